//! Poles of a sampled loop, open and closed.

use super::SampledLoop;
use crate::complex::{Complex, modulus, sort};
use crate::eigenvalues::eigenvalues;
use crate::error::LtiError;
use crate::matrix::Matrix;

impl SampledLoop {
    /// Poles of the open loop in the z plane, sorted as [`eigenvalues`](crate::eigenvalues()) does.
    ///
    /// # Errors
    /// As [`eigenvalues`](crate::eigenvalues()).
    pub fn open_poles(&self) -> Result<Vec<Complex>, LtiError> {
        self.closed_poles_at(0.0)
    }

    /// Poles of the closed loop in the z plane.
    ///
    /// # Errors
    /// As [`eigenvalues`](crate::eigenvalues()).
    pub fn closed_poles(&self) -> Result<Vec<Complex>, LtiError> {
        self.closed_poles_at(1.0)
    }

    /// Poles of the loop closed with a factor on its gain.
    ///
    /// # Errors
    /// A factor that is not finite; as [`eigenvalues`](crate::eigenvalues()).
    pub fn closed_poles_at(&self, factor: f64) -> Result<Vec<Complex>, LtiError> {
        poles(&self.reduced.closed(factor))
    }
}

/// A spectral radius from here on counts as unstable: eigenvalues are not known better, and a mode that takes longer
/// than 10⁹ samples to decay is none that a controller holds.
pub(super) const STABLE_BELOW: f64 = 1.0 - 1e-9;

/// How far rounding may move the outermost poles of a loop that is called stable, over their distance from the unit
/// circle. Loops in natural states reach 10⁻⁴ within 10⁻⁹ of their limit; from 1 on the verdict would be a guess.
const SHARE_ALLOWED: f64 = 0.1;

/// Angles of the poles from the positive real axis, between 0 and π.
pub(super) fn angles_rad(poles: &[Complex]) -> Vec<f64> {
    poles.iter().map(|pole| libm::atan2(pole.im.abs(), pole.re)).collect()
}

impl SampledLoop {
    /// Spectral radius of a closed loop that is not stable, `None` for one that is: what [`margins`](Self::margins)
    /// says of it, without margins, which take some ten times as long.
    ///
    /// # Errors
    /// Poles that rounding may carry across the unit circle; eigenvalues that do not converge.
    pub fn unstable_radius(&self) -> Result<Option<f64>, LtiError> {
        let (_, spectral_radius, stable) = self.verdict()?;
        Ok((!stable).then_some(spectral_radius))
    }

    /// Poles of the closed loop and whether it is stable, which it only is if rounding cannot tell otherwise.
    pub(super) fn verdict(&self) -> Result<(Vec<Complex>, f64, bool), LtiError> {
        let poles = self.closed_poles()?;
        let spectral_radius = radius(&poles);
        let stable = spectral_radius < STABLE_BELOW;
        if stable {
            let share = self.reduced.rounding_share(&poles);
            if !(share < SHARE_ALLOWED) {
                let allowed = SHARE_ALLOWED;
                return Err(LtiError::Blurred { spectral_radius, share, allowed });
            }
        }
        Ok((poles, spectral_radius, stable))
    }
}

/// Poles of a matrix less the identity.
fn poles(matrix: &Matrix) -> Result<Vec<Complex>, LtiError> {
    let mut found = eigenvalues(matrix)?;
    for pole in &mut found {
        pole.re += 1.0;
    }
    sort(&mut found);
    Ok(found)
}

/// Largest modulus.
pub(super) fn radius(poles: &[Complex]) -> f64 {
    let sizes = poles.iter().map(|&pole| modulus(pole));
    sizes.fold(0.0, |largest, size| if size <= largest { largest } else { size })
}
