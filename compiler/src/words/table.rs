//! Every word, with the form it begins.

use super::Layout::{Block, Hanging, Packed};
use super::Piece::{
    Agent, Bound, Class, Clause, Content, Flag, Form, Keywords, List, Name, Number, Occurrence, Options,
};
use super::Position::{Body, Condition, Constraint, Declaration, Declare, Definition, Duration, Event, Team};
use super::{Keyword, Layout, Piece, Position, Word};

/// All words, in the order in which they are offered.
pub const WORDS: &[Word] = &[
    Word {
        name: "define-control-program",
        position: Definition,
        parts: &[("name", Name), ("(parameter...)", Name), ("form...", Content)],
        layout: Block(3),
        filled: " ${1:name} (${2})\n  ${0}",
        about: "Defines a program: an activity, if the first form is a `declare` that says `(primitive)`, else what its body does. A string before the forms says what it is for.",
        usage: "A program is `(define-control-program name (parameter...) (declare ...) body...)`.",
        ..PLAIN
    },
    Word {
        name: "define-team",
        position: Definition,
        parts: &[("name", Name), ("(agent ...)", Form(Team))],
        layout: Block(2),
        filled: " ${1:name}\n  (agent ${2:astronaut})\n  (agent ${3:robot})\n  (link ${2:astronaut} ${3:robot} :min-delay ${4:5} :max-delay ${5:15})",
        about: "Defines who executes the mission together, and how late news reaches each of them.",
        usage: "A team is `(define-team name (agent a) (agent b) (link a b :min-delay 5 :max-delay 15))`.",
        ..PLAIN
    },
    Word {
        name: "defparameter",
        position: Definition,
        parts: &[("name", Name), ("number", Number)],
        layout: Hanging(3),
        filled: " *${1:name}* ${2:60}",
        about: "Gives a number a name.",
        usage: "A named number is `(defparameter *name* 15)`.",
        ..PLAIN
    },
    Word {
        name: "defconstant",
        position: Definition,
        parts: &[("name", Name), ("number", Number)],
        layout: Hanging(3),
        filled: " +${1:name}+ ${2:60}",
        about: "Gives a number a name.",
        usage: "A named number is `(defparameter *name* 15)`.",
        ..PLAIN
    },
    Word {
        name: "defclass",
        position: Definition,
        parts: &[("name", Name), ("(superclass...)", Name), ("(slot...)", List)],
        layout: Block(3),
        filled: " ${1:name} (${2})\n  ((${3:slot} :accessor ${3:slot}))",
        about: "Defines what agents or objects there are and what may be true of them.",
        usage: "A class is `(defclass name (super...) ((slot :option value...)...))`.",
        ..PLAIN
    },
    Word {
        name: "defpackage",
        position: Definition,
        parts: &[("name", Name), ("option...", Clause)],
        keywords: PACKAGE,
        layout: Hanging(2),
        filled: " #:${1:name}",
        about: "Defines a package: names that are known only where it is used.",
        usage: "Write `(defpackage #:name)`.",
    },
    Word {
        name: "in-package",
        position: Definition,
        parts: &[("name", Name)],
        filled: " #:${1:name}",
        about: "Enters a package: the definitions that follow belong to it.",
        usage: "Write `(in-package #:name)`.",
        ..PLAIN
    },
    Word {
        name: "declare",
        position: Declare,
        parts: &[("declaration...", Form(Declaration))],
        layout: Block(2),
        filled: " (primitive)\n    (duration (simple :lower-bound ${1:5} :upper-bound ${2:10}))",
        about: "Says what a program is: primitive, how long it takes, what it requires and brings about.",
        ..PLAIN
    },
    Word {
        name: "sequence",
        position: Body,
        parts: &[("(:slack t)", Options), ("form...", Form(Body))],
        keywords: GROUP,
        layout: Block(2),
        filled: " (:slack ${1|t,nil|})\n  ${0}",
        about: "One after the other. With `:slack t` time may pass between the parts; without, each starts the moment the one before it ends.",
        ..PLAIN
    },
    Word {
        name: "parallel",
        position: Body,
        parts: &[("(:slack t)", Options), ("form...", Form(Body))],
        keywords: GROUP,
        layout: Block(2),
        filled: " (:slack ${1|t,nil|})\n  ${0}",
        about: "Side by side. With `:slack t` all happen between its start and its end; without, all start together and end together.",
        ..PLAIN
    },
    Word {
        name: "with-temporal-constraint",
        position: Body,
        parts: &[("(simple-temporal ...)", Form(Constraint)), ("form...", Form(Body))],
        layout: Block(2),
        filled: " (simple-temporal :upper-bound ${1:60})\n  ${0}",
        about: "Limits how long the body takes from its start to its end.",
        usage: "Write `(with-temporal-constraint (simple-temporal :upper-bound 60) body...)`.",
        ..PLAIN
    },
    Word {
        name: "delay",
        position: Body,
        parts: &[("least", Number), ("most", Bound)],
        filled: " ${1:5} ${2:10}",
        about: "A wait, as long as we choose; with one number exactly that long, with `:infinity` as the most at least that long.",
        usage: "Write `(delay 5 10)`: a wait of 5 to 10 s. `(delay 5 :infinity)` is a wait of at least 5 s.",
        ..PLAIN
    },
    Word {
        name: "dotimes",
        position: Body,
        parts: &[("(variable count)", Name), ("form...", Form(Body))],
        layout: Block(2),
        filled: " (${1:i} ${2:3})\n  ${0}",
        about: "The body so many times in its place, the variable standing for 0, 1, 2 and so on.",
        usage: "Write `(dotimes (i 3) body...)`: the body three times, with `i` standing for 0, 1 and 2.",
        ..PLAIN
    },
    Word {
        name: "let",
        position: Body,
        parts: &[("((name value)...)", List), ("form...", Form(Body))],
        layout: Block(2),
        filled: " ((${1:x} ${2:5}))\n  ${0}",
        about: "The body in its place, with names for values.",
        usage: "Write `(let ((x 5) (y (minutes 2))) body...)`.",
        ..PLAIN
    },
    Word {
        name: "let*",
        position: Body,
        parts: &[("((name value)...)", List), ("form...", Form(Body))],
        layout: Block(2),
        filled: " ((${1:x} ${2:5}))\n  ${0}",
        about: "As `let`, each name being known to those after it.",
        usage: "Write `(let ((x 5) (y (minutes 2))) body...)`.",
        ..PLAIN
    },
    Word {
        name: "label",
        position: Body,
        parts: &[("name", Name), ("form", Form(Body))],
        layout: Hanging(2),
        filled: " ${1:name} ${0}",
        about: "Names an occurrence, so that `(start name)` and `(end name)` mean its events.",
        usage: "Write `(label first (drive))`, or `(label (drive i) (drive))` to tell the repetitions of a `dotimes` apart.",
        ..PLAIN
    },
    Word {
        name: "between",
        position: Body,
        parts: &[("event", Form(Event)), ("event", Form(Event)), ("(simple-temporal ...)", Form(Constraint))],
        layout: Hanging(3),
        filled: " (end ${1:a}) (start ${2:b}) (simple-temporal :lower-bound ${3:0})",
        about: "A constraint between two events, wherever they are: from the first to the second it takes so long.",
        usage: "Write `(between (end a) (start b) (simple-temporal :lower-bound 5 :upper-bound 10))`: b starts 5 to 10 s after a ends.",
        ..PLAIN
    },
    Word {
        name: "with-agent",
        position: Body,
        parts: &[("agent", Agent), ("form...", Form(Body))],
        layout: Block(2),
        filled: " ${1:robot}\n  ${0}",
        about: "The body in its place, executed by this agent of the team, as far as it names no other.",
        usage: "Write `(with-agent robot body...)`.",
        ..PLAIN
    },
    Word {
        name: "link",
        position: Team,
        parts: &[("agent", Agent), ("agent", Agent), (":min-delay least :max-delay most", Keywords)],
        keywords: LINK,
        filled: " ${1:astronaut} ${2:robot} :min-delay ${3:5} :max-delay ${4:15}",
        about: "News travels between these two agents, and takes so long.",
        usage: "A link is `(link a b :min-delay 5 :max-delay 15)`; `:max-delay :infinity` says that messages may be lost.",
        ..PLAIN
    },
    Word {
        name: "primitive",
        position: Declaration,
        filled: "",
        about: "The program is an activity that somebody carries out.",
        ..PLAIN
    },
    Word {
        name: "duration",
        position: Declaration,
        parts: &[("(simple ...)", Form(Duration)), (":contingent t", Keywords)],
        keywords: DURATION,
        layout: Block(2),
        filled: " (simple :lower-bound ${1:5} :upper-bound ${2:10})",
        about: "How long the activity takes; with `:contingent t` Nature decides.",
        usage: "A duration is `(duration (simple :lower-bound 15 :upper-bound 20))`, with `:contingent t` at its end if Nature decides.",
    },
    Word {
        name: "agent",
        position: Declaration,
        parts: &[("agent", Agent)],
        filled: " ${1:robot}",
        about: "In a `define-team`, an agent of it. In a `declare`, the agent that executes the program: one of the team, or a parameter that stands for one.",
        usage: "An agent is `(agent robot)`.",
        ..PLAIN
    },
    Word {
        name: "requires",
        position: Declaration,
        parts: &[("condition", Form(Condition))],
        filled: " (${1|at :start,over :all,at :end|} ${0})",
        about: "What has to hold. It is checked against the classes, and not planned with.",
        ..PLAIN
    },
    Word {
        name: "effect",
        position: Declaration,
        parts: &[("condition", Form(Condition))],
        filled: " (at ${1|:end,:start|} ${0})",
        about: "What the activity brings about. It is checked against the classes, and not planned with.",
        ..PLAIN
    },
    Word {
        name: "simple",
        position: Duration,
        parts: &[(":lower-bound least :upper-bound most", Keywords)],
        keywords: SIMPLE,
        layout: Packed,
        filled: " :lower-bound ${1:5} :upper-bound ${2:10}",
        about: "A duration, and how late the news of its end may be.",
        ..PLAIN
    },
    Word {
        name: "simple-temporal",
        position: Constraint,
        parts: &[(":lower-bound least :upper-bound most", Keywords)],
        keywords: LIMITS,
        filled: " :upper-bound ${1:60}",
        about: "How much time passes from the first event to the second.",
        usage: "Write `(simple-temporal :lower-bound 5 :upper-bound 10)`; either bound may be left out.",
        ..PLAIN
    },
    Word {
        name: "start",
        position: Event,
        parts: &[("name", Occurrence)],
        filled: " ${1:name}",
        about: "The start of what a label names, or of the one occurrence of a program.",
        usage: "An event is `(start x)` or `(end x)`, where `x` is a label or the name of a program.",
        ..PLAIN
    },
    Word {
        name: "end",
        position: Event,
        parts: &[("name", Occurrence)],
        filled: " ${1:name}",
        about: "The end of what a label names, or of the one occurrence of a program.",
        usage: "An event is `(start x)` or `(end x)`, where `x` is a label or the name of a program.",
        ..PLAIN
    },
    condition("and", &[("condition...", Form(Condition))], " ${0}", "All of these."),
    condition("or", &[("condition...", Form(Condition))], " ${0}", "One of these."),
    condition("not", &[("condition", Form(Condition))], " ${0}", "Not this."),
    condition(
        "at",
        &[("time", Name), ("condition", Form(Condition))],
        " ${1|:start,:end|} ${0}",
        "At the start, or at the end.",
    ),
    condition("over", &[(":all", Name), ("condition", Form(Condition))], " :all ${0}", "All the while."),
    Word {
        name: "=",
        position: Condition,
        parts: &[("(accessor object)", Form(Condition)), ("value", Number)],
        filled: " (${1:accessor} ${2:object}) ${3:value}",
        about: "The slot has this value.",
        usage: "A condition is `(= (accessor object) value)`, put together with `and`, `or`, `not`, `(at :start c)`, `(at :end c)` and `(over :all c)`.",
        ..PLAIN
    },
    number("seconds", &[("number", Number)], " ${1:60}", "So many seconds."),
    number("minutes", &[("number", Number)], " ${1:5}", "So many minutes."),
    number("hours", &[("number", Number)], " ${1:1}", "So many hours."),
    number("days", &[("number", Number)], " ${1:1}", "So many days."),
    number(
        "microseconds",
        &[("number", Number)],
        " ${1:500}",
        "So many microseconds, the smallest unit there is.",
    ),
    number("+", &[("number...", Number)], " ${0}", "The sum."),
    number(
        "-",
        &[("number", Number), ("number...", Number)],
        " ${0}",
        "The difference; of one number, its negative.",
    ),
    number("*", &[("number...", Number)], " ${0}", "The product."),
    number("/", &[("number", Number), ("number", Number)], " ${0}", "The quotient, which must be exact."),
    number("1+", &[("number", Number)], " ${0}", "One more."),
    number("1-", &[("number", Number)], " ${0}", "One less."),
    number("min", &[("number...", Number)], " ${0}", "The smallest."),
    number("max", &[("number...", Number)], " ${0}", "The largest."),
    number(
        "mod",
        &[("number", Number), ("number", Number)],
        " ${0}",
        "What is left over when the first is divided by the second.",
    ),
];

