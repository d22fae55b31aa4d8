//! The two controllers: fixed gains, and gains that a fuzzy supervisor tunes while flying.

use fspid_fuzzy::Real;

use crate::error::ConfigError;
use crate::gains::Gains;
use crate::shell::Shell;
use crate::state::{Sample, State, Step};
use crate::tuner::SelfTuner;

/// A PID controller with fixed gains (`ki = kd = 0`: the paper's proportional controller).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pid<R> {
    gains: Gains<R>,
    shell: Shell<R>,
}

impl<R: Real> Pid<R> {
    /// A controller with these gains.
    ///
    /// # Errors
    /// [`ConfigError`] names the first setting that is not allowed.
    pub fn new(gains: Gains<R>, shell: Shell<R>) -> Result<Self, ConfigError> {
        shell.check()?;
        Ok(Self { gains: gains.checked()?, shell })
    }

    /// The gains.
    pub fn gains(&self) -> Gains<R> {
        self.gains
    }

    /// Everything but the gains.
    pub fn shell(&self) -> &Shell<R> {
        &self.shell
    }

    /// Answers one sample; call it once every period.
    #[inline]
    pub fn step(&self, state: &mut State<R>, sample: Sample<R>) -> Step<R> {
        match self.shell.admitted(sample) {
            Ok(sample) => self.shell.step(state, sample, self.gains),
            Err(fault) => self.shell.hold(state, fault, self.gains),
        }
    }
}

/// A fuzzy self-tuning PID controller.
///
/// When the gains move, the command moves at once by $\Delta k_p e + \Delta k_d \dot e$; the
/// integral's part does not with [`IntegralForm::Bumpless`](crate::IntegralForm::Bumpless) and does
/// with the literal form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fspid<R> {
    tuner: SelfTuner<R>,
    shell: Shell<R>,
}

impl<R: Real> Fspid<R> {
    /// A controller whose gains come from `tuner`.
    ///
    /// # Errors
    /// [`ConfigError`] names the first setting that is not allowed; a leakage above one per sample
    /// period, which would throw the gains beyond their nominal values, is one.
    pub fn new(tuner: SelfTuner<R>, shell: Shell<R>) -> Result<Self, ConfigError> {
        shell.check()?;
        tuner.check_leakage(shell.dt_s)?;
        Ok(Self { tuner, shell })
    }

    /// Where the gains come from.
    pub fn tuner(&self) -> &SelfTuner<R> {
        &self.tuner
    }

    /// Everything but the gains.
    pub fn shell(&self) -> &Shell<R> {
        &self.shell
    }

    /// Answers one sample; call it once every period.
    #[inline]
    pub fn step(&self, state: &mut State<R>, sample: Sample<R>) -> Step<R> {
        let nominal = self.tuner.nominal();
        let sample = match self.shell.admitted(sample) {
            Ok(sample) => sample,
            Err(fault) => return self.shell.hold(state, fault, nominal),
        };
        let error_rad = sample.setpoint_rad - sample.measurement_rad;
        let delta_rad = state.error_delta(error_rad);
        let answer = self.tuner.gains(state.gains(), error_rad, delta_rad, self.shell.dt_s);
        match answer {
            Ok((gains, fault)) => {
                state.latch(fault);
                self.shell.step(state, sample, gains)
            }
            Err(fault) => self.shell.hold(state, fault, nominal),
        }
    }
}
