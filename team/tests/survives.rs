//! Every team that is accepted keeps every requirement in true time, whatever Nature and the links do within their bounds.
//!
//! `KIRK_CASES=100000 cargo test --release -p kirk-team --test survives` tries as many teams as one likes.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod build;
mod random;

use build::Builder;
use kirk_network::{Verdict as Central, check};
use kirk_runtime::Strategy;
use kirk_team::{
    Agreement, Mood, Options, Ready, Simulation, Team, Verdict, Weather, find, late_news, verify,
};
use random::{KINDS, Kind};

fn cases(usual: u64) -> u64 {
    std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(usual)
}

fn random_team(seed: u64) -> (Kind, Builder) {
    let kind = KINDS[seed as usize % 4];
    (kind, random::team(kind, 2 + (seed / 4) as usize % 4, 3, seed))
}

/// Twenty executions, under Nature and links at their extremes and at random.
fn simulations(seed: u64) -> impl Iterator<Item = Simulation> {
    (0..20).map(move |number: u64| {
        let mood =
            |number: u64| [Mood::Longest, Mood::Shortest, Mood::Extremes, Mood::Random][number as usize % 4];
        let (delays, lost, doubled) = (mood(number / 4), 10 * (number % 4) as u32, 5 * (number % 3) as u32);
        Simulation {
            strategy: if number.is_multiple_of(2) { Strategy::Optimistic } else { Strategy::Buffer },
            nature: mood(number),
            weather: Weather { delays, lost, doubled, partitions: Vec::new() },
            seed: seed.wrapping_mul(31).wrapping_add(number),
            ..Simulation::default()
        }
    })
}

/// What goes wrong with an agreement, if anything does.
fn violation(team: &Team, agreement: &Agreement, seed: u64) -> Option<String> {
    let ready = Ready::new(team, agreement).unwrap();
    simulations(seed).enumerate().find_map(|(number, simulation)| {
        let execution = ready.run(&simulation);
        let late = late_news(team, &execution);
        assert!(late.is_empty(), "seed {seed}, execution {number}: the links cheat: {late:?}");
        let violations = verify(team, agreement, &execution);
        let is_fine = violations.is_empty() && execution.troubles.is_empty();
        (!is_fine).then(|| format!("execution {number}: {violations:?}, {:?}", execution.troubles))
    })
}

fn judge(builder: &Builder, seed: u64) -> (Option<Verdict>, Option<String>) {
    let Ok(team) = builder.build() else { return (None, None) };
    let verdict = find(&team, &Options::default()).unwrap();
    let wrong = match &verdict {
        Verdict::Yes(agreement) => violation(&team, agreement, seed),
        _ => None,
    };
    (Some(verdict), wrong)
}

/// Leaves out requirements as long as something is still wrong.
fn made_smaller(mut builder: Builder, seed: u64) -> Builder {
    for at in (0..builder.requirements.len()).rev() {
        let mut smaller = builder.clone();
        smaller.requirements.remove(at);
        if judge(&smaller, seed).1.is_some() {
            builder = smaller;
        }
    }
    builder
}

#[test]
fn accepted_teams_keep_every_requirement_in_true_time() {
    let mut counts = [[0; 4]; 4];
    for seed in 0..cases(200) {
        let (kind, builder) = random_team(seed);
        let (verdict, wrong) = judge(&builder, seed);
        if let Some(wrong) = wrong {
            panic!("seed {seed}, {kind:?}: {wrong}\n{:#?}", made_smaller(builder, seed));
        }
        let at = match verdict {
            None => 0,
            Some(Verdict::No(_)) => 1,
            Some(Verdict::NotFound(_)) => 2,
            Some(Verdict::Yes(_)) => 3,
        };
        counts[kind as usize][at] += 1;
    }
    assert!(counts.iter().all(|count| count[3] > count.iter().sum::<i32>() / 20), "{counts:?}");
}

#[test]
fn what_one_executive_that_hears_all_cannot_do_is_never_accepted() {
    let mut told = [0; 2];
    for seed in 0..cases(200) {
        let (kind, builder) = random_team(seed);
        let Ok(team) = builder.build() else { continue };
        let can = match check(team.network()).unwrap() {
            Central::Controllable => true,
            Central::Uncontrollable(conflict) => conflict.conservative,
        };
        let accepted = matches!(find(&team, &Options::default()).unwrap(), Verdict::Yes(_));
        assert!(can || !accepted, "seed {seed}, {kind:?}");
        told[usize::from(can)] += 1;
    }
    assert!(told.iter().all(|&count| count > 10), "{told:?}");
}