/// The keywords of a slot of a class.
pub const SLOT: &[Keyword] = &[
    keyword("initform", Name, "", "Its value at first."),
    keyword("type", Class, "(member ${1})", "What it may be: `(member a b)`, a class or a type of Lisp."),
    keyword("accessor", Name, "", "What reads it in conditions."),
    keyword("reader", Name, "", "What reads it in conditions."),
    keyword("initarg", Name, "", "The keyword that sets it."),
    flag("finalp", "`t` if it never changes."),
    keyword("documentation", Name, "", "What it is for."),
];

const SIMPLE: &[Keyword] = &[
    LOWER,
    UPPER,
    keyword(
        "min-observation-delay",
        Number,
        "",
        "How late the news of the end is at the earliest; without it 0.",
    ),
    keyword(
        "max-observation-delay",
        Bound,
        "",
        "How late the news of the end is at the latest; `:infinity` if it may never come.",
    ),
];

const LIMITS: &[Keyword] = &[LOWER, UPPER];

const LOWER: Keyword = keyword("lower-bound", Number, "", "The least, in seconds; without it 0.");

const UPPER: Keyword =
    keyword("upper-bound", Bound, "", "The most, in seconds; without it there is no limit.");

const DURATION: &[Keyword] = &[
    flag("contingent", "`t` if Nature decides how long it takes."),
    keyword(
        "observed-by",
        Agent,
        "",
        "The agent of the team that hears of the end first, if it is another one.",
    ),
];

