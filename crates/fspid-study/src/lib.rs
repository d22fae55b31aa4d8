//! fspid-study

#![cfg_attr(
    test,
    allow(
        clippy::float_cmp,
        reason = "tests ask for exact bits where they compare floats"
    )
)]

pub mod file;
