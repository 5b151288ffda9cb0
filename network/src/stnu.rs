//! The plain STNU: what the reduction produces and every algorithm works on. Flat arrays, integers, no names.
//!
//! An edge `from -> to` of weight `w` reads `to - from <= w` (`target - source <= weight`), in microseconds.
//! A link (A, x, y, C) stands for its lower-case edge `A -c:x-> C` and its upper-case edge `C -C:-y-> A`.
//! L. Hunsberger, *Efficient execution of dynamically controllable simple temporal networks with uncertainty*, 2016.

/// Sums beyond this many microseconds (some 18,000 years) are refused, so that no `i64` addition can overflow.
pub const LIMIT: i64 = 1 << 59;

/// A number grew beyond [`LIMIT`]. An error, never a wrong answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge;

impl std::fmt::Display for TooLarge {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "the durations of this network add up to more than 18,000 years; kirk cannot compute with that"
        )
    }
}

impl std::error::Error for TooLarge {}

/// A number, if it is within [`LIMIT`].
///
/// Hot loops add once to a number that was checked and check the sum when they go on from it: two or three numbers
/// within the limit cannot overflow.
#[inline]
pub(crate) fn within_limit(number: i64) -> Result<i64, TooLarge> {
    if number.unsigned_abs() > LIMIT as u64 { Err(TooLarge) } else { Ok(number) }
}

/// `a + b`, if that is within [`LIMIT`].
#[inline]
pub(crate) fn add(a: i64, b: i64) -> Result<i64, TooLarge> {
    within_limit(a.checked_add(b).ok_or(TooLarge)?)
}

/// An ordinary edge: `to - from <= weight`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// The node measured from.
    pub from: u32,
    /// The node measured to.
    pub to: u32,
    /// The most microseconds `to` may come after `from`.
    pub weight: i64,
}

/// A contingent link: Nature picks `contingent - activation` in `[lower, upper]`, `0 <= lower < upper`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// The node the duration is measured from.
    pub activation: u32,
    /// The node Nature places.
    pub contingent: u32,
    /// The shortest duration.
    pub lower: i64,
    /// The longest duration.
    pub upper: i64,
}

/// A plain STNU with nodes `0..nodes`; node 0 is the origin Z.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Stnu {
    /// The number of nodes.
    pub nodes: u32,
    /// The ordinary edges.
    pub edges: Vec<Edge>,
    /// The contingent links; every node is the contingent node of at most one.
    pub links: Vec<Link>,
}

/// No node, no link, no edge.
pub const NONE: u32 = u32::MAX;

impl Stnu {
    /// For every node the index of the link that ends there, or [`NONE`].
    pub fn link_ending_at(&self) -> Vec<u32> {
        let mut ending = vec![NONE; self.nodes as usize];
        for (index, link) in self.links.iter().enumerate() {
            ending[link.contingent as usize] = index as u32;
        }
        ending
    }

    /// By when all is over, whatever Nature does, if every node is executed as early as it may be.
    ///
    /// The time of a node is that of another and the wait for it: the shortest distance an edge demands, or a duration of
    /// Nature's. Going back from the last node in this way passes every node at most once, so the longest waits of all
    /// nodes and the longest durations of all links add up to a time that is enough. What follows from a controllable
    /// network is no longer than that either, and what happens later than that never happens: a bound beyond it says
    /// nothing.
    ///
    /// # Errors
    /// [`TooLarge`] if that is beyond [`LIMIT`]. Everything that decides or compiles a network asks this first, so all
    /// refuse the same networks.
    pub(crate) fn horizon(&self) -> Result<i64, TooLarge> {
        let mut longest_wait = vec![0; self.nodes as usize];
        for edge in &self.edges {
            let wait: &mut i64 = &mut longest_wait[edge.from as usize];
            *wait = (*wait).max(-within_limit(edge.weight)?);
        }
        let longest_durations = self.links.iter().map(|link| link.upper);
        longest_wait
            .into_iter()
            .chain(longest_durations)
            .try_fold(0, |sum, wait| add(sum, within_limit(wait)?))
    }
}

/// Adjacency in compressed rows: the items of node `v` are `items[start[v]..start[v + 1]]`.
#[derive(Clone, Debug)]
pub struct Rows {
    start: Vec<u32>,
    items: Vec<u32>,
}

impl Rows {
    /// Sorts `0..keys.len()` into rows by key, stably.
    pub fn new(nodes: u32, keys: impl Iterator<Item = u32> + Clone) -> Rows {
        let mut start = vec![0_u32; nodes as usize + 1];
        for key in keys.clone() {
            start[key as usize + 1] += 1;
        }
        for node in 0..nodes as usize {
            start[node + 1] += start[node];
        }
        let mut next = start.clone();
        let mut items = vec![0; start[nodes as usize] as usize];
        for (item, key) in keys.enumerate() {
            items[next[key as usize] as usize] = item as u32;
            next[key as usize] += 1;
        }
        Rows { start, items }
    }

    /// The items of a node, in order.
    #[inline]
    pub fn of(&self, node: u32) -> &[u32] {
        &self.items[self.start[node as usize] as usize..self.start[node as usize + 1] as usize]
    }
}
