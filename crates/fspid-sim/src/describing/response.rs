//! The open loop without limits at a frequency.

use fspid_core::{Gains, PidConfig};
use fspid_lti::{Complex, Matrix, SampledLoop};

use crate::error::SimError;
use crate::loop_model::{BreakPoint, LoopModel, LoopSettings, Memory};
use crate::math::sin_cos;
use crate::plant::LinearPlant;
use crate::scenario::Scenario;

/// The open loop of a sampled loop at frozen gains without limits, broken at the command with every
/// other loop closed.
#[derive(Clone, Debug)]
pub struct OpenLoop {
    /// From command to what comes back, to pitch angle and to deflection, without the command's delay.
    returned: SampledLoop,
    pitch: SampledLoop,
    deflection: SampledLoop,
    delay_s: f64,
}

/// Open-loop frequency response to a command $\cos \omega t$ of amplitude 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// The open loop $L(e^{j \omega T})$: what comes back as a command, sign changed.
    pub returned: Complex,
    /// Pitch angle, rad/rad.
    pub pitch: Complex,
    /// Deflection of the elevator in the sense of the command, rad/rad.
    pub deflection: Complex,
}

impl OpenLoop {
    /// The open loop of a plant of the scenario with these gains.
    ///
    /// # Errors
    /// [`SimError`] where the plant cannot be sampled.
    pub fn of(
        scenario: &Scenario,
        plant: &LinearPlant,
        config: &PidConfig<f64>,
        gains: Gains<f64>,
    ) -> Result<Self, SimError> {
        let model = LoopModel::of(scenario, plant, config, Memory::of_gains(gains, config))?;
        let delay_s = model.settings().delay_samples as f64 * config.dt_s;
        // The queue would be as many states, and is nothing but a turn.
        let settings = LoopSettings { delay_samples: 0, ..model.settings().clone() };
        let prompt = LoopModel::new(model.plant().clone(), settings);
        let parts = prompt.parts(gains);
        let matrix = Matrix::from_rows(&parts.matrix)?;
        let state = |place: usize| {
            let exit = (0..matrix.rows()).map(|n| if n == place { 1.0 } else { 0.0 }).collect();
            SampledLoop::new(matrix.clone(), parts.by_command.clone(), exit, config.dt_s)
        };
        Ok(Self {
            returned: prompt.open(gains, BreakPoint::Command)?,
            pitch: state(0)?,
            deflection: state(plant.order())?,
            delay_s,
        })
    }

    /// Half the sampling rate, rad/s.
    #[must_use]
    pub fn nyquist_rad_s(&self) -> f64 {
        self.returned.nyquist_rad_s()
    }

    /// The response at a frequency, rad/s; `None` at a pole.
    #[must_use]
    pub fn at(&self, frequency_rad_s: f64) -> Option<Response> {
        let (sine, cosine) = sin_cos(-frequency_rad_s * self.delay_s);
        let late = Complex::new(cosine, sine);
        let [returned, pitch, deflection] = [&self.returned, &self.pitch, &self.deflection]
            .map(|part| part.at(frequency_rad_s) * late);
        let finite = returned.is_finite() && pitch.is_finite() && deflection.is_finite();
        finite.then_some(Response { returned, pitch, deflection })
    }

    /// Where the open loop has gain 1, rad/s, in order.
    ///
    /// # Errors
    /// [`SimError`] where eigenvalues are not found.
    pub fn gain_crossovers_rad_s(&self) -> Result<Vec<f64>, SimError> {
        Ok(self.returned.gain_crossings(1.0)?)
    }
}
