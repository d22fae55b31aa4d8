//! How far an adjoint recursion in floats may drift from the true one.
//!
//! Intervals that are passed from sample to sample through an oscillating plant grow without end. Here the recursion is done
//! in floats, what each step leaves over is enclosed, and how left-overs grow is bounded in a norm of the plant itself:
//!
//! $$ A P A^T \preceq \rho^2 P \ \Rightarrow\ \lVert A^T x \rVert_P \le \rho \lVert x \rVert_P, \qquad
//! \beta_i P \succeq e_i e_i^T \ \Rightarrow\ |x_i| \le \sqrt{\beta_i} \lVert x \rVert_P $$
//!
//! P is found in floats and believed by [`prove_positive_definite`].

use fspid_lti::Matrix;
use fspid_numeric::scalar::{Interval, Scalar};
use fspid_proof::check::{IntervalMatrix, prove_positive_definite};

use crate::error::LimitError;

/// Doublings of the series of P: 2^24 samples are more than a flight has.
const DOUBLINGS: usize = 24;
/// Faster growth than $e^{2^k}$ over the flight is not tried.
const MOST_GROWTH: i32 = 9;
/// How much $\beta_i$ is above what floats make of it.
const ROOM: f64 = 1.0 + 1e-4;

/// A norm in which left-overs grow by no more than a known factor a sample.
#[derive(Clone, Debug)]
pub(crate) struct Drift {
    /// ρ.
    growth: Interval,
    /// Upper bounds of $\sqrt{P_{ii}}$.
    weights: Vec<f64>,
    /// Upper bounds of $\sqrt{\beta_i}$.
    shares: Vec<f64>,
}

impl Drift {
    /// For a plant over as many samples.
    pub(crate) fn of(a: &IntervalMatrix, samples: usize) -> Result<Self, LimitError> {
        let scale = scale(&a.midpoint());
        for exponent in 0..=MOST_GROWTH {
            let growth = 1.0 + libm::ldexp(1.0, exponent) / samples.max(1) as f64;
            if let Some(drift) = Self::tried(a, growth, &scale) {
                return Ok(drift);
            }
        }
        Err(LimitError::GrowsTooFast)
    }

    fn tried(a: &IntervalMatrix, growth: f64, scale: &[f64]) -> Option<Self> {
        let p = series(&a.midpoint(), growth, scale)?;
        let (states, enclosed) = (a.rows(), IntervalMatrix::from(&p));
        let rho = Interval::point(growth);
        let moved = a.product(&enclosed).ok()?.product(&a.transpose()).ok()?;
        prove_positive_definite(&enclosed.scaled(rho * rho).difference(&moved).ok()?).ok()?;
        let inverse = inverse_diagonal(&p)?;
        let mut shares = Vec::with_capacity(states);
        for (place, least) in inverse.into_iter().enumerate() {
            let beta = least * ROOM;
            let mut unit = Matrix::zeros(states, states);
            unit.set(place, place, 1.0).ok()?;
            let room = enclosed.scaled(Interval::point(beta));
            prove_positive_definite(&room.difference(&IntervalMatrix::from(&unit)).ok()?).ok()?;
            shares.push(Interval::point(beta).sqrt().upper());
        }
        let weight = |place| p.get(place, place).map(|it| Interval::point(it).sqrt().upper());
        let weights = (0..states).map(weight).collect::<Option<Vec<f64>>>()?;
        Some(Self { growth: rho, weights, shares })
    }

    /// The norm of everything within these sizes, rounded up.
    pub(crate) fn norm(&self, sizes: impl Iterator<Item = f64>) -> Interval {
        let terms = self.weights.iter().zip(sizes);
        let sum = terms.fold(Interval::ZERO, |sum, (weight, size)| {
            sum + Interval::point(*weight) * Interval::point(size)
        });
        Interval::point(sum.upper())
    }

    /// What is left of a norm a sample earlier, and what comes to it.
    pub(crate) fn grown(&self, norm: Interval, more: Interval) -> Interval {
        Interval::point((self.growth * norm + more).upper())
    }

    /// How large entry `place` is within a norm, at most.
    pub(crate) fn share(&self, place: usize, norm: Interval) -> f64 {
        let share = self.shares.get(place).copied().unwrap_or(f64::INFINITY);
        (Interval::point(share) * norm).upper()
    }
}

/// Sizes of the states of $A^T$'s motion: units in which a norm of it is round.
fn scale(a: &Matrix) -> Vec<f64> {
    let states = a.rows();
    let entry = |row: usize, column: usize| a.get(row, column).unwrap_or(0.0).abs();
    let mut scale = vec![1.0_f64; states];
    // Balancing: rows as large as columns.
    for _ in 0..32 {
        for i in 0..states {
            let others = || (0..states).filter(move |&j| j != i);
            let row: f64 = others().map(|j| entry(i, j) * scale[j] / scale[i]).sum();
            let column: f64 = others().map(|j| entry(j, i) * scale[i] / scale[j]).sum();
            if row > 0.0 && column > 0.0 {
                scale[i] *= libm::sqrt(row / column);
            }
        }
    }
    scale
}

/// $\sum_j (A / \rho)^j S (A / \rho)^{jT}$, symmetric to the bit.
fn series(a: &Matrix, growth: f64, scale: &[f64]) -> Option<Matrix> {
    let states = a.rows();
    let mut sum = Matrix::zeros(states, states);
    for (place, unit) in scale.iter().enumerate() {
        sum.set(place, place, unit * unit).ok()?;
    }
    let mut power = a.scaled(1.0 / growth);
    for _ in 0..DOUBLINGS {
        let moved = power.product(&sum).ok()?.product(&power.transpose()).ok()?;
        sum = sum.sum(&moved).ok()?;
        power = power.product(&power).ok()?;
    }
    let finite = sum.data().iter().all(|value| value.is_finite());
    let mut even = Matrix::zeros(states, states);
    for row in 0..states {
        for column in 0..states {
            let (one, other) = (sum.get(row, column)?, sum.get(column, row)?);
            even.set(row, column, 0.5 * (one + other)).ok()?;
        }
    }
    finite.then_some(even)
}

/// The diagonal of the inverse, by Gauss and Jordan in floats.
fn inverse_diagonal(p: &Matrix) -> Option<Vec<f64>> {
    let states = p.rows();
    let mut rows: Vec<Vec<f64>> = (0..states)
        .map(|i| {
            let own = (0..states).map(|j| p.get(i, j).unwrap_or(0.0));
            own.chain((0..states).map(|j| if i == j { 1.0 } else { 0.0 })).collect()
        })
        .collect();
    for pivot in 0..states {
        let lead = rows[pivot][pivot];
        if !(lead > 0.0) {
            return None;
        }
        rows[pivot].iter_mut().for_each(|value| *value /= lead);
        let row = rows[pivot].clone();
        for (place, other) in rows.iter_mut().enumerate() {
            let factor = other[pivot];
            if place != pivot {
                other.iter_mut().zip(&row).for_each(|(value, own)| *value -= factor * own);
            }
        }
    }
    Some((0..states).map(|place| rows[place][states + place]).collect())
}
