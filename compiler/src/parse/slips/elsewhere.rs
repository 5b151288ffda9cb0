//! Words people bring along from Lisp and other languages, and what RMPL has in their place.

use super::head;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::Form;
use crate::words::usage;

/// What there is in the place of a word of another language.
#[derive(Clone, Copy)]
pub(crate) struct Instead {
    /// What to write.
    pub(crate) help: &'static str,
    /// What puts it right, if that is certain.
    cure: Cure,
}

#[derive(Clone, Copy)]
enum Cure {
    /// This in the place of the word.
    Write(&'static str),
    /// Nothing in the place of the form.
    TakeOut,
    /// That is for the writer to say.
    Unknown,
}

impl Instead {
    /// The problem of a form that begins with the word, with the way out.
    pub(super) fn told(self, problem: Diagnostic, form: &Form) -> Diagnostic {
        let problem = problem.help(self.help);
        match self.cure {
            Cure::Write(text) => problem.change(head(form), text),
            Cure::TakeOut => problem.suggest("Take it out", [Edit::replace(form.span, "")]),
            Cure::Unknown => problem,
        }
    }

    /// What to write in the place of the word, if that is certain.
    pub(crate) fn word(self) -> Option<&'static str> {
        match self.cure {
            Cure::Write(text) => Some(text),
            Cure::TakeOut | Cure::Unknown => None,
        }
    }
}

/// What there is in the place of a form of this name in a body.
pub(crate) fn instead_of_operator(word: &str) -> Option<Instead> {
    let (help, cure) = match word {
        "loop" | "repeat" | "for" | "foreach" | "do" | "do*" | "dolist" | "times" => {
            ("To do something several times, write `(dotimes (i 3) body...)`.", Cure::Unknown)
        }
        "while" | "until" => (
            "How often something is done has to be known before the mission starts: `(dotimes (i 3) body...)`.",
            Cure::Unknown,
        ),
        "if" | "when" | "unless" | "cond" | "case" | "choose" | "either" | "optional" | "maybe" | "try" => (
            "A mission has no choices: everything in it is done. Write a program for each case, and start one with `--entry`.",
            Cure::Unknown,
        ),
        "progn" | "prog1" | "begin" | "block" | "serial" | "seq" | "then" => (
            "To do one thing after the other, write `(sequence (:slack t) ...)`.",
            Cure::Write("sequence (:slack t)"),
        ),
        "par" | "concurrently" | "fork" | "both" | "all" => (
            "To do things at the same time, write `(parallel (:slack t) ...)`.",
            Cure::Write("parallel (:slack t)"),
        ),
        "mutex" | "lock" | "critical" | "exclusive" | "resource" | "semaphore" => (
            "Kirk orders nothing by itself: say what comes first, by a `(sequence (:slack t) ...)` or by `(between (end a) (start b) (simple-temporal :lower-bound 0))`.",
            Cure::Unknown,
        ),
        "prefer" | "soft" | "priority" | "cost" | "minimize" | "maximize" => (
            "Every constraint has to hold; kirk weighs nothing against anything. Leave it out, or make it a bound.",
            Cure::Unknown,
        ),
        "wait" | "sleep" | "pause" => {
            ("To let time pass, write `(delay 5 10)`: 5 to 10 s.", Cure::Write("delay"))
        }
        "simple-temporal" | "simple" | "within" | "deadline" | "timeout" => (
            "Bounds are put around what they limit: `(with-temporal-constraint (simple-temporal :upper-bound 60) ...)`.",
            Cure::Unknown,
        ),
        "setq" | "setf" | "defparameter" | "flet" => {
            ("To name a number, write `(let ((x 5)) ...)`.", Cure::Unknown)
        }
        "lambda" | "funcall" | "apply" | "format" | "print" => {
            ("A body only says what is done when; kirk runs no Lisp.", Cure::Unknown)
        }
        "start" | "end" => (
            "An event is no activity; it is named in a constraint: `(between (end a) (start b) (simple-temporal :lower-bound 5))`.",
            Cure::Unknown,
        ),
        "primitive" | "duration" | "requires" | "effect" => {
            ("This is a declaration: it belongs into the `(declare ...)` of the program.", Cure::Unknown)
        }
        _ => return None,
    };
    Some(Instead { help, cure })
}

/// What there is in the place of a definition of this name.
pub(super) fn instead_of_definition(word: &str) -> Option<Instead> {
    let (help, cure) = match word {
        "defun" | "defmacro" | "defgeneric" | "defmethod" | "lambda" | "defprogram" | "def" | "define"
        | "define-program" => (
            "A program is `(define-control-program name (parameter...) body...)`; functions and macros of Lisp are not run.",
            match word {
                "defprogram" | "define-program" => Cure::Write("define-control-program"),
                _ => Cure::Unknown,
            },
        ),
        "defvar" | "define-constant" | "defconst" => (usage("defparameter"), Cure::Write("defparameter")),
        "setq" | "setf" | "let" | "let*" => (usage("defparameter"), Cure::Unknown),
        "defstruct" | "deftype" => (usage("defclass"), Cure::Unknown),
        "use-package" | "import" | "export" | "shadow" => (
            "What a package uses is said where it is defined: `(defpackage #:name (:use #:other))`.",
            Cure::Unknown,
        ),
        "load" | "require" | "quickload" | "defsystem" | "include" | "load-system" => {
            ("Kirk loads nothing: give all the files on one command line, and take this out.", Cure::TakeOut)
        }
        "eval-when" | "declaim" | "proclaim" | "optimize" => (
            "Kirk runs no Lisp: take this out.",
            if word == "eval-when" { Cure::Unknown } else { Cure::TakeOut },
        ),
        _ => return None,
    };
    Some(Instead { help, cure })
}
