//! The desk: where everybody outside of the loop hands in messages and asks how things are. Cheap to clone.
//!
//! What is certainly of no use (unknown events, events of ours, repeated news) is answered here, without a word to the
//! loop, so no flood of it can delay a dispatch.

use std::collections::{HashMap, HashSet};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};

use kirk_network::model::normal_name;
use kirk_network::{Duration, EventId, Network, Time};
use kirk_runtime::{Rebuilt, Why};
use serde::Serialize;
use tokio::sync::broadcast;

use crate::clock::Clock;
use crate::happening::Happening;
use crate::snapshot::Snapshot;

/// Hands in messages.
#[derive(Clone)]
pub struct Desk {
    inbox: SyncSender<Message>,
    clock: Clock,
    shared: Arc<Shared>,
}

struct Shared {
    /// Every name, in lower case.
    events: HashMap<String, EventId>,
    /// For each event: it is Nature's.
    contingent: Vec<bool>,
    /// For each event: its news was accepted.
    observed: Vec<AtomicBool>,
    version: AtomicU64,
    /// What was told of news of no use: each event and reason once.
    ignored: Mutex<HashSet<(String, Why)>>,
    happenings: broadcast::Sender<Arc<Happening>>,
}

/// Stands for everything that was written to the journal before it was asked for. Later tickets are greater.
pub(crate) type Ticket = u64;

/// What reaches the loop.
pub(crate) enum Message {
    /// News of events, and who wants to know what became of it.
    Observed {
        arrived: Time,
        events: Vec<(String, EventId)>,
        answer: Acknowledgement,
        reply: Reply<Acknowledgement>,
    },
    /// The driver confirmed a dispatch, really so long after it was executed if it says so.
    Executed { id: String, ago: Option<Duration> },
    /// The driver failed, or in case of doubt nobody knows.
    Failed { id: String, reason: String, doubt: bool },
    /// The driver has something to say to people.
    Warning(String),
    /// A new plan is ready.
    Rebuilt(Rebuilt),
    /// Part of the journal is on the disk, or cannot be brought there.
    Synced { ticket: Ticket, result: Result<(), String> },
    /// Somebody wants to know how things are.
    State { reply: Reply<String> },
    /// Somebody wants to look at the mission.
    Look { reply: Reply<Snapshot> },
    /// Somebody wants the mission to end.
    Stop { reason: String },
}

/// Called once with the answer.
pub type Reply<T> = Box<dyn FnOnce(T) + Send>;

/// What became of news: the events by the names they were given.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Acknowledgement {
    /// Known now.
    pub accepted: Vec<String>,
    /// Of no use.
    pub ignored: Vec<Ignored>,
}

/// News of no use.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Ignored {
    /// The event, as it was named.
    pub event: String,
    /// Why it is of no use.
    pub why: Why,
}

/// How an attempt of the driver failed.
#[derive(Clone, Debug)]
pub(crate) struct Failed {
    pub(crate) reason: String,
    /// The event may have been executed all the same.
    pub(crate) doubt: bool,
}

impl Failed {
    /// It was not executed.
    pub(crate) fn surely(reason: impl Into<String>) -> Failed {
        Failed { reason: reason.into(), doubt: false }
    }

    /// Nobody knows.
    pub(crate) fn perhaps(reason: impl Into<String>) -> Failed {
        Failed { reason: reason.into(), doubt: true }
    }
}

/// How many messages may wait, and how many happenings a slow listener may be behind.
const WAITING: usize = 4096;
/// Of so much news of no use people are told; whoever makes names up does not fill a terminal with them.
const MOST_IGNORED: usize = 1000;

impl Desk {
    pub(crate) fn new(network: &Network, clock: Clock) -> (Desk, Receiver<Message>) {
        let (inbox, outbox) = sync_channel(WAITING);
        let names = |event: EventId| network.events()[event.index()].names.iter().map(move |n| (n, event));
        let events = network.event_ids().flat_map(names);
        let shared = Shared {
            events: events.map(|(name, event)| (name.text.to_lowercase(), event)).collect(),
            contingent: network.event_ids().map(|event| network.link_of(event).is_some()).collect(),
            observed: network.event_ids().map(|_| AtomicBool::new(false)).collect(),
            version: AtomicU64::new(0),
            ignored: Mutex::new(HashSet::new()),
            happenings: broadcast::channel(WAITING).0,
        };
        (Desk { inbox, clock, shared: Arc::new(shared) }, outbox)
    }

