//! Packages, classes, conditions, and whether a mission can be executed.

use super::Page;

pub(super) const UNKNOWN_PACKAGE: Page = Page {
    meaning: "A package is defined by `defpackage` before it is entered by `in-package`, used by another, written before a
name, or chosen with `-P`.",
    wrong: r##"(defpackage #:scenario1)
(in-package #:scenaro1)"##,
    right: r##"(defpackage #:scenario1)
(in-package #:scenario1)"##,
};

pub(super) const PACKAGE_NOT_CHOSEN: Page = Page {
    meaning:
        "The source defines several packages, and none of them, or more than one, has a program of the name to
start from. Say which one is meant with
`-P NAME`. What is outside any package is in `cl-user`, which counts as one of them. With one package or none, `-P`
is not needed.",
    wrong: r##"(defpackage #:astronaut)
(defpackage #:robot)"##,
    right: r##"(defpackage #:robot)
(in-package #:robot)"##,
};

pub(super) const UNKNOWN_CLASS: Page = Page {
    meaning: "A class extends a class that is not defined.",
    wrong: "(defclass vehicle () ())
(defclass glider (vehcile) ())",
    right: "(defclass vehicle () ())
(defclass glider (vehicle) ())",
};

pub(super) const CIRCULAR_CLASS: Page = Page {
    meaning: "A class extends itself, directly or through the classes it extends. The help shows the way round.",
    wrong: "(defclass rover (vehicle) ())
(defclass vehicle (rover) ())
(define-control-program main () (declare (primitive)))",
    right: "(defclass vehicle () ())
(defclass rover (vehicle) ())
(define-control-program main () (declare (primitive)))",
};

pub(super) const UNKNOWN_ACCESSOR: Page = Page {
    meaning: "A condition speaks of a slot through its `:reader` or `:accessor`, and no class has one of this name. A slot
without either cannot be spoken of.",
    wrong: "(defclass glider () ((place :initarg :place)))
(define-control-program move (g)
  (declare (primitive) (effect (at :end (= (place g) 5)))))",
    right: "(defclass glider () ((place :initarg :place :accessor place)))
(define-control-program move (g)
  (declare (primitive) (effect (at :end (= (place g) 5)))))",
};

pub(super) const WRONG_TYPE: Page = Page {
    meaning: "The value does not belong to the type of the slot, so the condition could never hold, or the slot would begin
with a value it cannot have. Text, `t` and `nil`, numbers and symbols are checked against `(member ...)`,
`boolean`, `string`, `integer` and their like.",
    wrong: r##"(defclass glider () ((place :type (member "start" "end") :accessor place)))
(define-control-program move (g)
  (declare (primitive) (effect (at :end (= (place g) "strat")))))"##,
    right: r##"(defclass glider () ((place :type (member "start" "end") :accessor place)))
(define-control-program move (g)
  (declare (primitive) (effect (at :end (= (place g) "start")))))"##,
};

pub(super) const BAD_CONDITION: Page = Page {
    meaning: "A condition is `(= (accessor object) value)` or `(accessor object)`, put together with `and`, `or` and `not`,
and said of a time with `(at :start c)`, `(at :end c)` or `(over :all c)`.",
    wrong: "(defclass glider () ((place :accessor place)))
(define-control-program move (g)
  (declare (primitive) (requires (at :begin (= (place g) nil)))))",
    right: "(defclass glider () ((place :accessor place)))
(define-control-program move (g)
  (declare (primitive) (requires (at :start (= (place g) nil)))))",
};

pub(super) const NOT_PLANNED_WITH: Page = Page {
    meaning: "Conditions and effects are read, resolved, checked against the classes and kept with the episode, so that
other tools can use them. Kirk itself does not plan: it takes the program as it is written and does not look
for activities that would bring about what another one requires, nor does it check that one does not undo what
another needs.",
    wrong: "(defclass glider () ((place :accessor place)))
(define-control-program move (g)
  (declare (primitive) (requires (at :start (= (place g) nil)))))",
    right: "(define-control-program move (g)
  (declare (primitive)))",
};

pub(super) const UNKNOWN_TYPE: Page = Page {
    meaning: "The type of a slot is neither a class nor a type of Lisp that kirk knows. The slot is kept, and its values are
not checked.",
    wrong: "(defclass glider ()
  ((id :type integr)))",
    right: "(defclass glider ()
  ((id :type integer)))",
};

pub(super) const NOT_CONTROLLABLE: Page = Page {
    meaning: "There is no strategy that keeps every constraint whatever Nature does within its bounds. The message names the
bounds that do not go together and tells, step by step, what is needed and who decides it, and what is there. At
least one of them has to change: a longer deadline, a shorter activity, a narrower contingent duration, news that
comes sooner, or slack where two events are forced together. Conflicts that have no bound of ours in common are
told each by itself, up to ten of them. The help says what is enough: each amount it names, changed alone to
the value it gives, makes the mission controllable (with several conflicts: settles this one), and a microsecond
less of a change does not. Of all the ways in which the bounds do not go together the steps tell the one that is left
just before the first of these changes is enough: what is said to be missing is that change. Where there is none of
which that can be said, the steps are any way round, and the difference is said to be of `this way round` only: more
may be missing in all, or less. What is ours and the news come first; Nature's durations are named only where nothing
else is enough. If no amount alone will do, it says so, and `kirk repair` finds what several changes, slack or an
order less can do. With `--theory` the amounts are added up with their signs: the sum round the cycle is below
zero. A schedule for the average case may exist all the same; kirk promises more than that.

The question of the least change is that of P. Yu and B. Williams (Continuously relaxing over-constrained conditional
temporal problems, IJCAI 2013) for one bound at a time; conflicts are found as by N. Bhargava, T. Vaquero and B. Williams
(Faster conflict generation for dynamic controllability, IJCAI 2017), and several changes together as by J. Cui and others
(Optimising bounds in simple temporal networks with uncertainty under dynamic controllability constraints, ICAPS 2015).",
    wrong: "(define-control-program drive ()
  (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 20) :contingent t)))
