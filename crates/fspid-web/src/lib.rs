#![doc = include_str!("../README.md")]
//!
//! No features. Not here: any formula, and what is drawn while it moves (`web/`).

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

mod answer;
pub mod boundary;
mod question;
mod verbs;

pub use answer::Answer;
use question::Question;

/// Answers a question, a JSON object whose `verb` says what is asked. What cannot be answered has `refused` with the
/// reason, a scenario with mistakes `problems` with their places.
#[must_use]
pub fn answer(question: &str) -> Answer {
    match Question::read(question) {
        Ok(question) => verbs::answer(&question),
        Err(refused) => refused,
    }
}
