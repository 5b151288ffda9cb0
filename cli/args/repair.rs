//! The command lines of `kirk repair` and `kirk slack`.

use clap::{Args, ValueEnum};

use super::{Selection, TextOrJson};

#[derive(Debug, Args)]
pub(crate) struct RepairOf {
    /// The mission or network, or `-` for standard input; several files of RMPL are one program.
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<String>,
    #[command(flatten)]
    pub(crate) selection: Selection,
    /// Make proposal K: change the sources.
    #[arg(long, value_name = "K", conflicts_with = "format")]
    pub(crate) apply: Option<usize>,
    /// Print proposal 1, or that of `--apply`, as a patch and change nothing.
    #[arg(long, conflicts_with = "format")]
    pub(crate) diff: bool,
    /// Leave as it is what is called so: an activity, a label, a form, `requirements[3]`.
    #[arg(long, value_name = "NAME")]
    pub(crate) keep: Vec<String>,
    /// Change this rather than anything else.
    #[arg(long, value_enum, value_name = "WHAT")]
    pub(crate) prefer: Option<Prefer>,
    /// A change of what is called NAME is W times as dear.
    #[arg(long, value_name = "NAME=W")]
    pub(crate) weight: Vec<String>,
    /// The durations that Nature decides may change, too: a better model, or a better machine.
    #[arg(long)]
    pub(crate) nature: bool,
    /// So many proposals at most.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = limit)]
    pub(crate) limit: usize,
    /// How to print the result.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub(crate) format: TextOrJson,
}

fn limit(text: &str) -> Result<usize, String> {
    let number = text.parse().ok().filter(|number| (1..=100).contains(number));
    number.ok_or("expected a number from 1 to 100".to_string())
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Prefer {
    /// By when news is here.
    News,
    /// Bounds between events, and around forms.
    Deadlines,
    /// How long activities of ours take.
    Durations,
}

#[derive(Debug, Args)]
pub(crate) struct SlackOf {
    /// The mission or network, or `-` for standard input; several files of RMPL are one program.
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<String>,
    #[command(flatten)]
    pub(crate) selection: Selection,
    /// How to print the result.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub(crate) format: TextOrJson,
}
