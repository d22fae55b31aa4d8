//! White noise through a linear filter, sampled exactly.
//!
//! $$ dx = A x \ dt + b \ dW, \qquad x_{k+1} = \Phi x_k + L n_k, \qquad
//! \Phi = e^{A T}, \quad L L^T = Q = \int_0^T e^{A t} b b^T e^{A^T t} dt $$
//!
//! The covariance of the sampled states is that of the continuous ones whatever T is, and the start
//! is drawn from the stationary covariance $A P + P A^T + b b^T = 0$, so that nothing warms up.
//! $L$ is lower triangular: state i takes the first i + 1 normal numbers only, so that states added
//! at the end never change those before them.

use core::convert::Infallible;

use fspid_lti::{Matrix, exponential};
use fspid_numeric::matrix::cholesky;

use crate::error::SimError;
use crate::math::dot;
use crate::signal::Noise;

/// A filter of N states driven by one white noise, for one sample period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ShapedNoise<const N: usize> {
    transition: [[f64; N]; N],
    noise: [[f64; N]; N],
    start: [[f64; N]; N],
}

/// Where a filter's random numbers come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Source<'a> {
    pub(super) noise: &'a Noise,
    /// Stream of the first state; those of the others follow.
    pub(super) stream: u64,
    /// The last sample that has random numbers; those of the others are 0.
    pub(super) last: usize,
}

impl Source<'_> {
    fn normals<const N: usize>(self, k: usize) -> [f64; N] {
        if k > self.last {
            return [0.0; N];
        }
        std::array::from_fn(|state| self.noise.normal(self.stream + state as u64, k))
    }
}

impl<const N: usize> ShapedNoise<N> {
    /// The filter for unit-intensity white noise, sampled every `dt_s`.
    pub(super) fn new(a: [[f64; N]; N], b: [f64; N], dt_s: f64) -> Result<Self, SimError> {
        let (transition, covariance) = sampled(a, b, dt_s)?;
        let stationary = stationary(a, b)?;
        Ok(Self {
            transition: array(&transition),
            noise: factor(array(&covariance)),
            start: factor(stationary),
        })
    }

    /// States at sample 0, from the stationary distribution.
    pub(super) fn start(&self, source: Source<'_>) -> [f64; N] {
        let normals: [f64; N] = source.normals(0);
        self.start.map(|row| dot(&row, &normals))
    }

    /// States at sample `k` from those at the sample before.
    pub(super) fn advance(&self, states: &mut [f64; N], source: Source<'_>, k: usize) {
        let normals: [f64; N] = source.normals(k);
        let before = *states;
        for ((next, by_state), by_normal) in
            states.iter_mut().zip(&self.transition).zip(&self.noise)
        {
            *next = dot(by_state, &before) + dot(by_normal, &normals);
        }
    }
}

/// Largest norm of $A T$ that Van Loan's block is computed for at once; it holds $e^{-A T}$.
const LARGEST_BLOCK: f64 = 1.0;

/// $\Phi$ and $Q$ for a period.
///
/// $$ \exp \begin{pmatrix} -A h & b b^T h \cr 0 & A^T h \end{pmatrix}
/// = \begin{pmatrix} \cdot & \Phi_h^{-1} Q_h \cr 0 & \Phi_h^T \end{pmatrix}, \qquad
/// Q_{2h} = Q_h + \Phi_h Q_h \Phi_h^T $$
///
/// with $h = T / 2^m$ small enough that $e^{-A h}$ does no harm, doubled m times.
///
/// # Source
/// C. F. Van Loan, Computing integrals involving the matrix exponential, IEEE Trans. Automatic
/// Control 23 (1978) 395.
fn sampled<const N: usize>(
    a: [[f64; N]; N],
    b: [f64; N],
    dt_s: f64,
) -> Result<(Matrix, Matrix), SimError> {
    let norm = dt_s * Matrix::from_rows(&a)?.norm_one();
    let doublings = libm::frexp(norm / LARGEST_BLOCK).1.max(0);
    let step_s = libm::scalbn(dt_s, -doublings);
    let exponential = exponential(&block(a, b, step_s)?)?;
    let mut transition = part(&exponential, N, N)?.transpose();
    let mut covariance = transition.product(&part(&exponential, 0, N)?)?;
    for _ in 0..doublings {
        let carried = transition.product(&covariance)?.product(&transition.transpose())?;
        covariance = covariance.sum(&carried)?;
        transition = transition.product(&transition)?;
    }
    Ok((transition, covariance))
}

