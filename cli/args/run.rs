//! The command lines of `kirk run`, `kirk resume` and `kirk replay`.

use std::path::PathBuf;
use std::time::Duration as Real;

use clap::{Args, ValueEnum};
use jiff::{SignedDuration, Timestamp};
use kirk_network::{Duration, Time};
use kirk_runtime::Speed;

use super::{Picture, Selection};

#[derive(Debug, Args)]
pub(crate) struct Run {
    /// The mission: RMPL (.rmpl, .lisp; several files are one program), a network (.json, .stnu, .plainstnu), or `-` for
    /// standard input.
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<String>,
    #[command(flatten)]
    pub(crate) selection: Selection,
    /// Simulate in virtual time.
    #[arg(long)]
    pub(crate) simulate: bool,
    /// News of EVENT arrives at T seconds (repeatable).
    #[arg(long, value_name = "EVENT@T", requires = "simulate", help_heading = "Simulation")]
    pub(crate) observe: Vec<String>,
    /// A JSON object of event: time, as if each were given with --observe.
    #[arg(long, value_name = "FILE", requires = "simulate", help_heading = "Simulation")]
    pub(crate) observations: Option<String>,
    /// Rehearse news that the model rules out, such as an overrun: what becomes of the mission, what is broken and what is kept.
    #[arg(long, requires = "simulate", help_heading = "Simulation")]
    pub(crate) what_if: bool,
    /// How Nature chooses durations and delays where the observations leave a choice.
    #[arg(long, value_enum, default_value_t = Nature::Upper, requires = "simulate", help_heading = "Simulation")]
    pub(crate) nature: Nature,
    /// Of a team: what the links between its agents do; a lost message comes again, by the latest that its link allows.
    ///
    /// [default: longest]
    #[arg(long, value_enum, requires = "simulate", help_heading = "Simulation")]
    pub(crate) links: Option<Links>,
    /// The seed of `--nature random`, and of `--links`.
    #[arg(long, default_value_t = 0, value_name = "N", requires = "simulate", help_heading = "Simulation")]
    pub(crate) seed: u64,
    /// What to do with news that says more than the plan assumed.
    ///
    /// [default: optimistic]
    #[arg(long, value_enum)]
    pub(crate) strategy: Option<StrategyName>,
    /// The same as --strategy optimistic, which is the default.
    #[arg(long, conflicts_with = "strategy")]
    pub(crate) optimistic: bool,
    /// How to print the result.
    #[command(flatten)]
    pub(crate) show: Show,
    #[command(flatten)]
    pub(crate) live: Live,
}

