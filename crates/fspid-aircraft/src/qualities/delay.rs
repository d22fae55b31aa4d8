//! Equivalent delay: how late the attitude answers.

use super::absent::Absent;
use super::level::{Confidence, Judgement, Level, Requirement};
use super::model::PitchModel;
use super::short_period::short_period_mode;
use fspid_lti::FrequencyResponse;

/// Delay of the response to a command.
pub(super) const DELAY: Requirement = Requirement {
    title: "equivalent delay",
    clause: "MIL-F-8785C 3.5.3, table XIV",
    confidence: Confidence::Transcribed,
    note: "0.10, 0.20 and 0.25 s",
};

const BOUNDS_S: [f64; 3] = [0.10, 0.20, 0.25];

/// Equivalent delay of what lies between the command and the elevator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EquivalentDelay {
    /// The delay.
    pub delay_s: f64,
    /// What it is worth.
    pub level: Judgement,
}

impl EquivalentDelay {
    /// Delay that would lag as much as servo and dead time do at the frequency of the short period.
    ///
    /// $$ \tau_e = -\frac{\varphi_{servo}(\omega_n)}{\omega_n} + \tau $$
    ///
    /// An estimate: the standard fits a whole band of frequencies.
    ///
    /// # Errors
    /// A model without a short period.
    pub fn of(model: &PitchModel) -> Result<Self, Absent> {
        let omega_rad_s = short_period_mode(&model.modes()?)?.natural_frequency_rad_s;
        let lag_s = match &model.path.servo {
            Some(servo) => {
                -FrequencyResponse::new(servo.clone(), 0.0)?.phase_rad(omega_rad_s) / omega_rad_s
            }
            None => 0.0,
        };
        Ok(Self::new(lag_s + model.path.delay_s))
    }

    /// A delay that was found otherwise.
    #[must_use]
    pub fn new(delay_s: f64) -> Self {
        let level = Level::at_most(delay_s, BOUNDS_S);
        Self { delay_s, level: Judgement::new(&DELAY, delay_s, level) }
    }
}
