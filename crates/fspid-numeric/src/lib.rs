#![doc = include_str!("../README.md")]
//!
//! - [`Real`]: `f32` and `f64` with only the operations whose bits do not depend on the platform, its exponential
//!   function among them.
//! - [`Scalar`](trait@Scalar): what an equation needs; [`Dual`](scalar::Dual), [`Jet`](scalar::Jet) and
//!   [`Interval`](scalar::Interval) are some of those that it can be asked with.
//! - [`lanes`]: numbers side by side.
//! - [`matrix`](mod@matrix): triangles, rotations and balancing of small matrices, over slices.
//! - [`quadrature`]: integrals with bounds that are proved.
//! - [`rounding`]: what a sum and a product lose, and which float lies above or below.
//! - [`straight`]: elementary functions that a loop over lanes makes vectors of.
//! - [`sums`]: weighted sums of long vectors.
//! - [`units`]: what a foot, a pound, a knot and a degree are.
//!
//! | feature | adds | needs |
//! | --- | --- | --- |
//! | `simd` | `Vector`, the lanes of the machine, and `InstructionSet`; `sums` by its widest instructions | `std` |
//!
//! Not here: complex numbers and a type of matrix (`fspid-lti`), and balls of arbitrary precision.
#![no_std]
#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

#[cfg(test)]
extern crate std;

mod exp;
mod floats;
#[cfg(feature = "simd")]
mod instruction_set;
pub mod lanes;
pub mod matrix;
pub mod quadrature;
mod real;
pub mod rounding;
pub mod scalar;
pub mod straight;
pub mod sums;
pub mod units;
#[cfg(feature = "simd")]
mod vector;

#[cfg(feature = "simd")]
pub use instruction_set::InstructionSet;
pub use real::Real;
pub use scalar::Scalar;
#[cfg(feature = "simd")]
pub use vector::Vector;
