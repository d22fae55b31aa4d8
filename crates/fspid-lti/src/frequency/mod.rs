//! The frequency response of a continuous system with a dead time: gain, phase without jumps, and where they cross.
//!
//! For margins and flying qualities. Crossings are not read off a grid: between the frequencies at which gain or phase
//! turn round, which are roots of polynomials, each is monotone, so no crossing is missed and each is found to the
//! last digits. Not for sampled loops: see [`SampledLoop`](crate::SampledLoop).

mod crossing;
mod margins;
mod parts;
mod peak;

use crate::complex::{Complex, modulus};
use crate::error::LtiError;
use crate::transfer_function::TransferFunction;
use parts::Parts;

pub use margins::{Crossover, Margins, NeutralGain};

/// Error of a phase that roots of several fold may have.
const BLUR_RAD: f64 = 0.1;

/// Response of a system followed by a dead time.
///
/// $$ L(j \omega) = G(j \omega) e^{-j \omega \tau} $$
///
/// # Example
/// The paper's Navion with its servo and proportional control of gain 1 is neutral at a gain of 4:
/// ```
/// use fspid_lti::{FrequencyResponse, LtiError, TransferFunction};
///
/// # fn main() -> Result<(), LtiError> {
/// let plant = TransferFunction::new(&[11.7304, 22.578], &[1.0, 4.9676, 12.941, 0.0])?;
/// let servo = TransferFunction::new(&[10.0], &[1.0, 10.0])?;
/// let margins = FrequencyResponse::new(plant.series(&servo)?, 0.0)?.margins()?;
/// assert!(margins.stable());
/// assert!((margins.gain_margin().unwrap() - 4.005).abs() < 5e-4);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct FrequencyResponse {
    system: TransferFunction,
    delay_s: f64,
    zeros: Vec<Complex>,
    poles: Vec<Complex>,
    /// Frequencies at which the gain turns round.
    gain_turns_rad_s: Vec<f64>,
    /// Frequencies at which the phase turns round or jumps.
    phase_turns_rad_s: Vec<f64>,
}

impl FrequencyResponse {
    /// Response of a system and a dead time, which may be 0.
    ///
    /// # Errors
    /// A dead time that is negative or not finite; roots that cannot be found.
    pub fn new(system: TransferFunction, delay_s: f64) -> Result<Self, LtiError> {
        if !(delay_s >= 0.0 && delay_s.is_finite()) {
            return Err(LtiError::Negative { what: "dead time in seconds", value: delay_s });
        }
        let (zeros, poles) = (system.zeros()?, system.poles()?);
        let [numerator, denominator] = [system.numerator(), system.denominator()].map(Parts::of);
        let gain_turns_rad_s = parts::gain_turns(&numerator, &denominator)?;
        let mut phase_turns_rad_s = parts::phase_turns(&numerator, &denominator, delay_s)?;
        let undamped = zeros.iter().chain(&poles).filter(|root| root.re == 0.0 && root.im > 0.0);
        phase_turns_rad_s.extend(undamped.map(|root| root.im));
        phase_turns_rad_s.sort_by(f64::total_cmp);
        Ok(Self { system, delay_s, zeros, poles, gain_turns_rad_s, phase_turns_rad_s })
    }

    /// The system without its dead time.
    #[must_use]
    pub fn system(&self) -> &TransferFunction {
        &self.system
    }

    /// Dead time.
    #[must_use]
    pub fn delay_s(&self) -> f64 {
        self.delay_s
    }

    /// Value at a frequency; infinite or NaN at a pole.
    #[must_use]
    pub fn at(&self, omega_rad_s: f64) -> Complex {
        let (sin, cos) = libm::sincos(-omega_rad_s * self.delay_s);
        self.system.at(Complex::new(0.0, omega_rad_s)) * Complex::new(cos, sin)
    }

    /// Gain at a frequency.
    #[must_use]
    pub fn gain(&self, omega_rad_s: f64) -> f64 {
        modulus(self.system.at(Complex::new(0.0, omega_rad_s)))
    }

