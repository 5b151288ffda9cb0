//! How late are dispatches in real time? At rest, with a journal, while news pours in at 10,000 posts a second, and while all
//! news is early and planned with, in a mission whose parts wait for one another.
//!
//! `cargo bench --bench lateness`: a mission of 500 activities, one every 10 ms, handed over to a child process that confirms
//! at once; then four rovers with 2,000 events, or as many as an argument says, faster than real time. Needs `sed`; takes a minute.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark may panic, and prints")]

mod work;

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::io::{BufRead, BufReader, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use kirk_executive::{Assignment, Driver, Ended, Happening, Http, Options, begin};
use kirk_network::{EventId, Time, json};
use kirk_runtime::nature::Nature;
use kirk_runtime::{How, Outcome, Plan, Scope, Speed, Temper, handovers};
use work::{Family, Repeaters};

const ACTIVITIES: usize = 500;
const POSTS_PER_SECOND: u64 = 10_000;
const CLIENTS: u64 = 4;

fn main() {
    println!("{ACTIVITIES} dispatches, one every 10 ms; lateness in milliseconds");
    println!("| | median | 99th percentile | most | posts a second |");
    println!("| --- | --- | --- | --- | --- |");
    for (name, journal, flood) in [
        ("at rest", false, false),
        ("with a journal", true, false),
        ("under the load of news", false, true),
        ("under the load of news, with a journal", true, true),
    ] {
        let (ended, posts) = execute(journal, flood);
        assert_eq!(ended.execution.outcome, Outcome::Completed, "{:?}", ended.execution.failure);
        let at = |percent| ended.lateness.percentile(percent).unwrap().as_micros() as f64 / 1000.0;
        println!("| {name} | {:.2} | {:.2} | {:.2} | {posts} |", at(50), at(99), at(100));
    }
    let events = std::env::args().filter_map(|argument| argument.parse().ok()).next().unwrap_or(2000);
    for (name, journal) in
        [("while all news is early", false), ("while all news is early, with a journal", true)]
    {
        let ended = early(events, journal);
        let at = |percent| ended.lateness.percentile(percent).unwrap().as_micros() as f64 / 1000.0 / SPEED;
        let outcome = ended
            .execution
            .failure
            .map_or("completed".to_string(), |failure| failure.reason.word().to_string());
        let count = ended.lateness.count();
        println!(
            "| {name} ({count} dispatches, {outcome}) | {:.2} | {:.2} | {:.2} | |",
            at(50),
            at(99),
            at(100)
        );
    }
}

/// How many times faster than real time the rovers are.
const SPEED: f64 = 100.0;

/// Four rovers who wait for one another; Nature takes the least, and whatever happens is heard as soon as it can be.
fn early(events: u32, journal: bool) -> Ended {
    let network = Repeaters::network(events);
    let plan = Plan::new(&network).unwrap();
    let handovers = handovers(plan.network(), None, Scope::All);
    let merged = plan.network().clone();
    let mission = Assignment { program: "early".into(), network, plan, handovers };
    let options = Options {
        driver: Some(Driver::Stdio(CONFIRM.into())),
        speed: Speed::try_from(SPEED).unwrap(),
        ..Options::default()
    };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("journal");
    let ready =
        begin(mission, options, journal.then_some(file.as_path()), std::sync::mpsc::channel().0).unwrap();
    let desk = ready.desk();
    let mut happenings = desk.listen();
    let nature = std::thread::spawn(move || {
        let mut nature = Nature::new(&merged, Temper::Lower, 0, &[]);
        let mut coming: BinaryHeap<Reverse<(Time, EventId)>> = BinaryHeap::new();
        loop {
            match happenings.try_recv().map(|happening| (*happening).clone()) {
                Ok(Happening::Over { .. }) => return,
                Ok(Happening::Fixed { rows, .. }) => {
                    for row in rows.iter().filter(|row| row.how == How::Dispatched) {
                        let (event, time) = (merged.find(&row.event).unwrap(), row.time.unwrap());
                        let deeds = nature.begin(event, time).unwrap();
                        coming.extend(
                            deeds.into_iter().filter_map(|deed| Some(Reverse((deed.observed?, deed.event)))),
                        );
                    }
                    continue;
                }
                Ok(_) => continue,
                Err(_) => {}
            }
            while let Some(Reverse((_, event))) =
                coming.peek().copied().filter(|Reverse((at, _))| *at <= desk.clock().now())
            {
                coming.pop();
                desk.observe(vec![merged.id(event).to_string()], Box::new(|_| {}));
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    });
    let ended = ready.run(false);
    nature.join().unwrap();
    ended
}

/// Confirms at once whatever is handed over.
const CONFIRM: &str = r#"sed -u -n 's/.*"id":"\([^"]*\)".*/{"executed": "\1"}/p'"#;

/// One after the other; each has a contingent event beside it, so that there is news of use.
fn network() -> String {
    let mut events = vec!["\"z\"".to_string()];
    let (mut requirements, mut contingents) = (Vec::new(), Vec::new());
    for n in 0..ACTIVITIES {
        events.extend([format!("\"a{n}:start\""), format!("\"a{n}:end\"")]);
        let before = if n == 0 { "z".to_string() } else { format!("a{}:start", n - 1) };
        requirements.push(format!(r#"{{"from":"{before}","to":"a{n}:start","lower":0.01,"upper":0.5}}"#));
        contingents.push(format!(
            r#"{{"from":"a{n}:start","to":"a{n}:end","lower":0,"upper":60,"delay":[0,null]}}"#
        ));
    }
    format!(
        r#"{{"format":"kirk-network/1","origin":"z","events":[{}],"requirements":[{}],"contingents":[{}]}}"#,
        events.join(","),
        requirements.join(","),
        contingents.join(",")
    )
}

fn execute(journal: bool, flood: bool) -> (Ended, u64) {
    let network = json::read(&network()).unwrap();
    let plan = Plan::new(&network).unwrap();
    let handovers = handovers(plan.network(), None, Scope::Starts);
    let mission = Assignment { program: "lateness".into(), network, plan, handovers };
    let options = Options {
        driver: Some(Driver::Stdio(CONFIRM.into())),
        http: Some(Http { bind: "127.0.0.1".into(), port: 0, token_file: None }),
        ..Options::default()
    };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("journal");
    let ready =
        begin(mission, options, journal.then_some(file.as_path()), std::sync::mpsc::channel().0).unwrap();
    let address = ready.address().unwrap();
    let (stop, posts) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicU64::new(0)));
    let started = Instant::now();
    let clients: Vec<_> = (0..if flood { CLIENTS } else { 0 })
        .map(|client| {
            let (stop, posts) = (Arc::clone(&stop), Arc::clone(&posts));
            std::thread::spawn(move || pour(address, client, &stop, &posts))
        })
        .collect();
    // What comes after the last dispatch only waits for events that need not be heard.
    let desk = ready.desk();
    std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(10 * ACTIVITIES as u64 + 1000));
        let names = (0..ACTIVITIES).map(|n| format!("a{n}:end")).collect();
        desk.observe(names, Box::new(|_| {}));
    });
    let ended = ready.run(false);
    let took = started.elapsed();
    stop.store(true, Ordering::Relaxed);
    clients.into_iter().for_each(|client| client.join().unwrap());
    (ended, (posts.load(Ordering::Relaxed) as f64 / took.as_secs_f64()) as u64)
}

