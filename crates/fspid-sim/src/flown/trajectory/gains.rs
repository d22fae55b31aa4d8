//! Derivatives of the supervisor's gain increments with respect to its inputs, along a flight.

use fspid_core::SelfTuner;
use fspid_fuzzy::Supervisor;
use fspid_fuzzy::system::{Differentiator, GradientError, Parts, System, Workspace};

/// Half the width of differences where a supervisor has no derivatives in closed form, of its range.
const DIFFERENCE: f64 = 1e-6;

/// Slopes of the three increments, before they are scaled, by the two inputs of the supervisor; in the
/// order kp, ki, kd.
pub(super) type IncrementSlopes = [[f64; 2]; 3];

/// Derives the increments of one tuner.
pub(super) struct TunerSlopes<'a> {
    tuner: &'a SelfTuner<f64>,
    differentiator: Differentiator<'a>,
    workspace: Workspace,
}

/// The supervisor of a tuner as a general system; `None` where it is none, which does not happen.
pub(super) fn system_of(supervisor: &Supervisor<f64>) -> Option<System> {
    System::new(Parts::try_from(supervisor).ok()?).ok()
}

impl<'a> TunerSlopes<'a> {
    pub(super) fn new(tuner: &'a SelfTuner<f64>, system: &'a System) -> Self {
        let (differentiator, workspace) = (system.differentiator(), system.workspace());
        Self { tuner, differentiator, workspace }
    }

    /// The slopes where the supervisor sees this: 0 for an input beyond the range that is clamped.
    pub(super) fn at(&mut self, inputs: [f64; 2]) -> IncrementSlopes {
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
