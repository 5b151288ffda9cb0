//! What becomes of news: taken, held until nothing is in flight, of no use, or against the model; and of news that never comes.

use kirk_network::{Duration, EventId, Time};

use super::{Broken, Executive, Output};
use crate::dispatcher::Reception;
use crate::input::{Answer, Why};
use crate::record::{and_goes_on, broken_model};

impl Executive {
    /// Takes news that arrived at a time, usually now.
    pub(super) fn observed(&mut self, arrived: Time, event: EventId) -> Answer {
        if self.dispatcher.known(event).observed.is_some() || self.held.iter().any(|held| held.1 == event) {
            return Answer::Ignored(Why::ObservedBefore);
        }
        if self.network().link_of(event).is_none() {
            return Answer::Ignored(Why::NotNatures);
        }
        // What was due before comes before; at one time Nature comes first.
        self.timeout(arrived.saturating_sub(Duration::SHORTEST));
        if self.over {
            return Answer::Ignored(Why::Over);
        }
        if self.dispatcher.is_in_flight(self.dispatcher.root(event)) {
            self.held.push((arrived, event));
            self.changes += 1;
            return Answer::Accepted;
        }
        let answer = self.hear(arrived, event);
        self.timeout(arrived);
        answer
    }

    /// Takes the news that had to wait for what was in flight.
    pub(super) fn hear_held(&mut self, now: Time) {
        for (arrived, event) in std::mem::take(&mut self.held) {
            if self.dispatcher.is_in_flight(self.dispatcher.root(event)) {
                self.held.push((arrived, event));
            } else {
                self.hear(arrived, event);
            }
        }
        self.dispatcher.handle_timeout(now);
        self.settle(now);
    }

    fn hear(&mut self, arrived: Time, event: EventId) -> Answer {
        match self.dispatcher.handle_observation(arrived, event) {
            Reception::Accepted => {
                self.tell_rounding(arrived, event);
                Answer::Accepted
            }
            Reception::Repeated => Answer::Ignored(Why::ObservedBefore),
            Reception::NotContingent => Answer::Ignored(Why::NotNatures),
            Reception::Impossible { earliest: None, .. } => {
                let start = self.network().label(self.dispatcher.root(event)).to_string();
                Answer::Ignored(Why::NotStarted { start })
            }
            // From where to plan anew is known when nothing is in flight.
            Reception::Impossible { .. } if self.dispatcher.has_in_flight() => {
                self.held.push((arrived, event));
                self.changes += 1;
                Answer::Accepted
            }
            Reception::Impossible { earliest: Some(earliest), latest } => {
                let said = broken_model(self.network(), event, arrived, earliest, latest);
                self.dispatcher.handle_impossible(arrived, event);
                self.broken.push(Broken { event, arrived, said });
                Answer::Accepted
            }
        }
    }

    /// Says so when news counts as if it had come when the model allows it.
    fn tell_rounding(&mut self, arrived: Time, event: EventId) {
        let Some(heard) = self.dispatcher.known(event).observed.filter(|&heard| heard != arrived) else {
            return;
        };
        let (name, slack) = (self.network().label(event), self.slack);
        let first = if heard < arrived { "the latest" } else { "the earliest" };
        let text = format!(
            "news of `{name}` at {arrived} s counts as of {heard} s, {first} the model allows: it is within the tolerance of \
             {slack} s"
        );
        self.outputs.push_back(Output::Note(text));
    }

    /// There is a plan with all the news, whatever the model says.
    pub(super) fn mend(&mut self) {
        for Broken { said, .. } in std::mem::take(&mut self.broken) {
            self.outputs.push_back(Output::Warning(and_goes_on(&said)));
        }
    }

    /// Until when news may still come that is late by no more than is allowed. A mission that ends before that would say of it
    /// that it is lost.
    pub(super) fn overdue(&self, now: Time) -> Option<Time> {
        let network = self.network();
        let unheard = network.contingents().iter().map(|link| link.to);
        let unheard = unheard.filter(|&event| self.dispatcher.known(event).observed.is_none());
        let late = unheard.filter_map(|event| self.dispatcher.observed_by(event)).filter(|&by| by < now);
        late.filter_map(|by| by.checked_add(self.slack)).filter(|&until| until >= now).max()
    }

    /// Says so when news is lost: what was imagined stands, but something is wrong in the world.
    pub(super) fn miss_news(&mut self, now: Time) {
        for (by, event) in std::mem::take(&mut self.awaited) {
            if self.dispatcher.known(event).observed.is_some() {
                continue;
            }
            if by.checked_add(self.slack).is_none_or(|by| by >= now) {
                self.awaited.push((by, event));
                continue;
            }
            self.changes += 1;
            self.outputs.push_back(Output::Warning(format!(
                "nothing was heard of `{}`, though its news was to come by {by} s: the model is broken, or the news is lost; the \
                 mission goes on as if it had happened",
                self.network().label(event)
            )));
        }
    }
}
