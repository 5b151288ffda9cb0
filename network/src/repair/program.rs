//! The linear program: the cheapest amounts that keep some inequalities.
//!
//! It is solved in floating point, in seconds; so nothing it says is believed. Whoever uses it rounds, and asks for the verdict.

use std::collections::BTreeMap;

use good_lp::{Expression, ResolutionError, Solution, SolverModel, microlp, variable, variables};

use super::clause::Inequality;

/// An amount to choose.
pub(super) struct Column {
    /// What a microsecond costs.
    pub(super) weight: u64,
    /// The least and the greatest amount.
    pub(super) low: i64,
    pub(super) high: i64,
}

/// What came out.
pub(super) enum Outcome {
    /// The amounts, in microseconds, by knob.
    Optimum(BTreeMap<usize, f64>),
    Infeasible,
    /// The solver has lost its way among its numbers.
    Failed,
}

const MICROS: f64 = 1e6;

/// Costs differ by no more than this factor, as what is much less than the largest counts for nothing in floating point.
const MOST: f64 = 1e8;

/// The cheapest amounts of these knobs, with all else at nothing, that keep all of `rows`.
pub(super) fn solve(columns: &BTreeMap<usize, Column>, rows: &[&Inequality]) -> Outcome {
    if columns.is_empty() {
        return Outcome::Optimum(BTreeMap::new());
    }
    let mut variables = variables!();
    let heaviest = columns.values().map(|column| column.weight).max().unwrap_or(1) as f64;
    let mut cost = Expression::with_capacity(columns.len());
    let mut variable_of = BTreeMap::new();
    for (&knob, column) in columns {
        let (low, high) = (column.low as f64 / MICROS, column.high as f64 / MICROS);
        let amount = variables.add(variable().min(low).max(high));
        cost.add_mul((column.weight as f64 / heaviest).max(1.0 / MOST) * 1e3, amount);
        variable_of.insert(knob, amount);
    }
    let mut model = variables.minimise(cost).using(microlp);
    for row in rows {
        let mut sum = Expression::with_capacity(row.terms.len());
        for (knob, &factor) in &row.terms {
            if let Some(&amount) = variable_of.get(knob) {
                sum.add_mul(factor as f64, amount);
            }
        }
        model.add_constraint(sum.geq(row.least as f64 / MICROS));
    }
    match model.solve() {
        Ok(solution) => Outcome::Optimum(
            variable_of.iter().map(|(&knob, &amount)| (knob, solution.value(amount) * MICROS)).collect(),
        ),
        Err(ResolutionError::Infeasible) => Outcome::Infeasible,
        Err(_) => Outcome::Failed,
    }
}
