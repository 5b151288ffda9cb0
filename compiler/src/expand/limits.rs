//! How far a program may unfold, found out before it is unfolded: two calls of two calls of two calls ... double each time.

use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::episode::{MAX_DEPTH, MAX_EPISODES};
use crate::evaluate;
use crate::form::clip;
use crate::problem::Problems;
use crate::typed::{Body, Model, Work};

/// True if the program stays within the limits; reports it if not.
pub(super) fn check(model: &Model, entry: usize, problems: &mut Problems) -> bool {
    let sizes = sizes(model, entry);
    let Some(size) = sizes[entry] else { return false };
    let program = &model.programs[entry];
    let name = clip(&program.name.name);
    if size.episodes > MAX_EPISODES {
        let largest =
            program.calls().into_iter().max_by_key(|(target, _)| sizes[*target].map(|size| size.episodes));
        let count = match size.episodes {
            u64::MAX => "more episodes than can be counted".to_string(),
            episodes => format!("{episodes} episodes"),
        };
        let mut problem = Diagnostic::error(
            Code::TooManyEpisodes,
            program.name.span,
            format!("`{name}` unfolds to {count}"),
        )
        .primary(format!("at most {MAX_EPISODES} are possible"))
        .help("Every call is an episode of its own, and so is everything it calls in turn; every repetition counts.");
        if let Some((target, span)) = largest {
            let what = clip(&model.programs[target].name.name);
            problem = problem.label(span, format!("most of them come from `{what}`"));
        }
        problems.push(problem);
        return false;
    }
    if size.depth > MAX_DEPTH {
        problems.push(
            Diagnostic::error(
                Code::CallsTooDeep,
                program.name.span,
                format!("`{name}` unfolds to a depth of {}", size.depth),
            )
            .primary(format!("at most {MAX_DEPTH} programs and forms can be nested"))
            .help("Call the programs one after the other instead of each from the one before."),
        );
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
