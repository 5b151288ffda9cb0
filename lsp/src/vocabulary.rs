//! The words of the language: what each is, where it stands, and how it is written.

/// Where a form stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Position {
    /// At the top level.
    Definition,
    /// In a `declare`.
    Declaration,
    /// In the body of a program or of a form.
    Body,
    /// Where a duration is declared: `simple`.
    Duration,
    /// Where a constraint is: `simple-temporal`.
    Constraint,
    /// Where an event is: `start`, `end`.
    Event,
    /// In `requires` and `effect`.
    Condition,
    /// Where a number is.
    Number,
}

/// A word of the language.
#[derive(Debug)]
pub(crate) struct Word {
    /// The word.
    pub(crate) name: &'static str,
    /// Where its form stands.
    pub(crate) position: Position,
    /// How it is written: its parts, separated by blanks outside of parentheses.
    pub(crate) shape: &'static str,
    /// The same to be filled in, without the parentheses around it.
    pub(crate) snippet: &'static str,
    /// What it means.
    pub(crate) about: &'static str,
}

/// The word of this name, in any case.
pub(crate) fn word(name: &str) -> Option<&'static Word> {
    WORDS.iter().find(|word| word.name.eq_ignore_ascii_case(name))
}

/// The keywords a form understands, with what they mean; none for most.
pub(crate) fn keywords(head: &str) -> &'static [(&'static str, &'static str)] {
    const LOWER: (&str, &str) = ("lower-bound", "The least, in seconds; without it 0.");
    const UPPER: (&str, &str) = ("upper-bound", "The most, in seconds; without it there is no limit.");
    match head {
        "simple" => &[
            LOWER,
            UPPER,
            ("min-observation-delay", "How late the news of the end is at the earliest; without it 0."),
            (
                "max-observation-delay",
                "How late the news of the end is at the latest; `:infinity` if it may never come.",
            ),
        ],
        "simple-temporal" => &[LOWER, UPPER],
        "duration" => &[("contingent", "`t` if Nature decides how long it takes.")],
        "sequence" | "parallel" => &[("slack", "`t` if time may pass between the parts, `nil` if not.")],
        "defpackage" => &[
            ("use", "Packages whose names are known in this one."),
            ("import-from", "A package and the names of it that are known in this one."),
        ],
        "slot" => &[
            ("initform", "Its value at first."),
            ("type", "What it may be: `(member a b)`, a class or a type of Lisp."),
            ("accessor", "What reads it in conditions."),
            ("reader", "What reads it in conditions."),
            ("initarg", "The keyword that sets it."),
            ("finalp", "`t` if it never changes."),
            ("documentation", "What it is for."),
        ],
        _ => &[],
    }
}

