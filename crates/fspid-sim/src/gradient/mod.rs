//! What every number of a controller is worth: exact gradients of what flights cost, by one way back through each flight.
//!
//! ```text
//! numbers ─loop, sample by sample▶ error, travel ─cost
//! numbers ◀─what each is worth, the last sample first─ cost
//! ```
//!
//! A difference asks for two flights for each number; the way back asks for a few flights' work for all of them, however
//! many there are (reverse mode: the adjoint of the sampled loop). The state of every [`SEGMENT`]th sample is kept, and what
//! lies between is flown again on the way back, so that memory grows with a small part of the samples.
//!
//! - **Plant and servo** are one exact matrix a sample (`Propagator`); backwards it is the matrix transposed. Where the rate
//!   limit holds the servo for a part of a sample, the matrix is that of both parts; the instant at which the limit lets go
//!   moves with the command, and what that changes is zero, since the servo moves at the same rate on both sides of it.
//! - **The controller** is the core's own equations, recorded and gone through backwards (`program`).
//! - **The rules** conclude numbers; between the sets they are bilinear.
//!
//! Limits have the derivative of the case that flew. At a kink that is one of Clarke's generalised gradient, and as good as
//! any other; costs are continuous there.
//!
//! Refused by name: everything but linear plants behind a first-order servo with a lag, in calm air, seen as they are; rules
//! that conclude labels.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane is a place in many arrays at once, and such loops become vectors"
)]

mod flight;
mod law;
mod numbers;
mod plant;
mod program;

pub use flight::{Differentiated, Weights, differentiate, differentiate_by};
pub use numbers::{NUMBERS, names, numbers};

/// Samples between two that are kept.
pub const SEGMENT: usize = 64;
