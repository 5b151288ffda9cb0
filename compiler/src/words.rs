//! The words of the language, in one place: the parser and its guesses know them from here, and the grammars of the editors are held
//! to them by a test.

/// The words that begin a top-level form.
pub const DEFINITIONS: [&str; 6] =
    ["define-control-program", "defpackage", "in-package", "defclass", "defparameter", "defconstant"];

/// The operators of bodies.
pub const OPERATORS: [&str; 9] = [
    "sequence",
    "parallel",
    "with-temporal-constraint",
    "delay",
    "let",
    "let*",
    "dotimes",
    "label",
    "between",
];

/// What may stand in a `declare`.
pub const DECLARATIONS: [&str; 4] = ["primitive", "duration", "requires", "effect"];

/// The keywords of `simple`.
pub const BOUNDS: [&str; 4] =
    ["lower-bound", "upper-bound", "min-observation-delay", "max-observation-delay"];

/// The units of time, in microseconds.
pub const UNITS: [(&str, i64); 5] = [
    ("microseconds", 1),
    ("seconds", 1_000_000),
    ("minutes", 60_000_000),
    ("hours", 3_600_000_000),
    ("days", 86_400_000_000),
];
