//! S-expressions with their places: what the reader hands to the parser.

use crate::source::Span;

/// An s-expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Form {
    /// From its first to its last character.
    pub span: Span,
    /// What it is.
    pub kind: FormKind,
}

/// What an s-expression may be.
#[derive(Clone, Debug, PartialEq)]
pub enum FormKind {
    /// `( ... )`.
    List(Vec<Form>),
    /// A name, in lower case.
    Symbol(Symbol),
    /// `:name`, without the colon, in lower case.
    Keyword(String),
    /// `#:name`, without the mark, in lower case.
    Uninterned(String),
    /// A number as written, without a leading `+`, in lower case.
    Number(String),
    /// The contents of a string, escapes resolved.
    String(String),
    /// `'form`.
    Quote(Box<Form>),
    /// Something that could not be read; it has been reported.
    Error,
}

/// A name with the package it was written with, both in lower case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// What stands before the `:`, if anything does.
    pub package: Option<String>,
    /// The name.
    pub name: String,
}

impl Form {
    /// The elements, if this is a list.
    pub fn list(&self) -> Option<&[Form]> {
        match &self.kind {
            FormKind::List(items) => Some(items),
            _ => None,
        }
    }

    /// The name, if this is a symbol.
    pub fn symbol(&self) -> Option<&Symbol> {
        match &self.kind {
            FormKind::Symbol(symbol) => Some(symbol),
            _ => None,
        }
    }

    /// The name, if this is a symbol of the language itself: without a package, or with one of Lisp's or RMPL's.
    pub fn word(&self) -> Option<&str> {
        let symbol = self.symbol()?;
        let ours = match symbol.package.as_deref() {
            None => true,
            Some(package) => matches!(package, "cl" | "common-lisp" | "rmpl") || package.starts_with("rmpl/"),
        };
        ours.then_some(symbol.name.as_str())
    }

    /// The word this list begins with, and its other elements.
    pub fn call(&self) -> Option<(&str, &[Form])> {
        let (first, rest) = self.list()?.split_first()?;
        Some((first.word()?, rest))
    }

    /// The keyword, if this is one.
    pub fn keyword(&self) -> Option<&str> {
        match &self.kind {
            FormKind::Keyword(name) => Some(name),
            _ => None,
        }
    }

    /// The name a symbol, keyword, `#:name` or string designates, as packages and such are named.
    pub fn designator(&self) -> Option<String> {
        match &self.kind {
            FormKind::Symbol(symbol) if symbol.package.is_none() => Some(symbol.name.clone()),
            FormKind::Keyword(name) | FormKind::Uninterned(name) => Some(name.clone()),
            FormKind::String(text) => Some(text.to_lowercase()),
            _ => None,
        }
    }

    /// True if reading this failed, which has been reported.
    pub fn is_error(&self) -> bool {
        self.kind == FormKind::Error
    }

    /// The place of the first element of a list, which says what the list is.
    pub fn head(&self) -> Span {
        self.list().and_then(|items| items.first()).map_or(self.span, |first| first.span)
    }
}

/// The form as Lisp text on one line, for messages and for values that are only carried along.
pub fn write(form: &Form) -> String {
    let mut text = String::new();
    write_into(form, &mut text);
    text
}

fn write_into(form: &Form, text: &mut String) {
    match &form.kind {
        FormKind::List(items) => {
            text.push('(');
            for (index, item) in items.iter().enumerate() {
                if index > 0 {
                    text.push(' ');
                }
                write_into(item, text);
            }
            text.push(')');
        }
        FormKind::Symbol(symbol) => {
            if let Some(package) = &symbol.package {
                text.push_str(package);
                text.push(':');
            }
            text.push_str(&symbol.name);
        }
        FormKind::Keyword(name) => text.extend([":", name]),
        FormKind::Uninterned(name) => text.extend(["#:", name]),
        FormKind::Number(number) => text.push_str(number),
        FormKind::String(contents) => {
            text.push('"');
            for c in contents.chars() {
                if matches!(c, '"' | '\\') {
                    text.push('\\');
                }
                text.push(c);
            }
            text.push('"');
        }
        FormKind::Quote(inner) => {
            text.push('\'');
            write_into(inner, text);
        }
        FormKind::Error => text.push_str("#<unreadable>"),
    }
}

/// A word short enough for a message.
pub fn clip(word: &str) -> String {
    if word.chars().count() <= 60 {
        word.to_string()
    } else {
        word.chars().take(57).chain("...".chars()).collect()
    }
}

/// The form on one line, short enough for a message.
pub(crate) fn text_of(form: &Form) -> String {
    clip(&write(form))
}
