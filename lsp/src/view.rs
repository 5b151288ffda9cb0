//! What every feature looks at: the newest text, and the missions of the last text that could be judged.

use std::sync::Arc;

use kirk_compiler::Span;

use crate::analysis::Analysis;
use crate::judged::{Judged, Occurrence};

/// The newest text of a document and the last missions known.
#[derive(Clone, Debug)]
pub struct View {
    /// The newest text.
    pub analysis: Arc<Analysis>,
    /// The missions of this text, or of the last that had any.
    pub missions: Arc<Vec<Judged>>,
    /// From the text of the missions to the newest.
    pub shift: Shift,
}

impl View {
    /// What occurs at a place of the newest text: a call, an operator, the name of a program that is started.
    pub fn occurrences(&self, span: Span) -> Vec<(&Judged, &Occurrence)> {
        let Some(before) = self.shift.back(span) else { return Vec::new() };
        let mut found = Vec::new();
        for mission in self.missions.iter() {
            let places = mission.at.get(&before).into_iter().flatten();
            found.extend(places.map(|&index| (mission, &mission.occurrences[index])));
        }
        found
    }

    /// True if the missions are those of the newest text.
    pub fn is_current(&self) -> bool {
        self.shift.changed.is_none()
    }
}

/// How one text became another: something in the middle was replaced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shift {
    /// Where the two differ: from this byte on, up to this one in the old text, and up to this one in the new.
    changed: Option<(u32, u32, u32)>,
}

impl Shift {
    /// Compares two texts.
    pub fn new(old: &str, new: &str) -> Shift {
        if old == new {
            return Shift::default();
        }
        let start = old.bytes().zip(new.bytes()).take_while(|(a, b)| a == b).count();
        let rest = (old.len() - start).min(new.len() - start);
        let backward = old.bytes().rev().zip(new.bytes().rev());
        let same = backward.take(rest).take_while(|(a, b)| a == b).count();
        Shift { changed: Some((start as u32, (old.len() - same) as u32, (new.len() - same) as u32)) }
    }

    /// Where a place of the new text was in the old one; `None` if it has changed.
    pub fn back(&self, span: Span) -> Option<Span> {
        match self.changed {
            None => Some(span),
            // Another file, as it was when it was judged.
            Some(_) if span.source != 0 => Some(span),
            Some((start, _, _)) if span.end <= start => Some(span),
            Some((_, old, new)) if span.start >= new => {
                Some(Span { start: span.start - new + old, end: span.end - new + old, ..span })
            }
            Some(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_before_or_after_the_change_is_found_and_one_inside_is_not() {
        let (old, new) = ("(a) (b) (c)", "(a) (xyz b) (c)");
        let shift = Shift::new(old, new);
        let back = |start, end| shift.back(Span::new(0, start, end));
        assert_eq!(back(0, 3), Some(Span::new(0, 0, 3)));
        assert_eq!(back(4, 11), None);
        assert_eq!(back(12, 15), Some(Span::new(0, 8, 11)));
        assert_eq!(Shift::new(new, new).back(Span::new(0, 4, 11)), Some(Span::new(0, 4, 11)));
        assert_eq!(Shift::new("aa", "aaa").back(Span::new(0, 0, 2)), Some(Span::new(0, 0, 2)));
        assert_eq!(Shift::new("", "aaa").back(Span::new(0, 0, 1)), None);
    }
}
