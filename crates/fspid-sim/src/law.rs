//! A linear law with held inputs over a sample or a part of one.
//!
//! Over the whole sample it is one matrix product. Over a part it is the action of a matrix
//! exponential on the state: its Taylor series over pieces so short that what follows its last term
//! is below rounding. Neither allocates. Where such pieces would be too many, as of an aircraft that answers within
//! microseconds, the exponential is made for the part, which does.

use fspid_lti::{FineMatrix, Matrix, exponential, exponential_change};

use crate::error::SimError;
use crate::math::dot;

/// Inputs: target or rate of the leg, elevator disturbance, three gusts.
pub(crate) const INPUTS: usize = 5;
/// Largest norm of a piece of the Taylor series.
const PIECE: f64 = 0.5;
/// Its terms: 0.5^16 / 16! is below 10⁻¹⁸.
const TERMS: u32 = 16;
/// Most pieces of a part.
const MOST_PIECES: f64 = 512.0;

/// One sample of plant and actuator without limits.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LinearStep {
    /// States of plant and actuator, pitch angle first.
    pub(crate) states: usize,
    /// Rows over states, command and elevator disturbance, flat.
    pub(crate) rows: Vec<f64>,
    /// Row from states to pitch rate.
    pub(crate) rate_row: Vec<f64>,
}

/// A state and what is needed to move it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StateVector {
    pub(crate) values: Vec<f64>,
    term: Vec<f64>,
    scratch: Vec<f64>,
}

impl StateVector {
    pub(crate) fn zeros(size: usize) -> Self {
        let zeros = || vec![0.0; size];
        Self { values: zeros(), term: zeros(), scratch: zeros() }
    }
}

/// A linear law over state and held inputs, and its solution over one sample.
#[derive(Clone, Debug)]
pub(crate) struct Law {
    /// Rows of all states over states and inputs, then rows of zeros.
    generator: Matrix,
    /// Rows of its exponential over the sample, flat.
    pub(crate) step: Vec<f64>,
    states: usize,
    /// A state that is the first input.
    remembers: Option<usize>,
    /// Largest row sum of the part over the state, 1/s.
    norm_1_s: f64,
}

impl Law {
    /// Of the rows of all states over states and inputs; a state may be the first input itself.
    pub(crate) fn new(
        rows: &[Vec<f64>],
        remembers: Option<usize>,
        dt_s: f64,
    ) -> Result<Self, SimError> {
        let states = rows.len();
        let sum = |row: &Vec<f64>| row.iter().take(states).map(|entry| entry.abs()).sum();
        let mut law = Self {
            generator: square(rows)?,
            step: Vec::new(),
            states,
            remembers,
            norm_1_s: rows.iter().map(sum).fold(0.0, f64::max),
        };
        law.step = law.step_over(dt_s)?;
        Ok(law)
    }

    /// The rows of all states over another time, flat.
    pub(crate) fn step_over(&self, time_s: f64) -> Result<Vec<f64>, SimError> {
        let step = exponential(&self.generator.scaled(time_s))?;
        let width = self.generator.columns();
        let mut rows = step.data()[..self.states * width].to_vec();
        if let Some(row) = self.remembers.and_then(|state| rows.chunks_exact_mut(width).nth(state))
        {
            row.fill(0.0);
            row[self.states] = 1.0;
        }
        Ok(rows)
    }

    /// The first of its states over one sample.
    pub(crate) fn linear_step(&self, states: usize, rate_row: &[f64]) -> LinearStep {
        let rows = self.step.chunks_exact(self.generator.columns()).take(states);
        let inputs = self.states..self.states + 2;
        let entries = |row: &[f64]| [&row[..states], &row[inputs.clone()]].concat();
        LinearStep {
            states,
            rows: rows.flat_map(entries).collect(),
            rate_row: rate_row[..states].to_vec(),
        }
    }

