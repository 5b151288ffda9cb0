//! Classes, and whether conditions and effects fit them.

use super::Analyser;
use super::names::Names;
use super::symbols::{SymbolKind, Uses};
use crate::ast::{Class, Condition, Ident, Program, Slot, SlotOf, Type, Value, ValueKind};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::form::{Form, FormKind, clip, write};
use crate::nearest::nearest;
use crate::problem::Problems;
use crate::source::Span;

/// Types of Lisp that kirk does not look into.
const LISP_TYPES: [&str; 24] = [
    "t",
    "integer",
    "fixnum",
    "number",
    "real",
    "rational",
    "ratio",
    "float",
    "single-float",
    "double-float",
    "string",
    "simple-string",
    "symbol",
    "keyword",
    "boolean",
    "null",
    "list",
    "cons",
    "sequence",
    "vector",
    "array",
    "function",
    "character",
    "atom",
];

/// Checks the class definitions.
pub(super) fn check(program: &Program, names: &Names, uses: &mut Uses, problems: &mut Problems) {
    for class in &program.classes {
        for parent in &class.supers {
            match names.class(parent, &class.home) {
                Some(index) => uses.global(SymbolKind::Class(index), parent.span),
                None if parent.name == "standard-object" => {}
                None => {
                    let known = program.classes.iter().map(|class| class.name.name.as_str());
                    problems.push(
                        Diagnostic::error(
                            Code::UnknownClass,
                            parent.span,
                            format!("the class `{}` is not defined", clip(&parent.name)),
                        )
                        .primary("extended here")
                        .meant(parent.span, nearest(&parent.name, known).map(|near| parent.with_name(near))),
                    );
                }
            }
        }
        for slot in &class.slots {
            check_slot(class, slot, program, names, uses, problems);
        }
    }
    circles(program, names, problems);
}

impl<'a> Analyser<'a> {
    /// Checks a condition or effect of the program at hand, and notes that kirk does not plan with it.
    pub(super) fn condition(&mut self, condition: &Condition) {
        let name = &self.definition.name;
        self.problems.push(
            Diagnostic::note(
                Code::NotPlannedWith,
                name.span,
                format!("the conditions and effects of `{}` are not planned with", clip(&name.name)),
            )
            .primary("its conditions are read and checked, and kept with the episode")
            .help("Kirk does not plan: it takes for granted that the program as written brings about what it requires."),
        );
        let mut open = vec![condition];
        while let Some(condition) = open.pop() {
            match condition {
                Condition::And(parts) | Condition::Or(parts) => open.extend(parts.iter().rev()),
                Condition::Not(part)
                | Condition::AtStart(part)
                | Condition::AtEnd(part)
                | Condition::OverAll(part) => {
                    open.push(part);
                }
                Condition::Holds(slot) => {
                    self.slots(slot);
                }
                Condition::Equal(slot, value) => {
                    let slots = self.slots(slot);
                    self.object(value, true);
                    if let Some(first) = slots.first()
                        && !slots.iter().any(|slot| slot.kind.as_ref().is_none_or(|kind| fits(kind, value)))
                    {
                        self.problems.push(wrong_type(first, value));
                    }
                }
            }
        }
    }

