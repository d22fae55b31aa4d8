#![doc = include_str!("../README.md")]
//!
//! ```text
//! packet ─frames▶ checked by length and checksum ─listener▶ one sender's, joined ─▶ lines of named numbers
//! ```
//!
//! No features. Not here: sockets, JSON (`fspid-serve`), signatures of frames (they are skipped, not checked), and anything
//! that would be sent.

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

mod frame;
mod listener;
mod values;

pub use frame::{Damage, is_frame};
pub use listener::{Counts, Line, Listener, Sender};
