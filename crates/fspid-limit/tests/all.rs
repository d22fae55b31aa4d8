//! Every test of the crate in one binary.

mod attack;
mod known;
