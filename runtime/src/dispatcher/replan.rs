//! Planning anew: when news calls for it, from what is known, and how the new plan is followed.

use std::sync::Arc;

use kirk_network::precedence::Precedence;
use kirk_network::{EventId, Network, Time};

use super::{Dispatcher, Reception, Settings, agenda, whereabouts};
use crate::cause::Cause;
use crate::execution::How;
use crate::knowledge::Knowledge;
use crate::plan::Plan;
use crate::rebuild::{Rebuild, Rebuilt};
use crate::record::{and_fails, and_goes_on, broken_model};

/// What became of a new plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Adoption {
    /// It is followed from now on.
    Followed,
    /// There is none: the old plan stands, unless it is broken.
    NoPlan,
    /// Something has happened since it was asked for; it has to be asked for again.
    TooLate,
}

/// What became of news that was planned with at once.
pub(crate) enum Taken {
    /// It is of what has not begun, which nothing can be heard of.
    NotBegun,
    /// The model allows it, or it says nothing new.
    Possible,
    /// The model rules it out: what is wrong with it, in a sentence, and whether the rest can still be guaranteed.
    Broken { said: String, goes_on: bool },
}

impl Dispatcher {
    /// Takes news where planning takes no time, also if the model rules it out.
    pub(crate) fn hear_and_plan(&mut self, now: Time, event: EventId) -> Taken {
        match self.handle_observation(now, event) {
            Reception::Impossible { earliest: None, .. } => Taken::NotBegun,
            Reception::Impossible { earliest: Some(earliest), latest } => {
                let said = broken_model(self.network(), event, now, earliest, latest);
                self.handle_impossible(now, event);
                let goes_on = self.plan_at_once(now) != Some(Adoption::NoPlan);
                Taken::Broken { said: if goes_on { and_goes_on(&said) } else { and_fails(&said) }, goes_on }
            }
            Reception::Accepted | Reception::Repeated | Reception::NotContingent => {
                self.plan_at_once(now);
                Taken::Possible
            }
        }
    }

    /// Plans anew as long as news calls for it, where that takes no time. Returns what became of the last plan.
    pub fn plan_at_once(&mut self, now: Time) -> Option<Adoption> {
        let mut last = None;
        while let Some(rebuild) = self.poll_rebuild(now) {
            last = Some(self.handle_rebuilt(rebuild.run()));
        }
        last
    }

    /// What is to be planned anew because of news, if anything is. While events are in flight it is not known from where
    /// to plan, so that has to wait.
    pub fn poll_rebuild(&mut self, now: Time) -> Option<Rebuild> {
        self.rebuild_from(self.now.max(now))
    }

    /// The same, planned from a time that may have passed since it was asked for, as a journal says.
    pub(crate) fn rebuild_from(&mut self, from: Time) -> Option<Rebuild> {
        if !self.stale || self.asked || !self.in_flight.is_empty() || self.missed.is_some() {
            return None;
        }
        self.asked = true;
        Some(self.rebuild(from))
    }

    /// True if this is the plan for all that has happened.
    pub(crate) fn is_current(&self, rebuilt: &Rebuilt) -> bool {
        rebuilt.version == self.version
    }

    /// Goes on with a new plan, or without one.
    pub fn handle_rebuilt(&mut self, rebuilt: Rebuilt) -> Adoption {
        // The version proves that nothing was dispatched, fixed or heard since the question; time alone may have passed.
        // What the new plan had due in that time is done by the timeout that follows.
        self.asked = false;
        if !self.is_current(&rebuilt) {
            return Adoption::TooLate;
        }
        // It knows all the news there is.
        (self.stale, self.broken) = (false, false);
        let Some((reduction, net)) = rebuilt.plan else {
            // In a delayed chain the reduction may be too careful to see that there is a way. Then the old plan stands.
            self.fix_heard();
            return Adoption::NoPlan;
        };
        self.agenda = agenda(&reduction, &net, |event| self.settings.lead_of(self.is_carried_out(event)));
        self.reduction = reduction;
        self.take_up(rebuilt.now);
        Adoption::Followed
    }

    /// True if the news of an event narrowed what was assumed of it, and that makes a difference to what is left.
    pub(super) fn says_more(&self, event: EventId) -> bool {
        let executed = |event: EventId| self.agenda.executed(self.reduction.places[event.index()].node);
        // Not yet executed: the plan is still to wait for it.
        let Some(node) = executed(event) else { return true };
        let assumed = whereabouts(&self.reduction.places[event.index()], node);
        let to_come = |event| executed(event).is_none();
        self.happened(event) != Some(assumed)
            && self.measured.concerns_the_rest(event, &self.knowledge, to_come)
    }

    /// Puts what is known in place of the links, for what is left to be planned anew.
    fn rebuild(&mut self, from: Time) -> Rebuild {
        let network = Arc::clone(&self.network);
        let known = self.knowledge.progress(&network);
        let precedence = Arc::clone(&self.precedence);
        Rebuild::new(network, precedence, from, known, self.version)
    }

    /// The events of which something has become known since the last checkpoint. The time is not among what is known: it
    /// passes without a record, and the first thing done with a plan has its own.
    pub(crate) fn checkpoint(&mut self) -> Vec<EventId> {
        self.knowledge.take_touched()
    }

    /// Goes on from what is known, with the plan that was made of it at some time; `None` if there is none.
    pub(crate) fn restored(
        network: &Arc<Network>,
        settings: Settings,
        mut knowledge: Knowledge,
        version: u64,
        planned: Time,
    ) -> Option<Dispatcher> {
        let known = knowledge.progress(network);
        let precedence = Arc::new(Precedence::new(network));
        let rebuild = Rebuild::new(Arc::clone(network), Arc::clone(&precedence), planned, known, version);
        let (reduction, net) = rebuild.run().plan?;
        let plan = Plan { network: Arc::clone(network), reduction, net, precedence };
        let mut dispatcher = Dispatcher::following(plan, settings, knowledge);
        dispatcher.version = version;
        dispatcher.take_up(planned);
        Some(dispatcher)
    }

    /// Begins to follow a plan that was made at some time: what it takes for known is fixed.
    fn take_up(&mut self, planned: Time) {
        self.active.clear();
        self.activate_from_origin();
        let anew = self.anew();
        self.anew = Some(anew);
        for event in self.network.event_ids() {
            let known = *self.known(event);
            if known.settled && known.fixed.is_none() {
                let (time, how, cause) = match known.observed {
                    // Lateness of ours is not held against the news.
                    Some(heard) if self.recorded(heard, planned, planned) == heard => {
                        (heard, How::Observed, Cause::Observed)
                    }
                    Some(_) => (planned, How::Buffered, anew),
                    None => (planned, How::Imagined, anew),
                };
                self.fix(event, time, how, cause);
            }
        }
    }

    /// What was heard and has no place of its own in the plan is fixed when it was heard.
    pub(crate) fn fix_heard(&mut self) {
        for event in self.network.event_ids() {
            let known = *self.known(event);
            if let (Some(heard), None, true) = (known.observed, known.fixed, self.is_hidden(event)) {
                self.fix(event, heard, How::Observed, Cause::Observed);
            }
        }
    }
}
