//! Resonance peaks of the closed-loop frequency response of continuous loops: sensitivity and complementary sensitivity.

use super::FrequencyResponse;
use crate::error::LtiError;
use crate::polynomial::Polynomial;
use crate::sampled::{DiskMargin, Peak};
use crate::transfer_function::TransferFunction;

impl FrequencyResponse {
    /// Largest sensitivity $M_s = \max |S|$, $S = 1/(1 + L)$, of the loop closed with negative feedback.
    ///
    /// The highest of the values where the slope of the gain vanishes, which are roots of a polynomial, at rest and at
    /// infinite frequency.
    ///
    /// # Errors
    /// A dead time, with which there is no such polynomial; a closed loop that is not stable; as
    /// [`FrequencyResponse::margins`].
    pub fn peak_sensitivity(&self) -> Result<Peak, LtiError> {
        self.peak_of(1.0)
    }

    /// Disk margin of a skew.
    ///
    /// # Errors
    /// A skew that is not finite; as [`FrequencyResponse::peak_sensitivity`].
    pub fn disk_margin(&self, skew: f64) -> Result<DiskMargin, LtiError> {
        LtiError::unless_finite("skew of the disk", &[skew])?;
        // S + (σ − 1)/2 = (1 + σ)/2 − T.
        let peak = self.peak_of(0.5 * (1.0 + skew))?;
        Ok(DiskMargin::new(1.0 / peak.value, skew, peak.omega_rad_s))
    }

    /// Largest distance of $T = L/(1 + L)$ from a real number.
    fn peak_of(&self, centre: f64) -> Result<Peak, LtiError> {
        if self.delay_s > 0.0 {
            return Err(LtiError::DeadTime { delay_s: self.delay_s });
        }
        let unstable_poles = self.margins()?.unstable_poles;
        if unstable_poles > 0 {
            return Err(LtiError::UnstablePoles { unstable_poles });
        }
        let (over, under) = (self.system.numerator(), self.system.denominator());
        let distance = combined(under, centre, over, centre - 1.0)?;
        let closed = over.sum(under)?;
        Ok(Self::new(TransferFunction::from_polynomials(distance, closed)?, 0.0)?.highest())
    }

    /// Largest gain and its frequency, which is infinite where nothing is higher than what passes at once.
    fn highest(&self) -> Peak {
        let at = |omega_rad_s: f64| Peak { value: self.gain(omega_rad_s), omega_rad_s };
        let turns = self.gain_turns_rad_s.iter().copied();
        let places = core::iter::once(0.0).chain(turns).map(at);
        let mut best = at(0.0);
        for peak in places {
            best = if peak.value > best.value { peak } else { best };
        }
        let (over, under) = (self.system.numerator(), self.system.denominator());
        let value = (over.leading() / under.leading()).abs();
        if over.degree() == under.degree() && value > best.value {
            best = Peak { value, omega_rad_s: f64::INFINITY };
        }
        best
    }
}

/// Sum of two polynomials times factors, either of which may be 0.
fn combined(
    first: &Polynomial,
    factor: f64,
    second: &Polynomial,
    other: f64,
) -> Result<Polynomial, LtiError> {
    let size = first.degree().max(second.degree());
    let at = |polynomial: &Polynomial, power: usize| {
        let place = polynomial.degree().checked_sub(power);
        place.map_or(0.0, |place| polynomial.coefficients()[place])
    };
    let term = |power: usize| factor * at(first, power) + other * at(second, power);
    let falling: Vec<f64> = (0..=size).rev().map(term).skip_while(|&value| value == 0.0).collect();
    Polynomial::new(&falling)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn response(numerator: &[f64], denominator: &[f64], delay_s: f64) -> FrequencyResponse {
        let system = TransferFunction::new(numerator, denominator).expect("a test system");
        FrequencyResponse::new(system, delay_s).expect("roots")
    }

    #[test]
    fn a_servo_loop_of_second_order_peaks_where_textbooks_say() {
        // L = 1/(s (s + 2 ζ)): T = 1/(s² + 2 ζ s + 1), S = s (s + 2 ζ) T; with ζ = 1/2, |S|² is
        // w (w + 1)/(w² − w + 1) in w = ω², which is highest at w = (1 + √3)/2.
        let found = response(&[1.0], &[1.0, 1.0, 0.0], 0.0).peak_sensitivity().expect("stable");
        let w = 0.5 * (1.0 + 3.0_f64.sqrt());
        let expected = (w * (w + 1.0) / (w * w - w + 1.0)).sqrt();
        assert!((found.value - expected).abs() < 1e-14, "{found:?} {expected}");
        assert!((found.omega_rad_s - w.sqrt()).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn a_first_order_loop_bears_every_disk_of_size_two() {
        // S − 1/2 is all-pass for an integrator: 1/2 at every frequency.
        let found = response(&[3.0], &[1.0, 0.0], 0.0).disk_margin(0.0).expect("stable");
        assert!((found.size - 2.0).abs() < 1e-14, "{found:?}");
        assert!(found.omega_rad_s.abs() < 1e-14, "the lowest of all: {found:?}");
        // T is 1 at rest and less beyond: with a skew of −1 the disk is 1/max |T|.
        let found = response(&[3.0], &[1.0, 0.0], 0.0).disk_margin(-1.0).expect("stable");
        assert!((found.size - 1.0).abs() < 1e-14 && found.omega_rad_s.abs() < 1e-14, "{found:?}");
        // S rises to 1 at infinite frequency, in whichever units the loop is written.
        for unit in [1.0, 2.0] {
            let open = response(&[3.0 * unit], &[unit, 0.0], 0.0);
            let found = open.peak_sensitivity().expect("stable");
            assert!(
                found.omega_rad_s.is_infinite() && (found.value - 1.0).abs() < 1e-15,
                "{found:?}"
            );
        }
    }

    #[test]
    fn loops_without_such_peaks_are_refused() {
        let unstable = response(&[9.0], &[1.0, 3.0, 3.0, 1.0], 0.0).peak_sensitivity();
        assert_eq!(unstable, Err(LtiError::UnstablePoles { unstable_poles: 2 }));
        let late = response(&[1.0], &[1.0, 1.0], 0.5).peak_sensitivity();
        assert_eq!(late, Err(LtiError::DeadTime { delay_s: 0.5 }));
        assert!(response(&[1.0], &[1.0, 1.0], 0.0).disk_margin(f64::NAN).is_err());
    }
}
