//! Perturbations inserted between controller and servo to measure margins by simulation: gain, delay, phase lag.

use std::collections::VecDeque;

use crate::error::{SimError, finite, not_negative, positive};

/// Longest extra delay; more is a mistake.
pub(super) const MOST_DELAY_SAMPLES: f64 = 10_000.0;

/// A discrete all-pass of first order: it delays the phase and leaves every amplitude as it is.
///
/// $$ y_k = a x_k + x_{k-1} - a y_{k-1}, \qquad
/// H(z) = \frac{a + z^{-1}}{1 + a z^{-1}}, \quad -1 < a \le 1 $$
///
/// At rest it is 1. Its lag grows with the frequency, from 0 to 180 deg at half the sampling rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AllPass {
    coefficient: f64,
}

impl AllPass {
    /// The all-pass that lags by `lag_rad` at one frequency:
    ///
    /// $$ a = \frac{\tan (\omega T / 2) - \tan (\varphi / 2)}{\tan (\omega T / 2) + \tan (\varphi / 2)} $$
    ///
    /// # Errors
    /// [`SimError::Number`] for a lag outside of 0 to π (π excluded), a period that is not positive
    /// and a frequency that is not between 0 and half the sampling rate.
    pub fn lagging(lag_rad: f64, at_rad_s: f64, dt_s: f64) -> Result<Self, SimError> {
        let half_lag_rad = 0.5 * not_negative("phase lag, rad", lag_rad)?;
        let half_turn_rad =
            0.5 * positive("frequency, rad/s", at_rad_s)? * positive("sample period, s", dt_s)?;
        let quarter = std::f64::consts::FRAC_PI_2;
        if !(half_lag_rad < quarter) {
            let allowed = "below half a turn";
            return Err(SimError::Number { what: "phase lag, rad", found: lag_rad, allowed });
        }
        if !(half_turn_rad < quarter) {
            let allowed = "below half the sampling rate";
            return Err(SimError::Number { what: "frequency, rad/s", found: at_rad_s, allowed });
        }
        let (own, asked) = (libm::tan(half_turn_rad), libm::tan(half_lag_rad));
        Ok(Self { coefficient: (own - asked) / (own + asked) })
    }
}

/// Perturbation inserted between controller and servo; by default none.
///
/// In this order: the gain, the extra delay, the all-pass. The controller knows of none of them: its
/// own limits and anti-windup act on the command that it gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perturbation {
    /// Factor on the command.
    pub gain: f64,
    /// Samples by which the command comes late beyond its own delay. Between whole numbers of samples
    /// the command lies on the straight line between the two, which takes at most $(\omega T)^2 / 8$
    /// of the amplitude of a sine.
    pub extra_delay_samples: f64,
    /// Phase lag.
    pub all_pass: Option<AllPass>,
}

impl Default for Perturbation {
    fn default() -> Self {
        Self::NONE
    }
}

impl Perturbation {
    /// Nothing: the flight as it is, bit for bit.
    pub const NONE: Self = Self { gain: 1.0, extra_delay_samples: 0.0, all_pass: None };

    /// A factor on the command.
    #[must_use]
    pub const fn of_gain(gain: f64) -> Self {
        Self { gain, ..Self::NONE }
    }

    /// A delay.
    #[must_use]
    pub const fn of_delay(extra_delay_samples: f64) -> Self {
        Self { extra_delay_samples, ..Self::NONE }
    }

    /// A lag.
    #[must_use]
    pub const fn of_lag(all_pass: AllPass) -> Self {
        Self { all_pass: Some(all_pass), ..Self::NONE }
    }

    /// At rest, before the first command.
    pub(crate) fn start(&self) -> Result<CommandPath, SimError> {
        finite("gain", self.gain)?;
        let delay_samples = not_negative("extra delay, samples", self.extra_delay_samples)?;
        if delay_samples > MOST_DELAY_SAMPLES {
            let (what, allowed) = ("extra delay, samples", "0 to 10000");
            return Err(SimError::Number { what, found: delay_samples, allowed });
        }
        if *self == Self::NONE {
            return Ok(CommandPath(None));
        }
        let whole = delay_samples.floor();
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number from 0 to 10 000"
        )]
        let samples = whole as usize;
        Ok(CommandPath(Some(Perturbed {
            gain: self.gain,
            // One more than the whole samples: the older end of the straight line.
            past: VecDeque::from(vec![0.0; samples + 1]),
            part: delay_samples - whole,
            all_pass: self.all_pass,
            last: [0.0; 2],
        })))
    }
}

