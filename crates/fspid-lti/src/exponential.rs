//! The exponential of a matrix.

use crate::balance::balance;
use crate::doubled::{Doubled, DoubledMatrix};
use crate::error::LtiError;
use crate::fine::FineMatrix;
use crate::matrix::Matrix;

/// Coefficients of the numerator of the diagonal Padé approximant of degree 13, from the constant up.
const PADE: [f64; 14] = [
    64_764_752_532_480_000.0,
    32_382_376_266_240_000.0,
    7_771_770_303_897_600.0,
    1_187_353_796_428_800.0,
    129_060_195_264_000.0,
    10_559_470_521_600.0,
    670_442_572_800.0,
    33_522_128_640.0,
    1_323_241_920.0,
    40_840_800.0,
    960_960.0,
    16_380.0,
    182.0,
    1.0,
];

/// Norm up to which the approximant of degree 13 has a backward error below 2^-53: theta_13 of the source, table 2.3.
const THETA: f64 = 5.371_920_351_148_152;

/// Norm up to which Taylor's series is used, and its terms: 0.25^18 / 18! is below 10⁻²⁶.
const SERIES: f64 = 0.25;
const TERMS: u32 = 18;

/// Exponential of a square matrix.
///
/// $$ e^A = \sum_{k=0}^{\infty} \frac{A^k}{k!} = \left( e^{A / 2^s} \right)^{2^s} $$
///
/// Balanced, scaled by $2^{-s}$, approximated by a Padé fraction of degree 13, and squared s times. The squarings are
/// done with twice the working precision, because each of them doubles the relative error: beside a fast actuator
/// the slow modes would lose s binary digits.
///
/// # Source
/// N. J. Higham, The scaling and squaring method for the matrix exponential revisited, SIAM J. Matrix Anal. Appl. 26
/// (2005) 1179, algorithm 2.3.
///
/// # Errors
/// A matrix that is not square, an entry that is not finite, a result that overflows.
pub fn exponential(matrix: &Matrix) -> Result<Matrix, LtiError> {
    matrix.require_square_and_finite("matrix of the exponential")?;
    let mut balanced = matrix.clone();
    let exponents = balance(&mut balanced);
    let squarings = squarings(balanced.norm_one())?;
    let change = pade_less_identity(&balanced.map(|value| libm::scalbn(value, -squarings)))?;
    let mut result = DoubledMatrix::identity_plus(&change);
    for _ in 0..squarings {
        result = result.squared();
    }
    let result = result.rounded();
    let restored = Matrix::from_function(matrix.rows(), matrix.rows(), |row, column| {
        libm::scalbn(result.at(row, column), exponents[row] - exponents[column])
    });
    LtiError::unless_finite("matrix exponential", restored.data())?;
    Ok(restored)
}

/// Exponential of a square matrix times a time, less the identity, with twice the working precision.
///
/// $$ e^{A t} - I = (2 I + X_s) X_s, \quad X_k = (2 I + X_{k-1}) X_{k-1}, \quad X_0 = e^{A t / 2^s} - I $$
///
/// By Taylor's series and squarings of the difference alone: what is small beside 1, as the slow modes of a system that
/// is sampled fast, loses nothing to it.
///
/// # Errors
/// As [`exponential`]; a time that is not finite.
pub fn exponential_change(matrix: &FineMatrix, time_s: f64) -> Result<FineMatrix, LtiError> {
    const WHAT: &str = "matrix of the exponential";
    matrix.high().require_square_and_finite(WHAT)?;
    let mut balanced = matrix.high().scaled(time_s);
    LtiError::unless_finite(WHAT, balanced.data())?;
    let exponents = balance(&mut balanced);
    let squarings = squarings(balanced.norm_one() * (THETA / SERIES))?;
    let size = exponents.len();
    let shift = |row: usize, column: usize| exponents[column] - exponents[row] - squarings;
    let scaled = DoubledMatrix::from_function(size, |row, column| {
        let [high, low] = matrix.at(row, column);
        let scale = |value: f64| libm::scalbn(value, shift(row, column));
        Doubled { high: scale(high), low: scale(low) }.times(time_s)
    });
    let mut change = DoubledMatrix::from_function(size, |_, _| Doubled::ZERO);
    // Horner's scheme: A (1 + A/2 (1 + A/3 (…))).
    for order in (1..=TERMS).rev() {
        change = scaled.product(&change).plus(&scaled).divided(f64::from(order));
    }
    for _ in 0..squarings {
        change = change.product(&change).plus(&change).plus(&change);
    }
    let restored = FineMatrix::from_function((size, size), |row, column| {
        let entry = change.at(row, column);
        let back = -shift(row, column) - squarings;
        [entry.high, entry.low].map(|value| libm::scalbn(value, back))
    });
    LtiError::unless_finite("matrix exponential", restored.high().data())?;
    Ok(restored)
}

/// How often to halve a matrix of this norm before the approximant holds.
fn squarings(norm: f64) -> Result<i32, LtiError> {
    if norm.is_finite() {
        let (_, exponent) = libm::frexp(norm / THETA);
        Ok(exponent.max(0))
    } else {
        Err(LtiError::OutOfRange { what: "norm of the matrix of the exponential" })
    }
}

/// Padé fraction (V - U)^-1 (V + U) less the identity, as 2 (V - U)^-1 U, so that what is small keeps its digits.
fn pade_less_identity(a: &Matrix) -> Result<Matrix, LtiError> {
    let a2 = a.product(a)?;
    let a4 = a2.product(&a2)?;
    let a6 = a2.product(&a4)?;
    let powers = [&Matrix::identity(a.rows()), &a2, &a4, &a6];
    let odd = a.product(&sum_of_powers(powers, 1)?)?;
    let even = sum_of_powers(powers, 0)?;
    Ok(even.sum(&odd.scaled(-1.0))?.solve(&odd)?.scaled(2.0))
}

/// Sum of the coefficients of every second power from `first`, over the powers I, A^2, A^4, A^6 and their products.
fn sum_of_powers(powers: [&Matrix; 4], first: usize) -> Result<Matrix, LtiError> {
    let [one, a2, a4, a6] = powers;
    let c = |k: usize| PADE[first + 2 * k];
    let high = a6.scaled(c(6)).sum(&a4.scaled(c(5)))?.sum(&a2.scaled(c(4)))?;
    let low =
        a6.scaled(c(3)).sum(&a4.scaled(c(2)))?.sum(&a2.scaled(c(1)))?.sum(&one.scaled(c(0)))?;
    a6.product(&high)?.sum(&low)
}
