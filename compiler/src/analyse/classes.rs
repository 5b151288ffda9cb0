//! Classes, and whether conditions and effects fit them.

use super::Analyser;
use super::names::Names;
use super::problem::{Allowed, MOST_TOLD, MOST_VALUES, Problem};
use super::symbols::{SymbolKind, Uses};
use crate::ast::{Class, Condition, Ident, Program, Slot, SlotOf, Type, Value, ValueKind};
use crate::nearest::nearest;
use crate::problem::Problems;

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
                    let near = nearest(&parent.name, known).map(str::to_string);
                    problems.push(Problem::UnknownClass { name: parent.clone(), near });
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
        self.problems.push(Problem::NotPlannedWith { program: self.definition.name.clone() });
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
            self.problems.push(Problem::UnknownAccessor {
                name: slot.accessor.clone(),
                is_slot: all().any(|slot| slot.name.name == *wanted),
                near: nearest(wanted, known).map(str::to_string),
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
            let definition = self.definition;
            let parameters = definition.parameters.iter().map(|parameter| parameter.name.as_str());
            self.problems.push(Problem::UnknownParameter {
                name: name.clone(),
                span: object.span,
                program: definition.name.clone(),
                near: nearest(name, parameters).map(str::to_string),
            });
        }
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
            let circle = walk[from..].iter().map(|(class, _)| program.classes[*class].name.clone());
            problems
                .push(Problem::CircularClass { circle: circle.take(MOST_TOLD).collect(), at: parent.span });
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
                    let near = nearest(&name.name, known).map(str::to_string);
                    problems.push(Problem::UnknownType { name: name.clone(), near });
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
                matches!(value.kind, ValueKind::Number(number) if number.whole_seconds().is_some())
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

fn wrong_type(slot: &Slot, value: &Value) -> Problem {
    let (allowed, near) = match &slot.kind {
        Some(Type::Member(values)) => {
            let near = match &value.kind {
                ValueKind::Text(text) => nearest(text, values.iter().filter_map(text_of)).map(str::to_string),
                _ => None,
            };
            (Allowed::OneOf(values.iter().take(MOST_VALUES).map(|value| value.kind.clone()).collect()), near)
        }
        Some(Type::Named(name)) => (Allowed::OfType(name.clone()), None),
        _ => (Allowed::Other, None),
    };
    Problem::WrongType { slot: slot.name.clone(), allowed, value: value.clone(), near }
}

fn text_of(value: &Value) -> Option<&str> {
    match &value.kind {
        ValueKind::Text(text) => Some(text),
        _ => None,
    }
}