/// All words, in the order in which they are offered.
pub(crate) const WORDS: &[Word] = &[
    Word {
        name: "define-control-program",
        position: Position::Definition,
        shape: "(define-control-program name (parameter...) form...)",
        snippet: "define-control-program ${1:name} (${2})\n  ${0}",
        about: "Defines a program: an activity, if the first form is a `declare` that says `(primitive)`, else what its body does. A string before the forms says what it is for.",
    },
    Word {
        name: "defparameter",
        position: Position::Definition,
        shape: "(defparameter name number)",
        snippet: "defparameter *${1:name}* ${2:60}",
        about: "Gives a number a name.",
    },
    Word {
        name: "defconstant",
        position: Position::Definition,
        shape: "(defconstant name number)",
        snippet: "defconstant +${1:name}+ ${2:60}",
        about: "Gives a number a name.",
    },
    Word {
        name: "defclass",
        position: Position::Definition,
        shape: "(defclass name (superclass...) (slot...))",
        snippet: "defclass ${1:name} (${2})\n  ((${3:slot} :accessor ${3:slot}))",
        about: "Defines what agents or objects there are and what may be true of them.",
    },
    Word {
        name: "defpackage",
        position: Position::Definition,
        shape: "(defpackage name option...)",
        snippet: "defpackage #:${1:name}",
        about: "Defines a package: names that are known only where it is used.",
    },
    Word {
        name: "in-package",
        position: Position::Definition,
        shape: "(in-package name)",
        snippet: "in-package #:${1:name}",
        about: "Enters a package: the definitions that follow belong to it.",
    },
    Word {
        name: "declare",
        position: Position::Body,
        shape: "(declare declaration...)",
        snippet: "declare (primitive)\n    (duration (simple :lower-bound ${1:5} :upper-bound ${2:10}))",
        about: "Says what a program is: primitive, how long it takes, what it requires and brings about.",
    },
    Word {
        name: "sequence",
        position: Position::Body,
        shape: "(sequence (:slack t) form...)",
        snippet: "sequence (:slack ${1|t,nil|})\n  ${0}",
        about: "One after the other. With `:slack t` time may pass between the parts; without, each starts the moment the one before it ends.",
    },
    Word {
        name: "parallel",
        position: Position::Body,
        shape: "(parallel (:slack t) form...)",
        snippet: "parallel (:slack ${1|t,nil|})\n  ${0}",
        about: "Side by side. With `:slack t` all happen between its start and its end; without, all start together and end together.",
    },
    Word {
        name: "with-temporal-constraint",
        position: Position::Body,
        shape: "(with-temporal-constraint (simple-temporal ...) form...)",
        snippet: "with-temporal-constraint (simple-temporal :upper-bound ${1:60})\n  ${0}",
        about: "Limits how long the body takes from its start to its end.",
    },
    Word {
        name: "delay",
        position: Position::Body,
        shape: "(delay least most)",
        snippet: "delay ${1:5} ${2:10}",
        about: "A wait, as long as we choose; with one number exactly that long, with `:infinity` as the most at least that long.",
    },
    Word {
        name: "dotimes",
        position: Position::Body,
        shape: "(dotimes (variable count) form...)",
        snippet: "dotimes (${1:i} ${2:3})\n  ${0}",
        about: "The body so many times in its place, the variable standing for 0, 1, 2 and so on.",
    },
    Word {
        name: "let",
        position: Position::Body,
        shape: "(let ((name value)...) form...)",
        snippet: "let ((${1:x} ${2:5}))\n  ${0}",
        about: "The body in its place, with names for values.",
    },
    Word {
        name: "let*",
        position: Position::Body,
        shape: "(let* ((name value)...) form...)",
        snippet: "let* ((${1:x} ${2:5}))\n  ${0}",
        about: "As `let`, each name being known to those after it.",
    },
    Word {
        name: "label",
        position: Position::Body,
        shape: "(label name form)",
        snippet: "label ${1:name} ${0}",
        about: "Names an occurrence, so that `(start name)` and `(end name)` mean its events.",
    },
    Word {
        name: "between",
        position: Position::Body,
        shape: "(between event event (simple-temporal ...))",
        snippet: "between (end ${1:a}) (start ${2:b}) (simple-temporal :lower-bound ${3:0})",
        about: "A constraint between two events, wherever they are: from the first to the second it takes so long.",
    },
    Word {
        name: "primitive",
        position: Position::Declaration,
        shape: "(primitive)",
        snippet: "primitive",
        about: "The program is an activity that somebody carries out.",
    },
    Word {
        name: "duration",
        position: Position::Declaration,
        shape: "(duration (simple ...) :contingent t)",
        snippet: "duration (simple :lower-bound ${1:5} :upper-bound ${2:10})",
        about: "How long the activity takes; with `:contingent t` Nature decides.",
    },
    Word {
        name: "requires",
        position: Position::Declaration,
        shape: "(requires condition)",
        snippet: "requires (${1|at :start,over :all,at :end|} ${0})",
        about: "What has to hold. It is checked against the classes, and not planned with.",
    },
    Word {
        name: "effect",
        position: Position::Declaration,
        shape: "(effect condition)",
        snippet: "effect (at ${1|:end,:start|} ${0})",
        about: "What the activity brings about. It is checked against the classes, and not planned with.",
    },
    Word {
        name: "simple",
        position: Position::Duration,
        shape: "(simple :lower-bound least :upper-bound most)",
        snippet: "simple :lower-bound ${1:5} :upper-bound ${2:10}",
        about: "A duration, and how late the news of its end may be.",
    },
    Word {
        name: "simple-temporal",
        position: Position::Constraint,
        shape: "(simple-temporal :lower-bound least :upper-bound most)",
        snippet: "simple-temporal :upper-bound ${1:60}",
        about: "How much time passes from the first event to the second.",
    },
    Word {
        name: "start",
        position: Position::Event,
        shape: "(start name)",
        snippet: "start ${1:name}",
        about: "The start of what a label names, or of the one occurrence of a program.",
    },
    Word {
        name: "end",
        position: Position::Event,
        shape: "(end name)",
        snippet: "end ${1:name}",
        about: "The end of what a label names, or of the one occurrence of a program.",
    },
    Word {
        name: "and",
        position: Position::Condition,
        shape: "(and condition...)",
        snippet: "and ${0}",
        about: "All of these.",
    },
    Word {
        name: "or",
        position: Position::Condition,
        shape: "(or condition...)",
        snippet: "or ${0}",
        about: "One of these.",
    },
    Word {
        name: "not",
        position: Position::Condition,
        shape: "(not condition)",
        snippet: "not ${0}",
        about: "Not this.",
    },
    Word {
        name: "at",
        position: Position::Condition,
        shape: "(at time condition)",
        snippet: "at ${1|:start,:end|} ${0}",
        about: "At the start, or at the end.",
    },
    Word {
        name: "over",
        position: Position::Condition,
        shape: "(over :all condition)",
        snippet: "over :all ${0}",
        about: "All the while.",
    },
    Word {
        name: "=",
        position: Position::Condition,
        shape: "(= (accessor object) value)",
        snippet: "= (${1:accessor} ${2:object}) ${3:value}",
        about: "The slot has this value.",
    },
    Word {
        name: "seconds",
        position: Position::Number,
        shape: "(seconds number)",
        snippet: "seconds ${1:60}",
        about: "So many seconds.",
    },
    Word {
        name: "minutes",
        position: Position::Number,
        shape: "(minutes number)",
        snippet: "minutes ${1:5}",
        about: "So many minutes.",
    },
    Word {
        name: "hours",
        position: Position::Number,
        shape: "(hours number)",
        snippet: "hours ${1:1}",
        about: "So many hours.",
    },
    Word {
        name: "days",
        position: Position::Number,
        shape: "(days number)",
        snippet: "days ${1:1}",
        about: "So many days.",
    },
    Word {
        name: "microseconds",
        position: Position::Number,
        shape: "(microseconds number)",
        snippet: "microseconds ${1:500}",
        about: "So many microseconds, the smallest unit there is.",
    },
    Word {
        name: "+",
        position: Position::Number,
        shape: "(+ number...)",
        snippet: "+ ${0}",
        about: "The sum.",
    },
    Word {
        name: "-",
        position: Position::Number,
        shape: "(- number number...)",
        snippet: "- ${0}",
        about: "The difference; of one number, its negative.",
    },
    Word {
        name: "*",
        position: Position::Number,
        shape: "(* number...)",
        snippet: "* ${0}",
        about: "The product.",
    },
    Word {
        name: "/",
        position: Position::Number,
        shape: "(/ number number)",
        snippet: "/ ${0}",
        about: "The quotient, which must be exact.",
    },
    Word {
        name: "1+",
        position: Position::Number,
        shape: "(1+ number)",
        snippet: "1+ ${0}",
        about: "One more.",
    },
    Word {
        name: "1-",
        position: Position::Number,
        shape: "(1- number)",
        snippet: "1- ${0}",
        about: "One less.",
    },
    Word {
        name: "min",
        position: Position::Number,
        shape: "(min number...)",
        snippet: "min ${0}",
        about: "The smallest.",
    },
    Word {
        name: "max",
        position: Position::Number,
        shape: "(max number...)",
        snippet: "max ${0}",
        about: "The largest.",
    },
    Word {
        name: "mod",
        position: Position::Number,
        shape: "(mod number number)",
        snippet: "mod ${0}",
        about: "What is left over when the first is divided by the second.",
    },
];

#[cfg(test)]
mod tests {
    use kirk_compiler::words::{DECLARATIONS, DEFINITIONS, OPERATORS, UNITS};

    #[test]
    fn every_word_of_the_language_has_its_page() {
        let units = UNITS.map(|(unit, _)| unit);
        let words = DEFINITIONS.iter().chain(&OPERATORS).chain(&DECLARATIONS).chain(&units);
        let missing: Vec<&&str> = words.filter(|name| super::word(name).is_none()).collect();
        assert!(missing.is_empty(), "{missing:?}");
    }
}
