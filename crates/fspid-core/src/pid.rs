//! The two controllers: fixed gains, and gains that a fuzzy supervisor tunes while flying.

use fspid_numeric::Real;

use crate::equations::{Memory, PidEquations, TunerEquations};
use crate::error::ConfigError;
use crate::gains::Gains;
use crate::guard::Faults;
use crate::pid_config::{Moment, PidConfig, SetpointWeights};
use crate::sample::Sample;
use crate::second_input::ModelState;
use crate::state::{State, Step};
use crate::tuner::{GainCoupling, SelfTuner};

/// A PID controller with fixed gains (`ki = kd = 0`: the paper's proportional controller).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pid<R> {
    gains: Gains<R>,
    config: PidConfig<R>,
    equations: PidEquations<R>,
}

impl<R: Real> Pid<R> {
    /// A controller with these gains.
    ///
    /// # Errors
    /// [`ConfigError`] names the first setting that is not allowed.
    pub fn new(gains: Gains<R>, config: PidConfig<R>) -> Result<Self, ConfigError> {
        config.check()?;
        let gains = gains.checked()?;
        let equations = PidEquations::new(&config, gains, GainCoupling::NONE);
        Ok(Self { gains, config, equations })
    }

    /// The parts of a controller that was built, as a constant: an export writes them. Nothing is checked and nothing
    /// derived; [`Controller::rounded`](crate::Controller::rounded) does both again.
    #[must_use]
    pub const fn new_unchecked(
        gains: Gains<R>,
        config: PidConfig<R>,
        equations: PidEquations<R>,
    ) -> Self {
        Self { gains, config, equations }
    }

    /// The gains.
    pub fn gains(&self) -> Gains<R> {
        self.gains
    }

    /// Everything but the gains.
    pub fn config(&self) -> &PidConfig<R> {
        &self.config
    }

    /// The same in numbers, with which it flies.
    pub fn equations(&self) -> &PidEquations<R> {
        &self.equations
    }

    /// Answers one sample; call it once every period.
    #[inline]
    pub fn step(&self, state: &mut State<R>, sample: Sample<R>) -> Step<R> {
        let (equations, gains) = (&self.equations, self.gains);
        let sample = match self.config.admitted(sample, self.config.uses_rate()) {
            Ok(sample) => sample,
            Err(fault) => return self.config.hold(state, fault, gains),
        };
        let memory = state.memory_for(equations, &sample, &gains);
        let model = ModelState::at(R::ZERO);
        self.config.step(state, sample, Moment { equations, memory: &memory, gains, model })
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
    equations: PidEquations<R>,
    tuner_equations: TunerEquations<R>,
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
        let (settings, nominal) = (tuner.settings(), tuner.nominal());
        let equations = PidEquations::new(&config, nominal, settings.gain_coupling);
        let tuner_equations = TunerEquations::new(settings, nominal, config.dt_s);
        Ok(Self { tuner, config, equations, tuner_equations })
    }

    /// As [`Pid::new_unchecked`].
    #[must_use]
    pub const fn new_unchecked(
        tuner: SelfTuner<R>,
        config: PidConfig<R>,
        equations: PidEquations<R>,
        tuner_equations: TunerEquations<R>,
    ) -> Self {
        Self { tuner, config, equations, tuner_equations }
    }

    /// Where the gains come from.
    pub fn tuner(&self) -> &SelfTuner<R> {
        &self.tuner
    }

    /// Everything but the gains.
    pub fn config(&self) -> &PidConfig<R> {
        &self.config
    }

    /// The controller behind its gains in numbers, with which it flies.
    pub fn equations(&self) -> &PidEquations<R> {
        &self.equations
    }

    /// The way from a sample to its gains in numbers, but for the rules.
    pub fn tuner_equations(&self) -> &TunerEquations<R> {
        &self.tuner_equations
    }

    /// Answers one sample; call it once every period.
    #[inline]
    pub fn step(&self, state: &mut State<R>, sample: Sample<R>) -> Step<R> {
        self.step_by(state, sample, |memory, sample| {
            self.tuner.gains(&self.tuner_equations, memory, sample)
        })
    }

    /// What the supervisor has before it at a sample: the error, rad, and what stands beside it, before any factor.
    /// `None` for a sample that a step would hold.
    pub fn inputs(&self, state: &State<R>, sample: Sample<R>) -> Option<[R; 2]> {
        let sample = self.config.admitted(sample, self.uses_rate()).ok()?;
        let memory = state.memory_for(&self.equations, &sample, &self.tuner.nominal());
        Some(self.tuner_equations.inputs(&memory, &sample))
    }

    /// As [`step`](Self::step), with other [inputs](Self::inputs) before the supervisor than the sample has. For
    /// experiments: where the inputs are the sample's own, it is that step bit for bit.
    pub fn step_seeing(&self, state: &mut State<R>, sample: Sample<R>, inputs: [R; 2]) -> Step<R> {
        self.step_by(state, sample, |memory, _| {
            self.tuner.gains_where(&self.tuner_equations, memory, inputs)
        })
    }

    /// As [`step`](Self::step), with these gains in place of the supervisor's: what follows them, the reference model
    /// and the limits of the command are those of a step. For experiments.
    pub fn step_at(&self, state: &mut State<R>, sample: Sample<R>, gains: Gains<R>) -> Step<R> {
        self.step_by(state, sample, |_, _| Ok((gains, Faults::NONE)))
    }

    /// One sample with the gains that somebody has for it.
    #[inline(always)]
    fn step_by(
        &self,
        state: &mut State<R>,
        sample: Sample<R>,
        gains: impl FnOnce(&Memory<R>, &Sample<R>) -> Result<(Gains<R>, Faults), Faults>,
    ) -> Step<R> {
        let (equations, nominal) = (&self.equations, self.tuner.nominal());
        let sample = match self.config.admitted(sample, self.uses_rate()) {
            Ok(sample) => sample,
            Err(fault) => return self.config.hold(state, fault, nominal),
        };
        let memory = state.memory_for(equations, &sample, &nominal);
        match gains(&memory, &sample) {
            Ok((gains, fault)) => {
                state.latch(fault);
                let model = self.tuner_equations.next_model(&memory, &sample);
                self.config.step(state, sample, Moment { equations, memory: &memory, gains, model })
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
        let (proportional, rate_gain_s) = self.equations.coupled(&gains);
        let setpoint_weights = SetpointWeights { proportional, ..self.config.setpoint_weights };
        PidConfig { setpoint_weights, rate_gain_s, ..self.config }
    }
}
