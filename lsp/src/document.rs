//! A text that is open in an editor: edited piece by piece, analysed when it is asked about.

use std::sync::Arc;

use kirk_compiler::Diagnostic;
use lsp_types::{TextDocumentContentChangeEvent, Uri};

use crate::analysis::{Analysis, Companions, Unjudged, analyse_among};
use crate::judged::Judged;
use crate::lines::{Encoding, Lines};
use crate::view::{Shift, View};

/// An open document.
#[derive(Debug)]
pub(crate) struct Document {
    pub(crate) uri: Uri,
    pub(crate) version: i32,
    text: String,
    /// The files that are one program with it, and what there is to say about their names.
    companions: (Companions, Vec<Diagnostic>),
    /// Counts the changes of all of that.
    revision: u64,
    analysis: Option<Arc<Analysis>>,
    /// What is left to be judged of the analysis.
    unjudged: Option<Unjudged>,
    /// The last revision that was judged, and what there is to say about it.
    told: Option<(u64, Vec<Diagnostic>)>,
    /// The last text in which there were missions, and these.
    known: Option<(String, Arc<Vec<Judged>>)>,
    /// True if the newest text has been handed on, to be judged or to the client.
    pub(crate) handed_on: bool,
    /// True if the client has been told of it.
    pub(crate) settled: bool,
}

impl Document {
    pub(crate) fn new(uri: Uri, version: i32, text: String) -> Document {
        Document {
            uri,
            version,
            text,
            companions: Default::default(),
            revision: 0,
            analysis: None,
            unjudged: None,
            told: None,
            known: None,
            handed_on: false,
            settled: false,
        }
    }

    /// Applies changes one after the other.
    pub(crate) fn change(
        &mut self,
        version: i32,
        changes: Vec<TextDocumentContentChangeEvent>,
        encoding: Encoding,
    ) {
        for change in changes {
            match change.range {
                None => self.text = change.text,
                Some(range) => {
                    let lines = Lines::new(&self.text);
                    let start = lines.offset(&self.text, range.start, encoding);
                    let end = lines.offset(&self.text, range.end, encoding);
                    self.text.replace_range(start..end.max(start), &change.text);
                }
            }
        }
        self.version = version;
        self.renew();
    }

    /// Takes the files that are one program with it; true if they are other than before.
    pub(crate) fn accompany(&mut self, companions: (Companions, Vec<Diagnostic>)) -> bool {
        let new = self.companions != companions;
        if new {
            self.companions = companions;
            self.renew();
        }
        new
    }

    fn renew(&mut self) {
        self.revision += 1;
        self.analysis = None;
        self.unjudged = None;
        self.handed_on = false;
        self.settled = false;
    }

    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    pub(crate) fn revision(&self) -> u64 {
        self.revision
    }

    /// The analysis of the newest text.
    pub(crate) fn analysis(&mut self) -> Arc<Analysis> {
        if let Some(analysis) = &self.analysis {
            return analysis.clone();
        }
        let (analysis, unjudged) = analyse_among(self.text.clone(), &self.companions.0);
        let analysis = Arc::new(analysis);
        self.analysis = Some(analysis.clone());
        self.unjudged = Some(unjudged);
        analysis
    }

    /// What is to be judged of the newest text, once.
    pub(crate) fn take_unjudged(&mut self) -> Option<Unjudged> {
        self.analysis();
        self.unjudged.take().filter(|unjudged| !unjudged.roots.is_empty())
    }

    /// Keeps what came of judging a revision and its text; false if there is a newer one.
    pub(crate) fn keep(
        &mut self,
        (revision, text): (u64, String),
        missions: Vec<Judged>,
        diagnostics: Vec<Diagnostic>,
    ) -> bool {
        if !missions.is_empty() {
            self.known = Some((text, Arc::new(missions)));
        }
        self.told = Some((revision, diagnostics));
        revision == self.revision
    }

    /// What there is to say about the newest text as far as it is known, sorted by place.
    pub(crate) fn diagnostics(&mut self) -> Vec<Diagnostic> {
        let mut all = self.analysis().diagnostics.clone();
        all.extend(self.companions.1.iter().cloned());
        if let Some((_, more)) = self.told.as_ref().filter(|(revision, _)| *revision == self.revision) {
            // What is to be said at places of other files is said there, if they name this one.
            all.extend(more.iter().filter(|d| d.span.source == 0).cloned());
            all.sort_by_key(|d| (d.span, d.severity, d.code));
        }
        all
    }

    /// The newest text with the last missions known.
    pub(crate) fn view(&mut self) -> View {
        let analysis = self.analysis();
        let (missions, shift) = match &self.known {
            Some((text, missions)) => (missions.clone(), Shift::new(text, analysis.text())),
            None => (Arc::default(), Shift::default()),
        };
        View { analysis, missions, shift }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lsp_types::{Position, Range};

    /// The position of a byte, found by walking there.
    fn position(text: &str, at: usize, encoding: Encoding) -> Position {
        let (mut line, mut character, mut was_return) = (0, 0, false);
        for c in text[..at].chars() {
            match c {
                '\n' if was_return => {}
                '\n' | '\r' => (line, character) = (line + 1, 0),
                c if encoding == Encoding::Utf8 => character += c.len_utf8() as u32,
                c => character += c.len_utf16() as u32,
            }
            was_return = c == '\r';
        }
        Position { line, character }
    }

    #[test]
    fn edits_piece_by_piece_give_the_text_the_editor_has() {
        const PIECES: [&str; 9] = ["", "(a", ")", "\n", "\r\n", "ö", "𝄞𝄞", "; x\n", "\r"];
        for seed in 0..300 {
            let mut random = fastrand::Rng::with_seed(seed);
            let encoding = if seed % 2 == 0 { Encoding::Utf8 } else { Encoding::Utf16 };
            let mut text = "(define-control-program ö ()\r\n  𝄞)\n".to_string();
            let mut document = Document::new("file:///x".parse().unwrap(), 0, text.clone());
            for version in 1..40 {
                // Inside of a line end there is no position.
                let is_place = |at: &usize| !(text[..*at].ends_with('\r') && text[*at..].starts_with('\n'));
                let places: Vec<usize> =
                    text.char_indices().map(|(at, _)| at).chain([text.len()]).filter(is_place).collect();
                let first = random.usize(..places.len());
                let last = (first + random.usize(..6)).min(places.len() - 1);
                let (start, end) = (places[first], places[last]);
                let piece = PIECES[random.usize(..PIECES.len())].to_string();
                let range =
                    Range { start: position(&text, start, encoding), end: position(&text, end, encoding) };
                text.replace_range(start..end, &piece);
                let change =
                    TextDocumentContentChangeEvent { range: Some(range), range_length: None, text: piece };
                document.change(version, vec![change], encoding);
                assert_eq!(document.text, text, "seed {seed}, version {version}");
            }
        }
    }
}