const LINK: &[Keyword] = &[
    keyword("min-delay", Number, "", "How long a message takes at the least; without it 0."),
    keyword("max-delay", Bound, "", "How long it takes at the most; `:infinity` if it may be lost."),
    flag("one-way", "`t` if messages go from the first agent to the second only."),
    flag("stamped", "`t` if messages say when what they tell of happened, by clocks that agree."),
];

const GROUP: &[Keyword] = &[flag("slack", "`t` if time may pass between the parts, `nil` if not.")];

const PACKAGE: &[Keyword] = &[
    keyword("use", Name, "#:${1:package}", "Packages whose names are known in this one."),
    keyword(
        "import-from",
        Name,
        "#:${1:package} #:${2:name}",
        "A package and the names of it that are known in this one.",
    ),
];

const fn flag(name: &'static str, about: &'static str) -> Keyword {
    keyword(name, Flag, "${1|t,nil|}", about)
}

const fn keyword(name: &'static str, value: Piece, filled: &'static str, about: &'static str) -> Keyword {
    let filled = if filled.is_empty() { "${1}" } else { filled };
    Keyword { name, value, filled, about }
}

/// A word whose form stands for a number.
const fn number(
    name: &'static str,
    parts: &'static [(&'static str, Piece)],
    filled: &'static str,
    about: &'static str,
) -> Word {
    Word { name, parts, filled, about, ..PLAIN }
}

/// A word whose form is a condition.
const fn condition(
    name: &'static str,
    parts: &'static [(&'static str, Piece)],
    filled: &'static str,
    about: &'static str,
) -> Word {
    Word { position: Condition, ..number(name, parts, filled, about) }
}

/// What most words have in common.
const PLAIN: Word = Word {
    name: "",
    position: Position::Number,
    parts: &[],
    keywords: &[],
    layout: Layout::Aligned,
    filled: "",
    about: "",
    usage: "",
};
