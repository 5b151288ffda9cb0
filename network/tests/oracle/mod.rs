//! The slow, plain judges the fast algorithms are tested against, and the random networks they are tested on.
//!
//! [`game`] plays the definition of controllability out, move by move, with delays and chains; only tiny networks can be
//! played. [`closure`] decides plain networks (no delays) of a few dozen events from the published rules. [`random`]
//! makes networks from seeds, prints them, and makes failing ones smaller. [`order`] says what must not come before what,
//! [`joined`] which events are one. None of them shares code with the library.

#![allow(dead_code, reason = "every test file that includes this module uses only some of it")]
#![allow(unreachable_pub, reason = "a module of a test is reachable from that test only")]

pub mod closure;
pub mod game;
pub mod joined;
pub mod order;
pub mod random;
