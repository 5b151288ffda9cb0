//! The journal: everything that happened to an executive, line by line, so that it can be continued or repeated.
//!
//! A line is a checksum, a blank and a JSON object with a time and what happened then. The checksum (CRC-32, in
//! hexadecimal) is over the checksum of the line before and the JSON, so a line that is damaged, missing or moved is
//! noticed. The first line says what is executed and how. Lines are only ever added; the last one may be torn.
//!
//! Some records are what happened to the executive ([`Input`]), in the order it happened; they determine everything. The
//! others are what came of it, for people, for checking a repetition, and for knowing what had left when the journal ends.

mod text;

use std::collections::{HashMap, HashSet};

use kirk_network::json;
use kirk_network::model::Name;
use kirk_network::{Duration, Event, EventId, Network, Time};
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use crate::activity::Handover;
use crate::dispatcher::{Settings, Strategy};
use crate::execution::Execution;
use crate::executive::{Executive, Setup};
use crate::input::Input;
use crate::order::Patience;
use crate::plan::{NoPlan, Plan};
use crate::replay::names;
use crate::speed::Speed;
pub use text::{BadJournal, Journal, is_journal, read, write};

/// The `format` of the journals written and read here.
pub const FORMAT: &str = "kirk-journal/3";

/// One line.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// When.
    pub at: Time,
    /// What.
    pub record: Record,
}

/// What is on record.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Record {
    /// The mission begins: the first line, and no other.
    Start(Box<Start>),
    /// What happened to the executive.
    In(Input),
    /// What came of it, or happened around it.
    Out(Trace),
}

/// What leads to no other state of the executive.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Trace {
    /// The clock of the mission started: it had stood at zero until the driver confirmed.
    Began {
        /// What the clocks say at time zero.
        clocks: Clocks,
    },
    /// The executive was away and is back.
    Back {
        /// What the clocks say.
        clocks: Clocks,
    },
    /// An event is to be handed over.
    Dispatch {
        /// The dispatch.
        id: String,
        /// When it is due.
        due: Time,
        /// 1 for the first.
        attempt: u32,
    },
    /// This is what will be due then, unless something happens before. It is on disk before it leaves.
    Ahead {
        /// When.
        due: Time,
        /// The dispatches.
        ids: Vec<String>,
    },
    /// Something a person should know.
    Warning {
        /// A sentence.
        text: String,
    },
    /// News arrived that was of no use. Further news of the same kind is not recorded.
    Ignored {
        /// The event, as it was called.
        event: String,
        /// Why.
        why: String,
    },
    /// The mission is over.
    End {
        /// What became of it.
        execution: Execution,
    },
}

/// What is executed, and how: all it takes to go on.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// Always [`FORMAT`].
    pub format: String,
    /// The version of kirk that wrote it.
    pub version: String,
    /// The control program, or the name of the network.
    pub program: String,
    /// What the ids of its dispatches begin with.
    pub run: String,
    /// True if news that says more than the plan assumed is planned with.
    pub optimistic: bool,
    /// How long before they are due events are handed over.
    pub lead: Duration,
    /// Up to how late an event counts as executed when it was due.
    pub lateness: Duration,
    /// How long to wait before trying again, at first and at most.
    pub patience: (Duration, Duration),
    /// How many times faster than real time it is executed.
    pub speed: Speed,
    /// What somebody is to carry out: names and companions.
    pub handovers: Vec<(String, Option<String>)>,
    /// True if a driver is told of that and confirms it.
    pub driver: bool,
    /// Names no user wrote.
    pub internal: Vec<String>,
    /// What the clocks say at time 0.
    pub clocks: Clocks,
    /// What the shell around the executive needs to go on.
    pub shell: Box<RawValue>,
    /// The network as written, not merged.
    pub network: Box<RawValue>,
}

/// What the clocks say at the time of a record, in microseconds. The time since boot is right whatever is done to the
/// calendar, as long as the machine has not been booted again.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Clocks {
    /// Which boot, if the machine tells.
    pub boot: Option<String>,
    /// Since then.
    pub since_boot: i64,
    /// Since 1970, by the calendar.
    pub calendar: i64,
}

impl Start {
    /// What is to be executed: a network as written, and a setup whose handovers are of its merged form.
    pub fn new(
        network: &Network,
        setup: &Setup,
        speed: Speed,
        clocks: Clocks,
        shell: Box<RawValue>,
        version: &str,
    ) -> Start {
        let names = network.events().iter().flat_map(|event| event.names.iter());
        let internal = names.filter(|name| name.internal).map(|name| name.text.clone());
        let text = json::write(network);
        Start {
            format: FORMAT.to_string(),
            version: version.to_string(),
            program: setup.program.clone(),
            run: setup.run.clone(),
            optimistic: setup.settings.strategy == Strategy::Optimistic,
            lead: setup.settings.lead,
            lateness: setup.settings.lateness,
            patience: (setup.patience.first, setup.patience.most),
            speed,
            handovers: setup.handovers.iter().map(|h| (h.name.clone(), h.companion.clone())).collect(),
            driver: setup.driver,
            internal: internal.collect(),
            clocks,
            shell,
            network: RawValue::from_string(text)
                .unwrap_or_else(|error| unreachable!("a network is written as JSON: {error}")),
        }
    }

