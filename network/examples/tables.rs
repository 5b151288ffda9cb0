//! Redoes tables 4.2 and 4.3 and the lambda series of C. Pittman's thesis (MIT, 2023, section 4.5).
//!
//! `cargo run --release -p kirk-network --example tables` takes the reading of the thesis that comes nearest to its
//! figures; `-- --readings` goes through the others. What came out is discussed in `docs/EXPERIMENTS.md`.

#![allow(clippy::print_stdout, reason = "an example prints")]

use kirk_network::assume::{Assumption, assume};
use kirk_network::controllability::is_controllable;
use kirk_network::generate::{Exponential, GenerateError, Lambda, Link, RepeaterOptions, repeaters};
use kirk_network::merge::merge;
use kirk_network::reduce::{ReduceError, reduce};
use kirk_network::stnu::TooLarge;
use kirk_network::{Bound, Duration, EventId, Network, Requirement};

const ROVERS: u32 = 4;
const REPEATERS: u32 = 5;
const NETWORKS: u64 = 1000;

type Error = Box<dyn std::error::Error>;

fn main() -> Result<(), Error> {
    if std::env::args().any(|argument| argument == "--readings") {
        return print_readings();
    }
    let reading = &Reading::NEAREST;
    let [mean, maximum, elongated] = [Assumption::Mean, Assumption::Maximum, Assumption::Elongated];
    let found = Counts::of(3.0, reading, &[Assumption::Minimum, mean, maximum, elongated])?;
    let strict = Counts::of(3.0, &Reading { strict: true, ..*reading }, &[mean, maximum])?;
    println!("{NETWORKS} networks of {ROVERS} rovers with {REPEATERS} repeaters each, lambda 3\n");
    println!("Table 4.2, controllable                thesis   kirk   kirk, strict");
    println!("  with variable delays                    222   {:4}", found.written);
    println!("  with minimum fixed delays               841   {:4}", found.assumed[0]);
    println!(
        "  with mean fixed delays                  805   {:4}   {:4}",
        found.assumed[1], strict.assumed[0]
    );
    println!(
        "  with maximum fixed delays               577   {:4}   {:4}",
        found.assumed[2], strict.assumed[1]
    );
    println!("Table 4.3, controllable");
    println!("  elongated                                36   {:4}", found.assumed[3]);
    println!("  elongated, but not as written             0   {:4}\n", found.only_assumed[3]);
    println!("False positives of maximum fixed delays, percent");
    for (lambda, thesis) in [(3.0, 45.6), (4.5, 27.9), (6.0, 12.9), (7.5, 7.0), (9.0, 3.1)] {
        let found = Counts::of(lambda, reading, &[maximum])?.false_positives(0);
        let strict =
            Counts::of(lambda, &Reading { strict: true, ..*reading }, &[maximum])?.false_positives(0);
        println!("  lambda {lambda:3}                             {thesis:5.1}  {found:5.1}  {strict:5.1}");
    }
    println!(
        "\nstrict: controllable, and no test has a fixed delay above the slack of the cleaning up plus the"
    );
    println!("longest duration of the test. That is not what the definition says; see docs/EXPERIMENTS.md.");
    Ok(())
}

fn print_readings() -> Result<(), Error> {
    println!(
        "reading                                        vdc  min mean  max  el | lambda 4.5    6  7.5    9"
    );
    println!(
        "thesis                                         222  841  805  577  36 |       27.9 12.9  7.0  3.1"
    );
    for (name, reading) in readings() {
        let fixed = [Assumption::Minimum, Assumption::Mean, Assumption::Maximum, Assumption::Elongated];
        let found = Counts::of(3.0, &reading, &fixed)?;
        let [minimum, mean, maximum, elongated] = found.assumed[..] else { continue };
        print!("{name:45} {:4} {minimum:4} {mean:4} {maximum:4} {elongated:3} |      ", found.written);
        for lambda in [4.5, 6.0, 7.5, 9.0] {
            let found = Counts::of(lambda, &reading, &[Assumption::Maximum])?;
            print!(" {:4.1}", found.false_positives(0));
        }
        println!();
    }
    Ok(())
}

