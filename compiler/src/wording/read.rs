//! What is said about texts.

use crate::code::Code;
use crate::diagnostic::{Diagnostic, Edit};
use crate::form::clip;
use crate::read::problem::{Commas, Foreign, ForeignToken, Problem, StrayClose, Unclosed};
use crate::read::{MAX_LENGTH, MAX_NESTING};
use crate::source::Span;

/// What to do about a quotation mark inside of a string.
const INSIDE_A_STRING: &str = "Inside a string, a quotation mark is written `\\\"`.";

/// Where a definition was expected.
const NO_DEFINITION: &str = "a definition in parentheses was expected here";

impl From<Problem<'_>> for Diagnostic {
    fn from(problem: Problem) -> Diagnostic {
        match problem {
            Problem::TooLong { end } => {
                let message = format!("this source is longer than {} MiB", MAX_LENGTH >> 20);
                Diagnostic::error(Code::TooLong, end, message)
                    .primary("kirk reads no further than here")
                    .help("Is this the file you meant? No mission that can be executed is that long.")
            }
            Problem::Empty { start, comments } => {
                let message = match comments {
                    true => "this source contains comments but no program",
                    false => "this source is empty",
                };
                Diagnostic::error(Code::EmptySource, start, message)
                    .primary("a program was expected")
                    .help("The smallest program is `(define-control-program main () (sequence ()))`.")
            }
            Problem::NotText { at } => Diagnostic::error(Code::NotText, at, "this is not text")
                .primary("no text contains this")
                .help("kirk reads RMPL programs as UTF-8 text; this looks like a binary file."),
            Problem::ForeignText { line, is } => not_rmpl(line, is)
                .help("A mission begins like `(define-control-program main () (sequence (:slack t) (first) (second)))`."),
            Problem::ForeignLines { first, is, lines } => comment_out(
                not_rmpl(first, is).help("Take it out, or put `;` in front of it to make it a comment."),
                lines,
            ),
            Problem::Stray { first, word, lines } => {
                let message = format!("`{}` stands outside every definition", clip(word));
                let problem = Diagnostic::error(Code::StrayText, first, message)
                    .primary(NO_DEFINITION)
                    .help("A comment begins with `;`. A program is `(define-control-program name () ...)`.");
                comment_out(problem, lines)
            }
            Problem::UnclosedComment { mark } => {
                Diagnostic::error(Code::UnclosedComment, mark, "this comment is never closed")
                    .primary("`#|` opens a comment here; `|#` was expected before the end of the text")
                    .help("Everything after it was left out. A comment to the end of one line begins with `;`.")
            }
            Problem::TooDeep { at } => {
                Diagnostic::error(Code::TooDeep, at, format!("forms are nested more than {MAX_NESTING} deep"))
                    .primary("this is one level too many")
                    .help("Give the inner part a name of its own with `define-control-program` and call it.")
            }
            Problem::NothingQuoted { quote } => {
                Diagnostic::error(Code::Unreadable, quote, "nothing follows this quote")
                    .primary("a form was expected after `'`")
            }
            Problem::Unclosed(form) => unclosed(form),
            Problem::StrayClose(parentheses) => stray_close(parentheses),
            Problem::UnclosedString { mark, end } => {
                let problem = Diagnostic::error(Code::UnclosedString, mark, "this string is never closed")
                    .primary("the string begins here; a closing `\"` was expected")
                    .help(INSIDE_A_STRING);
                match end {
                    Some(end) => problem.suggest("Close it before the parenthesis", [Edit::before(end, "\"")]),
                    None => problem,
                }
            }
            Problem::StringGoesOn { start, end, inside } => {
                let problem =
                    Diagnostic::error(Code::UnclosedString, end, "this quotation mark ends the string")
                        .primary("and words follow without a blank")
                        .label(start, "the string begins here")
                        .help(INSIDE_A_STRING);
                match inside.is_empty() {
                    true => problem,
                    false => problem.suggest(
                        "Make the quotation marks part of the string",
                        inside.into_iter().map(|mark| Edit::before(mark, "\\")),
                    ),
                }
            }
            Problem::NumberWithCommas { at, number, commas } => {
                let (what, instead) = match commas {
                    Commas::Thousands => ("a comma between thousands", ""),
                    Commas::Between => ("commas between numbers", " "),
                    Commas::Decimal => ("a comma before decimals", "."),
                };
                let plain = number.replace(',', instead);
                Diagnostic::error(Code::Unreadable, at, format!("`{number}` is no number"))
                    .primary(what)
                    .help(format!("Numbers are written without commas: `{plain}`."))
                    .change(at, plain)
            }
            Problem::ForeignToken { at, is, open, close } => foreign_token(at, is, open, close),
            Problem::LoneComma { at } => unreadable(",", at).take_out("the comma", at),
            Problem::Brackets { open, close, bracket } => unreadable(bracket, open).suggest(
                "Change to round parentheses",
                [Edit::replace(open, "("), Edit::replace(close, ")")],
            ),
            Problem::Unreadable { at, text } => unreadable(text, at),
        }
    }
}

