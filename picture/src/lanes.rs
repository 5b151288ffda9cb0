//! Which row each activity is in.

use kirk_compiler::episode::{Episode, Kind};
use kirk_network::Time;

use crate::chart::{Bar, is_leaf};

/// Where an episode is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    /// Its row, from the top.
    pub(crate) row: usize,
    /// The rows below that are its parts'.
    pub(crate) around: usize,
}

/// All places.
pub(crate) struct Places {
    /// Of each episode, in the order of [`kirk_compiler::events_of`]; `None` of what is not drawn.
    pub(crate) of: Vec<Option<Place>>,
    /// How many rows there are.
    pub(crate) rows: usize,
}

/// The parts of a `parallel` are one below the other, those of any other form in the same rows, one after the other. What has a name
/// or a limit has a row above its parts. Depth is limited where programs are unfolded.
pub(crate) fn placed(root: &Episode) -> Places {
    let mut heights = Vec::new();
    let rows = measure(root, true, &mut heights);
    let mut of = Vec::new();
    place(root, 0, &heights, &mut of);
    Places { of, rows }
}

/// How many rows an episode takes, and all in it, each before its parts; and how many of them its parts take.
fn measure(episode: &Episode, is_root: bool, heights: &mut Vec<(usize, usize)>) -> usize {
    let number = heights.len();
    heights.push((0, 0));
    let parts = episode.parts.iter().map(|part| measure(part, false, heights));
    let inside: usize = match episode.kind {
        Kind::Parallel => parts.sum(),
        _ => parts.max().unwrap_or(0),
    };
    let own = usize::from(is_drawn(episode, is_root));
    heights[number] = (own + inside, inside);
    own + inside
}

/// What takes no row is a wait that nobody has named, and a form that says nothing of itself.
fn is_drawn(episode: &Episode, is_root: bool) -> bool {
    if is_leaf(episode) {
        return !episode.internal || !episode.labels.is_empty();
    }
    let is_limited = episode.duration.is_some_and(|duration| duration.upper.finite().is_some());
    is_limited || !is_root && (!episode.internal || !episode.labels.is_empty())
}

fn place(episode: &Episode, row: usize, heights: &[(usize, usize)], of: &mut Vec<Option<Place>>) {
    let (all, around) = heights[of.len()];
    of.push((all > around).then_some(Place { row, around }));
    let mut top = row + (all - around);
    for part in &episode.parts {
        let (height, _) = heights[of.len()];
        place(part, top, heights, of);
        if episode.kind == Kind::Parallel {
            top += height;
        }
    }
}

/// Puts bars that are not at the same time into one row, the earliest first, and returns how many rows there are.
pub(crate) fn packed(bars: &mut [Bar]) -> usize {
    bars.sort_by(|one, other| {
        let key = |bar: &Bar| (bar.start.at(), bar.end.at());
        key(one).cmp(&key(other)).then_with(|| one.name.cmp(&other.name))
    });
    let mut free: Vec<Time> = Vec::new();
    for bar in bars {
        let (start, end) = (bar.start.at(), bar.over());
        bar.row = free.iter().position(|free| *free <= start).unwrap_or(free.len());
        match free.get_mut(bar.row) {
            Some(free) => *free = end,
            None => free.push(end),
        }
    }
    free.len()
}
