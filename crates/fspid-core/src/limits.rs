//! An interval a value is kept in.

use fspid_numeric::Real;

use crate::controller_setting::ControllerSetting;
use crate::error::ConfigError;

/// A closed interval; its ends may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits<R> {
    lower: R,
    upper: R,
}

impl<R: Real> Limits<R> {
    /// The interval from `lower` to `upper`; `what` names it in the error.
    ///
    /// # Errors
    /// [`ConfigError::EmptyRange`] unless `lower < upper`.
    pub fn new(what: ControllerSetting, lower: R, upper: R) -> Result<Self, ConfigError> {
        if lower < upper {
            return Ok(Self { lower, upper });
        }
        let (lower, upper) = (lower.to_f64(), upper.to_f64());
        Err(ConfigError::EmptyRange { what, lower, upper })
    }

    /// The ends of an interval that was built, as a constant; nothing is checked.
    #[must_use]
    pub const fn new_unchecked(lower: R, upper: R) -> Self {
        Self { lower, upper }
    }

    /// Lower end.
    pub fn lower(&self) -> R {
        self.lower
    }

    /// Upper end.
    pub fn upper(&self) -> R {
        self.upper
    }

    /// The nearest value within the interval; NaN stays NaN.
    pub fn clamp(&self, value: R) -> R {
        value.limited(self.lower, self.upper)
    }
}
