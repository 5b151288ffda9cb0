//! One mission, several executives: what each agent of a team executes, and why that is enough.
//!
//! The network of the whole team, an owner of each event and the links between the agents go in; a view for each agent comes out, and
//! the promises by which the views fit together.
//!
//! ```
//! use kirk_network::{Bound, Delay, Duration, json};
//! use kirk_team::{Link, Options, Team, Verdict, find};
//!
//! // The robot drills when the astronaut's downlink has ended; the news of that takes 5 to 15 s.
//! let network = json::read(
//!     r#"{"format": "kirk-network/1", "origin": "start", "events": ["start", "downlinked", "drill"],
//!         "requirements": [{"from": "downlinked", "to": "drill", "lower": 0, "upper": 20}],
//!         "contingents": [{"from": "start", "to": "downlinked", "lower": 15, "upper": 30}]}"#,
//! )
//! .expect("a valid network");
//! let seconds = Duration::from_secs;
//! let delay = Delay { min: seconds(5), max: Bound::Finite(seconds(15)) };
//! let (astronaut, robot) = ("astronaut".to_string(), "robot".to_string());
//! let link = Link { from: astronaut.clone(), to: robot.clone(), delay, one_way: false, stamped: false };
//! let owners = [None, Some(astronaut.clone()), Some(robot.clone())];
//! let team = Team::new(network, vec![astronaut, robot], vec![link], &owners).expect("a valid team");
//! let Ok(Verdict::Yes(agreement)) = find(&team, &Options::default()) else { panic!("there is a way") };
//! assert!(agreement.promises.is_empty()); // nobody but the robot needs to know when it drills
//! assert_eq!(agreement.views[1].network.contingents()[0].delay, delay);
//! ```
//!
//! # The way through
//!
//! | step | module | from | to |
//! | --- | --- | --- | --- |
//! | take over | [`mission`] | a compiled mission | a team, and its verdict in the source |
//! | validate | [`model`] | network, owners, links | [`Team`], or everything that is wrong |
//! | reach | [`reach`] | links | how late news of one agent reaches another |
//! | make ready | `whole` | team | one network: joins of one owner made one, joints of nobody composed away |
//! | share out | `views` | whole, and what promises are measured from | views without numbers |
//! | find | `search`, `cuts` | views | promises such that all views are controllable |
//! | execute | [`Ready`] | views, Nature, the weather on the links | when each event happened, and who heard of it when |
//! | record | [`mod@record`] | what happened | `kirk-team-execution/1`, for programs and the verifier |
//! | verify | [`verify()`] | what happened | what of the team's network did not hold |
//!
//! # Words
//!
//! An agent *owns* the events it executes, or is the first to observe. Its *view* is the network it executes. A *promise* says when
//! an event will have been executed, measured from its *base*; it is a requirement in the view of its owner and a contingent link in
//! the views of all who count on it.
//!
//! # Invariants
//!
//! - An executable event in a view is the agent's own.
//! - What is promised is never in the end measured from itself, over all views together.
//! - [0, 0] makes events one within one owner only, or with the origin.
//! - A "yes" rests on a check of every view; the same team gives the same promises.

pub mod mission;
pub mod model;
pub mod reach;
pub mod record;
#[doc(hidden)]
pub mod rules;

mod cuts;
mod distances;
mod find;
mod promise;
mod search;
mod shortage;
mod simulate;
mod verify;
mod views;
mod weather;
mod whole;
mod wording;

pub use find::{Agreement, Options, Verdict, View, find};
pub use mission::Mission;
pub use model::{AgentId, Link, Place, Team, TeamError};
pub use promise::Promise;
pub use record::Record;
pub use rules::Rules;
pub use shortage::{Cause, Change, Member, NotFound, Remedy, remedies};
pub use simulate::{Ready, Simulation, TeamExecution, Trouble};
pub use verify::{Late, Violation, late_news, verify, verify_truth};
pub use weather::{Mood, Partition, Weather};
