//! Words people bring along from Lisp and other languages, and what RMPL has in their place.

/// What there is in the place of a word of another language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Instead {
    /// `dotimes`.
    Dotimes,
    /// The same, for so many times as are known before the start.
    Unrolled,
    /// A program for each case.
    Entries,
    Sequence,
    Parallel,
    /// What comes first has to be said.
    Order,
    /// What weighs more cannot be said: a bound, if anything.
    Bound,
    Delay,
    /// `with-temporal-constraint`.
    Constraint,
    Let,
    Between,
    Declare,
    /// Nothing in a body, where no Lisp is run.
    NoLisp,
    /// `define-control-program`, with other things in it.
    Program,
    /// The same, with the same in it.
    ControlProgram,
    Defparameter,
    /// The same, with other things in it.
    NamedNumber,
    Defclass,
    Defpackage,
    /// All files are named when kirk is started.
    CommandLine,
    /// Nothing at the top level, where no Lisp is run.
    Nothing,
    /// The same, around definitions that are meant.
    NothingAround,
}

/// What puts it right.
#[derive(Clone, Copy)]
pub(crate) enum Cure {
    /// This in the place of the word.
    Write(&'static str),
    /// Nothing in the place of the form.
    TakeOut,
    /// That is for the writer to say.
    Unknown,
}

impl Instead {
    /// What puts it right, if that is certain.
    pub(crate) fn cure(self) -> Cure {
        match self {
            Instead::Sequence => Cure::Write("sequence (:slack t)"),
            Instead::Parallel => Cure::Write("parallel (:slack t)"),
            Instead::Delay => Cure::Write("delay"),
            Instead::ControlProgram => Cure::Write("define-control-program"),
            Instead::Defparameter => Cure::Write("defparameter"),
            Instead::CommandLine | Instead::Nothing => Cure::TakeOut,
            _ => Cure::Unknown,
        }
    }

    /// What to write in the place of the word, if that is certain.
    pub(crate) fn word(self) -> Option<&'static str> {
        match self.cure() {
            Cure::Write(text) => Some(text),
            Cure::TakeOut | Cure::Unknown => None,
        }
    }
}

/// What there is in the place of a form of this name in a body.
pub(crate) fn instead_of_operator(word: &str) -> Option<Instead> {
    Some(match word {
        "loop" | "repeat" | "for" | "foreach" | "do" | "do*" | "dolist" | "times" => Instead::Dotimes,
        "while" | "until" => Instead::Unrolled,
        "if" | "when" | "unless" | "cond" | "case" | "choose" | "either" | "optional" | "maybe" | "try" => {
            Instead::Entries
        }
        "progn" | "prog1" | "begin" | "block" | "serial" | "seq" | "then" => Instead::Sequence,
        "par" | "concurrently" | "fork" | "both" | "all" => Instead::Parallel,
        "mutex" | "lock" | "critical" | "exclusive" | "resource" | "semaphore" => Instead::Order,
        "prefer" | "soft" | "priority" | "cost" | "minimize" | "maximize" => Instead::Bound,
        "wait" | "sleep" | "pause" => Instead::Delay,
        "simple-temporal" | "simple" | "within" | "deadline" | "timeout" => Instead::Constraint,
        "setq" | "setf" | "defparameter" | "flet" => Instead::Let,
        "lambda" | "funcall" | "apply" | "format" | "print" => Instead::NoLisp,
        "start" | "end" => Instead::Between,
        "primitive" | "duration" | "requires" | "effect" => Instead::Declare,
        _ => return None,
    })
}

/// What there is in the place of a definition of this name.
pub(super) fn instead_of_definition(word: &str) -> Option<Instead> {
    Some(match word {
        "defun" | "defmacro" | "defgeneric" | "defmethod" | "lambda" | "def" | "define" => Instead::Program,
        "defprogram" | "define-program" => Instead::ControlProgram,
        "defvar" | "define-constant" | "defconst" => Instead::Defparameter,
        "setq" | "setf" | "let" | "let*" => Instead::NamedNumber,
        "defstruct" | "deftype" => Instead::Defclass,
        "use-package" | "import" | "export" | "shadow" => Instead::Defpackage,
        "load" | "require" | "quickload" | "defsystem" | "include" | "load-system" => Instead::CommandLine,
        "declaim" | "proclaim" | "optimize" => Instead::Nothing,
        "eval-when" => Instead::NothingAround,
        _ => return None,
    })
}