    /// The slots an accessor may read; reports an accessor no class has.
    fn slots(&mut self, slot: &SlotOf) -> Vec<&'a Slot> {
        let program = self.program;
        let all = || program.classes.iter().flat_map(|class| &class.slots);
        let wanted = &slot.accessor.name;
        let found: Vec<&Slot> =
            all().filter(|slot| slot.accessors.iter().any(|name| name.name == *wanted)).collect();
        self.uses.accessor(&slot.accessor);
        if found.is_empty() && !self.problems.has_lost(wanted) {
            let known = all().flat_map(|slot| &slot.accessors).map(|name| name.name.as_str());
            let slot_itself = all().find(|slot| slot.name.name == *wanted);
            let problem = Diagnostic::error(
                Code::UnknownAccessor,
                slot.accessor.span,
                format!("no class has an accessor `{}`", clip(wanted)),
            )
            .primary("not the `:reader` or `:accessor` of any slot");
            self.problems.push(match slot_itself {
                Some(_) => {
                    problem.help("There is a slot of this name, but it has no `:reader` or `:accessor`.")
                }
                None => {
                    let near = nearest(wanted, known).map(|near| slot.accessor.with_name(near));
                    problem.meant(slot.accessor.span, near)
                }
            });
        }
        self.object(&slot.object, false);
        found
    }

    /// What a name in a condition means: a parameter; as a value also a named number.
    fn object(&mut self, object: &Value, is_value: bool) {
        let ValueKind::Name(package, name) = &object.kind else { return };
        let ident = Ident { package: package.clone(), name: name.clone(), span: object.span };
        let parameter = self.scope.iter().find(|parameter| parameter.name == *name);
        let number = self.names.number(&ident, &self.definition.home);
        match (parameter, number) {
            (Some(parameter), _) if package.is_none() => self.uses.place(parameter.symbol, object.span),
            (_, Some(number)) => self.uses.global(SymbolKind::NamedNumber(number), object.span),
            _ => {}
        }
        let known = parameter.is_some() || is_value && number.is_some();
        if !known && (is_value || package.is_none()) {
            let problem = self.unknown(object.span, name);
            self.problems.push(problem);
        }
    }

    fn unknown(&self, span: Span, name: &str) -> Diagnostic {
        let definition = self.definition;
        let parameters = definition.parameters.iter().map(|parameter| parameter.name.as_str());
        Diagnostic::error(Code::UnknownName, span, format!("nothing is called `{}`", clip(name)))
            .primary(format!("not a parameter of `{}`", clip(&definition.name.name)))
            .meant(span, nearest(name, parameters))
    }
}

/// Reports every class that extends itself, directly or through others: each circle once.
fn circles(program: &Program, names: &Names, problems: &mut Problems) {
    #[derive(Clone, Copy, PartialEq)]
    enum State {
        New,
        OnTheWalk,
        Done,
    }
    let mut state = vec![State::New; program.classes.len()];
    for start in 0..program.classes.len() {
        let mut walk: Vec<(usize, usize)> = Vec::new();
        if state[start] == State::New {
            state[start] = State::OnTheWalk;
            walk.push((start, 0));
        }
        while let Some((class, next)) = walk.last_mut() {
            let here = &program.classes[*class];
            let Some(parent) = here.supers.get(*next) else {
                state[*class] = State::Done;
                walk.pop();
                continue;
            };
            *next += 1;
            let Some(target) = names.class(parent, &here.home) else { continue };
            if state[target] == State::New {
                state[target] = State::OnTheWalk;
                walk.push((target, 0));
            }
            if state[target] == State::Done || walk.last().is_some_and(|(_, next)| *next == 0) {
                continue;
            }
            let from = walk.iter().position(|(class, _)| *class == target).unwrap_or(0);
            let circle = walk[from..].iter().map(|(class, _)| &program.classes[*class].name);
            let mut path: Vec<String> = circle.clone().take(8).map(|name| clip(&name.name)).collect();
            path.push(clip(&program.classes[target].name.name));
            let message = format!("the class `{}` extends itself", path[0]);
            let problem = Diagnostic::error(Code::CircularClass, parent.span, message)
                .primary("this closes the circle")
                .help(format!("{}: take one of the superclasses out.", path.join(" -> ")));
            problems.push(
                circle.take(8).fold(problem, |problem, name| problem.label(name.span, "on the circle")),
            );
        }
    }
}

