//! The command line of `kirk generate`.

use clap::{Args, Subcommand, ValueEnum};

#[derive(Debug, Args)]
pub(crate) struct Generate {
    #[command(subcommand)]
    pub(crate) family: Family,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Family {
    /// Rovers that set up radio repeaters and wait for one another's tests.
    Repeaters {
        #[command(flatten)]
        size: Size,
        /// How late the confirmation of a test may be: exponentially distributed, so many seconds on average.
        #[arg(long, default_value_t = 3.0, value_name = "SECONDS")]
        lambda: f64,
        /// Who decides how long cleaning up after a test takes.
        #[arg(long, value_enum, default_value_t = LinkKind::Requirement, value_name = "KIND")]
        clean_up: LinkKind,
        /// Clean up after the last repeater as well.
        #[arg(long)]
        clean_up_at_end: bool,
        /// For how many activities more than there are tasks the consumables last.
        #[arg(long, default_value_t = 0, value_name = "N")]
        spare: u32,
        /// What bounds are drawn from.
        #[arg(long, value_enum, default_value_t = BoundsKind::Tables, value_name = "KIND")]
        bounds: BoundsKind,
    },
    /// Astronauts who sample rocks with the advice of scientists on Earth.
    Sampling {
        #[command(flatten)]
        size: Size,
        /// How late data and messages may be: exponentially distributed, so many seconds on average.
        #[arg(long, default_value_t = 2.0, value_name = "SECONDS")]
        lambda: f64,
        /// Who decides how long the way to the next site takes.
        #[arg(long, value_enum, default_value_t = LinkKind::Contingent, value_name = "KIND")]
        traverse: LinkKind,
    },
    /// Parallel lanes of tasks, in the manner of the random STNU benchmarks.
    Lanes {
        #[command(flatten)]
        size: Size,
        /// How many of 100 tasks are contingent.
        #[arg(long, default_value_t = 20, value_name = "PERCENT")]
        links: u32,
        /// How many of 100 events are tied to another lane.
        #[arg(long, default_value_t = 33, value_name = "PERCENT")]
        cross: u32,
        /// The most seconds such a tie leaves on either side.
        #[arg(long, default_value_t = 40, value_name = "SECONDS")]
        slack: u32,
        /// The most seconds the news of a contingent task may be late.
        #[arg(long, default_value_t = 0, value_name = "SECONDS")]
        delay: u32,
    },
}

/// What every family has.
#[derive(Debug, Args)]
pub(crate) struct Size {
    /// How many rovers, astronauts, lanes.
    #[arg(long, default_value_t = 4, value_name = "N")]
    pub(crate) agents: u32,
    /// How many tasks each of them has.
    #[arg(long, default_value_t = 5, value_name = "N")]
    pub(crate) tasks: u32,
    /// The same seed gives the same network on every machine.
    #[arg(long, default_value_t = 0, value_name = "N")]
    pub(crate) seed: u64,
    /// Try seeds from --seed on until the network is controllable, and say which one it was.
    #[arg(long)]
    pub(crate) controllable: bool,
    /// Write it as a network or as an RMPL program.
    #[arg(long, value_enum, default_value_t = JsonOrRmpl::Json)]
    pub(crate) format: JsonOrRmpl,
    /// Where to write it, instead of standard output.
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum JsonOrRmpl {
    Json,
    Rmpl,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum BoundsKind {
    /// What gives the tables of the thesis.
    Tables,
    /// What the text of the thesis says.
    Text,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LinkKind {
    /// We do, within bounds.
    Requirement,
    /// Nature does.
    Contingent,
}
