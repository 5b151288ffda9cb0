//! A JSON value for serde to read whose errors are not sentences but what serde knows, and where that is.

use std::{fmt, vec};

use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, Error, Expected, IntoDeserializer, MapAccess, SeqAccess,
    Unexpected, Visitor,
};
use serde::forward_to_deserialize_any;
use serde_json::Value;
use serde_json::value::RawValue;

use super::ReadProblem;
use super::fields::{Fields, clipped};

type Words = &'static [&'static str];
type Read<'de, V> = Result<<V as Visitor<'de>>::Value, Wrong>;

/// A value in a text.
#[derive(Clone, Copy)]
pub(super) struct Element<'de> {
    pub(super) text: &'de str,
    pub(super) raw: &'de RawValue,
}

/// What is wrong with a value.
#[derive(Debug)]
pub(super) enum Wrong {
    /// It is not what was expected.
    Expected(String),
    Other(String),
    /// It is said where.
    Located(ReadProblem),
}

impl Wrong {
    /// The value that is to blame, unless a part of it is.
    fn at(self, element: Element<'_>) -> Wrong {
        let message = match self {
            Wrong::Located(_) => return self,
            Wrong::Expected(what) => format!("expected {what}, not {}", element.describe()),
            Wrong::Other(message) => message,
        };
        Wrong::Located(ReadProblem { offset: element.offset(), message })
    }
}

impl<'de> Element<'de> {
    /// Where it is in the text.
    pub(super) fn offset(self) -> usize {
        (self.raw.get().as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize).min(self.text.len())
    }

    /// What it is, after "not".
    fn describe(self) -> String {
        match self.raw.get().as_bytes().first() {
            Some(b'{') => "an object".to_string(),
            Some(b'[') => "a list".to_string(),
            Some(b'"') => format!("the text {}", clipped(self.raw.get())),
            _ => format!("`{}`", clipped(self.raw.get())),
        }
    }

    /// Reads it if it begins as what is expected does.
    fn visit_if<V: Visitor<'de>>(self, begin: char, expected: &str, visitor: V) -> Read<'de, V> {
        if !self.raw.get().starts_with(begin) {
            return Err(Wrong::Expected(expected.to_string()).at(self));
        }
        self.visit(visitor).map_err(|wrong| wrong.at(self))
    }

    fn visit<V: Visitor<'de>>(self, visitor: V) -> Read<'de, V> {
        match self.raw.get().as_bytes().first() {
            Some(b'{') => {
                let Fields(fields) = self.read()?;
                let mut parts = Parts { rest: fields.into_iter(), of: self, last: None };
                visitor.visit_map(&mut parts).map_err(|wrong| wrong.at(parts.last.unwrap_or(self)))
            }
            Some(b'[') => {
                let list: Vec<&RawValue> = self.read()?;
                let list: Vec<_> = list.into_iter().map(|raw| (String::new(), raw)).collect();
                let mut parts = Parts { rest: list.into_iter(), of: self, last: None };
                visitor.visit_seq(&mut parts).map_err(|wrong| wrong.at(parts.last.unwrap_or(self)))
            }
            _ => match self.read()? {
                Value::Bool(value) => visitor.visit_bool(value),
                Value::String(text) => visitor.visit_string(text),
                Value::Number(number) => match (number.as_u64(), number.as_i64()) {
                    (Some(number), _) => visitor.visit_u64(number),
                    (_, Some(number)) => visitor.visit_i64(number),
                    _ => visitor.visit_f64(number.as_f64().unwrap_or(f64::INFINITY)),
                },
                Value::Null | Value::Array(_) | Value::Object(_) => visitor.visit_unit(),
            },
        }
    }

    /// As what it is known to be.
    fn read<T: Deserialize<'de>>(self) -> Result<T, Wrong> {
        serde_json::from_str(self.raw.get()).map_err(|error| Wrong::Other(words(&error)))
    }
}

