//! A plant with one input: its responses by substitution along a subdiagonal.

use super::control::SeriesControl;
use crate::balance::balance;
use crate::complex::Complex;
use crate::error::LtiError;
use crate::matrix::Matrix;
use crate::sampled::quick::{hessenberg, hessenberg_eigenvalues, quick_eigenvalues};

/// Vectors up to this length are kept without an allocation.
const SHORT: usize = 12;

/// A Hessenberg matrix whose first state alone hears the input, in $\zeta = z - 1$, and two outputs.
///
/// $$ (\zeta I - H) x = d e_1, \quad d = \det(\zeta I - H), \quad c (z I - A)^{-1} b = \frac{c x}{d} $$
///
/// From a known last entry of x each equation but the first gives the entry before, and the first gives d: no
/// division by anything that depends on ζ.
///
/// # Source
/// M. A. Hyman, Eigenvalues and eigenvectors of general matrices, ACM national conference (1957); its rounding: J. H.
/// Wilkinson, The Algebraic Eigenvalue Problem, Oxford (1965), chapter 7.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Chain {
    h: Matrix,
    /// One over the entry left of the diagonal, for each row but the first.
    steps: Vec<f64>,
    /// The last entry of x.
    last: f64,
    /// The output that is fed back as it is, times the input's entry.
    fixed: Vec<f64>,
    /// The output that the controller answers, times the input's entry.
    measured: Vec<f64>,
    /// Poles less 1 that the input does not reach: those of every loop.
    hidden: Vec<Complex>,
}

/// What x gives at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Parts {
    pub(super) fixed: Complex,
    pub(super) measured: Complex,
    pub(super) under: Complex,
}

/// Rows of the outputs, then the column of the input, in the matrix that is turned as a whole.
const FIXED: usize = 0;
const MEASURED: usize = 1;
const INPUT: usize = 2;
const STATES: usize = 3;

impl Chain {
    /// From parts whose shapes agree.
    ///
    /// # Errors
    /// Poles that the input does not reach and that are not found.
    pub(super) fn new(
        a: &Matrix,
        b: &[f64],
        [fixed, measured]: [&[f64]; 2],
    ) -> Result<Self, LtiError> {
        let order = a.rows();
        let mut system =
            Matrix::from_function(STATES + order, STATES + order, |row, column| {
                match (row, row.checked_sub(STATES), column.checked_sub(STATES)) {
                    (FIXED, _, Some(state)) => fixed[state],
                    (MEASURED, _, Some(state)) => measured[state],
                    (_, Some(to), Some(from)) if to == from => a.at(to, from) - 1.0,
                    (_, Some(to), Some(from)) => a.at(to, from),
                    (_, Some(to), None) if column == INPUT => b[to],
                    _ => 0.0,
                }
            });
        // What turns the states turns outputs and input too; without a column or a row of their own they keep units.
        balance(&mut system);
        let system = hessenberg(&system);
        let state = |row: usize, column: usize| system.at(STATES + row, STATES + column);
        let reached = (1..order).find(|&row| is_cut(&state, row)).unwrap_or(order);
        let rest = order - reached;
        let rest =
            Matrix::from_function(rest, rest, |row, column| state(reached + row, reached + column));
        let entry = system.at(STATES, INPUT);
        let output = |row: usize| {
            (0..reached).map(|column| entry * system.at(row, STATES + column)).collect()
        };
        let below = || (1..reached).map(|row| state(row, row - 1));
        Ok(Self {
            steps: below().map(|entry| 1.0 / entry).collect(),
            last: below().product(),
            fixed: output(FIXED),
            measured: output(MEASURED),
            hidden: quick_eigenvalues(&rest)?,
            h: Matrix::from_function(reached, reached, state),
        })
    }

    /// True if nothing over- or underflows.
    pub(super) fn is_sound(&self) -> bool {
        self.last.is_normal() && self.steps.iter().all(|step| step.is_normal())
    }

    /// Poles less 1 that are the same in every loop.
    pub(super) fn hidden(&self) -> &[Complex] {
        &self.hidden
    }

    pub(super) fn order(&self) -> usize {
        self.h.rows()
    }

    /// Poles of the plant, less 1.
    ///
    /// # Errors
    /// As [`eigenvalues`](crate::eigenvalues()).
    pub(super) fn poles(&self) -> Result<Vec<Complex>, LtiError> {
        quick_eigenvalues(&self.h)
    }

    /// Poles of the loop closed by a controller with these coefficients, less 1; `None` if they are not found.
    ///
    /// With the controller's input spread over its states, and its last state before the plant's first one, the
    /// whole is a Hessenberg matrix.
    pub(super) fn closed_poles(
        &self,
        control: &SeriesControl,
        coefficients: &[f64],
    ) -> Option<Vec<Complex>> {
        let (count, order) = (control.poles().len(), self.order());
        let closed = Matrix::from_function(count + order, count + order, |row, column| {
            // The controller's poles from the last one to the first, then the plant.
            let own = row.checked_sub(count);
            match (own, column.checked_sub(count)) {
                (Some(0), Some(state)) => {
                    self.h.at(0, state) - self.fixed[state] - coefficients[0] * self.measured[state]
                }
                (Some(0), None) if column + 1 == count => -1.0,
                (Some(to), Some(from)) => self.h.at(to, from),
                (None, Some(state)) => coefficients[count - row] * self.measured[state],
                (None, None) if row == column => control.poles()[count - 1 - row],
                (None, None) if row == column + 1 => 1.0,
                _ => 0.0,
            }
        });
        hessenberg_eigenvalues(closed)
    }

    /// Outputs and d at a place.
    pub(super) fn at(&self, zeta: Complex) -> Parts {
        let order = self.order();
        let zero = Complex::new(0.0, 0.0);
        if order <= SHORT {
            self.substitute(zeta, &mut [zero; SHORT][..order])
        } else {
            self.substitute(zeta, &mut vec![zero; order])
        }
    }

    fn substitute(&self, zeta: Complex, x: &mut [Complex]) -> Parts {
        let zero = Complex::new(0.0, 0.0);
        let mut parts = Parts { fixed: zero, measured: zero, under: zero };
        let mut entry = Complex::new(self.last, 0.0);
        for row in (0..x.len()).rev() {
            x[row] = entry;
            parts.fixed += entry * self.fixed[row];
            parts.measured += entry * self.measured[row];
            let mut sum = zeta * entry;
            for (coefficient, value) in self.h.row(row)[row..].iter().zip(&x[row..]) {
                sum -= value * coefficient;
            }
            match row.checked_sub(1) {
                Some(before) => entry = sum * self.steps[before],
                None => parts.under = sum,
            }
        }
        parts
    }
}

/// Whether the entry left of the diagonal is no more than rounding of its neighbours on it.
fn is_cut(state: &impl Fn(usize, usize) -> f64, row: usize) -> bool {
    let neighbours = state(row, row).abs() + state(row - 1, row - 1).abs();
    state(row, row - 1).abs() <= f64::EPSILON * neighbours
}
