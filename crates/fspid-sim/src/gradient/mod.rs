//! Gradients of flight costs with respect to every number of a controller: exact, by reverse-mode differentiation (adjoint)
//! through the simulation.
//!
//! ```text
//! numbers ─loop, sample by sample▶ error, travel ─cost
//! numbers ◀─what each is worth, the last sample first─ cost
//! ```
//!
//! A difference asks for two flights for each number; the way back asks for a few flights' work for all of them, however
//! many there are (reverse mode: the adjoint of the sampled loop). What passes is kept for [`SEGMENT`] samples, and for longer
//! flights the state at each of these: what lies between is flown again on the way back, so that no flight is too long.
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
//! - **Sensors** show a straight line between two samples and what is known before the flight: noise, bias, drift.
//! - **Moving air** adds what it adds whatever anybody does: it moves where the slopes are taken, and nothing else.
//!
//! Refused by name: everything but linear plants behind a first-order servo with a lag; sensors with a resolution, whose
//! steps have no slope that helps anybody; rules that conclude labels.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane is a place in many arrays at once, and such loops become vectors"
)]

mod flight;
mod law;
mod network;
mod numbers;
mod plant;
mod price;
mod program;
mod seeing;

pub use flight::{Kind, differentiate_prices};
pub use numbers::{NUMBERS, names, numbers};
pub use price::{
    Differentiated, Flown, Slopes, Weights, add_variation, differentiate, differentiate_by,
};

/// Most samples between two states that are kept, and most samples of lanes that a rate limit holds there: 6.5 MiB of what
/// passes for eight lanes, and 3 MiB more of matrices of such samples for a plant of fourth order.
pub const SEGMENT: usize = 8192;
