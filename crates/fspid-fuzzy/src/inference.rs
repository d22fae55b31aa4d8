//! What a supervisor answers, and why it answers nothing.

use core::fmt;

/// Increments of the three gains, in the supervisor's own units (before the output factors).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Increments<R> {
    /// For the proportional gain.
    pub kp: R,
    /// For the integral gain.
    pub ki: R,
    /// For the derivative gain.
    pub kd: R,
}

/// An answer of the supervisor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inference<R> {
    /// Increments of the gains.
    pub delta: Increments<R>,
    /// An input lay outside the range and was moved to its end.
    pub clamped: bool,
    /// Every rule underflowed, and the answer is that of the clamped inputs.
    pub underflowed: bool,
}

/// Why an input has no answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InferenceError {
    /// `error` or `change`.
    pub input: &'static str,
    /// What was given.
    pub found: f64,
    /// Half range of the input.
    pub range: f64,
}

impl fmt::Display for InferenceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { input, found, range } = self;
        if found.is_finite() {
            write!(f, "{input} is {found:?}; allowed is -{range:?} to {range:?}")
        } else {
            write!(f, "{input} is {found:?}; allowed is a finite number")
        }
    }
}

impl core::error::Error for InferenceError {}