    /// The clock of the mission.
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// News arrived just now, of events under any of their names. `reply` is called with what became of it, once it is
    /// safe; at once if none of it is of use.
    pub fn observe(&self, names: Vec<String>, reply: Reply<Acknowledgement>) {
        let arrived = self.clock.now();
        let mut answer = Acknowledgement::default();
        let mut events: Vec<(String, EventId)> = Vec::new();
        for name in names {
            let why = match self.shared.events.get(&normal_name(&name)) {
                None => Why::UnknownEvent,
                Some(event) if !self.shared.contingent[event.index()] => Why::NotNatures,
                Some(event) if self.shared.observed[event.index()].load(Ordering::Acquire) => {
                    Why::ObservedBefore
                }
                Some(event) => {
                    events.push((name, *event));
                    continue;
                }
            };
            answer.ignored.push(Ignored { event: name, why });
        }
        if events.is_empty() {
            return reply(answer);
        }
        // If the loop is gone nobody is there to answer; whoever waits notices that the reply was dropped.
        let _ = self.inbox.send(Message::Observed { arrived, events, answer, reply });
    }

    /// The same for news from elsewhere: whoever watches the mission does not see the answer, so of what is of no use they are
    /// told, of each event and reason once.
    pub(crate) fn report(&self, names: Vec<String>, reply: Reply<Acknowledgement>) {
        let (desk, arrived) = (self.clone(), self.clock.now());
        let tell = move |answer: Acknowledgement| {
            answer.ignored.iter().for_each(|ignored| desk.tell_ignored(arrived, ignored));
            reply(answer);
        };
        self.observe(names, Box::new(tell));
    }

    fn tell_ignored(&self, arrived: Time, Ignored { event, why }: &Ignored) {
        let mut told = self.shared.ignored.lock().unwrap_or_else(PoisonError::into_inner);
        if told.len() < MOST_IGNORED && told.insert((normal_name(event), why.clone())) {
            self.tell(Happening::Ignored { at: arrived, event: event.clone(), why: why.clone() });
        }
    }

    /// The execution as it stands, as `kirk-execution/1` in one line of JSON.
    pub fn state(&self, reply: Reply<String>) {
        let _ = self.inbox.send(Message::State { reply });
    }

    /// The mission as a person wants to see it. Whoever goes on looking asks again when the version has changed.
    pub fn look(&self, reply: Reply<Snapshot>) {
        let _ = self.inbox.send(Message::Look { reply });
    }

    /// Changes whenever the state does.
    pub fn version(&self) -> u64 {
        self.shared.version.load(Ordering::Acquire)
    }

    /// Everything that happens from now on.
    pub fn listen(&self) -> broadcast::Receiver<Arc<Happening>> {
        self.shared.happenings.subscribe()
    }

    /// Ends the mission.
    pub fn stop(&self, reason: String) {
        let _ = self.inbox.send(Message::Stop { reason });
    }

    pub(crate) fn executed(&self, id: String, ago: Option<Duration>) {
        let _ = self.inbox.send(Message::Executed { id, ago });
    }

    pub(crate) fn failed(&self, id: String, failure: Failed) {
        let Failed { reason, doubt } = failure;
        let _ = self.inbox.send(Message::Failed { id, reason, doubt });
    }

    pub(crate) fn warn(&self, text: String) {
        let _ = self.inbox.send(Message::Warning(text));
    }

    pub(crate) fn rebuilt(&self, rebuilt: Rebuilt) {
        let _ = self.inbox.send(Message::Rebuilt(rebuilt));
    }

    pub(crate) fn synced(&self, ticket: Ticket, result: Result<(), String>) {
        let _ = self.inbox.send(Message::Synced { ticket, result });
    }

    pub(crate) fn set_version(&self, version: u64) {
        self.shared.version.store(version, Ordering::Release);
    }

    pub(crate) fn set_observed(&self, event: EventId) {
        self.shared.observed[event.index()].store(true, Ordering::Release);
    }

    pub(crate) fn tell(&self, happening: Happening) {
        // Nobody may be listening.
        let _ = self.shared.happenings.send(Arc::new(happening));
    }
}