/// How one may read what the thesis says of the family.
#[derive(Clone, Copy)]
struct Reading {
    lambda_is: Lambda,
    last_link: Link,
    clean_up_at_end: bool,
    /// For how many activities the consumables last, in all or for each rover.
    activities: u32,
    order: Order,
    /// Delays in whole seconds.
    whole: bool,
    /// Seconds after which a rover that waits for another must have started its test.
    patience: Option<i64>,
    /// Our guess at what else must hold under fixed delays.
    strict: bool,
}

/// Which confirmations wait for which.
#[derive(Clone, Copy, PartialEq)]
enum Order {
    /// Of every repeater, each rover for the one before.
    Every,
    /// The same, but not of the last repeater.
    NotLast,
    /// And the first rover for the last one, one repeater before.
    Round,
    /// None.
    Free,
}

impl Reading {
    const NEAREST: Reading = Reading {
        lambda_is: Lambda::Mean,
        last_link: Link::Requirement,
        clean_up_at_end: false,
        activities: REPEATERS + 1,
        order: Order::Every,
        whole: false,
        patience: None,
        strict: false,
    };
}

fn readings() -> Vec<(&'static str, Reading)> {
    let nearest = Reading::NEAREST;
    vec![
        ("nearest: consumables for 6 activities", nearest),
        ("  strict about fixed delays", Reading { strict: true, ..nearest }),
        ("  delays in whole seconds", Reading { whole: true, ..nearest }),
        ("  lambda is a rate", Reading { lambda_is: Lambda::Rate, ..nearest }),
        ("  D to A contingent", Reading { last_link: Link::Contingent, ..nearest }),
        ("  cleaning up at the end", Reading { clean_up_at_end: true, ..nearest }),
        ("  no order in the last round", Reading { order: Order::NotLast, ..nearest }),
        ("  order from round to round", Reading { order: Order::Round, ..nearest }),
        ("  no order between rovers", Reading { order: Order::Free, ..nearest }),
        ("  within 60 s of the rover before", Reading { patience: Some(60), ..nearest }),
        ("  within 30 s of the rover before", Reading { patience: Some(30), ..nearest }),
        ("consumables for 4 activities", Reading { activities: 4, ..nearest }),
        ("  no order between rovers", Reading { activities: 4, order: Order::Free, ..nearest }),
        ("consumables for 5 activities", Reading { activities: 5, ..nearest }),
        ("  no order in the last round", Reading { activities: 5, order: Order::NotLast, ..nearest }),
        ("  no order between rovers", Reading { activities: 5, order: Order::Free, ..nearest }),
        ("  D to A contingent", Reading { activities: 5, last_link: Link::Contingent, ..nearest }),
        ("consumables for 7 activities", Reading { activities: 7, ..nearest }),
        ("  cleaning up at the end", Reading { activities: 7, clean_up_at_end: true, ..nearest }),
        ("  order from round to round", Reading { activities: 7, order: Order::Round, ..nearest }),
        ("consumables for 20 activities", Reading { activities: 20, ..nearest }),
        ("  D to A contingent", Reading { activities: 20, last_link: Link::Contingent, ..nearest }),
        ("  order from round to round", Reading { activities: 20, order: Order::Round, ..nearest }),
        ("  within 60 s of the rover before", Reading { activities: 20, patience: Some(60), ..nearest }),
        ("  within 30 s of the rover before", Reading { activities: 20, patience: Some(30), ..nearest }),
    ]
}

/// How many networks are controllable.
struct Counts {
    written: u64,
    assumed: Vec<u64>,
    /// Under the assumption, but not as written.
    only_assumed: Vec<u64>,
}

impl Counts {
    fn of(lambda: f64, reading: &Reading, assumptions: &[Assumption]) -> Result<Counts, Error> {
        let none = vec![0; assumptions.len()];
        let mut counts = Counts { written: 0, assumed: none.clone(), only_assumed: none };
        for seed in 0..NETWORKS {
            let network = reading.network(lambda, seed)?;
            let written = controllable(&network)?;
            counts.written += u64::from(written);
            for (index, &assumption) in assumptions.iter().enumerate() {
                let assumed = assume(&network, assumption)?;
                let yes = controllable(&assumed)? && !(reading.strict && is_too_late_for_strict(&assumed));
                counts.assumed[index] += u64::from(yes);
                counts.only_assumed[index] += u64::from(yes && !written);
            }
        }
        Ok(counts)
    }

