//! The rules on which views rest, each of which a test can leave out to see that it is needed.

use kirk_network::{Bound, Delay};

/// True for what is kept. Only tests have reason to leave any out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rules {
    /// Agents tell on what they hear, whoever may have been told already.
    pub flooding: bool,
    /// News takes as long as the longest delays allow.
    pub longest: bool,
    /// News is as soon as the shortest delays allow.
    pub shortest: bool,
    /// Who promises something has it as a requirement.
    pub own_promise: bool,
    /// What is promised must not in the end be measured from itself.
    pub acyclic: bool,
    /// [0, 0] between events of two agents does not make them one.
    pub no_merging: bool,
    /// News of what has not begun here is held.
    pub hold: bool,
}

impl Rules {
    /// All of them.
    pub const ALL: Rules = Rules {
        flooding: true,
        longest: true,
        shortest: true,
        own_promise: true,
        acyclic: true,
        no_merging: true,
        hold: true,
    };

    pub(crate) fn delay(&self, Delay { min, max }: Delay) -> Delay {
        Delay {
            min: if self.shortest { min } else { max.finite().unwrap_or(min) },
            max: if self.longest { max } else { Bound::Finite(min) },
        }
    }
}

impl Default for Rules {
    fn default() -> Rules {
        Rules::ALL
    }
}
