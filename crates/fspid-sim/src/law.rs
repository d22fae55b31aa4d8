//! A linear law with held inputs over a sample or a part of one.
//!
//! Over the whole sample it is one matrix product. Over a part it is the action of a matrix
//! exponential on the state: its Taylor series over pieces so short that what follows its last term
//! is below rounding. Neither allocates.

use fspid_lti::{Matrix, exponential};

use crate::error::SimError;
use crate::math::dot;

/// Inputs: target or rate of the leg, elevator disturbance, three gusts.
pub(crate) const INPUTS: usize = 5;
/// Largest norm of a piece of the Taylor series.
const PIECE: f64 = 0.5;
/// Its terms: 0.5^16 / 16! is below 10⁻¹⁸.
const TERMS: u32 = 16;

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
    /// Rows of the generator.
    generator: Vec<f64>,
    /// Rows of its exponential over the sample.
    step: Vec<f64>,
    width: usize,
    /// Largest row sum of the part over the state, 1/s.
    norm_1_s: f64,
}

impl Law {
    pub(crate) fn new(rows: &[Vec<f64>], dt_s: f64) -> Result<Self, SimError> {
        let width = rows.len() + INPUTS;
        let mut square = rows.to_vec();
        square.resize(width, vec![0.0; width]);
        let generator = Matrix::from_rows(&square)?;
        let step = exponential(&generator.scaled(dt_s))?;
        let sum = |row: &Vec<f64>| row.iter().take(rows.len()).map(|entry| entry.abs()).sum();
        Ok(Self {
            generator: generator.data()[..rows.len() * width].to_vec(),
            step: step.data()[..rows.len() * width].to_vec(),
            width,
            norm_1_s: rows.iter().map(sum).fold(0.0, f64::max),
        })
    }

    /// The generator of states and held inputs.
    pub(crate) fn generator(&self) -> Result<Matrix, SimError> {
        let mut square: Vec<Vec<f64>> =
            self.generator.chunks_exact(self.width).map(<[f64]>::to_vec).collect();
        square.resize(self.width, vec![0.0; self.width]);
        Ok(Matrix::from_rows(&square)?)
    }

    /// The rows of one sample.
    pub(crate) fn step_rows(&self) -> std::slice::ChunksExact<'_, f64> {
        self.step.chunks_exact(self.width)
    }

    /// Lets the deflection after a sample be the input.
    pub(crate) fn remember_input(&mut self, deflection: usize) {
        if let Some(row) = self.step.chunks_exact_mut(self.width).nth(deflection) {
            row.fill(0.0);
            row[deflection + 2] = 1.0;
        }
    }

    /// x ← Φ x + Γ u
    pub(crate) fn advance(&self, state: &mut StateVector, inputs: &[f64; INPUTS]) {
        let rows = self.step.chunks_exact(self.width);
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
        let rows = || self.generator.chunks_exact(self.width);
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
