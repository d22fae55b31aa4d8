//! Where a sampled loop has a given gain, and where its value is real.

use core::f64::consts::PI;

use super::bracket::Proof;
use super::reduced::{Reduced, Response};
use super::squares::Squares;
use super::{SampledLoop, scan};
use crate::complex::modulus;
use crate::error::LtiError;

/// Values beyond this are those of a pole on the unit circle: rounding splits several at one place, and between the
/// parts the phase means nothing.
const POLE: f64 = 1e10;
/// Angles this near to 0 and π are taken for them: rounding decides the sign of what is real there.
const END_RAD: f64 = 1e-10;

impl SampledLoop {
    /// All frequencies in rad/s above 0, up to Nyquist's, at which the gain has a value above 0, rising.
    ///
    /// # Errors
    /// A level that is not above zero and finite; eigenvalues that do not converge; real poles so dense that no place on
    /// the real axis keeps clear of them to working precision.
    pub fn gain_crossings(&self, level: f64) -> Result<Vec<f64>, LtiError> {
        if !(level > 0.0 && level.is_finite()) {
            return Err(LtiError::NotPositive { what: "gain to be crossed", value: level });
        }
        let scaled = self.reduced.scaled(1.0 / level);
        let proof = self.proof_scaled(1.0 / level);
        let angles = unit_gain_angles(&scaled, &Squares::new(&scaled)?, proof.as_ref())?;
        Ok(self.frequencies(angles))
    }

    /// All frequencies in rad/s at which the value is real, rising; with 0 and Nyquist's, where it always is.
    ///
    /// At a pole on the unit circle, such as an integrator's, there is no crossing: values beyond 10¹⁰ are left out.
    ///
    /// # Errors
    /// As [`SampledLoop::gain_crossings`].
    pub fn real_crossings(&self) -> Result<Vec<f64>, LtiError> {
        Ok(self
            .frequencies(self.real_angles(&Squares::new(&self.reduced)?, self.proof().as_ref())?))
    }

    /// The same as angles ωT.
    pub(super) fn real_angles(
        &self,
        squares: &Squares<'_>,
        proof: Option<&Proof>,
    ) -> Result<Vec<f64>, LtiError> {
        let candidates = squares.angles_of_real_values()?;
        let across = |angle_rad: f64| sine(self.response(angle_rad));
        let ends = (END_RAD, PI - END_RAD);
        let mut inside = scan::sign_changes(across, &candidates, ends);
        if let Some(proof) = proof {
            inside = proof.real_angles(inside, ends);
        }
        let finite = |angle_rad: &f64| modulus(self.response(*angle_rad).open()) < POLE;
        Ok(core::iter::once(0.0).chain(inside).chain([PI]).filter(finite).collect())
    }

    pub(super) fn frequencies(&self, angles: Vec<f64>) -> Vec<f64> {
        angles.into_iter().map(|angle_rad| angle_rad / self.dt_s).collect()
    }
}

/// Angles ωT above 0 at which $|L| = 1$.
pub(super) fn unit_gain_angles(
    reduced: &Reduced,
    squares: &Squares<'_>,
    proof: Option<&Proof>,
) -> Result<Vec<f64>, LtiError> {
    let candidates = squares.angles_of_unit_gain()?;
    let above = |angle_rad: f64| excess(reduced.at(super::zeta(angle_rad)));
    let found = scan::sign_changes(above, &candidates, (END_RAD, PI));
    Ok(match proof {
        Some(proof) => proof.unit_gain_angles(found, (END_RAD, PI)),
        None => found,
    })
}

/// $|L|^2 - 1$ over $|L|^2 + 1$.
pub(super) fn excess(response: Response) -> f64 {
    let (over, under) = (response.over.norm_sqr(), response.under.norm_sqr());
    (over - under) / (over + under)
}

/// Sine of the phase.
pub(super) fn sine(response: Response) -> f64 {
    let (over, under) = (response.over, response.under);
    let size = (over.norm_sqr() * under.norm_sqr()).sqrt();
    if size > 0.0 { (over * under.conj()).im / size } else { 0.0 }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "the same bits are asked for")]
mod tests {
    use super::*;
    use crate::complex::Complex;

    #[test]
    fn at_a_zero_and_at_a_pole_there_is_no_side() {
        let (nothing, one) = (Complex::new(0.0, 0.0), Complex::new(0.0, 1.0));
        for (over, under) in [(nothing, one), (one, nothing)] {
            assert_eq!(sine(Response { over, under }), 0.0);
        }
        assert_eq!(sine(Response { over: one, under: Complex::new(2.0, 0.0) }), 1.0);
    }
}
