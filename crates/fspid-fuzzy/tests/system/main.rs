//! General systems: what they answer, and what they keep to.

#![cfg(feature = "alloc")]
#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

mod build;
mod integral;
mod outline;
mod sampled;
mod supervisor;
mod tipper;