    /// What a sample changes of the first of its states: rows over them and the command, less 1 on the diagonal, and
    /// what 64 bits leave out of them, `rest` being what they leave out of the generator's rows.
    pub(crate) fn change(
        &self,
        rest: &[Vec<f64>],
        states: usize,
        dt_s: f64,
    ) -> Result<[Vec<f64>; 2], SimError> {
        let generator = FineMatrix::new(self.generator.clone(), square(rest)?)?;
        let change = exponential_change(&generator, dt_s)?;
        let part = |matrix: &Matrix, [left, kept]: [f64; 2]| {
            let rows = matrix.data().chunks_exact(matrix.columns()).take(states);
            let columns = |row: &[f64]| [&row[..states], &row[self.states..=self.states]].concat();
            let mut part: Vec<f64> = rows.flat_map(columns).collect();
            if let Some(state) = self.remembers {
                let row = &mut part[state * (states + 1)..(state + 1) * (states + 1)];
                row.fill(0.0);
                (row[state], row[states]) = (left, kept);
            }
            part
        };
        Ok([part(change.high(), [-1.0, 1.0]), part(change.low(), [0.0, 0.0])])
    }

    /// x ← Φ x + Γ u
    pub(crate) fn advance(&self, state: &mut StateVector, inputs: &[f64; INPUTS]) {
        self.by_rows(&self.step, state, inputs);
    }

    /// The same with the rows of another time.
    fn by_rows(&self, rows: &[f64], state: &mut StateVector, inputs: &[f64; INPUTS]) {
        let rows = rows.chunks_exact(self.generator.columns());
        for (next, row) in state.scratch.iter_mut().zip(rows) {
            let (by_state, by_input) = row.split_at(state.values.len());
            *next = dot(by_state, &state.values) + dot(by_input, inputs);
        }
        std::mem::swap(&mut state.values, &mut state.scratch);
    }

    /// x ← x + h (A x + B u) + h²/2 A (A x + B u) + …
    pub(crate) fn advance_by_series(
        &self,
        state: &mut StateVector,
        inputs: &[f64; INPUTS],
        time_s: f64,
    ) {
        let pieces = (self.norm_1_s * time_s / PIECE).ceil().max(1.0);
        if pieces > MOST_PIECES
            && let Ok(rows) = self.step_over(time_s)
        {
            return self.by_rows(&rows, state, inputs);
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "not negative, and the cast saturates"
        )]
        let count = pieces as u32;
        for _ in 0..count {
            self.piece(state, inputs, time_s / pieces);
        }
    }

    fn piece(&self, state: &mut StateVector, inputs: &[f64; INPUTS], step_s: f64) {
        let rows = || self.generator.data().chunks_exact(self.generator.columns());
        for (term, row) in state.term.iter_mut().zip(rows()) {
            let (by_state, by_input) = row.split_at(state.values.len());
            *term = step_s * (dot(by_state, &state.values) + dot(by_input, inputs));
        }
        for order in 2..=TERMS {
            for (value, term) in state.values.iter_mut().zip(&state.term) {
                *value += term;
            }
            for (next, row) in state.scratch.iter_mut().zip(rows()) {
                *next = step_s / f64::from(order) * dot(row, &state.term);
            }
            std::mem::swap(&mut state.term, &mut state.scratch);
        }
    }
}

/// Rows with rows of zeros below them.
fn square(rows: &[Vec<f64>]) -> Result<Matrix, SimError> {
    let width = rows.first().map_or(0, Vec::len);
    let mut square = rows.to_vec();
    square.resize(width, vec![0.0; width]);
    Ok(Matrix::from_rows(&square)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fast lag that drives a slow one: by one exponential, and by parts of it that are short enough for pieces.
    #[test]
    fn a_part_of_a_sample_is_the_same_by_pieces_and_by_its_exponential() {
        let rows = vec![
            vec![-2.0, 1.0, 0.0, 0.5, 0.0, 0.0, 0.0],
            vec![0.0, -40_000.0, 40_000.0, 0.0, 0.0, 0.0, 0.0],
        ];
        let law = Law::new(&rows, None, 0.02).expect("a law");
        let begun = || {
            let mut state = StateVector::zeros(2);
            state.values = vec![0.3, -0.7];
            state
        };
        let inputs = [0.2, -0.1, 0.0, 0.0, 0.0];
        let (mut whole, mut parts) = (begun(), begun());
        law.advance_by_series(&mut whole, &inputs, 0.008);
        (0..16).for_each(|_| law.advance_by_series(&mut parts, &inputs, 0.0005));
        for (one, other) in whole.values.iter().zip(&parts.values) {
            assert!((one - other).abs() < 1e-12, "{:?} {:?}", whole.values, parts.values);
        }
    }
}
