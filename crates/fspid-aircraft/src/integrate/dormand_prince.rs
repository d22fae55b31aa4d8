//! The pair of Dormand and Prince of orders 5 and 4, with a step that follows an error bound and values in between.

use crate::error::AircraftError;
use crate::integrate::advanced;
use crate::integrate::tableau::{DENSE, ERROR, NODES, STAGES};

/// Error bound of a step and limits of its length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Error allowed of a value, relative to its size.
    pub relative: f64,
    /// Error allowed of a value near zero, in the unit of the value.
    pub absolute: f64,
    /// Longest step.
    pub step_max_s: f64,
    /// Most steps, refused ones included.
    pub steps_max: usize,
}

impl Default for Tolerance {
    fn default() -> Self {
        Self { relative: 1e-9, absolute: 1e-9, step_max_s: f64::INFINITY, steps_max: 1_000_000 }
    }
}

/// Why an integration ended before its time.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IntegrationError {
    /// The rate of change is not a finite number.
    #[error("the rate of change at {time_s} s is not finite")]
    NotFinite {
        /// When.
        time_s: f64,
    },
    /// No step is short enough for the tolerance.
    #[error("at {time_s} s no step is short enough for the tolerance")]
    StepTooShort {
        /// When.
        time_s: f64,
    },
    /// As many steps as allowed.
    #[error("{steps} steps were taken up to {time_s} s, as many as allowed")]
    TooManySteps {
        /// When.
        time_s: f64,
        /// How many.
        steps: usize,
    },
}

/// A step that was taken, with everything in between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step<const N: usize> {
    /// When it began.
    pub start_s: f64,
    /// How long it was.
    pub dt_s: f64,
    /// State where it began.
    pub start: [f64; N],
    /// State where it ended.
    pub end: [f64; N],
    rates: [[f64; N]; 7],
}

impl<const N: usize> Step<N> {
    /// One step of order 5 from a state whose rate is known.
    fn new(
        rate: &impl Fn(f64, &[f64; N]) -> [f64; N],
        start_s: f64,
        start: [f64; N],
        dt_s: f64,
        first: [f64; N],
    ) -> Self {
        let mut rates = [[0.0; N]; 7];
        rates[0] = first;
        let mut end = start;
        for (index, factors) in STAGES.iter().enumerate() {
            end = advanced(&start, &factors.map(|factor| dt_s * factor), &lead(&rates));
            rates[index + 1] = rate(start_s + NODES[index + 1] * dt_s, &end);
        }
        Self { start_s, dt_s, start, end, rates }
    }

    /// When it ended.
    #[must_use]
    pub fn end_s(&self) -> f64 {
        self.start_s + self.dt_s
    }

    /// State at a time within the step; its error is of the order of the step's fifth power.
    ///
    /// # Source
    /// E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd edition, section II.6 and
    /// the code DOPRI5.
    #[must_use]
    pub fn at(&self, time_s: f64) -> [f64; N] {
        let part = (time_s - self.start_s) / self.dt_s;
        let rest = 1.0 - part;
        let bend = advanced(&[0.0; N], &DENSE.map(|factor| self.dt_s * factor), &self.rates);
        let mut state = self.start;
        for (index, value) in state.iter_mut().enumerate() {
            let rise = self.end[index] - self.start[index];
            let entry = self.dt_s * self.rates[0][index] - rise;
            let exit = rise - self.dt_s * self.rates[6][index] - entry;
            *value += part * (rise + rest * (entry + part * (exit + rest * bend[index])));
        }
        state
    }

    /// Estimated error in multiples of what is allowed; infinite where anything is not finite.
    fn error(&self, tolerance: &Tolerance) -> f64 {
        let error = advanced(&[0.0; N], &ERROR.map(|factor| self.dt_s * factor), &self.rates);
        let mut sum = 0.0;
        for (index, error) in error.iter().enumerate() {
            let size = self.start[index].abs().max(self.end[index].abs());
            let ratio = error / (tolerance.absolute + tolerance.relative * size);
            sum += ratio * ratio;
        }
        let mean = (sum / N as f64).sqrt();
        if mean.is_finite() { mean } else { f64::INFINITY }
    }
}

/// The first six rates: what later stages are made of.
fn lead<const N: usize>(rates: &[[f64; N]; 7]) -> [[f64; N]; 6] {
    [rates[0], rates[1], rates[2], rates[3], rates[4], rates[5]]
}

/// An integration under way: an iterator over its steps.
///
/// The last step ends at the final time exactly. After an error there is nothing more.
pub struct DormandPrince<R, const N: usize> {
    rate: R,
    tolerance: Tolerance,
    time_s: f64,
    end_s: f64,
    state: [f64; N],
    first: [f64; N],
    dt_s: f64,
    steps: usize,
    failed: bool,
}

impl<R: Fn(f64, &[f64; N]) -> [f64; N], const N: usize> DormandPrince<R, N> {
    /// Integration of a rate of change from a state at a time to a later time.
    ///
    /// # Errors
    /// A final time that is not after the first, a tolerance that is not above zero.
    pub fn new(
        rate: R,
        (start_s, end_s): (f64, f64),
        state: [f64; N],
        tolerance: Tolerance,
    ) -> Result<Self, AircraftError> {
        AircraftError::unless_positive("time to integrate over in s", end_s - start_s)?;
        AircraftError::unless_positive("relative tolerance", tolerance.relative)?;
        AircraftError::unless_positive("absolute tolerance", tolerance.absolute)?;
        let first = rate(start_s, &state);
        let dt_s = (0.01 * (end_s - start_s)).min(tolerance.step_max_s);
        Ok(Self {
            rate,
            tolerance,
            time_s: start_s,
            end_s,
            state,
            first,
            dt_s,
            steps: 0,
            failed: false,
        })
    }

