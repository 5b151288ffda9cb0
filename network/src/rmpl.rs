//! A network as an RMPL program: every contingent link an activity, as well as what we execute from `x:start` to `x:end`; every other
//! requirement a `between`.
//!
//! The program means the same network and reads like a list. It is for networks that were generated or converted and are
//! to be gone on with by hand.

use std::collections::BTreeSet;
use std::fmt::Write;

use crate::model::{ContingentLink, Delay, EventId, Network, Requirement};
use crate::time::{Bound, Duration};

/// Writes a network as a program that compiles to it, with some events more (those of `main` and of its forms).
pub fn write(network: &Network) -> String {
    let writer = Writer {
        network,
        addresses: vec![String::new(); network.events().len()],
        taken: ["main".to_string()].into_iter().collect(),
        programs: String::new(),
        activities: String::new(),
        constraints: String::new(),
    };
    writer.write()
}

struct Writer<'a> {
    network: &'a Network,
    /// What to call each event in a `between`: `(start x)`, `(end x)`; empty if not yet known.
    addresses: Vec<String>,
    /// Names of programs and labels.
    taken: BTreeSet<String>,
    programs: String,
    activities: String,
    constraints: String,
}

impl Writer<'_> {
    fn write(mut self) -> String {
        let network = self.network;
        let origin = self.label(network.origin());
        let mut joins = Vec::new();
        for link in network.contingents() {
            joins.extend(self.activity(link));
        }
        let ours: Vec<bool> = network.requirements().iter().map(|it| self.activity_of_ours(it)).collect();
        for event in network.event_ids() {
            if self.addresses[event.index()].is_empty() {
                let label = self.label(event);
                let _ = writeln!(self.activities, "      (label {label} (delay 0 0))");
            }
        }
        for (event, start) in joins {
            let _ = writeln!(
                self.constraints,
                "  (between {} {start} (simple-temporal :lower-bound 0 :upper-bound 0))",
                self.addresses[event.index()]
            );
        }
        for (requirement, _) in network.requirements().iter().zip(&ours).filter(|(_, is_said)| !**is_said) {
            self.requirement(requirement.from, requirement.to, requirement.lower, requirement.upper);
        }
        format!(
            ";; {}\n\n{}(define-control-program main ()\n  (sequence (:slack nil)\n    (label {origin} (delay 0 0))\n    \
             (parallel (:slack t)\n{}    ))\n{})\n",
            network.name(),
            self.programs,
            self.activities,
            self.constraints,
        )
    }

    /// A free name for a program or a label, as like the wanted one as possible.
    fn name(&mut self, wanted: &str) -> String {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./+*".contains(c);
        let mut name: String =
            wanted.to_lowercase().chars().map(|c| if plain(c) { c } else { '.' }).collect();
        if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
            name.insert_str(0, "e-");
        }
        while !self.taken.insert(name.clone()) {
            name.push('+');
        }
        name
    }

    fn label(&mut self, event: EventId) -> String {
        let wanted = self.network.label(event).to_string();
        let label = self.name(&wanted);
        self.addresses[event.index()] = format!("(start {label})");
        label
    }

    /// The activity of a link; if it cannot give its activation a name, what its start must be joined with.
    fn activity(&mut self, link: &ContingentLink) -> Option<(EventId, String)> {
        let (from, to) = (self.network.label(link.from), self.network.label(link.to));
        let base = to.strip_suffix(":end").unwrap_or(to);
        let name = self.name(base);
        let mut bounds = format!(":lower-bound {} :upper-bound {}", link.lower, link.upper);
        if link.delay != Delay::NONE {
            let max = link.delay.max.finite().map_or(":infinity".to_string(), |max| max.to_string());
            let _ = write!(bounds, "\n                      :min-observation-delay {}", link.delay.min);
            let _ = write!(bounds, "\n                      :max-observation-delay {max}");
        }
        let _ = write!(
            self.programs,
            "(define-control-program {name} ()\n  (declare (primitive)\n    (duration (simple {bounds})\n      \
             :contingent t)))\n\n"
        );
        let _ = writeln!(self.activities, "      ({name})");
        self.addresses[link.to.index()] = format!("(end {name})");
        let start = format!("(start {name})");
        let executable = self.network.link_of(link.from).is_none();
        if executable
            && from.strip_suffix(":start") == Some(base)
            && self.addresses[link.from.index()].is_empty()
        {
            self.addresses[link.from.index()] = start;
            return None;
        }
        Some((link.from, start))
    }

    /// True if a requirement says how long something of ours takes, which becomes an activity.
    fn activity_of_ours(&mut self, &Requirement { from, to, lower, upper }: &Requirement) -> bool {
        let is_free = |event: EventId| {
            self.network.link_of(event).is_none() && self.addresses[event.index()].is_empty()
        };
        let (start, end) = (self.network.label(from), self.network.label(to));
        let base = start.strip_suffix(":start").filter(|base| end.strip_suffix(":end") == Some(base));
        let least = lower.finite().filter(|lower| *lower >= Duration::ZERO);
        let (Some(base), Some(least), true) = (base, least, is_free(from) && is_free(to)) else {
            return false;
        };
        let name = self.name(base);
        let most = upper.finite().map_or(String::new(), |upper| format!(" :upper-bound {upper}"));
        let _ = write!(
            self.programs,
            "(define-control-program {name} ()\n  (declare (primitive)\n    (duration (simple :lower-bound {least}{most}))))\n\n"
        );
        let _ = writeln!(self.activities, "      ({name})");
        self.addresses[from.index()] = format!("(start {name})");
        self.addresses[to.index()] = format!("(end {name})");
        true
    }

    fn requirement(&mut self, from: EventId, to: EventId, lower: Bound, upper: Bound) {
        // Nothing comes before the origin anyway.
        if from == self.network.origin() && lower == Bound::ZERO && upper == Bound::Infinite {
            return;
        }
        let address = |event: EventId| self.addresses[event.index()].clone();
        let (from, to, bounds) = match (lower, upper) {
            (Bound::Infinite, Bound::Infinite) => return,
            // A `between` always has a lower bound: the other way round this one is one.
            (Bound::Infinite, Bound::Finite(upper)) => {
                let lower = -upper;
                (address(to), address(from), format!(":lower-bound {lower}"))
            }
            (Bound::Finite(lower), Bound::Infinite) => {
                (address(from), address(to), format!(":lower-bound {lower}"))
            }
            (Bound::Finite(lower), Bound::Finite(upper)) => {
                (address(from), address(to), format!(":lower-bound {lower} :upper-bound {upper}"))
            }
        };
        let _ = writeln!(self.constraints, "  (between {from} {to} (simple-temporal {bounds}))");
    }
}
