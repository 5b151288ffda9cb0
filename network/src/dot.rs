//! Draws networks in the language of Graphviz: `kirk compile FILE --emit stnu --format dot | dot -Tsvg`.
//!
//! Ours are solid circles, Nature's dashed ones, the origin is doubled. A contingent link is a double line with the
//! bounds of its duration and, below, those of its delay; a requirement a single line with its bounds; a wait a dashed
//! line. The same network gives the same text.

use std::fmt::Write;

use crate::dispatchable::Dispatchable;
use crate::model::{Delay, Network};
use crate::stnu::NONE;
use crate::time::{Bound, Duration};

/// Draws a delay STNU: events with the names users wrote, requirements, contingent links with their delays.
pub fn network(network: &Network) -> String {
    let mut out = header(network.name());
    for event in network.event_ids() {
        let names: Vec<&str> = network.events()[event.index()].shown_names().collect();
        let style = node_style(event == network.origin(), network.link_of(event).is_some());
        line(&mut out, format_args!("n{} [label=\"{}\"{style}]", event.0, label(&names)));
    }
    for requirement in network.requirements() {
        let (from, to) = (requirement.from.0, requirement.to.0);
        let bounds = interval(requirement.lower, requirement.upper);
        line(&mut out, format_args!("n{from} -> n{to} [label=\"{bounds}\"]"));
    }
    for link in network.contingents() {
        let (from, to) = (link.from.0, link.to.0);
        let mut text = interval(Bound::Finite(link.lower), Bound::Finite(link.upper));
        if link.delay != Delay::NONE {
            let delay = interval(Bound::Finite(link.delay.min), link.delay.max);
            text.push_str("\\nheard after ");
            text.push_str(&delay);
        }
        line(&mut out, format_args!("n{from} -> n{to} [label=\"{text}\"{CONTINGENT}]"));
    }
    out.push_str("}\n");
    out
}

/// Draws a dispatchable network, naming its nodes: ordinary edges with their weights, waits with `C:weight`, and the
/// contingent links.
pub fn dispatchable(dispatchable: &Dispatchable, name: impl Fn(u32) -> String) -> String {
    let mut out = header("dispatchable");
    let mut link_ending_at = vec![NONE; dispatchable.nodes as usize];
    for (index, link) in dispatchable.links.iter().enumerate() {
        link_ending_at[link.contingent as usize] = index as u32;
    }
    let seconds = Duration::from_micros;
    for node in 0..dispatchable.nodes {
        let style = node_style(node == 0, link_ending_at[node as usize] != NONE);
        line(&mut out, format_args!("n{node} [label=\"{}\"{style}]", label(&[&name(node)])));
    }
    for edge in &dispatchable.edges {
        let weight = seconds(edge.weight);
        line(&mut out, format_args!("n{} -> n{} [label=\"{weight}\"]", edge.from, edge.to));
    }
    for wait in &dispatchable.waits {
        let link = dispatchable.links[wait.link as usize];
        let text = format!("{}:{}", label(&[&name(link.contingent)]), seconds(wait.weight));
        line(
            &mut out,
            format_args!("n{} -> n{} [label=\"{text}\", style=dashed]", wait.waiter, link.activation),
        );
    }
    for link in &dispatchable.links {
        let bounds = interval(Bound::Finite(seconds(link.lower)), Bound::Finite(seconds(link.upper)));
        line(
            &mut out,
            format_args!("n{} -> n{} [label=\"{bounds}\"{CONTINGENT}]", link.activation, link.contingent),
        );
    }
    out.push_str("}\n");
    out
}

const CONTINGENT: &str = ", color=\"black:invis:black\", style=bold";

fn header(title: &str) -> String {
    format!(
        "digraph \"{}\" {{\n  rankdir=LR\n  node [shape=ellipse, fontname=\"sans-serif\"]\n  \
         edge [fontname=\"sans-serif\", fontsize=11]\n",
        label(&[title])
    )
}

fn line(out: &mut String, statement: std::fmt::Arguments<'_>) {
    writeln!(out, "  {statement}").unwrap_or_else(|_| unreachable!("a string takes whatever is written"));
}

fn node_style(origin: bool, contingent: bool) -> &'static str {
    match (origin, contingent) {
        (true, _) => ", peripheries=2",
        (false, true) => ", style=dashed",
        (false, false) => "",
    }
}

fn interval(lower: Bound, upper: Bound) -> String {
    let lower = lower.finite().map_or("(-∞".to_string(), |lower| format!("[{lower}"));
    let upper = upper.finite().map_or("∞)".to_string(), |upper| format!("{upper}]"));
    format!("{lower}, {upper}")
}

/// Names one below the other, for a quoted string: Graphviz reads quotes, backslashes and XML entities in one.
fn label(names: &[&str]) -> String {
    let mut out = String::new();
    for (index, name) in names.iter().enumerate() {
        if index > 0 {
            out.push_str("\\n");
        }
        for char in name.chars() {
            match char {
                '"' => out.push_str("\\\""),
                '\\' => out.push_str("\\\\"),
                '&' => out.push_str("&amp;"),
                char if char.is_control() => out.extend(char.escape_default().flat_map(|char| {
                    // The backslash of the escape is shown as such.
                    std::iter::repeat_n(char, if char == '\\' { 2 } else { 1 })
                })),
                char => out.push(char),
            }
        }
    }
    out
}
