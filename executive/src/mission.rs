//! From a proven plan, or from a journal, to an executive at work.

use std::net::TcpListener;
use std::path::Path;
use std::sync::mpsc::{Receiver, Sender};
use std::time::Duration as Real;

use kirk_network::{Duration, Network, Time};
use kirk_runtime::journal::{Clocks, Journal, Line, Record, Start};
use kirk_runtime::{Execution, Executive, Handover, Patience, Plan, Settings, Setup, Strategy, recover};
use serde::{Deserialize, Serialize};
use serde_json::json;
use serde_json::value::RawValue;

use crate::clock::{Clock, clocks};
use crate::desk::{Desk, Message};
use crate::driver::{Driver, Running, Said, Treatment};
use crate::file::JournalFile;

/// What is executed.
#[derive(Clone, Debug)]
pub struct Mission {
    /// The control program, or the name of the network.
    pub program: String,
    /// The network as written, not merged.
    pub network: Network,
    /// Its plan.
    pub plan: Plan,
    /// What the driver hears of.
    pub handovers: Vec<Handover>,
}

/// How a mission is executed. All of it is in the journal, for going on.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Options {
    /// True if news that says more than the plan assumed is planned with.
    pub optimistic: bool,
    /// How many times faster than the world.
    pub speed: f64,
    /// How many seconds before they are due events may be handed over.
    pub tolerance: f64,
    /// Who executes events; nobody but the reader of the timetable if `None`.
    pub driver: Option<Driver>,
    /// How many seconds an attempt of the driver may really take.
    pub driver_timeout: f64,
    /// Where news is heard over HTTP.
    pub http: Option<Http>,
    /// A shell command that is run if the mission fails.
    pub on_failure: Option<String>,
    /// Whether the mission is to be shown on a screen; that is up to whoever shows it.
    #[serde(default)]
    pub screen: Screen,
    /// When the clock of the mission starts.
    #[serde(default)]
    pub zero: Zero,
}

/// When the clock of a mission starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Zero {
    /// As soon as everything is ready.
    #[default]
    Soon,
    /// At this time of the calendar, in microseconds since 1970: several executives may share it.
    At(i64),
    /// When the driver first confirms an event, which it has to do within so many real seconds.
    DriverConfirms {
        /// The seconds.
        within: f64,
    },
}

/// Whether a mission is shown on a screen of the terminal, or by lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Screen {
    /// If somebody sits before a terminal.
    #[default]
    Auto,
    /// Lines in any case.
    Never,
    /// A screen, or nothing is started.
    Always,
}

impl Default for Options {
    /// In real time, with news that says more planned with, and nobody to drive or to report.
    fn default() -> Options {
        Options {
            optimistic: true,
            speed: 1.0,
            tolerance: 0.0,
            driver: None,
            driver_timeout: 10.0,
            http: None,
            on_failure: None,
            screen: Screen::Auto,
            zero: Zero::Soon,
        }
    }
}

/// Where news is heard over HTTP.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Http {
    /// The address, usually that of this machine alone.
    pub bind: String,
    /// The port.
    pub port: u16,
    /// The file with the word that whoever brings news must know.
    pub token_file: Option<String>,
}

/// A mission that is about to begin, or to go on. [`Ready::run`] does it.
pub struct Ready {
    pub(crate) executive: Executive,
    pub(crate) options: Options,
    pub(crate) desk: Desk,
    pub(crate) inbox: Receiver<Message>,
    pub(crate) journal: Option<JournalFile>,
    pub(crate) driver: Option<Running>,
    pub(crate) server: Option<crate::http::Server>,
}

/// What a journal leads to.
pub enum Resumption {
    /// The mission goes on.
    Ready(Box<Ready>),
    /// The mission is over.
    Over(Box<Execution>),
}

/// How late, really, an event may be and still count as executed when it was due, if no tolerance says more. A busy
/// machine wakes up so late now and then, and no activity cares.
const LATENESS: Real = Real::from_millis(100);
/// How long before time zero everything is prepared, so that nothing is late at time zero.
const PREPARATION: Real = Real::from_millis(50);
/// How long to wait, really, before the driver is tried again, at first and at most.
pub(crate) const PATIENCE: (Real, Real) = (Real::from_millis(100), Real::from_secs(2));

