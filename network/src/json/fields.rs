//! What the fields of a network file may hold, and in plain words what is wrong if they hold something else.

use serde_json::value::RawValue;

use super::ReadProblem;
use crate::time::{Duration, ParseDurationError};

/// What a field may hold.
#[derive(Clone, Copy)]
pub(super) enum Content {
    Name,
    Seconds,
    /// Seconds, or `null` or absent for none.
    Bound,
    /// Two bounds, or `null` or absent for none.
    Delay,
}

pub(super) const REQUIREMENT: [(&str, Content); 4] =
    [("from", Content::Name), ("to", Content::Name), ("lower", Content::Bound), ("upper", Content::Bound)];
pub(super) const CONTINGENT: [(&str, Content); 5] = [
    ("from", Content::Name),
    ("to", Content::Name),
    ("lower", Content::Seconds),
    ("upper", Content::Seconds),
    ("delay", Content::Delay),
];

impl Content {
    /// What it is, after "must be".
    pub(super) fn describe(self) -> &'static str {
        match self {
            Content::Name => "the name of an event in quotation marks",
            Content::Seconds => "a number of seconds",
            Content::Bound => "a number of seconds, or `null` for none",
            Content::Delay => {
                "a list of two numbers of seconds, [shortest, longest], the longest `null` if the news may never come"
            }
        }
    }

    /// If the value is not of this kind, what it is.
    pub(super) fn check(self, value: &str) -> Result<(), String> {
        let told = || clipped(value);
        match self {
            Content::Name => value.starts_with('"').then_some(()).ok_or_else(told),
            Content::Bound | Content::Delay if value == "null" => Ok(()),
            Content::Seconds | Content::Bound => {
                Duration::parse_seconds(value).map(drop).map_err(|error| match error {
                    ParseDurationError::NotANumber => told(),
                    error => format!("{}: {error}", told()),
                })
            }
            Content::Delay => match serde_json::from_str::<Vec<&RawValue>>(value).as_deref() {
                Ok([min, max]) => {
                    Content::Seconds.check(min.get())?;
                    Content::Bound.check(max.get())
                }
                Ok(list) => Err(format!("a list of {}", list.len())),
                Err(_) => Err(told()),
            },
        }
    }
}

/// A value short enough for a message.
fn clipped(value: &str) -> String {
    match value.char_indices().nth(40) {
        Some((at, _)) => format!("{}...", &value[..at]),
        None => value.to_string(),
    }
}

/// Where and what an error of serde_json on `text` is.
pub fn locate(text: &str, error: &serde_json::Error) -> ReadProblem {
    problem(text, 0, "", text, error)
}

/// Words an error of serde_json, which counts lines and columns within `part` (that starts at `start` of `text`).
pub(super) fn problem(
    text: &str,
    start: usize,
    element: &str,
    part: &str,
    error: &serde_json::Error,
) -> ReadProblem {
    if part.trim().is_empty() {
        return ReadProblem {
            offset: start,
            message: "there is nothing here; a JSON document was expected".to_string(),
        };
    }
    let line_start: usize =
        part.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum::<usize>();
    let mut offset = (start + line_start + error.column().saturating_sub(1)).min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    let mut message = error.to_string();
    if let Some(at) = message.rfind(" at line ") {
        message.truncate(at);
    }
    let message = plainly(&message);
    let message = if element.is_empty() { message } else { format!("{element}: {message}") };
    ReadProblem { offset, message }
}

/// A message of serde_json in the words of kirk: what was expected, and what is there.
fn plainly(message: &str) -> String {
    let thing = |words: &str| match words {
        "map" => "an object".to_string(),
        "sequence" | "a sequence" => "a list".to_string(),
        "null" => "`null`".to_string(),
        "a string" => "a text in quotation marks".to_string(),
        words => match words.split_once(' ') {
            Some(("integer" | "boolean" | "floating point", value)) => value.to_string(),
            Some(("string", value)) => format!("the text {value}"),
            _ => words.to_string(),
        },
    };
    let quoted = |message: &str| message.split('`').nth(1).map(str::to_string).unwrap_or_default();
    if let Some((found, expected)) = message
        .strip_prefix("invalid type: ")
        .or_else(|| message.strip_prefix("invalid length "))
        .and_then(|rest| rest.split_once(", expected "))
    {
        return format!("expected {}, not {}", thing(expected), thing(found));
    }
    match message {
        "expected value" => {
            "a value was expected here: a number, a text in double quotation marks, a list or an object"
                .to_string()
        }
        "key must be a string" => {
            "the name of a field in double quotation marks was expected here".to_string()
        }
        "trailing characters" => "something follows after the end of the JSON document".to_string(),
        "trailing comma" => "a comma stands before the end of this list or object".to_string(),
        _ if message.starts_with("EOF while parsing") => {
            format!("the text ends in the middle of {}", &message["EOF while parsing ".len()..])
        }
        _ if message.starts_with("missing field") => format!("the field `{}` is missing", quoted(message)),
        _ if message.starts_with("duplicate field") => {
            format!("the field `{}` is there twice", quoted(message))
        }
        _ if message.starts_with("unknown field") => {
            let known = message.split_once(", expected ").map_or("", |(_, known)| known);
            format!("there is no field `{}`; expected {known}", quoted(message))
        }
        _ => message.to_string(),
    }
}
