//! Those who listen.

use kirk_network::Time;
use kirk_runtime::{Execution, How, Outcome, Row};

use super::*;
use crate::happening::Happening;

fn at(micros: i64) -> Time {
    Time::from_micros(micros)
}

fn warning(text: impl Into<String>) -> Happening {
    Happening::Warning { at: at(1_500_000), text: text.into() }
}

fn one_of_each() -> [Happening; 5] {
    let row = Row {
        event: "scan:end".to_string(),
        time: Some(at(2_000_000)),
        how: How::Observed,
        observed: Some(Some(at(2_000_000))),
        happened: None,
        truth: None,
        because: None,
    };
    let execution = Execution {
        format: "kirk-execution/1".to_string(),
        program: "main".to_string(),
        outcome: Outcome::Completed,
        failure: None,
        makespan: at(2_000_000),
        seed: None,
        what_if: None,
        rows: vec![row.clone()],
    };
    [
        Happening::Sent {
            at: at(0),
            event: "x:start".to_string(),
            id: "1".to_string(),
            due: at(0),
            attempt: 1,
        },
        Happening::Failed {
            at: at(1),
            event: "scan:start".to_string(),
            id: "1".to_string(),
            reason: "two\nlines, \u{e4}".to_string(),
        },
        warning("late"),
        Happening::Fixed { at: at(2_000_000), rows: vec![row] },
        Happening::Over { at: at(2_000_000), execution },
    ]
}

impl Client {
    /// Begins to listen.
    fn listen(&mut self) {
        self.send("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n");
        let (status, head) = self.head();
        assert_eq!(status, 200);
        assert!(head.contains("content-type: text/event-stream\r\n"), "{head}");
    }

    /// The next event, or comment; nothing at the end of the stream.
    fn event(&mut self) -> Option<String> {
        let mut size = String::new();
        self.0.read_line(&mut size).unwrap();
        let size = usize::from_str_radix(size.trim(), 16).unwrap();
        let mut chunk = vec![0; size + 2];
        self.0.read_exact(&mut chunk).unwrap();
        chunk.truncate(size);
        let event = String::from_utf8(chunk).unwrap();
        assert!(event.is_empty() || event.ends_with("\n\n"), "{event}");
        (size > 0).then_some(event)
    }
}

#[test]
fn a_stream_begins_with_the_state_and_tells_what_happens_in_order() {
    let mut rig = Rig::new();
    let mut clients = [rig.client(), rig.client()];
    for client in &mut clients {
        client.listen();
        let state = client.event().unwrap();
        assert_eq!(state, "event: state\ndata: {\"format\":\"kirk-execution/1\",\"news\":0}\n\n");
    }
    one_of_each().into_iter().for_each(|happening| rig.desk.tell(happening));
    // All of it is told, the end as well, though the server stops right after.
    rig.stop();
    for client in &mut clients {
        for happening in one_of_each() {
            let json = serde_json::to_value(&happening).unwrap();
            let event = client.event().unwrap();
            let (kind, data) = event.trim_end().split_once('\n').unwrap();
            assert_eq!(kind, format!("event: {}", json["kind"].as_str().unwrap()));
            let data = data.strip_prefix("data: ").unwrap();
            assert_eq!(serde_json::from_str::<serde_json::Value>(data).unwrap(), json);
        }
        assert_eq!(client.event(), None);
        assert!(client.is_closed());
    }
}

#[test]
fn a_listener_that_is_too_slow_is_told_how_much_it_missed() {
    let rig = Rig::new();
    let mut client = rig.client();
    client.listen();
    client.event().unwrap();
    // More than sockets and queues take.
    let all: usize = 30_000;
    for i in 0..all {
        rig.desk.tell(warning(format!("{i} {}", "x".repeat(1000))));
    }
    let (mut next, mut missed) = (0, 0);
    while next < all {
        let event = client.event().unwrap();
        if let Some(data) = event.strip_prefix("event: missed\ndata: ") {
            let data: serde_json::Value = serde_json::from_str(data).unwrap();
            assert_eq!(data["kind"], "missed");
            let count = data["count"].as_u64().unwrap() as usize;
            (next, missed) = (next + count, missed + count);
        } else {
            assert!(event.contains(&format!("\"text\":\"{next} x")), "{next}: {event}");
            next += 1;
        }
    }
    assert!(missed > 0);
    // And goes on.
    rig.desk.tell(warning("still there?"));
    assert!(client.event().unwrap().contains("still there?"));
}

#[test]
fn a_stream_shows_signs_of_life() {
    let rig = Rig::with(Limits { keep_alive: Duration::from_millis(10), ..LIMITS }, Loop::Answers, None);
    let mut client = rig.client();
    client.listen();
    assert!(client.event().unwrap().starts_with("event: state\n"));
    assert_eq!(client.event().unwrap(), ": still here\n\n");
    assert_eq!(client.event().unwrap(), ": still here\n\n");
}

#[test]
fn there_may_be_so_many_streams_and_who_leaves_makes_room() {
    let limits = Limits { streams: 2, keep_alive: Duration::from_millis(10), ..LIMITS };
    let rig = Rig::with(limits, Loop::Answers, None);
    let mut clients = [rig.client(), rig.client()];
    clients.iter_mut().for_each(Client::listen);
    assert!(rig.get("/events").body.contains("too many ask at the same time"));
    // Others are not hindered.
    assert_eq!(rig.get("/state").status, 200);
    drop(clients);
    let mut client = rig.client();
    let free = (0..2000).any(|_| {
        std::thread::sleep(Duration::from_millis(5));
        client.send("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n");
        let (status, _) = client.head();
        let mut line = String::new();
        status == 200 || client.0.read_line(&mut line).unwrap() == 0
    });
    assert!(free);
}

#[test]
fn a_stream_outlives_silence_and_the_need_for_room() {
    let patience = Duration::from_millis(300);
    let rig = Rig::with(Limits { connections: 3, patience, ..LIMITS }, Loop::Answers, None);
    let mut listener = rig.client();
    listener.listen();
    listener.event().unwrap();
    let crowd: Vec<Client> = (0..20).map(|_| rig.client()).collect();
    std::thread::sleep(patience * 3 / 2);
    assert!(crowd.into_iter().all(|mut client| client.is_closed()));
    rig.desk.tell(warning("after all this"));
    assert!(listener.event().unwrap().contains("after all this"));
}

#[test]
fn a_listener_that_takes_nothing_is_hung_up_on() {
    let patience = Duration::from_millis(300);
    let limits = Limits { stalled: Duration::from_millis(20), patience, streams: 1, ..LIMITS };
    let rig = Rig::with(limits, Loop::Answers, None);
    let mut client = rig.client();
    client.listen();
    // More than sockets take.
    for _ in 0..30_000 {
        rig.desk.tell(warning("x".repeat(1000)));
    }
    // Once it is let go there is room for another.
    while rig.get("/events").status == 503 {
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(2 * patience);
    let mut told = Vec::new();
    let hung_up = client.0.read_to_end(&mut told).map_err(|error| error.kind());
    assert!(matches!(hung_up, Ok(_) | Err(ErrorKind::ConnectionReset)), "{hung_up:?}");
    assert!(told.len() < 30_000 * 1000);
}
