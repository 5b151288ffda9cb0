//! Names, calls, and how programs unfold.

use super::Page;

pub(super) const UNKNOWN_PROGRAM: Page = Page {
    meaning: "A form of a body that is no operator is a call, and no program of this name is defined, in any place of the
sources. Programs may be defined after their use. A program of another package is called as `package:name`.",
    wrong: "(define-control-program shower () (declare (primitive)))
(define-control-program main () (shover))",
    right: "(define-control-program shower () (declare (primitive)))
(define-control-program main () (shower))",
};

pub(super) const DEFINED_TWICE: Page = Page {
    meaning: "Two definitions of the same kind have the same name in the same package, so a call could mean either. Upper
and lower case make no difference in names.",
    wrong: "(define-control-program a () (declare (primitive)))
(define-control-program A () (declare (primitive)))",
    right: "(define-control-program a () (declare (primitive)))
(define-control-program b () (declare (primitive)))",
};

pub(super) const RECURSION: Page = Page {
    meaning: "A program calls itself, directly or through others; the message shows the circle. A mission is a fixed set of
events, so programs are unfolded before anything is executed, and this one would never end. To repeat
something, use `dotimes`.",
    wrong: "(define-control-program a () (sequence () (b) (a)))",
    right: "(define-control-program a () (sequence () (b) (b)))",
};

