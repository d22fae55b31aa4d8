#![doc = include_str!("../README.md")]
//!
//! ```text
//! packet ─frames▶ checked by length and checksum ─listener▶ one sender's, joined ─▶ lines of named numbers
//! bytes of a connection ─stream▶ controls of a simulator's flight stack
//! what is to be told ─encoder▶ frames, which somebody else sends
//! ```
//!
//! No features. Not here: sockets, JSON (`fspid-serve`), signatures of frames (they are skipped, not checked).

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

mod frame;
mod incoming;
mod listener;
mod outgoing;
mod values;

pub use frame::{Damage, is_frame};
pub use incoming::{ActuatorControls, Stream};
pub use listener::{Counts, Line, Listener, Sender};
pub use outgoing::{Encoder, HilAttitude, HilPlace, HilSensor, Outgoing};