    /// A step within the tolerance.
    fn advance(&mut self) -> Result<Step<N>, IntegrationError> {
        loop {
            let time_s = self.time_s;
            if self.steps >= self.tolerance.steps_max {
                return Err(IntegrationError::TooManySteps { time_s, steps: self.steps });
            }
            if self.first.iter().any(|rate| !rate.is_finite()) {
                return Err(IntegrationError::NotFinite { time_s });
            }
            self.steps += 1;
            let dt_s = self.next_dt_s();
            let step = Step::new(&self.rate, time_s, self.state, dt_s, self.first);
            let error = step.error(&self.tolerance);
            self.dt_s = (dt_s * growth(error)).min(self.tolerance.step_max_s);
            if error <= 1.0 {
                self.accept(&step);
                return Ok(step);
            }
            if time_s + self.dt_s <= time_s {
                return Err(IntegrationError::StepTooShort { time_s });
            }
        }
    }

    /// The step's length, not beyond the end and not leaving a sliver before it.
    fn next_dt_s(&self) -> f64 {
        let rest_s = self.end_s - self.time_s;
        if self.dt_s >= rest_s * (1.0 - 1e-12) { rest_s } else { self.dt_s }
    }

    fn accept(&mut self, step: &Step<N>) {
        let last = step.dt_s >= self.end_s - self.time_s;
        self.time_s = if last { self.end_s } else { step.end_s() };
        self.state = step.end;
        self.first = step.rates[6];
    }
}

/// By which factor the step changes after an error in multiples of the tolerance.
fn growth(error: f64) -> f64 {
    if error == 0.0 {
        return 5.0;
    }
    (0.9 * libm::pow(error, -0.2)).clamp(0.2, 5.0)
}

impl<R: Fn(f64, &[f64; N]) -> [f64; N], const N: usize> Iterator for DormandPrince<R, N> {
    type Item = Result<Step<N>, IntegrationError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.failed || self.time_s >= self.end_s {
            return None;
        }
        let step = self.advance();
        self.failed = step.is_err();
        Some(step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rate(time_s: f64, state: &[f64; 1]) -> [f64; 1] {
        [-2.0 * time_s * state[0] * state[0]]
    }

    /// One step from t = 0.5 of x' = −2 t x², whose solution is 1/(1 + t²).
    fn step(dt_s: f64) -> Step<1> {
        let start = [0.8];
        Step::new(&rate, 0.5, start, dt_s, rate(0.5, &start))
    }

    fn solution(time_s: f64) -> f64 {
        1.0 / (1.0 + time_s * time_s)
    }

    #[test]
    fn half_the_step_leaves_a_64th_of_a_steps_error() {
        let error = |dt_s: f64| (step(dt_s).end[0] - solution(0.5 + dt_s)).abs();
        for dt_s in [0.1, 0.05] {
            let order = libm::log2(error(dt_s) / error(0.5 * dt_s));
            assert!((order - 6.0).abs() < 0.4, "{order}");
        }
    }

    #[test]
    fn between_the_ends_the_error_falls_with_the_fifth_power_too() {
        let error = |dt_s: f64| {
            let step = step(dt_s);
            let errors = [0.25, 0.5, 0.75].map(|part| {
                let time_s = 0.5 + part * dt_s;
                (step.at(time_s)[0] - solution(time_s)).abs()
            });
            errors.into_iter().fold(0.0, f64::max)
        };
        // Longer steps are not yet where the leading term of the error rules.
        let order = libm::log2(error(0.025) / error(0.0125));
        assert!((order - 5.0).abs() < 0.3, "{order}");
    }

    #[test]
    fn the_ends_of_the_values_in_between_are_the_ends_of_the_step() {
        let step = step(0.1);
        assert!((step.at(0.5)[0] - step.start[0]).abs() < 1e-15);
        assert!((step.at(0.6)[0] - step.end[0]).abs() < 1e-15);
    }

    #[test]
    fn an_oscillator_keeps_to_the_tolerance_and_ends_on_time() {
        let oscillator = |_: f64, state: &[f64; 2]| [state[1], -state[0]];
        for relative in [1e-6, 1e-9, 1e-12] {
            let tolerance = Tolerance { relative, absolute: relative, ..Tolerance::default() };
            let flight = DormandPrince::new(oscillator, (0.0, 10.0), [1.0, 0.0], tolerance);
            let last = flight.expect("well posed").last().expect("a step").expect("no failure");
            assert!((last.end_s() - 10.0).abs() < 1e-14);
            assert!((last.end[0] - libm::cos(10.0)).abs() < 30.0 * relative, "{}", last.end[0]);
        }
    }

    #[test]
    fn a_solution_that_runs_to_infinity_ends_with_a_reason() {
        let explosion = |_: f64, state: &[f64; 1]| [state[0] * state[0]];
        let flight = DormandPrince::new(explosion, (0.0, 2.0), [1.0], Tolerance::default());
        let end = flight.expect("well posed").last().expect("an end");
        assert!(end.is_err(), "{end:?}");
    }

    #[test]
    fn times_and_tolerances_that_make_no_sense_are_refused() {
        let still = |_: f64, _: &[f64; 1]| [0.0];
        assert!(DormandPrince::new(still, (1.0, 1.0), [0.0], Tolerance::default()).is_err());
        let nothing = Tolerance { relative: f64::NAN, ..Tolerance::default() };
        assert!(DormandPrince::new(still, (0.0, 1.0), [0.0], nothing).is_err());
    }
}
