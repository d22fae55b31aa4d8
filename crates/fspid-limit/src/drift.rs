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
use fspid_proof::check::{IntervalMatrix, balance, prove_positive_definite};
use fspid_proof::solve::summed;

use crate::error::LimitError;

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
        let midpoint = a.midpoint();
        let units = balance(midpoint.data().iter().map(|it| it.abs()).collect(), a.rows());
        for exponent in 0..=MOST_GROWTH {
            let growth = 1.0 + libm::ldexp(1.0, exponent) / samples.max(1) as f64;
            if let Some(drift) = Self::tried(a, growth, &units) {
                return Ok(drift);
            }
        }
        Err(LimitError::GrowsTooFast)
    }

    fn tried(a: &IntervalMatrix, growth: f64, units: &[i32]) -> Option<Self> {
        let p = series(&a.midpoint(), growth, units)?;
        let (states, enclosed) = (a.rows(), IntervalMatrix::from(&p));
        let rho = Interval::point(growth);
        let moved = a.product(&enclosed).ok()?.product(&a.transpose()).ok()?;
        prove_positive_definite(&enclosed.scaled(rho * rho).difference(&moved).ok()?).ok()?;
        let inverse = p.solve(&Matrix::identity(states)).ok()?;
        let mut shares = Vec::with_capacity(states);
        for place in 0..states {
            let beta = inverse.get(place, place)? * ROOM;
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

/// $\sum_j (A / \rho)^j S (A / \rho)^{jT}$ with S of the states' units, squared.
fn series(a: &Matrix, growth: f64, units: &[i32]) -> Option<Matrix> {
    let mut squares = Matrix::zeros(units.len(), units.len());
    for (place, exponent) in units.iter().enumerate() {
        squares.set(place, place, libm::ldexp(1.0, 2 * exponent)).ok()?;
    }
    summed(&a.scaled(1.0 / growth).transpose(), &squares)
}
