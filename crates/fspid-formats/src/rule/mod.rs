//! Rules as FCL and fuzzylite write them: `if x is very low and (y is a or y is b) then z is c with 0.5`.
//!
//! Keywords are read in any case. *And* binds tighter than *or*, but in jFuzzyLogic; where both are written they stand in
//! brackets, for tools disagree. Conclusions are separated by *and* or a comma.

mod carry;
mod read;
mod write;

pub(crate) use carry::{arrange, switches, take_along};
pub(crate) use read::{Manner, Rank, Reader, depth};
pub(crate) use write::{Style, written};

/// Words that mean something in every rule and cannot be names.
pub(crate) const RESERVED: [&str; 7] = ["if", "is", "and", "or", "then", "with", "not"];

/// A rule that ends with its line, as fuzzylite has it.
pub(crate) const LINE: Manner = Manner { ends: |_| false, rank: Rank::AndFirst };

/// Deepest nesting of brackets and negations.
pub(crate) const MAX_DEPTH: usize = 64;
