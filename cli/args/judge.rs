//! The command lines of `kirk check`, `kirk compile` and `kirk verify`.

use clap::{Args, ValueEnum};

use super::{Selection, TextOrJson};

#[derive(Debug, Args)]
pub(crate) struct Check {
    /// Missions or networks, or `-` for standard input.
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<String>,
    /// Take all files as one program, as `run` and `compile` do, and not each by itself.
    #[arg(long)]
    pub(crate) together: bool,
    #[command(flatten)]
    pub(crate) selection: Selection,
    /// What to assume about the delays of news, instead of what is written.
    #[arg(long, value_enum, default_value_t = Delays::AsWritten, value_name = "WHAT")]
    pub(crate) delays: Delays,
    /// Also say what a conflict is in the theory: the signed amounts along the way, and their sum.
    #[arg(long)]
    pub(crate) theory: bool,
    /// How to print the result; short is `FILE:LINE:COLUMN: KIND: MESSAGE` for every place a message is about, JSON is one
    /// document per file, one per line, SARIF is one log of all files.
    #[arg(long, value_enum, default_value_t = CheckFormat::Text)]
    pub(crate) format: CheckFormat,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CheckFormat {
    Text,
    Short,
    Json,
    Sarif,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Delays {
    /// The delays of the mission (variable-delay controllability).
    AsWritten,
    /// All news comes at once (dynamic controllability).
    Zero,
    /// News is always as early as it can be (fixed-delay controllability).
    Minimum,
    /// News is always late by the mean of its bounds (fixed-delay controllability).
    Mean,
    /// News is always as late as it can be (fixed-delay controllability).
    Maximum,
    /// No news ever comes (strong controllability).
    Never,
    /// Duration and delay are one uncertainty, known only from the news.
    Elongated,
}

#[derive(Debug, Args)]
pub(crate) struct Compile {
    /// The mission or network, or `-` for standard input; several files of RMPL are one program.
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<String>,
    #[command(flatten)]
    pub(crate) selection: Selection,
    /// Of a team's mission: what this agent executes.
    #[arg(long, value_name = "NAME")]
    pub(crate) agent: Option<String>,
    /// Which stage to print.
    #[arg(long, value_enum, default_value_t = Stage::Stnu, value_name = "WHAT")]
    pub(crate) emit: Stage,
    /// How to print it.
    #[arg(long, value_enum, default_value_t = StageFormat::Text)]
    pub(crate) format: StageFormat,
    /// Where to write it, instead of standard output.
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Stage {
    /// The program as read.
    Ast,
    /// The program unfolded: every occurrence with its events and bounds.
    Episodes,
    /// The merged delay STNU.
    Stnu,
    /// The plain STNU after the delay reduction.
    Reduced,
    /// The network that is executed.
    Dispatchable,
    /// The network as a program, such as what one agent of a team executes.
    Rmpl,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum StageFormat {
    Text,
    Json,
    Sexpr,
    Dot,
    Graphml,
}

#[derive(Debug, Args)]
pub(crate) struct Verify {
    /// The recorded execution (`kirk run --format json`).
    #[arg(value_name = "EXECUTION")]
    pub(crate) execution: String,
    /// The mission or network it is checked against; several files of RMPL are one program.
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<String>,
    /// The package whose programs are meant; needed only when a file defines more than one.
    #[arg(short = 'P', long, value_name = "NAME")]
    pub(crate) package: Option<String>,
    /// The control program that was executed, if not the one the record names.
    #[arg(long, value_name = "NAME")]
    pub(crate) entry: Option<String>,
    /// How to print the result.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub(crate) format: TextOrJson,
}
