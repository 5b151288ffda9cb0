//! Where the constraints of a network stand in the file it was read from.

use std::ops::Range;

use crate::conflict::Part;

/// Byte ranges in the text of a network file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SourceMap {
    /// For each requirement, what says its upper bound and what says its lower one.
    pub requirements: Vec<[Range<usize>; 2]>,
    /// For each contingent link the same.
    pub contingents: Vec<[Range<usize>; 2]>,
}

impl SourceMap {
    /// What says this part of a conflict; `None` for what goes without saying.
    pub fn of(&self, part: Part) -> Option<Range<usize>> {
        match part {
            Part::RequirementUpper(index) => self.requirements.get(index).map(|[upper, _]| upper.clone()),
            Part::RequirementLower(index) | Part::Join(index) => {
                self.requirements.get(index).map(|[_, lower]| lower.clone())
            }
            Part::LinkUpper(index) | Part::DelayMin(index) | Part::DelayMax(index) => {
                self.contingents.get(index).map(|[upper, _]| upper.clone())
            }
            Part::LinkLower(index) => self.contingents.get(index).map(|[_, lower]| lower.clone()),
            Part::AfterOrigin => None,
        }
    }
}