fn not_rmpl(line: Span, is: Foreign) -> Diagnostic {
    let what = match is {
        Foreign::Script => "a script for another program",
        Foreign::Prompt => "what was typed at a shell prompt",
        Foreign::Command => "a command for the shell",
        Foreign::MergeMark => "the mark of a merge that has not been settled",
        Foreign::Patch => "part of a patch",
        Foreign::Xml => "XML",
        Foreign::Html => "HTML",
        Foreign::XmlOrHtml => "XML or HTML",
        Foreign::Json => "JSON",
        Foreign::Pddl => "PDDL",
        Foreign::Python => "Python",
        Foreign::JavaScript => "JavaScript or another language with `let` and `=`",
        Foreign::Rust => "Rust",
        Foreign::C => "C or C++",
        Foreign::JavaOrGo => "Java or Go",
        Foreign::Yaml => "YAML or a list of settings",
        Foreign::Markdown => "Markdown, or a comment of another language",
        Foreign::Comment => "a comment of another language",
        Foreign::Assignment => "an assignment of another language",
    };
    Diagnostic::error(Code::NotRmpl, line, format!("this is {what}, not RMPL")).primary(NO_DEFINITION)
}

fn comment_out(problem: Diagnostic, lines: Vec<Span>) -> Diagnostic {
    problem.suggest("Make a comment of it", lines.into_iter().map(|line| Edit::before(line, "; ")))
}

fn unclosed(Unclosed { at, begins, missing, definition, next, close }: Unclosed) -> Diagnostic {
    let what = match missing {
        1 => "a `)` is missing".to_string(),
        _ => format!("{missing} `)` are missing"),
    };
    let message = format!("the form `{}` is never closed", clip(&begins));
    let mut problem = Diagnostic::error(Code::UnclosedForm, at, message)
        .primary(format!("{what} for the form that is open here"));
    if let Some(definition) = definition {
        problem = problem.label(definition, "inside the definition that begins here");
    }
    problem = match next {
        Some(next) => problem.label(next, "the next definition begins before it is closed"),
        None => problem.help("The text ends while it is still open: is the end of the file missing?"),
    };
    match close {
        Some(end) => problem.suggest("Close what is open", [Edit::before(end, ")".repeat(missing))]),
        None => problem,
    }
}

fn stray_close(parentheses: StrayClose) -> Diagnostic {
    let StrayClose { at, count, closed, too_early, are_the_ones, indented } = parentheses;
    let (message, primary) = match count {
        1 => ("this parenthesis closes nothing", "one `)` too many"),
        _ => ("these parentheses close nothing", "too many `)`"),
    };
    let mut problem = Diagnostic::error(Code::StrayClose, at, message).primary(primary);
    if let Some(close) = closed {
        problem = problem.label(close, "the definition before it already ends here");
    }
    if are_the_ones {
        problem = problem.take_out("what closes nothing", at);
    }
    if let Some(close) = too_early {
        problem = problem.take_out(&format!("`{}` at the end of the definition", ")".repeat(count)), close);
    }
    match indented {
        Some((form, line)) => problem.label(
            line,
            format!(
                "this line is indented as if `{}` were still open: look at the parentheses just before it",
                clip(form)
            ),
        ),
        None => problem,
    }
}

fn foreign_token(at: Span, is: ForeignToken, open: Span, close: Span) -> Diagnostic {
    const COMMENT: [&str; 3] = [
        "this is a comment of another language",
        "not RMPL",
        "A comment begins with `;` and goes to the end of the line.",
    ];
    const STRING: &str = "A string stands in straight quotation marks: `\"text\"`.";
    let ([message, primary, help], instead) = match is {
        ForeignToken::LineComment => (COMMENT, Some([";", ""])),
        ForeignToken::BlockComment => (COMMENT, Some(["#|", "|#"])),
        ForeignToken::String => {
            (["these are not the quotation marks of a program", "not RMPL", STRING], Some(["\"", "\""]))
        }
        ForeignToken::UnclosedString => {
            (["this quotation mark is not one of a program", "not RMPL, and never closed", STRING], None)
        }
        ForeignToken::Quote => (
            [
                "the character `‘` (U+2018) has no meaning here",
                "a curly quotation mark",
                "A symbol that stands for itself is quoted with a straight one: `'name`; the name of a program is not quoted.",
            ],
            Some(["'", ""]),
        ),
    };
    let problem = Diagnostic::error(Code::Unreadable, at, message).primary(primary).help(help);
    let Some([begin, finish]) = instead else { return problem };
    let edits = [Edit::replace(open, begin), Edit::replace(close, finish)];
    let edits = edits.into_iter().filter(|edit| edit.span.start < edit.span.end);
    problem.suggest(format!("Write it as `{begin}...{finish}`"), edits)
}

fn unreadable(text: &str, at: Span) -> Diagnostic {
    let plain = |c: char| if c.is_control() { c.escape_debug().to_string() } else { c.to_string() };
    let shown: String = clip(text).chars().map(plain).collect();
    let (message, help) = match text.chars().next() {
        Some(',') => (
            "a comma has no meaning in RMPL".to_string(),
            Some("Between the elements of a form there are blanks; a decimal number has a point: `1.5`."),
        ),
        Some('`') => (
            format!("`{shown}` is for Lisp macros, which kirk does not run"),
            Some("Write the form out as it should be."),
        ),
        Some('#') => (
            format!("kirk does not read `{shown}`"),
            Some("Of the forms that begin with `#`, kirk reads `#:name` and the comment `#| ... |#`."),
        ),
        Some('[' | ']' | '{' | '}') => {
            (format!("`{shown}` has no meaning in RMPL"), Some("Forms are enclosed in round parentheses."))
        }
        Some('|' | '\\') => (
            format!("kirk does not read `{shown}` in names"),
            Some("Names are made of letters, digits and `-+*/<>=.!?%&$_~^@`."),
        ),
        _ => (format!("the character `{shown}` has no meaning here"), None),
    };
    Diagnostic::error(Code::Unreadable, at, message).primary("not RMPL").maybe_help(help.map(str::to_string))
}
