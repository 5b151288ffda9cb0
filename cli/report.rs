//! Diagnostics for people (codespan-reporting, on standard error) and for programs (JSON).

use std::io::{self, IsTerminal, Write};

use codespan_reporting::diagnostic as codespan;
use codespan_reporting::files::SimpleFiles;
use codespan_reporting::term::termcolor::{ColorChoice, StandardStream};
use codespan_reporting::term::{self, Config};
use kirk_compiler::{Diagnostic, LineIndex, Severity, Source, Span, Suggestion};
use serde::Serialize;

use crate::args::{Color, Common};
use crate::foreign::{as_long, one_line, visible};
use crate::output::print_line;

/// The sources that diagnostics point into.
pub(crate) struct Reporter<'a> {
    sources: &'a [Source],
    lines: Vec<LineIndex>,
}

/// Lines longer than this are not shown; they are no lines a person wrote.
const LONGEST_LINE: usize = 500;

impl<'a> Reporter<'a> {
    pub(crate) fn new(sources: &'a [Source]) -> Reporter<'a> {
        let lines = sources.iter().map(|source| LineIndex::new(&source.text)).collect();
        Reporter { sources, lines }
    }

    /// Renders diagnostics to standard error; notes and warnings not if quiet.
    pub(crate) fn show(&self, diagnostics: &[Diagnostic], common: &Common) -> io::Result<()> {
        let color = match common.color {
            Color::Always => ColorChoice::Always,
            Color::Never => ColorChoice::Never,
            Color::Auto if io::stderr().is_terminal() => ColorChoice::Auto,
            Color::Auto => ColorChoice::Never,
        };
        let mut files = SimpleFiles::new();
        for source in self.sources {
            files.add(one_line(&source.name), as_long(&source.text));
        }
        let stream = StandardStream::stderr(color);
        for diagnostic in diagnostics {
            if common.quiet && diagnostic.severity != Severity::Error {
                continue;
            }
            let shown = self.cooked(diagnostic);
            let mut stream = stream.lock();
            term::emit_to_write_style(&mut stream, &Config::default(), &files, &shown)
                .map_err(io::Error::other)?;
            stream.flush()?;
        }
        Ok(())
    }

    /// One line for every place a diagnostic is about, to standard output: `FILE:LINE:COLUMN: KIND: MESSAGE`, as compilers write
    /// them and editors read them. Notes and warnings not if quiet.
    pub(crate) fn show_short(&self, diagnostics: &[Diagnostic], common: &Common) -> io::Result<()> {
        for diagnostic in diagnostics {
            if common.quiet && diagnostic.severity != Severity::Error {
                continue;
            }
            let kind = match diagnostic.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
                Severity::Note => "note",
            };
            let said = format!("{kind}[{}]: {}", diagnostic.code, diagnostic.message);
            let first = std::iter::once((diagnostic.span, said));
            let others =
                diagnostic.labels.iter().map(|label| (label.span, format!("note: {}", label.message)));
            for (span, said) in first.chain(others) {
                let (line, column) = self.position(span.source, span.start).unwrap_or((1, 1));
                print_line(&one_line(&format!("{}:{line}:{column}: {said}", self.name(span))))?;
            }
        }
        Ok(())
    }

    fn cooked(&self, diagnostic: &Diagnostic) -> codespan::Diagnostic<usize> {
        let severity = match diagnostic.severity {
            Severity::Error => codespan::Severity::Error,
            Severity::Warning => codespan::Severity::Warning,
            Severity::Note => codespan::Severity::Note,
        };
        let mut cooked = codespan::Diagnostic::new(severity)
            .with_code(diagnostic.code.to_string())
            .with_message(one_line(&diagnostic.message));
        let places = std::iter::once((diagnostic.span, &diagnostic.primary))
            .chain(diagnostic.labels.iter().map(|label| (label.span, &label.message)));
        for (index, (span, message)) in places.enumerate() {
            let range = span.start as usize..span.end as usize;
            if self.is_showable(span) {
                let style =
                    if index == 0 { codespan::LabelStyle::Primary } else { codespan::LabelStyle::Secondary };
                cooked.labels.push(
                    codespan::Label::new(style, span.source as usize, range).with_message(one_line(message)),
                );
            } else if let Some((line, column)) = self.position(span.source, span.start) {
                let name = &self.sources[span.source as usize].name;
                let message = if message.is_empty() { "here" } else { message };
                cooked.notes.push(one_line(&format!("{name}:{line}:{column}: {message}")).into_owned());
            }
        }
        if let Some(help) = &diagnostic.help {
            cooked.notes.push(visible(help).into_owned());
        }
        cooked
    }

