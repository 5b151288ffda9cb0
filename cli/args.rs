//! The command line.

mod generate;
mod judge;
mod query;
mod repair;
mod run;
mod show;

use clap::{Args, Parser, Subcommand, ValueEnum};

pub(crate) use generate::{BoundsKind, Family, Generate, JsonOrRmpl, LinkKind, Size};
pub(crate) use judge::{Check, CheckFormat, Compile, Delays, Stage, StageFormat, Verify};
pub(crate) use query::Query;
pub(crate) use repair::{Prefer, RepairOf, SlackOf};
pub(crate) use run::{
    CompanionName, DriverEvents, DriverStarts, Links, Live, Nature, Replay, Resume, Run, ScreenWhen, Show,
    ShowFormat, StrategyName,
};
pub(crate) use show::{Picture, Pictures};

/// Compiles RMPL control programs to temporal networks with uncertainty, proves that they can always be executed (or
/// shows which lines make it impossible), and executes them.
#[derive(Debug, Parser)]
#[command(name = "kirk", version, arg_required_else_help = true)]
#[command(
    after_help = "Exit status: 0 yes (controllable, completed, verified), 1 no, 2 wrong input or command line."
)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
    #[command(flatten)]
    pub(crate) common: Common,
}

/// Options of every command.
#[derive(Clone, Debug, Args)]
pub(crate) struct Common {
    /// When to use colours in messages.
    #[arg(long, global = true, value_enum, default_value_t = Color::Auto, value_name = "WHEN")]
    pub(crate) color: Color,
    /// Say only what was asked for: no notes, no warnings.
    #[arg(short, long, global = true)]
    pub(crate) quiet: bool,
    /// Also say how the news of each contingent event is treated.
    #[arg(short, long, global = true, conflicts_with = "quiet")]
    pub(crate) verbose: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Color {
    Auto,
    Always,
    Never,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Compiles, proves and executes a mission, and prints its timetable.
    Run(Box<Run>),
    /// Goes on with a mission that was interrupted, from its journal.
    Resume(Resume),
    /// Repeats a mission from its journal, bit for bit.
    Replay(Replay),
    /// Prints all diagnostics and the verdict for each file.
    Check(Check),
    /// Prints what would make a mission controllable, each proposal proven, and makes one of them if that is wanted.
    Repair(RepairOf),
    /// Prints how much is left of a "yes": how far each bound can move, how late everything may start, how late news may be.
    Slack(SlackOf),
    /// Asks a mission, a record or the journal of a mission, running or not: when can this still happen, what does it wait for, what
    /// if that is heard then.
    Query(Query),
    /// Draws a mission, the record of an execution, or a journal.
    Show(Pictures),
    /// Prints what a mission is compiled to.
    Compile(Compile),
    /// Checks a recorded execution against a mission, independently of what executed it.
    Verify(Verify),
    /// Prints a random network of a family, for experiments and benchmarks.
    Generate(Generate),
    /// Lays out RMPL files: indentation, line breaks and blanks.
    Fmt(Fmt),
    /// Serves an editor: the Language Server Protocol on standard input and output.
    Lsp(Lsp),
    /// Explains a diagnostic code, such as K0203, or lists all codes.
    Explain(Explain),
}

/// Which program of a file is meant.
#[derive(Clone, Debug, Args)]
pub(crate) struct Selection {
    /// The package whose programs are meant; needed only when a file defines more than one.
    #[arg(short = 'P', long, value_name = "NAME")]
    pub(crate) package: Option<String>,
    /// The control program to start from [default: main].
    #[arg(long, value_name = "NAME")]
    pub(crate) entry: Option<String>,
    /// The one to start from if none is asked for.
    #[arg(skip)]
    pub(crate) otherwise: Option<String>,
}

impl Selection {
    pub(crate) fn entry(&self) -> &str {
        self.entry.as_deref().or(self.otherwise.as_deref()).unwrap_or("main")
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum TextOrJson {
    Text,
    Json,
}

#[derive(Debug, Args)]
pub(crate) struct Fmt {
    /// Files to lay out in place; `-` reads standard input and writes standard output.
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<String>,
    /// Change nothing; print the names of the files that would change, and exit with 1 if there are any.
    #[arg(long)]
    pub(crate) check: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Lsp {
    /// Speak on standard input and output, as is always done: editors like to say so.
    #[arg(long)]
    stdio: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Explain {
    /// The codes, such as K0203; without any, all codes are listed.
    #[arg(value_name = "CODE")]
    pub(crate) codes: Vec<String>,
    /// List all codes with what they are about.
    #[arg(long, conflicts_with = "codes")]
    pub(crate) list: bool,
}