/// Posts news of every kind, a batch every 10 ms.
fn pour(address: SocketAddr, client: u64, stop: &AtomicBool, posts: &AtomicU64) {
    let batch = POSTS_PER_SECOND / CLIENTS / 100;
    let Ok(stream) = TcpStream::connect(address) else { return };
    stream.set_nodelay(true).unwrap();
    let (mut reader, mut writer) = (BufReader::new(stream.try_clone().unwrap()), stream);
    let mut next = Instant::now();
    let mut n = client;
    while !stop.load(Ordering::Relaxed) {
        for _ in 0..batch {
            n += 1;
            let body = match n % 4 {
                0 => r#"{"event-ids": ["nobody:end"]}"#.to_string(),
                1 => "{\"event-ids\": nonsense".to_string(),
                2 => r#"{"event-ids": ["a0:start"]}"#.to_string(),
                // Of use the first time, after that repeated; before its start, impossible.
                _ => format!(r#"{{"event-ids": ["+A{}::END+"]}}"#, n / 40 % ACTIVITIES as u64),
            };
            let length = body.len();
            let request =
                format!("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: {length}\r\n\r\n{body}");
            // The mission may be over.
            if writer.write_all(request.as_bytes()).is_err() {
                return;
            }
        }
        for _ in 0..batch {
            if !skip_response(&mut reader) {
                return;
            }
            posts.fetch_add(1, Ordering::Relaxed);
        }
        next += Duration::from_millis(10);
        std::thread::sleep(next.saturating_duration_since(Instant::now()));
    }
}

fn skip_response(reader: &mut impl BufRead) -> bool {
    let mut length = 0;
    let mut line = String::new();
    loop {
        line.clear();
        match reader.read_line(&mut line) {
            Ok(read) if read > 0 => {}
            _ => return false,
        }
        if line == "\r\n" {
            let mut body = vec![0; length];
            return reader.read_exact(&mut body).is_ok();
        }
        if let Some(value) = line.to_lowercase().strip_prefix("content-length:") {
            length = value.trim().parse().unwrap_or(0);
        }
    }
}
