//! SARIF 2.1.0 (OASIS, *Static Analysis Results Interchange Format*): what editors and code hosts read diagnostics from.
//!
//! One log with one run for all files. A rule for each code that occurs, with its page as help; a result for each
//! diagnostic, the secondary places as related locations, what would put it right as fixes. The verdict on a file is with
//! the file, among the artifacts.

use std::collections::BTreeMap;

use kirk_compiler::code::markdown;
use kirk_compiler::{Code, Diagnostic, Severity, Suggestion, explain};
use serde_json::{Value, json};

use crate::input::Loaded;
use crate::judge::CheckJson;
use crate::output::Status;
use crate::report::{Reporter, SpanJson};

/// The log in the making.
#[derive(Default)]
pub(crate) struct Log {
    rules: Vec<Code>,
    artifacts: Vec<Value>,
    results: Vec<Value>,
}

impl Log {
    /// Adds one checked input.
    pub(crate) fn add(&mut self, input: &Loaded, reporter: &Reporter<'_>, checked: &CheckJson<'_>) {
        let first = self.artifacts.len();
        for source in &input.sources {
            self.artifacts.push(json!({
                "location": {"uri": uri(&source.name)},
                "properties": &checked.verdict,
            }));
        }
        let mut conflicts = checked.conflicts.iter();
        for diagnostic in &input.diagnostics {
            let rule = self.rule(diagnostic.code);
            let place = |span: kirk_compiler::Span, message: &str| {
                let index = first + span.source as usize;
                let name = input.sources.get(span.source as usize).map_or("", |source| source.name.as_str());
                let mut place = json!({
                    "physicalLocation": {
                        "artifactLocation": {"uri": uri(name), "index": index},
                        "region": reporter.span_json(span).map(region),
                    },
                });
                if !message.is_empty() {
                    place["message"] = json!({"text": message});
                }
                place
            };
            let related: Vec<Value> = diagnostic
                .labels
                .iter()
                .enumerate()
                .map(|(id, label)| {
                    let mut place = place(label.span, &label.message);
                    place["id"] = json!(id);
                    place
                })
                .collect();
            let mut result = json!({
                "ruleId": diagnostic.code.to_string(),
                "ruleIndex": rule,
                "level": level(diagnostic.severity),
                "message": {"text": text(diagnostic)},
                "locations": [place(diagnostic.span, &diagnostic.primary)],
                "relatedLocations": related,
            });
            if !diagnostic.suggestions.is_empty() {
                let fix = |suggestion: &Suggestion| fix(suggestion, first, input, reporter);
                result["fixes"] = diagnostic.suggestions.iter().map(fix).collect();
            }
            // Each has a diagnostic of its own, in the same order.
            if diagnostic.code == Code::NotControllable
                && let Some(conflict) = conflicts.next()
            {
                result["properties"] = json!({"conflict": &conflict.members});
            }
            self.results.push(result);
        }
    }

    /// The finished log.
    pub(crate) fn document(self, status: Status) -> Value {
        let rules: Vec<Value> = self
            .rules
            .iter()
            .map(|code| {
                json!({
                    "id": code.to_string(),
                    "name": format!("{code:?}"),
                    "shortDescription": {"text": code.title()},
                    "fullDescription": {"text": code.meaning()},
                    "help": {"text": explain(&code.to_string()), "markdown": markdown(*code)},
                })
            })
            .collect();
        json!({
            "$schema": "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json",
            "version": "2.1.0",
            "runs": [{
                "tool": {"driver": {
                    "name": "kirk",
                    "semanticVersion": env!("CARGO_PKG_VERSION"),
                    "rules": rules,
                }},
                "columnKind": "unicodeCodePoints",
                "invocations": [{
                    // Wrong input is a result, and not a failure of kirk.
                    "executionSuccessful": true,
                    "exitCode": status as u8,
                }],
                "artifacts": self.artifacts,
                "results": self.results,
            }],
        })
    }

    /// The index of the rule of a code.
    fn rule(&mut self, code: Code) -> usize {
        self.rules.iter().position(|known| *known == code).unwrap_or_else(|| {
            self.rules.push(code);
            self.rules.len() - 1
        })
    }
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    }
}

/// What is the matter and what to do about it.
fn text(diagnostic: &Diagnostic) -> String {
    let mut text = diagnostic.message.clone();
    if let Some(help) = &diagnostic.help {
        text.push('\n');
        text.push_str(help);
    }
    text
}

/// The changes of a suggestion, file by file.
fn fix(suggestion: &Suggestion, first: usize, input: &Loaded, reporter: &Reporter<'_>) -> Value {
    let mut changes: BTreeMap<u32, Vec<Value>> = BTreeMap::new();
    for edit in &suggestion.edits {
        changes.entry(edit.span.source).or_default().push(json!({
            "deletedRegion": reporter.span_json(edit.span).map(region),
            "insertedContent": {"text": edit.text(&input.sources)},
        }));
    }
    let changed = |(source, replacements): (u32, Vec<Value>)| {
        let name = input.sources.get(source as usize).map_or("", |source| source.name.as_str());
        json!({
            "artifactLocation": {"uri": uri(name), "index": first + source as usize},
            "replacements": replacements,
        })
    };
    let changes: Vec<Value> = changes.into_iter().map(changed).collect();
    json!({"description": {"text": suggestion.title}, "artifactChanges": changes})
}

/// Both count from 1, in characters, and name the column after the last one.
fn region(span: SpanJson) -> Value {
    json!({
        "startLine": span.start.line,
        "startColumn": span.start.column,
        "endLine": span.end.line,
        "endColumn": span.end.column,
    })
}

/// The name of a file as a URI: relative as it was given, absolute with its scheme.
fn uri(name: &str) -> String {
    let mut uri = String::from(if name.starts_with('/') { "file://" } else { "" });
    for byte in name.bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => {
                uri.push(char::from(byte))
            }
            _ => uri.push_str(&format!("%{byte:02X}")),
        }
    }
    uri
}
