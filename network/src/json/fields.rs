//! What the fields of a network file may hold, and in plain words what is wrong if they hold something else.

use std::fmt;

use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::value::RawValue;

use crate::time::{Duration, ParseDurationError};

/// A JSON object, field by field, in order, nothing lost.
pub(super) struct Fields<'a>(pub(super) Vec<(String, &'a RawValue)>);

impl<'de> Deserialize<'de> for Fields<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Fields<'de>, D::Error> {
        struct FieldsVisitor;
        impl<'de> Visitor<'de> for FieldsVisitor {
            type Value = Fields<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "a network: a JSON object with `format`, `origin` and `events`")
            }

            fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Fields<'de>, M::Error> {
                let mut fields = Vec::new();
                while let Some(field) = map.next_entry()? {
                    fields.push(field);
                }
                Ok(Fields(fields))
            }
        }
        deserializer.deserialize_map(FieldsVisitor)
    }
}

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
pub(super) fn clipped(value: &str) -> String {
    match value.char_indices().nth(40) {
        Some((at, _)) => format!("{}...", &value[..at]),
        None => value.to_string(),
    }
}
