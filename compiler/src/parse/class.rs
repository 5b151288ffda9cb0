//! `(defclass name (super...) ((slot :option value...)...) ...)`.

use super::body::value;
use super::ident;
use super::slips::{expected, unexpected};
use crate::ast::{Class, Slot, Type};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::{Form, FormKind, clip};
use crate::nearest::nearest;
use crate::problem::Problems;
use crate::words::usage;

const SHAPE: &str = usage("defclass");
const SLOT_OPTIONS: [&str; 9] =
    ["initarg", "initform", "type", "reader", "accessor", "finalp", "documentation", "writer", "allocation"];

/// Parses a class definition.
pub(super) fn class(form: &Form, rest: &[Form], home: &str, problems: &mut Problems) -> Option<Class> {
    let [name, supers, slots, options @ ..] = rest else {
        problems.push(expected(form, "a class needs a name, its superclasses and its slots", SHAPE));
        return None;
    };
    let Some(name) = ident(name) else {
        problems.push(unexpected(name, "the name of the class", SHAPE));
        return None;
    };
    let mut class = Class { home: home.to_string(), name, supers: Vec::new(), slots: Vec::new() };
    for item in listed(supers, "a list of superclasses", problems) {
        match ident(item) {
            Some(name) => class.supers.push(name),
            None if item.is_error() => {}
            None => problems.push(unexpected(item, "the name of a class", SHAPE)),
        }
    }
    for item in listed(slots, "a list of slots", problems) {
        class.slots.extend(slot(item, problems));
    }
    for option in options {
        let keyword = option.list().and_then(|items| items.first()).and_then(Form::keyword);
        if !matches!(keyword, Some("documentation" | "default-initargs" | "metaclass")) && !option.is_error()
        {
            problems.push(unexpected(option, "an option such as `(:documentation ...)`", SHAPE));
        }
    }
    Some(class)
}

fn listed<'a>(form: &'a Form, wanted: &str, problems: &mut Problems) -> &'a [Form] {
    match form.list() {
        Some(items) => items,
        None => {
            if !form.is_error() && form.word() != Some("nil") {
                problems.push(unexpected(form, wanted, SHAPE));
            }
            &[]
        }
    }
}

fn slot(form: &Form, problems: &mut Problems) -> Option<Slot> {
    let (name, mut rest) = match form.list().and_then(|items| items.split_first()) {
        Some((name, rest)) => (name, rest),
        None => (form, &[][..]),
    };
    let Some(name) = ident(name) else {
        if !name.is_error() {
            problems.push(unexpected(name, "the name of a slot", SHAPE));
        }
        return None;
    };
    let mut slot =
        Slot { name, kind: None, accessors: Vec::new(), initform: None, finalp: false, documentation: None };
    while let Some((keyword, after)) = rest.split_first() {
        let Some(option) = keyword.keyword() else {
            if !keyword.is_error() {
                problems.push(unexpected(
                    keyword,
                    "a slot option",
                    "Slot options are keywords, each followed by its value.",
                ));
            }
            rest = after;
            continue;
        };
        let Some((setting, after)) = after.split_first() else {
            problems.push(
                Diagnostic::error(
                    Code::WrongShape,
                    keyword.span,
                    format!("`:{}` has no value", clip(option)),
                )
                .primary("a value was expected after this option"),
            );
            break;
        };
        rest = after;
        match option {
            "type" => slot.kind = kind(setting, problems),
            "reader" | "accessor" => slot.accessors.extend(ident(setting)),
            "initform" => slot.initform = Some(value(setting)),
            "finalp" => slot.finalp = setting.word() != Some("nil"),
            "documentation" => match &setting.kind {
                FormKind::String(text) => slot.documentation = Some(text.clone()),
                _ => problems.push(unexpected(
                    setting,
                    "a string",
                    "Documentation is text in quotation marks.",
                )),
            },
            _ if SLOT_OPTIONS.contains(&option) => {}
            _ => problems.push(
                Diagnostic::warning(
                    Code::UnknownSlotOption,
                    keyword.span,
                    format!("a slot has no option `:{}`", clip(option)),
                )
                .primary("left out, with its value")
                .help(format!("The slot options are :{}.", SLOT_OPTIONS.join(", :")))
                .meant(keyword.span, nearest(option, SLOT_OPTIONS).map(|near| format!(":{near}"))),
            ),
        }
    }
    Some(slot)
}

fn kind(form: &Form, problems: &mut Problems) -> Option<Type> {
    let form = match &form.kind {
        FormKind::Quote(inner) => inner,
        _ => form,
    };
    Some(match form.call() {
        Some(("member", values)) => Type::Member(values.iter().map(value).collect()),
        Some(("eql", [one])) => Type::Member(vec![value(one)]),
        Some(("or", types)) => Type::Or(types.iter().filter_map(|form| kind(form, problems)).collect()),
        Some(_) => Type::Anything,
        None => match ident(form) {
            Some(name) => Type::Named(name),
            None => {
                if !form.is_error() {
                    problems.push(unexpected(form, "a type", "A type is a name or `(member value...)`."));
                }
                return None;
            }
        },
    })
}
