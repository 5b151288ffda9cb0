//! Elongated links: what happens and when its news comes as one uncertainty (thesis, table 4.3).
//!
//! Each contingent event whose news is sure to come is replaced by its news, at the end of a link [l + g-, u + g+] with
//! no delay; the event itself is *placed* between g+ and g- before. A requirement `t_j - t_i <= w` must hold wherever
//! the two are: `news_j - news_i <= w + g-_j - g+_i`. A link that starts at a contingent event p is measured from the
//! news of p, [l - g+(p) + g-, u - g-(p) + g+]; where that could be negative, from the event before p.

use std::collections::BTreeMap;

use crate::conflict::{Conflict, Part, Share};
use crate::model::{ContingentLink, Delay, EventId, Network, Requirement};
use crate::stnu::{TooLarge, add};
use crate::time::{Bound, Duration};
use crate::trees::{Trees, link_index, link_to};

/// Elongates the links of a merged network.
pub(super) fn elongate(network: &Network) -> Result<Elongated, TooLarge> {
    let trees = Trees::new(network)?;
    let mut bases: Vec<EventId> = network.event_ids().collect();
    let mut links = network.contingents().to_vec();
    for &event in &trees.parents_first {
        let index = link_index(network, event);
        let news = news(network, event);
        let mut base = links[index].from;
        let mut window = Window::new(network, base, event)?;
        while add(window.lower, news.min)? < 0 {
            base = bases[base.index()];
            window = Window::new(network, base, event)?;
        }
        bases[event.index()] = base;
        links[index] = ContingentLink {
            from: base,
            to: event,
            lower: Duration::from_micros(add(window.lower, news.min)?),
            upper: Duration::from_micros(add(window.upper, news.max)?),
            delay: match links[index].delay.max {
                Bound::Finite(_) => Delay::NONE,
                Bound::Infinite => links[index].delay,
            },
        };
    }
    let mut requirements = Vec::new();
    let mut sides = Vec::new();
    for (index, requirement) in network.requirements().iter().enumerate() {
        let parts = [Part::RequirementUpper(index), Part::RequirementLower(index)];
        for (part, edge) in parts.into_iter().zip(requirement.edges()) {
            let Some((from, to, weight)) = edge else { continue };
            let weight = weight.as_micros();
            let nature = trees.nature_alone(network, from, to)?;
            if nature.is_some_and(|worst| worst <= weight) {
                continue;
            }
            let weight = add(add(weight, news(network, to).min)?, -news(network, from).max)?;
            let upper = Bound::Finite(Duration::from_micros(weight));
            requirements.push(Requirement { from, to, lower: Bound::Infinite, upper });
            sides.push(Side { part, from, to });
        }
    }
    let elongated = network
        .with(requirements, links)
        .unwrap_or_else(|errors| unreachable!("an elongated network is valid: {errors:?}"));
    Ok(Elongated { network: elongated, sides })
}

/// A network with elongated links over the same events, its links in the same order, and what it was made of.
pub(super) struct Elongated {
    pub(super) network: Network,
    /// What each requirement was.
    sides: Vec<Side>,
}

/// One side of a requirement: `to - from <= weight`.
struct Side {
    part: Part,
    from: EventId,
    to: EventId,
}

/// From when until when news comes after its event, in microseconds. None for executable events and for news that
/// may never come: those are placed where they are.
#[derive(Clone, Copy, Default)]
struct News {
    min: i64,
    max: i64,
}

fn news(network: &Network, event: EventId) -> News {
    match network.link_of(event).map(|link| network.contingents()[link].delay) {
        Some(Delay { min, max: Bound::Finite(max) }) => News { min: min.as_micros(), max: max.as_micros() },
        _ => News::default(),
    }
}

/// Where an event is after the news of its ancestor `base`.
struct Window {
    lower: i64,
    upper: i64,
}

impl Window {
    fn new(network: &Network, base: EventId, event: EventId) -> Result<Window, TooLarge> {
        let News { min, max } = news(network, base);
        let mut window = Window { lower: -max, upper: -min };
        let mut at = event;
        while at != base {
            let link = link_to(network, at);
            window.lower = add(window.lower, link.lower.as_micros())?;
            window.upper = add(window.upper, link.upper.as_micros())?;
            at = link.from;
        }
        Ok(window)
    }
}

impl Elongated {
    /// A conflict of the elongated network in terms of the bounds of the one it was made of, `network`.
    pub(super) fn conflict(&self, network: &Network, conflict: &Conflict) -> Conflict {
        let mut times: BTreeMap<Part, u32> = BTreeMap::new();
        for share in &conflict.members {
            let mut add = |part| {
                let sum: &mut u32 = times.entry(part).or_default();
                *sum = sum.saturating_add(share.times);
            };
            let mut delay = |event: EventId, part: fn(usize) -> Part| {
                let heard = |&index: &usize| network.contingents()[index].delay.max != Bound::Infinite;
                if let Some(index) = network.link_of(event).filter(heard) {
                    add(part(index));
                }
            };
            match share.part {
                Part::RequirementUpper(index) | Part::RequirementLower(index) => {
                    let side = &self.sides[index];
                    delay(side.to, Part::DelayMin);
                    delay(side.from, Part::DelayMax);
                    add(side.part);
                }
                Part::LinkLower(index) => {
                    let ContingentLink { from, to, .. } = self.network.contingents()[index];
                    delay(to, Part::DelayMin);
                    delay(from, Part::DelayMax);
                    path(network, from, to).for_each(|index| add(Part::LinkLower(index)));
                }
                Part::LinkUpper(index) => {
                    let ContingentLink { from, to, .. } = self.network.contingents()[index];
                    delay(to, Part::DelayMax);
                    delay(from, Part::DelayMin);
                    path(network, from, to).for_each(|index| add(Part::LinkUpper(index)));
                }
                part => add(part),
            }
        }
        let members = times.into_iter().filter_map(|(part, times)| {
            let bound = part.signed(network).as_micros();
            // News at once is nobody's fault.
            let delay = matches!(part, Part::DelayMin(_) | Part::DelayMax(_));
            let amount = i64::from(times).saturating_mul(bound);
            (!delay || bound != 0).then_some(Share { part, times, amount: Duration::from_micros(amount) })
        });
        Conflict { members: members.collect(), ..*conflict }
    }
}

/// The links on the way from `above` down to `below`.
fn path(network: &Network, above: EventId, below: EventId) -> impl Iterator<Item = usize> {
    let parent = move |&event: &EventId| Some(link_to(network, event).from).filter(|&from| from != above);
    std::iter::successors(Some(below), parent).map(|event| link_index(network, event))
}
