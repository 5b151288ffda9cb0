//! How long does it take to go on with a mission from its journal? Four rovers who wait for one another, with news that
//! comes early and is planned with; the process dies after one plan, a quarter, a half and all of it.
//!
//! `cargo bench --bench resume`; with a number as argument, a mission of about so many events (2,000).

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark may panic, and prints")]

mod work;

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::time::Instant;

use kirk_network::{Duration, EventId, Time};
use kirk_runtime::journal::{Clocks, Line, Record, Start, read, write};
use kirk_runtime::nature::Nature;
use kirk_runtime::{
    Executive, Input, Output, Patience, Plan, Settings, Setup, Speed, Temper, recover, replay,
};
use serde_json::value::RawValue;
use work::{Family, Repeaters};

fn main() {
    let events = std::env::args().filter_map(|argument| argument.parse().ok()).next().unwrap_or(2000);
    let lines = journal(events);
    let plans = |lines: &[String]| lines.iter().filter(|line| line.contains(r#""rebuilt""#)).count();
    let first = lines.iter().position(|line| line.contains(r#""rebuilt""#)).unwrap() + 1;
    println!("{events} events; milliseconds");
    println!("| plans made | lines | bytes | reading | recovering | repeating |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for part in [first, lines.len() / 4, lines.len() / 2, lines.len()] {
        let lines = &lines[..part];
        let text = lines.concat();
        let (journal, reading) = timed(|| read(text.as_bytes()).unwrap());
        let (recovered, recovering) = timed(|| recover(&journal).unwrap());
        let (replayed, repeating) = timed(|| replay(&journal, |_, _, _| {}).unwrap());
        assert_eq!(format!("{recovered:?}"), format!("{replayed:?}"));
        let (plans, bytes) = (plans(lines), text.len());
        println!("| {plans} | {part} | {bytes} | {reading:.1} | {recovering:.1} | {repeating:.1} |");
    }
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begun = Instant::now();
    let result = work();
    (result, begun.elapsed().as_secs_f64() * 1000.0)
}

/// The lines of the journal of a mission in which all news comes as early as it can.
fn journal(events: u32) -> Vec<String> {
    let network = Repeaters::network(events);
    let plan = Plan::new(&network).unwrap();
    let patience = Patience { first: Duration::from_secs(1), most: Duration::from_secs(1) };
    let settings = Settings::default();
    let (program, run) = ("resume".to_string(), "run".to_string());
    let setup = Setup { program, run, settings, handovers: Vec::new(), driver: false, patience };
    let shell = RawValue::from_string("null".to_string()).unwrap();
    let clocks = Clocks { boot: None, since_boot: 0, calendar: 0 };
    let start = Record::Start(Box::new(Start::new(&network, &setup, Speed::REAL, clocks, shell, "bench")));
    let (mut lines, mut checksum) = (Vec::new(), 0);
    let mut record = |at: Time, record: Record| {
        let (line, next) = write(&Line::new(at, record), checksum);
        lines.push(line);
        checksum = next;
    };
    record(Time::ZERO, start);
    let merged = plan.network().clone();
    let mut nature = Nature::new(&merged, Temper::Lower, 0, &[]);
    let mut executive = Executive::new(plan, setup);
    let mut happens = |executive: &mut Executive, at: Time, input: Input| {
        if let Some(input) = executive.handle(at, input).record {
            record(at, Record::In(input));
        }
    };
    let mut news: BinaryHeap<Reverse<(Time, EventId)>> = BinaryHeap::new();
    let mut now = Time::ZERO;
    while !executive.is_over() {
        while let Some(output) = executive.poll_output() {
            if let Output::Fixed { event, .. } = output
                && merged.link_of(event).is_none()
            {
                let at = executive.dispatcher().known(event).fixed.unwrap().time;
                for deed in nature.begin(event, at).unwrap() {
                    news.extend(deed.observed.map(|time| Reverse((time, deed.event))));
                }
            }
        }
        if let Some(rebuild) = executive.poll_rebuild(now) {
            happens(&mut executive, now, Input::rebuilt(rebuild.run()));
            continue;
        }
        let timeout = executive.poll_timeout();
        match news.peek() {
            Some(&Reverse((time, event))) if timeout.is_none_or(|timeout| time <= timeout) => {
                news.pop();
                now = now.max(time);
                happens(&mut executive, time, Input::observed(&merged, event));
            }
            _ => {
                now = timeout.unwrap();
                happens(&mut executive, now, Input::Timeout {});
            }
        }
    }
    lines
}