    /// Phase at a frequency above 0 in rad, without jumps.
    ///
    /// $$ \varphi(\omega) = \varphi_0 + \sum_z \angle (1 - j\omega/z) - \sum_p \angle (1 - j\omega/p) - \omega \tau $$
    ///
    /// Each integrator gives −π/2, a differentiator π/2, a negative sign −π. Each two unstable poles are counted with
    /// −2π, so that at high frequency an aircraft with a slow unstable mode has the phase of one with a stable mode.
    /// The roots only tell the number of turns: the rest comes from the value itself, which multiple roots do not blur.
    #[must_use]
    pub fn phase_rad(&self, omega_rad_s: f64) -> f64 {
        let by_roots = self.phase_by_roots_rad(omega_rad_s);
        let value = self.at(omega_rad_s);
        let off =
            libm::remainder(libm::atan2(value.im, value.re) - by_roots, core::f64::consts::TAU);
        if off.abs() < BLUR_RAD { by_roots + off } else { by_roots }
    }

    fn phase_by_roots_rad(&self, omega_rad_s: f64) -> f64 {
        let sum = |roots: &[Complex]| {
            roots.iter().fold(0.0, |sum, root| sum + root_phase_rad(*root, omega_rad_s))
        };
        self.phase_offset_rad() + sum(&self.zeros) - sum(&self.poles) - omega_rad_s * self.delay_s
    }

    /// What the sign of the gain and the unstable poles add to the phase.
    fn phase_offset_rad(&self) -> f64 {
        let pairs = self.unstable_poles() / 2;
        let lowest = |polynomial: &crate::Polynomial| {
            let coefficients = polynomial.coefficients();
            coefficients[coefficients.len() - 1 - polynomial.roots_at_origin()]
        };
        let positive =
            (lowest(self.system.numerator()) > 0.0) == (lowest(self.system.denominator()) > 0.0);
        let sign_rad = if positive { 0.0 } else { -core::f64::consts::PI };
        sign_rad - core::f64::consts::TAU * pairs as f64
    }

    fn unstable_poles(&self) -> usize {
        self.poles.iter().filter(|pole| pole.re > 0.0).count()
    }

    /// All frequencies in rad/s at which the gain has a value, rising.
    #[must_use]
    pub fn gain_crossings(&self, level: f64) -> Vec<f64> {
        let above = |omega_rad_s: f64| libm::log(self.gain(omega_rad_s)) - libm::log(level);
        crossing::all(above, &self.gain_turns_rad_s, self.band_rad_s())
    }

    /// All frequencies in rad/s at which the phase has a value in rad, rising.
    #[must_use]
    pub fn phase_crossings(&self, phase_rad: f64) -> Vec<f64> {
        let above = |omega_rad_s: f64| self.phase_rad(omega_rad_s) - phase_rad;
        crossing::all(above, &self.phase_turns_rad_s, self.band_rad_s())
    }

    /// Frequencies between which crossings are looked for: nine decades beyond the roots on both sides.
    fn band_rad_s(&self) -> (f64, f64) {
        let sizes = self.zeros.iter().chain(&self.poles).map(|root| modulus(*root));
        let sizes = sizes.filter(|&size| size > 0.0);
        let (min, max) =
            sizes.fold((1.0_f64, 1.0_f64), |(min, max), size| (min.min(size), max.max(size)));
        (1e-9 * min, 1e9 * max)
    }
}

