//! What an executive knows when it goes on with a new plan: all there is to it but the plan, which follows from that.
//!
//! Planning is what takes its time when a mission is repeated, and of all plans only the last is needed to go on. So with
//! each plan that is followed the journal says what has become known since the one before; all of that together leads to
//! the executive as it was, with a single plan to make.

use std::collections::BTreeMap;

use kirk_network::{Interval, Time};
use serde::{Deserialize, Serialize};

use crate::knowledge::Known;
use crate::order::Course;

/// What has become known since the last checkpoint; several of them, one followed by the other, are
/// all that is known. Events go by name, times are microseconds after the origin.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint {
    /// How often anything has happened to the dispatcher, and to the executive besides.
    pub(crate) versions: (u64, u64),
    /// What is known of events.
    pub(crate) events: BTreeMap<String, Known>,
    /// What is or was in the hands of the driver, by number.
    pub(crate) orders: BTreeMap<u32, Course>,
    /// News that waits for what is in flight.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) held: Vec<(i64, String)>,
    /// Events whose news is still to come, and when it is to at the latest.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) awaited: Vec<(i64, String)>,
    /// News the model rules out that nobody was told of, as it was not known whether the mission can go on: when it arrived,
    /// of which event, and what to say.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) broken: Vec<(i64, String, String)>,
}

impl Checkpoint {
    /// All that is known once this and then that has become known.
    pub(crate) fn followed_by(&mut self, later: &Checkpoint) {
        let Checkpoint { mut events, mut orders, .. } = std::mem::replace(self, later.clone());
        events.append(&mut self.events);
        orders.append(&mut self.orders);
        (self.events, self.orders) = (events, orders);
    }
}

/// Times as checkpoints have them, for `#[serde(with = "micros")]`.
pub(crate) mod micros {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::InMicros;

    pub(crate) fn serialize<T: InMicros, S: Serializer>(time: &T, serializer: S) -> Result<S::Ok, S::Error> {
        time.to_micros().serialize(serializer)
    }

    pub(crate) fn deserialize<'de, T: InMicros, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<T, D::Error> {
        T::Micros::deserialize(deserializer).map(T::of_micros)
    }
}

/// What is written in whole microseconds.
pub(crate) trait InMicros: Copy {
    type Micros: Serialize + for<'de> Deserialize<'de>;

    fn to_micros(self) -> Self::Micros;
    fn of_micros(micros: Self::Micros) -> Self;
}

impl InMicros for Time {
    type Micros = i64;

    fn to_micros(self) -> i64 {
        self.as_micros()
    }

    fn of_micros(micros: i64) -> Time {
        Time::from_micros(micros)
    }
}

impl InMicros for Interval {
    type Micros = (i64, i64);

    fn to_micros(self) -> (i64, i64) {
        (self.earliest.to_micros(), self.latest.to_micros())
    }

    fn of_micros((earliest, latest): (i64, i64)) -> Interval {
        Interval::new(Time::of_micros(earliest), Time::of_micros(latest))
    }
}

impl<T: InMicros> InMicros for Option<T> {
    type Micros = Option<T::Micros>;

    fn to_micros(self) -> Option<T::Micros> {
        self.map(T::to_micros)
    }

    fn of_micros(micros: Option<T::Micros>) -> Option<T> {
        micros.map(T::of_micros)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Journals are read for as long as robots keep them.
    #[test]
    fn a_checkpoint_is_written_as_it_always_was() {
        let events = r#""a":{"fixed":[0,"dispatched",0]},"b":{"fixed":[7000000,"imagined",1],"evidence":[4000000,9223372036854775807],"settled":true},"c":{"observed":9500000,"evidence":[-9223372036854775808,9000000],"settled":true,"overruled":true},"d":{}"#;
        let orders = r#""0":{"name":"a:start","due":0,"closes":100000,"first_sent":0,"started":1,"attempts":1,"state":"done"},"7":{"name":"b:start","due":1500000,"closes":9223372036854775807,"first_sent":1500000,"started":1600000,"attempts":2,"state":{"waiting":3000000},"reason":"no power","doubtful":true},"8":{"name":"c:start","due":1,"closes":2,"first_sent":3,"started":4,"attempts":1,"state":"sent"}"#;
        let lists =
            r#""held":[[1500000,"b"]],"awaited":[[2000000,"c"]],"broken":[[3000000,"d","it is late"]]"#;
        for text in [
            format!(r#"{{"versions":[12,3],"events":{{{events}}},"orders":{{{orders}}},{lists}}}"#),
            r#"{"versions":[0,0],"events":{},"orders":{}}"#.to_string(),
        ] {
            let checkpoint: Checkpoint = serde_json::from_str(&text).unwrap();
            assert_eq!(serde_json::to_string(&checkpoint).unwrap(), text);
        }
        let strange = r#"{"versions":[0,0],"events":{"a":{"tea":1}},"orders":{}}"#;
        assert!(serde_json::from_str::<Checkpoint>(strange).is_err());
    }
}