    /// Of the networks not controllable as written, those that are said to be, in percent.
    fn false_positives(&self, assumption: usize) -> f64 {
        100.0 * self.only_assumed[assumption] as f64 / (NETWORKS - self.written).max(1) as f64
    }
}

/// The verdict without its reasons.
fn controllable(network: &Network) -> Result<bool, TooLarge> {
    match reduce(&merge(network).network) {
        Ok(reduction) => is_controllable(&reduction.stnu),
        Err(ReduceError::Never(_)) => Ok(false),
        Err(ReduceError::TooLarge) => Err(TooLarge),
    }
}

/// True if a fixed delay is above the slack of what follows plus the longest duration of what is heard late.
fn is_too_late_for_strict(network: &Network) -> bool {
    network.contingents().iter().any(|link| {
        let slacks = network.requirements().iter().filter(|r| r.from == link.to).filter_map(|r| {
            Some(r.upper.finite()?.as_micros() - r.lower.finite()?.as_micros() + link.upper.as_micros())
        });
        let delay = link.delay.max.finite().map_or(0, Duration::as_micros);
        slacks.min().is_some_and(|slack| delay > slack)
    })
}

impl Reading {
    /// A network of the family as generated, with its requirements changed to the reading.
    fn network(&self, lambda: f64, seed: u64) -> Result<Network, Error> {
        let options = RepeaterOptions {
            delay: Exponential { lambda, lambda_is: self.lambda_is },
            last_link: self.last_link,
            clean_up_at_end: self.clean_up_at_end,
            spare: self.activities.saturating_sub(REPEATERS),
        };
        let network = repeaters(ROVERS, REPEATERS, seed, &options)?;
        let mut requirements = Vec::new();
        for requirement in network.requirements() {
            let mut requirement = *requirement;
            if requirement.from == network.origin()
                && let Some(limit) = requirement.upper.finite()
            {
                let made_for = i64::from(REPEATERS + options.spare);
                let micros = limit.as_micros() / made_for * i64::from(self.activities);
                requirement.upper = Duration::from_micros(micros).into();
            }
            if is_order(&network, &requirement) {
                let last = format!(".{REPEATERS}:end");
                let kept = match self.order {
                    Order::Every | Order::Round => true,
                    Order::NotLast => !network.id(requirement.from).ends_with(&last),
                    Order::Free => false,
                };
                if !kept {
                    continue;
                }
                if let Some(patience) = self.patience {
                    requirement.upper = Duration::from_secs(patience).into();
                }
            }
            requirements.push(requirement);
        }
        if self.order == Order::Round {
            for task in 1..REPEATERS {
                let from = event(&network, &format!("test.{ROVERS}.{task}:end"))?;
                let to = event(&network, &format!("test.1.{}:start", task + 1))?;
                let (lower, upper) = (Bound::Finite(Duration::ZERO), Bound::Infinite);
                requirements.push(Requirement { from, to, lower, upper });
            }
        }
        let mut contingents = network.contingents().to_vec();
        for link in contingents.iter_mut().filter(|_| self.whole) {
            let seconds = link.delay.max.finite().map_or(0, |max| (max.as_micros() + 500_000) / 1_000_000);
            link.delay.max = Duration::from_secs(seconds).into();
        }
        let events = network.events().to_vec();
        Network::new(network.name().to_string(), network.origin(), events, requirements, contingents)
            .map_err(|errors| format!("{errors:?}").into())
    }
}

/// True if the requirement makes one rover wait for another: from the end of a test to the start of one.
fn is_order(network: &Network, requirement: &Requirement) -> bool {
    let (from, to) = (network.id(requirement.from), network.id(requirement.to));
    from.starts_with("test.") && to.starts_with("test.")
}

fn event(network: &Network, name: &str) -> Result<EventId, GenerateError> {
    network.find(name).ok_or(GenerateError::NoTasks)
}