/// How a mission is executed in real time.
#[derive(Debug, Args)]
#[command(next_help_heading = "Real time")]
pub(crate) struct Live {
    /// A shell command for each activity that starts: the first `~A` is its start, the second its end, spelt
    /// `+UPLOAD-A::START+`. Exit status 0 confirms that it has started.
    #[arg(long, value_name = "CMD", conflicts_with_all = ["simulate", "driver", "driver_url"])]
    pub(crate) driver_command: Option<String>,
    /// A child process that speaks JSON in lines: `stdio:CMD`.
    #[arg(long, value_name = "stdio:CMD", conflicts_with_all = ["simulate", "driver_url"])]
    pub(crate) driver: Option<String>,
    /// An HTTP address to which each activity that starts is posted.
    #[arg(long, value_name = "URL", conflicts_with = "simulate")]
    pub(crate) driver_url: Option<String>,
    /// Which events the driver hears of.
    #[arg(long, value_enum, default_value_t = DriverEvents::Starts, value_name = "WHICH", conflicts_with = "simulate")]
    pub(crate) driver_events: DriverEvents,
    /// Whether the driver also hears of starts that are one with an event of Nature's.
    ///
    /// [default: all]
    #[arg(long, value_enum, value_name = "WHICH", conflicts_with = "simulate")]
    pub(crate) driver_starts: Option<DriverStarts>,
    /// What the driver is told beside the start of an activity (the second `~A`).
    ///
    /// [default: end]
    #[arg(long, value_enum, value_name = "WHAT", conflicts_with = "simulate")]
    pub(crate) companion: Option<CompanionName>,
    /// How many seconds the driver may take for an answer.
    #[arg(long, default_value = "10", value_name = "S", value_parser = real, conflicts_with = "simulate")]
    pub(crate) driver_timeout: Real,
    /// A shell command that is run if the mission fails (KIRK_REASON, KIRK_EVENT, KIRK_TIME, KIRK_DETAIL, KIRK_PROGRAM).
    #[arg(long, value_name = "CMD", conflicts_with = "simulate")]
    pub(crate) on_failure: Option<String>,
    /// Hear news over HTTP on this port; 0 takes a free one.
    #[arg(short = 'p', long, value_name = "PORT", conflicts_with = "simulate")]
    pub(crate) port: Option<u16>,
    /// Where to listen; anything but this machine alone needs --token-file.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1", requires = "port")]
    pub(crate) bind: String,
    /// A file with the word that whoever brings news has to know (`Authorization: Bearer WORD`).
    #[arg(long, value_name = "FILE", requires = "port")]
    pub(crate) token_file: Option<String>,
    /// An event may be handed over up to so many seconds before its time.
    #[arg(long, default_value = "0", value_name = "S", value_parser = seconds, conflicts_with = "simulate")]
    pub(crate) tolerance: Duration,
    /// Run the clock so many times faster: rehearsals, tests.
    #[arg(long, default_value = "1", value_name = "X", value_parser = speed, conflicts_with = "simulate")]
    pub(crate) speed: Speed,
    /// Let the clock of the mission stand until the driver first confirms, for so many seconds at most.
    #[arg(long, value_name = "S", value_parser = real, conflicts_with_all = ["simulate", "start_at"])]
    pub(crate) wait_for_driver: Option<Real>,
    /// When the clock of the mission starts: a time of the calendar (RFC 3339, such as 2030-05-20T14:00:00Z), or from now on
    /// (+30s, +5m). Several executives may share it.
    #[arg(long, value_name = "TIME", value_parser = moment, conflicts_with = "simulate")]
    pub(crate) start_at: Option<i64>,
    /// Record everything there, so that `kirk resume` can go on after whatever interrupts the mission.
    #[arg(long, value_name = "FILE", conflicts_with = "simulate")]
    pub(crate) journal: Option<PathBuf>,
    /// Whether the mission is shown on a screen of the terminal, or by lines.
    ///
    /// [default: auto; never with the original's --driver-command or --optimistic]
    #[arg(long, value_enum, value_name = "WHEN", conflicts_with = "simulate")]
    pub(crate) screen: Option<ScreenWhen>,
    /// In all that kirk does differently do as the original: --driver-starts own, --companion merged, --screen never,
    /// --strategy buffer. What is given beside it holds.
    #[arg(long, conflicts_with = "simulate")]
    pub(crate) like_original: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DriverStarts {
    /// Only those that kirk decides: what follows an event of Nature's without slack starts by itself, as with the original.
    Own,
    /// All of them.
    All,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CompanionName {
    /// The end of the activity.
    End,
    /// The start that the end is one with, if it is one with a start, as with the original.
    Merged,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ScreenWhen {
    /// If standard input is a terminal, and standard output or standard error.
    Auto,
    /// Lines in any case.
    Never,
    /// A screen, or an error if there is no terminal.
    Always,
}

impl Run {
    /// What to do with news that says more than the plan assumed.
    pub(crate) fn strategy(&self) -> StrategyName {
        match self.strategy {
            Some(strategy) => strategy,
            None if self.live.like_original && !self.optimistic => StrategyName::Buffer,
            None => StrategyName::Optimistic,
        }
    }

    /// Whether the mission is shown on a screen. Whoever uses the options of the original has a launch file, under which
    /// standard input may be a terminal, and wants lines.
    pub(crate) fn screen(&self) -> ScreenWhen {
        let original = self.live.like_original || self.live.driver_command.is_some() || self.optimistic;
        self.live.screen.unwrap_or(if original { ScreenWhen::Never } else { ScreenWhen::Auto })
    }
}

impl Live {
    pub(crate) fn driver_starts(&self) -> DriverStarts {
        let usual = if self.like_original { DriverStarts::Own } else { DriverStarts::All };
        self.driver_starts.unwrap_or(usual)
    }

    pub(crate) fn companion(&self) -> CompanionName {
        let usual = if self.like_original { CompanionName::Merged } else { CompanionName::End };
        self.companion.unwrap_or(usual)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DriverEvents {
    /// The starts of activities.
    Starts,
    /// Also the ends that kirk decides itself.
    All,
}

fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if (0.0..=1e9).contains(&number) => Ok(number),
        Ok(_) => Err("expected a number from 0 to 1000000000".to_string()),
        Err(_) => Err("expected a number, such as 1.5".to_string()),
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match not_negative(text)? {
        number if number >= 1e-6 => Ok(number),
        _ => Err("expected a number greater than 0".to_string()),
    }
}

/// A time of the calendar, in microseconds since 1970.
fn moment(text: &str) -> Result<i64, String> {
    let moment = match text.strip_prefix('+') {
        Some(wait) => wait.parse::<SignedDuration>().and_then(|wait| Timestamp::now().checked_add(wait)),
        None => text.parse::<Timestamp>(),
    };
    let expected = "expected a time with its offset, such as 2030-05-20T14:00:00Z or ...+02:00, or how long from now: +30s";
    moment.map(Timestamp::as_microsecond).map_err(|error| format!("{error}; {expected}"))
}

fn speed(text: &str) -> Result<Speed, String> {
    match positive(text)? {
        number if number <= 1e6 => Speed::try_from(number),
        _ => Err("expected a number up to 1000000".to_string()),
    }
}

/// Seconds of mission time, to the nearest microsecond.
fn seconds(text: &str) -> Result<Duration, String> {
    not_negative(text).map(|seconds| Duration::from_micros((seconds * 1e6).round() as i64))
}

/// A time of the mission, in seconds.
fn time(text: &str) -> Result<Time, String> {
    seconds(text).map(Time::after_origin)
}

/// Seconds of real time.
fn real(text: &str) -> Result<Real, String> {
    positive(text).map(Real::from_secs_f64)
}

#[derive(Debug, Args)]
pub(crate) struct Resume {
    /// The journal (`kirk run --journal FILE`).
    #[arg(value_name = "FILE")]
    pub(crate) journal: PathBuf,
    /// What time it is in the mission, in seconds after its start, if the clocks cannot tell.
    #[arg(long, value_name = "S", value_parser = time)]
    pub(crate) at: Option<Time>,
    /// Whether the mission is shown on a screen of the terminal, or by lines [default: as it was begun].
    #[arg(long, value_enum, value_name = "WHEN")]
    pub(crate) screen: Option<ScreenWhen>,
    /// How to print the result.
    #[command(flatten)]
    pub(crate) show: Show,
}

/// How an execution is printed.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct Show {
    /// Also print the events that no user wrote.
    #[arg(long)]
    pub(crate) internal: bool,
    /// Also print what decided the time of each event: another event, its news or the lack of it, an order.
    #[arg(long)]
    pub(crate) why: bool,
    /// How to print the result.
    #[arg(long, value_enum, default_value_t = ShowFormat::Text)]
    pub(crate) format: ShowFormat,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ShowFormat {
    /// A timetable.
    Text,
    /// A record, for programs.
    Json,
    /// A picture.
    Svg,
    /// A page with the picture.
    Html,
    /// A Gantt chart of Mermaid.
    Mermaid,
}

impl ShowFormat {
    /// Which picture it is, if it is one.
    pub(crate) fn picture(self) -> Option<Picture> {
        match self {
            ShowFormat::Text | ShowFormat::Json => None,
            ShowFormat::Svg => Some(Picture::Svg),
            ShowFormat::Html => Some(Picture::Html),
            ShowFormat::Mermaid => Some(Picture::Mermaid),
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct Replay {
    /// The journal (`kirk run --journal FILE`).
    #[arg(value_name = "FILE")]
    pub(crate) journal: PathBuf,
    /// Repeat it so many times faster than it was; at once if not given.
    #[arg(long, value_name = "X", value_parser = speed)]
    pub(crate) speed: Option<Speed>,
    /// How to print the result.
    #[command(flatten)]
    pub(crate) show: Show,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Nature {
    /// Durations and delays as long as possible.
    Upper,
    /// Durations and delays as short as possible.
    Lower,
    /// Anything possible.
    Random,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Links {
    /// Every message as late as it can be, none over links that may lose it.
    Longest,
    /// Every message as soon as it can be.
    Shortest,
    /// Anything possible.
    Random,
    /// The same, and of 100 messages 30 are lost at first and 20 come twice.
    Lossy,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum StrategyName {
    /// Hold early news until the plan expects it.
    Buffer,
    /// Plan anew with it.
    Optimistic,
}
