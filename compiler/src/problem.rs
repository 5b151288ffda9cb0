//! The one place every phase reports to.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use crate::code::Code;
use crate::diagnostic::{Diagnostic, Severity};
use crate::form::Form;
use crate::source::Span;
use crate::wording::too_many;

/// How many messages about one source are kept; the rest are counted.
pub(crate) const MAX_PER_SOURCE: usize = 200;

/// Collects the diagnostics of all phases: each (code, place) once, and a bounded number per source.
#[derive(Debug, Default)]
pub struct Problems {
    list: Vec<Diagnostic>,
    seen: HashSet<(Code, Span)>,
    /// For every source: how many are kept, how many more there were, and how bad the worst of those is.
    counts: BTreeMap<u32, (usize, usize, Option<Severity>)>,
    errors: usize,
    lost: bool,
    /// The words of what could not be understood: they may be names.
    lost_words: HashSet<String>,
    /// Forms that were not read to their end: what else is wrong with them follows from that.
    muted: BTreeSet<(u32, u32, u32)>,
    /// Places at which one text ends and another begins, though both are in one source.
    parts: BTreeSet<(u32, u32)>,
}

impl Problems {
    /// Reports a problem, unless the same code was already reported for the same place. Not inlined: forms nest, and its words
    /// would take room on the stack at every level.
    #[inline(never)]
    pub fn push(&mut self, problem: impl Into<Diagnostic>) {
        let diagnostic = problem.into();
        if self.is_muted(diagnostic.span) {
            return;
        }
        self.errors += usize::from(diagnostic.severity == Severity::Error);
        let counts = self.counts.entry(diagnostic.span.source).or_default();
        if counts.0 >= MAX_PER_SOURCE {
            counts.1 += 1;
            counts.2 = counts.2.into_iter().chain([diagnostic.severity]).min();
        } else if self.seen.insert((diagnostic.code, diagnostic.span)) {
            counts.0 += 1;
            self.list.push(diagnostic);
        }
    }

    /// Reports all of these.
    pub fn extend(&mut self, problems: impl IntoIterator<Item = impl Into<Diagnostic>>) {
        problems.into_iter().for_each(|problem| self.push(problem));
    }

    /// Drops what is reported from now on about this form, which is damaged; that must have been reported.
    pub fn mute(&mut self, form: Span) {
        self.muted.insert((form.source, form.start, form.end));
    }

    /// True if one more message about this source would be kept: if not, it is not worth thinking about its words.
    pub fn wants(&self, source: u32) -> bool {
        self.counts.get(&source).is_none_or(|counts| counts.0 < MAX_PER_SOURCE)
    }

    fn is_muted(&self, span: Span) -> bool {
        let before = self.muted.range(..=(span.source, span.start, u32::MAX)).next_back();
        before.is_some_and(|(source, _, end)| *source == span.source && span.end <= *end)
    }

    /// Says that another text begins here, in the same source.
    pub fn part(&mut self, at: Span) {
        self.parts.insert((at.source, at.start));
    }

    /// True if the two places, in this order, are in different texts of one source: what is there twice may be meant so.
    pub fn are_apart(&self, first: Span, second: Span) -> bool {
        let between = (first.source, first.start)..(second.source, second.start.max(first.start));
        first.source == second.source && self.parts.range(between).next().is_some()
    }

    /// Says that definitions may have been lost with what could not be read: what is missing is not worth a message then.
    pub fn lose_definitions(&mut self) {
        self.lost = true;
    }

    /// Says that a form could not be understood, which has been reported: what is named in it may be missing elsewhere.
    pub fn lose(&mut self, form: &Form) {
        let mut open = vec![form];
        while let Some(form) = open.pop() {
            if let Some(symbol) = form.symbol() {
                self.lost_words.insert(symbol.name.clone());
            }
            open.extend(form.list().unwrap_or_default());
        }
    }

    /// Says that a text could not be understood, as `lose` does of a form.
    pub fn lose_text(&mut self, text: &str) {
        let words = text.split(|c: char| c.is_whitespace() || matches!(c, '(' | ')' | '\'' | '"'));
        self.lost_words.extend(words.filter(|word| !word.is_empty()).map(str::to_lowercase));
    }

    /// True if this name may have been defined in what could not be understood.
    pub fn has_lost(&self, name: &str) -> bool {
        self.lost || self.lost_words.contains(name)
    }

    /// How many errors were reported so far.
    pub fn errors(&self) -> usize {
        self.errors
    }

    /// True if a form could not be read as it should be, which has been reported.
    pub fn is_damaged(&self, form: Span) -> bool {
        self.is_muted(form)
    }

    /// True if anything reported so far was an error.
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// Everything reported, sorted by place, with a last message for each source that had too many.
    pub fn into_sorted(mut self) -> Vec<Diagnostic> {
        self.list.sort_by_key(|d| (d.span, d.severity, d.code));
        for (source, (_, more, worst)) in self.counts {
            if let Some(severity) = worst {
                let at = self.list.partition_point(|d| d.span.source <= source);
                let span =
                    self.list.get(at.wrapping_sub(1)).map_or(Span { source, start: 0, end: 0 }, |d| d.span);
                self.list.insert(at, too_many(more, MAX_PER_SOURCE, severity, span));
            }
        }
        self.list
    }
}
