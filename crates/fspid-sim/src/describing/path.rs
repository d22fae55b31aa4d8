//! The nonlinearities between command and control surface (slew, rate and position limits, deadband, backlash), and their
//! joint describing function.

use fspid_aircraft::ForceModel;
use fspid_core::{Limits, PidConfig};
use fspid_lti::{Complex, Matrix, quotient, zero_order_hold};

use crate::actuator::{Actuator, ActuatorState, Lag};
use crate::error::SimError;
use crate::math::sin_cos;
use crate::plant::Plant;
use crate::scenario::Scenario;

/// How a describing function is computed.
#[derive(Clone, Copy, Debug)]
struct Effort {
    /// Steps a period.
    steps: usize,
    /// Change from period to period, relative, below which the start has died out.
    steady: f64,
    /// Most periods that the start may take for it.
    periods: usize,
    /// A lag that trails a sine by less, rad, is left out: it takes time to fly, and changes a function
    /// that is relative to it by no more than this.
    least_lag: f64,
}

/// For an answer. A lag of 0.1 s takes 100 periods at 350 rad/s.
const FINE: Effort = Effort { steps: 512, steady: 1e-7, periods: 100, least_lag: 0.003 };
/// To a percent.
const FAIR: Effort = Effort { steps: 128, steady: 1e-4, periods: 50, least_lag: 0.03 };
/// To some percent, where cycles are only looked for.
const ROUGH: Effort = Effort { steps: 64, steady: 1e-3, periods: 20, least_lag: 0.1 };
/// What limits a command between controller and surface: slew and output limits of the controller,
/// everything of the actuator but its delay, and an aircraft's travel of the elevator.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitedPath {
    slew_rad_s: Option<f64>,
    limits: Option<Limits<f64>>,
    actuator: Actuator,
    /// Least and most deflection from the trim in the sense of the command, rad.
    travel_rad: Option<(f64, f64)>,
}

impl LimitedPath {
    /// The path of a scenario behind a controller.
    ///
    /// # Errors
    /// [`SimError::OtherSimulator`] where another simulator flies: what a scenario has, an actuator allows.
    pub fn of(scenario: &Scenario, config: &PidConfig<f64>) -> Result<Self, SimError> {
        scenario.plant.require_equations()?;
        let travel_rad = match &scenario.plant {
            Plant::Linear(_) | Plant::External(_) => None,
            Plant::Aircraft(plant) => {
                let trim_rad = plant.trim().point.elevator_rad;
                let range = plant.aircraft().model().travel().elevator_rad;
                // Trailing edge down is nose down.
                Some((trim_rad - range.max, trim_rad - range.min))
            }
        };
        Ok(Self {
            slew_rad_s: config.slew_rad_s,
            limits: config.limits,
            actuator: scenario.actuator.with_bias(0.0)?,
            travel_rad,
        })
    }

    /// True where nothing limits.
    #[must_use]
    pub fn is_linear(&self) -> bool {
        let free = |(least, most): (f64, f64)| least.is_infinite() && most.is_infinite();
        let controller = self.slew_rad_s.is_none() && self.limits.is_none();
        controller && self.actuator.is_linear() && self.travel_rad.is_none_or(free)
    }

    /// The describing function of the path relative to that without limits,
    ///
    /// $$ N(A, \omega) = \frac{c_1[\text{limited}]}{c_1[\text{unlimited}]}, \qquad
    /// c_1[\delta] = \frac{\omega}{\pi} \int_0^{2 \pi / \omega} \delta(t) e^{-j \omega t} dt $$
    ///
    /// for a command $A \cos \omega t$ of amplitude `amplitude_rad` and frequency `frequency_rad_s`.
    /// The actuator itself flies it in 512 steps of held command a period, from the crest of the sine
    /// on, until a period is as the one before; the integral is the sum over the ends of the steps. A
    /// rate that changes its sign does so at a step, which is good to 0.012 rad of phase.
    ///
    /// `None` unless amplitude and frequency are finite and positive.
    #[must_use]
    pub fn describing_function(&self, amplitude_rad: f64, frequency_rad_s: f64) -> Option<Complex> {
        self.relative(amplitude_rad, frequency_rad_s, FINE)
    }

    /// As [`describing_function`](Self::describing_function) to a percent.
    pub(super) fn fairly(&self, amplitude_rad: f64, frequency_rad_s: f64) -> Option<Complex> {
        self.relative(amplitude_rad, frequency_rad_s, FAIR)
    }

    /// As [`describing_function`](Self::describing_function) to some percent, in a fraction of the time.
    pub(super) fn roughly(&self, amplitude_rad: f64, frequency_rad_s: f64) -> Option<Complex> {
        self.relative(amplitude_rad, frequency_rad_s, ROUGH)
    }

