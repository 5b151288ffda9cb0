//! The `kirk` binary: arguments, files, colours and exit statuses. Everything else is in the libraries.
//!
//! Exit status: 0 yes (controllable, completed, verified), 1 no, 2 the input or the command line is wrong.

mod aftermath;
mod args;
mod check;
mod compile;
mod conflict;
mod elsewhere;
mod execute;
mod explain;
mod fmt;
mod foreign;
mod generate;
mod input;
mod json;
mod judge;
mod live;
mod lsp;
mod news;
mod observations;
mod output;
mod query;
mod repair;
mod replace;
mod replay;
mod report;
mod run;
mod sarif;
mod show;
mod slack;
mod table;
mod team;
mod timetable;
mod verify;
mod watch;
mod why;
mod wording;

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command};
use output::Status;

fn main() -> ExitCode {
    // Deeply nested programs make deep (bounded) trees; the main thread's stack is not ours to size.
    const STACK: usize = 256 << 20;
    let arguments = Arguments::parse();
    let work = std::thread::Builder::new().stack_size(STACK).spawn(move || execute(&arguments));
    match work.map(std::thread::JoinHandle::join) {
        Ok(Ok(status)) => ExitCode::from(status as u8),
        Ok(Err(_)) => ExitCode::from(101),
        Err(_) => ExitCode::from(Status::Wrong as u8),
    }
}

fn execute(arguments: &Arguments) -> Status {
    let result = match &arguments.command {
        Command::Run(run) => run::run(run, &arguments.common),
        Command::Resume(resume) => execute::resume(resume, &arguments.common),
        Command::Replay(replay) => replay::replay(replay, &arguments.common),
        Command::Check(check) => check::check(check, &arguments.common),
        Command::Repair(repair) => repair::repair_of(repair, &arguments.common),
        Command::Slack(slack) => slack::slack_of(slack, &arguments.common),
        Command::Query(query) => query::query(query, &arguments.common),
        Command::Show(pictures) => show::show(pictures, &arguments.common),
        Command::Compile(compile) => compile::compile(compile, &arguments.common),
        Command::Verify(verify) => verify::verify(verify, &arguments.common),
        Command::Generate(generate) => generate::generate(generate, &arguments.common),
        Command::Fmt(fmt) => fmt::fmt(fmt, &arguments.common),
        Command::Lsp(_) => Ok(lsp::lsp()),
        Command::Explain(explain) => explain::explain(explain),
    };
    match result {
        Ok(status) => status,
        // Whoever read our output has gone away; there is nobody left to tell.
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Status::Yes,
        Err(error) => {
            output::complain(&format!("cannot write the output: {error}"));
            Status::Wrong
        }
    }
}