impl<'de> Deserializer<'de> for Element<'de> {
    type Error = Wrong;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Read<'de, V> {
        self.visit(visitor).map_err(|wrong| wrong.at(self))
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Read<'de, V> {
        self.visit_if('"', "a text in quotation marks", visitor)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Read<'de, V> {
        self.deserialize_str(visitor)
    }

    fn deserialize_u64<V: Visitor<'de>>(self, visitor: V) -> Read<'de, V> {
        let is_natural = self.raw.get().bytes().all(|byte| byte.is_ascii_digit());
        let expected =
            if is_natural { "a whole number below 2^64" } else { "a whole number that is not negative" };
        let number = self.read().map_err(|_| Wrong::Expected(expected.to_string()).at(self))?;
        visitor.visit_u64(number).map_err(|wrong: Wrong| wrong.at(self))
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Read<'de, V> {
        self.visit_if('[', "a list", visitor)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Read<'de, V> {
        let expected = format!("a list of {length}");
        match self.read::<Vec<&RawValue>>() {
            Ok(list) if list.len() != length => {
                Err(Wrong::Other(format!("expected {expected}, not of {}", list.len())).at(self))
            }
            _ => self.visit_if('[', &expected, visitor),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(self, _: &'static str, _: Words, visitor: V) -> Read<'de, V> {
        self.visit_if('{', "an object", visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Read<'de, V> {
        if self.raw.get() == "null" { visitor.visit_none() } else { visitor.visit_some(self) }
    }

    fn deserialize_enum<V: Visitor<'de>>(self, _: &'static str, _: Words, visitor: V) -> Read<'de, V> {
        let word = String::deserialize(self)?;
        visitor.visit_enum(word.into_deserializer()).map_err(|wrong: Wrong| wrong.at(self))
    }

    /// However deep it is.
    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Read<'de, V> {
        visitor.visit_unit()
    }

    /// A [`RawValue`], which only serde_json can make.
    fn deserialize_newtype_struct<V: Visitor<'de>>(self, name: &'static str, visitor: V) -> Read<'de, V> {
        let mut deserializer = serde_json::Deserializer::from_str(self.raw.get());
        deserializer
            .deserialize_newtype_struct(name, visitor)
            .map_err(|error| Wrong::Other(words(&error)).at(self))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u128 f32 f64 char bytes byte_buf unit unit_struct tuple_struct map
        identifier
    }
}

/// The elements of a list, or the fields of an object.
struct Parts<'de> {
    rest: vec::IntoIter<(String, &'de RawValue)>,
    of: Element<'de>,
    /// The one that is looked at.
    last: Option<Element<'de>>,
}

impl Parts<'_> {
    fn next(&mut self) -> Option<String> {
        let next = self.rest.next();
        self.last = next.as_ref().map(|(_, raw)| Element { raw, ..self.of });
        next.map(|(name, _)| name)
    }
}

impl<'de> SeqAccess<'de> for Parts<'de> {
    type Error = Wrong;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Wrong> {
        self.next();
        self.last.map(|element| seed.deserialize(element)).transpose()
    }
}

impl<'de> MapAccess<'de> for Parts<'de> {
    type Error = Wrong;

    fn next_key_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Wrong> {
        self.next().map(|name| seed.deserialize(name.into_deserializer())).transpose()
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Wrong> {
        seed.deserialize(self.last.unwrap_or(self.of))
    }
}

impl std::error::Error for Wrong {}

impl fmt::Display for Wrong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self, f)
    }
}

impl Error for Wrong {
    fn custom<T: fmt::Display>(message: T) -> Wrong {
        Wrong::Other(message.to_string())
    }

    fn invalid_type(_: Unexpected<'_>, expected: &dyn Expected) -> Wrong {
        Wrong::Expected(expected.to_string())
    }

    fn invalid_value(_: Unexpected<'_>, expected: &dyn Expected) -> Wrong {
        Wrong::Expected(expected.to_string())
    }

    fn unknown_variant(word: &str, expected: Words) -> Wrong {
        Wrong::Other(format!("`{word}` is not known here; expected {}", one_of(expected)))
    }

    fn unknown_field(field: &str, expected: Words) -> Wrong {
        Wrong::Other(format!("there is no field `{field}`; expected {}", one_of(expected)))
    }

    fn missing_field(field: &'static str) -> Wrong {
        Wrong::Other(format!("the field `{field}` is missing"))
    }

    fn duplicate_field(field: &'static str) -> Wrong {
        Wrong::Other(format!("the field `{field}` is there twice"))
    }
}

/// What serde_json says, without the place.
pub(super) fn words(error: &serde_json::Error) -> String {
    let words = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    words.strip_suffix(&place).unwrap_or(&words).to_string()
}

fn one_of(words: &[&str]) -> String {
    match words {
        [] => "none".to_string(),
        [one] => format!("`{one}`"),
        [one, other] => format!("`{one}` or `{other}`"),
        more => format!("one of `{}`", more.join("`, `")),
    }
}
