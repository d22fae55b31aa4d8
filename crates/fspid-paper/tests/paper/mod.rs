//! The claims of the paper, one test each: reproduced, or our answer asserted and the reason written.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

mod claims;
mod fits;
mod readme;

use std::sync::OnceLock;

use fspid_paper::Reproduction;

/// The stored reproduction, flown once for all tests.
fn paper() -> &'static Reproduction {
    static PAPER: OnceLock<Reproduction> = OnceLock::new();
    PAPER.get_or_init(|| Reproduction::stored().expect("the stored scenarios fly"))
}
