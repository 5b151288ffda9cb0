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
        for name in network.written(event) {
            let activity = |suffix: &str| {
                let activity = name.strip_suffix(suffix)?;
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
                all.push(Handover { event, name: name.to_string(), companion });
            }
        }
    }
    all
}

/// Leaves out what starts at an event that Nature decides, as the original Kirk does: its middleware begins such activities by
/// itself when it reports the event.
pub fn leave_out_natures(network: &Network, handovers: &mut Vec<Handover>) {
    handovers.retain(|handover| network.link_of(handover.event).is_none());
}

/// Names as companion the event that the end of an activity is one with, as the original Kirk does: it knows an event of
/// several names by the start among them (thesis, B.1: `take-pictures:end` becomes `eat-snack:start`). Of several starts the
/// first is taken.
pub fn merge_companions(network: &Network, handovers: &mut [Handover]) {
    let starts = handovers.iter().filter(|handover| handover.companion.is_some());
    let mut start_of: Vec<Option<String>> = vec![None; network.events().len()];
    for Handover { event, name, .. } in starts {
        start_of[event.index()].get_or_insert_with(|| name.clone());
    }
    for companion in handovers.iter_mut().filter_map(|handover| handover.companion.as_mut()) {
        if let Some(start) = network.find(companion).and_then(|event| start_of[event.index()].clone()) {
            *companion = start;
        }
    }
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

    /// A flight of Nature's, and without slack after it an upload of ours and the landing.
    #[test]
    fn as_the_original_does_starts_of_natures_are_left_out_and_companions_are_named_by_what_follows() {
        let network = json::read(
            r#"{"format": "kirk-network/1", "origin": "fly:start",
                "events": ["fly:start", {"id": "fly:end", "names": ["fly:end", "upload:start", "talk:start"]},
                           {"id": "upload:end", "names": ["upload:end", "land:start"]}, "land:end", "talk:end"],
                "requirements": [{"from": "upload:start", "to": "upload:end", "lower": 30, "upper": 40},
                                 {"from": "land:start", "to": "land:end", "lower": 1, "upper": 5},
                                 {"from": "talk:start", "to": "talk:end", "lower": 1, "upper": 5}],
                "contingents": [{"from": "fly:start", "to": "fly:end", "lower": 1, "upper": 600}]}"#,
        );
        let network = network.unwrap();
        let activities = ["fly", "upload", "land", "talk"].map(str::to_string);
        let told = |handovers: &[Handover]| -> Vec<String> {
            let told = |h: &Handover| format!("{} {}", h.name, h.companion.as_deref().unwrap_or("NIL"));
            handovers.iter().map(told).collect()
        };
        let mut all = handovers(&network, Some(&activities), Scope::All);
        merge_companions(&network, &mut all);
        let merged = [
            "fly:start upload:start",
            "upload:start land:start",
            "talk:start talk:end",
            "upload:end NIL",
            "land:start land:end",
            "land:end NIL",
            "talk:end NIL",
        ];
        assert_eq!(told(&all), merged);
        leave_out_natures(&network, &mut all);
        let ours = [merged[0], merged[3], merged[4], merged[5], merged[6]];
        assert_eq!(told(&all), ours);
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