fn check_slot(
    class: &Class,
    slot: &Slot,
    program: &Program,
    names: &Names,
    uses: &mut Uses,
    problems: &mut Problems,
) {
    let mut open: Vec<&Type> = slot.kind.iter().collect();
    while let Some(kind) = open.pop() {
        match kind {
            Type::Or(kinds) => open.extend(kinds.iter().rev()),
            Type::Named(name) => match names.class(name, &class.home) {
                Some(index) => uses.global(SymbolKind::Class(index), name.span),
                None if LISP_TYPES.contains(&name.name.as_str()) => {}
                None => {
                    let classes = program.classes.iter().map(|class| class.name.name.as_str());
                    let known = LISP_TYPES.into_iter().chain(classes);
                    problems.push(
                        Diagnostic::warning(
                            Code::UnknownType,
                            name.span,
                            format!("`{}` is not a type kirk knows", clip(&name.name)),
                        )
                        .primary("values of this slot are not checked")
                        .meant(name.span, nearest(&name.name, known).map(|near| name.with_name(near))),
                    );
                }
            },
            Type::Member(_) | Type::Anything => {}
        }
    }
    if let (Some(kind), Some(value)) = (&slot.kind, &slot.initform)
        && !fits(kind, value)
    {
        problems.push(wrong_type(slot, value));
    }
}

/// False if the value is certainly not of the type.
fn fits(kind: &Type, value: &Value) -> bool {
    let known = |value: &Value| !matches!(value.kind, ValueKind::Name(..) | ValueKind::Other(_));
    if !known(value) {
        return true;
    }
    match kind {
        Type::Member(values) => {
            values.iter().any(|other| other.kind == value.kind || !known(other) && same_name(other, value))
        }
        Type::Or(kinds) => kinds.is_empty() || kinds.iter().any(|kind| fits(kind, value)),
        Type::Named(name) => match name.name.as_str() {
            "boolean" => matches!(value.kind, ValueKind::True | ValueKind::Nil),
            "null" => value.kind == ValueKind::Nil,
            "string" | "simple-string" => matches!(value.kind, ValueKind::Text(_)),
            "integer" | "fixnum" => {
                matches!(value.kind, ValueKind::Number(number) if number.as_micros() % 1_000_000 == 0)
            }
            "number" | "real" | "rational" | "float" | "single-float" | "double-float" => {
                matches!(value.kind, ValueKind::Number(_))
            }
            "keyword" | "symbol" => {
                matches!(value.kind, ValueKind::Symbol(_) | ValueKind::True | ValueKind::Nil)
            }
            _ => true,
        },
        Type::Anything => true,
    }
}

/// In `(member a b)` the symbols stand unquoted.
fn same_name(member: &Value, value: &Value) -> bool {
    matches!((&member.kind, &value.kind), (ValueKind::Name(_, a), ValueKind::Symbol(b)) if a == b)
}

fn wrong_type(slot: &Slot, value: &Value) -> Diagnostic {
    let allowed = match &slot.kind {
        Some(Type::Member(values)) => {
            let shown: Vec<String> = values.iter().take(12).map(|value| show(&value.kind)).collect();
            format!("one of {}", shown.join(", "))
        }
        Some(Type::Named(name)) => format!("a value of type `{}`", clip(&name.name)),
        _ => "a value of another type".to_string(),
    };
    let near = match (&slot.kind, &value.kind) {
        (Some(Type::Member(values)), ValueKind::Text(text)) => {
            let texts = values.iter().filter_map(|value| match &value.kind {
                ValueKind::Text(text) => Some(text.as_str()),
                _ => None,
            });
            nearest(text, texts)
        }
        _ => None,
    };
    let message = format!("the slot `{}` cannot be {}", clip(&slot.name.name), show(&value.kind));
    let problem = Diagnostic::error(Code::WrongType, value.span, message)
        .primary(format!("{allowed} was expected"))
        .label(slot.name.span, "the slot is defined here");
    match near.map(|near| write(&Form { span: value.span, kind: FormKind::String(near.to_string()) })) {
        Some(near) => problem.help(format!("Did you mean {near}?")).change(value.span, near),
        None => problem,
    }
}

fn show(kind: &ValueKind) -> String {
    match kind {
        ValueKind::Number(number) => number.to_string(),
        ValueKind::Text(text) => format!("\"{}\"", clip(text)),
        ValueKind::True => "t".to_string(),
        ValueKind::Nil => "nil".to_string(),
        ValueKind::Symbol(name) | ValueKind::Name(_, name) | ValueKind::Other(name) => clip(name),
    }
}
