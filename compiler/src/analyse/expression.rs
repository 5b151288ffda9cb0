//! Numbers and arguments: names are resolved, and what does not depend on a variable is calculated.

use kirk_network::Bound;

use super::Variable;
use super::names::Names;
use super::problem::Problem;
use super::symbols::{SymbolKind, Uses};
use crate::ast::{self, AmountKind, Argument, Ident, Role, Value, ValueKind};
use crate::evaluate::{self, INFINITY};
use crate::nearest::nearest;
use crate::problem::Problems;
use crate::typed::{AmountValue, Expression, ExpressionKind};

/// The values of the named numbers, in the order of their definitions; `None` for what was wrong.
pub(super) type Numbers = Vec<Option<Bound>>;

/// Calculates the named numbers. As in Lisp, one may use those defined before it.
pub(super) fn named_numbers(
    program: &ast::Program,
    names: &Names,
    uses: &mut Uses,
    problems: &mut Problems,
) -> Numbers {
    let mut numbers = Numbers::new();
    for definition in &program.parameters {
        let home = &definition.home;
        let mut resolver = Resolver { names, numbers: &numbers, program, home, scope: &[], uses, problems };
        let expression = resolver.amount(&definition.value);
        numbers.push(match resolver.known(&expression, Role::Named) {
            AmountValue::Known(bound) => Some(bound),
            _ => None,
        });
    }
    numbers
}

/// Knows what the names in one place mean.
pub(super) struct Resolver<'a> {
    pub(super) names: &'a Names,
    pub(super) numbers: &'a Numbers,
    pub(super) program: &'a ast::Program,
    /// The package the place is in.
    pub(super) home: &'a str,
    /// The variables known there, from the outside in.
    pub(super) scope: &'a [Variable],
    pub(super) uses: &'a mut Uses,
    pub(super) problems: &'a mut Problems,
}

