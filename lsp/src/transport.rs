//! Messages in and out: the frames of the protocol on two byte streams, each served by a thread of its own.
//!
//! `lsp-server` has a reader too, which ends at the first message it cannot understand. This one says what is wrong with
//! it and goes on with the next.

use std::io::{BufRead, Read, Write};
use std::sync::mpsc::{Receiver, Sender};

use lsp_server::{ErrorCode, Message};
use serde_json::{Value, json};

/// More than any program kirk reads, several times over.
const LARGEST_FRAME: u64 = 256 << 20;

/// What the client sent.
#[derive(Debug)]
pub(crate) enum Incoming {
    /// A message.
    Message(Message),
    /// What is no message: the answer to it.
    Malformed(Value),
}

/// What the client gets.
#[derive(Debug)]
pub(crate) enum Outgoing {
    /// A message.
    Message(Message),
    /// The answer to what was no message.
    Raw(Value),
}

/// Hands over every message, until the stream ends or nobody listens.
pub(crate) fn read(mut input: impl BufRead, deliver: impl Fn(Incoming) -> bool) {
    while let Some(incoming) = frame(&mut input) {
        if !deliver(incoming) {
            break;
        }
    }
}

/// Writes every message, until there are no more or nobody reads.
pub(crate) fn write(mut output: impl Write, outbox: &Receiver<Outgoing>) {
    for outgoing in outbox {
        let written = match outgoing {
            Outgoing::Message(message) => message.write(&mut output),
            Outgoing::Raw(value) => {
                let text = value.to_string();
                write!(output, "Content-Length: {}\r\n\r\n{text}", text.len()).and_then(|()| output.flush())
            }
        };
        if written.is_err() {
            break;
        }
    }
}

/// Sends, whether or not anybody still reads.
pub(crate) fn send(outbox: &Sender<Outgoing>, message: impl Into<Message>) {
    let _ = outbox.send(Outgoing::Message(message.into()));
}

/// The next message; `None` at the end of the stream.
fn frame(input: &mut impl BufRead) -> Option<Incoming> {
    let mut length = None;
    loop {
        let mut line = Vec::new();
        if (&mut *input).take(64 << 10).read_until(b'\n', &mut line).ok()? == 0 {
            return None;
        }
        let line = String::from_utf8_lossy(&line);
        let line = line.trim();
        if line.is_empty() {
            break;
        }
        if let Some((name, value)) = line.split_once(':')
            && name.trim().eq_ignore_ascii_case("content-length")
        {
            length = value.trim().parse::<u64>().ok();
        }
    }
    let Some(length) = length else {
        return Some(malformed(
            Value::Null,
            ErrorCode::ParseError,
            "a header `Content-Length: N` was expected",
        ));
    };
    if length > LARGEST_FRAME {
        return None;
    }
    let mut body = Vec::new();
    let read = (&mut *input).take(length).read_to_end(&mut body).ok()?;
    if (read as u64) < length {
        return None;
    }
    let value: Value = match serde_json::from_slice(&body) {
        Ok(value) => value,
        Err(error) => {
            return Some(malformed(
                Value::Null,
                ErrorCode::ParseError,
                &format!("this is not JSON: {error}"),
            ));
        }
    };
    let id = value.get("id").filter(|id| id.is_number() || id.is_string()).cloned().unwrap_or(Value::Null);
    let is_request = value.get("id").is_some_and(|id| !id.is_null()) && value.get("method").is_some();
    Some(match serde_json::from_value(value) {
        // The id of a request may be one that `lsp-server` does not understand.
        Ok(message) if is_request == matches!(message, Message::Request(_)) => Incoming::Message(message),
        _ => malformed(id, ErrorCode::InvalidRequest, "this is neither a request nor a notification"),
    })
}

fn malformed(id: Value, code: ErrorCode, message: &str) -> Incoming {
    let error = json!({ "code": code as i32, "message": message });
    Incoming::Malformed(json!({ "jsonrpc": "2.0", "id": id, "error": error }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(text: &str) -> Vec<String> {
        let seen = std::cell::RefCell::new(Vec::new());
        read(text.as_bytes(), |incoming| {
            seen.borrow_mut().push(match incoming {
                Incoming::Message(Message::Request(request)) => format!("request {}", request.method),
                Incoming::Message(Message::Notification(notification)) => {
                    format!("notification {}", notification.method)
                }
                Incoming::Message(Message::Response(_)) => "response".to_string(),
                Incoming::Malformed(answer) => answer.to_string(),
            });
            true
        });
        seen.into_inner()
    }

    fn framed(body: &str) -> String {
        format!("Content-Length: {}\r\n\r\n{body}", body.len())
    }

    #[test]
    fn what_is_no_message_is_answered_and_the_next_one_read() {
        let good = framed(r#"{"jsonrpc":"2.0","id":1,"method":"shutdown"}"#);
        for (bad, says) in [
            (framed("{"), "-32700"),
            (framed("[]"), "-32600"),
            (framed(r#"{"jsonrpc":"2.0","id":7}"#), "\"id\":7"),
            (framed(r#"{"id":99999999999,"method":"x"}"#), "99999999999"),
            ("Nonsense\r\n\r\n".to_string(), "Content-Length"),
            ("Content-Length: many\r\n\r\n".to_string(), "Content-Length"),
            (framed("\u{0}"), "-32700"),
        ] {
            let seen = frames(&format!("{bad}{good}"));
            assert_eq!(seen.len(), 2, "{bad:?}: {seen:?}");
            assert!(seen[0].contains(says), "{bad:?}: {seen:?}");
            assert_eq!(seen[1], "request shutdown");
        }
    }

    #[test]
    fn headers_come_in_any_case_and_a_stream_may_end_anywhere() {
        assert_eq!(
            frames("content-length:29\r\nContent-Type: x\r\n\r\n{\"method\":\"exit\",\"params\":{}}"),
            ["notification exit"]
        );
        assert!(frames("Content-Length: 100\r\n\r\n{").is_empty());
        assert!(frames("Content-Length: 99999999999999\r\n\r\n{").is_empty());
        assert!(frames("Content-Le").len() <= 1);
    }
}
