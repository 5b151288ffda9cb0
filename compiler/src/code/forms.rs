//! Forms and declarations.

use super::Page;

pub(super) const UNKNOWN_TOP_LEVEL: Page = Page {
    meaning:
        "A source consists of definitions: `define-control-program`, `defpackage`, `in-package`, `defclass`,
`defparameter` and `defconstant`. Other Lisp, such as `defun`, is not run. A body form such as `sequence` at
the top level usually means that the program before it was closed too early.",
    wrong: "(define-control-progam main () (declare (primitive)))",
    right: "(define-control-program main () (declare (primitive)))",
};

pub(super) const UNKNOWN_OPERATOR: Page = Page {
    meaning: "The operators of a body are `sequence`, `parallel`, `with-temporal-constraint`, `delay`, `between`, `label`,
`dotimes`, `let` and `let*`; every other form is a call of a program. This one is neither, and looks like an
operator misspelt.",
    wrong: "(define-control-program main ()
  (seqence (:slack t) (a)))",
    right: "(define-control-program main ()
  (sequence (:slack t) (a)))",
};

pub(super) const UNKNOWN_KEYWORD: Page = Page {
    meaning: "A form understands only its own keywords: `simple` has `:lower-bound`, `:upper-bound`,
`:min-observation-delay` and `:max-observation-delay`; `duration` has `:contingent`; `simple-temporal` has
`:lower-bound` and `:upper-bound`; `sequence` and `parallel` have `:slack`. A keyword that is not understood
is never left out silently: the constraint you meant would be missing.",
    wrong: "(define-control-program a ()
  (declare (primitive) (duration (simple :lower-bound 5 :uper-bound 10))))",
    right: "(define-control-program a ()
  (declare (primitive) (duration (simple :lower-bound 5 :upper-bound 10))))",
};

pub(super) const UNKNOWN_DECLARATION: Page = Page {
    meaning: "The declarations of a program are `(primitive)`, `(duration ...)`, `(requires ...)` and `(effect ...)`.",
    wrong: "(define-control-program a ()
  (declare (primitive) (duraton (simple :upper-bound 10))))",
    right: "(define-control-program a ()
  (declare (primitive) (duration (simple :upper-bound 10))))",
};

pub(super) const WRONG_SHAPE: Page = Page {
    meaning: "At this place the language has something else: a name, a list, a value after a keyword, a body form. The
message says what was expected and how the form is written.",
    wrong: "(define-control-program main
  (sequence :slack t (a)))",
    right: "(define-control-program main ()
  (sequence (:slack t) (a)))",
};

pub(super) const KEYWORD_TWICE: Page = Page {
    meaning: "A bound, an option or a declaration is given twice. Lisp would take the first and say nothing; kirk asks which
one is meant.",
    wrong: "(define-control-program a ()
  (declare (primitive) (duration (simple :upper-bound 5 :upper-bound 10))))",
    right: "(define-control-program a ()
  (declare (primitive) (duration (simple :lower-bound 5 :upper-bound 10))))",
};

pub(super) const PRIMITIVE_WITH_BODY: Page = Page {
    meaning: "A program is either primitive, an activity that takes time and that somebody carries out, or it has a body
that says of what others it consists.",
    wrong: "(define-control-program main ()
  (declare (primitive))
  (a))",
    right: "(define-control-program main ()
  (a))",
};

pub(super) const NO_BODY: Page = Page {
    meaning: "Nothing says what this program does: it is not declared primitive and has no body. An activity that somebody
carries out needs `(primitive)`; a program that is to do nothing has the body `(sequence ())`.",
    wrong: "(define-control-program a ()
  (declare (duration (simple :upper-bound 10))))",
    right: "(define-control-program a ()
  (declare (primitive) (duration (simple :upper-bound 10))))",
};

pub(super) const DURATION_OF_BODY: Page = Page {
    meaning: "How long a program with a body takes follows from its parts. To limit it, put `with-temporal-constraint`
around the body.",
    wrong: "(define-control-program main ()
  (declare (duration (simple :upper-bound 60)))
  (sequence () (a) (a)))",
    right: "(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound 60)
    (sequence () (a) (a))))",
};

pub(super) const UNKNOWN_SLOT_OPTION: Page = Page {
    meaning: "The options of a slot are `:initarg`, `:initform`, `:type`, `:reader`, `:accessor`, `:writer`, `:allocation`,
`:finalp` and `:documentation`. An unknown one is left out, with a warning: nothing kirk does depends on it.",
    wrong: r##"(defclass glider ()
  ((id :documentaiton "Its number.")))"##,
    right: r##"(defclass glider ()
  ((id :documentation "Its number.")))"##,
};
