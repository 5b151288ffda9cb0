//! A socket that says why. What is not HTTP hyper answers by itself, without a body; here it gets one.

use std::io;
use std::pin::Pin;
use std::task::{Context, Poll, ready};

use serde_json::json;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};

use super::{HEAD, HEADERS};

/// Reads and writes what hyper does, but for its own refusals.
pub(super) struct Explained<S> {
    stream: S,
    /// What is written instead of one, as far as that was not done yet.
    rest: Vec<u8>,
}

impl<S> Explained<S> {
    pub(super) fn new(stream: S) -> Explained<S> {
        Explained { stream, rest: Vec::new() }
    }
}

/// Where hyper's own refusal begins, if what it writes ends with one: it is the last thing hyper writes. A refusal of ours
/// always has a body.
fn refusal(bytes: &[u8]) -> Option<(usize, &[u8])> {
    let at = bytes.windows(BEGINNING.len()).rposition(|window| window == BEGINNING)?;
    let head = bytes[at..].strip_suffix(b"\r\n\r\n")?;
    let mut lines = head.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    lines.any(|line| line.eq_ignore_ascii_case(b"content-length: 0")).then_some((at, head))
}

const BEGINNING: &[u8] = b"HTTP/1.1 4";

/// The same refusal with a body.
fn explained(head: &[u8]) -> Vec<u8> {
    let line = head.split(|&byte| byte == b'\r').next().unwrap_or_default();
    let why = match line.get(9..12) {
        Some(b"431") => format!("the head of a request may have {HEAD} bytes and {HEADERS} lines"),
        Some(b"414") => "the path is too long".to_string(),
        _ => {
            "this is not HTTP/1.1: look at the first line, at the headers, and at `Content-Length` above all"
                .to_string()
        }
    };
    let error = format!("{why}. The connection ends here, and whatever came after this request was not read");
    let body = json!({ "error": error }).to_string() + "\n";
    let length = body.len();
    let head = format!(
        "\r\ncontent-type: application/json\r\ncontent-length: {length}\r\nconnection: close\r\ncache-control: no-store\r\n\r\n"
    );
    [line, head.as_bytes(), body.as_bytes()].concat()
}

impl<S: AsyncWrite + Unpin> Explained<S> {
    fn poll_rest(&mut self, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        while !self.rest.is_empty() {
            let written = ready!(Pin::new(&mut self.stream).poll_write(context, &self.rest))?;
            if written == 0 {
                return Poll::Ready(Err(io::ErrorKind::WriteZero.into()));
            }
            self.rest.drain(..written);
        }
        Poll::Ready(Ok(()))
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for Explained<S> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_read(context, buffer)
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for Explained<S> {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        ready!(self.poll_rest(context))?;
        match refusal(bytes) {
            Some((0, head)) => {
                self.rest = explained(head);
                Poll::Ready(Ok(bytes.len()))
            }
            // What stands before it first.
            Some((at, _)) => Pin::new(&mut self.stream).poll_write(context, &bytes[..at]),
            None => Pin::new(&mut self.stream).poll_write(context, bytes),
        }
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        ready!(self.poll_rest(context))?;
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        ready!(self.poll_rest(context))?;
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_refusal_without_a_body_is_one_of_hypers() {
        let own = b"HTTP/1.1 400 Bad Request\r\nconnection: close\r\ncontent-length: 0\r\n\r\n";
        let ours = b"HTTP/1.1 404 Not Found\r\ncontent-length: 2\r\n\r\n{}";
        let head = b"HTTP/1.1 405 Method Not Allowed\r\nallow: GET\r\ncontent-length: 20\r\n\r\n";
        assert_eq!(refusal(own).map(|(at, _)| at), Some(0));
        assert_eq!(refusal(&[&ours[..], own].concat()).map(|(at, _)| at), Some(ours.len()));
        assert!(refusal(ours).is_none() && refusal(head).is_none());
        assert!(refusal(b"HTTP/1.1 200 OK\r\ncontent-length: 0\r\n\r\n").is_none());
    }
}
