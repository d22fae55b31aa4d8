//! What can be wrong with a controller before it is built.

use core::fmt;

/// Why a controller could not be built: which setting, what was found, what is allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ConfigError {
    /// A number that is not allowed.
    Number {
        /// Name of the setting, with its unit.
        what: &'static str,
        /// What was given.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A lower limit that is not below its upper limit.
    EmptyRange {
        /// Name of the setting.
        what: &'static str,
        /// Lower limit given.
        lower: f64,
        /// Upper limit given.
        upper: f64,
    },
    /// Nominal gains outside the gain limits.
    OutsideLimits {
        /// Which gain.
        what: &'static str,
        /// What was given.
        found: f64,
        /// Lowest allowed.
        lower: f64,
        /// Highest allowed.
        upper: f64,
    },
    /// Two settings that exclude each other.
    Conflict {
        /// The sentence.
        what: &'static str,
    },
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number {
                what,
                found,
                allowed,
            } => {
                write!(f, "{what} is {found:?}; allowed is {allowed}")
            }
            Self::EmptyRange { what, lower, upper } => write!(
                f,
                "{what} are {lower:?} to {upper:?}; the lower must be below the upper, and neither NaN"
            ),
            Self::OutsideLimits {
                what,
                found,
                lower,
                upper,
            } => {
                write!(
                    f,
                    "{what} is {found:?}, outside its limits {lower:?} to {upper:?}"
                )
            }
            Self::Conflict { what } => f.write_str(what),
        }
    }
}

impl core::error::Error for ConfigError {}

/// `value` if it is finite and above zero.
pub(crate) fn positive<R: fspid_fuzzy::Real>(
    what: &'static str,
    value: R,
) -> Result<R, ConfigError> {
    if value.is_finite() && value > R::ZERO {
        return Ok(value);
    }
    let allowed = "a finite number above 0";
    Err(ConfigError::Number {
        what,
        found: value.to_f64(),
        allowed,
    })
}

/// `value` if it is finite and not below zero.
pub(crate) fn not_negative<R: fspid_fuzzy::Real>(
    what: &'static str,
    value: R,
) -> Result<R, ConfigError> {
    if value.is_finite() && value >= R::ZERO {
        return Ok(value);
    }
    let allowed = "a finite number, 0 or above";
    Err(ConfigError::Number {
        what,
        found: value.to_f64(),
        allowed,
    })
}

/// `value` if it is finite.
pub(crate) fn finite<R: fspid_fuzzy::Real>(what: &'static str, value: R) -> Result<R, ConfigError> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(ConfigError::Number {
        what,
        found: value.to_f64(),
        allowed: "a finite number",
    })
}
