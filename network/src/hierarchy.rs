//! Shortest paths from every node, by eliminating one node after the other.
//!
//! L. Planken, M. de Weerdt, R. van der Krogt, *Computing all-pairs shortest paths by leveraging low treewidth*, 2012; as
//! passes over the nodes: D. Delling, A. V. Goldberg, A. Nowatzyk, R. F. Werneck, *PHAST*, 2013. Eliminating a node puts
//! an edge in place of each path through it, from neighbour to neighbour. Then for every shortest path there is one that
//! first climbs to nodes eliminated later and later and then descends. Two passes over the nodes, without a queue, find
//! all that start at a node; here they are made for [`LANES`] nodes at once. Missions hang together loosely (activities
//! in sequence, a few constraints across), so few edges are added: some four for each node.
//!
//! All lengths in here are reduced by potentials that fit: `potential(from) <= weight + potential(to)` for every edge. So
//! none is negative, and adding to [`NOWHERE`] never makes it look like somewhere.

mod elimination;
mod thin;

use std::ops::Range;

use crate::stnu::{Edge, LIMIT};

/// So many searches are made at once.
pub(crate) const LANES: usize = 8;

/// A number for each search.
type Lanes = [i64; LANES];

/// The longest path: one that is longer than this is beyond [`LIMIT`] in truth, so it says nothing and is left out (see
/// `Stnu::horizon`).
// Potentials are within LIMIT, so length and true distance differ by 2 LIMIT at most: beyond 4 LIMIT the distance is beyond
// 2 LIMIT. The largest sums formed stay below 16 LIMIT = 2^63.
const FARTHEST: i64 = 4 * LIMIT;

/// No path. More than the sum of any two lengths.
const NOWHERE: i64 = 2 * FARTHEST + 1;

/// No inner node. More than a distance less a potential.
const NOTHING: i64 = FARTHEST + 2 * LIMIT;

/// The shortest paths between two nodes, as far as they lead through nodes eliminated before both.
#[derive(Clone, Copy)]
struct Way {
    /// The other node.
    end: u32,
    length: i64,
    /// The least distance of an inner node from the start, less the potential of the start.
    least: i64,
}

/// For each rank the ways between the node of that rank and nodes of higher rank, which are called by their rank.
struct Ways {
    start: Vec<u32>,
    ways: Vec<Way>,
}

impl Ways {
    fn with_capacity(ways: usize) -> Ways {
        Ways { start: vec![0], ways: Vec::with_capacity(ways) }
    }

    /// Adds those of the next rank.
    fn push(&mut self, ways: Vec<Way>) {
        self.ways.extend(ways);
        self.start.push(self.ways.len() as u32);
    }

    /// How many ranks there are.
    fn count(&self) -> usize {
        self.start.len() - 1
    }

    #[inline]
    fn range(&self, rank: usize) -> Range<usize> {
        self.start[rank] as usize..self.start[rank + 1] as usize
    }

    #[inline]
    fn of(&self, rank: usize) -> &[Way] {
        &self.ways[self.range(rank)]
    }

    /// Keeps those that are needed.
    fn retain(&mut self, needed: &[bool]) {
        let mut kept = Ways::with_capacity(needed.iter().filter(|needed| **needed).count());
        for rank in 0..self.count() {
            kept.ways.extend(self.range(rank).filter(|&at| needed[at]).map(|at| self.ways[at]));
            kept.start.push(kept.ways.len() as u32);
        }
        *self = kept;
    }
}

/// A network prepared for finding shortest paths. The rank of a node is the number of those eliminated before it.
pub(crate) struct Hierarchy {
    /// The nodes that have edges, by rank.
    nodes: Vec<u32>,
    /// [`crate::stnu::NONE`] for nodes without edges.
    rank: Vec<u32>,
    /// By rank.
    potential: Vec<i64>,
    /// From each node to those of higher rank.
    up: Ways,
    /// To each node from those of higher rank.
    down: Ways,
}

/// The shortest paths from one node to another.
pub(crate) struct Path {
    /// Their length.
    pub(crate) distance: i64,
    /// The least distance of an inner node of any of them; more than any distance if there is none.
    pub(crate) least: i64,
}

/// What a few searches know of each node, by rank. To be used again, as it is large.
#[derive(Default)]
pub(crate) struct Searches {
    length: Vec<Lanes>,
    /// Known to some search on its way up.
    open: Vec<bool>,
    lowest: usize,
}

impl Searches {
    /// Forgets everything.
    pub(crate) fn restart(&mut self, hierarchy: &Hierarchy) {
        let count = hierarchy.nodes.len();
        self.length.clear();
        self.length.resize(count, [NOWHERE; LANES]);
        self.open.clear();
        self.open.resize(count, false);
        self.lowest = count;
    }