(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound 18)
    (drive)))",
    right: "(define-control-program drive ()
  (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 20) :contingent t)))
(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound 20)
    (drive)))",
};

pub(super) const NO_PROMISES: Page = Page {
    meaning: "A team could execute this mission if everybody heard everything at once. As news is late, each agent has to act on what
it knows, and on what others promise: that they will do something so long after something that both hear of. kirk looked
for such promises and found none. The message says how much is missing and names the bounds and the delays that it is the
sum of; the help names the links that would do if they were faster, or stamped. What was not found may exist all the same: kirk
does not know ways in which agents signal by the time at which they do something else. A promise can be written by hand as a
`between` of its two events.",
    wrong: "(define-team crew (agent astronaut) (agent robot) (link astronaut robot :min-delay 5 :max-delay 15))
(define-control-program talk ()
  (declare (primitive) (agent astronaut) (duration (simple :lower-bound 15 :upper-bound 30) :contingent t)))
(define-control-program drill ()
  (declare (primitive) (agent robot)))
(define-control-program main ()
  (sequence (:slack t) (talk) (drill))
  (between (end talk) (start drill) (simple-temporal :upper-bound 14)))",
    right: "(define-team crew (agent astronaut) (agent robot) (link astronaut robot :min-delay 5 :max-delay 14))
(define-control-program talk ()
  (declare (primitive) (agent astronaut) (duration (simple :lower-bound 15 :upper-bound 30) :contingent t)))
(define-control-program drill ()
  (declare (primitive) (agent robot)))
(define-control-program main ()
  (sequence (:slack t) (talk) (drill))
  (between (end talk) (start drill) (simple-temporal :upper-bound 14)))",
};
