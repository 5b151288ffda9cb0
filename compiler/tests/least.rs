//! What is said of random missions that cannot be executed in every case: the amounts that are enough against plain bisection of
//! the source text, and the stories against these amounts.
//!
//! `KIRK_CASES=100000 cargo test -p kirk-compiler --test least` tries as many missions as one likes.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;
#[allow(dead_code, unreachable_pub, reason = "a part of it is used, and from here only")]
#[path = "../../network/tests/oracle/random.rs"]
mod random;

use kirk_compiler::repair::Changed;
use kirk_compiler::{Explain, Source, Told};
use kirk_network::{Bound, Duration, Verdict, check, rmpl};
use random::{Random, Shape};

fn cases() -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(2_000)
}

fn told(text: &str) -> Vec<Told> {
    let plan = common::compile(text).lowered.unwrap_or_else(|| panic!("it compiles:\n{text}"));
    Explain::of(&plan, &[Source::new("mission.rmpl", text)]).each().unwrap()
}

/// True if a text means a mission that can be promised; `None` if it means none.
fn is_controllable(text: &str) -> Option<bool> {
    let plan = common::compile(text).lowered?;
    Some(check(&plan.network).unwrap() == Verdict::Controllable)
}

/// The text with another amount where a change is made.
fn with(text: &str, change: &Changed, micros: i64) -> String {
    let (start, end) = (change.place.start as usize, change.place.end as usize);
    format!("{}{}{}", &text[..start], Duration::from_micros(micros), &text[end..])
}

/// The last amount with which it is not controllable and the first with which it is, found by halving between what is
/// written and what is said.
fn bisected(text: &str, change: &Changed, (from, to): (i64, i64)) -> (i64, i64) {
    let (mut no, mut yes) = (from, to);
    while (yes - no).abs() > 1 {
        let middle = no + (yes - no) / 2;
        let is_yes = is_controllable(&with(text, change, middle)).unwrap_or(false);
        *(if is_yes { &mut yes } else { &mut no }) = middle;
    }
    (no, yes)
}

/// A mission in forms: sequences and parallels of activities, deadlines around them.
fn forms(seed: u64) -> String {
    let random = &mut Random::new(seed);
    let mut text = String::new();
    let count = random.within(2..=6);
    for activity in 0..count {
        let lower = random.within(1..=30);
        let upper = lower + random.within(0..=20);
        let news = match random.within(0..=3) {
            0 => String::new(),
            _ => format!(" :max-observation-delay {}", random.within(0..=15)),
        };
        let nature = random.percent(50);
        let (news, contingent) = if nature { (news, " :contingent t") } else { (String::new(), "") };
        text.push_str(&format!(
            "(define-control-program a{activity} () (declare (primitive) (duration (simple :lower-bound {lower} \
             :upper-bound {upper}{news}){contingent})))\n"
        ));
    }
    text.push_str("(define-control-program main () (parallel (:slack t)\n");
    for _ in 0..random.within(1..=2) {
        let calls: Vec<String> =
            (0..random.within(1..=4)).map(|_| format!("(a{})", random.within(0..=count - 1))).collect();
        let limit = random.within(10..=90);
        text.push_str(&format!(
            "  (with-temporal-constraint (simple-temporal :upper-bound {limit}) (sequence (:slack {}) {}))\n",
            if random.percent(80) { "t" } else { "nil" },
            calls.join(" ")
        ));
    }
    text + "))\n"
}

/// A mission of a random network.
fn of_network(seed: u64) -> String {
    let shapes = [Shape::tiny(), Shape::tiny_delayed(), Shape::medium()];
    rmpl::write(&random::network(seed, &shapes[(seed / 2 % 3) as usize]))
}

#[test]
fn each_amount_of_a_mission_is_where_bisection_finds_it() {
    let (mut missions, mut found, mut stories) = (0, 0, 0);
    for seed in 0..cases() {
        let text = if seed % 2 == 0 { forms(seed) } else { of_network(seed) };
        if is_controllable(&text) != Some(false) {
            continue;
        }
        missions += 1;
        let all = told(&text);
        let describe = || format!("seed {seed}, {:#?}\n{text}", all[0].diagnostic.help);
        stories += usize::from(check_stories(&all, &describe));
        // With several conflicts no change is enough for all of them.
        let [one] = &all[..] else { continue };
        let changes = one.enough.as_ref().unwrap();
        if changes.is_empty() {
            continue;
        }
        let change = Random::new(seed).choose(changes).clone();
        let Some((Bound::Finite(from), Bound::Finite(to))) = change.amounts() else { continue };
        // A shortest delay that has to follow is another edit, which is made for that one value.
        if change.edits.len() != 1 {
            continue;
        }
        let (from, to) = (from.as_micros(), to.as_micros());
        let title = change.title();
        let before = to - (to - from).signum();
        let [enough, less] = [to, before].map(|amount| is_controllable(&with(&text, &change, amount)));
        assert_eq!((enough, less), (Some(true), Some(false)), "{title}: {}", describe());
        // Halving reads the text again and again.
        if found % 4 == 0 {
            assert_eq!(bisected(&text, &change, (from, to)), (before, to), "{title}: {}", describe());
        }
        found += 1;
    }
    assert!(
        missions as u64 > cases() / 5 && found as u64 > cases() / 20,
        "{missions} missions, {found} amounts, {stories} stories of what is missing"
    );
    assert!(stories as u64 > cases() / 20, "{stories} stories");
}

/// What is said to be missing is the first change that is enough, and is the difference of the steps. True if that was said.
fn check_stories(all: &[Told], describe: &impl Fn() -> String) -> bool {
    let mut is_said = false;
    for told in all {
        let help = told.diagnostic.help.as_deref().unwrap_or_default();
        assert!(help.lines().all(|line| line.chars().count() <= 76), "{}", describe());
        let total: i64 = told.story.iter().map(|step| step.needs.as_micros()).sum();
        if !told.story.is_empty() {
            assert_eq!(total, -told.conflict.total.as_micros(), "{}", describe());
        }
        let amount = |change: &Changed| {
            let (from, to) = change.amounts()?;
            Some((to.finite()?.as_micros() - from.finite()?.as_micros()).abs())
        };
        if help.contains(" missing.") && !help.contains("this way round") {
            let first = told.enough.as_ref().and_then(|enough| amount(enough.first()?));
            assert_eq!(first, Some(total), "{}", describe());
            is_said = true;
        }
    }
    is_said
}
