//! The codes of kirk's diagnostics: a stable number, a title, and a page for `kirk explain`.
//!
//! The hundreds digit says which part of kirk speaks: 1 reading, 2 forms and declarations, 3 names, 4 bounds and
//! durations, 5 packages, classes and conditions, 6 executability, 7 files, 8 executions. The pages live in `code/`, one file for each.

mod bounds;
mod files;
mod forms;
mod names;
mod reading;
mod worlds;

use std::fmt;

/// The page of a code: what it means, and a wrong and a right example.
pub(crate) struct Page {
    pub(crate) meaning: &'static str,
    pub(crate) wrong: &'static str,
    pub(crate) right: &'static str,
}

macro_rules! codes {
    ($($name:ident = $number:literal, $title:literal, $page:expr;)*) => {
        /// What kind of problem a diagnostic is about. Displayed as `K0203`.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u16)]
        pub enum Code {
            $(#[doc = $title] $name = $number,)*
        }

        impl Code {
            /// Every code, in order.
            pub const ALL: &[Code] = &[$(Code::$name),*];

            /// One line that says what it is about.
            pub fn title(self) -> &'static str {
                match self { $(Code::$name => $title,)* }
            }

            /// What it means, in a paragraph or a few.
            pub fn meaning(self) -> &'static str {
                self.page().meaning.trim()
            }

            fn page(self) -> &'static Page {
                match self { $(Code::$name => &$page,)* }
            }
        }
    };
}

codes! {
    UnclosedForm = 101, "a form is never closed", reading::UNCLOSED_FORM;
    StrayClose = 102, "a closing parenthesis too many", reading::STRAY_CLOSE;
    UnclosedString = 103, "a string is never closed", reading::UNCLOSED_STRING;
    UnclosedComment = 104, "a block comment is never closed", reading::UNCLOSED_COMMENT;
    TooDeep = 105, "forms are nested too deeply to be read", reading::TOO_DEEP;
    NotText = 106, "this is not text", reading::NOT_TEXT;
    Unreadable = 107, "a character or a piece of Lisp that kirk does not read", reading::UNREADABLE;
    NotRmpl = 108, "this is not RMPL", reading::NOT_RMPL;
    EmptySource = 109, "there is no program here", reading::EMPTY_SOURCE;
    StrayText = 110, "text between the definitions", reading::STRAY_TEXT;
    TooManyProblems = 111, "there are more problems than kirk shows", reading::TOO_MANY_PROBLEMS;
    TooLong = 112, "a source is too long", reading::TOO_LONG;
    UnknownTopLevel = 201, "not a definition kirk knows", forms::UNKNOWN_TOP_LEVEL;
    UnknownOperator = 202, "not an operator kirk knows", forms::UNKNOWN_OPERATOR;
    UnknownKeyword = 203, "not a keyword that is understood here", forms::UNKNOWN_KEYWORD;
    UnknownDeclaration = 204, "not a declaration kirk knows", forms::UNKNOWN_DECLARATION;
    WrongShape = 205, "something else was expected here", forms::WRONG_SHAPE;
    KeywordTwice = 206, "the same thing is said twice", forms::KEYWORD_TWICE;
    PrimitiveWithBody = 207, "a primitive program with a body", forms::PRIMITIVE_WITH_BODY;
    NoBody = 208, "a program that does nothing", forms::NO_BODY;
    DurationOfBody = 209, "a duration declared for a program with a body", forms::DURATION_OF_BODY;
    UnknownSlotOption = 211, "not a slot option kirk knows", forms::UNKNOWN_SLOT_OPTION;
    UnknownProgram = 301, "a program that is not defined", names::UNKNOWN_PROGRAM;
    DefinedTwice = 302, "a name is defined twice", names::DEFINED_TWICE;
    Recursion = 303, "a program that calls itself", names::RECURSION;
    WrongArguments = 304, "the wrong number of arguments", names::WRONG_ARGUMENTS;
    NoEntry = 305, "there is no program to start from", names::NO_ENTRY;
    NeverUsed = 306, "something that is never used", names::NEVER_USED;
    UnknownName = 307, "a name that stands for nothing", names::UNKNOWN_NAME;
    StartsAtDelayedEnd = 308, "an activity starts at an end that is heard late", names::STARTS_AT_DELAYED_END;
    TooManyEpisodes = 309, "the program unfolds to too many episodes", names::TOO_MANY_EPISODES;
    CallsTooDeep = 310, "the program unfolds too deeply", names::CALLS_TOO_DEEP;
    FreeParameters = 311, "the program to start from has parameters", names::FREE_PARAMETERS;
    UnknownLabel = 312, "a label that is not there", names::UNKNOWN_LABEL;
    AmbiguousLabel = 313, "a label or a name that means several occurrences", names::AMBIGUOUS_LABEL;
    ReservedName = 314, "a name that has a meaning of its own", names::RESERVED_NAME;
    UnknownAgent = 315, "an agent that is not in the team", names::UNKNOWN_AGENT;
    NobodyExecutes = 316, "an activity of a team that is nobody's", names::NOBODY_EXECUTES;
    NotTheSameMoment = 317, "one moment for two agents who cannot both know it", names::NOT_THE_SAME_MOMENT;
    Unreachable = 318, "two agents of whom neither hears of the other", names::UNREACHABLE;
    NotANumber = 401, "a bound that is not a number", bounds::NOT_A_NUMBER;
    Negative = 402, "a negative bound", bounds::NEGATIVE;
    LowerAboveUpper = 403, "the lower bound is above the upper bound", bounds::LOWER_ABOVE_UPPER;
    NotExact = 404, "a number that is not exact to a microsecond", bounds::NOT_EXACT;
    TooLarge = 405, "a number that is too large", bounds::TOO_LARGE;
    DelayNotContingent = 406, "an observation delay without `:contingent t`", bounds::DELAY_NOT_CONTINGENT;
    DelayReversed = 407, "the shortest delay is above the longest", bounds::DELAY_REVERSED;
    ContingentUnbounded = 408, "a contingent duration without an upper bound", bounds::CONTINGENT_UNBOUNDED;
    InfiniteLower = 409, "an infinite lower bound", bounds::INFINITE_LOWER;
    UnknownUnit = 410, "not a unit of time", bounds::UNKNOWN_UNIT;
    NoBounds = 411, "a constraint that allows everything", bounds::NO_BOUNDS;
    BadCount = 412, "not a number of repetitions", bounds::BAD_COUNT;
    SameEvent = 413, "a constraint between an event and itself", bounds::SAME_EVENT;
    NeverBinds = 414, "an upper bound that is never reached", bounds::NEVER_BINDS;
    UselessNews = 415, "news that comes too irregularly to be of use", bounds::USELESS_NEWS;
    NeverLate = 416, "an activity that can never start late", bounds::NEVER_LATE;
    UnknownPackage = 501, "a package that is not defined", worlds::UNKNOWN_PACKAGE;
    PackageNotChosen = 502, "several packages and none chosen", worlds::PACKAGE_NOT_CHOSEN;
    UnknownClass = 503, "a class that is not defined", worlds::UNKNOWN_CLASS;
    UnknownAccessor = 504, "no class has such a slot", worlds::UNKNOWN_ACCESSOR;
    WrongType = 505, "a value the slot cannot have", worlds::WRONG_TYPE;
    BadCondition = 506, "not a condition kirk understands", worlds::BAD_CONDITION;
    NotPlannedWith = 507, "conditions are not planned with", worlds::NOT_PLANNED_WITH;
    UnknownType = 508, "not a type kirk knows", worlds::UNKNOWN_TYPE;
    CircularClass = 509, "a class that extends itself", worlds::CIRCULAR_CLASS;
    NotControllable = 601, "the program cannot be executed in every case", worlds::NOT_CONTROLLABLE;
    NoPromises = 602, "no promises were found with which a team is sure to succeed", worlds::NO_PROMISES;
    CannotRead = 701, "a file that cannot be read", files::CANNOT_READ;
    BadNetwork = 702, "not a network kirk can read", files::BAD_NETWORK;
    NumbersTooLarge = 703, "durations that add up to too much", files::NUMBERS_TOO_LARGE;
    NoPrograms = 704, "an option that chooses a program, given with a network", files::NO_PROGRAMS;
    ForOneAlone = 705, "a question about one executive, asked of a team's mission", files::FOR_ONE_ALONE;
    BadObservation = 801, "not an observation of this mission", files::BAD_OBSERVATION;
    ImpossibleObservation = 802, "news that the model rules out", files::IMPOSSIBLE_OBSERVATION;
    BadRecord = 803, "not the record of an execution", files::BAD_RECORD;
}

