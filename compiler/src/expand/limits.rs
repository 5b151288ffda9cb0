//! How far a program may unfold, found out before it is unfolded: two calls of two calls of two calls ... double each time.

use super::problem::Problem;
use crate::episode::{MAX_DEPTH, MAX_EPISODES};
use crate::evaluate;
use crate::problem::Problems;
use crate::typed::{Body, Model, Work};

/// True if the program stays within the limits; reports it if not.
pub(super) fn check(model: &Model, entry: usize, problems: &mut Problems) -> bool {
    let sizes = sizes(model, entry);
    let Some(size) = sizes[entry] else { return false };
    let program = &model.programs[entry];
    let Size { episodes, depth } = size;
    if episodes > MAX_EPISODES {
        let largest =
            program.calls().into_iter().max_by_key(|(target, _)| sizes[*target].map(|size| size.episodes));
        let most = largest.map(|(target, span)| (model.programs[target].name.clone(), span));
        problems.push(Problem::TooManyEpisodes { program: program.name.clone(), episodes, most });
        return false;
    }
    if depth > MAX_DEPTH {
        problems.push(Problem::TooDeep { program: program.name.clone(), depth });
        return false;
    }
    true
}

#[derive(Clone, Copy)]
struct Size {
    episodes: u64,
    depth: u64,
}

/// How large each program is that the entry leads to. Without recursion, every program is visited once.
fn sizes(model: &Model, entry: usize) -> Vec<Option<Size>> {
    let mut sizes: Vec<Option<Size>> = vec![None; model.programs.len()];
    let mut seen = vec![false; model.programs.len()];
    let mut open = vec![entry];
    while let Some(program) = open.last().copied() {
        if !std::mem::replace(&mut seen[program], true) {
            let calls = model.programs[program].calls().into_iter();
            open.extend(calls.map(|(target, _)| target).filter(|target| !seen[*target]));
            continue;
        }
        open.pop();
        if sizes[program].is_none() {
            sizes[program] = Some(size(&model.programs[program].work, &sizes));
        }
    }
    sizes
}

fn size(work: &Work, sizes: &[Option<Size>]) -> Size {
    let Work::Body(body) = work else { return Size { episodes: 1, depth: 1 } };
    let mut total = Size { episodes: 1, depth: 1 };
    let mut open: Vec<(&Body, u64, u64)> = body.iter().map(|part| (part, 2, 1)).collect();
    while let Some((part, depth, times)) = open.pop() {
        let own = match part {
            Body::Call { program, .. } => sizes[*program].unwrap_or(Size { episodes: 1, depth: 1 }),
            _ => Size { episodes: u64::from(part.is_episode()), depth: 1 },
        };
        // A number that depends on variables counts as one; what comes of it is counted when it is unfolded.
        let again = match part {
            Body::Repeat { count, .. } => evaluate::count(count, &[]).unwrap_or(1),
            _ => 1,
        };
        let inside = part.parts().iter().map(|inner| (inner, depth + 1, times.saturating_mul(again)));
        open.extend(inside);
        total.episodes = total.episodes.saturating_add(own.episodes.saturating_mul(times));
        total.depth = total.depth.max((depth - 1).saturating_add(own.depth));
    }
    total
}
