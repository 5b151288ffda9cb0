//! Slips: what people write in the place of the right shape. What is wrong with it is found out, and what was meant is
//! guessed as far as that is clear, so that one slip costs one message.
//!
//! A form of the right shape never comes here: the grammar is in `parse/`, and this could be left out of it.

pub(super) mod amount;
pub(super) mod binding;
pub(super) mod body;
pub(super) mod declaration;
pub(super) mod definition;
pub(super) mod elsewhere;
pub(super) mod label;
pub(super) mod options;