    fn relative(
        &self,
        amplitude_rad: f64,
        frequency_rad_s: f64,
        effort: Effort,
    ) -> Option<Complex> {
        let good = |value: f64| value.is_finite() && value > 0.0;
        if !(good(amplitude_rad) && good(frequency_rad_s)) {
            return None;
        }
        let lag = self.actuator.lag();
        if lag.order() > 0 && lag.trailing_s() * frequency_rad_s < effort.least_lag {
            let prompt = Self { actuator: self.actuator.with_lag(Lag::NONE), ..self.clone() };
            return prompt.relative(amplitude_rad, frequency_rad_s, effort);
        }
        let sine = Sine::new(frequency_rad_s, effort.steps);
        let limited = self.fundamental(&sine, amplitude_rad, effort);
        let ratio = quotient(limited, sine.through(lag)? * amplitude_rad);
        ratio.is_finite().then_some(ratio)
    }

    /// The command after the controller's own limits, rad.
    fn limited(&self, last_rad: f64, free_rad: f64, step_s: f64) -> f64 {
        let slewed = self.slew_rad_s.map_or(free_rad, |slew| {
            free_rad.clamp(last_rad - slew * step_s, last_rad + slew * step_s)
        });
        self.limits.map_or(slewed, |limits| limits.clamp(slewed))
    }

    fn surface_rad(&self, actuator: &ActuatorState) -> f64 {
        let deflection_rad = self.actuator.deflection_rad(actuator);
        self.travel_rad.map_or(deflection_rad, |(least, most)| deflection_rad.max(least).min(most))
    }

    /// Fundamental of the surface, rad.
    fn fundamental(&self, sine: &Sine, amplitude_rad: f64, effort: Effort) -> Complex {
        let mut actuator = ActuatorState::default();
        let (mut command_rad, mut before) = (0.0, Complex::default());
        for _ in 0..effort.periods {
            let mut sum = Complex::default();
            for pair in sine.turns.windows(2) {
                let [now, then] = *pair else {
                    continue;
                };
                command_rad = self.limited(command_rad, amplitude_rad * now.re, sine.step_s);
                // Without a lag the surface jumps at the beginning of a step.
                self.actuator.settle(&mut actuator, command_rad);
                sum += now * self.surface_rad(&actuator);
                self.actuator.advance(&mut actuator, command_rad, sine.step_s);
                sum += then * self.surface_rad(&actuator);
            }
            let changed = (sum - before).norm_sqr();
            before = sum;
            if changed <= effort.steady * effort.steady * sum.norm_sqr() {
                break;
            }
        }
        before * (1.0 / effort.steps as f64)
    }
}

/// The steps of a period.
struct Sine {
    /// $e^{-j \omega t}$ at the beginning of each step and at the end of the last.
    turns: Vec<Complex>,
    step_s: f64,
}

impl Sine {
    fn new(frequency_rad_s: f64, steps: usize) -> Self {
        let step_rad = std::f64::consts::TAU / steps as f64;
        let turn = |step: usize| {
            let (sine, cosine) = sin_cos(step_rad * step as f64);
            Complex::new(cosine, -sine)
        };
        let turns = (0..=steps).map(turn).collect();
        Self { turns, step_s: step_rad / frequency_rad_s }
    }

    /// Fundamental behind a lag alone for an amplitude of 1, of the same held steps.
    ///
    /// $$ \left( (z I - \Phi)^{-1} \Gamma \right)_1, \quad z = e^{2 \pi j / n} $$
    fn through(&self, lag: Lag) -> Option<Complex> {
        let z = self.turns.get(1)?.conj();
        let [by_deflection, by_rate, by_target] = lag.coefficients();
        let (a, b) = match lag.order() {
            // A surface that jumps stands still over a step: half of it before, half after.
            0 => return Some((z.conj() + 1.0) * 0.5),
            1 => (vec![vec![by_deflection]], vec![[by_target]]),
            _ => (vec![vec![0.0, 1.0], vec![by_deflection, by_rate]], vec![[0.0], [by_target]]),
        };
        let (a, b) = (Matrix::from_rows(&a).ok()?, Matrix::from_rows(&b).ok()?);
        let (by_state, by_input) = zero_order_hold(&a, &b, self.step_s).ok()?;
        let entry = |matrix: &Matrix, row, column| matrix.get(row, column).unwrap_or(0.0);
        let first = entry(&by_input, 0, 0);
        if lag.order() == 1 {
            return Some(quotient(Complex::from(first), z - entry(&by_state, 0, 0)));
        }
        // The first row of the inverse of a matrix of two.
        let (other, corner) = (z - entry(&by_state, 1, 1), entry(&by_state, 0, 1));
        let own = z - entry(&by_state, 0, 0);
        let determinant = own * other - corner * entry(&by_state, 1, 0);
        Some(quotient(other * first + corner * entry(&by_input, 1, 0), determinant))
    }
}