/// Phase of $1 - j\omega/r$ for a root, of $j\omega$ for a root at the origin, and continuous in between.
///
/// A complex root alone has no phase 0 at rest, but with its conjugate it has.
fn root_phase_rad(root: Complex, omega_rad_s: f64) -> f64 {
    let across = omega_rad_s - root.im;
    if root.re > 0.0 { -libm::atan2(across, root.re) } else { libm::atan2(across, -root.re) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::{FRAC_PI_2, PI};

    fn response(numerator: &[f64], denominator: &[f64], delay_s: f64) -> FrequencyResponse {
        let system = TransferFunction::new(numerator, denominator).expect("a test system");
        FrequencyResponse::new(system, delay_s).expect("roots")
    }

    #[test]
    fn the_phase_is_that_of_the_value_but_for_whole_turns() {
        let systems = [
            response(&[2.0, -1.0], &[1.0, 0.3, 4.0, 0.0], 0.1),
            response(&[-2.0, 1.0, 3.0], &[1.0, -0.1, 4.0, 0.2], 0.0),
            response(&[1.0, 0.0], &[1.0, -3.0, 2.0], 0.3),
            response(&[-1.0], &[1.0, 0.0, 9.0], 0.0),
        ];
        for system in &systems {
            for omega_rad_s in [1e-3, 0.2, 1.0, 1.9, 2.1, 3.5, 40.0] {
                let value = system.at(omega_rad_s);
                let turns =
                    (system.phase_rad(omega_rad_s) - libm::atan2(value.im, value.re)) / (2.0 * PI);
                assert!((turns - libm::round(turns)).abs() < 1e-9, "{omega_rad_s}: {turns}");
            }
        }
    }

    #[test]
    fn a_slow_unstable_pair_lags_like_a_stable_one() {
        let stable = response(&[1.0], &[1.0, 0.01, 0.01], 0.0);
        let unstable = response(&[1.0], &[1.0, -0.01, 0.01], 0.0);
        assert!((stable.phase_rad(10.0) - unstable.phase_rad(10.0)).abs() < 1e-2);
        assert!((stable.phase_rad(1e-6)).abs() < 1e-4);
    }

    #[test]
    fn an_integrator_with_a_dead_time_crosses_where_it_must() {
        let system = response(&[3.0], &[1.0, 0.0], 0.5);
        let crossings = system.phase_crossings(-PI);
        assert_eq!(crossings.len(), 1);
        assert!((crossings[0] - PI).abs() < 1e-14, "{crossings:?}");
        assert!((system.gain_crossings(1.0)[0] - 3.0).abs() < 1e-14);
        assert!((system.phase_rad(1e-9) + FRAC_PI_2).abs() < 1e-8);
    }

    #[test]
    fn a_resonance_is_crossed_on_both_sides_however_narrow() {
        let system = response(&[1.0], &[1.0, 2e-9, 1.0], 0.0);
        let crossings = system.gain_crossings(1e7);
        assert_eq!(crossings.len(), 2);
        // Near ω = 1 the gain is 1/(2 |ω − 1|).
        assert!((crossings[0] - (1.0 - 5e-8)).abs() < 1e-9, "{crossings:?}");
        assert!((crossings[1] - (1.0 + 5e-8)).abs() < 1e-9, "{crossings:?}");
    }

    #[test]
    fn a_lead_reaches_its_highest_phase_between_zeros_and_poles() {
        let lead = response(&[1.0, 3.0, 3.0, 1.0], &[1.0, 30.0, 300.0, 1000.0], 0.0);
        let middle_rad_s = 10.0_f64.sqrt();
        let nearest = lead.phase_turns_rad_s.iter().map(|turn| (turn - middle_rad_s).abs());
        assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-9, "{:?}", lead.phase_turns_rad_s);
        let almost = lead.phase_rad(middle_rad_s) - 1e-9;
        let crossings = lead.phase_crossings(almost);
        assert_eq!(crossings.len(), 2);
        assert!((crossings[0] * crossings[1] - 10.0).abs() < 1e-6, "{crossings:?}");
    }

    #[test]
    fn a_response_has_the_system_and_the_dead_time_that_it_was_given() {
        let system = TransferFunction::new(&[2.0], &[1.0, 3.0]).expect("a lag");
        let found = FrequencyResponse::new(system.clone(), 0.3).expect("roots");
        assert_eq!((found.system(), found.delay_s()), (&system, 0.3));
    }

    #[test]
    fn a_negative_sign_is_half_a_turn_of_lag() {
        let found = response(&[-1.0], &[1.0, 1.0], 0.0);
        assert!((found.phase_rad(1.0) + 1.25 * PI).abs() < 1e-14);
        let both = response(&[-1.0], &[-1.0, -1.0], 0.0);
        assert!((both.phase_rad(1.0) + 0.25 * PI).abs() < 1e-14);
    }

    #[test]
    fn roots_beyond_all_others_are_crossed_as_any() {
        // 10/(1 + s/p) has the gain 1 at √99 p.
        for pole in [1e-12, 1.0, 1e12] {
            let found = response(&[10.0 * pole], &[1.0, pole], 0.0).gain_crossings(1.0);
            assert!(
                found.len() == 1 && (found[0] / pole - 99.0_f64.sqrt()).abs() < 1e-13,
                "{found:?}"
            );
        }
    }

    #[test]
    fn dead_times_that_no_loop_has_are_refused() {
        let system = TransferFunction::new(&[1.0], &[1.0, 1.0]).expect("a lag");
        assert!(FrequencyResponse::new(system.clone(), -0.1).is_err());
        assert!(FrequencyResponse::new(system, f64::NAN).is_err());
    }
}
