//! Labels as names of events, and the constraints of `between`, once all episodes are known.

use std::collections::{BTreeMap, HashMap};

use super::Expander;
use super::problem::Problem;
use super::scope::{Scopes, Target, Wanted, shown};
use crate::ast::Value;
use crate::episode::{Constraint, Episode, EventOf};
use crate::typed;

/// Gives episodes the names of their labels, as far as nothing else is called that.
pub(super) fn give_names(root: &mut Episode, scopes: &Scopes) {
    let mut labels: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for named in &scopes.named {
        if let Target::Label(name) = &named.target {
            labels.entry(shown(name, &named.arguments)).or_default().push(&named.episode);
        }
    }
    if labels.is_empty() {
        return;
    }
    let mut open = vec![&*root];
    while let Some(episode) = open.pop() {
        labels.remove(&episode.name);
        open.extend(&episode.parts);
    }
    let mut by_episode: HashMap<&str, Vec<String>> = HashMap::new();
    for (label, episodes) in labels {
        if let [only] = episodes.as_slice() {
            by_episode.entry(only).or_default().push(label);
        }
    }
    let mut open = vec![root];
    while let Some(episode) = open.pop() {
        episode.labels = by_episode.remove(episode.name.as_str()).unwrap_or_default();
        open.extend(&mut episode.parts);
    }
}

impl Expander<'_> {
    /// Looks up the events of every `between` and adds the constraints to the outermost episode.
    pub(super) fn constrain(&mut self, root: &mut Episode) {
        if self.betweens.is_empty() || self.exhausted {
            return;
        }
        let index = self.scopes.index();
        for pending in &self.betweens {
            let find = |(event, arguments): &(&typed::EventOf, Option<Vec<Value>>)| {
                let wanted = Wanted {
                    scope: pending.scope,
                    name: &event.name.name,
                    may_be_label: event.name.package.is_none(),
                    program: event.program,
                    is_occurrence: event.is_occurrence,
                    arguments: arguments.clone(),
                    span: event.span,
                };
                index.find(&wanted).map(|episode| EventOf { episode: episode.to_string(), end: event.end })
            };
            match (find(&pending.from), find(&pending.to)) {
                (Ok(from), Ok(to)) if from == to => {
                    let (from, to) = (pending.from.0.span, pending.to.0.span);
                    self.problems.push(Problem::SameEvent { from, to });
                }
                (Ok(from), Ok(to)) => {
                    root.constraints.push(Constraint { from, to, interval: pending.interval });
                }
                (from, to) => {
                    for problem in [from.err(), to.err()].into_iter().flatten() {
                        self.problems.push(*problem);
                    }
                }
            }
        }
    }
}
