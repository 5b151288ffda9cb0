//! Notes on bounds and delays that change nothing.

use kirk_network::{Bound, Duration};

use super::problem::Problem;
use crate::episode::{Episode, Kind, Range};

/// Notes news that tells nothing, and upper bounds that are never reached.
pub(super) fn notes_on_bounds(root: &Episode) -> Vec<Problem<'_>> {
    let mut notes = Vec::new();
    longest(root, &mut notes);
    notes
}

/// How long an episode can take by what is inside it alone: as long as its bounds allow, and at least as long as Nature
/// may make it take, whatever the bounds say.
fn longest<'a>(episode: &'a Episode, notes: &mut Vec<Problem<'a>>) -> Bound {
    let allowed = allowed(episode, notes);
    match (allowed, forced(episode)) {
        (Bound::Finite(allowed), Bound::Finite(forced)) => Bound::Finite(allowed.max(forced)),
        _ => Bound::Infinite,
    }
}

/// How long Nature alone may make an episode take.
fn forced(episode: &Episode) -> Bound {
    let inside = episode.parts.iter().map(forced);
    match (episode.kind, &episode.duration) {
        (Kind::Primitive, Some(duration)) if episode.contingent => duration.upper,
        (Kind::Primitive | Kind::Delay, _) => Bound::ZERO,
        (Kind::Parallel, _) => inside.reduce(most).unwrap_or(Bound::ZERO),
        (Kind::Program | Kind::Sequence | Kind::WithTemporalConstraint, _) => inside.fold(Bound::ZERO, sum),
    }
}

fn allowed<'a>(episode: &'a Episode, notes: &mut Vec<Problem<'a>>) -> Bound {
    let inside: Vec<Bound> = episode.parts.iter().map(|part| longest(part, notes)).collect();
    let inside = inside.into_iter();
    let own = episode.duration.as_ref().map_or(Bound::Infinite, |duration| duration.upper);
    let slack = episode.slack == Some(true) && !episode.parts.is_empty();
    let parts = match episode.kind {
        Kind::Primitive => {
            notes.extend(useless_news(episode));
            return own;
        }
        Kind::Delay => return own,
        _ if slack => Bound::Infinite,
        // Without slack, the parts of a parallel all take the same time.
        Kind::Parallel => inside.reduce(least).unwrap_or(Bound::ZERO),
        Kind::Program | Kind::Sequence | Kind::WithTemporalConstraint => inside.fold(Bound::ZERO, sum),
    };
    if let (Kind::WithTemporalConstraint, Some(duration), Bound::Finite(most)) =
        (episode.kind, &episode.duration, parts)
    {
        notes.extend(never_binds(duration, most));
    }
    least(parts, own)
}

/// The news of an end is of use if it may say something: in the worst case it is as uncertain as the end itself.
fn useless_news(episode: &Episode) -> Option<Problem<'_>> {
    let (duration, delay) = (episode.duration.as_ref()?, episode.delay.as_ref()?);
    let (longest, latest) = (duration.upper.finite()?, delay.upper.finite()?);
    let width = longest.checked_sub(duration.lower)?;
    let spread = latest.checked_sub(delay.lower)?;
    if spread == Duration::ZERO || width == Duration::ZERO || width > spread {
        return None;
    }
    Some(Problem::UselessNews {
        activity: episode,
        delay: (spread, delay.upper_span),
        duration: (width, duration.upper_span),
    })
}

fn never_binds(duration: &Range, most: Duration) -> Option<Problem<'static>> {
    let limit = duration.upper.finite().filter(|limit| *limit > most)?;
    Some(Problem::NeverBinds { bound: duration.upper_span, limit, most })
}

fn least(a: Bound, b: Bound) -> Bound {
    match (a, b) {
        (Bound::Finite(a), Bound::Finite(b)) => Bound::Finite(a.min(b)),
        (Bound::Finite(a), Bound::Infinite) | (Bound::Infinite, Bound::Finite(a)) => Bound::Finite(a),
        (Bound::Infinite, Bound::Infinite) => Bound::Infinite,
    }
}

fn most(a: Bound, b: Bound) -> Bound {
    match (a, b) {
        (Bound::Finite(a), Bound::Finite(b)) => Bound::Finite(a.max(b)),
        _ => Bound::Infinite,
    }
}

fn sum(a: Bound, b: Bound) -> Bound {
    match (a, b) {
        (Bound::Finite(a), Bound::Finite(b)) => a.checked_add(b).map_or(Bound::Infinite, Bound::Finite),
        _ => Bound::Infinite,
    }
}
