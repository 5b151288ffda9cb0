//! Planning anew with what news has told: work that may be done elsewhere while the old plan is still followed.

use std::sync::Arc;

use kirk_network::precedence::Precedence;
use kirk_network::reduce::{Progress, Reduction};
use kirk_network::{Dispatchable, Interval, Network, Time};

use crate::plan::rest;

/// What is to be planned anew: what is left of an execution, from the state it was in.
#[derive(Clone, Debug)]
pub struct Rebuild {
    network: Arc<Network>,
    precedence: Arc<Precedence>,
    progress: Progress,
    version: u64,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct Rebuilt {
    /// `None` if there is no plan: in delayed chains, and when Nature does not keep to the model.
    pub(crate) plan: Option<(Reduction, Dispatchable)>,
    /// The time from which it plans.
    pub(crate) now: Time,
    /// The state of the execution it is for.
    pub(crate) version: u64,
}

impl Rebuild {
    pub(crate) fn new(
        network: Arc<Network>,
        precedence: Arc<Precedence>,
        now: Time,
        known: Vec<Option<Interval>>,
        version: u64,
    ) -> Rebuild {
        Rebuild { network, precedence, progress: Progress { now, known }, version }
    }

    /// The time from which it is planned.
    pub fn now(&self) -> Time {
        self.progress.now
    }

    /// Does the work.
    pub fn run(self) -> Rebuilt {
        Rebuilt {
            plan: rest(&self.network, &self.precedence, &self.progress),
            now: self.progress.now,
            version: self.version,
        }
    }

    /// What is left when it is known that there is no plan, as a journal says, or when none can be made.
    pub fn without_plan(self) -> Rebuilt {
        Rebuilt { plan: None, now: self.progress.now, version: self.version }
    }
}

impl Rebuilt {
    pub(crate) fn is_plan(&self) -> bool {
        self.plan.is_some()
    }
}
