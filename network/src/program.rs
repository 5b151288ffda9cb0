//! The linear program: the cheapest amounts that keep some inequalities.
//!
//! What repairs are made of, and the promises that agents of a team make one another.
//! It is solved in floating point, in seconds; so nothing it says is believed. Whoever uses it rounds, and asks for the verdict.

use std::collections::BTreeMap;

use good_lp::{Expression, ResolutionError, Solution, SolverModel, microlp, variable, variables};

/// `sum of factor * amount >= least`, for amounts by their numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inequality {
    /// The factors.
    pub terms: BTreeMap<usize, i64>,
    /// What the sum is at least.
    pub least: i128,
}

impl Inequality {
    /// By how much it is violated; not positive if it holds. An amount that is not given is 0.
    pub fn lacks(&self, amounts: &BTreeMap<usize, i64>) -> i128 {
        let amount = |number: &usize| amounts.get(number).copied().unwrap_or(0);
        let sum: i128 =
            self.terms.iter().map(|(number, factor)| i128::from(*factor) * i128::from(amount(number))).sum();
        self.least - sum
    }
}

/// An amount to choose.
pub struct Column {
    /// What a microsecond costs.
    pub weight: u64,
    /// The least amount.
    pub low: i64,
    /// The greatest amount.
    pub high: i64,
}

/// What came out.
pub enum Optimized {
    /// The amounts, in microseconds, by number.
    Optimum(BTreeMap<usize, f64>),
    /// There are none.
    Infeasible,
    /// The solver has lost its way among its numbers.
    Failed,
}

const MICROS: f64 = 1e6;

/// Costs differ by no more than this factor, as what is much less than the largest counts for nothing in floating point.
const MOST: f64 = 1e8;

/// The cheapest amounts of these, with all else at nothing, that keep all of `rows`.
pub fn solve(columns: &BTreeMap<usize, Column>, rows: &[&Inequality]) -> Optimized {
    if columns.is_empty() {
        return Optimized::Optimum(BTreeMap::new());
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
        Ok(solution) => Optimized::Optimum(
            variable_of.iter().map(|(&knob, &amount)| (knob, solution.value(amount) * MICROS)).collect(),
        ),
        Err(ResolutionError::Infeasible) => Optimized::Infeasible,
        Err(_) => Optimized::Failed,
    }
}
