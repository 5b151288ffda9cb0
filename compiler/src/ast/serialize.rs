//! How numbers, names and values are written for `--emit ast`.

use kirk_network::Duration;
use serde::ser::SerializeSeq;
use serde::{Serialize, Serializer};

use super::{Amount, AmountKind, Ident, Import, ValueKind};

impl Serialize for Import {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&format_args!("{}:{}", self.from.name, self.name.name))
    }
}

impl Serialize for Ident {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.package {
            Some(package) => serializer.collect_str(&format_args!("{package}:{}", self.name)),
            None => serializer.serialize_str(&self.name),
        }
    }
}

impl Serialize for Amount {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.kind {
            AmountKind::Number(duration) => seconds(duration, serializer),
            AmountKind::Infinite => serializer.serialize_str(":infinity"),
            AmountKind::Named(name) => name.serialize(serializer),
            AmountKind::Unit(name, _, amount) => (name, amount).serialize(serializer),
            AmountKind::Calculation(operator, amounts) => {
                let mut list = serializer.serialize_seq(Some(amounts.len() + 1))?;
                list.serialize_element(operator)?;
                for amount in amounts {
                    list.serialize_element(amount)?;
                }
                list.end()
            }
            AmountKind::Error => serializer.serialize_str("?"),
        }
    }
}

impl Serialize for ValueKind {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            ValueKind::Number(number) => seconds(number, serializer),
            ValueKind::Text(text) => serializer.collect_str(&format_args!("\"{text}\"")),
            ValueKind::True => serializer.serialize_str("t"),
            ValueKind::Nil => serializer.serialize_str("nil"),
            ValueKind::Symbol(name) => serializer.collect_str(&format_args!("'{name}")),
            ValueKind::Name(Some(package), name) => serializer.collect_str(&format_args!("{package}:{name}")),
            ValueKind::Name(None, name) | ValueKind::Other(name) => serializer.serialize_str(name),
        }
    }
}

/// Seconds as a number: whole ones without a fraction. Exact below 2^53 microseconds, as JSON readers are.
pub(crate) fn seconds<S: Serializer>(duration: &Duration, serializer: S) -> Result<S::Ok, S::Error> {
    match duration.whole_seconds() {
        Some(seconds) => serializer.serialize_i64(seconds),
        None => serializer.serialize_f64(duration.as_micros() as f64 / 1e6),
    }
}
