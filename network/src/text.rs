//! Networks as text for people: one event, requirement or link a line.

use std::fmt::Write;

use crate::dispatchable::Dispatchable;
use crate::model::{Delay, EventId, Network};
use crate::stnu::NONE;
use crate::time::{Bound, Duration};

/// A delay STNU or a plain one.
///
/// `a -> b [l, u]` is a requirement `l <= b - a <= u`, `a => b [l, u]` a contingent link, `delay [min, max]` that of its
/// news. An event with several names is listed with all of them; names in parentheses are those no user wrote.
pub fn network(network: &Network) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "network {}, origin {}", network.name(), network.label(network.origin()));
    let _ = writeln!(text, "\nevents");
    for event in network.events() {
        let names = event.names.iter();
        let names: Vec<String> = names
            .map(|name| if name.internal { format!("({})", name.text) } else { name.text.clone() })
            .collect();
        let _ = writeln!(text, "  {}", names.join(" = "));
    }
    if !network.requirements().is_empty() {
        let _ = writeln!(text, "\nrequirements");
    }
    let arrow = |from: EventId, arrow: &str, to: EventId| {
        format!("  {} {arrow} {}", network.label(from), network.label(to))
    };
    for requirement in network.requirements() {
        let interval = interval(requirement.lower, requirement.upper);
        let _ = writeln!(text, "{} {interval}", arrow(requirement.from, "->", requirement.to));
    }
    if !network.contingents().is_empty() {
        let _ = writeln!(text, "\ncontingent links");
    }
    for link in network.contingents() {
        let bounds = interval(link.lower.into(), link.upper.into());
        let delay = match link.delay {
            Delay::NONE => String::new(),
            Delay { min, max } => format!(" delay {}", interval(min.into(), max)),
        };
        let _ = writeln!(text, "{} {bounds}{delay}", arrow(link.from, "=>", link.to));
    }
    text
}

fn counted(count: usize, thing: &str) -> String {
    if count == 1 { format!("1 {thing}") } else { format!("{count} {thing}s") }
}

fn interval(lower: Bound, upper: Bound) -> String {
    let bound = |bound: Bound, infinite: &str| bound.finite().map_or(infinite.to_string(), |b| b.to_string());
    format!("[{}, {}]", bound(lower, "-inf"), bound(upper, "inf"))
}

/// A dispatchable network: `x -> y w` says `y - x <= w`; `x waits for c until w after a` is a wait.
pub fn dispatchable(net: &Dispatchable, label: impl Fn(u32) -> String) -> String {
    let seconds = Duration::from_micros;
    let mut text = format!(
        "dispatchable network: {}, {}, {}, {}\n\nedges\n",
        counted(net.nodes as usize, "node"),
        counted(net.edges.len(), "edge"),
        counted(net.waits.len(), "wait"),
        counted(net.links.len(), "contingent link")
    );
    for edge in &net.edges {
        let _ = writeln!(text, "  {} -> {} {}", label(edge.from), label(edge.to), seconds(edge.weight));
    }
    if !net.waits.is_empty() {
        let _ = writeln!(text, "\nwaits");
    }
    for wait in &net.waits {
        let link = net.links[wait.link as usize];
        let _ = writeln!(
            text,
            "  {} waits for {}, until {} after {}",
            label(wait.waiter),
            label(link.contingent),
            seconds(-wait.weight),
            label(link.activation)
        );
    }
    let pairs = net.simultaneous.iter().enumerate().filter(|&(_, &leader)| leader != NONE);
    for (at, (node, &leader)) in pairs.enumerate() {
        if at == 0 {
            let _ = writeln!(text, "\nsimultaneous");
        }
        let _ = writeln!(text, "  {} with {}, right after it", label(node as u32), label(leader));
    }
    if !net.links.is_empty() {
        let _ = writeln!(text, "\ncontingent links");
    }
    for link in &net.links {
        let (lower, upper) = (seconds(link.lower), seconds(link.upper));
        let _ =
            writeln!(text, "  {} => {} [{lower}, {upper}]", label(link.activation), label(link.contingent));
    }
    text
}
