//! Who calls whom: no program may call itself, and one that nobody calls is probably a slip.

use super::problem::{MOST_TOLD, Problem};
use crate::Options;
use crate::ast;
use crate::problem::Problems;
use crate::source::Span;
use crate::typed::{Model, Program, Work};

/// Reports every call that leads back to the program it stands in.
pub(super) fn check_recursion(model: &Model, problems: &mut Problems) {
    let calls: Vec<Vec<(usize, Span)>> = model.programs.iter().map(Program::calls).collect();
    // 0: not seen, 1: on the walk, 2: done.
    let mut state = vec![0_u8; calls.len()];
    for start in 0..calls.len() {
        if state[start] != 0 {
            continue;
        }
        state[start] = 1;
        let mut walk: Vec<(usize, usize)> = vec![(start, 0)];
        while let Some((program, next)) = walk.last_mut() {
            let Some((target, span)) = calls[*program].get(*next).copied() else {
                state[*program] = 2;
                walk.pop();
                continue;
            };
            *next += 1;
            match state[target] {
                0 => {
                    state[target] = 1;
                    walk.push((target, 0));
                }
                1 => {
                    let from = walk.iter().position(|(program, _)| *program == target).unwrap_or(0);
                    let circle =
                        walk[from..].iter().map(|(program, _)| model.programs[*program].name.clone());
                    let (length, circle) = (circle.len(), circle.take(MOST_TOLD).collect());
                    problems.push(Problem::Recursion { circle, length, call: span });
                }
                _ => {}
            }
        }
    }
}

/// Warns of programs that are never called. If the program to start from was chosen, the others that nobody calls
/// and that are not primitive may be chosen another time: they and what they call are in use. So are those of
/// the same name in other packages.
pub(super) fn check_use(
    model: &Model,
    program: &ast::Program,
    entry: usize,
    options: &Options,
    problems: &mut Problems,
) {
    let is_main = options.entry.eq_ignore_ascii_case("main");
    if problems.has_errors() {
        return;
    }
    let calls: Vec<Vec<(usize, Span)>> = model.programs.iter().map(Program::calls).collect();
    let mut called = vec![false; calls.len()];
    for (target, _) in calls.iter().flatten() {
        called[*target] = true;
    }
    let mut used = vec![false; calls.len()];
    let name_of = |index: usize| model.programs[index].name.name.as_str();
    let mut open: Vec<usize> = (0..calls.len()).filter(|index| name_of(*index) == name_of(entry)).collect();
    if !is_main {
        open.extend(
            (0..calls.len())
                .filter(|index| !called[*index] && matches!(model.programs[*index].work, Work::Body(_))),
        );
    }
    while let Some(program) = open.pop() {
        if !std::mem::replace(&mut used[program], true) {
            open.extend(calls[program].iter().map(|(target, _)| *target));
        }
    }
    let start = &model.programs[entry].name;
    let homes = program.programs.iter().map(|program| &program.home);
    for ((unused, used), home) in model.programs.iter().zip(used).zip(homes) {
        // Other sources are libraries: nobody uses all of one.
        if !used && unused.name.span.source == start.span.source {
            problems.push(Problem::NeverCalled {
                program: unused.name.clone(),
                entry: start.name.clone(),
                package: (*home != program.programs[entry].home).then(|| home.clone()),
            });
        }
    }
}
