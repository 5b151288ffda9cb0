//! Names of episodes: `shower`, then `shower#2`; `main.1` for forms no user gave a name. No two are equal.

use std::collections::{HashMap, HashSet};

use crate::typed::Model;

/// Hands out names.
pub(super) struct Occurrences {
    /// The names of all programs: the first occurrence of each has the bare name, so nothing else may.
    reserved: HashSet<String>,
    counts: HashMap<String, u32>,
}

impl Occurrences {
    pub(super) fn new(model: &Model) -> Occurrences {
        Occurrences {
            reserved: model.programs.iter().map(|program| program.name.name.clone()).collect(),
            counts: HashMap::new(),
        }
    }

    /// The name of the next occurrence of a program.
    pub(super) fn of(&mut self, program: &str) -> String {
        let count = match self.counts.get_mut(program) {
            Some(count) => count,
            None => {
                self.counts.insert(program.to_string(), 1);
                return program.to_string();
            }
        };
        loop {
            *count += 1;
            let name = format!("{program}#{count}");
            if !self.reserved.contains(&name) {
                return name;
            }
        }
    }

    /// The next name inside the occurrence `name`, of which `count` were given so far.
    pub(super) fn inside(&self, name: &str, count: &mut u32) -> String {
        loop {
            *count += 1;
            let inner = format!("{name}.{count}");
            if !self.reserved.contains(&inner) {
                return inner;
            }
        }
    }
}