    /// The network as written.
    ///
    /// # Errors
    /// A sentence that says what is wrong with it.
    pub fn network(&self) -> Result<Network, String> {
        let network = json::read(self.network.get()).map_err(|problems| problems[0].message.clone())?;
        let internal: HashSet<&str> = self.internal.iter().map(String::as_str).collect();
        let flagged = |event: &Event| {
            let name = |name: &Name| Name { internal: internal.contains(name.text.as_str()), ..name.clone() };
            Event { names: event.names.iter().map(name).collect() }
        };
        let events = network.events().iter().map(flagged).collect();
        let (requirements, contingents) = (network.requirements().to_vec(), network.contingents().to_vec());
        Network::new(network.name().to_string(), network.origin(), events, requirements, contingents)
            .map_err(|errors| errors[0].to_string())
    }

    /// How the executive of a merged network is set up.
    ///
    /// # Errors
    /// A sentence: it is another network.
    pub fn setup(&self, network: &Network) -> Result<Setup, String> {
        let events: HashMap<&str, EventId> = names(network).collect();
        let handover = |(name, companion): &(String, Option<String>)| {
            let event = *events.get(name.as_str()).ok_or(format!("there is no event `{name}`"))?;
            Ok(Handover { event, name: name.clone(), companion: companion.clone() })
        };
        let handovers = self.handovers.iter().map(handover).collect::<Result<_, String>>()?;
        let settings = Settings {
            strategy: if self.optimistic { Strategy::Optimistic } else { Strategy::Buffer },
            lead: self.lead,
            lateness: self.lateness,
            ..Settings::default()
        };
        Ok(Setup {
            program: self.program.clone(),
            run: self.run.clone(),
            settings,
            handovers,
            driver: self.driver,
            patience: Patience { first: self.patience.0, most: self.patience.1 },
        })
    }

    /// The executive at time 0.
    ///
    /// # Errors
    /// A sentence that says why there is none.
    pub fn executive(&self) -> Result<Executive, String> {
        let plan = match Plan::new(&self.network()?) {
            Ok(plan) => plan,
            Err(NoPlan::Uncontrollable(_)) => return Err("its network is not controllable".to_string()),
            Err(NoPlan::TooLarge) => return Err("its numbers are too large to compute with".to_string()),
        };
        let setup = self.setup(plan.network())?;
        Ok(Executive::new(plan, setup))
    }
}

impl Clocks {
    /// How long after `earlier` these are, as far as the clocks can tell; `None` if they say it was before.
    pub fn since(&self, earlier: &Clocks) -> Option<Duration> {
        let micros = if self.rebooted_since(earlier) {
            self.calendar - earlier.calendar
        } else {
            // The start of a mission is set for a moment later, and the process may die before.
            (self.since_boot - earlier.since_boot).max(0)
        };
        (micros >= 0).then(|| Duration::from_micros(micros))
    }

    /// True if the machine was booted in between, as far as one can tell.
    pub fn rebooted_since(&self, earlier: &Clocks) -> bool {
        self.boot.is_none() || self.boot != earlier.boot
    }
}

impl Line {
    /// A line at a time.
    pub fn new(at: Time, record: Record) -> Line {
        Line { at, record }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clocks(boot: Option<&str>, since_boot: i64, calendar: i64) -> Clocks {
        Clocks { boot: boot.map(str::to_string), since_boot, calendar }
    }

    #[test]
    fn a_calendar_that_is_set_changes_nothing_unless_the_machine_was_booted_again() {
        let start = clocks(Some("a"), 1_000, 50_000);
        let set_back = clocks(Some("a"), 3_000, 20_000);
        assert_eq!(set_back.since(&start), Some(Duration::from_micros(2_000)));
        let set_forward = clocks(Some("a"), 3_000, 90_000);
        assert_eq!(set_forward.since(&start), Some(Duration::from_micros(2_000)));
        let booted = clocks(Some("b"), 10, 57_000);
        assert_eq!(booted.since(&start), Some(Duration::from_micros(7_000)));
        assert!(booted.rebooted_since(&start) && !set_back.rebooted_since(&start));
        let booted_and_set_back = clocks(Some("b"), 10, 20_000);
        assert_eq!(booted_and_set_back.since(&start), None);
        let no_boot = clocks(None, 3_000, 51_000);
        assert_eq!(no_boot.since(&clocks(None, 1_000, 50_000)), Some(Duration::from_micros(1_000)));
    }
}
