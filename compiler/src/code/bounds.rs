//! Bounds and durations.

use super::Page;

pub(super) const NOT_A_NUMBER: Page = Page {
    meaning: "A bound is a number of seconds (`15`, `1.5`, `1/2`, `1e3`), a number with a unit (`(minutes 5)`), a name from
`defparameter`, a parameter of the program, a calculation with these (`(+ *wait* 5)`), or `:infinity` for an upper bound.",
    wrong: "(define-control-program a () (declare (primitive) (duration (simple :upper-bound 5min))))",
    right: "(define-control-program a () (declare (primitive) (duration (simple :upper-bound (minutes 5)))))",
};

pub(super) const NEGATIVE: Page = Page {
    meaning: "A bound says how much time passes from a start to an end. The end never comes before the start.",
    wrong: "(define-control-program a () (declare (primitive) (duration (simple :lower-bound -5))))",
    right: "(define-control-program a () (declare (primitive) (duration (simple :lower-bound 5))))",
};

pub(super) const LOWER_ABOVE_UPPER: Page = Page {
    meaning: "No duration is at least as long as the lower bound and at most as long as the upper one. They are probably
swapped, or in different units.",
    wrong: "(define-control-program a () (declare (primitive) (duration (simple :lower-bound 20 :upper-bound 15))))",
    right: "(define-control-program a () (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 20))))",
};

pub(super) const NOT_EXACT: Page = Page {
    meaning: "Kirk counts time in whole microseconds and never rounds a bound, because a proof about rounded numbers is no
proof about yours. A number with more than six decimals, or a fraction such as `1/3`, has to be rounded by
you. `(minutes 1/3)` is 20 s and therefore fine.",
    wrong: "(define-control-program a () (declare (primitive) (duration (simple :lower-bound 1/3))))",
    right: "(define-control-program a () (declare (primitive) (duration (simple :lower-bound 0.333334))))",
};

pub(super) const TOO_LARGE: Page = Page {
    meaning: "Durations are at most 10 billion seconds, some 317 years, so that sums of them can never overflow. To say that
there is no limit, leave the upper bound out or write `:infinity`.",
    wrong: "(define-control-program a () (declare (primitive) (duration (simple :upper-bound 1e99))))",
    right: "(define-control-program a () (declare (primitive) (duration (simple :upper-bound :infinity))))",
};

pub(super) const DELAY_NOT_CONTINGENT: Page = Page {
    meaning: "An observation delay says how late the executive hears that an activity has ended. What the executive ends
itself it need not hear of: only a contingent duration has a delay. Probably `:contingent t` was forgotten; it
stands after `(simple ...)`.",
    wrong: "(define-control-program a ()
  (declare (primitive)
    (duration (simple :upper-bound 10 :max-observation-delay 5))))",
    right: "(define-control-program a ()
  (declare (primitive)
    (duration (simple :upper-bound 10 :max-observation-delay 5) :contingent t)))",
};

pub(super) const DELAY_REVERSED: Page = Page {
    meaning: "The news of an end comes at least `:min-observation-delay` and at most `:max-observation-delay` after it. The
least is above the most, or only the least is given. A delay that may never end is written
`:max-observation-delay :infinity`.",
    wrong: "(define-control-program a ()
  (declare (primitive)
    (duration (simple :upper-bound 10 :min-observation-delay 5) :contingent t)))",
    right: "(define-control-program a ()
  (declare (primitive)
    (duration (simple :upper-bound 10 :min-observation-delay 5 :max-observation-delay 8) :contingent t)))",
};

pub(super) const CONTINGENT_UNBOUNDED: Page = Page {
    meaning: "Nature decides how long a contingent activity takes, within its bounds. Without an upper bound it might never
end, and nothing could be promised about what comes after it.",
    wrong: "(define-control-program a ()
  (declare (primitive) (duration (simple :lower-bound 5) :contingent t)))",
    right: "(define-control-program a ()
  (declare (primitive) (duration (simple :lower-bound 5 :upper-bound 60) :contingent t)))",
};

pub(super) const INFINITE_LOWER: Page = Page {
    meaning: "An activity that takes at least forever never ends. Only an upper bound, and the longest delay, may be
`:infinity`.",
    wrong: "(define-control-program a () (declare (primitive) (duration (simple :lower-bound :infinity))))",
    right: "(define-control-program a () (declare (primitive) (duration (simple :upper-bound :infinity))))",
};