    /// A search is to start at this node, where it has this length behind it.
    pub(crate) fn start(&mut self, hierarchy: &Hierarchy, lane: usize, node: u32, length: i64) {
        let rank = hierarchy.rank[node as usize] as usize;
        if let Some(known) = self.length.get_mut(rank) {
            known[lane] = length.min(known[lane]);
            self.open[rank] = true;
            self.lowest = self.lowest.min(rank);
        }
    }

    /// What a search has found: a length, more than that of any path if there is none.
    #[inline]
    pub(crate) fn length(&self, hierarchy: &Hierarchy, lane: usize, node: u32) -> i64 {
        self.length.get(hierarchy.rank[node as usize] as usize).map_or(NOWHERE, |known| known[lane])
    }
}

impl Hierarchy {
    /// Prepares a network. The potentials must fit.
    pub(crate) fn new(edges: &[Edge], potential: &[i64]) -> Hierarchy {
        elimination::eliminate(edges, potential)
    }

    /// Takes all searches from where they start forward to all other nodes.
    pub(crate) fn lengths_from(&self, searches: &mut Searches) {
        spread(&self.up, &self.down, searches);
    }

    /// Takes all searches from where they start backward to all other nodes.
    pub(crate) fn lengths_to(&self, searches: &mut Searches) {
        spread(&self.down, &self.up, searches);
    }

    /// Finds the shortest paths from every node to every other that are not beyond [`LIMIT`]: calls
    /// `found(from, to, path)`. There must be no cycle of weight 0.
    pub(crate) fn all_paths(&self, mut found: impl FnMut(u32, u32, Path)) {
        let count = self.nodes.len();
        let mut known = vec![Known::NOTHING; count];
        let mut open = vec![false; count];
        // A shortest path that climbs and then descends: every way up goes to a higher rank, so one pass from low to high
        // finds all that is reached by climbing, and one pass from high to low adds the descents, in which every node looks
        // at ranks above its own, where nothing changes any more. Nodes of neighbouring ranks have much of their way up in
        // common, which is why they are taken together.
        for first in (0..count).step_by(LANES) {
            known.fill(Known::NOTHING);
            let sources = first..count.min(first + LANES);
            for rank in sources.clone() {
                known[rank].length[rank - first] = 0;
                open[rank] = true;
            }
            for rank in first..count {
                if std::mem::take(&mut open[rank]) {
                    let here = known[rank].to_go_on(rank, first, self.potential[rank]);
                    known[rank] = here;
                    for way in self.up.of(rank) {
                        open[way.end as usize] = true;
                        known[way.end as usize].improve(&here, way);
                    }
                }
            }
            for rank in (0..count).rev() {
                let mut here = known[rank];
                for way in self.down.of(rank) {
                    here.improve(&known[way.end as usize], way);
                }
                known[rank] = here.to_go_on(rank, first, self.potential[rank]);
            }
            for (rank, &node) in self.nodes.iter().enumerate() {
                for source in sources.clone() {
                    let length = known[rank].length[source - first];
                    let base = self.potential[source];
                    let distance = length - self.potential[rank] + base;
                    if rank == source || length > FARTHEST || distance > LIMIT {
                        continue;
                    }
                    let least = known[rank].least[source - first] + base;
                    found(self.nodes[source], node, Path { distance, least });
                }
            }
        }
    }
}

/// What is known of a node when the shortest paths from several sources are searched.
#[derive(Clone, Copy)]
struct Known {
    length: Lanes,
    /// See [`Way::least`].
    least: Lanes,
    /// The same for the paths that go on from here.
    least_on: Lanes,
}

impl Known {
    const NOTHING: Known =
        Known { length: [NOWHERE; LANES], least: [NOTHING; LANES], least_on: [NOTHING; LANES] };

    /// The node becomes an inner one of the paths that go on, unless they start here.
    #[inline(always)]
    fn to_go_on(mut self, rank: usize, first: usize, potential: i64) -> Known {
        for lane in 0..LANES {
            self.least_on[lane] = self.least[lane].min(self.length[lane] - potential);
        }
        if let Some(on) = rank.checked_sub(first).and_then(|lane| self.least_on.get_mut(lane)) {
            *on = NOTHING;
        }
        self
    }

    /// Takes what is better, what is known or the way from another node: the shorter, and of equals both.
    #[inline(always)]
    fn improve(&mut self, from: &Known, way: &Way) {
        for lane in 0..LANES {
            let length = from.length[lane] + way.length;
            let least = from.least_on[lane].min(from.length[lane] + way.least);
            let known = (self.length[lane], self.least[lane]);
            let least_of_equals = if length == known.0 { least.min(known.1) } else { known.1 };
            self.least[lane] = if length < known.0 { least } else { least_of_equals };
            self.length[lane] = length.min(known.0);
        }
    }
}

