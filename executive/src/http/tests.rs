//! The server as its clients see it, over real sockets, with a thread that plays the loop.

mod access;
mod hostile;
mod stream;

use std::io::{BufRead, BufReader, ErrorKind, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::mpsc::Receiver;
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::Duration;

use kirk_network::{EventId, Network, Time, json};

use super::{LIMITS, Limits, Server, ServerOptions};
use crate::clock::Clock;
use crate::desk::{Acknowledgement, Desk, Message, Reply};

/// Two events are Nature's, `downlink:end` and `scan:end`.
fn network() -> Network {
    json::read(
        r#"{"format": "kirk-network/1", "origin": "main:start",
            "events": [{"id": "main:start", "names": ["main:start", "downlink:start"]}, "downlink:end", "scan:end"],
            "requirements": [],
            "contingents": [{"from": "main:start", "to": "downlink:end", "lower": 15, "upper": 30},
                            {"from": "main:start", "to": "scan:end", "lower": 1, "upper": 9}]}"#,
    )
    .expect("a valid network")
}

/// What the thread that plays the loop does with messages.
#[derive(Clone, Copy)]
enum Loop {
    Answers,
    /// Keeps them.
    Silent,
    /// Is gone.
    Over,
}

/// A server and the loop behind it.
struct Rig {
    server: Option<Server>,
    address: SocketAddr,
    desk: Desk,
    seen: Arc<Mutex<Seen>>,
    thread: Option<JoinHandle<()>>,
}

/// What reached the loop.
#[derive(Default)]
struct Seen {
    news: Vec<Vec<String>>,
    states: usize,
    kept: Vec<(Reply<Acknowledgement>, Acknowledgement)>,
}

impl Rig {
    fn new() -> Rig {
        Rig::with(LIMITS, Loop::Answers, None)
    }

    fn with(limits: Limits, plays: Loop, token: Option<&str>) -> Rig {
        let (desk, messages) = Desk::new(&network(), Clock::starting(Time::ZERO, kirk_runtime::Speed::REAL));
        let seen = Arc::new(Mutex::new(Seen::default()));
        let thread = {
            let (desk, seen) = (desk.clone(), seen.clone());
            std::thread::spawn(move || play(plays, &messages, &desk, &seen))
        };
        if let Loop::Over = plays {
            while !thread.is_finished() {
                std::thread::yield_now();
            }
        }
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let options = ServerOptions { token: token.map(|token| token.as_bytes().to_vec()) };
        let server = Server::with_limits(listener, options, desk.clone(), limits).unwrap();
        let address = server.address();
        Rig { server: Some(server), address, desk, seen, thread: Some(thread) }
    }

