//! All integration tests in one binary: linking one takes less than linking many.

#[cfg(feature = "alloc")]
mod audit;
#[cfg(feature = "batch")]
mod batch;
mod boxes;
mod common;
mod duals;
#[cfg(feature = "alloc")]
mod gradient;
mod jets;
mod membership;
mod network;
mod numbers;
mod quadrature;
mod recorded_bits;
mod reference;
#[cfg(feature = "alloc")]
mod system;
#[cfg(feature = "alloc")]
mod type2;
