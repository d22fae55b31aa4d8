//! Elementary functions with the same bits on every machine.

use fspid_numeric::Scalar;

/// $e^x$ by the one exponential of the project.
pub(crate) fn exp(x: f64) -> f64 {
    Scalar::exp(x)
}

/// Sine and cosine.
pub(crate) fn sin_cos(angle_rad: f64) -> (f64, f64) {
    libm::sincos(angle_rad)
}

/// Sum of products.
pub(crate) fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(a, b)| a * b).sum()
}