/// The page on a code (`K0203`, in any case): what it means, a wrong and a right example. `None` if there is no such code.
pub fn explain(code: &str) -> Option<String> {
    let wanted = code.trim().to_uppercase();
    let code = Code::ALL.iter().copied().find(|code| code.to_string() == wanted)?;
    let Page { meaning, wrong, right } = code.page();
    let mut text = format!("{code}: {}\n\n{}\n", code.title(), meaning.trim());
    for (title, example) in [("Wrong", wrong), ("Right", right)] {
        if !example.trim().is_empty() {
            text.push_str(&format!("\n{title}:\n\n"));
            for line in example.trim_matches('\n').lines() {
                text.push_str(format!("    {line}").trim_end());
                text.push('\n');
            }
        }
    }
    Some(text)
}

/// All pages as one Markdown document, which is `docs/DIAGNOSTICS.md`.
pub fn pages() -> String {
    let mut text = String::from(
        "# What kirk has to say\n\nEvery message has a code. `kirk explain K0203` prints the page of one; this file holds all of them.\nIt is generated \
         from `compiler/src/code/`.\n",
    );
    for code in Code::ALL {
        text.push_str(&format!("\n## {code}: {}\n\n{}", code.title(), markdown(*code)));
    }
    text
}

/// The page on a code in Markdown, without its heading.
pub fn markdown(code: Code) -> String {
    let Page { meaning, wrong, right } = code.page();
    let mut text = format!("{}\n", meaning.trim());
    for (title, example) in [("Wrong", wrong), ("Right", right)] {
        if !example.trim().is_empty() {
            text.push_str(&format!("\n{title}:\n\n```lisp\n{}\n```\n", example.trim_matches('\n')));
        }
    }
    text
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "K{:04}", *self as u16)
    }
}
