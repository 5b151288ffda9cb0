//! From a resolved program to its network: every call becomes an episode, every episode two events.

use crate::episode::Episode;
use crate::expand::expand;
use crate::lower::{Lowered, lower};
use crate::notes::notes;
use crate::problem::Problems;
use crate::team::faults;
use crate::typed::Model;

/// A program unfolded.
#[derive(Clone, Debug)]
pub struct Unfolded {
    /// The tree of its episodes.
    pub episodes: Episode,
    /// Its network and where that comes from; `None` if unfolding it was an error.
    pub lowered: Option<Lowered>,
}

/// Unfolds the program the model starts from, and notes what may surprise. Expects a model without errors; `None` if there is
/// nothing to start from, or too much to unfold.
pub fn unfold(model: &Model, problems: &mut Problems) -> Option<Unfolded> {
    let before = problems.errors();
    let episodes = expand(model, problems)?;
    if problems.errors() > before {
        return Some(Unfolded { episodes, lowered: None });
    }
    let lowered = lower(&episodes, model.team.as_ref());
    if let Some(lowered) = &lowered {
        if let Some(team) = &lowered.team {
            problems.extend(faults(team, &lowered.network, &lowered.origins));
        }
        problems.extend(notes(lowered, &episodes));
    }
    Some(Unfolded { episodes, lowered: lowered.filter(|_| problems.errors() == before) })
}
