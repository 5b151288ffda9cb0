//! From a proven plan to an executive at work.

use std::net::TcpListener;
use std::path::Path;
use std::sync::mpsc::{Receiver, Sender};
use std::time::Duration as Real;

use kirk_network::{Duration, Network, Time};
use kirk_runtime::journal::{Line, Record, Start};
use kirk_runtime::{Executive, Handover, Patience, Plan, Settings, Setup, Speed, Strategy};
use serde::{Deserialize, Serialize};
use serde_json::json;
use serde_json::value::RawValue;

use crate::clock::{Clock, clocks};
use crate::desk::{Desk, Message};
use crate::driver::{Driver, Running, Said};
use crate::file::JournalFile;
use crate::seconds;

/// What is executed.
#[derive(Clone, Debug)]
pub struct Assignment {
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
    pub speed: Speed,
    /// How long before they are due events may be handed over.
    #[serde(with = "seconds::mission")]
    pub tolerance: Duration,
    /// Who executes events; nobody but the reader of the timetable if `None`.
    pub driver: Option<Driver>,
    /// How long an attempt of the driver may really take.
    #[serde(with = "seconds::real")]
    pub driver_timeout: Real,
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
    /// When the driver first confirms an event, which it has to do in time.
    DriverConfirms {
        /// How long that may really take.
        #[serde(with = "seconds::real")]
        within: Real,
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
            speed: Speed::REAL,
            tolerance: Duration::ZERO,
            driver: None,
            driver_timeout: Real::from_secs(10),
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

/// How late, really, an event may be and still count as executed when it was due, if no tolerance says more. A busy
/// machine wakes up so late now and then, and no activity cares.
const LATENESS: Duration = Duration::from_micros(100_000);
/// How long before time zero everything is prepared, so that nothing is late at time zero.
const PREPARATION: Real = Real::from_millis(50);
/// How long to wait, really, before the driver is tried again.
pub(crate) const PATIENCE: Patience =
    Patience { first: Duration::from_micros(100_000), most: Duration::from_secs(2) };

/// Prepares a mission: opens the journal, the port and the driver. Its time zero is a moment later, or as the options
/// say. `said` hears what commands of the driver print.
///
/// # Errors
/// A sentence that says what cannot be opened. Then nothing has been started.
pub fn begin(
    mission: Assignment,
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
            Some(JournalFile::create(path, &run, &line)?)
        }
    };
    let hall = Hall::open(executive.network(), clock, listener)?;
    make(executive, options, hall, journal, &run, said, false)
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
pub(crate) type Ear = (TcpListener, Option<Vec<u8>>);

/// Opens the port for news.
pub(crate) fn open(options: &Options) -> Result<Option<Ear>, String> {
    let Some(http) = &options.http else { return Ok(None) };
    let token = http.token_file.as_ref().map(|file| crate::http::read_token(Path::new(file))).transpose()?;
    let listener = crate::http::listen(&http.bind, http.port, token.is_some())?;
    Ok(Some((listener, token)))
}

fn setup(mission: &Assignment, options: &Options) -> Setup {
    let scaled = |real: Duration| options.speed.mission(real);
    let lead = options.tolerance;
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
        handovers: mission.handovers.clone(),
        driver: options.driver.is_some(),
        patience: Patience { first: scaled(PATIENCE.first), most: scaled(PATIENCE.most) },
    }
}

/// What no other run has: when it began, and in which process.
fn run_id() -> String {
    format!("{:x}-{:x}", clocks().calendar, std::process::id())
}

/// Where messages come in.
pub(crate) struct Hall {
    desk: Desk,
    inbox: Receiver<Message>,
    server: Option<crate::http::Server>,
}

impl Hall {
    /// From now on news is heard.
    pub(crate) fn open(network: &Network, clock: Clock, ear: Option<Ear>) -> Result<Hall, String> {
        let (desk, inbox) = Desk::new(network, clock);
        let server = match ear {
            None => None,
            Some((listener, token)) => {
                let options = crate::http::ServerOptions { token };
                let server = crate::http::Server::start(listener, options, desk.clone());
                Some(server.map_err(|error| format!("the port cannot be served: {error}"))?)
            }
        };
        Ok(Hall { desk, inbox, server })
    }
}

/// Starts the driver: everything is there.
pub(crate) fn make(
    executive: Executive,
    options: Options,
    hall: Hall,
    mut journal: Option<JournalFile>,
    run: &str,
    said: Sender<Said>,
    resumed: bool,
) -> Result<Ready, String> {
    let Hall { desk, inbox, server } = hall;
    for event in executive.network().event_ids() {
        if executive.dispatcher().known(event).observed.is_some() {
            desk.set_observed(event);
        }
    }
    if let Some(journal) = &mut journal {
        journal.begin_syncing(desk.clone())?;
    }
    let greeting =
        json!({ "protocol": "kirk-driver/1", "run": run, "speed": options.speed, "resumed": resumed });
    let driver = match &options.driver {
        None => None,
        Some(driver) => {
            let started = driver.start(options.driver_timeout, greeting, desk.clone(), said);
            Some(started.map_err(|error| format!("the driver cannot be started: {error}"))?)
        }
    };
    Ok(Ready { executive, options, desk, inbox, journal, driver, server })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// They stand in the journals of missions that go on.
    #[test]
    fn options_are_written_as_they_always_were() {
        let rest = r#""http":null,"on_failure":null,"screen":"auto","zero":"soon""#;
        let usual = format!(
            r#"{{"optimistic":true,"speed":1.0,"tolerance":0.0,"driver":null,"driver_timeout":10.0,{rest}}}"#
        );
        assert_eq!(serde_json::to_string(&Options::default()).unwrap(), usual);
        let rest =
            r#""http":null,"on_failure":"echo","screen":"never","zero":{"driver-confirms":{"within":0.1}}"#;
        let text = format!(
            r#"{{"optimistic":false,"speed":2.5,"tolerance":0.29,"driver":{{"url":"http://robot/"}},"driver_timeout":1234.1,{rest}}}"#
        );
        let options: Options = serde_json::from_str(&text).unwrap();
        assert_eq!(options.tolerance, Duration::from_micros(290_000));
        assert_eq!(serde_json::to_string(&options).unwrap(), text);
        for (right, wrong) in [("2.5", "0"), ("0.29", "-1"), ("1234.1", "-1"), ("0.1", "-1")] {
            assert!(
                serde_json::from_str::<Options>(&text.replace(right, wrong)).is_err(),
                "{wrong} for {right}"
            );
        }
    }
}
