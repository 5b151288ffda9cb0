//! Missions of teams as they are written: what joins agents in the language is joined in the team, too, and no more.
//!
//! `KIRK_CASES=100000 cargo test --release -p kirk-team --test missions` tries as many as one likes.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use std::collections::BTreeMap;
use std::fmt::Write;

use fastrand::Rng;
use kirk_compiler::{Code, Lowered, Severity, Source, compile};
use kirk_network::{EventId, Network};
use kirk_team::mission::judge;
use kirk_team::{Mission, Mood, Options, Ready, Record, Simulation, Verdict, Weather, verify};

const AGENTS: [&str; 3] = ["one", "two", "three"];

fn cases() -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(400)
}

/// A random mission of two or three agents, as text.
struct Writer {
    random: Rng,
    agents: usize,
    labels: usize,
    programs: String,
}

impl Writer {
    fn mission(seed: u64) -> String {
        let mut random = Rng::with_seed(seed);
        let agents = random.usize(2..=3);
        let mut writer = Writer { random, agents, labels: 0, programs: String::new() };
        let body = writer.form(3);
        let limit = writer.random.u32(60..400);
        let mut text = "(define-team crew".to_string();
        AGENTS[..agents].iter().for_each(|agent| write!(text, " (agent {agent})").unwrap());
        for to in 1..agents {
            let (min, more) = (writer.random.u32(0..6), writer.random.u32(0..8));
            let stamped = if writer.random.u32(0..6) == 0 { " :stamped t" } else { "" };
            let from = AGENTS[writer.random.usize(0..to)];
            write!(
                text,
                "\n  (link {from} {} :min-delay {min} :max-delay {}{stamped})",
                AGENTS[to],
                min + more
            )
            .unwrap();
        }
        text.push_str(")\n");
        text.push_str(&writer.programs);
        write!(text, "(define-control-program main ()\n  (with-temporal-constraint (simple-temporal :upper-bound {limit}) {body})")
            .unwrap();
        for _ in 0..writer.random.usize(0..4) {
            let label = |random: &mut Rng, labels: usize| format!("l{}", random.usize(0..labels));
            let (from, to) =
                (label(&mut writer.random, writer.labels), label(&mut writer.random, writer.labels));
            let (low, more) = (writer.random.u32(0..10), writer.random.u32(5..60));
            if from != to {
                let bounds = match writer.random.u32(0..3) {
                    0 => format!(":lower-bound {low}"),
                    1 => format!(":upper-bound {}", low + more),
                    _ => format!(":lower-bound {low} :upper-bound {}", low + more),
                };
                write!(text, "\n  (between (end {from}) (start {to}) (simple-temporal {bounds}))").unwrap();
            }
        }
        text + ")\n"
    }

    fn agent(&mut self) -> &'static str {
        AGENTS[self.random.usize(0..self.agents)]
    }

    fn form(&mut self, depth: u32) -> String {
        let choice = if depth == 0 { 0 } else { self.random.u32(0..6) };
        match choice {
            0 | 1 => self.activity(),
            2 | 3 => self.group("sequence (:slack t)", depth),
            4 => self.group("parallel (:slack t)", depth),
            // Without slack, most often by one.
            _ => {
                let group = self.group("sequence ()", depth);
                format!("(with-agent {} {group})", self.agent())
            }
        }
    }

    fn group(&mut self, operator: &str, depth: u32) -> String {
        let parts: Vec<String> =
            (0..self.random.usize(1..=3)).map(|_| self.form(depth.saturating_sub(1))).collect();
        let wait = if self.random.u32(0..4) == 0 { " (delay 1 3)" } else { "" };
        format!("({operator} {}{wait})", parts.join(" "))
    }

    fn activity(&mut self) -> String {
        let number = self.labels;
        self.labels += 1;
        let (low, more) = (self.random.u32(0..10), self.random.u32(0..15));
        let nature = if self.random.bool() {
            let observer = if self.random.u32(0..4) == 0 {
                format!(" :observed-by {}", self.agent())
            } else {
                String::new()
            };
            format!(" :contingent t{observer}")
        } else {
            String::new()
        };
        let is_given = self.random.bool();
        let agent = if is_given { "(agent who)" } else { "" };
        writeln!(
            self.programs,
            "(define-control-program p{number} (who) (declare (primitive) (ignorable who) {agent} (duration (simple :lower-bound \
             {low} :upper-bound {}){nature})))",
            low + more
        )
        .unwrap();
        let call = format!("(label l{number} (p{number} {}))", self.agent());
        if is_given { call } else { format!("(with-agent {} {call})", self.agent()) }
    }
}

