//! Random teams from seeds, of four kinds: work handed on, free ties, tight ties, many ties.
//!
//! A nominal schedule is drawn first, and requirements leave some slack around it.

#![allow(dead_code, reason = "each test uses what it needs")]
#![allow(unreachable_pub, reason = "it is a module of several tests")]

use fastrand::Rng;
use kirk_network::EventId;

use super::build::{Builder, NEVER, ORIGIN};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Flow,
    Free,
    Tight,
    Dense,
}

pub const KINDS: [Kind; 4] = [Kind::Flow, Kind::Free, Kind::Tight, Kind::Dense];

/// An event with its owner and nominal time.
#[derive(Clone, Copy, Debug)]
struct Placed {
    event: EventId,
    agent: usize,
    at: i64,
    is_ours: bool,
}

/// So many agents with so many activities each at the most.
pub fn team(kind: Kind, agents: usize, most: usize, seed: u64) -> Builder {
    let mut r = Rng::with_seed(seed);
    let names: Vec<String> = (0..agents).map(|agent| format!("a{agent}")).collect();
    let mut b = Builder::new(&names.iter().map(String::as_str).collect::<Vec<_>>());
    link(&mut b, &mut r, &names);
    let mut placed: Vec<Placed> = Vec::new();
    for agent in 0..agents {
        let mut last = Placed { event: ORIGIN, agent, at: 0, is_ours: true };
        for activity in 0..r.usize(1..=most) {
            let at = last.at + r.i64(0..=6);
            let name = |what: &str| format!("{what}.{agent}.{activity}");
            let start = Placed { event: b.event(&name("start"), &names[agent]), at, ..last };
            let start = Placed { is_ours: true, ..start };
            let least = if last.is_ours || r.bool() { r.i64(0..=at - last.at) } else { 0 };
            let most = if r.u32(0..3) == 0 { at - last.at + r.i64(3..=12) } else { NEVER };
            b.require(last.event, start.event, [least, most]);
            placed.push(start);
            last = end(&mut b, &mut r, &names, start, &name("end"));
            placed.push(last);
        }
        if r.u32(0..10) == 0 {
            let range = [r.i64(0..=5), r.i64(6..=10)];
            let event =
                b.contingent(&format!("nature.{agent}"), &names[agent], ORIGIN, range, [0, r.i64(0..=2)]);
            placed.push(Placed { event, agent, at: 6, is_ours: false });
        }
    }
    tie(&mut b, &mut r, kind, &placed);
    if r.u32(0..10) < 7 {
        let horizon = placed.iter().map(|it| it.at).max().unwrap_or(0) + r.i64(10..=40);
        for it in placed.iter().filter(|it| it.is_ours) {
            b.require(ORIGIN, it.event, [0, horizon]);
        }
    }
    b
}

/// The end of an activity: Nature's, or ours, sometimes seen by another first.
fn end(b: &mut Builder, r: &mut Rng, names: &[String], start: Placed, name: &str) -> Placed {
    let (lower, wide) = (r.i64(0..=5), r.i64(0..=8));
    let at = start.at + lower + wide / 2;
    if r.u32(0..10) < 6 {
        let agent = if r.u32(0..8) == 0 { r.usize(0..names.len()) } else { start.agent };
        let early = r.i64(0..=2);
        let delay = match r.u32(0..20) {
            0..10 => [0, 0],
            10..17 => [early, early + r.i64(0..=3)],
            17..19 => [early, early],
            _ => [early, NEVER],
        };
        let event = b.contingent(name, &names[agent], start.event, [lower, lower + wide], delay);
        return Placed { event, agent: start.agent, at, is_ours: false };
    }
    let event = b.event(name, &names[start.agent]);
    b.require(start.event, event, [lower, if r.bool() { lower + wide } else { NEVER }]);
    Placed { event, at, ..start }
}

/// Ties across agents.
fn tie(b: &mut Builder, r: &mut Rng, kind: Kind, placed: &[Placed]) {
    let count = match kind {
        Kind::Flow => placed.len().div_ceil(3),
        Kind::Free => placed.len().div_ceil(2),
        Kind::Tight => placed.len().div_ceil(3),
        Kind::Dense => 2 * placed.len(),
    };
    for _ in 0..count {
        let (from, to) = (placed[r.usize(0..placed.len())], placed[r.usize(0..placed.len())]);
        if from.event == to.event || !from.is_ours && !to.is_ours || from.agent == to.agent {
            continue;
        }
        let between = to.at - from.at;
        match kind {
            Kind::Flow => {
                let (first, then) = if from.at <= to.at && to.is_ours { (from, to) } else { (to, from) };
                if then.is_ours && first.at <= then.at {
                    let most = if r.u32(0..3) == 0 { then.at - first.at + r.i64(8..=25) } else { NEVER };
                    b.require(first.event, then.event, [r.i64(0..=1), most]);
                }
            }
            Kind::Tight => b.require(from.event, to.event, [between - r.i64(1..=7), between + r.i64(1..=7)]),
            Kind::Free | Kind::Dense => {
                let same = between == 0 && from.is_ours && to.is_ours && r.u32(0..3) == 0;
                let (before, after) = (r.i64(3..=18), r.i64(3..=18));
                let range = if same { [0, 0] } else { [between - before, between + after] };
                b.require(from.event, to.event, range);
            }
        }
    }
}

/// Every agent has a link to one before it, some more than one.
fn link(b: &mut Builder, r: &mut Rng, names: &[String]) {
    for to in 1..names.len() {
        for from in 0..to {
            let is_needed = from == to - 1;
            if !is_needed && r.u32(0..3) > 0 {
                continue;
            }
            let least = r.i64(0..=2);
            let most = if r.u32(0..12) == 0 && !is_needed { NEVER } else { least + r.i64(0..=3) };
            let is_stamped = r.u32(0..8) == 0;
            let [one, other] = if r.bool() { [from, to] } else { [to, from] };
            let one_way = !is_needed && r.u32(0..6) == 0;
            b.link(&names[one], &names[other], [least, most], one_way).stamped = is_stamped;
        }
    }
}
