//! Dynamic controllability of a network without delays, by closing its labelled graph under the published rules.
//!
//! P. Morris, N. Muscettola, *Temporal dynamic controllability revisited*, AAAI 2005, for reactions that take no time
//! (`w < 0` where the paper has `w <= 0`). An edge `P -> Q` of weight w says `Q - P <= w`; with the upper-case label C,
//! it says so as long as C has not happened, and Q is the activation of C's link; with the lower-case label c, it says
//! what Nature may choose. A link (A, x, y, C) gives `A -c:x-> C`, `C -C:-y-> A` and plain `A -y-> C`, `C -(-x)-> A`.
//!
//! | rule       | from                                   | to                                       |
//! |------------|----------------------------------------|------------------------------------------|
//! | no case    | `P -u-> Q -v-> R`                      | `P -(u+v)-> R`                           |
//! | upper case | `P -u-> Q -C:v-> A`                    | `P -C:(u+v)-> A`                         |
//! | lower case | `A -c:x-> C -w-> R`, w < 0             | `A -(x+w)-> R`                           |
//! | cross case | `A -c:x-> C -B:w-> R`, w < 0, B not C  | `A -B:(x+w)-> R`                         |
//! | removal    | `P -C:w-> A`, w >= -x                  | `P -w-> A`                               |
//!
//! The network is uncontrollable if the graph without lower-case edges and with labels ignored ever has a negative
//! cycle, and controllable if nothing more follows. After as many rounds as there are pairs of events something must
//! have been going round in circles, which means the former.

use kirk_network::{Bound, EventId, Network};

/// No edge. Far from overflow even when two are added.
pub const NONE: i64 = i64::MAX / 4;

/// True if the network, in which all delays must be zero, is dynamically controllable.
pub fn dynamically_controllable(network: &Network) -> bool {
    closed(network).is_some()
}

/// Everything that follows from a network without delays; `None` if it is not dynamically controllable.
pub fn closed(network: &Network) -> Option<Closed> {
    let mut graph = Graph::new(network);
    let pairs = graph.size * graph.size;
    for _ in 0..=pairs {
        if graph.has_negative_cycle() {
            return None;
        }
        if !graph.round() {
            let Graph { ordinary, upper, .. } = graph;
            return Some(Closed { ordinary, upper });
        }
    }
    None
}

/// A closed graph, by event numbers. Entries of [`NONE`] are no edges.
pub struct Closed {
    /// `ordinary[p][q]` is the weight of `P -> Q`, in microseconds.
    pub ordinary: Vec<Vec<i64>>,
    /// `upper[c][p]` is the weight of the upper-case edge from P to the activation of link c.
    pub upper: Vec<Vec<i64>>,
}

/// A contingent link, times in microseconds.
struct Link {
    from: usize,
    to: usize,
    lower: i64,
}

struct Graph {
    /// The number of events.
    size: usize,
    links: Vec<Link>,
    /// Plain edges: `ordinary[p][q]` is the weight of `P -> Q`.
    ordinary: Vec<Vec<i64>>,
    /// `upper[c][p]` is the weight of the upper-case edge from P to the activation of link c.
    upper: Vec<Vec<i64>>,
}

impl Graph {
    fn new(network: &Network) -> Graph {
        let size = network.events().len();
        let mut ordinary = vec![vec![NONE; size]; size];
        let mut add = |from: EventId, to: EventId, weight: i64| {
            lower_to(&mut ordinary[from.index()][to.index()], weight);
        };
        for event in network.event_ids() {
            add(event, network.origin(), 0);
            add(event, event, 0);
        }
        for requirement in network.requirements() {
            if let Bound::Finite(upper) = requirement.upper {
                add(requirement.from, requirement.to, upper.as_micros());
            }
            if let Bound::Finite(lower) = requirement.lower {
                add(requirement.to, requirement.from, -lower.as_micros());
            }
        }
        let mut upper = vec![vec![NONE; size]; network.contingents().len()];
        let mut links = Vec::new();
        for (index, link) in network.contingents().iter().enumerate() {
            let none = link.delay.min.as_micros() == 0 && link.delay.max == Bound::Finite(link.delay.min);
            assert!(none, "the closure knows nothing of delays");
            add(link.from, link.to, link.upper.as_micros());
            add(link.to, link.from, -link.lower.as_micros());
            upper[index][link.to.index()] = -link.upper.as_micros();
            links.push(Link { from: link.from.index(), to: link.to.index(), lower: link.lower.as_micros() });
        }
        Graph { size, links, ordinary, upper }
    }

    /// Applies every rule to every edge; true if anything new came of it.
    fn round(&mut self) -> bool {
        let mut changed = false;
        for middle in 0..self.size {
            for from in 0..self.size {
                let first = self.ordinary[from][middle];
                if first == NONE {
                    continue;
                }
                for to in 0..self.size {
                    let second = self.ordinary[middle][to];
                    if second != NONE {
                        changed |= lower_to(&mut self.ordinary[from][to], first + second);
                    }
                }
                for upper in &mut self.upper {
                    if upper[middle] != NONE {
                        let weight = first + upper[middle];
                        changed |= lower_to(&mut upper[from], weight);
                    }
                }
            }
        }
        for (index, link) in self.links.iter().enumerate() {
            for to in 0..self.size {
                let weight = self.ordinary[link.to][to];
                if weight < 0 {
                    changed |= lower_to(&mut self.ordinary[link.from][to], link.lower + weight);
                }
            }
            for (label, upper) in self.upper.iter_mut().enumerate() {
                if label != index && upper[link.to] < 0 {
                    let weight = link.lower + upper[link.to];
                    changed |= lower_to(&mut upper[link.from], weight);
                }
            }
        }
        for (link, upper) in self.links.iter().zip(&self.upper) {
            for (from, &weight) in upper.iter().enumerate() {
                if weight != NONE && weight >= -link.lower {
                    changed |= lower_to(&mut self.ordinary[from][link.from], weight);
                }
            }
        }
        changed
    }

    /// True if the plain edges and the upper-case edges, taken as plain ones, have a negative cycle (Floyd, Warshall).
    fn has_negative_cycle(&self) -> bool {
        let mut distance = self.ordinary.clone();
        for (link, upper) in self.links.iter().zip(&self.upper) {
            for (from, &weight) in upper.iter().enumerate() {
                lower_to(&mut distance[from][link.from], weight);
            }
        }
        for middle in 0..self.size {
            for from in 0..self.size {
                for to in 0..self.size {
                    let (first, second) = (distance[from][middle], distance[middle][to]);
                    if first != NONE && second != NONE {
                        lower_to(&mut distance[from][to], first + second);
                    }
                }
            }
            if (0..self.size).any(|event| distance[event][event] < 0) {
                return true;
            }
        }
        false
    }
}

/// Lowers the entry to `weight`; true if it was higher.
fn lower_to(entry: &mut i64, weight: i64) -> bool {
    let lowers = weight < *entry;
    if lowers {
        *entry = weight;
    }
    lowers
}
