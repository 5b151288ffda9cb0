//! Pictures.

use clap::{Args, ValueEnum};

use super::Selection;

#[derive(Debug, Args)]
pub(crate) struct Pictures {
    /// The mission or network, the record of an execution (with its mission after it, if that is at hand), or a journal; `-` for
    /// standard input.
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<String>,
    #[command(flatten)]
    pub(crate) selection: Selection,
    /// Where to put the picture, instead of standard output: .svg, .html or .mmd.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<String>,
    /// What to draw [default: what the name of the file says, else svg].
    #[arg(long, value_enum)]
    pub(crate) format: Option<Picture>,
    /// The time of day at which the mission starts: times of the picture are those of the clock.
    #[arg(long, value_name = "HH:MM")]
    pub(crate) start: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Picture {
    /// A picture.
    Svg,
    /// A page of its own, to zoom and filter, and to go through what was known when.
    Html,
    /// A Gantt chart of Mermaid, for pages that draw these.
    Mermaid,
}
