//! An HTTP address to which each event is posted; any answer of the 200s confirms it.

use std::time::Duration as Real;

use http_body_util::{BodyExt, Full, Limited};
use hyper::Request;
use hyper::body::Bytes;
use hyper_util::rt::TokioIo;
use kirk_runtime::Sending;
use tokio::net::TcpStream;
use tokio::sync::mpsc::UnboundedReceiver;

use super::{Instruction, dispatch, next};
use crate::desk::{Desk, Failed};

/// Where to post.
#[derive(Clone, Debug)]
pub(super) struct Address {
    /// Host and port, as a `Host` header has them.
    authority: String,
    /// What to connect to.
    socket: (String, u16),
    path: String,
}

impl Address {
    pub(super) fn parse(url: &str) -> Result<Address, String> {
        let uri: hyper::Uri = url.parse().map_err(|error| format!("`{url}` is no address: {error}"))?;
        match uri.scheme_str() {
            Some("http") => {}
            Some("https") => {
                return Err(format!(
                    "`{url}`: kirk speaks plain HTTP only; for https use `--driver-command 'curl --fail ... {url}'`"
                ));
            }
            _ => return Err(format!("`{url}` is no address of HTTP; expected `http://HOST[:PORT]/PATH`")),
        }
        let host = uri.host().unwrap_or_default().trim_matches(['[', ']']).to_string();
        if host.is_empty() {
            return Err(format!("`{url}` names no host"));
        }
        let authority = uri.authority().map(|authority| authority.to_string()).unwrap_or_default();
        if authority.contains('@') {
            return Err(format!(
                "`{url}`: a password in the address would end up in journals; kirk does not use it"
            ));
        }
        // Without a port the scheme says which; one that is none must not be taken for that.
        let after_host = authority.strip_prefix(uri.host().unwrap_or_default()).unwrap_or_default();
        let port = match (after_host, uri.port_u16()) {
            ("", _) => 80,
            (_, Some(port @ 1..)) => port,
            (given, _) => {
                let given = given.trim_start_matches(':');
                return Err(format!("`{url}`: `{given}` is no port; a port is a number from 1 to 65535"));
            }
        };
        let path = uri.path_and_query().map_or("/".to_string(), |path| path.to_string());
        Ok(Address { authority, socket: (host, port), path })
    }
}

pub(super) async fn run(url: String, limit: Real, mut inbox: UnboundedReceiver<Instruction>, desk: Desk) {
    let address = match Address::parse(&url) {
        Ok(address) => address,
        Err(message) => return desk.warn(message),
    };
    let local = tokio::task::LocalSet::new();
    let work = async {
        while let Some(sending) = next(&mut inbox).await {
            let (address, desk) = (address.clone(), desk.clone());
            tokio::task::spawn_local(async move {
                let answer = tokio::time::timeout(limit, post(&address, &sending)).await;
                match answer {
                    Ok(Ok(())) => desk.executed(sending.id, None),
                    Ok(Err(failure)) => desk.failed(sending.id, failure),
                    Err(_) => {
                        let limit = limit.as_secs_f64();
                        desk.failed(sending.id, Failed::perhaps(format!("no answer within {limit} s")));
                    }
                }
            });
        }
    };
    local.run_until(work).await;
}

async fn post(address: &Address, sending: &Sending) -> Result<(), Failed> {
    let connected = TcpStream::connect((address.socket.0.as_str(), address.socket.1)).await;
    let stream =
        connected.map_err(|error| Failed::surely(format!("cannot reach {}: {error}", address.authority)))?;
    let _ = stream.set_nodelay(true);
    let lost = |error: hyper::Error| {
        Failed::perhaps(format!("{} did not answer properly: {error}", address.authority))
    };
    let (mut sender, connection) =
        hyper::client::conn::http1::handshake(TokioIo::new(stream)).await.map_err(lost)?;
    let connection = tokio::task::spawn_local(connection);
    let body = serde_json::json!({ "dispatch": dispatch(sending) }).to_string();
    let request = Request::post(address.path.as_str())
        .header("Host", address.authority.as_str())
        .header("Content-Type", "application/json")
        .header("Idempotency-Key", sending.id.as_str())
        .header("Connection", "close")
        .body(Full::new(Bytes::from(body)))
        .map_err(|error| Failed::surely(format!("the request cannot be made: {error}")))?;
    let answer = sender.send_request(request).await.map_err(lost)?;
    let status = answer.status();
    let result = if status.is_success() {
        Ok(())
    } else {
        // What the server says may help whoever reads the journal.
        let text = Limited::new(answer.into_body(), 4096).collect().await;
        let text =
            text.map(|body| String::from_utf8_lossy(&body.to_bytes()).trim().to_string()).unwrap_or_default();
        let first = text.lines().next().unwrap_or_default();
        let colon = if first.is_empty() { "" } else { ": " };
        Err(Failed::surely(format!("{} answered {status}{colon}{first}", address.authority)))
    };
    connection.abort();
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_port_that_is_none_is_refused_and_not_taken_for_the_usual_one() {
        let socket = |url: &str| Address::parse(url).map(|address| address.socket);
        assert_eq!(socket("http://127.0.0.1/x"), Ok(("127.0.0.1".to_string(), 80)));
        assert_eq!(socket("http://robot:8080"), Ok(("robot".to_string(), 8080)));
        assert_eq!(socket("http://[::1]:65535/"), Ok(("::1".to_string(), 65535)));
        assert_eq!(socket("http://[::1]/"), Ok(("::1".to_string(), 80)));
        for url in [
            "http://127.0.0.1:99999/",
            "http://robot:0/",
            "http://[::1]:65536/",
            "http://robot:/x",
            "http://robot:8o/",
        ] {
            assert!(socket(url).is_err(), "{url}: {:?}", socket(url));
        }
    }
}
