//! Which events are handed over to a driver, and as what.
//!
//! The driver hears of the starts of activities, each with its companion, the end of the activity. An event of several
//! names may start several activities. Events that are no action of anybody are not handed over (thesis, 6.1.1).

use kirk_network::{EventId, Network};

/// Which events a driver hears of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Scope {
    /// The starts of activities.
    #[default]
    Starts,
    /// Also the ends that we decide ourselves.
    All,
}

/// One event as it is handed over, under one of its names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Handover {
    /// The event of the merged network.
    pub event: EventId,
    /// The name: `upload-a:start`.
    pub name: String,
    /// The end of the activity it starts, `upload-a:end`.
    pub companion: Option<String>,
}

/// What a driver is to hear of, in the order of the events and of their names. `activities` are the names of the activities
/// of a mission, without `:start`; `None` for networks that do not say, where every `x:start` with an `x:end` starts an
/// activity and, with [`Scope::All`], every executable event is handed over.
pub fn handovers(network: &Network, activities: Option<&[String]>, scope: Scope) -> Vec<Handover> {
    let mut all = Vec::new();
    for event in network.event_ids() {
        let ours = network.link_of(event).is_none();
        for name in network.events()[event.index()].names.iter().filter(|name| !name.internal) {
            let activity = |suffix: &str| {
                let activity = name.text.strip_suffix(suffix)?;
                let known = match activities {
                    Some(activities) => activities.iter().any(|known| known == activity),
                    None => {
                        network.find(&format!("{activity}:start")).is_some()
                            && network.find(&format!("{activity}:end")).is_some()
                    }
                };
                known.then_some(activity)
            };
            let companion = activity(":start").map(|activity| format!("{activity}:end"));
            let also = scope == Scope::All && ours && (activities.is_none() || activity(":end").is_some());
            if companion.is_some() || also {
                all.push(Handover { event, name: name.text.clone(), companion });
            }
        }
    }
    all
}

/// The spelling of the original Kirk: `upload-a:start` is `+UPLOAD-A::START+`.
pub fn original_spelling(name: &str) -> String {
    format!("+{}+", name.replacen(':', "::", 1).to_uppercase())
}

#[cfg(test)]
mod tests {
    use kirk_network::json;
    use kirk_network::model::normal_name;

    use super::*;

    #[test]
    fn the_original_spelling_reads_back() {
        for name in ["upload-a:start", "drive#2:end", "z"] {
            assert_eq!(normal_name(&original_spelling(name)), name);
        }
        assert_eq!(original_spelling("upload-a:start"), "+UPLOAD-A::START+");
    }

    #[test]
    fn a_start_has_its_end_as_companion_and_an_end_of_ours_has_none() {
        let network = json::read(
            r#"{"format": "kirk-network/1", "origin": "main:start",
                "events": ["main:start", "a:start", "a:end", "b:start", "b:end"],
                "requirements": [{"from": "a:start", "to": "a:end", "lower": 1, "upper": 2}],
                "contingents": [{"from": "b:start", "to": "b:end", "lower": 1, "upper": 2}]}"#,
        )
        .unwrap();
        let names = |scope| -> Vec<(String, Option<String>)> {
            let activities = ["a".to_string(), "b".to_string()];
            let all = handovers(&network, Some(&activities), scope);
            all.into_iter().map(|handover| (handover.name, handover.companion)).collect()
        };
        let start = |activity: &str| (format!("{activity}:start"), Some(format!("{activity}:end")));
        assert_eq!(names(Scope::Starts), [start("a"), start("b")]);
        assert_eq!(names(Scope::All), [start("a"), ("a:end".to_string(), None), start("b")]);
    }
}