/// The way of a flight's commands.
#[derive(Clone, Debug)]
pub(crate) struct CommandPath(Option<Perturbed>);

#[derive(Clone, Debug)]
struct Perturbed {
    gain: f64,
    /// The last commands, oldest first.
    past: VecDeque<f64>,
    /// Part of a sample beyond the whole ones.
    part: f64,
    all_pass: Option<AllPass>,
    /// What entered and left the all-pass last.
    last: [f64; 2],
}

impl CommandPath {
    /// What arrives of a command.
    #[inline]
    pub(crate) fn pass(&mut self, command_rad: f64) -> f64 {
        match &mut self.0 {
            None => command_rad,
            Some(perturbed) => perturbed.pass(command_rad),
        }
    }
}

impl Perturbed {
    fn pass(&mut self, command_rad: f64) -> f64 {
        self.past.push_back(self.gain * command_rad);
        let older_rad = self.past.pop_front().unwrap_or(0.0);
        let newer_rad = self.past.front().copied().unwrap_or(older_rad);
        let delayed_rad = newer_rad + self.part * (older_rad - newer_rad);
        let Some(AllPass { coefficient }) = self.all_pass else {
            return delayed_rad;
        };
        let [entered_rad, left_rad] = self.last;
        let now_rad = coefficient * delayed_rad + entered_rad - coefficient * left_rad;
        self.last = [delayed_rad, now_rad];
        now_rad
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sin_cos;

    /// Every 20 ms.
    const DT_S: f64 = 0.02;

    fn passed(perturbation: Perturbation, commands: &[f64]) -> Vec<f64> {
        let mut path = perturbation.start().expect("allowed");
        commands.iter().map(|command| path.pass(*command)).collect()
    }

    #[test]
    fn nothing_leaves_every_bit_of_a_command() {
        let commands = [0.1, -0.0, f64::MIN_POSITIVE / 4.0, 1e300];
        let same = passed(Perturbation::NONE, &commands);
        assert!(same.iter().zip(&commands).all(|(a, b)| a.to_bits() == b.to_bits()));
    }

    #[test]
    fn a_delay_of_one_and_a_quarter_samples_lies_between_the_second_and_third_last_command() {
        let late = passed(Perturbation::of_delay(1.25), &[8.0, 16.0, 4.0, 0.0, 0.0]);
        assert_eq!(late, [0.0, 6.0, 14.0, 7.0, 1.0]);
        assert_eq!(passed(Perturbation::of_delay(2.0), &[8.0, 4.0, 1.0]), [0.0, 0.0, 8.0]);
        assert_eq!(passed(Perturbation::of_gain(-2.0), &[8.0, 4.0]), [-16.0, -8.0]);
    }

    #[test]
    fn an_all_pass_without_lag_is_nothing_else_either() {
        let all_pass = AllPass::lagging(0.0, 3.0, DT_S).expect("allowed");
        let commands = [0.3, -0.2, 0.7];
        assert_eq!(passed(Perturbation::of_lag(all_pass), &commands), commands);
    }

    #[test]
    fn an_all_pass_delays_a_sine_by_its_lag_and_keeps_its_amplitude() {
        let frequency_rad_s = 3.0;
        for lag_rad in [0.1, 1.0, 2.5] {
            let all_pass = AllPass::lagging(lag_rad, frequency_rad_s, DT_S).expect("allowed");
            let sine =
                |k: i32, lag_rad: f64| sin_cos(frequency_rad_s * DT_S * f64::from(k) - lag_rad).0;
            let commands: Vec<f64> = (0..4000).map(|k| sine(k, 0.0)).collect();
            let late = passed(Perturbation::of_lag(all_pass), &commands);
            // The start has died out: the pole is at most 0.99 for these lags, and 0.99^3000 is 1e-13.
            for (k, value) in (0..).zip(&late).skip(3000) {
                assert!((value - sine(k, lag_rad)).abs() < 1e-12, "{lag_rad} {k}");
            }
        }
    }

    #[test]
    fn numbers_that_make_no_sense_are_refused() {
        for (lag_rad, at_rad_s) in
            [(-0.1, 1.0), (3.2, 1.0), (f64::NAN, 1.0), (0.5, 0.0), (0.5, 158.0)]
        {
            assert!(AllPass::lagging(lag_rad, at_rad_s, DT_S).is_err(), "{lag_rad} {at_rad_s}");
        }
        for bad in [-0.5, 1e5, f64::NAN] {
            assert!(Perturbation::of_delay(bad).start().is_err(), "{bad}");
        }
        assert!(Perturbation::of_gain(f64::INFINITY).start().is_err());
    }
}
