//! Formatting of numbers in error messages: NaN and infinities are spelled out.

use std::fmt;

/// A number as a message tells it: what is none in words, for it is rarely the one that somebody wrote.
#[derive(Clone, Copy, Debug)]
pub struct InWords(pub f64);

impl fmt::Display for InWords {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            value if value.is_finite() => write!(f, "{value}"),
            value if value.is_nan() => f.write_str("not a number"),
            value if value < 0.0 => f.write_str("below all numbers"),
            _ => f.write_str("beyond all numbers"),
        }
    }
}
