//! Stability margins of continuous loops with dead time: gain, phase and delay.

use core::f64::consts::PI;

use super::{FrequencyResponse, crossing};
use crate::complex::modulus;
use crate::error::LtiError;

/// A gain factor at which the loop has undamped oscillations or a pole at the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeutralGain {
    /// Factor on the loop's gain.
    pub gain: f64,
    /// Frequency; 0 for a pole at the origin.
    pub omega_rad_s: f64,
    /// How many closed-loop poles become unstable as the factor grows beyond it; negative if they become stable.
    pub poles: i32,
}

/// A frequency at which the loop's gain is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossover {
    /// Frequency.
    pub omega_rad_s: f64,
    /// Distance of the phase from ±π in rad, between −π and π; positive if lag is missing to an oscillation.
    pub phase_margin_rad: f64,
}

/// Margins of a loop with negative feedback.
///
/// A loop that is unstable has crossings but no margins: every question about them is then answered with none.
#[derive(Debug, Clone, PartialEq)]
pub struct Margins {
    /// Closed-loop poles on the right.
    pub unstable_poles: usize,
    /// Gain factors at which poles cross the imaginary axis, by rising factor.
    pub neutral_gains: Vec<NeutralGain>,
    /// Where the gain is 1, by rising frequency.
    pub crossovers: Vec<Crossover>,
}

impl FrequencyResponse {
    /// Margins of the loop closed around this response with negative feedback.
    ///
    /// Stability is counted from the crossings: with the factor k on the gain growing from 0 to 1, unstable poles
    /// appear or vanish in pairs where the phase is an odd multiple of π and the gain $1/k$, and singly where the gain
    /// at rest is $-1/k$. They appear where the phase falls with frequency:
    ///
    /// $$ \operatorname{sgn} \operatorname{Re} \frac{d s}{d k} = -\operatorname{sgn} \frac{d \varphi}{d \omega} $$
    ///
    /// # Errors
    /// A loop with feedthrough, or with more than three integrators.
    pub fn margins(&self) -> Result<Margins, LtiError> {
        if self.system.relative_degree() == 0 {
            return Err(LtiError::Feedthrough);
        }
        let mut neutral_gains = self.neutral_gains();
        neutral_gains.extend(self.neutral_at_rest());
        neutral_gains.sort_by(|left, right| left.gain.total_cmp(&right.gain));
        let start = self.unstable_poles() as i32 + self.poles_from_origin()?;
        let reached = neutral_gains.iter().filter(|neutral| neutral.gain < 1.0);
        let unstable = reached.fold(start, |sum, neutral| sum + neutral.poles);
        let unstable_poles = usize::try_from(unstable).unwrap_or(0);
        Ok(Margins { unstable_poles, neutral_gains, crossovers: self.crossovers() })
    }

    /// Crossings of the negative real axis above frequency 0.
    fn neutral_gains(&self) -> Vec<NeutralGain> {
        let band = (self.band_rad_s().0, self.highest_of_interest_rad_s());
        let ends = self.phase_turns_rad_s.iter().copied().chain([band.0, band.1]);
        let phases = ends.map(|omega| self.phase_rad(omega));
        let (min, max) =
            phases.fold((0.0_f64, 0.0_f64), |(min, max), phase| (min.min(phase), max.max(phase)));
        let (first, last) = (libm::floor(min / PI) as i64, libm::ceil(max / PI) as i64);
        let odd = (first..=last).filter(|multiple| multiple % 2 != 0);
        odd.flat_map(|multiple| self.neutral_at_phase(multiple as f64 * PI, band)).collect()
    }

    fn neutral_at_phase(&self, phase_rad: f64, band: (f64, f64)) -> Vec<NeutralGain> {
        let above = |omega_rad_s: f64| self.phase_rad(omega_rad_s) - phase_rad;
        let places = crossing::all(above, &self.phase_turns_rad_s, band);
        places.into_iter().map(|omega_rad_s| self.neutral_at(omega_rad_s)).collect()
    }

    fn neutral_at(&self, omega_rad_s: f64) -> NeutralGain {
        let slope =
            self.phase_rad(omega_rad_s * (1.0 + 1e-7)) - self.phase_rad(omega_rad_s * (1.0 - 1e-7));
        let poles = if slope < 0.0 { 2 } else { -2 };
        NeutralGain { gain: 1.0 / self.gain(omega_rad_s), omega_rad_s, poles }
    }

