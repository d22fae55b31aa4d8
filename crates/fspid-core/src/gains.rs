//! Gains of a PID controller in parallel form, and the bounds they may be kept in.

use fspid_fuzzy::Increments;
use fspid_numeric::Real;

use crate::controller_setting::ControllerSetting;
use crate::error::{ConfigError, allowed_if, finite, not_negative};
use crate::limits::Limits;

/// Gains in parallel form: $u = k_p e + k_i \int e \ dt + k_d \dot e$.
///
/// `kp` in command per error, `ki` per second, `kd` in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains<R> {
    /// Proportional gain, rad/rad.
    pub kp: R,
    /// Integral gain, rad/(rad s).
    pub ki: R,
    /// Derivative gain, rad/(rad/s).
    pub kd: R,
}

impl<R: Real> Gains<R> {
    /// No gains.
    pub const ZERO: Self = Self { kp: R::ZERO, ki: R::ZERO, kd: R::ZERO };

    /// From the ISA form $u = K (e + \frac{1}{T_i} \int e \ dt + T_d \dot e)$; an infinite `ti_s`
    /// means no integral action. A filter is [`Derivative::from_isa`](crate::Derivative::from_isa).
    ///
    /// # Errors
    /// [`ConfigError::Number`] for a gain or time that is not finite, a `ti_s` that is not positive
    /// and a negative `td_s`, or where a gain of the parallel form overflows.
    pub fn from_isa(gain: R, ti_s: R, td_s: R) -> Result<Self, ConfigError> {
        let gain = finite(ControllerSetting::Gain, gain)?;
        // Infinity passes, NaN does not.
        let ti_s =
            allowed_if(ti_s > R::ZERO, ControllerSetting::IntegralTime, ti_s, "a number above 0")?;
        let td_s = not_negative(ControllerSetting::DerivativeTime, td_s)?;
        Self { kp: gain, ki: gain / ti_s, kd: gain * td_s }.checked()
    }

    /// The gains if each is finite.
    ///
    /// # Errors
    /// [`ConfigError::Number`] naming the first gain that is not.
    pub fn checked(self) -> Result<Self, ConfigError> {
        Ok(Self {
            kp: finite(ControllerSetting::Kp, self.kp)?,
            ki: finite(ControllerSetting::Ki, self.ki)?,
            kd: finite(ControllerSetting::Kd, self.kd)?,
        })
    }

    pub(crate) fn are_finite(self) -> bool {
        self.kp.is_finite() && self.ki.is_finite() && self.kd.is_finite()
    }

    /// Gain by gain, `f(self, other)`.
    pub(crate) fn zip(self, other: Self, f: impl Fn(R, R) -> R) -> Self {
        Self { kp: f(self.kp, other.kp), ki: f(self.ki, other.ki), kd: f(self.kd, other.kd) }
    }
}

impl<R: Real> From<Increments<R>> for Gains<R> {
    fn from(Increments { kp, ki, kd }: Increments<R>) -> Self {
        Self { kp, ki, kd }
    }
}

/// Bounds of the total gains (nominal plus increment).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GainLimits<R> {
    /// Of the proportional gain.
    pub kp: Limits<R>,
    /// Of the integral gain.
    pub ki: Limits<R>,
    /// Of the derivative gain.
    pub kd: Limits<R>,
}

impl<R: Real> GainLimits<R> {
    /// The gains moved into the limits.
    pub(crate) fn apply(&self, gains: Gains<R>) -> Gains<R> {
        Gains {
            kp: self.kp.clamp(gains.kp),
            ki: self.ki.clamp(gains.ki),
            kd: self.kd.clamp(gains.kd),
        }
    }

    /// Refuses nominal gains that would be cut at once.
    pub(crate) fn check(&self, nominal: Gains<R>) -> Result<(), ConfigError> {
        for (what, found, limits) in [
            (ControllerSetting::NominalKp, nominal.kp, self.kp),
            (ControllerSetting::NominalKi, nominal.ki, self.ki),
            (ControllerSetting::NominalKd, nominal.kd, self.kd),
        ] {
            if limits.clamp(found) != found {
                return Err(ConfigError::OutsideLimits {
                    what,
                    found: found.to_f64(),
                    lower: limits.lower().to_f64(),
                    upper: limits.upper().to_f64(),
                });
            }
        }
        Ok(())
    }
}
