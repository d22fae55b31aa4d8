//! A scenario's controller on a line, so that any simulator can be its aircraft.
//!
//! # Protocol
//!
//! A line in is a request. Each request gets exactly one line out, at once, so that a client that
//! reads one line for each it writes cannot get out of step:
//!
//! | line in | line out |
//! | --- | --- |
//! | `setpoint measured dt_s [q]` | the command, nose up positive |
//! | `reset` | `ok`; the next sample is the first of a new flight |
//! | anything else | the last command once more, and a word on what is wrong |
//! | nothing, or `#` and a comment | nothing |
//!
//! - Fields stand between blanks, or between commas; an empty field is not allowed. Angles are in
//!   degrees, or all of them in radians ([`Angles`]); `q` is the pitch rate, per second.
//! - Commands have the shortest digits that read back as the same number.
//! - A line that cannot be read is to the controller a sample that is not finite: it holds its
//!   command, latches a fault, and its memory stays as it was.
//! - `dt_s` is the time since the sample before. The controller computes with its own period
//!   whatever it says; more than a millionth beside it, and it is counted as a slip. Time that
//!   stands still or runs back is no time for a sample: the command is held. At the first sample of
//!   a flight there is none before, and `dt_s` has only to be a finite number.
//! - Where the controller needs a pitch rate and the line has none, it is estimated from the
//!   measurement by a filter over two periods (in `rate.rs`).
//! - An external controller is asked what equations would answer. Lines without a sample are kept from it; where it is
//!   lost (a crash, silence, NaN) that is told with the time of the sample, and its last command is held until a `reset`
//!   starts it anew.
//! - Whoever does not read what is told to people is not stopped by it: it is bounded.
//!
//! In radians the commands are those of a flight in `simulate`, bit for bit. In degrees they are
//! near: not each number in radians has a number in degrees of its own.
//!
//! Not here: servo, delays, sensors and air. They belong to the aircraft, and here that is the
//! client. Nor a clock: the client says when a sample is.

mod flyer;
mod hand;
mod latched;
mod line;
mod log;
mod pilot;
mod rate;
mod stream;

pub use hand::Hand;
pub use line::Angles;
pub use log::Summary;
pub use pilot::{Answer, ChoiceError, Pilot};
pub use stream::{StreamError, fly};
