//! The words of what the command finds wrong with files, records and observations. Those of programs are the compiler's.

use std::io;

use kirk_compiler::{Code, Diagnostic, Span};
use kirk_network::{Network, ParseDurationError, Time};
use kirk_runtime::execution::FORMAT;
use kirk_runtime::{Impossible, Unheard};

/// What is wrong, and what is known about it.
pub(crate) enum Problem<'a> {
    /// A file cannot be read, for this reason.
    Unreadable(String),
    /// A file cannot be replaced.
    NotWritten(&'a str, io::Error),
    /// A file is given again.
    Twice(&'a str),
    /// So is standard input.
    StandardInputTwice,
    /// A network among files that are one program.
    NetworkInProgram(&'a str),
    /// A network where a program is to be laid out.
    NetworkToLayOut(&'a str),
    /// Bytes that are no text.
    NotText { line: usize, byte: usize },
    /// A program of more bytes than are read.
    TooLong { length: usize, most: u64 },
    /// What a reader of networks says.
    BadNetwork(String),
    /// An option that chooses a program of a network.
    NoPrograms { option: &'static str, value: &'a str },
    /// A question about one executive, asked of a team's mission.
    ForOneAlone { asked: &'a str, team: &'a str, agents: &'a [String] },
    /// A journal that cannot be repeated, for this reason.
    BadJournal(String),
    /// A record in another format.
    OtherFormat(&'a str),
    /// What a reader of records says.
    BadRecord(String),
    /// An observation without a time.
    NoTime,
    /// An observation with this in the place of its time.
    BadTime(&'a str, ParseDurationError),
    /// What a reader of observations says.
    BadObservations(String),
    /// An observation of nothing; what there is to be observed, and what of it was probably meant.
    UnknownEvent { name: &'a str, known: &'a [&'a str], near: Option<&'a str> },
    /// An observation of what kirk dispatches.
    NotNatures(&'a str),
    /// An observation before the mission starts.
    BeforeStart(&'a str),
    /// Two observations of one event, the other perhaps by another name.
    HeardTwice { name: &'a str, other: &'a str },
    /// An observation that the model rules out, or, in a rehearsal, that nothing could lead to.
    Impossible { name: &'a str, impossible: &'a Impossible, what_if: bool },
    /// News that cannot be heard at that time, whatever the model says.
    Unheard { name: &'a str, time: Time, why: Unheard, network: &'a Network, now: Time },
}

impl Problem<'_> {
    /// What is said about it at a place.
    pub(crate) fn at(self, span: Span) -> Diagnostic {
        let error = |code, message: String| Diagnostic::error(code, span, message);
        match self {
            Problem::Unreadable(why) => error(Code::CannotRead, why),
            Problem::NotWritten(file, why) => {
                error(Code::CannotRead, format!("cannot write `{file}`, which is as it was: {why}"))
            }
            Problem::Twice(file) => error(Code::CannotRead, format!("`{file}` is given twice")),
            Problem::StandardInputTwice => error(
                Code::CannotRead,
                "standard input is given twice, and can be read only once".to_string(),
            ),
            Problem::NetworkInProgram(file) => {
                error(Code::CannotRead, format!("`{file}` is a network and cannot be part of a program"))
                    .help("Several files are compiled as one program. Give a network alone.")
            }
            Problem::NetworkToLayOut(file) => {
                error(Code::CannotRead, format!("`{file}` is a network, and no program to lay out"))
            }
            Problem::NotText { line, byte } => {
                error(Code::NotText, format!("this is not UTF-8 text (line {line}, byte {byte})"))
                    .help("kirk reads RMPL and networks as text; is this the right file, or a compiled or compressed one?")
            }
            Problem::TooLong { length, most } => error(
                Code::TooLong,
                format!("this file has {length} bytes; kirk reads programs of up to {most}"),
            ),
            Problem::BadNetwork(message) => error(Code::BadNetwork, message),
            Problem::NoPrograms { option, value } => error(
                Code::NoPrograms,
                format!("`{option} {value}` chooses among the programs of a source, and this is a network"),
            )
            .help(format!("A network is checked and executed as a whole: leave `{option}` out.")),
            Problem::ForOneAlone { asked, team, agents } => error(
                Code::ForOneAlone,
                format!("{asked} knows one executive that hears everything, and the team `{team}` executes this"),
            )
            .help(format!(
                "`kirk check` judges the team; `kirk compile --agent NAME` prints what one of its agents executes: {}.",
                agents.join(", ")
            )),
            Problem::BadJournal(why) => {
                error(Code::BadRecord, format!("this journal cannot be repeated: {why}"))
            }
            Problem::OtherFormat(format) => {
                error(Code::BadRecord, format!("the format is `{format}`; this kirk reads `{FORMAT}`"))
            }
            Problem::BadRecord(message) => {
                error(Code::BadRecord, message).help("kirk run --format json writes such a record")
            }
            Problem::NoTime => observation(
                span,
                "an observation is written EVENT@T, such as `drive:end@17.5`".to_string(),
            ),
            Problem::BadTime(text, why) => observation(span, format!("`{text}`: {why}"))
                .help("an observation is written EVENT@T, with T in seconds after the start"),
            Problem::BadObservations(message) => observation(span, message)
                .help("the file is a JSON object of event: time in seconds, such as {\"drive:end\": 17.5}"),
            Problem::UnknownEvent { name, known, near } => {
                let help = match (near, known) {
                    (Some(near), _) => format!("did you mean `{near}`?"),
                    (None, []) => "nothing in this mission is Nature's; there is nothing to observe".to_string(),
                    (None, known) if known.len() <= 12 => {
                        format!("what can be observed: {}", known.join(", "))
                    }
                    (None, known) => format!(
                        "what can be observed: {} and {} more",
                        known[..10].join(", "),
                        known.len() - 10
                    ),
                };
                observation(span, no_event(name, None)).help(help)
            }
            Problem::NotNatures(name) => {
                observation(span, not_natures(name))
                    .help("only the ends of contingent durations are observed")
            }
            Problem::BeforeStart(name) => {
                observation(span, format!("`{name}` cannot be heard before the mission starts"))
                    .help("times are seconds after the start")
            }
            Problem::HeardTwice { name, other } => {
                let once = "news of an event arrives once";
                observation(span, format!("`{name}` is observed twice")).help(
                    match other.eq_ignore_ascii_case(name) {
                        true => once.to_string(),
                        false => format!("`{other}` and `{name}` are names of one event, and {once}"),
                    },
                )
            }
            Problem::Unheard { name, time, why, network, now } => {
                let (message, help) = unheard(name, time, why, network, now);
                error(Code::ImpossibleObservation, message).help(help)
            }
            Problem::Impossible { name, impossible, what_if } => {
                let Impossible { time, earliest, latest, .. } = impossible;
                let message = match latest {
                    _ if time < earliest => format!(
                        "news of `{name}` at {time} s is too early: it cannot arrive before {earliest} s"
                    ),
                    Some(latest) if time > latest => {
                        format!("news of `{name}` at {time} s is too late: it cannot arrive after {latest} s")
                    }
                    _ => format!("news of `{name}` at {time} s contradicts the other observations"),
                };
                let window = match latest {
                    Some(latest) => format!("from {earliest} to {latest} s"),
                    None => format!("from {earliest} s on"),
                };
                let rehearse = match what_if {
                    true => "what has not begun cannot be heard of, whatever the model says",
                    false => "`--what-if` rehearses what becomes of the mission if it comes all the same",
                };
                error(Code::ImpossibleObservation, message)
                    .help(format!("given what was dispatched, the model allows this news {window}; {rehearse}"))
            }
        }
    }
}

/// That nothing is called so, and what was probably meant.
pub(crate) fn no_event(name: &str, near: Option<&str>) -> String {
    let near = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
    format!("there is no event `{name}`{near}")
}

fn unheard(name: &str, time: Time, why: Unheard, network: &Network, now: Time) -> (String, String) {
    let earlier = "`--at` asks of an earlier time".to_string();
    match why {
        Unheard::Past => (format!("news of `{name}` at {time} s is in the past: it is {now} s"), earlier),
        Unheard::NotBegun { start } => (
            format!("`{name}` cannot be heard of at {time} s: it has not begun"),
            format!("it begins with `{}`, which is not executed by then", network.label(start)),
        ),
        Unheard::Before(before) => {
            (format!("`{name}` was heard at {before} s"), "news of an event arrives once".to_string())
        }
        Unheard::NotNatures => {
            (not_natures(name), "only the ends of contingent durations are heard of".to_string())
        }
        Unheard::Over => {
            (format!("`{name}` cannot be heard of at {time} s: nothing goes on by then"), earlier)
        }
    }
}

fn not_natures(name: &str) -> String {
    format!("`{name}` is not Nature's to decide: kirk dispatches it")
}

fn observation(span: Span, message: String) -> Diagnostic {
    Diagnostic::error(Code::BadObservation, span, message)
}
