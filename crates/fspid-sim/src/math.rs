//! Elementary functions with the same bits on every machine.

use std::f64::consts::TAU;

use fspid_numeric::Scalar;

/// $e^x$ by the one exponential of the project.
pub(crate) fn exp(x: f64) -> f64 {
    Scalar::exp(x)
}

/// Sine and cosine.
pub(crate) fn sin_cos(angle_rad: f64) -> (f64, f64) {
    libm::sincos(angle_rad)
}

/// A direction as the one of its turns that is nearest to another, rad.
pub(crate) fn turned_towards(other_rad: f64, direction_rad: f64) -> f64 {
    direction_rad + TAU * ((other_rad - direction_rad) / TAU).round()
}

/// Sum of products.
pub(crate) fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(a, b)| a * b).sum()
}