/// Van Loan's matrix of twice the size.
fn block<const N: usize>(a: [[f64; N]; N], b: [f64; N], step_s: f64) -> Result<Matrix, SimError> {
    let mut block = Matrix::zeros(2 * N, 2 * N);
    for row in 0..N {
        for column in 0..N {
            block.set(row, column, -step_s * a[row][column])?;
            block.set(row, N + column, step_s * b[row] * b[column])?;
            block.set(N + row, N + column, step_s * a[column][row])?;
        }
    }
    Ok(block)
}

/// A square quarter of a matrix of twice the size.
fn part(matrix: &Matrix, row: usize, column: usize) -> Result<Matrix, SimError> {
    let size = matrix.rows() / 2;
    let entries = |i: usize| (0..size).map(move |j| matrix.get(row + i, column + j).unwrap_or(0.0));
    let rows: Vec<Vec<f64>> = (0..size).map(|i| entries(i).collect()).collect();
    Ok(Matrix::from_rows(&rows)?)
}

/// The stationary covariance P of $A P + P A^T = -b b^T$: N² linear equations with the matrix
/// $A \otimes I + I \otimes A$.
fn stationary<const N: usize>(a: [[f64; N]; N], b: [f64; N]) -> Result<[[f64; N]; N], SimError> {
    let entry = |row: usize, column: usize| {
        let (i, j, k, l) = (row / N, row % N, column / N, column % N);
        (if j == l { a[i][k] } else { 0.0 }) + (if i == k { a[j][l] } else { 0.0 })
    };
    let rows: Vec<Vec<f64>> =
        (0..N * N).map(|row| (0..N * N).map(|column| entry(row, column)).collect()).collect();
    let right: Vec<[f64; 1]> = (0..N * N).map(|row| [-b[row / N] * b[row % N]]).collect();
    Ok(array(&Matrix::from_rows(&rows)?.solve(&Matrix::from_rows(&right)?)?))
}

/// The entries of a matrix of N² entries, row after row.
fn array<const N: usize>(matrix: &Matrix) -> [[f64; N]; N] {
    let entry = |index: usize| matrix.data().get(index).copied().unwrap_or(0.0);
    std::array::from_fn(|row| std::array::from_fn(|column| entry(row * N + column)))
}

/// Of a variance: below this share of it, what earlier states leave over is rounding.
const ROUNDING: f64 = 1e-15;

/// The lower triangular factor of a covariance, also of one without full rank.
fn factor<const N: usize>(covariance: [[f64; N]; N]) -> [[f64; N]; N] {
    let mut factor = [[0.0; N]; N];
    let matrix = |row: usize, column: usize| covariance[row][column];
    let Ok(()) = cholesky(factor.as_flattened_mut(), N, matrix, |entry| {
        let rest = entry.rest();
        Ok::<_, Infallible>(match entry.diagonal {
            Some(pivot) if pivot > 0.0 => rest / pivot,
            None if rest > ROUNDING * entry.value => rest.sqrt(),
            _ => 0.0,
        })
    });
    factor
}

#[cfg(test)]
impl<const N: usize> ShapedNoise<N> {
    /// The stationary covariance P of the sampled filter, from $P = \Phi P \Phi^T + L L^T$ alone.
    pub(super) fn sampled_covariance(&self) -> [[f64; N]; N] {
        let identity = Matrix::identity(N * N);
        let mut left = identity;
        let mut right = Matrix::zeros(N * N, 1);
        for i in 0..N {
            for j in 0..N {
                right.set(i * N + j, 0, dot(&self.noise[i], &self.noise[j])).expect("inside");
                for k in 0..N {
                    for l in 0..N {
                        let before = left.get(i * N + j, k * N + l).expect("inside");
                        let entry = before - self.transition[i][k] * self.transition[j][l];
                        left.set(i * N + j, k * N + l, entry).expect("inside");
                    }
                }
            }
        }
        array(&left.solve(&right).expect("stable"))
    }

    /// The covariance that the start is drawn from.
    pub(super) fn start_covariance(&self) -> [[f64; N]; N] {
        std::array::from_fn(|i| std::array::from_fn(|j| dot(&self.start[i], &self.start[j])))
    }

    /// The transition matrix of one period.
    pub(super) fn transition(&self) -> [[f64; N]; N] {
        self.transition
    }
}