pub(super) const WRONG_ARGUMENTS: Page = Page {
    meaning: "A program is called with as many arguments as it has parameters.",
    wrong: "(define-control-program move (glider to) (declare (primitive)))
(define-control-program main () (move 'g1))",
    right: r##"(define-control-program move (glider to) (declare (primitive)))
(define-control-program main () (move 'g1 "start"))"##,
};

pub(super) const NO_ENTRY: Page = Page {
    meaning: "A mission starts with the program `main`, or with the one given by `--entry NAME`. With several packages, it
is looked for in the one given by `-P`.",
    wrong: "(define-control-program mian () (declare (primitive)))",
    right: "(define-control-program main () (declare (primitive)))",
};

pub(super) const NEVER_USED: Page = Page {
    meaning: "Nothing that the program to start from does leads to this one. It may be a forgotten call, or it may be left
over. When another entry is chosen with `--entry`, programs that nobody calls are taken for entries as well
and are not reported.

A parameter that nothing in the body means makes no difference, whatever is given for it; those of primitive programs are
for whoever executes them. A label that no `between` means only gives events another name.",
    wrong: "(define-control-program a () (declare (primitive)))
(define-control-program b () (declare (primitive)))
(define-control-program main () (a))",
    right: "(define-control-program a () (declare (primitive)))
(define-control-program b () (declare (primitive)))
(define-control-program main () (a) (b))",
};

pub(super) const UNKNOWN_NAME: Page = Page {
    meaning: "A name that stands for a value is a parameter of the program it is used in, is given by a `let` or `dotimes`
around the place, or is defined by `defparameter` or `defconstant`, for other named numbers further up. A symbol that stands for itself is quoted: `'north`.",
    wrong: "(define-control-program a () (declare (primitive) (duration (simple :upper-bound *limit*))))",
    right: "(defparameter *limit* 60)
(define-control-program a () (declare (primitive) (duration (simple :upper-bound *limit*))))",
};

pub(super) const STARTS_AT_DELAYED_END: Page = Page {
    meaning: "Without slack, the end of one activity and the start of the next are one event. If the end is up to Nature and
heard late, the next activity starts at the true end, before anybody has heard of it. That is right if the
activity starts by itself, or is carried out by the one who knows; it is not what you want if the executive
has to start it. Then use slack: it starts when the news has come.",
    wrong: "(define-control-program downlink ()
  (declare (primitive)
    (duration (simple :lower-bound 15 :upper-bound 30 :max-observation-delay 5) :contingent t)))
(define-control-program sync () (declare (primitive)))
(define-control-program main ()
  (sequence (:slack nil) (downlink) (sync)))",
    right: "(define-control-program downlink ()
  (declare (primitive)
    (duration (simple :lower-bound 15 :upper-bound 30 :max-observation-delay 5) :contingent t)))
(define-control-program sync () (declare (primitive)))
(define-control-program main ()
  (sequence (:slack t) (downlink) (sync)))",
};

pub(super) const TOO_MANY_EPISODES: Page = Page {
    meaning: "Every call is an episode of its own, and so is every call it leads to: a program that calls another twice,
which calls a third twice, and so on, doubles with each step. Kirk counts before it unfolds and stops at
200,000 episodes.",
    wrong: "",
    right: "",
};

pub(super) const CALLS_TOO_DEEP: Page = Page {
    meaning: "Programs that call one another in a chain, and the forms around the calls, unfold to a tree of episodes. Its
depth may be at most 1,000. Call the programs one after the other from one place instead of each from the one
before.",
    wrong: "",
    right: "",
};

pub(super) const FREE_PARAMETERS: Page = Page {
    meaning: "The program to start from has parameters, and nobody gives them a value. That does no harm as long as no bound
depends on them. To start with definite values, write a program `main` that calls it with arguments.",
    wrong: "(define-control-program main (glider) (declare (primitive)))",
    right: "(define-control-program move (glider) (declare (primitive)))
(define-control-program main () (move 'g1))",
};

pub(super) const UNKNOWN_LABEL: Page = Page {
    meaning: "`(start x)` and `(end x)` mean an occurrence: one that `(label x ...)` names, or that of a program called `x`. With
arguments, `(end (confirm 0 1))` means the one labelled or called with these arguments. Nothing of this name, or
nothing with these arguments, occurs in the mission. Repetitions count from 0, so the last of n is n - 1.",
    wrong: "(define-control-program a () (declare (primitive)))
(define-control-program main ()
  (parallel (:slack t)
    (dotimes (i 3) (label (step i) (a)))
    (between (end (step 2)) (start (step 3)) (simple-temporal :upper-bound 5))))",
    right: "(define-control-program a () (declare (primitive)))
(define-control-program main ()
  (parallel (:slack t)
    (dotimes (i 3) (label (step i) (a)))
    (between (end (step 1)) (start (step 2)) (simple-temporal :upper-bound 5))))",
};

pub(super) const AMBIGUOUS_LABEL: Page = Page {
    meaning: "The name means several occurrences, and a constraint is about one. Kirk looks in the program or the repetition of
a `dotimes` the `between` stands in, with everything called from there, and then further out; the first that has
any occurrence of the name must have exactly one. Give the one you mean a name of its own with `label`. Inside a
`dotimes`, a label with an argument, `(label (x i) ...)`, tells the repetitions apart; programs called with
different arguments can be told apart by these.",
    wrong: "(define-control-program a () (declare (primitive)))
(define-control-program main ()
  (sequence (:slack t) (a) (a))
  (between (start a) (end a) (simple-temporal :upper-bound 60)))",
    right: "(define-control-program a () (declare (primitive)))
(define-control-program main ()
  (sequence (:slack t) (label first (a)) (label last (a)))
  (between (start first) (end last) (simple-temporal :upper-bound 60)))",
};

pub(super) const RESERVED_NAME: Page = Page {
    meaning: "The operators of bodies (`sequence`, `parallel`, `with-temporal-constraint`, `delay`, `let`, `let*`, `dotimes`, `label`,
`between`), `declare`, `t` and `nil` have a meaning of their own. A program of such a name could never be called:
`(delay)` is always the operator. What the calls of it look like is not reported again. A label has no `#` in its
name, as `a#2` means the second occurrence of `a`.",
    wrong: "(define-control-program delay ()
  (declare (primitive) (duration (simple :lower-bound 5 :upper-bound 10))))
(define-control-program main () (sequence () (delay)))",
    right: "(define-control-program short-delay ()
  (declare (primitive) (duration (simple :lower-bound 5 :upper-bound 10))))
(define-control-program main () (sequence () (short-delay)))",
};

pub(super) const UNKNOWN_AGENT: Page = Page {
    meaning: "An agent is one that the `define-team` of the mission names, or a parameter that stands for one. Without a team a
mission has one executive, and nothing in it needs an agent.",
    wrong: "(define-team crew (agent astronaut) (agent robot) (link astronaut robot))
(define-control-program dig () (declare (primitive) (agent robbot)))
(define-control-program main () (dig))",
    right: "(define-team crew (agent astronaut) (agent robot) (link astronaut robot))
(define-control-program dig () (declare (primitive) (agent robot)))
(define-control-program main () (dig))",
};

pub(super) const NOBODY_EXECUTES: Page = Page {
    meaning: "In the mission of a team every activity is carried out by one of its agents: the one that its `declare` names, or else the
one of the nearest `with-agent` around the call.",
    wrong: "(define-team crew (agent astronaut) (agent robot) (link astronaut robot))
(define-control-program dig () (declare (primitive)))
(define-control-program main () (dig))",
    right: "(define-team crew (agent astronaut) (agent robot) (link astronaut robot))
(define-control-program dig () (declare (primitive)))
(define-control-program main () (with-agent robot (dig)))",
};

pub(super) const NOT_THE_SAME_MOMENT: Page = Page {
    meaning: "Without slack, what follows starts at the very moment at which what is before it ends. If Nature decides that moment, and the
one agent hears of it later than it happens, it cannot act at that moment. With slack it acts as soon as the news is there, or at
a time that does not depend on it.",
    wrong: "(define-team crew (agent astronaut) (agent robot) (link astronaut robot :min-delay 5 :max-delay 15))
(define-control-program talk ()
  (declare (primitive) (agent astronaut) (duration (simple :lower-bound 5 :upper-bound 25) :contingent t)))
(define-control-program dig ()
  (declare (primitive) (agent robot) (duration (simple :lower-bound 5 :upper-bound 10))))
(define-control-program main () (sequence () (talk) (dig)))",
    right: "(define-team crew (agent astronaut) (agent robot) (link astronaut robot :min-delay 5 :max-delay 15))
(define-control-program talk ()
  (declare (primitive) (agent astronaut) (duration (simple :lower-bound 5 :upper-bound 25) :contingent t)))
(define-control-program dig ()
  (declare (primitive) (agent robot) (duration (simple :lower-bound 5 :upper-bound 10))))
(define-control-program main () (sequence (:slack t) (talk) (dig)))",
};

pub(super) const UNREACHABLE: Page = Page {
    meaning: "A constraint says something of the events of two agents, and no chain of links leads from the one to the other, so neither
could ever act on what the other does.",
    wrong: "(define-team crew (agent astronaut) (agent robot))
(define-control-program talk () (declare (primitive) (agent astronaut)))
(define-control-program dig () (declare (primitive) (agent robot)))
(define-control-program main () (sequence (:slack t) (talk) (dig)))",
    right: "(define-team crew (agent astronaut) (agent robot) (link astronaut robot))
(define-control-program talk () (declare (primitive) (agent astronaut)))
(define-control-program dig () (declare (primitive) (agent robot)))
(define-control-program main () (sequence (:slack t) (talk) (dig)))",
};
