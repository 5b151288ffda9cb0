//! Numbers and arguments: names are resolved, and what does not depend on a variable is calculated.

use kirk_network::Bound;

use super::Variable;
use super::names::Names;
use super::symbols::{SymbolKind, Uses};
use crate::ast::{self, AmountKind, Argument, Ident, Value, ValueKind};
use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::evaluate::{self, INFINITY};
use crate::form::clip;
use crate::nearest::nearest;
use crate::parse::suffixed;
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
        numbers.push(match resolver.known(&expression, "this value") {
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

    /// The expression as a bound called `what`, if it is known by now.
    pub(super) fn known(&mut self, expression: &Expression, what: &str) -> AmountValue {
        match &expression.kind {
            ExpressionKind::Error => AmountValue::Error,
            ExpressionKind::Value(_) => match evaluate::bound(expression, &[], what) {
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
            self.problems.push(*problem);
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
                let name = clip(&ident.name);
                let message = format!("`{name}` is used before it is defined");
                self.problems.push(
                    Diagnostic::error(Code::UnknownName, ident.span, message)
                        .primary("not known yet")
                        .label(self.program.parameters[index].name.span, "defined only here")
                        .help("A named number may be calculated from those above it: move this one up."),
                );
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
        if let Some((mark, name)) = quoted_elsewhere(&ident.name).filter(|_| ident.package.is_none()) {
            self.problems.push(curly_quote(ident, mark, name));
            return;
        }
        let problem = Diagnostic::error(Code::UnknownName, ident.span, format!("nothing is called `{}`", clip(&ident.name)))
            .primary("neither a parameter or variable here nor a named number")
            .help("A value is a number, a string, `t`, `nil`, a parameter, a name from `let`, `dotimes` or `defparameter`. A symbol is quoted: `'name`.");
        self.problems.push(match unit {
            Some(unit) => {
                problem.help(format!("A unit stands before its number, in a list with it: `({unit} 5)`."))
            }
            None => {
                let problem = suffixed(problem, ident.span, &ident.name);
                problem.meant(ident.span, near.map(|near| ident.with_name(near)))
            }
        });
    }
}

/// A name with a mark before it that looks like the quote: the mark, and the name.
fn quoted_elsewhere(name: &str) -> Option<(char, &str)> {
    let mark = name.chars().next().filter(|c| "\u{2018}\u{2019}\u{b4}\u{2bc}\u{2032}".contains(*c))?;
    Some((mark, &name[mark.len_utf8()..])).filter(|(_, name)| !name.is_empty())
}

fn curly_quote(ident: &Ident, mark: char, name: &str) -> Diagnostic {
    let message = format!("the mark before `{}` is no quote: it is U+{:04X}", clip(name), u32::from(mark));
    Diagnostic::error(Code::UnknownName, ident.span, message)
        .primary("read as a name that begins with this mark")
        .help("A symbol is quoted with the straight apostrophe of the keyboard, U+0027. Word processors change it.")
        .change(ident.span, format!("'{name}"))
}

fn infinite() -> ExpressionKind {
    ExpressionKind::Value(ValueKind::Symbol(INFINITY.to_string()))
}
