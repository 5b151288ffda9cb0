//! What decided the time of a row of a timetable, in words.

use kirk_network::{Duration, EventId, Network};
use kirk_runtime::{Cause, Dispatcher, How, Row};

use crate::foreign::one_line;

/// What decided the time of a row, by the dispatcher that did; empty if nothing did, or it does not know.
pub(crate) fn why(dispatcher: &Dispatcher, row: &Row) -> String {
    let event = dispatcher.network().find(&row.event);
    event.map_or(String::new(), |event| why_event(dispatcher, event, &row.event))
}

/// The same of an event under one of its names.
pub(crate) fn why_event(dispatcher: &Dispatcher, event: EventId, called: &str) -> String {
    let network = dispatcher.network();
    let name = |other: EventId| format!("`{}`", one_line(name_beside(network, other, called)));
    let after = |other: EventId, distance: Duration| {
        let beside = name_beside(network, other, called);
        match other == network.origin() && beside == network.label(other) {
            true => format!("{distance} s after the start"),
            false => format!("{distance} s after {}", name(other)),
        }
    };
    // An event of Nature's may have other names beside the one it is heard by.
    let is_itself = network.label(event) == called;
    let its_news =
        || if is_itself { "its news".to_string() } else { format!("the news of {}", label(network, event)) };
    match dispatcher.why(event) {
        None => String::new(),
        Some(Cause::Start) => "at the start".to_string(),
        Some(Cause::After { event, distance: Duration::ZERO }) => at(dispatcher, event, &name(event)),
        Some(Cause::After { event, distance }) => after(event, distance),
        Some(Cause::Surely { event, latest, distance: Duration::ZERO }) => {
            format!("{} was by {latest} s", name(event))
        }
        Some(Cause::Surely { event, latest, distance }) => {
            format!("{}, which was by {latest} s", after(event, distance))
        }
        Some(Cause::Order { event }) => format!("after {} (order)", name(event)),
        Some(Cause::Unobserved { event: of, since, distance }) if of == event && is_itself => {
            format!("no news by {}", after(since, distance))
        }
        Some(Cause::Unobserved { event, since, distance }) => {
            format!("no news of {} by {}", label(network, event), after(since, distance))
        }
        Some(Cause::Observed) => its_news(),
        Some(Cause::Held { since, distance }) => {
            format!("{}, held until {}", its_news(), after(since, distance))
        }
        Some(Cause::Anew { news: Some(news) }) => {
            format!("as planned anew with the news of {}", label(network, news))
        }
        Some(Cause::Anew { news: None }) => "as planned anew".to_string(),
        Some(Cause::Late { due }) => format!("due at {due} s, done late"),
        Some(Cause::Closed { due }) => format!("due at {due} s, done early, and news closed its window"),
    }
}

fn label(network: &Network, event: EventId) -> String {
    format!("`{}`", one_line(network.label(event)))
}

/// Of the names of an event the one that belongs with another: `drill:start` beside `drill:end`.
fn name_beside<'a>(network: &'a Network, event: EventId, other: &str) -> &'a str {
    let stem = |name: &str| name.rsplit_once(':').map(|(stem, _)| stem.to_string());
    let is_sibling = |name: &&str| stem(name).is_some_and(|it| Some(it) == stem(other));
    network.written(event).find(is_sibling).unwrap_or(network.label(event))
}

/// At the time of another event: for one of Nature's that is when its news is acted on, or the lack of it.
fn at(dispatcher: &Dispatcher, event: EventId, name: &str) -> String {
    let label = label(dispatcher.network(), event);
    match dispatcher.known(event).fixed.map(|fixed| fixed.how) {
        Some(How::Observed) => format!("the news of {label}"),
        Some(How::Buffered) => format!("the news of {label}, held until then"),
        Some(How::Imagined) => format!("no news of {label} by then"),
        _ => format!("with {name}"),
    }
}