/// Climbs by the ways of the nodes that are known, then descends to all nodes.
fn spread(climb: &Ways, descend: &Ways, searches: &mut Searches) {
    let Searches { length, open, lowest, .. } = searches;
    let count = length.len();
    for rank in *lowest..count {
        if std::mem::take(&mut open[rank]) {
            let here = length[rank];
            for way in climb.of(rank) {
                let end = way.end as usize;
                open[end] = true;
                shorten(&mut length[end], way, &here);
            }
        }
    }
    for rank in (0..count).rev() {
        let mut best = length[rank];
        for way in descend.of(rank) {
            shorten(&mut best, way, &length[way.end as usize]);
        }
        length[rank] = best;
    }
}

#[inline(always)]
fn shorten(length: &mut Lanes, way: &Way, from: &Lanes) {
    for lane in 0..LANES {
        length[lane] = length[lane].min(from[lane] + way.length);
    }
}

#[cfg(test)]
mod tests {
    use super::{Hierarchy, Path};
    use crate::stnu::{Edge, LIMIT};

    /// Edges that a random potential fits and that are on no cycle of weight 0: all are a little longer than need be.
    fn network(seed: u64) -> (Vec<Edge>, Vec<i64>) {
        let mut random = fastrand::Rng::with_seed(seed);
        let nodes = random.usize(2..16);
        let potential: Vec<i64> = (0..nodes).map(|_| -random.i64(0..40)).collect();
        let mut edges = Vec::new();
        for _ in 0..random.usize(..4 * nodes) {
            let (from, to) = (random.usize(..nodes), random.usize(..nodes));
            if from != to {
                let weight = potential[from] - potential[to] + random.i64(1..=12);
                edges.push(Edge { from: from as u32, to: to as u32, weight });
            }
        }
        (edges, potential)
    }

    /// The distances from everywhere to everywhere, by the book (Floyd, Warshall).
    fn distances(edges: &[Edge], nodes: usize) -> Vec<Vec<Option<i64>>> {
        let mut known = vec![vec![None; nodes]; nodes];
        for edge in edges {
            let known = &mut known[edge.from as usize][edge.to as usize];
            *known = Some(known.map_or(edge.weight, |known: i64| known.min(edge.weight)));
        }
        for by in 0..nodes {
            for from in 0..nodes {
                for to in 0..nodes {
                    if from != to
                        && let (Some(a), Some(b)) = (known[from][by], known[by][to])
                    {
                        known[from][to] = Some(known[from][to].map_or(a + b, |known| known.min(a + b)));
                    }
                }
            }
        }
        known
    }

    #[test]
    fn all_paths_are_as_short_and_pass_as_early_nodes_as_by_the_book() {
        for seed in 0..3000 {
            let (edges, potential) = network(seed);
            let nodes = potential.len();
            let distance = distances(&edges, nodes);
            let mut seen = 0;
            let found = |from: u32, to: u32, path: Path| {
                let (from, to) = (from as usize, to as usize);
                let expected = distance[from][to];
                assert_eq!(Some(path.distance), expected, "seed {seed}: from {from} to {to}");
                let inner = |by: &usize| {
                    let through = distance[from][*by].zip(distance[*by][to]).map(|(a, b)| a + b);
                    *by != from && *by != to && through == expected
                };
                let least = (0..nodes).filter(inner).filter_map(|by| distance[from][by]).min();
                match least {
                    Some(least) => assert_eq!(path.least, least, "seed {seed}: from {from} to {to}"),
                    None => assert!(path.least > LIMIT, "seed {seed}: from {from} to {to}"),
                }
                seen += 1;
            };
            Hierarchy::new(&edges, &potential).all_paths(found);
            let pairs = (0..nodes).flat_map(|from| (0..nodes).map(move |to| (from, to)));
            let reached = pairs.filter(|&(from, to)| from != to && distance[from][to].is_some()).count();
            assert_eq!(seen, reached, "seed {seed}");
        }
    }

    #[test]
    fn a_path_beyond_the_limit_says_nothing_and_is_left_out() {
        let chain = |length: u32, weight: i64| -> Vec<Edge> {
            (0..length).map(|from| Edge { from, to: from + 1, weight }).collect()
        };
        let found = |edges: &[Edge]| {
            let mut found = 0;
            Hierarchy::new(edges, &vec![0; 41]).all_paths(|_, _, path| {
                assert!(path.distance <= LIMIT);
                found += 1;
            });
            found
        };
        let paths_of_up_to = |edges: u32| (0..edges).map(|edges| 40 - edges).sum::<u32>();
        assert_eq!(found(&chain(40, LIMIT / 40)), paths_of_up_to(40));
        assert_eq!(found(&chain(40, LIMIT / 30)), paths_of_up_to(30));
        assert_eq!(found(&chain(40, LIMIT)), paths_of_up_to(1));
    }
}
