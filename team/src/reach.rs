//! How late news of one agent reaches another, if everybody tells on what they hear: shortest paths over the links.
//!
//! With flooding news takes, at the least, the shortest path over the shortest delays and, at the most, the shortest path over the
//! longest ones; the two need not be the same path. Where stamped links alone are as fast at the most, the stamp says when the news
//! was told, and who waits until then knows it as exactly as after a fixed delay.

use kirk_network::{Bound, Delay, Duration};

use crate::model::AgentId;

/// A link in one direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arc {
    /// Who tells.
    pub from: AgentId,
    /// Who is told.
    pub to: AgentId,
    /// How long a message takes.
    pub delay: Delay,
    /// Whether a message says when it was told.
    pub stamped: bool,
    /// The link as it was written, by its number.
    pub link: u32,
}

/// No path.
const NEVER: i64 = i64::MAX;
const NONE: u32 = u32::MAX;

/// All pairs of agents.
#[derive(Clone, Debug)]
pub struct Reach {
    agents: usize,
    least: Paths,
    most: Paths,
    /// Over stamped links alone.
    stamped: Paths,
}

/// The lengths of shortest paths, and the arc each begins with, by `from * agents + to`.
#[derive(Clone, Debug)]
struct Paths {
    length: Vec<i64>,
    first: Vec<u32>,
}

impl Reach {
    /// Of agents and their links in each direction.
    pub(crate) fn new(agents: usize, arcs: &[Arc]) -> Reach {
        let least = Paths::new(agents, arcs, |arc| arc.delay.min.as_micros());
        let longest = |arc: &Arc| arc.delay.max.finite().map_or(NEVER, Duration::as_micros);
        let most = Paths::new(agents, arcs, longest);
        let stamped = Paths::new(agents, arcs, |arc| if arc.stamped { longest(arc) } else { NEVER });
        Reach { agents, least, most, stamped }
    }

    /// When news of `from` reaches `to`; `None` if there is no way for it.
    pub fn delay(&self, from: AgentId, to: AgentId) -> Option<Delay> {
        let at = self.at(from, to);
        let least = self.least.length[at];
        let most = self.most.length[at];
        (least < NEVER).then(|| {
            let max = if most < NEVER { Bound::Finite(Duration::from_micros(most)) } else { Bound::Infinite };
            let min = if self.is_stamped(from, to) { most } else { least };
            Delay { min: Duration::from_micros(min), max }
        })
    }

    /// True if news of `from` comes to `to` with a stamp no later than without one.
    pub fn is_stamped(&self, from: AgentId, to: AgentId) -> bool {
        let at = self.at(from, to);
        from != to && self.most.length[at] < NEVER && self.stamped.length[at] == self.most.length[at]
    }

    /// The arcs over which news takes longest, and those over which it can be soonest, by their numbers.
    pub(crate) fn ways(&self, arcs: &[Arc], from: AgentId, to: AgentId) -> [Vec<u32>; 2] {
        let most = if self.is_stamped(from, to) { &self.stamped } else { &self.most };
        let least = if self.is_stamped(from, to) { most } else { &self.least };
        [most, least].map(|paths| paths.way(arcs, self.agents, from, to))
    }

    fn at(&self, from: AgentId, to: AgentId) -> usize {
        from.index() * self.agents + to.index()
    }
}

impl Paths {
    /// R. Floyd and S. Warshall, 1962; teams are small.
    fn new(agents: usize, arcs: &[Arc], length_of: impl Fn(&Arc) -> i64) -> Paths {
        let mut length = vec![NEVER; agents * agents];
        let mut first = vec![NONE; agents * agents];
        for agent in 0..agents {
            length[agent * agents + agent] = 0;
        }
        for (number, arc) in arcs.iter().enumerate() {
            let (at, own) = (arc.from.index() * agents + arc.to.index(), length_of(arc));
            if own < length[at] {
                length[at] = own;
                first[at] = number as u32;
            }
        }
        for middle in 0..agents {
            for from in 0..agents {
                let there = length[from * agents + middle];
                if there == NEVER {
                    continue;
                }
                for to in 0..agents {
                    let sum = there.saturating_add(length[middle * agents + to]);
                    if sum < length[from * agents + to] {
                        length[from * agents + to] = sum;
                        first[from * agents + to] = first[from * agents + middle];
                    }
                }
            }
        }
        Paths { length, first }
    }

    fn way(&self, arcs: &[Arc], agents: usize, from: AgentId, to: AgentId) -> Vec<u32> {
        let mut way = Vec::new();
        let mut at = from;
        while at != to {
            let first = self.first[at.index() * agents + to.index()];
            if first == NONE {
                break;
            }
            way.push(first);
            at = arcs[first as usize].to;
        }
        way
    }
}
