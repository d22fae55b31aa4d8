//! The two controllers: fixed gains, and gains that a fuzzy supervisor tunes while flying.

use fspid_numeric::Real;

use crate::error::ConfigError;
use crate::gains::Gains;
use crate::pid_config::PidConfig;
use crate::second_input::ModelState;
use crate::state::{Sample, State, Step};
use crate::tuner::{SelfTuner, Tuned};

/// A PID controller with fixed gains (`ki = kd = 0`: the paper's proportional controller).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pid<R> {
    gains: Gains<R>,
    config: PidConfig<R>,
}

impl<R: Real> Pid<R> {
    /// A controller with these gains.
    ///
    /// # Errors
    /// [`ConfigError`] names the first setting that is not allowed.
    pub fn new(gains: Gains<R>, config: PidConfig<R>) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self { gains: gains.checked()?, config })
    }

    /// The gains.
    pub fn gains(&self) -> Gains<R> {
        self.gains
    }

    /// Everything but the gains.
    pub fn config(&self) -> &PidConfig<R> {
        &self.config
    }

    /// Answers one sample; call it once every period.
    #[inline]
    pub fn step(&self, state: &mut State<R>, sample: Sample<R>) -> Step<R> {
        let no_model = ModelState::at(R::ZERO);
        match self.config.admitted(sample, self.config.uses_rate()) {
            Ok(sample) => self.config.step(state, sample, (self.gains, no_model)),
            Err(fault) => self.config.hold(state, fault, self.gains),
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
    config: PidConfig<R>,
}

impl<R: Real> Fspid<R> {
    /// A controller whose gains come from `tuner`.
    ///
    /// # Errors
    /// [`ConfigError`] names the first setting that is not allowed; a leakage above one per sample
    /// period, which would throw the gains beyond their nominal values, is one.
    pub fn new(tuner: SelfTuner<R>, config: PidConfig<R>) -> Result<Self, ConfigError> {
        config.check()?;
        tuner.check_period(config.dt_s)?;
        Ok(Self { tuner, config })
    }

    /// Where the gains come from.
    pub fn tuner(&self) -> &SelfTuner<R> {
        &self.tuner
    }

    /// Everything but the gains.
    pub fn config(&self) -> &PidConfig<R> {
        &self.config
    }

    /// Answers one sample; call it once every period.
    #[inline]
    pub fn step(&self, state: &mut State<R>, sample: Sample<R>) -> Step<R> {
        let nominal = self.tuner.nominal();
        let sample = match self.config.admitted(sample, self.uses_rate()) {
            Ok(sample) => sample,
            Err(fault) => return self.config.hold(state, fault, nominal),
        };
        match self.tuner.tuned(state, sample, self.config.dt_s) {
            Ok(Tuned { gains, model, fault }) => {
                state.latch(fault);
                self.tuner.config_at(&self.config, gains).step(state, sample, (gains, model))
            }
            Err(fault) => self.config.hold(state, fault, nominal),
        }
    }

    /// True if a sample's pitch rate matters: to the rate loop, or to the supervisor.
    pub fn uses_rate(&self) -> bool {
        self.config.uses_rate()
            || self.tuner.sees_rate()
            || self.tuner.settings().gain_coupling.rate_gain != R::ZERO
    }

    /// Everything but the gains, as it is at these gains: with what follows them.
    pub fn config_at(&self, gains: Gains<R>) -> PidConfig<R> {
        self.tuner.config_at(&self.config, gains)
    }
}
