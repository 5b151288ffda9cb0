//! What a text defines, for an outline of it.

use kirk_compiler::Span;

use crate::analysis::Analysis;

/// Something that is defined, with what is defined in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outline {
    /// Its name.
    pub name: String,
    /// What it is.
    pub kind: OutlineKind,
    /// More about it: parameters, a value.
    pub detail: String,
    /// The whole definition.
    pub whole: Span,
    /// Its name in it.
    pub selection: Span,
    /// What is defined in it.
    pub children: Vec<Outline>,
}

/// What may be defined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutlineKind {
    /// An activity.
    Primitive,
    /// A program with a body.
    Program,
    /// A named number.
    Number,
    /// A class.
    Class,
    /// A slot.
    Slot,
    /// A package.
    Package,
    /// A team.
    Team,
    /// An agent of it.
    Agent,
}

impl Outline {
    /// True if what is looked for occurs in its name, letter by letter in this order.
    pub fn is_like(&self, wanted: &str) -> bool {
        let mut name = self.name.chars();
        wanted.to_lowercase().chars().all(|wanted| name.any(|c| c == wanted))
    }
}

/// Everything a text defines, in source order.
pub fn outline(analysis: &Analysis) -> Vec<Outline> {
    let program = &analysis.program;
    let entry = |name: &kirk_compiler::ast::Ident, kind, detail: String| Outline {
        name: name.name.clone(),
        kind,
        detail,
        whole: top_level(analysis, name.span),
        selection: name.span,
        children: Vec::new(),
    };
    let mut found = Vec::new();
    let here = |name: &kirk_compiler::ast::Ident| analysis.is_here(name.span);
    found.extend(
        program
            .packages
            .iter()
            .filter(|it| here(&it.name))
            .map(|it| entry(&it.name, OutlineKind::Package, String::new())),
    );
    for number in program.parameters.iter().filter(|it| here(&it.name)) {
        let value = analysis.slice(number.value.span).to_string();
        found.push(entry(&number.name, OutlineKind::Number, value));
    }
    for class in program.classes.iter().filter(|it| here(&it.name)) {
        let mut outline = entry(&class.name, OutlineKind::Class, String::new());
        outline.children = class
            .slots
            .iter()
            .map(|slot| Outline {
                whole: slot.name.span,
                ..entry(&slot.name, OutlineKind::Slot, String::new())
            })
            .collect();
        found.push(outline);
    }
    for team in program.teams.iter().filter(|it| here(&it.name)) {
        let agent = |name: &kirk_compiler::ast::Ident| Outline {
            whole: name.span,
            ..entry(name, OutlineKind::Agent, String::new())
        };
        let children = team.agents.iter().map(agent).collect();
        found.push(Outline { children, ..entry(&team.name, OutlineKind::Team, String::new()) });
    }
    for program in program.programs.iter().filter(|it| here(&it.name)) {
        let kind = if program.primitive { OutlineKind::Primitive } else { OutlineKind::Program };
        let parameters: Vec<&str> = program.parameters.iter().map(|it| it.name.as_str()).collect();
        found.push(entry(&program.name, kind, parameters.join(" ")));
    }
    found.sort_by_key(|outline| outline.selection);
    found
}

/// The top-level form around a place.
pub(crate) fn top_level(analysis: &Analysis, place: Span) -> Span {
    let after = analysis.forms.partition_point(|form| form.span.start <= place.start);
    let form = analysis.forms[..after].last().filter(|form| place.end <= form.span.end);
    form.map_or(place, |form| form.span)
}