/// Prepares a mission: opens the journal, the port and the driver. Its time zero is a moment later, or as the options
/// say. `said` hears what commands of the driver print.
///
/// # Errors
/// A sentence that says what cannot be opened. Then nothing has been started.
pub fn begin(
    mission: Mission,
    options: Options,
    journal: Option<&Path>,
    said: Sender<Said>,
) -> Result<Ready, String> {
    if let Some(driver) = &options.driver {
        driver.check(&mission.handovers)?;
    }
    let listener = open(&options)?;
    let setup = setup(&mission, &options);
    let run = setup.run.clone();
    let shell = serde_json::to_string(&options).and_then(RawValue::from_string).map_err(|e| e.to_string())?;
    let executive = Executive::new(mission.plan, setup.clone());
    let clock = clock(&options)?;
    let journal = match journal {
        None => None,
        Some(path) => {
            let version = env!("CARGO_PKG_VERSION");
            let start = Start::new(&mission.network, &setup, options.speed, clock.anchor(), shell, version);
            let line = Line::new(Time::ZERO, Record::Start(Box::new(start)));
            Some(JournalFile::create(path, &line)?)
        }
    };
    make(executive, options, clock, journal, listener, &run, said, false)
}

/// Goes on with the mission of a journal. Time has passed meanwhile as the clocks of the machine say, or it is `at` now.
/// `said` hears what commands of the driver print, `note` is told what a person should know.
///
/// # Errors
/// A sentence that says why that is not possible.
pub fn resume(
    path: &Path,
    at: Option<Time>,
    said: Sender<Said>,
    mut note: impl FnMut(String),
) -> Result<Resumption, String> {
    let (mut file, journal) = JournalFile::open(path)?;
    if journal.torn > 0 {
        note(format!("the last record was torn, {} bytes of it; it is left out", journal.torn));
    }
    let of_file = |bad| format!("`{}`, {bad}", path.display());
    let replayed = recover(&journal).map_err(of_file)?;
    let mut executive = replayed.executive;
    if executive.is_over() {
        return Ok(Resumption::Over(Box::new(executive.execution(replayed.at, false))));
    }
    let start = &journal.start;
    let options: Options = serde_json::from_str(start.shell.get())
        .map_err(|error| format!("`{}` does not say how the mission is executed: {error}", path.display()))?;
    let listener = open(&options)?;
    let (mut anchor, mut anchored) = (&start.clocks, Time::ZERO);
    for line in &journal.lines {
        if let Record::Resumed { clocks, .. } | Record::Began { clocks } = &line.record {
            (anchor, anchored) = (clocks, line.time());
        }
    }
    if let Some(clock) = before_zero(&options, &journal, anchor) {
        if at.is_some_and(|at| at > Time::ZERO) {
            return Err(format!("`{}` has not begun, so it can be no time in the mission", start.program));
        }
        note(format!("`{}` has not begun; it is waited for time zero", start.program));
        file.push(&Line::new(
            Time::ZERO,
            Record::Resumed { clocks: clock.anchor(), unsent: replayed.unsent.clone() },
        ));
        executive.handle_resumed(Time::ZERO, &replayed.unsent);
        let run = start.run.clone();
        return make(executive, options, clock, Some(file), listener, &run, said, true)
            .map(|ready| Resumption::Ready(Box::new(ready)));
    }
    let clocks = clocks();
    let rebooted = clocks.rebooted_since(anchor);
    let passed = clocks.since(anchor).map(|real| (real.as_micros() as f64 * options.speed) as i64);
    let told = passed.and_then(|passed| anchored.checked_add(Duration::from_micros(passed)));
    let now = match (at, told) {
        (Some(at), _) => at,
        (None, Some(told)) => told,
        (None, None) => {
            return Err("the machine was booted again, and its calendar says it is earlier than when the mission was \
                        interrupted; say what time it is in the mission, in seconds after its start, with `--at`"
                .to_string());
        }
    };
    if now < replayed.at {
        return Err(format!(
            "the mission was executed until {} s, so it cannot be {now} s now; say what time it is in the mission with `--at`",
            replayed.at
        ));
    }
    note(format!("`{}` goes on at {now} s; the last record is of {} s", start.program, replayed.at));
    let mut unsent = replayed.unsent;
    if rebooted {
        // The records of what left may be lost, not those of what was going to: the driver is asked.
        unsent.clear();
        if let Some(due) = replayed.ahead.filter(|&due| due <= now) {
            file.push(&Line::new(due, Record::Timeout {}));
            executive.handle_timeout(due);
            // It may have left already: it is handed over again with all the rest.
            while executive.poll_output().is_some() {}
        }
    }
    file.push(&Line::new(now, Record::Resumed { clocks, unsent: unsent.clone() }));
    executive.handle_resumed(now, &unsent);
    let clock = Clock::starting(now, options.speed);
    let run = start.run.clone();
    make(executive, options, clock, Some(file), listener, &run, said, true)
        .map(|ready| Resumption::Ready(Box::new(ready)))
}