    fn position(&self, source: u32, offset: u32) -> Option<(usize, usize)> {
        let text = &self.sources.get(source as usize)?.text;
        Some(self.lines[source as usize].line_column(text, offset))
    }

    /// False if showing the lines of a span would flood the terminal.
    fn is_showable(&self, span: Span) -> bool {
        let Some(source) = self.sources.get(span.source as usize) else { return false };
        let line_around = |offset: u32| {
            let offset = (offset as usize).min(source.text.len());
            let bytes = source.text.as_bytes();
            let before =
                bytes[..offset].iter().rev().take(LONGEST_LINE + 1).take_while(|&&b| b != b'\n').count();
            let after = bytes[offset..].iter().take(LONGEST_LINE + 1).take_while(|&&b| b != b'\n').count();
            before + after
        };
        line_around(span.start) <= LONGEST_LINE && line_around(span.end) <= LONGEST_LINE
    }

    /// A diagnostic as `interface` promises it to programs.
    pub(crate) fn to_json<'b>(&self, diagnostic: &'b Diagnostic) -> DiagnosticJson<'b> {
        DiagnosticJson {
            code: diagnostic.code.to_string(),
            severity: match diagnostic.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
                Severity::Note => "note",
            },
            message: &diagnostic.message,
            file: self.name(diagnostic.span).to_string(),
            span: self.span_json(diagnostic.span),
            labels: std::iter::once((diagnostic.span, &diagnostic.primary))
                .filter(|(_, message)| !message.is_empty())
                .chain(diagnostic.labels.iter().map(|label| (label.span, &label.message)))
                .map(|(span, message)| LabelJson {
                    file: self.name(span).to_string(),
                    span: self.span_json(span),
                    message,
                })
                .collect(),
            help: diagnostic.help.as_deref(),
            suggestions: diagnostic
                .suggestions
                .iter()
                .map(|suggestion| self.suggestion(suggestion))
                .collect(),
        }
    }

    fn suggestion<'b>(&self, suggestion: &'b Suggestion) -> SuggestionJson<'b> {
        let edits = suggestion.edits.iter().map(|edit| EditJson {
            file: self.name(edit.span).to_string(),
            span: self.span_json(edit.span),
            text: edit.text(self.sources).to_string(),
        });
        SuggestionJson { title: &suggestion.title, edits: edits.collect() }
    }

    /// `FILE:LINE:COLUMN` of a place.
    pub(crate) fn at(&self, span: Span) -> Option<String> {
        let (line, column) = self.position(span.source, span.start)?;
        Some(format!("{}:{line}:{column}", self.name(span)))
    }

    pub(crate) fn name(&self, span: Span) -> &str {
        self.sources.get(span.source as usize).map_or("", |source| source.name.as_str())
    }

    pub(crate) fn span_json(&self, span: Span) -> Option<SpanJson> {
        let position =
            |offset| self.position(span.source, offset).map(|(line, column)| Position { line, column });
        Some(SpanJson { start: position(span.start)?, end: position(span.end)? })
    }
}

#[derive(Serialize)]
pub(crate) struct DiagnosticJson<'a> {
    code: String,
    severity: &'static str,
    message: &'a str,
    file: String,
    span: Option<SpanJson>,
    labels: Vec<LabelJson<'a>>,
    help: Option<&'a str>,
    suggestions: Vec<SuggestionJson<'a>>,
}

/// Changes of the files that together put the problem right.
#[derive(Serialize)]
struct SuggestionJson<'a> {
    title: &'a str,
    edits: Vec<EditJson>,
}

/// What is written in the place of a span, which may be empty.
#[derive(Serialize)]
struct EditJson {
    file: String,
    span: Option<SpanJson>,
    text: String,
}

#[derive(Serialize)]
struct LabelJson<'a> {
    file: String,
    span: Option<SpanJson>,
    message: &'a str,
}

#[derive(Serialize)]
pub(crate) struct SpanJson {
    pub(crate) start: Position,
    pub(crate) end: Position,
}

/// Counted from 1, columns in characters.
#[derive(Serialize)]
pub(crate) struct Position {
    pub(crate) line: usize,
    pub(crate) column: usize,
}
