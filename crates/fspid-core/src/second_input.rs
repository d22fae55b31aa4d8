//! The supervisor's second input (change of error, pitch rate or reference-model error) and the spacing of its fuzzy sets.

use fspid_numeric::{Real, Scalar};

use crate::controller_setting::ControllerSetting;
use crate::error::{ConfigError, allowed_if, positive};

/// A step of the reference model covers at most this part of $1 / \omega$: then its discrete poles
/// are stable for every damping up to [`MOST_DAMPING`] ($\zeta \omega T < 1$ and
/// $4 \zeta \omega T + (\omega T)^2 < 4$, the conditions of Jury).
const LONGEST_STEP: f64 = 0.5;
/// Largest damping of a reference model; above it, the model is as good as one of first order.
const MOST_DAMPING: f64 = 1.5;

/// What the supervisor sees beside the error. The scale of the change belongs to it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum SecondInput<R> {
    /// The change of the error, as [`Change`](crate::Change) says.
    #[default]
    Change,
    /// The measured pitch rate with its sign turned, $-q$ in rad/s: the rate of the error wherever the
    /// set-point rests, without the noise of a difference and without the jump at a step.
    Rate,
    /// How far the pitch is behind a reference model, $y_m - y$ in rad. Where it has the sign of the
    /// error the loop is slower than the model, else it is faster: an accumulating law with rules that
    /// tell the two apart adapts the gains to the plant.
    ModelError(ReferenceModel<R>),
}

impl<R> SecondInput<R> {
    /// Name in files.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Change => "error-and-change",
            Self::Rate => "error-and-rate",
            Self::ModelError(_) => "error-and-model-error",
        }
    }

    /// What stands beside the error, in words.
    #[must_use]
    pub const fn beside(&self) -> &'static str {
        match self {
            Self::Change => "change of error",
            Self::Rate => "pitch rate, sign turned",
            Self::ModelError(_) => "error of the reference model",
        }
    }
}

/// How the pitch should follow the set-point:
/// $\ddot y_m = \omega^2 (r - y_m) - 2 \zeta \omega \dot y_m$.
///
/// Sampled with the speed before the place, $\dot y_m \leftarrow \dot y_m + T \ddot y_m$ and then
/// $y_m \leftarrow y_m + T \dot y_m$; it starts at rest at the first measurement. The supervisor sees
/// at a sample what the set-points before it have made of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceModel<R> {
    /// $\omega$, rad/s.
    pub bandwidth_rad_s: R,
    /// $\zeta$.
    pub damping: R,
}

/// Where a reference model is at a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelState<R> {
    /// Its pitch, rad.
    pub pitch_rad: R,
    /// Its pitch rate, rad/s.
    pub rate_rad_s: R,
}

impl<R: Real> ModelState<R> {
    /// At rest.
    pub fn at(pitch_rad: R) -> Self {
        Self { pitch_rad, rate_rad_s: R::ZERO }
    }
}

impl<R: Real> ReferenceModel<R> {
    pub(crate) fn check(&self, dt_s: R) -> Result<(), ConfigError> {
        positive(ControllerSetting::ModelBandwidth, self.bandwidth_rad_s)?;
        positive(ControllerSetting::ModelDamping, self.damping)?;
        let damped = self.damping <= R::from_f64(MOST_DAMPING);
        allowed_if(damped, ControllerSetting::ModelDamping, self.damping, "at most 1.5")?;
        let slow = self.bandwidth_rad_s * dt_s <= R::from_f64(LONGEST_STEP);
        let what = ControllerSetting::ModelBandwidth;
        allowed_if(slow, what, self.bandwidth_rad_s, "at most 0.5 over the sample period")?;
        Ok(())
    }
}

impl<S: Scalar> ReferenceModel<S> {
    /// Where the model is at the next sample.
    #[inline(always)]
    pub fn next(&self, now: ModelState<S>, setpoint_rad: S, dt_s: S) -> ModelState<S> {
        let spring = self.bandwidth_rad_s * self.bandwidth_rad_s;
        let brake = S::constant(2.0) * self.damping * self.bandwidth_rad_s;
        let pull = spring * (setpoint_rad - now.pitch_rad) - brake * now.rate_rad_s;
        let rate_rad_s = now.rate_rad_s + pull * dt_s;
        ModelState { pitch_rad: now.pitch_rad + rate_rad_s * dt_s, rate_rad_s }
    }
}

/// Where the centres of the small and the medium sets of an input lie, as fractions of its range:
/// those of the positive ones, the negative ones mirrored. Even is `[1/3, 2/3]`.
///
/// The input is transformed before the rules, which keep their even sets: an odd, increasing function, linear
/// from 0 to the small centre, on to the medium one and to the range, takes these centres to one and
/// two thirds of the range.
///
/// For triangular sets that reach from neighbour to neighbour this is the same as moving the
/// triangles. With centres $c_i$ and the function $w$ with $w(c_i) = i L / 3$ that is linear in
/// between, an input $x = c_i + t (c_{i+1} - c_i)$, $0 \le t \le 1$, has the grades $1 - t$ and $t$ in
/// the two sets next to it, and 0 in all others; $w(x) = (i + t) L / 3$ has the very same grades in the
/// even sets. Of the Gaussian sets here the grades at the centres and where neighbours cross are
/// those of moved sets; the flanks are stretched with the distance to the neighbour on each side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetCentres<R> {
    /// Of the small sets.
    small: R,
    /// Of the medium sets.
    medium: R,
}

impl<R: Real> SetCentres<R> {
    /// Centres at these fractions of the range.
    ///
    /// # Errors
    /// [`ConfigError::Number`] unless $0 < small < medium < 1$.
    pub fn new(small: R, medium: R) -> Result<Self, ConfigError> {
        let what = ControllerSetting::SmallSets;
        let small = allowed_if(small > R::ZERO && small < R::ONE, what, small, "above 0, below 1")?;
        let (what, good) = (ControllerSetting::MediumSets, medium > small && medium < R::ONE);
        let medium = allowed_if(good, what, medium, "above that of the small sets, below 1")?;
        Ok(Self { small, medium })
    }

    /// The centres of sets that were built, as a constant; nothing is checked.
    #[must_use]
    pub const fn new_unchecked(small: R, medium: R) -> Self {
        Self { small, medium }
    }

    /// Of the small sets.
    pub fn small(&self) -> R {
        self.small
    }

    /// Of the medium sets.
    pub fn medium(&self) -> R {
        self.medium
    }

    /// The input as the even sets see it. One beyond the range stays as it is.
    #[inline(always)]
    pub fn warp(&self, input: R, range: R) -> R {
        let third = R::ONE / R::from_f64(3.0);
        let part = input.abs() / range;
        let warp = if part <= self.small {
            third * (part / self.small)
        } else if part <= self.medium {
            third + third * ((part - self.small) / (self.medium - self.small))
        } else if part < R::ONE {
            (third + third) + third * ((part - self.medium) / (R::ONE - self.medium))
        } else {
            part
        };
        let size = if part < R::ONE { warp.smaller(R::ONE) * range } else { input.abs() };
        if input < R::ZERO { -size } else { size }
    }
}
