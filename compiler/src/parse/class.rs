//! `(defclass name (super...) ((slot :option value...)...) ...)`.

use super::body::value;
use super::ident;
use super::problem::{Expected, Missing, Problem};
use crate::ast::{Class, Slot, Type};
use crate::form::{Form, FormKind};
use crate::nearest::nearest;
use crate::problem::Problems;

/// The options of a slot, of which some say nothing that matters here.
pub(crate) const SLOT_OPTIONS: [&str; 9] =
    ["initarg", "initform", "type", "reader", "accessor", "finalp", "documentation", "writer", "allocation"];

/// Parses a class definition.
pub(super) fn class(form: &Form, rest: &[Form], home: &str, problems: &mut Problems) -> Option<Class> {
    let [name, supers, slots, options @ ..] = rest else {
        problems.push(Problem::Missing { at: form.head(), what: Missing::PartsOfClass });
        return None;
    };
    let Some(name) = ident(name) else {
        problems.push(Problem::Unexpected { found: name, expected: Expected::ClassName });
        return None;
    };
    let mut class = Class { home: home.to_string(), name, supers: Vec::new(), slots: Vec::new() };
    for item in listed(supers, Expected::Superclasses, problems) {
        match ident(item) {
            Some(name) => class.supers.push(name),
            None if item.is_error() => {}
            None => problems.push(Problem::Unexpected { found: item, expected: Expected::Superclass }),
        }
    }
    for item in listed(slots, Expected::Slots, problems) {
        class.slots.extend(slot(item, problems));
    }
    for option in options {
        let keyword = option.list().and_then(|items| items.first()).and_then(Form::keyword);
        if !matches!(keyword, Some("documentation" | "default-initargs" | "metaclass")) && !option.is_error()
        {
            problems.push(Problem::Unexpected { found: option, expected: Expected::ClassOption });
        }
    }
    Some(class)
}

fn listed<'a>(form: &'a Form, expected: Expected, problems: &mut Problems) -> &'a [Form] {
    match form.list() {
        Some(items) => items,
        None => {
            if !form.is_error() && form.word() != Some("nil") {
                problems.push(Problem::Unexpected { found: form, expected });
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
            problems.push(Problem::Unexpected { found: name, expected: Expected::SlotName });
        }
        return None;
    };
    let mut slot =
        Slot { name, kind: None, accessors: Vec::new(), initform: None, finalp: false, documentation: None };
    while let Some((keyword, after)) = rest.split_first() {
        let Some(option) = keyword.keyword() else {
            if !keyword.is_error() {
                problems.push(Problem::Unexpected { found: keyword, expected: Expected::SlotOption });
            }
            rest = after;
            continue;
        };
        let Some((setting, after)) = after.split_first() else {
            problems.push(Problem::SlotOptionAlone { at: keyword.span, word: option });
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
                _ => {
                    problems.push(Problem::Unexpected { found: setting, expected: Expected::Documentation });
                }
            },
            _ if SLOT_OPTIONS.contains(&option) => {}
            _ => {
                let near = nearest(option, SLOT_OPTIONS);
                problems.push(Problem::SlotOption { at: keyword.span, word: option, near });
            }
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
                    problems.push(Problem::Unexpected { found: form, expected: Expected::Type });
                }
                return None;
            }
        },
    })
}