    /// Gain factor at which a closed-loop pole passes the origin.
    fn neutral_at_rest(&self) -> Option<NeutralGain> {
        let at_rest = self.system.dc_gain().ok().filter(|&gain| gain < 0.0)?;
        let poles = if self.rises_at_rest() { -1 } else { 1 };
        Some(NeutralGain { gain: -1.0 / at_rest, omega_rad_s: 0.0, poles })
    }

    /// Whether the phase rises with frequency at the lowest ones.
    fn rises_at_rest(&self) -> bool {
        let slope = |sum: f64, root: &crate::Complex| {
            let size = modulus(*root);
            if size > 0.0 { sum - root.re / size / size } else { sum }
        };
        self.zeros.iter().fold(0.0, slope) - self.poles.iter().fold(0.0, slope) > self.delay_s
    }

    /// Which of the poles at the origin go to the right at the smallest gain.
    fn poles_from_origin(&self) -> Result<i32, LtiError> {
        let count = |polynomial: &crate::Polynomial| polynomial.roots_at_origin();
        let integrators =
            count(self.system.denominator()).saturating_sub(count(self.system.numerator()));
        let value = self.at(self.band_rad_s().0);
        match integrators {
            0 => Ok(0),
            // s = −k K, with L near K/(jω) = −j K/ω.
            1 => Ok(i32::from(value.im > 0.0)),
            // s² = −k K (1 + c s), with L near −K/ω² and c the slope of the phase.
            2 if value.re > 0.0 => Ok(1),
            2 => Ok(if self.rises_at_rest() { 0 } else { 2 }),
            // s³ = −k K, with L near K/(jω)³ = j K/ω³.
            3 => Ok(if value.im > 0.0 { 2 } else { 1 }),
            _ => Err(LtiError::TooManyIntegrators { found: integrators, allowed: 3 }),
        }
    }

    /// Beyond it the gain only falls; at least one crossing of the negative axis by dead time lies before it.
    fn highest_of_interest_rad_s(&self) -> f64 {
        let sizes = self.zeros.iter().chain(&self.poles).map(|root| modulus(*root));
        let turns = self.gain_turns_rad_s.iter().chain(&self.phase_turns_rad_s).copied();
        let last = sizes.chain(turns).chain(self.gain_crossings(1.0)).fold(0.0, f64::max);
        if self.delay_s > 0.0 {
            (2.0 * last).min(1e4 * PI / self.delay_s) + 4.0 * PI / self.delay_s
        } else {
            self.band_rad_s().1
        }
    }

    fn crossovers(&self) -> Vec<Crossover> {
        let places = self.gain_crossings(1.0).into_iter();
        let margin = |omega_rad_s| libm::remainder(self.phase_rad(omega_rad_s) + PI, 2.0 * PI);
        places
            .map(|omega_rad_s| Crossover { omega_rad_s, phase_margin_rad: margin(omega_rad_s) })
            .collect()
    }
}

impl Margins {
    /// Whether the closed loop is stable.
    #[must_use]
    pub fn stable(&self) -> bool {
        self.unstable_poles == 0
    }

    /// The factor above 1 at which a stable loop becomes unstable, if there is one.
    #[must_use]
    pub fn upper_neutral(&self) -> Option<NeutralGain> {
        self.neutral_gains.iter().copied().find(|neutral| self.stable() && neutral.gain >= 1.0)
    }

    /// The factor below 1 at which a stable loop becomes unstable, if there is one.
    #[must_use]
    pub fn lower_neutral(&self) -> Option<NeutralGain> {
        self.neutral_gains.iter().rev().copied().find(|neutral| self.stable() && neutral.gain < 1.0)
    }

    /// Gain margin as a factor above 1, if the loop is stable and gain can make it unstable.
    #[must_use]
    pub fn gain_margin(&self) -> Option<f64> {
        self.upper_neutral().map(|neutral| neutral.gain)
    }

