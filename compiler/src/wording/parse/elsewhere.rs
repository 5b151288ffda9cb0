//! What is said about words of Lisp and other languages.

use crate::parse::Instead;
use crate::words::usage;

impl Instead {
    /// What to write in the place of such a word.
    pub(crate) fn help(self) -> &'static str {
        match self {
            Instead::Dotimes => "To do something several times, write `(dotimes (i 3) body...)`.",
            Instead::Unrolled => {
                "How often something is done has to be known before the mission starts: `(dotimes (i 3) body...)`."
            }
            Instead::Entries => {
                "A mission has no choices: everything in it is done. Write a program for each case, and start one with `--entry`."
            }
            Instead::Sequence => "To do one thing after the other, write `(sequence (:slack t) ...)`.",
            Instead::Parallel => "To do things at the same time, write `(parallel (:slack t) ...)`.",
            Instead::Order => {
                "Kirk orders nothing by itself: say what comes first, by a `(sequence (:slack t) ...)` or by `(between (end a) (start b) (simple-temporal :lower-bound 0))`."
            }
            Instead::Bound => {
                "Every constraint has to hold; kirk weighs nothing against anything. Leave it out, or make it a bound."
            }
            Instead::Delay => "To let time pass, write `(delay 5 10)`: 5 to 10 s.",
            Instead::Constraint => {
                "Bounds are put around what they limit: `(with-temporal-constraint (simple-temporal :upper-bound 60) ...)`."
            }
            Instead::Let => "To name a number, write `(let ((x 5)) ...)`.",
            Instead::NoLisp => "A body only says what is done when; kirk runs no Lisp.",
            Instead::Between => {
                "An event is no activity; it is named in a constraint: `(between (end a) (start b) (simple-temporal :lower-bound 5))`."
            }
            Instead::Declare => "This is a declaration: it belongs into the `(declare ...)` of the program.",
            Instead::Program | Instead::ControlProgram => {
                "A program is `(define-control-program name (parameter...) body...)`; functions and macros of Lisp are not run."
            }
            Instead::Defparameter | Instead::NamedNumber => const { usage("defparameter") },
            Instead::Defclass => const { usage("defclass") },
            Instead::Defpackage => {
                "What a package uses is said where it is defined: `(defpackage #:name (:use #:other))`."
            }
            Instead::CommandLine => {
                "Kirk loads nothing: give all the files on one command line, and take this out."
            }
            Instead::Nothing | Instead::NothingAround => "Kirk runs no Lisp: take this out.",
        }
    }
}
