//! Clients that mean harm, or do it.

use super::*;

#[test]
fn what_is_of_no_use_never_reaches_the_loop_however_much_comes() {
    let rig = Rig::new();
    let mut client = rig.client();
    for _ in 0..1000 {
        assert_eq!(client.post(r#"{"event-ids": ["scan:end"]}"#).status, 200);
        assert_eq!(client.post(r#"{"event-ids": ["lunch:end", "+MAIN::START+"]}"#).status, 200);
        assert_eq!(client.post(r#"{"event-ids": "#).status, 400);
        assert_eq!(client.ask("GET /state HTTP/1.1\r\nHost: evil.example\r\n\r\n").status, 403);
    }
    let seen = rig.seen.lock().unwrap();
    assert_eq!((&seen.news, seen.states), (&vec![vec!["scan:end".to_string()]], 0));
}

#[test]
fn a_body_may_be_as_long_as_the_limit_and_no_longer() {
    let rig = Rig::new();
    let padded = |length: usize| {
        let (before, after) = (r#"{"event-ids": [], "x": ""#, r#""}"#);
        format!("{before}{}{after}", "x".repeat(length - before.len() - after.len()))
    };
    assert_eq!(rig.post(&padded(65536)).status, 200);
    let answer = rig.post(&padded(65537));
    assert_eq!(answer.status, 413);
    assert!(answer.body.contains("a message may have 65536 bytes"), "{}", answer.body);

    // Told at once, and not invited to send it.
    let mut client = rig.client();
    let head =
        "POST / HTTP/1.1\r\nHost: localhost\r\nExpect: 100-continue\r\nContent-Length: 99999999999\r\n\r\n";
    assert_eq!(client.ask(head).status, 413);
    assert!(client.is_closed());

    // Also heard by a client that sends all of it before it listens, with or without a length.
    let mut client = rig.client();
    client.post_long(format!("Content-Length: {}\r\n", 1 << 20), &vec![b'x'; 1 << 20]);
    let mut client = rig.client();
    let chunk = format!("1000\r\n{}\r\n", "x".repeat(4096));
    client.post_long("Transfer-Encoding: chunked\r\n".to_string(), chunk.repeat(256).as_bytes());
}

impl Client {
    fn post_long(&mut self, header: String, body: &[u8]) {
        self.send(format!("POST / HTTP/1.1\r\nHost: localhost\r\n{header}\r\n"));
        self.send(body);
        assert_eq!(self.answer().status, 413);
    }
}

#[test]
fn a_request_that_comes_after_one_that_makes_no_sense_is_not_lost_without_a_word() {
    let rig = Rig::new();
    let mut client = rig.client();
    let good = r#"{"event-ids": ["scan:end"]}"#;
    let first = format!("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: {}\r\n\r\n{good}", good.len());
    let bad = "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: -5\r\n\r\n";
    client.send(format!("{first}{bad}{first}"));
    assert_eq!(client.answer().status, 200);
    let answer = client.answer();
    assert_eq!(answer.status, 400);
    assert!(answer.head.contains("connection: close"), "{}", answer.head);
    assert!(
        answer.body.contains("Content-Length") && answer.body.contains("was not read"),
        "{}",
        answer.body
    );
    assert!(client.is_closed());
}

#[test]
fn a_mark_before_the_news_does_no_harm() {
    let answer = Rig::new().post("\u{feff}{\"event-ids\": [\"scan:end\"]}");
    assert_eq!(answer.status, 200, "{}", answer.body);
}

#[test]
fn garbage_ends_the_connection_and_nothing_else() {
    let rig = Rig::new();
    let head = "POST / HTTP/1.1\r\nHost: localhost\r\n";
    let many: String = (0..100).map(|i| format!("X-{i}: {i}\r\n")).collect();
    for (request, status) in [
        ("\x16\x03\x01\x02\x00\x01\x00\x01\u{fc}\r\n\r\n".to_string(), 400),
        ("hello\r\n\r\n".to_string(), 400),
        ("GET /state HTTP/9.9\r\n\r\n".to_string(), 400),
        (format!("{head}Content-Length: -1\r\n\r\n"), 400),
        (format!("{head}Content-Length: 3\r\nContent-Length: 4\r\n\r\nabcd"), 400),
        (format!("{head}Transfer-Encoding: chunked\r\n\r\nZZ\r\n"), 400),
        (format!("{head}Transfer-Encoding: chunked\r\n\r\nffffffffffffffffff\r\n"), 400),
        (format!("{head}Transfer-Encoding: gzip\r\n\r\n"), 400),
        (format!("{head}{many}\r\n"), 431),
        (format!("{head}X: {}\r\n\r\n", "x".repeat(64 * 1024)), 431),
        (format!("GET /{} HTTP/1.1\r\n\r\n", "x".repeat(64 * 1024)), 431),
    ] {
        let mut client = rig.client();
        client.send(&request);
        let shown = &request[..request.len().min(100)];
        let answer = client.answer();
        assert_eq!(answer.status, status, "{shown}");
        let error: serde_json::Value = serde_json::from_str(&answer.body).unwrap();
        assert!(error["error"].as_str().is_some_and(|error| error.len() > 20), "{shown}: {}", answer.body);
    }
    assert_eq!(rig.get("/healthz").status, 200);
}

#[test]
fn deep_nesting_is_no_harm() {
    let rig = Rig::new();
    let deep = "[".repeat(30_000);
    assert_eq!(rig.post(&deep).status, 400);
    assert_eq!(rig.post(&format!(r#"{{"event-ids": {deep}"#)).status, 400);
    let whole = format!(r#"{{"event-ids": ["scan:end"], "x": {deep}{}}}"#, "]".repeat(30_000));
    assert_eq!(rig.post(&whole).status, 200);
}

#[test]
fn who_says_nothing_makes_room_for_who_does() {
    let rig = Rig::with(Limits { connections: 8, ..LIMITS }, Loop::Answers, None);
    let mut silent: Vec<Client> = (0..50).map(|_| rig.client()).collect();
    for (i, client) in silent.iter_mut().enumerate() {
        // Nothing, half a head, half a body. Some are cut off already.
        let half = ["", "POST / HTTP/1.1\r\nHos", "POST / HTTP/1.1\r\nContent-Length: 50\r\n\r\n{"][i % 3];
        let _ = client.0.get_mut().write_all(half.as_bytes());
    }
    let mut healthy = rig.client();
    assert_eq!(healthy.post(r#"{"event-ids": ["scan:end"]}"#).status, 200);
    assert!(silent[..40].iter_mut().all(Client::is_closed));
    assert_eq!(healthy.post(r#"{"event-ids": ["scan:end"]}"#).status, 200);
}

#[test]
fn who_waits_for_us_is_not_cut_off_for_others() {
    let rig = Rig::with(Limits { connections: 2, ..LIMITS }, Loop::Silent, None);
    let news =
        "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 27\r\n\r\n{\"event-ids\": [\"scan:end\"]}";
    let kept = |rig: &Rig| rig.seen.lock().unwrap().kept.len();
    let mut clients: Vec<Client> = Vec::new();
    for i in 1..=4 {
        clients.push(rig.client());
        clients[i - 1].send(news);
        while kept(&rig) < i.min(2) {
            std::thread::yield_now();
        }
    }
    let mut answered = 0;
    while answered < 4 {
        // Two at a time; the others wait for room.
        let kept = std::mem::take(&mut rig.seen.lock().unwrap().kept);
        assert!(kept.len() <= 2);
        for (reply, answer) in kept {
            reply(answer);
            answered += 1;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(clients.iter_mut().all(|client| client.answer().status == 200));
}

#[test]
fn who_takes_too_long_is_hung_up_on() {
    let rig = Rig::with(
        Limits { patience: Duration::from_millis(500), body: Duration::from_millis(20), ..LIMITS },
        Loop::Answers,
        None,
    );
    let mut clients: Vec<Client> = (0..3).map(|_| rig.client()).collect();
    clients[1].send("GET /sta");
    assert_eq!(clients[2].ask("GET /healthz HTTP/1.1\r\n\r\n").status, 200);
    assert!(clients.iter_mut().all(Client::is_closed));
    let mut client = rig.client();
    let answer = client.ask("POST / HTTP/1.1\r\nContent-Length: 50\r\n\r\n{");
    assert_eq!(answer.status, 408);
    assert!(answer.body.contains("the body did not come within 20ms"), "{}", answer.body);
    assert!(client.is_closed());
}

#[test]
fn who_never_takes_the_response_is_hung_up_on() {
    let rig = Rig::with(Limits { patience: Duration::from_millis(500), ..LIMITS }, Loop::Answers, None);
    let mut client = rig.client();
    let names = vec!["x"; 6000];
    let body = serde_json::json!({ "event-ids": names }).to_string();
    let request = format!("POST / HTTP/1.1\r\nContent-Length: {}\r\n\r\n{body}", body.len());
    client.0.get_mut().set_write_timeout(Some(Duration::from_secs(20))).unwrap();
    // Until neither side's buffers take any more, and the server hangs up.
    let error =
        std::iter::repeat_with(|| client.0.get_mut().write_all(request.as_bytes())).find_map(Result::err);
    let kind = error.unwrap().kind();
    assert!(matches!(kind, std::io::ErrorKind::ConnectionReset | std::io::ErrorKind::BrokenPipe), "{kind:?}");
}

#[test]
fn a_server_that_stops_leaves_nobody_waiting() {
    let mut rig = Rig::new();
    let mut idle = rig.client();
    assert_eq!(idle.ask("GET /healthz HTTP/1.1\r\n\r\n").status, 200);
    let mut silent = rig.client();
    rig.stop();
    assert!(idle.is_closed() && silent.is_closed());
    assert!(TcpStream::connect(rig.address).is_err());
}
