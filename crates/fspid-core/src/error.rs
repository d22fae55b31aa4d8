//! What can be wrong with a controller before it is built.

use core::fmt;

use fspid_fuzzy::FuzzyError;
use fspid_numeric::Real;

use crate::controller_setting::ControllerSetting;

/// Why a controller could not be built: which setting, what was found, what is allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ConfigError {
    /// A number that is not allowed.
    Number {
        /// Which setting.
        what: ControllerSetting,
        /// What was given.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A lower limit that is not below its upper limit.
    EmptyRange {
        /// Which setting.
        what: ControllerSetting,
        /// Lower limit given.
        lower: f64,
        /// Upper limit given.
        upper: f64,
    },
    /// Nominal gains outside the gain limits.
    OutsideLimits {
        /// Which gain.
        what: ControllerSetting,
        /// What was given.
        found: f64,
        /// Lowest allowed.
        lower: f64,
        /// Highest allowed.
        upper: f64,
    },
    /// A supervisor that could not be built.
    Supervisor(FuzzyError),
    /// Two settings that exclude each other.
    Conflict {
        /// The sentence.
        what: &'static str,
    },
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number { what, found, allowed } => {
                write!(f, "{what} is {found:?}; allowed is {allowed}")
            }
            Self::EmptyRange { what, lower, upper } => write!(
                f,
                "{what} are {lower:?} to {upper:?}; the lower must be below the upper, and neither NaN"
            ),
            Self::OutsideLimits { what, found, lower, upper } => {
                write!(f, "{what} is {found:?}, outside its limits {lower:?} to {upper:?}")
            }
            Self::Supervisor(error) => error.fmt(f),
            Self::Conflict { what } => f.write_str(what),
        }
    }
}

impl core::error::Error for ConfigError {}

impl From<FuzzyError> for ConfigError {
    fn from(error: FuzzyError) -> Self {
        Self::Supervisor(error)
    }
}

/// `value` if it is finite, above zero and not denormal: a quotient by it must not overflow.
pub(crate) fn positive<R: Real>(what: ControllerSetting, value: R) -> Result<R, ConfigError> {
    at_least(R::MIN_POSITIVE, what, value, "a finite number above 0")
}

/// `value` if it is finite and not below zero.
pub(crate) fn not_negative<R: Real>(what: ControllerSetting, value: R) -> Result<R, ConfigError> {
    at_least(R::ZERO, what, value, "a finite number, 0 or above")
}

/// `value` if it is finite.
pub(crate) fn finite<R: Real>(what: ControllerSetting, value: R) -> Result<R, ConfigError> {
    allowed_if(value.is_finite(), what, value, "a finite number")
}

/// `value` if it is finite and not below `least`.
pub(crate) fn at_least<R: Real>(
    least: R,
    what: ControllerSetting,
    value: R,
    allowed: &'static str,
) -> Result<R, ConfigError> {
    // NaN fails both.
    allowed_if(value.is_finite() && value >= least, what, value, allowed)
}

/// `value` if it is `good`.
pub(crate) fn allowed_if<R: Real>(
    good: bool,
    what: ControllerSetting,
    value: R,
    allowed: &'static str,
) -> Result<R, ConfigError> {
    if good {
        return Ok(value);
    }
    let found = value.to_f64();
    Err(ConfigError::Number { what, found, allowed })
}