    /// The crossover nearest to an oscillation, if the loop is stable and its gain is 1 anywhere.
    #[must_use]
    pub fn phase_margin(&self) -> Option<Crossover> {
        let size = |crossover: &Crossover| crossover.phase_margin_rad.abs();
        let nearest = self
            .crossovers
            .iter()
            .copied()
            .min_by(|left, right| size(left).total_cmp(&size(right)));
        nearest.filter(|_| self.stable())
    }

    /// Smallest dead time in s that makes a stable loop unstable, if its gain is 1 anywhere.
    ///
    /// $$ \tau = \min \frac{\varphi_m \bmod 2 \pi}{\omega} $$
    #[must_use]
    pub fn delay_margin_s(&self) -> Option<f64> {
        let delay = |crossover: &Crossover| {
            let margin = crossover.phase_margin_rad;
            (if margin < 0.0 { margin + 2.0 * PI } else { margin }) / crossover.omega_rad_s
        };
        let delays = self.crossovers.iter().filter(|_| self.stable()).map(delay);
        delays.min_by(f64::total_cmp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transfer_function::TransferFunction;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    fn margins(numerator: &[f64], denominator: &[f64], delay_s: f64) -> Margins {
        let system = TransferFunction::new(numerator, denominator).expect("a test system");
        FrequencyResponse::new(system, delay_s).expect("roots").margins().expect("no feedthrough")
    }

    #[test]
    fn three_equal_lags_have_a_gain_margin_of_eight() {
        let found = margins(&[1.0], &[1.0, 3.0, 3.0, 1.0], 0.0);
        assert!(found.stable() && found.neutral_gains.len() == 1);
        assert!((found.gain_margin().expect("a limit") - 8.0).abs() < 1e-12);
        assert!((found.neutral_gains[0].omega_rad_s - 3.0_f64.sqrt()).abs() < 1e-14);
        assert_eq!(margins(&[9.0], &[1.0, 3.0, 3.0, 1.0], 0.0).unstable_poles, 2);
    }

    #[test]
    fn an_unstable_plant_needs_gain_and_bears_only_so_much() {
        // 6/((s − 1)(s + 2)(s + 3)): stable between 1 and 10/6 by Routh's test.
        let found = margins(&[8.0], &[1.0, 4.0, 1.0, -6.0], 0.0);
        assert!(found.stable(), "{found:?}");
        assert!((found.lower_neutral().expect("a limit").gain - 0.75).abs() < 1e-12);
        assert!((found.gain_margin().expect("a limit") - 1.25).abs() < 1e-12);
        assert_eq!(margins(&[5.0], &[1.0, 4.0, 1.0, -6.0], 0.0).unstable_poles, 1);
    }

    #[test]
    fn a_dead_time_beyond_the_delay_margin_makes_a_loop_unstable() {
        let (numerator, denominator) = ([2.0, 3.0], [1.0, 1.0, 0.0]);
        let limit = margins(&numerator, &denominator, 0.0).delay_margin_s().expect("a crossover");
        assert!(margins(&numerator, &denominator, 0.999 * limit).stable());
        assert_eq!(margins(&numerator, &denominator, 1.001 * limit).unstable_poles, 2);
    }

    #[test]
    fn integrators_start_to_the_side_that_the_next_term_says() {
        assert!(margins(&[1.0, 1.0], &[1.0, 0.0, 0.0], 0.0).stable());
        assert_eq!(margins(&[1.0], &[1.0, 1.0, 0.0, 0.0], 0.0).unstable_poles, 2);
        assert_eq!(margins(&[-1.0], &[1.0, 1.0, 0.0, 0.0], 0.0).unstable_poles, 1);
        assert_eq!(margins(&[-1.0], &[1.0, 0.0], 0.0).unstable_poles, 1);
        assert_eq!(margins(&[1.0], &[1.0, 0.0, 0.0, 0.0], 0.0).unstable_poles, 2);
    }

    #[test]
    fn a_loop_with_feedthrough_has_no_margins() {
        let system = TransferFunction::new(&[1.0, 2.0], &[1.0, 1.0]).expect("a lead");
        let response = FrequencyResponse::new(system, 0.0).expect("roots");
        assert_eq!(response.margins(), Err(LtiError::Feedthrough));
    }

    #[test]
    fn a_loop_at_its_limit_has_a_gain_margin_of_one() {
        // −1/(s + 1): the closed pole is at the origin.
        let found = margins(&[-1.0], &[1.0, 1.0], 0.0);
        assert_eq!((found.gain_margin(), found.lower_neutral()), (Some(1.0), None));
    }

    #[test]
    fn a_loop_that_is_nothing_at_rest_has_no_limit_there() {
        let found = margins(&[1.0, 0.0], &[1.0, 2.0, 1.0], 0.0);
        assert!(found.stable() && found.neutral_gains.is_empty(), "{found:?}");
    }

    #[test]
    fn poles_come_back_where_the_phase_rises_and_leave_where_it_falls() {
        // (s + a)²/(s³ (s + b)²): the phase is −π where atan(ω/a) − atan(ω/b) is π/4, which is ω² − (b − a) ω + a b = 0.
        let (a, b) = (0.01_f64, 0.1_f64);
        let denominator = [1.0, 2.0 * b, b * b, 0.0, 0.0, 0.0];
        let root = ((b - a) * (b - a) - 4.0 * a * b).sqrt();
        let places = [0.5 * (b - a - root), 0.5 * (b - a + root)];
        let gain = |w: f64| w * w * w * (w * w + b * b) / (w * w + a * a);
        let found = margins(&[1.0, 2.0 * a, a * a], &denominator, 0.0).neutral_gains;
        assert_eq!(found.iter().map(|it| it.poles).collect::<Vec<_>>(), [-2, 2]);
        for (found, place) in found.iter().zip(places) {
            assert!((found.omega_rad_s / place - 1.0).abs() < 1e-12, "{found:?} {place}");
            assert!((found.gain / gain(place) - 1.0).abs() < 1e-12, "{found:?}");
        }
        let between = (found[0].gain * found[1].gain).sqrt();
        for (factor, stable) in
            [(0.5 * found[0].gain, false), (between, true), (2.0 * found[1].gain, false)]
        {
            let numerator = [factor, 2.0 * a * factor, a * a * factor];
            assert_eq!(margins(&numerator, &denominator, 0.0).stable(), stable, "{factor}");
        }
    }

    #[test]
    fn every_half_turn_of_lead_is_a_limit_too() {
        // s⁷ over eight lags begins at 7 π/2 and ends at −π/2: −1 is passed at 3 π and at π.
        let mut denominator = crate::Polynomial::new(&[1.0]).expect("one");
        for pole in 1..=8 {
            let lag = crate::Polynomial::new(&[1.0, f64::from(pole)]).expect("a lag");
            denominator = denominator.product(&lag).expect("small");
        }
        let numerator = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let found = margins(&numerator, denominator.coefficients(), 0.0).neutral_gains;
        assert_eq!(found.len(), 2, "{found:?}");
        for (neutral, left) in found.iter().zip([2.5, 0.5]) {
            let lags = (1..=8).map(|pole| libm::atan(neutral.omega_rad_s / f64::from(pole)));
            assert!((lags.sum::<f64>() - left * PI).abs() < 1e-12, "{neutral:?}");
        }
    }

    #[test]
    fn a_slow_loop_with_a_short_dead_time_has_its_limit_where_the_dead_time_makes_it() {
        let (pole, delay_s) = (0.01, 0.01);
        let found = margins(&[0.5 * pole], &[1.0, pole], delay_s).upper_neutral().expect("a limit");
        let lag = libm::atan(found.omega_rad_s / pole) + delay_s * found.omega_rad_s;
        assert!((lag - PI).abs() < 1e-12, "{found:?}");
        let gain = 2.0 * (1.0 + found.omega_rad_s * found.omega_rad_s / pole / pole).sqrt();
        assert!((found.gain / gain - 1.0).abs() < 1e-12, "{found:?} {gain}");
    }

    #[test]
    fn a_resonance_thousands_of_turns_of_dead_time_away_is_not_overlooked() {
        // The gain is 50 at 10⁶ rad/s and above 1 for a tenth of that, over which 20 ms turn the phase by 2000 rad.
        let (wn, zeta, delay_s) = (1e6, 1e-3_f64, 0.02);
        let found = margins(&[0.1 * wn * wn], &[1.0, 2.0 * zeta * wn, wn * wn], delay_s);
        let (first, last) = (found.crossovers[0].omega_rad_s, found.crossovers[1].omega_rad_s);
        // The gain is 1 where (1 − w)² + 4 ζ² w = 0.01, in w the square of ω over ωn.
        let (half, root) = (1.0 - 2.0 * zeta * zeta, (0.01_f64 - 4.0 * zeta * zeta).sqrt());
        assert!(
            (first / wn - (half - root).sqrt()).abs() < 1e-6
                && (last / wn - (half + root).sqrt()).abs() < 1e-6
        );
        let pairs = (last - first) * delay_s / (2.0 * PI);
        // The resonance itself turns by half a turn more.
        assert!(
            (found.unstable_poles as f64 / 2.0 - pairs).abs() < 2.0,
            "{} {pairs}",
            found.unstable_poles
        );
    }

    #[test]
    fn a_loop_that_is_hardly_above_one_lacks_nearly_half_a_turn() {
        let found = margins(&[1.01], &[1.0, 1.0], 0.0).phase_margin().expect("a crossover");
        let omega_rad_s = (1.01_f64 * 1.01 - 1.0).sqrt();
        assert!(
            (found.phase_margin_rad - (PI - libm::atan(omega_rad_s))).abs() < 1e-12,
            "{found:?}"
        );
    }

    #[test]
    fn a_lead_bears_a_dead_time_of_what_is_left_of_the_turn() {
        // s/(s² + s/2 + 1): the gain is 1 where 1 − ω² is ±(√3/2) ω, with ±60° of phase.
        let found = margins(&[1.0, 0.0], &[1.0, 0.5, 1.0], 0.0);
        let root = (0.75_f64 + 4.0).sqrt();
        let [lower, upper] = [0.5 * (root - 0.75_f64.sqrt()), 0.5 * (root + 0.75_f64.sqrt())];
        assert!((found.crossovers[0].omega_rad_s - lower).abs() < 1e-12, "{found:?}");
        assert!((found.crossovers[0].phase_margin_rad + 2.0 * PI / 3.0).abs() < 1e-12, "{found:?}");
        let delay_s = found.delay_margin_s().expect("a crossover");
        assert!((delay_s - 2.0 * PI / 3.0 / upper).abs() < 1e-12, "{delay_s}");
        let one = |phase_margin_rad: f64| Margins {
            unstable_poles: 0,
            neutral_gains: Vec::new(),
            crossovers: vec![Crossover { omega_rad_s: 2.0, phase_margin_rad }],
        };
        assert_eq!(one(-1.0).delay_margin_s(), Some(0.5 * (2.0 * PI - 1.0)));
        assert_eq!(one(0.0).delay_margin_s(), Some(0.0));
    }

    proptest! {
        #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(7), ..ProptestConfig::default() })]

        #[test]
        fn the_count_of_unstable_poles_is_that_of_the_closed_loop(
            zeros in proptest::collection::vec(-3.0..3.0_f64, 0..2),
            reals in proptest::collection::vec(-3.0..1.0_f64, 1..3),
            pair in (-2.0..0.5_f64, 0.1..4.0_f64),
            gain in prop_oneof![-30.0..-0.1_f64, 0.1..30.0_f64],
        ) {
            let mut numerator = crate::Polynomial::new(&[gain]).expect("a gain");
            for zero in zeros {
                numerator = numerator.product(&crate::Polynomial::new(&[1.0, -zero]).expect("a zero")).expect("small");
            }
            let square = pair.0 * pair.0 + pair.1 * pair.1;
            let mut denominator = crate::Polynomial::new(&[1.0, -2.0 * pair.0, square]).expect("a pair");
            for pole in reals {
                denominator = denominator.product(&crate::Polynomial::new(&[1.0, -pole]).expect("a pole")).expect("small");
            }
            let closed = numerator.sum(&denominator).expect("not zero").roots().expect("roots");
            prop_assume!(closed.iter().all(|root| root.re.abs() > 1e-6));
            let right = closed.iter().filter(|root| root.re > 0.0).count();
            let system = TransferFunction::from_polynomials(numerator, denominator).expect("proper");
            let found = FrequencyResponse::new(system, 0.0).expect("roots").margins().expect("no feedthrough");
            prop_assert_eq!(found.unstable_poles, right, "{:?}", found);
        }
    }
}
