//! How often promises are found for random teams that are possible with prompt messages, and how much later such teams are done than
//! one executive that hears all at once.
//!
//! `cargo run --release -p kirk-team --example completeness [TEAMS]` takes so many possible teams of each kind.

#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "it is a program that prints a table")]

#[path = "../tests/build/mod.rs"]
mod build;
#[path = "../tests/random/mod.rs"]
mod random;

use kirk_team::{Mood, Options, Ready, Simulation, Team, Verdict, Weather, find};
use random::KINDS;

fn main() {
    let wanted: u32 = std::env::args().nth(1).map_or(200, |text| text.parse().expect("a number of teams"));
    println!("kind    possible  found     later than one executive");
    for kind in KINDS {
        let (mut possible, mut found) = (0, 0);
        let (mut team_time, mut central_time) = (0_i64, 0_i64);
        for seed in 0_u64.. {
            if possible == wanted {
                break;
            }
            let builder = random::team(kind, 2 + seed as usize % 3, 3, seed);
            let Ok(team) = builder.build() else { continue };
            match find(&team, &Options::default()).unwrap() {
                Verdict::No(_) => continue,
                Verdict::NotFound(_) => possible += 1,
                Verdict::Yes(agreement) => {
                    (possible, found) = (possible + 1, found + 1);
                    let central = central(&builder);
                    let Verdict::Yes(alone) = find(&central, &Options::default()).unwrap() else { continue };
                    team_time += time(&Ready::new(&team, &agreement).unwrap());
                    central_time += time(&Ready::new(&central, &alone).unwrap());
                }
            }
        }
        let percent = |part: f64, whole: f64| 100.0 * part / whole;
        let later = percent((team_time - central_time) as f64, central_time as f64);
        println!(
            "{:7} {possible:8}  {:4.1} %    {later:4.1} %",
            format!("{kind:?}"),
            percent(found.into(), possible.into())
        );
    }
}

/// The same mission, all done by one.
fn central(builder: &build::Builder) -> Team {
    let mut one = builder.clone();
    one.agents = vec!["all".to_string()];
    one.links.clear();
    for (_, owner) in &mut one.events {
        *owner = owner.take().map(|_| "all".to_string());
    }
    one.build().expect("what is a team is a team of one")
}

/// Until when it takes, in all, on ten days.
fn time(ready: &Ready<'_>) -> i64 {
    let day = |seed: u64| {
        let weather = Weather { delays: Mood::Random, ..Weather::default() };
        let simulation = Simulation { nature: Mood::Random, weather, seed, ..Simulation::default() };
        ready.run(&simulation).makespan.as_micros()
    };
    (0..10).map(day).sum()
}
