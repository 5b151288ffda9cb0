//! The verdict on a team: views and promises with which it is sure to succeed, or why there are none.
//!
//! If every view is controllable and every agent executes its own, every requirement of the team is kept, whatever Nature and the
//! links do within their bounds: a promise is kept by its owner as one more requirement, and whoever counts on it treats it as
//! Nature's. As what is promised is never in the end measured from itself, neither waits for the other.

use kirk_network::stnu::TooLarge;
use kirk_network::{Conflict, Duration, Network};
use kirk_runtime::Strategy;

use crate::model::{AgentId, Team};
use crate::promise::Promise;
use crate::rules::Rules;
use crate::search::{Attempt, Finder};
use crate::shortage::{NotFound, shortage};
use crate::simulate::{Ready, Simulation};
use crate::weather::{Mood, Weather};
use crate::whole::Whole;

/// How to look for promises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// An agent keeps this much of each promise in reserve, as clocks are late: it is done so much earlier than it says.
    pub tolerance: Duration,
    /// So many rounds of checks at most with promises of the same events, or twice as many as there are promises.
    pub rounds: usize,
    /// So many ways at most to choose what promises are measured from and who keeps what.
    pub choices: usize,
    /// Whether to look for promises with which the team is done sooner, once there are some that are measured from what each agent
    /// waits for: such as from the origin, and such that begin as early as others can bear.
    pub soonest: bool,
    #[doc(hidden)]
    pub rules: Rules,
}

impl Default for Options {
    fn default() -> Options {
        Options { tolerance: Duration::ZERO, rounds: 40, choices: 60, soonest: true, rules: Rules::ALL }
    }
}

/// The answer of [`find`].
#[derive(Clone, Debug)]
pub enum Verdict {
    /// With these promises each agent can be left to its own view.
    Yes(Agreement),
    /// Not even if all knew everything at once. The conflict is in terms of the team's network.
    No(Conflict),
    /// There may be a way, but none of promises was found.
    NotFound(NotFound),
}

/// What the agents of a team have agreed on.
#[derive(Clone, Debug)]
pub struct Agreement {
    /// The network of the team with the joins of one owner made one, of which the promises speak.
    pub network: Network,
    /// By event of the network.
    pub promises: Vec<Promise>,
    /// One view for each agent, in order.
    pub views: Vec<View>,
}

/// What one agent executes: a network whose executable events are its own. Events have the names they have in the team.
#[derive(Clone, Debug)]
pub struct View {
    /// Whose it is.
    pub agent: AgentId,
    /// What it knows of.
    pub network: Network,
}

/// Looks for views and promises.
///
/// A "yes" is proven, and so is a "no"; what is not found may exist all the same.
///
/// # Errors
/// [`TooLarge`] if the durations add up to more than 64-bit microseconds can hold.
pub fn find(team: &Team, options: &Options) -> Result<Verdict, TooLarge> {
    let whole = Whole::new(team);
    let conflict = whole.conflict(team.network())?;
    if let Some(conflict) = conflict.filter(|conflict| !conflict.conservative || !whole.nature_is_kind()) {
        return Ok(Verdict::No(conflict));
    }
    let mut finder = Finder::new(team, &whole, options);
    Ok(match finder.search()? {
        Attempt::Found(found) => {
            let agreements = found.iter().map(|found| finder.agreement(found)).collect();
            Verdict::Yes(soonest(team, agreements))
        }
        Attempt::Failed(failure) => Verdict::NotFound(shortage(&finder, &failure)),
    })
}

/// The agreement with which the team is done soonest: once if all takes as long as it may, and on two days like any other.
fn soonest(team: &Team, mut agreements: Vec<Agreement>) -> Agreement {
    let ends = |agreement: &Agreement| -> i64 {
        let Ok(ready) = Ready::new(team, agreement) else { return i64::MAX };
        let day = |(seed, mood): (u64, Mood)| {
            let weather = Weather { delays: mood, ..Weather::default() };
            let simulation = Simulation {
                strategy: Strategy::Buffer,
                nature: mood,
                weather,
                seed,
                ..Simulation::default()
            };
            ready.run(&simulation).makespan.as_micros()
        };
        [(0, Mood::Longest), (1, Mood::Random), (2, Mood::Random)].into_iter().map(day).sum()
    };
    let at = match agreements.len() {
        1 => 0,
        _ => (0..agreements.len()).min_by_key(|&at| ends(&agreements[at])).unwrap_or(0),
    };
    agreements.swap_remove(at)
}

/// True if promises are found.
pub(crate) fn is_found(team: &Team, options: &Options) -> Result<bool, TooLarge> {
    let whole = Whole::new(team);
    if whole
        .conflict(team.network())?
        .is_some_and(|conflict| !conflict.conservative || !whole.nature_is_kind())
    {
        return Ok(false);
    }
    Ok(matches!(Finder::new(team, &whole, options).search()?, Attempt::Found(_)))
}