pub(super) const UNKNOWN_UNIT: Page = Page {
    meaning: "The units of time are `microseconds`, `seconds`, `minutes`, `hours` and `days`, each applied to one number. A
plain number is seconds. Numbers may be calculated with `+`, `-`, `*`, `/`, `1+`, `1-`, `min`, `max` and `mod`; kirk
calculates exactly or not at all. Anything else in place of a number means nothing to it.",
    wrong: "(define-control-program a () (declare (primitive) (duration (simple :upper-bound (minuts 5)))))",
    right: "(define-control-program a () (declare (primitive) (duration (simple :upper-bound (minutes 5)))))",
};

pub(super) const NO_BOUNDS: Page = Page {
    meaning: "A `with-temporal-constraint` whose constraint has neither a lower nor an upper bound constrains nothing.
Probably a bound was forgotten; if not, the form can go. In a `between` it says only that the first event comes first,
since a lower bound that is not given is 0; if that is meant, `:lower-bound 0` says so.",
    wrong: "(define-control-program main ()
  (with-temporal-constraint (simple-temporal) (a)))",
    right: "(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound 60) (a)))",
};

pub(super) const BAD_COUNT: Page = Page {
    meaning: "`dotimes` repeats its body 0, 1, 2, ... times. The number has to be known before the mission starts: a whole number,
a named number, a parameter that was given one, or a calculation with these. Every repetition is unfolded, so at
most 200,000 are possible.",
    wrong: "(define-control-program a () (declare (primitive)))
(define-control-program main ()
  (dotimes (i 2.5) (a)))",
    right: "(define-control-program a () (declare (primitive)))
(define-control-program main ()
  (dotimes (i 3) (a)))",
};

pub(super) const SAME_EVENT: Page = Page {
    meaning: "Both events of a `between` are one and the same, so the time between them is 0 s whatever the bounds say. Probably
one of them should be the other end, or that of another occurrence.",
    wrong: "(define-control-program a () (declare (primitive)))
(define-control-program main ()
  (a)
  (between (start a) (start a) (simple-temporal :upper-bound 5)))",
    right: "(define-control-program a () (declare (primitive)))
(define-control-program main ()
  (a)
  (between (start a) (end a) (simple-temporal :upper-bound 5)))",
};

pub(super) const NEVER_BINDS: Page = Page {
    meaning: "The activities inside a `with-temporal-constraint` follow one another without slack, and even the longest of their
durations add up to less than its upper bound. So the bound changes nothing. That may be just as well; or the
activities were meant to have slack, or the bound was meant in another unit.",
    wrong: "(define-control-program a () (declare (primitive) (duration (simple :upper-bound 10))))
(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound 60)
    (sequence (:slack nil) (a) (a))))",
    right: "(define-control-program a () (declare (primitive) (duration (simple :upper-bound 10))))
(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound 60)
    (sequence (:slack t) (a) (a))))",
};

pub(super) const USELESS_NEWS: Page = Page {
    meaning: "An end that Nature decides is heard some time later, and how much later varies as much as the duration itself, or
more. In the worst case the news then says nothing that was not known before: a short duration heard late looks
like a long one heard early. A plan that holds in every case is made as if the news never came. It becomes
useful when the delay varies by less than the duration, however long it is.",
    wrong: "(define-control-program main ()
  (declare (primitive)
    (duration (simple :lower-bound 20 :upper-bound 25
                      :min-observation-delay 0
                      :max-observation-delay 10)
      :contingent t)))",
    right: "(define-control-program main ()
  (declare (primitive)
    (duration (simple :lower-bound 20 :upper-bound 25
                      :min-observation-delay 8
                      :max-observation-delay 10)
      :contingent t)))",
};

pub(super) const NEVER_LATE: Page = Page {
    meaning: "An activity has to start at one certain moment, and nobody wrote that down: a lower bound and an upper bound meet,
so that the first moment at which it can start is also the last. Such a plan is right, and it breaks with the
smallest latency of a computer, a radio or a person. Kirk names the bounds; leave some time between them. An
exact time that is written as such (`:lower-bound 5 :upper-bound 5`) earns no note.",
    wrong: "(define-control-program a () (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 20))))
(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound 30)
    (sequence (:slack t) (a) (a))))",
    right: "(define-control-program a () (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 20))))
(define-control-program main ()
  (with-temporal-constraint (simple-temporal :upper-bound 35)
    (sequence (:slack t) (a) (a))))",
};