    fn client(&self) -> Client {
        let stream = TcpStream::connect(self.address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        stream.set_nodelay(true).unwrap();
        Client(BufReader::new(stream))
    }

    fn post(&self, body: &str) -> Answer {
        self.client().post(body)
    }

    fn get(&self, path: &str) -> Answer {
        self.client().ask(&format!("GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n"))
    }

    fn stop(&mut self) {
        self.server.take().expect("it runs").stop();
    }
}

impl Drop for Rig {
    fn drop(&mut self) {
        drop(self.server.take());
        self.desk.stop("the test is over".to_string());
        let played = self.thread.take().map(JoinHandle::join);
        assert!(std::thread::panicking() || matches!(played, Some(Ok(()))));
    }
}

fn play(plays: Loop, messages: &Receiver<Message>, desk: &Desk, seen: &Mutex<Seen>) {
    if let Loop::Over = plays {
        return;
    }
    for message in messages {
        let mut seen = seen.lock().unwrap();
        match (message, plays) {
            (Message::Stop { .. }, _) => return,
            (Message::Observed { events, mut answer, reply, .. }, _) => {
                let (names, ids): (Vec<String>, Vec<EventId>) = events.into_iter().unzip();
                answer.accepted.extend(names.iter().cloned());
                seen.news.push(names);
                if let Loop::Silent = plays {
                    seen.kept.push((reply, answer));
                    continue;
                }
                ids.into_iter().for_each(|event| desk.set_observed(event));
                desk.set_version(desk.version() + 1);
                reply(answer);
            }
            (Message::State { reply }, Loop::Answers) => {
                seen.states += 1;
                reply(format!(r#"{{"format":"kirk-execution/1","news":{}}}"#, seen.news.len()));
            }
            (Message::State { reply }, _) => std::mem::forget(reply),
            _ => panic!("nobody sends that"),
        }
    }
}

/// A connection.
struct Client(BufReader<TcpStream>);

/// A response.
#[derive(Debug)]
struct Answer {
    status: u16,
    /// In lower case.
    head: String,
    body: String,
}

impl Client {
    fn send(&mut self, bytes: impl AsRef<[u8]>) {
        self.0.get_mut().write_all(bytes.as_ref()).unwrap();
    }

    /// A request in full, and the response.
    fn ask(&mut self, request: &str) -> Answer {
        self.send(request);
        self.answer()
    }

    fn post(&mut self, body: impl AsRef<[u8]>) -> Answer {
        let body = body.as_ref();
        let head = format!("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: {}\r\n\r\n", body.len());
        self.send([head.as_bytes(), body].concat());
        self.answer()
    }

    fn head(&mut self) -> (u16, String) {
        let mut head = String::new();
        while !head.ends_with("\r\n\r\n") {
            assert_ne!(self.0.read_line(&mut head).unwrap(), 0, "closed after `{head}`");
        }
        let head = head.to_lowercase();
        (head.split(' ').nth(1).unwrap().parse().unwrap(), head)
    }

    fn answer(&mut self) -> Answer {
        let (status, head) = self.head();
        let length = head.split("content-length: ").nth(1).and_then(|rest| rest.split("\r\n").next());
        let mut body = vec![0; length.map_or(0, |length| length.parse().unwrap())];
        self.0.read_exact(&mut body).unwrap();
        Answer { status, head, body: String::from_utf8(body).unwrap() }
    }

    /// The server hangs up, and says nothing before.
    fn is_closed(&mut self) -> bool {
        match self.0.read(&mut [0; 1]) {
            Ok(read) => read == 0,
            Err(error) => error.kind() == ErrorKind::ConnectionReset,
        }
    }
}

#[test]
fn news_is_answered_event_by_event() {
    let rig = Rig::new();
    // As other people's programs say it, with what else they like to say.
    let answer =
        rig.post(r#"{"sender": {"name": "rover"}, "event-ids": ["+DOWNLINK::END+"], "t": [1.5, null]}"#);
    assert_eq!(
        (answer.status, answer.body.as_str()),
        (200, "{\"accepted\":[\"+DOWNLINK::END+\"],\"ignored\":[]}\n")
    );
    assert!(answer.head.contains("content-type: application/json"), "{}", answer.head);

    let answer = rig.post(r#"{"event-ids": ["scan:END", "downlink:end", "downlink:start", "lunch:end"]}"#);
    assert_eq!(answer.status, 200);
    let body: serde_json::Value = serde_json::from_str(&answer.body).unwrap();
    assert_eq!(body["accepted"], serde_json::json!(["scan:END"]));
    assert_eq!(
        body["ignored"],
        serde_json::json!([
            {"event": "downlink:end", "why": "it was heard before"},
            {"event": "downlink:start", "why": "it is not Nature's to decide: kirk dispatches it"},
            {"event": "lunch:end", "why": "there is no such event in this mission"},
        ])
    );
    assert_eq!(rig.seen.lock().unwrap().news, [["+DOWNLINK::END+"], ["scan:END"]]);
}

#[test]
fn an_empty_list_is_no_news_and_no_error() {
    let answer = Rig::new().post(r#"{"event-ids": []}"#);
    assert_eq!((answer.status, answer.body.as_str()), (200, "{\"accepted\":[],\"ignored\":[]}\n"));
}

#[test]
fn a_malformed_message_is_told_what_is_wrong_and_how_it_should_be() {
    let rig = Rig::new();
    let cases: [(&[u8], &str); 16] = [
        (b"", "EOF while parsing"),
        (b"event-ids=%2BDOWNLINK", "expected value at line 1 column 1"),
        (b"null", "invalid type: null, expected an object with the key `event-ids`"),
        (b"[]", "invalid type: sequence, expected an object"),
        (b"{}", "there is no `event-ids`"),
        (br#"{"event_ids": ["scan:end"]}"#, "there is `event_ids` but no `event-ids`"),
        (br#"{"event-ids": "scan:end"}"#, r#"invalid type: string \"scan:end\", expected a sequence"#),
        (br#"{"event-ids": ["scan:end", 7]}"#, "invalid type: integer `7`, expected a string"),
        (br#"{"event-ids": [["scan:end"]]}"#, "expected a string"),
        (br#"{"event-ids": null}"#, "invalid type: null"),
        (br#"{"event-ids": ["scan:end"], "event-ids": []}"#, "`event-ids` is there twice"),
        (br#"{"event-ids": ["scan:end"]} {}"#, "trailing characters"),
        (br#"{"event-ids": ["scan:end"]"#, "EOF while parsing an object"),
        (b"{\"event-ids\": [\"\xff\xfe\"]}", "invalid unicode code point"),
        (b"\xef\xbb\xbf\xef\xbb\xbf{\"event-ids\": []}", "expected value"),
        (b"\x00\x01\x02", "expected value"),
    ];
    for (body, part) in cases {
        let answer = rig.client().post(body);
        let shown = String::from_utf8_lossy(body);
        assert_eq!(answer.status, 400, "{shown}");
        assert!(answer.body.contains(part), "{shown}: {}", answer.body);
        assert!(answer.body.starts_with(r#"{"error":"this is not news: "#), "{shown}: {}", answer.body);
        assert!(
            answer.body.contains(r#"{\"event-ids\": [\"+DOWNLINK::END+\"]}"#),
            "{shown}: {}",
            answer.body
        );
    }
    assert!(rig.seen.lock().unwrap().news.is_empty());
}

#[test]
fn the_state_is_asked_for_once_for_each_change() {
    let rig = Rig::with(Limits { fresh: Duration::from_secs(3600), ..LIMITS }, Loop::Answers, None);
    let mut client = rig.client();
    for _ in 0..50 {
        let answer = client.ask("GET /state HTTP/1.1\r\nHost: localhost\r\n\r\n");
        assert_eq!(
            (answer.status, answer.body.as_str()),
            (200, "{\"format\":\"kirk-execution/1\",\"news\":0}\n")
        );
    }
    assert_eq!(rig.seen.lock().unwrap().states, 1);
    rig.post(r#"{"event-ids": ["scan:end"]}"#);
    for _ in 0..50 {
        let answer = client.ask("GET /state HTTP/1.1\r\nHost: localhost\r\n\r\n");
        assert_eq!(answer.body, "{\"format\":\"kirk-execution/1\",\"news\":1}\n");
    }
    assert_eq!(rig.seen.lock().unwrap().states, 2);
}

#[test]
fn an_old_answer_about_the_state_is_not_given_again() {
    let rig = Rig::with(Limits { fresh: Duration::ZERO, ..LIMITS }, Loop::Answers, None);
    rig.get("/state");
    rig.get("/state");
    assert_eq!(rig.seen.lock().unwrap().states, 2);
}

#[test]
fn where_get_is_head_is_too() {
    let rig = Rig::new();
    let mut client = rig.client();
    for (path, kind) in
        [("/state", "application/json"), ("/healthz", "text/plain"), ("/events", "text/event-stream")]
    {
        client.send(format!("HEAD {path} HTTP/1.1\r\nHost: localhost\r\n\r\n"));
        let (status, head) = client.head();
        assert_eq!(status, 200);
        assert!(head.contains(&format!("content-type: {kind}\r\n")), "{head}");
    }
    // Had there been a body it would come now.
    assert_eq!(client.ask("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n").body, "ok\n");
}

#[test]
fn what_there_is_not_is_refused_with_what_there_is() {
    let rig = Rig::new();
    for (request, status, part, header) in [
        ("GET /", 405, "`/` takes POST, not GET", "allow: post\r\n"),
        ("OPTIONS /", 405, "`/` takes POST, not OPTIONS", "allow: post\r\n"),
        ("HEAD /?now", 405, "", "allow: post\r\n"),
        ("POST /state", 405, "`/state` takes GET, HEAD, not POST", "allow: get, head\r\n"),
        ("DELETE /events", 405, "", "allow: get, head\r\n"),
        ("PUT /healthz", 405, "", "allow: get, head\r\n"),
        ("GET /nothing?x=1", 404, "there is no `/nothing`; what there is: POST / (news)", ""),
        ("POST /state/", 404, "", ""),
        ("POST //", 404, "", ""),
        ("GET *", 404, "", ""),
    ] {
        let mut client = rig.client();
        client.send(format!("{request} HTTP/1.1\r\nHost: localhost\r\n\r\n"));
        let (got, head) = client.head();
        assert_eq!(got, status, "{request}");
        assert!(head.contains(header), "{request}: {head}");
        assert!(head.contains("content-type: application/json\r\n"), "{request}: {head}");
        if !part.is_empty() {
            let mut body = String::new();
            client.0.read_line(&mut body).unwrap();
            assert!(body.contains(part), "{request}: {body}");
        }
    }
}

#[test]
fn clients_may_be_of_the_old_kind() {
    let rig = Rig::new();
    let mut client = rig.client();
    // HTTP/1.0 without a host, and hanging up the sending half when all is said.
    client.send("POST / HTTP/1.0\r\nContent-Length: 26\r\n\r\n{\"event-ids\":[\"scan:end\"]}");
    client.0.get_mut().shutdown(Shutdown::Write).unwrap();
    let answer = client.answer();
    assert_eq!(
        (answer.status, answer.body.as_str()),
        (200, "{\"accepted\":[\"scan:end\"],\"ignored\":[]}\n")
    );
    assert!(client.is_closed());
}

#[test]
fn bodies_may_be_chunked_and_expect_an_invitation() {
    let rig = Rig::new();
    let mut client = rig.client();
    client.send(
        "POST / HTTP/1.1\r\nHost: localhost\r\nExpect: 100-continue\r\nTransfer-Encoding: chunked\r\n\r\n",
    );
    assert_eq!(client.head().0, 100);
    client.send("e\r\n{\"event-ids\":[\r\nc\r\n\"scan:end\"]}\r\n0\r\n\r\n");
    let answer = client.answer();
    assert_eq!(
        (answer.status, answer.body.as_str()),
        (200, "{\"accepted\":[\"scan:end\"],\"ignored\":[]}\n")
    );
}

#[test]
fn requests_may_come_all_at_once() {
    let rig = Rig::new();
    let mut client = rig.client();
    client.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n".repeat(100));
    for _ in 0..100 {
        assert_eq!(client.answer().status, 200);
    }
}

#[test]
fn a_loop_that_does_not_answer_is_reported_in_time() {
    let rig = Rig::with(Limits { answer: Duration::from_millis(50), ..LIMITS }, Loop::Silent, None);
    for answer in [rig.post(r#"{"event-ids": ["scan:end"]}"#), rig.get("/state"), rig.get("/events")] {
        assert_eq!(answer.status, 503);
        assert!(answer.body.contains("did not answer within 50ms; ask again"), "{}", answer.body);
        assert!(answer.head.contains("retry-after: 1"), "{}", answer.head);
    }
    // What is of no use is known without the loop, and so is that the server lives.
    assert_eq!(rig.post(r#"{"event-ids": ["lunch:end"]}"#).status, 200);
    assert_eq!(rig.get("/healthz").status, 200);
}

#[test]
fn a_loop_that_is_gone_is_reported_at_once() {
    let rig = Rig::with(LIMITS, Loop::Over, None);
    for answer in [rig.post(r#"{"event-ids": ["scan:end"]}"#), rig.get("/state"), rig.get("/events")] {
        assert_eq!((answer.status, answer.body.as_str()), (503, "{\"error\":\"the mission is over\"}\n"));
    }
}

#[test]
fn the_inbox_of_the_loop_never_fills_up_with_questions() {
    let rig =
        Rig::with(Limits { questions: 3, answer: Duration::from_millis(50), ..LIMITS }, Loop::Silent, None);
    for _ in 0..3 {
        assert!(rig.post(r#"{"event-ids": ["scan:end"]}"#).body.contains("did not answer"));
    }
    let answer = rig.post(r#"{"event-ids": ["scan:end"]}"#);
    assert_eq!((answer.status, rig.seen.lock().unwrap().news.len()), (503, 3));
    assert!(answer.body.contains("too many ask at the same time"), "{}", answer.body);
    // Answers that nobody waits for any more make room as well.
    for (reply, answer) in rig.seen.lock().unwrap().kept.drain(..) {
        reply(answer);
    }
    assert!(rig.post(r#"{"event-ids": ["scan:end"]}"#).body.contains("did not answer"));
    assert_eq!(rig.seen.lock().unwrap().news.len(), 4);
}
