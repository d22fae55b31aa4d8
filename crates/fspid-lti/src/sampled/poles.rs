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

/// A spectral radius this near to 1 is on neither side: eigenvalues are not known better, and what takes longer than 10⁹
/// samples to decay or to grow is nothing that a controller holds or loses.
const EDGE: f64 = 1e-9;
/// A loop is stable below.
pub(super) const STABLE_BELOW: f64 = 1.0 - EDGE;

/// How far rounding may move the outermost poles of a loop that is called stable or unstable, over their distance from
/// the unit circle. Loops in natural states reach 10⁻⁴ within 10⁻⁹ of their limit; from 1 on the verdict would be a guess.
const SHARE_ALLOWED: f64 = 0.1;

/// Outermost poles that are asked of a loop that is called stable.
const STABLE_ASKED: usize = 2;

/// Angles of the poles from the positive real axis, between 0 and π.
pub(super) fn angles_rad(poles: &[Complex]) -> Vec<f64> {
    poles.iter().map(|pole| libm::atan2(pole.im.abs(), pole.re)).collect()
}

impl SampledLoop {
    /// Spectral radius of a closed loop that is unstable, `None` for a stable one. It takes a tenth of the time of
    /// [`margins`](Self::margins), which have no third answer and call what is at the edge unstable.
    ///
    /// # Errors
    /// A loop that is undecided ([`LtiError::undecided_radius`]): poles that cannot be told from the unit circle, or that
    /// rounding may carry across to either side; eigenvalues that do not converge.
    pub fn unstable_radius(&self) -> Result<Option<f64>, LtiError> {
        let (poles, spectral_radius, stable) = self.verdict()?;
        if stable {
            return Ok(None);
        }
        if spectral_radius <= 1.0 + EDGE {
            return Err(LtiError::AtEdge { spectral_radius });
        }
        // One pole outside is enough, so that the outermost alone is asked. One without a number is outside.
        let share = self.reduced.rounding_share(&poles, 1);
        if share >= SHARE_ALLOWED {
            return Err(LtiError::Blurred { spectral_radius, share, allowed: SHARE_ALLOWED });
        }
        Ok(Some(spectral_radius))
    }

    /// Poles of the closed loop and whether it is stable, which it only is if rounding cannot tell otherwise.
    pub(super) fn verdict(&self) -> Result<(Vec<Complex>, f64, bool), LtiError> {
        let poles = self.closed_poles()?;
        let spectral_radius = radius(&poles);
        let stable = spectral_radius < STABLE_BELOW;
        if stable {
            let share = self.reduced.rounding_share(&poles, STABLE_ASKED);
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
