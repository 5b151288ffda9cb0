//! How the plan treats the news of each contingent event: when it is acted on, or why it is not waited for.

use crate::merge::merge;
use crate::model::{ContingentLink, Delay, Network};
use crate::reduce::reduce;
use crate::time::Duration;

/// What becomes of the news of one contingent event.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Treatment {
    /// The name of the event.
    pub event: String,
    /// How late it is heard: `heard 5 to 15 s late`.
    pub heard: String,
    /// What is done about it, as a clause.
    pub how: String,
}

/// One treatment for each contingent link, in their order; empty if Nature alone can violate a constraint.
pub fn treatments(network: &Network) -> Vec<Treatment> {
    let merged = merge(network).network;
    let Ok(reduction) = reduce(&merged) else { return Vec::new() };
    let seconds = Duration::from_micros;
    let mut link_at = vec![None; reduction.event_of.len()];
    for link in &reduction.stnu.links {
        link_at[link.contingent as usize] = Some(link);
    }
    let treatment = |contingent: &ContingentLink| {
        let place = reduction.places[contingent.to.index()];
        let heard = match contingent.delay {
            Delay::NONE => "heard at once".to_string(),
            Delay { min, max } => match max.finite() {
                Some(max) => format!("heard {min} to {max} s late"),
                None => format!("heard {min} s late at the earliest, perhaps never"),
            },
        };
        let how = match (place.heard_by, link_at[place.node as usize]) {
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
                let (low, high) = (place.earliest, place.latest);
                format!(
                    "its news is not needed: whenever it is heard, it happens {low} to {high} s after `{start}`"
                )
            }
        };
        Treatment { event: merged.label(contingent.to).to_string(), heard, how }
    };
    merged.contingents().iter().map(treatment).collect()
}

/// For each contingent link whether its news is late and tells nothing of when its end was: it may never come, or be so much later at one
/// time than at another. All false if Nature alone can violate a constraint.
pub fn untold(network: &Network) -> Vec<bool> {
    let merged = merge(network).network;
    let reduction = reduce(&merged);
    let is_untold = |link: &ContingentLink| {
        let place = reduction.as_ref().ok().map(|reduction| reduction.places[link.to.index()]);
        link.delay != Delay::NONE
            && place.is_some_and(|place| place.heard_by.is_none() && place.earliest != place.latest)
    };
    merged.contingents().iter().map(is_untold).collect()
}