/// The clock of a mission that was interrupted before it began. `anchor` is what the clocks of the machine said, or will say, at
/// time zero, as far as the journal knows.
fn before_zero(options: &Options, journal: &Journal, anchor: &Clocks) -> Option<Clock> {
    let began = || journal.lines.iter().any(|line| matches!(line.record, Record::Began { .. }));
    match options.zero {
        Zero::DriverConfirms { .. } if !began() => Some(Clock::standing(options.speed)),
        Zero::At(_) if journal.lines.iter().all(|line| line.time() == Time::ZERO) => {
            let now = clocks();
            let rebooted = now.rebooted_since(anchor);
            let left =
                if rebooted { anchor.calendar - now.calendar } else { anchor.since_boot - now.since_boot };
            (left > 0).then(|| Clock::starting_in(Real::from_micros(left.unsigned_abs()), options.speed))
        }
        _ => None,
    }
}

/// The clock of a mission that begins.
fn clock(options: &Options) -> Result<Clock, String> {
    match options.zero {
        Zero::Soon => Ok(Clock::starting_in(PREPARATION, options.speed)),
        Zero::At(calendar) => {
            let wait = calendar.saturating_sub(clocks().calendar);
            if wait <= 0 {
                let ago = Duration::from_micros(wait.saturating_neg());
                return Err(format!("the time to start at was {ago} s ago, and it has to lie ahead"));
            }
            Ok(Clock::starting_in(Real::from_micros(wait.unsigned_abs()), options.speed))
        }
        Zero::DriverConfirms { .. } if options.driver.is_none() => {
            Err("the clock cannot wait for a driver to confirm: there is none".to_string())
        }
        Zero::DriverConfirms { .. } => Ok(Clock::standing(options.speed)),
    }
}

impl Ready {
    /// Where to hand in news and to ask how things are.
    pub fn desk(&self) -> Desk {
        self.desk.clone()
    }

    /// How it is executed.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// The network that is executed.
    pub fn network(&self) -> &Network {
        self.executive.network()
    }

    /// Where news is heard over HTTP, if it is.
    pub fn address(&self) -> Option<std::net::SocketAddr> {
        self.server.as_ref().map(crate::http::Server::address)
    }
}

/// Where news is heard, and the word to know.
type Ear = (TcpListener, Option<Vec<u8>>);

fn open(options: &Options) -> Result<Option<Ear>, String> {
    let Some(http) = &options.http else { return Ok(None) };
    let token = http.token_file.as_ref().map(|file| crate::http::read_token(Path::new(file))).transpose()?;
    let listener = crate::http::listen(&http.bind, http.port, token.is_some())?;
    Ok(Some((listener, token)))
}

fn setup(mission: &Mission, options: &Options) -> Setup {
    let scaled = |real: Real| Duration::from_micros((real.as_micros() as f64 * options.speed) as i64);
    let lead = Duration::from_micros((options.tolerance * 1e6) as i64);
    let settings = Settings {
        strategy: if options.optimistic { Strategy::Optimistic } else { Strategy::Buffer },
        lead,
        lateness: lead.max(scaled(LATENESS)),
        ..Settings::default()
    };
    Setup {
        program: mission.program.clone(),
        run: run_id(),
        settings,
        handovers: if options.driver.is_some() { mission.handovers.clone() } else { Vec::new() },
        patience: Patience { first: scaled(PATIENCE.0), most: scaled(PATIENCE.1) },
    }
}

/// What no other run has: when it began, and in which process.
fn run_id() -> String {
    format!("{:x}-{:x}", clocks().calendar, std::process::id())
}

#[expect(clippy::too_many_arguments, reason = "the one place where everything meets")]
fn make(
    executive: Executive,
    options: Options,
    clock: Clock,
    mut journal: Option<JournalFile>,
    listener: Option<Ear>,
    run: &str,
    said: Sender<Said>,
    resumed: bool,
) -> Result<Ready, String> {
    let (desk, inbox) = Desk::new(executive.network(), clock);
    for event in executive.network().event_ids() {
        if executive.dispatcher().known(event).observed.is_some() {
            desk.set_heard(event);
        }
    }
    if let Some(journal) = &mut journal {
        journal.begin_syncing(desk.clone())?;
    }
    let greeting =
        json!({ "protocol": "kirk-driver/1", "run": run, "speed": options.speed, "resumed": resumed });
    let treatment = Treatment { limit: Real::from_secs_f64(options.driver_timeout) };
    let driver = match &options.driver {
        None => None,
        Some(driver) => {
            let started = driver.start(treatment, greeting, desk.clone(), said);
            Some(started.map_err(|error| format!("the driver cannot be started: {error}"))?)
        }
    };
    let server = match listener {
        None => None,
        Some((listener, token)) => {
            let options = crate::http::ServerOptions { token };
            let server = crate::http::Server::start(listener, options, desk.clone());
            Some(server.map_err(|error| format!("the port cannot be served: {error}"))?)
        }
    };
    Ok(Ready { executive, options, desk, inbox, journal, driver, server })
}
