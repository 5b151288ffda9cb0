//! Redoes tables 4.2 and 4.3 and the lambda series of C. Pittman's thesis (MIT, 2023, section 4.5).
//!
//! `cargo run --release -p kirk-network --example tables` takes the reading of the thesis that gives its figures;
//! `-- --readings` goes through the others, `-- --networks 10000` takes more of them. What came out is discussed in `docs/EXPERIMENTS.md`.

#![allow(clippy::print_stdout, reason = "an example prints")]

use kirk_network::assume::{Assumption, assume};
use kirk_network::controllability::is_controllable;
use kirk_network::generate::{Bounds, Exponential, GenerateError, Lambda, Link, RepeaterOptions, repeaters};
use kirk_network::merge::merge;
use kirk_network::reduce::{ReduceError, reduce};
use kirk_network::stnu::TooLarge;
use kirk_network::{Bound, Duration, EventId, Network, Requirement};

const ROVERS: u32 = 4;
const REPEATERS: u32 = 5;
const USUAL_NETWORKS: u64 = 1000;

type Error = Box<dyn std::error::Error>;

fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().collect();
    let networks = match arguments.iter().position(|argument| argument == "--networks") {
        None => USUAL_NETWORKS,
        Some(at) => arguments.get(at + 1).ok_or("--networks takes a number")?.parse()?,
    };
    if arguments.iter().any(|argument| argument == "--readings") {
        return print_readings(networks);
    }
    let reading = &Reading::NEAREST;
    let fixed = [Assumption::Minimum, Assumption::Mean, Assumption::Maximum, Assumption::Elongated];
    let found = Counts::of(networks, 3.0, reading, &fixed)?;
    println!("{networks} networks of {ROVERS} rovers with {REPEATERS} repeaters each, lambda 3\n");
    println!("Table 4.2, controllable                thesis   kirk   not as written");
    println!("  with variable delays                    222   {:4}", found.written);
    let rows = [
        ("  with minimum fixed delays               841", 0),
        ("  with mean fixed delays                  805", 1),
        ("  with maximum fixed delays               577", 2),
        ("Table 4.3, controllable\n  elongated                                36", 3),
    ];
    for (row, index) in rows {
        println!("{row}   {:4}   {:4}", found.assumed[index], found.only_assumed[index]);
    }
    println!("\nFalse positives of maximum fixed delays, percent");
    for (lambda, thesis) in [(3.0, 45.6), (4.5, 27.9), (6.0, 12.9), (7.5, 7.0), (9.0, 3.1)] {
        let found = Counts::of(networks, lambda, reading, &[Assumption::Maximum])?.false_positives(0);
        println!("  lambda {lambda:3}                             {thesis:5.1}  {found:5.1}");
    }
    Ok(())
}

