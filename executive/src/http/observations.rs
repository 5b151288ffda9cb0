//! The body of a message: `{"event-ids": ["+DOWNLINK::END+", ...]}`, and whatever else its sender likes to say.

use std::fmt;

use serde::Deserializer;
use serde::de::{Error, IgnoredAny, MapAccess, Visitor};

/// The events a message of news names, `{"event-ids": [...]}` with whatever else its sender likes to say.
///
/// # Errors
/// A sentence that says why it is none.
pub fn read(body: &[u8]) -> Result<Vec<String>, String> {
    // Some programs put a mark before it (BOM), which JSON does not know.
    let body = body.strip_prefix("\u{feff}".as_bytes()).unwrap_or(body);
    let mut json = serde_json::Deserializer::from_slice(body);
    let events = json.deserialize_map(Message).and_then(|events| json.end().map(|()| events));
    events.map_err(|error| {
        let expected = r#"{"event-ids": ["+DOWNLINK::END+"]}"#;
        format!("this is not news: {error}. News is a JSON object with a list of names of events, such as {expected}")
    })
}

struct Message;

impl<'de> Visitor<'de> for Message {
    type Value = Vec<String>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object with the key `event-ids`")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Vec<String>, A::Error> {
        let mut events = None;
        let mut meant = None;
        while let Some(key) = map.next_key::<String>()? {
            if key == "event-ids" {
                if events.replace(map.next_value()?).is_some() {
                    return Err(A::Error::custom("`event-ids` is there twice"));
                }
                continue;
            }
            map.next_value::<IgnoredAny>()?;
            if meant.is_none() && key.len() < 20 && key.to_lowercase().contains("event") {
                meant = Some(key);
            }
        }
        events.ok_or_else(|| {
            A::Error::custom(match meant {
                Some(key) => format!("there is `{key}` but no `event-ids`"),
                None => "there is no `event-ids`".to_string(),
            })
        })
    }
}
