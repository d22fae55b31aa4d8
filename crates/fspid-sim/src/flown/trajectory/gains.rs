//! How the gains of a sample change with what the supervisor sees.

use fspid_core::{Change, ErrorSign, Gains, Law, SelfTuner};
use fspid_fuzzy::Supervisor;
use fspid_fuzzy::system::{Differentiator, GradientError, Parts, System, Workspace};

/// Half the width of differences where a supervisor has no derivatives in closed form, of its range.
const DIFFERENCE: f64 = 1e-6;

/// Slopes of the three gains, in the order kp, ki, kd.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct GainSlopes {
    /// By the error, 1/rad.
    pub(super) by_error: [f64; 3],
    /// By the change of the error since the last sample, 1/rad.
    pub(super) by_change: [f64; 3],
    /// By the gain of the last sample.
    pub(super) by_gain: [f64; 3],
}

impl GainSlopes {
    /// Gains that are held.
    pub(super) const HELD: Self =
        Self { by_error: [0.0; 3], by_change: [0.0; 3], by_gain: [1.0; 3] };
}

/// A sample as the tuner sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    pub(super) error_rad: f64,
    /// Since the last sample.
    pub(super) change_rad: f64,
    /// What the tuner answered.
    pub(super) gains: Gains<f64>,
}

/// Derives the gains of one tuner.
pub(super) struct TunerSlopes<'a> {
    tuner: &'a SelfTuner<f64>,
    differentiator: Differentiator<'a>,
    workspace: Workspace,
    dt_s: f64,
}

/// The supervisor of a tuner as a general system; `None` where it is none, which does not happen.
pub(super) fn system_of(supervisor: &Supervisor<f64>) -> Option<System> {
    System::new(Parts::from(supervisor)).ok()
}

impl<'a> TunerSlopes<'a> {
    pub(super) fn new(tuner: &'a SelfTuner<f64>, system: &'a System, dt_s: f64) -> Self {
        let (differentiator, workspace) = (system.differentiator(), system.workspace());
        Self { tuner, differentiator, workspace, dt_s }
    }

    /// The slopes at a sample.
    ///
    /// $$ \frac{\partial k}{\partial e} = s \frac{\partial \Delta k}{\partial x} c_e, \qquad
    /// \frac{\partial k}{\partial \Delta e} = s \frac{\partial \Delta k}{\partial \dot x}
    /// \frac{c_{\dot e}}{T} $$
    ///
    /// with the factors $c$ before and s behind the supervisor, and times T for gains that accumulate,
    /// which keep $1 - \lambda T$ of the last. They are 0 within the dead zone, for an input beyond the
    /// range that is clamped, and for a gain at its limit.
    pub(super) fn at(&mut self, seen: Seen) -> GainSlopes {
        let settings = *self.tuner.settings();
        let (answer_factor, kept) = match settings.law {
            Law::Memoryless => (1.0, 0.0),
            Law::Accumulating { leakage_per_s } => (self.dt_s, 1.0 - leakage_per_s * self.dt_s),
        };
        let rate = match settings.change {
            Change::Rate => 1.0 / self.dt_s,
            Change::Delta => 1.0,
        };
        let sign = match settings.error_sign {
            ErrorSign::SetpointMinusMeasurement => 1.0,
            ErrorSign::MeasurementMinusSetpoint => -1.0,
        };
        let scale = settings.input_scale;
        let (by_error, by_change) =
            (sign * scale.error_per_rad, sign * scale.change_per_rad * rate);
        let dead = settings.dead_zone.is_some_and(|zone| {
            seen.error_rad.abs() <= zone.error_rad
                && (rate * seen.change_rad).abs() <= zone.change_rad
        });
        let derivatives = if dead {
            [[0.0; 2]; 3]
        } else {
            self.derivatives([by_error * seen.error_rad, by_change * seen.change_rad])
        };
        let output = settings.output_scale;
        let mut slopes = GainSlopes::default();
        for (gain, factor) in [output.kp, output.ki, output.kd].into_iter().enumerate() {
            if self.is_at_limit(gain, seen.gains) {
                continue;
            }
            let [by_first, by_second] = derivatives[gain];
            slopes.by_error[gain] = answer_factor * factor * by_first * by_error;
            slopes.by_change[gain] = answer_factor * factor * by_second * by_change;
            slopes.by_gain[gain] = kept;
        }
        slopes
    }

    /// True for a gain that its limit holds.
    #[allow(clippy::float_cmp, reason = "a gain that was cut is the limit itself")]
    fn is_at_limit(&self, gain: usize, gains: Gains<f64>) -> bool {
        let Some(limits) = self.tuner.settings().gain_limits else {
            return false;
        };
        let ends = [(gains.kp, limits.kp), (gains.ki, limits.ki), (gains.kd, limits.kd)];
        ends.get(gain)
            .is_some_and(|(value, limits)| *value == limits.lower() || *value == limits.upper())
    }

    /// Derivatives of the three increments by both inputs of the supervisor.
    fn derivatives(&mut self, inputs: [f64; 2]) -> [[f64; 2]; 3] {
        let mut derivatives = [[0.0; 2]; 3];
        for (output, row) in derivatives.iter_mut().enumerate() {
            *row = match self.differentiator.gradient(&inputs, output, &mut self.workspace) {
                Ok(gradient) => {
                    [0, 1].map(|input| gradient.inputs.get(input).copied().unwrap_or(0.0))
                }
                // Samples that move with the strengths: no closed form.
                Err(GradientError::Jumps { .. }) => self.difference(inputs, output),
                Err(_) => self.clamped(inputs, output),
            };
        }
        derivatives
    }

    /// Derivatives where every rule has underflowed and the answer is that for the clamped inputs: an
    /// input within the range still moves it. What is refused does not get here.
    fn clamped(&mut self, inputs: [f64; 2], output: usize) -> [f64; 2] {
        let range = self.tuner.supervisor().range();
        let ends = inputs.map(|input| input.clamp(-range, range));
        let gradient = self.differentiator.gradient(&ends, output, &mut self.workspace);
        [0, 1].map(|input| match &gradient {
            Ok(gradient) if inputs[input].abs() <= range => {
                gradient.inputs.get(input).copied().unwrap_or(0.0)
            }
            _ => 0.0,
        })
    }

    fn difference(&self, inputs: [f64; 2], output: usize) -> [f64; 2] {
        let supervisor = self.tuner.supervisor();
        let half = DIFFERENCE * supervisor.range();
        let answer = |[error, change]: [f64; 2]| {
            let delta = supervisor.infer(error, change).map(|inference| inference.delta);
            delta.map_or(0.0, |delta| [delta.kp, delta.ki, delta.kd][output])
        };
        [0, 1].map(|input| {
            let moved = |by: f64| {
                let mut moved = inputs;
                moved[input] += by;
                answer(moved)
            };
            (moved(half) - moved(-half)) / (2.0 * half)
        })
    }
}
