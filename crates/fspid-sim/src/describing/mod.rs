//! Limit cycles under limits, predicted by describing functions.
//!
//! A limit answers a sine of amplitude A with a distorted one. Of that only the fundamental is kept,
//! and the describing function N(A, ω) is its ratio to what comes without the limit. A loop whose open
//! loop without limits is L can then go on oscillating where
//!
//! $$ N(A, \omega) L(e^{j \omega T}) = -1. $$
//!
//! # What this is worth
//! It is an approximation, and neither proves a cycle nor its absence: harmonics are taken to die out
//! on their way around the loop, and so is every constant part. It is good to some percent where the
//! plant is a low pass and the limits are the same on both sides. Anti-windup, and gains that move, are
//! left out: the gains are frozen, those at rest or those that are given.
//!
//! # Source
//! A. Gelb and W. E. Vander Velde, Multiple-Input Describing Functions and Nonlinear System Design,
//! McGraw-Hill 1968.

mod cycles;
mod path;
mod response;
mod scan;
mod search;

pub use cycles::{LimitCycle, LimitCycles, limit_cycles, limit_cycles_at};
pub use path::LimitedPath;
pub use response::{OpenLoop, Response};
pub use search::Search;
