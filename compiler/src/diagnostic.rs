//! What kirk has to say about a program: a code, a sentence, a place, how to put it right, and the change that does. No rendering.

use crate::code::Code;
use crate::source::{Source, Span};

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// The program cannot be compiled or executed.
    Error,
    /// It can, but it is probably not what was meant.
    Warning,
    /// It is legal and may surprise.
    Note,
}

/// A place that helps to understand a diagnostic, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// What there is to see.
    pub message: String,
}

/// Changes of the sources that together put a problem right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Suggestion {
    /// What they do, as the title of a menu entry.
    pub title: String,
    /// The changes, none inside another.
    pub edits: Vec<Edit>,
}

/// One change of a source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// What is replaced; nothing but a place to insert at, if it is empty.
    pub span: Span,
    /// What is written there instead.
    pub text: Text,
}

/// The text of a change.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Text {
    /// These words.
    Plain(String),
    /// What is written at another place, as it is written there.
    CopyOf(Span),
}

/// One message about one place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Its stable number.
    pub code: Code,
    /// How bad it is.
    pub severity: Severity,
    /// What is the matter, in one sentence.
    pub message: String,
    /// The place it is about.
    pub span: Span,
    /// The text at that place.
    pub primary: String,
    /// Other places worth a look.
    pub labels: Vec<Label>,
    /// What to do about it.
    pub help: Option<String>,
    /// Changes that do it, each by itself.
    pub suggestions: Vec<Suggestion>,
    /// The program that is missing, if that is the matter: another file may have it.
    pub lacks: Option<String>,
}

impl Diagnostic {
    /// An error.
    pub fn error(code: Code, span: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            code,
            severity: Severity::Error,
            message: message.into(),
            span,
            primary: String::new(),
            labels: Vec::new(),
            help: None,
            suggestions: Vec::new(),
            lacks: None,
        }
    }

    /// A warning.
    pub fn warning(code: Code, span: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(code, span, message) }
    }

    /// A note.
    pub fn note(code: Code, span: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic { severity: Severity::Note, ..Diagnostic::error(code, span, message) }
    }

    /// With this text at the primary place.
    pub fn primary(mut self, text: impl Into<String>) -> Diagnostic {
        self.primary = text.into();
        self
    }

    /// With another place worth a look.
    pub fn label(mut self, span: Span, message: impl Into<String>) -> Diagnostic {
        self.labels.push(Label { span, message: message.into() });
        self
    }

    /// With advice.
    pub fn help(mut self, text: impl Into<String>) -> Diagnostic {
        self.help = Some(text.into());
        self
    }

    /// With advice, if there is any.
    pub fn maybe_help(mut self, text: Option<String>) -> Diagnostic {
        self.help = text.or(self.help);
        self
    }

    /// About a program of this name that is missing.
    pub(crate) fn lacking(mut self, program: impl Into<String>) -> Diagnostic {
        self.lacks = Some(program.into());
        self
    }

    /// With changes that put it right.
    pub fn suggest(mut self, title: impl Into<String>, edits: impl IntoIterator<Item = Edit>) -> Diagnostic {
        self.suggestions.push(Suggestion { title: title.into(), edits: edits.into_iter().collect() });
        self
    }

    /// With the suggestion to write this at a place instead of what is there.
    pub fn change(self, span: Span, text: impl Into<String>) -> Diagnostic {
        let text = text.into();
        self.suggest(format!("Change to `{text}`"), [Edit::replace(span, text)])
    }

    /// With the suggestion to take out what is there.
    pub fn take_out(self, what: &str, span: Span) -> Diagnostic {
        self.suggest(format!("Take {what} out"), [Edit::replace(span, "")])
    }

    /// With what was probably meant at a place, if that is known, for advice and for a change.
    pub fn meant(self, span: Span, name: Option<impl Into<String>>) -> Diagnostic {
        let Some(name) = name.map(Into::into) else { return self };
        self.help(format!("Did you mean `{name}`?")).change(span, name)
    }

    /// The same for a name that may stand there as `#:name`, a keyword, a string or a symbol.
    pub fn designated(self, span: Span, name: Option<&str>) -> Diagnostic {
        let Some(name) = name else { return self };
        self.help(format!("Did you mean `{name}`?")).change(span, format!("#:{name}"))
    }
}

impl Edit {
    /// Writes this instead of what is there.
    pub fn replace(span: Span, text: impl Into<String>) -> Edit {
        Edit { span, text: Text::Plain(text.into()) }
    }

    /// Writes this before what is there.
    pub fn before(span: Span, text: impl Into<String>) -> Edit {
        Edit::replace(Span { end: span.start, ..span }, text)
    }

    /// Writes this after what is there.
    pub fn after(span: Span, text: impl Into<String>) -> Edit {
        Edit::replace(Span { start: span.end, ..span }, text)
    }

    /// Writes what is at the other place instead of what is at this one.
    pub fn copy(span: Span, from: Span) -> Edit {
        Edit { span, text: Text::CopyOf(from) }
    }

    /// What is written, given the sources.
    pub fn text<'a>(&'a self, sources: &'a [Source]) -> &'a str {
        match &self.text {
            Text::Plain(text) => text,
            Text::CopyOf(from) => sources.get(from.source as usize).map_or("", |source| source.slice(*from)),
        }
    }
}
