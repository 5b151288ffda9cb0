//! `kirk run`: compiles, proves and executes a mission, and prints its timetable.

use std::io;

use kirk_compiler::{Diagnostic, Severity, Span, too_large};
use kirk_network::Time;
use kirk_network::assume::Assumption;
use kirk_picture::Chart;
use kirk_runtime::execution::FORMAT;
use kirk_runtime::{
    Execution, Failure, NoPlan, Outcome, Plan, Reason, Simulation, Strategy, Temper, explained,
};

use crate::args::{Common, Nature, Run, ShowFormat, StrategyName};
use crate::conflict;
use crate::execute;
use crate::input::{Loaded, load_all};
use crate::json::line;
use crate::news::treatment;
use crate::observations::Observations;
use crate::output::{Status, complain, eprint, print};
use crate::report::Reporter;
use crate::show::of_input;
use crate::team;

pub(crate) fn run(arguments: &Run, common: &Common) -> io::Result<Status> {
    let mut input = load_all(&arguments.files, &arguments.selection);
    if input.team().is_some() {
        return team::simulate::run(arguments, common, input);
    }
    if arguments.links.is_some() && input.network.is_some() {
        complain("`--links` is about the links of a team, and this mission has no `define-team`");
        return Ok(Status::Wrong);
    }
    let plan = plan_of(&mut input);
    // Nothing but the execution goes to standard output, and nobody looks at notes beside JSON.
    let is_text = arguments.show.format == ShowFormat::Text;
    let reported = |diagnostic: &Diagnostic| is_text || diagnostic.severity == Severity::Error;
    let shown: Vec<Diagnostic> = input.diagnostics.iter().filter(|d| reported(d)).cloned().collect();
    Reporter::new(&input.sources).show(&shown, common)?;
    let plan = match plan {
        None => return Ok(Status::Wrong),
        Some(Err(_)) => {
            if arguments.show.format == ShowFormat::Json {
                print(&line(&not_executed(&input.program(&arguments.selection)))?)?;
            }
            return Ok(Status::No);
        }
        Some(Ok(plan)) => plan,
    };
    if common.verbose {
        eprint(&treatment(plan.network()))?;
    }
    if !arguments.simulate {
        return execute::execute(arguments, common, &input, plan);
    }
    let given = Observations::collect(
        "--observe",
        &arguments.observe,
        arguments.observations.as_deref(),
        plan.network(),
    );
    if !given.diagnostics.is_empty() {
        Reporter::new(&given.sources).show(&given.diagnostics, common)?;
        return Ok(Status::Wrong);
    }
    let simulation = Simulation {
        strategy: match arguments.strategy() {
            StrategyName::Buffer => Strategy::Buffer,
            StrategyName::Optimistic => Strategy::Optimistic,
        },
        nature: match arguments.nature {
            Nature::Upper => Temper::Upper,
            Nature::Lower => Temper::Lower,
            Nature::Random => Temper::Random,
        },
        seed: arguments.seed,
        observations: given.by_event.iter().map(|heard| (heard.event, heard.time)).collect(),
        // A picture has forms that nobody has named.
        internal: arguments.show.internal || arguments.show.format.picture().is_some(),
        what_if: arguments.what_if,
    };
    let explained = match explained(&plan, &input.program(&arguments.selection), &simulation) {
        Ok(explained) => explained,
        Err(impossible) => {
            let diagnostic = given.impossible(&impossible, plan.network(), arguments.what_if);
            Reporter::new(&given.sources).show(&[diagnostic], common)?;
            return Ok(Status::Wrong);
        }
    };
    let chart = || {
        let of_record = || Chart::of_execution(&explained.execution);
        of_input(&input, &arguments.selection).unwrap_or_else(of_record)
    };
    arguments.show.execution(&explained.execution, Some(&explained.dispatcher), chart)
}

/// It cannot be promised, and why is among the diagnostics.
pub(crate) struct Unproven;

/// Proves and compiles what was read; `None` if nothing could be.
pub(crate) fn plan_of(input: &mut Loaded) -> Option<Result<Plan, Unproven>> {
    let network = input.network.as_ref()?;
    match Plan::new(network) {
        Ok(plan) => Some(Ok(plan)),
        Err(NoPlan::TooLarge) => {
            input.diagnostics.push(too_large(Span::default()));
            None
        }
        Err(NoPlan::Uncontrollable(conflict)) => {
            let told = conflict::told(&conflict, network, input, (Assumption::AsWritten, false));
            input.diagnostics.extend(told.into_iter().map(|told| told.diagnostic));
            Some(Err(Unproven))
        }
    }
}

/// The record of a mission that was not started because it cannot be promised.
fn not_executed(program: &str) -> Execution {
    Execution {
        format: FORMAT.to_string(),
        program: program.to_string(),
        outcome: Outcome::Failed,
        failure: Some(Failure {
            event: program.to_string(),
            time: Time::ZERO,
            reason: Reason::NotControllable,
            detail: "there is no strategy that works in every case: some bounds do not go together"
                .to_string(),
        }),
        makespan: Time::ZERO,
        seed: None,
        what_if: None,
        rows: Vec::new(),
    }
}