/// By two events the most that the second comes after the first.
fn edges(network: &Network) -> BTreeMap<(EventId, EventId), i64> {
    let mut edges = BTreeMap::new();
    for (from, to, most) in network.requirements().iter().flat_map(|it| it.edges()).flatten() {
        let known: &mut i64 = edges.entry((from, to)).or_insert(i64::MAX);
        *known = most.as_micros().min(*known);
    }
    edges
}

fn compiled(text: &str) -> Result<Lowered, Vec<Code>> {
    let compilation = compile(&[Source::new("team.rmpl", text)], &kirk_compiler::Options::default());
    let errors = compilation.diagnostics.iter().filter(|it| it.severity == Severity::Error);
    let errors: Vec<Code> = errors.map(|it| it.code).collect();
    compilation.lowered.filter(|_| errors.is_empty()).ok_or(errors)
}

/// Executions with all that can be random in them.
fn keeps_all(mission: &Mission, seed: u64) {
    let agreement = mission.agreement().unwrap();
    for agent in mission.team.agent_ids() {
        let (view, raw) = (mission.view(agent).unwrap(), &agreement.views[agent.index()].network);
        assert_eq!(edges(&view), edges(raw), "seed {seed}: a view says the same in fewer requirements");
    }
    let ready = Ready::new(&mission.team, agreement).unwrap();
    for number in 0..8_usize {
        let mood = |number: usize| [Mood::Longest, Mood::Shortest, Mood::Extremes, Mood::Random][number % 4];
        let weather = Weather { delays: mood(number / 2), lost: 20, doubled: 20, partitions: Vec::new() };
        let simulation =
            Simulation { nature: mood(number), weather, seed: seed ^ number as u64, ..Simulation::default() };
        let execution = ready.run(&simulation);
        assert_eq!(execution.troubles, [], "seed {seed}");
        assert_eq!(verify(&mission.team, agreement, &execution), [], "seed {seed}");
        for internal in [false, true] {
            let record = Record::new(("main", "crew"), &mission.team, &execution, seed, internal);
            assert_eq!(record.violations(&mission.team), [], "seed {seed}");
        }
    }
}

#[test]
fn a_team_that_is_written_keeps_what_is_written() {
    let (mut yes, mut no, mut refused) = (0, 0, 0);
    for seed in 0..cases() {
        let text = Writer::mission(seed);
        let lowered = match compiled(&text) {
            Ok(lowered) => lowered,
            Err(errors) => {
                // The only thing that can be wrong with them.
                assert!(
                    errors.iter().all(|code| *code == Code::NotTheSameMoment),
                    "seed {seed}: {errors:?}\n{text}"
                );
                refused += 1;
                continue;
            }
        };
        let written = lowered.team.as_ref().unwrap();
        let mission = judge(written, &lowered.network, &lowered.origins, &Options::default());
        // What does not make a team the compiler has told.
        let mission = mission.unwrap_or_else(|why| panic!("seed {seed}: {why:?}\n{text}"));
        match &mission.verdict {
            Verdict::Yes(_) => {
                yes += 1;
                keeps_all(&mission, seed);
            }
            Verdict::No(_) | Verdict::NotFound(_) => no += 1,
        }
    }
    assert!(yes > cases() / 5 && no > cases() / 20 && refused > 0, "{yes} {no} {refused}");
}
