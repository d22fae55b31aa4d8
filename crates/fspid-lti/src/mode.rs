//! What a pole means to a pilot: how fast and how well damped.

use crate::complex::{Complex, modulus};
use crate::error::LtiError;

/// Natural frequency and damping of one pole or conjugate pair.
///
/// $$ p = -\zeta \omega_n \pm j \omega_n \sqrt{1 - \zeta^2} $$
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// Undamped natural frequency in rad/s: the distance of the pole from the origin.
    pub natural_frequency_rad_s: f64,
    /// Damping ratio: 1 for a real pole on the left, negative for a pole on the right.
    pub damping_ratio: f64,
}

impl Mode {
    /// Mode of a pole of a continuous system, given in rad/s.
    ///
    /// $$ \omega_n = |p|, \quad \zeta = -\frac{\operatorname{Re} p}{|p|} $$
    ///
    /// # Errors
    /// A pole at the origin, which has no damping ratio, or one that is not finite.
    pub fn of_pole(pole: Complex) -> Result<Self, LtiError> {
        let natural_frequency_rad_s = modulus(pole);
        if natural_frequency_rad_s > 0.0 && natural_frequency_rad_s.is_finite() {
            Ok(Self { natural_frequency_rad_s, damping_ratio: -pole.re / natural_frequency_rad_s })
        } else {
            Err(LtiError::NoMode { real: pole.re, imaginary: pole.im })
        }
    }

    /// Mode of a pole of a system sampled every `dt_s` seconds, by [`continuous_pole`].
    ///
    /// # Errors
    /// As [`continuous_pole`], and a pole at 1, which is the origin of the s plane.
    pub fn of_sampled_pole(pole: Complex, dt_s: f64) -> Result<Self, LtiError> {
        Self::of_pole(continuous_pole(pole, dt_s)?)
            .map_err(|_| LtiError::NoMode { real: pole.re, imaginary: pole.im })
    }
}

/// Pole in rad/s of the continuous system that, sampled every `dt_s` seconds, has this pole.
///
/// $$ s = \frac{\ln z}{T}, \quad |\operatorname{Im} s| \le \frac{\pi}{T} $$
///
/// Near the unit circle the logarithm is taken of $|z|^2 - 1$, so slow modes keep their digits.
///
/// # Errors
/// A sample period that is not above zero and finite; a pole at 0, which decays at once, or one that is not finite.
pub fn continuous_pole(pole: Complex, dt_s: f64) -> Result<Complex, LtiError> {
    if !(dt_s > 0.0 && dt_s.is_finite()) {
        return Err(LtiError::NotPositive { what: "sample period in seconds", value: dt_s });
    }
    let size = modulus(pole);
    if !(size > 0.0 && size.is_finite()) {
        return Err(LtiError::NoMode { real: pole.re, imaginary: pole.im });
    }
    let growth = if (0.5..=2.0).contains(&size) {
        0.5 * libm::log1p((pole.re.abs() - 1.0) * (pole.re.abs() + 1.0) + pole.im * pole.im)
    } else {
        libm::log(size)
    };
    Ok(Complex::new(growth / dt_s, libm::atan2(pole.im, pole.re) / dt_s))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_gives_the_frequency_and_damping_it_was_made_of() {
        let mode = Mode::of_pole(Complex::new(-3.0, 4.0)).expect("a pole away from the origin");
        assert_eq!(mode, Mode { natural_frequency_rad_s: 5.0, damping_ratio: 0.6 });
        let unstable = Mode::of_pole(Complex::new(2.0, 0.0)).expect("a pole away from the origin");
        assert_eq!(unstable, Mode { natural_frequency_rad_s: 2.0, damping_ratio: -1.0 });
    }

    #[test]
    fn poles_without_a_mode_are_refused() {
        assert_eq!(
            Mode::of_pole(Complex::new(0.0, 0.0)),
            Err(LtiError::NoMode { real: 0.0, imaginary: 0.0 })
        );
        assert!(Mode::of_pole(Complex::new(f64::NAN, 1.0)).is_err());
        assert!(Mode::of_pole(Complex::new(f64::INFINITY, f64::NAN)).is_err());
        assert_eq!(
            Mode::of_sampled_pole(Complex::new(1.0, 0.0), 0.02),
            Err(LtiError::NoMode { real: 1.0, imaginary: 0.0 })
        );
        assert!(Mode::of_sampled_pole(Complex::new(0.0, 0.0), 0.02).is_err());
        assert!(Mode::of_sampled_pole(Complex::new(0.5, 0.0), f64::NAN).is_err());
        assert!(Mode::of_sampled_pole(Complex::new(0.5, 0.0), 0.0).is_err());
    }

    #[test]
    fn sampling_and_going_back_keeps_the_mode() {
        for (re, im) in [(-0.00227987, 0.0686141), (-0.58, -1.097), (-2.5, 2.6), (-40.0, 10.0)] {
            for dt_s in [0.001, 0.02, 0.2] {
                let sampled =
                    libm::exp(re * dt_s) * Complex::new(libm::cos(im * dt_s), libm::sin(im * dt_s));
                let back = continuous_pole(sampled, dt_s).expect("a pole away from the origin");
                // The rounding of the sampled pole itself is one part in 1e16 of 1, seen over one period.
                assert!(
                    modulus(back - Complex::new(re, im)) < 1e-15 * (1.0 / dt_s + 50.0),
                    "{re} {im} {dt_s} {back}"
                );
            }
        }
    }
}