fn print_readings(networks: u64) -> Result<(), Error> {
    println!(
        "reading                                        vdc  min mean  max  el | lambda 4.5    6  7.5    9"
    );
    println!(
        "thesis                                         222  841  805  577  36 |       27.9 12.9  7.0  3.1"
    );
    for (name, reading) in readings() {
        let fixed = [Assumption::Minimum, Assumption::Mean, Assumption::Maximum, Assumption::Elongated];
        let found = Counts::of(networks, 3.0, &reading, &fixed)?;
        let [minimum, mean, maximum, elongated] = found.assumed[..] else { continue };
        print!("{name:45} {:4} {minimum:4} {mean:4} {maximum:4} {elongated:3} |      ", found.written);
        for lambda in [4.5, 6.0, 7.5, 9.0] {
            let found = Counts::of(networks, lambda, &reading, &[Assumption::Maximum])?;
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
    bounds: Bounds,
    order: Order,
    /// Delays in whole seconds.
    whole: bool,
    /// Seconds after which a rover that waits for another must have started its test.
    patience: Option<i64>,
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
        activities: REPEATERS,
        bounds: Bounds::Tables,
        order: Order::Every,
        whole: false,
        patience: None,
    };
}

fn readings() -> Vec<(&'static str, Reading)> {
    let nearest = Reading::NEAREST;
    let text = Reading { bounds: Bounds::Text, ..nearest };
    vec![
        ("bounds of the tables", nearest),
        ("  delays in whole seconds", Reading { whole: true, ..nearest }),
        ("  lambda is a rate", Reading { lambda_is: Lambda::Rate, ..nearest }),
        ("  D to A contingent", Reading { last_link: Link::Contingent, ..nearest }),
        ("  cleaning up at the end", Reading { clean_up_at_end: true, ..nearest }),
        ("  no order in the last round", Reading { order: Order::NotLast, ..nearest }),
        ("  order from round to round", Reading { order: Order::Round, ..nearest }),
        ("  no order between rovers", Reading { order: Order::Free, ..nearest }),
        ("  within 60 s of the rover before", Reading { patience: Some(60), ..nearest }),
        ("  consumables for 4 activities", Reading { activities: 4, ..nearest }),
        ("  consumables for 6 activities", Reading { activities: 6, ..nearest }),
        ("  consumables for 20 activities", Reading { activities: 20, ..nearest }),
        ("bounds of the text", text),
        ("  lambda is a rate", Reading { lambda_is: Lambda::Rate, ..text }),
        ("  D to A contingent", Reading { last_link: Link::Contingent, ..text }),
        ("  cleaning up at the end", Reading { clean_up_at_end: true, ..text }),
        ("  no order in the last round", Reading { order: Order::NotLast, ..text }),
        ("  no order between rovers", Reading { order: Order::Free, ..text }),
        ("  consumables for 6 activities", Reading { activities: 6, ..text }),
        ("    cleaning up at the end", Reading { activities: 6, clean_up_at_end: true, ..text }),
        ("    D to A contingent", Reading { activities: 6, last_link: Link::Contingent, ..text }),
        ("    within 60 s of the rover before", Reading { activities: 6, patience: Some(60), ..text }),
        ("  consumables for 7 activities", Reading { activities: 7, ..text }),
        ("  consumables for 20 activities", Reading { activities: 20, ..text }),
        ("    D to A contingent", Reading { activities: 20, last_link: Link::Contingent, ..text }),
    ]
}

/// How many networks are controllable.
struct Counts {
    networks: u64,
    written: u64,
    assumed: Vec<u64>,
    /// Under the assumption, but not as written.
    only_assumed: Vec<u64>,
}

impl Counts {
    fn of(
        networks: u64,
        lambda: f64,
        reading: &Reading,
        assumptions: &[Assumption],
    ) -> Result<Counts, Error> {
        let none = vec![0; assumptions.len()];
        let mut counts = Counts { networks, written: 0, assumed: none.clone(), only_assumed: none };
        for seed in 0..networks {
            let network = reading.network(lambda, seed)?;
            let written = controllable(&network)?;
            counts.written += u64::from(written);
            for (index, &assumption) in assumptions.iter().enumerate() {
                let yes = controllable(&assume(&network, assumption)?)?;
                counts.assumed[index] += u64::from(yes);
                counts.only_assumed[index] += u64::from(yes && !written);
            }
        }
        Ok(counts)
    }

    /// Of the networks not controllable as written, those that are said to be, in percent.
    fn false_positives(&self, assumption: usize) -> f64 {
        100.0 * self.only_assumed[assumption] as f64 / (self.networks - self.written).max(1) as f64
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

impl Reading {
    /// A network of the family as generated, with its requirements changed to the reading.
    fn network(&self, lambda: f64, seed: u64) -> Result<Network, Error> {
        let options = RepeaterOptions {
            delay: Exponential { lambda, lambda_is: self.lambda_is },
            last_link: self.last_link,
            clean_up_at_end: self.clean_up_at_end,
            spare: self.activities.saturating_sub(REPEATERS),
            bounds: self.bounds,
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
