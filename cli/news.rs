//! How the plan treats the news of each contingent event, for `--verbose`.

use kirk_network::merge::merge;
use kirk_network::reduce::reduce;
use kirk_network::{Delay, Duration, Network};

/// One line for each contingent event: when its news is acted on, or why it is not waited for. Empty if there are none.
pub(crate) fn treatment(network: &Network) -> String {
    let merged = merge(network).network;
    let Ok(reduction) = reduce(&merged) else { return String::new() };
    let seconds = Duration::from_micros;
    let mut text = String::new();
    for contingent in merged.contingents() {
        let place = reduction.places[contingent.to.index()];
        let name = merged.label(contingent.to);
        let late = match contingent.delay {
            Delay::NONE => "heard at once".to_string(),
            Delay { min, max } => match max.finite() {
                Some(max) => format!("heard {min} to {max} s late"),
                None => format!("heard {min} s late at the earliest, perhaps never"),
            },
        };
        let link = reduction.stnu.links.iter().find(|link| link.contingent == place.node);
        let how = match (place.heard_by, link) {
            (Some(news), Some(link)) => {
                let start = merged.label(reduction.event_of[link.activation as usize]);
                let (low, high) = (seconds(link.lower), seconds(link.upper));
                let whose = if news == contingent.to {
                    "acted on".to_string()
                } else {
                    format!("known through `{}`, which is acted on", merged.label(news))
                };
                format!("{whose} {low} to {high} s after `{start}`")
            }
            _ => {
                let start = merged.label(reduction.event_of[place.node as usize]);
                let (low, high) = (seconds(place.earliest), seconds(place.latest));
                format!(
                    "its news is not needed: whenever it is heard, it happens {low} to {high} s after `{start}`"
                )
            }
        };
        text.push_str(&format!("  `{name}`: {late}; {how}\n"));
    }
    text
}
