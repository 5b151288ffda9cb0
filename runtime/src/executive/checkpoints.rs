//! From an executive to what it knows, and back.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use kirk_network::{EventId, Network, Time};

use super::{Broken, Executive, Setup};
use crate::activity::Handover;
use crate::checkpoint::Checkpoint;
use crate::dispatcher::Dispatcher;
use crate::knowledge::Knowledge;
use crate::order::Orders;
use crate::replay::names;

impl Executive {
    /// What has become known since the last checkpoint. Nothing may be in flight.
    pub(super) fn checkpoint(&mut self) -> Checkpoint {
        let touched = self.dispatcher.checkpoint();
        let name = |event: EventId| self.dispatcher.network().id(event).to_string();
        let timed = |list: &[(Time, EventId)]| {
            list.iter().map(|&(time, event)| (time.as_micros(), name(event))).collect::<Vec<_>>()
        };
        Checkpoint {
            versions: (self.dispatcher.version(), self.changes),
            events: touched.iter().map(|&event| (name(event), *self.dispatcher.known(event))).collect(),
            orders: self.orders.checkpoint(),
            held: timed(&self.held),
            awaited: timed(&self.awaited),
            broken: self
                .broken
                .iter()
                .map(|broken| (broken.arrived.as_micros(), name(broken.event), broken.said.clone()))
                .collect(),
        }
    }

    /// The executive that knew all this and then, at `now`, went on with a plan that was made of it for `planned`.
    ///
    /// # Errors
    /// A sentence: this was never known in this mission.
    pub(crate) fn restored(
        network: &Arc<Network>,
        setup: Setup,
        known: &Checkpoint,
        planned: Time,
        now: Time,
    ) -> Result<Executive, String> {
        let names: HashMap<&str, EventId> = names(network).collect();
        let find =
            |name: &String| names.get(name.as_str()).copied().ok_or(format!("there is no event `{name}`"));
        let mut knowledge = Knowledge::new(network);
        for (name, event) in &known.events {
            knowledge.recall(find(name)?, *event);
        }
        let settings = setup.settings_for(network);
        let dispatcher = Dispatcher::restored(network, settings, knowledge, known.versions.0, planned)
            .ok_or("there is no plan with what is known here")?;
        let mut executive = Executive::around(dispatcher, setup);
        executive.changes = known.versions.1;
        let timed = |list: &[(i64, String)]| -> Result<Vec<_>, String> {
            list.iter().map(|(time, name)| Ok((Time::from_micros(*time), find(name)?))).collect()
        };
        executive.held = timed(&known.held)?;
        executive.awaited = timed(&known.awaited)?;
        for (arrived, name, said) in &known.broken {
            let (event, arrived) = (find(name)?, Time::from_micros(*arrived));
            executive.broken.push(Broken { event, arrived, said: said.clone() });
        }
        let by_name: HashMap<&str, &Handover> =
            executive.handovers.iter().map(|handover| (handover.name.as_str(), handover)).collect();
        let handover = |name: &str| by_name.get(name).copied().cloned();
        executive.orders = Orders::recall(&known.orders, &executive.run, handover)?;
        let told: HashSet<EventId> = known
            .orders
            .values()
            .filter_map(|course| Some(by_name.get(course.name.as_str())?.event))
            .collect();
        executive.unannounced.retain(|event| !told.contains(event));
        executive.mend();
        executive.timeout(now);
        Ok(executive)
    }
}
