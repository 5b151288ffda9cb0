//! The words of messages, and nothing else: each phase reports a problem as what it knows (`problem.rs` next to it), and here
//! it becomes a diagnostic, with its code, its sentences and the changes that put it right.

mod analyse;
mod evaluate;
mod expand;
mod read;