impl Resolver<'_> {
    /// A number with its names resolved.
    pub(super) fn amount(&mut self, written: &ast::Amount) -> Expression {
        let span = written.span;
        let kind = match &written.kind {
            AmountKind::Number(number) => ExpressionKind::Value(ValueKind::Number(*number)),
            AmountKind::Infinite => infinite(),
            AmountKind::Named(name) => self.name(name),
            AmountKind::Unit(_, unit, inner) => ExpressionKind::Scaled(*unit, Box::new(self.amount(inner))),
            AmountKind::Calculation(operator, parts) => {
                ExpressionKind::Calculated(*operator, parts.iter().map(|part| self.amount(part)).collect())
            }
            AmountKind::Error => ExpressionKind::Error,
        };
        self.folded(Expression { kind, span })
    }

    /// An argument with its names resolved.
    pub(super) fn argument(&mut self, written: &Argument) -> Expression {
        match written {
            Argument::Amount(amount) => self.amount(amount),
            Argument::Value(Value { kind: ValueKind::Name(package, name), span }) => {
                let ident = Ident { package: package.clone(), name: name.clone(), span: *span };
                Expression { kind: self.name(&ident), span: *span }
            }
            Argument::Value(value) => {
                Expression { kind: ExpressionKind::Value(value.kind.clone()), span: value.span }
            }
        }
    }

    /// The expression as a bound, if it is known by now.
    pub(super) fn known(&mut self, expression: &Expression, role: Role) -> AmountValue {
        match &expression.kind {
            ExpressionKind::Error => AmountValue::Error,
            ExpressionKind::Value(_) => match evaluate::bound(expression, &[], role) {
                Ok(bound) => AmountValue::Known(bound),
                Err(problem) => {
                    self.report(problem);
                    AmountValue::Error
                }
            },
            _ => AmountValue::Computed(Box::new(expression.clone())),
        }
    }

    pub(super) fn report(&mut self, problem: evaluate::Wrong) {
        if let Some(problem) = problem {
            self.problems.push(Problem::Amount(*problem));
        }
    }

    /// Calculates what depends on no variable.
    fn folded(&mut self, expression: Expression) -> Expression {
        let parts = match &expression.kind {
            ExpressionKind::Scaled(_, inner) => std::slice::from_ref(&**inner),
            ExpressionKind::Calculated(_, parts) => parts,
            _ => return expression,
        };
        let span = expression.span;
        let kind = if parts.iter().any(|part| matches!(part.kind, ExpressionKind::Error)) {
            ExpressionKind::Error
        } else if parts.iter().all(|part| matches!(part.kind, ExpressionKind::Value(_))) {
            match evaluate::evaluate(&expression, &[]) {
                Ok(value) => ExpressionKind::Value(value.kind),
                Err(problem) => {
                    self.report(problem);
                    ExpressionKind::Error
                }
            }
        } else {
            return expression;
        };
        Expression { kind, span }
    }

    fn name(&mut self, ident: &Ident) -> ExpressionKind {
        let mine = |known: &Variable| ident.package.is_none() && known.name == ident.name;
        if let Some(index) = self.scope.iter().rposition(mine) {
            self.uses.place(self.scope[index].symbol, ident.span);
            return ExpressionKind::Variable(index, ident.name.clone());
        }
        if self.names_agent(ident) {
            return ExpressionKind::Value(ValueKind::Name(None, ident.name.clone()));
        }
        let Some(index) = self.names.number(ident, self.home) else {
            self.unknown_name(ident);
            return ExpressionKind::Error;
        };
        self.uses.global(SymbolKind::NamedNumber(index), ident.span);
        match self.numbers.get(index) {
            Some(Some(Bound::Finite(number))) => ExpressionKind::Value(ValueKind::Number(*number)),
            Some(Some(Bound::Infinite)) => infinite(),
            Some(None) => ExpressionKind::Error,
            None => {
                let definition = self.program.parameters[index].name.span;
                self.problems.push(Problem::UsedBeforeDefined { name: ident.clone(), definition });
                ExpressionKind::Error
            }
        }
    }

    fn unknown_name(&mut self, ident: &Ident) {
        if self.problems.has_lost(&ident.name) {
            return;
        }
        let variables = self.scope.iter().map(|variable| variable.name.as_str());
        let numbers = self.program.parameters.iter().map(|p| p.name.name.as_str());
        let near = match ident.name.as_str() {
            "infinity" | "inf" | "infinite" | "unbounded" | "∞" => Some(":infinity"),
            _ => nearest(&ident.name, variables.chain(numbers)),
        };
        let unit = match ident.name.as_str() {
            "s" | "sec" | "secs" | "second" | "seconds" => Some("seconds"),
            "min" | "mins" | "minute" | "minutes" => Some("minutes"),
            "h" | "hour" | "hours" => Some("hours"),
            "day" | "days" => Some("days"),
            _ => None,
        };
        let name = ident.clone();
        self.problems.push(match (quoted_elsewhere(ident), unit) {
            (Some((mark, quoted)), _) => Problem::CurlyQuote { name, mark, quoted: quoted.to_string() },
            (None, Some(unit)) => Problem::StrayUnit { name, unit },
            (None, None) => Problem::UnknownName { name, near: near.map(str::to_string) },
        });
    }
}

/// A name with a mark before it that looks like the quote: the mark, and the name.
fn quoted_elsewhere(ident: &Ident) -> Option<(char, &str)> {
    let name = Some(ident.name.as_str()).filter(|_| ident.package.is_none())?;
    let mark = name.chars().next().filter(|c| "\u{2018}\u{2019}\u{b4}\u{2bc}\u{2032}".contains(*c))?;
    Some((mark, &name[mark.len_utf8()..])).filter(|(_, name)| !name.is_empty())
}

fn infinite() -> ExpressionKind {
    ExpressionKind::Value(ValueKind::Symbol(INFINITY.to_string()))
}
