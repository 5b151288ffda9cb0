//! Words people bring along from Lisp and other languages, and what RMPL has in their place.

/// What to write in the place of a form of this name in a body.
pub(crate) fn instead_of_operator(word: &str) -> Option<&'static str> {
    Some(match word {
        "loop" | "repeat" | "for" | "foreach" | "do" | "do*" | "dolist" | "times" => {
            "To do something several times, write `(dotimes (i 3) body...)`."
        }
        "while" | "until" => {
            "How often something is done has to be known before the mission starts: `(dotimes (i 3) body...)`."
        }
        "if" | "when" | "unless" | "cond" | "case" | "choose" | "either" => {
            "A mission has no choices: everything in it is done. Write a program for each case, and start one with `--entry`."
        }
        "progn" | "prog1" | "begin" | "block" | "serial" | "seq" | "then" => {
            "To do one thing after the other, write `(sequence (:slack t) ...)`."
        }
        "par" | "concurrently" | "fork" | "both" | "all" => {
            "To do things at the same time, write `(parallel (:slack t) ...)`."
        }
        "wait" | "sleep" | "pause" => "To let time pass, write `(delay 5 10)`: 5 to 10 s.",
        "simple-temporal" | "simple" | "within" | "deadline" | "timeout" => {
            "Bounds are put around what they limit: `(with-temporal-constraint (simple-temporal :upper-bound 60) ...)`."
        }
        "setq" | "setf" | "defparameter" | "flet" => "To name a number, write `(let ((x 5)) ...)`.",
        "lambda" | "funcall" | "apply" | "format" | "print" => {
            "A body only says what is done when; kirk runs no Lisp."
        }
        "start" | "end" => {
            "An event is no activity; it is named in a constraint: `(between (end a) (start b) (simple-temporal :lower-bound 5))`."
        }
        "primitive" | "duration" | "requires" | "effect" => {
            "This is a declaration: it belongs into the `(declare ...)` of the program."
        }
        _ => return None,
    })
}

/// What to write in the place of a definition of this name.
pub(super) fn instead_of_definition(word: &str) -> Option<&'static str> {
    Some(match word {
        "defun" | "defmacro" | "defgeneric" | "defmethod" | "lambda" | "defprogram" | "def" | "define"
        | "define-program" => {
            "A program is `(define-control-program name (parameter...) body...)`; functions and macros of Lisp are not run."
        }
        "defvar" | "setq" | "setf" | "let" | "let*" | "define-constant" | "defconst" => {
            "A named number is `(defparameter *name* 15)`."
        }
        "defstruct" | "deftype" => "A class is `(defclass name (super...) ((slot :option value...)...))`.",
        "use-package" | "import" | "export" | "shadow" => {
            "What a package uses is said where it is defined: `(defpackage #:name (:use #:other))`."
        }
        "load" | "require" | "quickload" | "defsystem" | "include" | "load-system" => {
            "Kirk loads nothing: give all the files on one command line, and take this out."
        }
        "eval-when" | "declaim" | "proclaim" | "optimize" => "Kirk runs no Lisp: take this out.",
        _ => return None,
    })
}
