//! All integration tests in one binary: linking one takes less than linking many.

mod eigenvalues;
mod handbook;
mod integral_regulator;
mod loops;
mod regulator;
mod roots;
mod same_bits;
mod sampled;
mod sampled_battery;
mod sampled_reference;
mod sampling;
#[path = "support/slow.rs"]
mod slow;
mod slow_modes;
mod support;
