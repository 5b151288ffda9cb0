//! From RMPL to a proof to an execution, stepped by hand: `cargo run --example stepped`.
//!
//! What a robot's own software would do that embeds kirk: compile a mission, refuse it with reasons if it cannot be promised,
//! then ask what to do and when, and tell what it hears.

#![allow(clippy::print_stdout, reason = "an example shows what it does")]

use kirk::{Dispatcher, Explain, NoPlan, Options, Plan, Settings, Source, Strategy, Time, compile};

fn main() -> Result<(), String> {
    let text = include_str!("rmpl/robot.rmpl");
    let sources = [Source::new("robot.rmpl", text)];
    let compilation = compile(&sources, &Options::default());
    let Some(mission) = compilation.lowered else {
        return Err(compilation.diagnostics.iter().map(|problem| format!("{}\n", problem.message)).collect());
    };
    let plan = match Plan::new(&mission.network) {
        Ok(plan) => plan,
        Err(NoPlan::Uncontrollable(conflict)) => {
            return Err(Explain::of(&mission, &sources).one(&conflict).diagnostic.message);
        }
        Err(NoPlan::TooLarge) => return Err("the durations add up to too much".to_string()),
    };

    // The world, as scripted here: two pieces of news and when they arrive.
    let news = [("human-downlink-science:end", 22), ("robot-drilling:end", 46)];
    let mut news = news.map(|(name, seconds)| (plan.network().find(name), seconds)).into_iter().peekable();

    let mut dispatcher = Dispatcher::new(plan.clone(), Settings::of(Strategy::Optimistic));
    let mut now = Time::ZERO;
    while !dispatcher.is_over() {
        while let Some((Some(event), _)) = news.next_if(|&(_, seconds)| at(seconds) <= now) {
            println!("{now:>4} s  heard:   {}", dispatcher.network().label(event));
            dispatcher.handle_observation(now, event);
        }
        // News that says more than the plan assumed is planned with; that may as well be done elsewhere.
        while let Some(rebuild) = dispatcher.poll_rebuild(now) {
            dispatcher.handle_rebuilt(rebuild.run());
        }
        dispatcher.handle_timeout(now);
        while let Some(dispatch) = dispatcher.poll_dispatch() {
            println!(
                "{:>4} s  execute: {}",
                dispatch.time.to_string(),
                dispatcher.network().label(dispatch.event)
            );
        }
        // Until the next decision, or the next piece of news, there is nothing to do.
        let heard = news.peek().map(|&(_, seconds)| at(seconds));
        match dispatcher.poll_timeout().into_iter().chain(heard).min() {
            Some(next) => now = next.max(now),
            None => break,
        }
    }
    Ok(())
}

fn at(seconds: i64) -> Time {
    Time::from_micros(seconds * 1_000_000)
}
