//! Numbers that an equation can be asked with, the same bits on every machine: no heap, no panic.
//!
//! - [`Real`]: `f32` and `f64` with only the operations whose bits do not depend on the platform, its exponential
//!   function among them.
//! - [`Scalar`](trait@Scalar): what an equation needs. Asked with a float it answers a value, with a
//!   [`Dual`](scalar::Dual) derivatives, with a [`Jet`](scalar::Jet) a Taylor series, and with an
//!   [`Interval`](scalar::Interval) everything that the value can be.
//! - [`lanes`]: numbers side by side; with the feature `simd` those of the machine's vectors.
//! - [`quadrature`]: integrals with bounds that are proved.
//!
//! Not here: complex numbers and matrices (`fspid-lti`), and balls of arbitrary precision.
//!
//! ```
//! use fspid_numeric::Scalar;
//! use fspid_numeric::scalar::{Dual, Interval};
//!
//! fn equation<S: Scalar>(x: S) -> S {
//!     (-x.square()).exp()
//! }
//!
//! let slope = equation(Dual::<f64, 1>::variable(0.5, 0)).derivative[0];
//! assert!((slope + equation(0.5)).abs() < 1e-15);
//! assert!(equation(Interval::new(0.0, 1.0).expect("in order")).contains(equation(0.5)));
//! ```
#![no_std]
#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

#[cfg(test)]
extern crate std;

mod exp;
#[cfg(feature = "simd")]
mod instruction_set;
pub mod lanes;
pub mod quadrature;
mod real;
pub mod scalar;
#[cfg(feature = "simd")]
mod vector;

#[cfg(feature = "simd")]
pub use instruction_set::InstructionSet;
pub use real::Real;
pub use scalar::Scalar;
#[cfg(feature = "simd")]
pub use vector::Vector;
