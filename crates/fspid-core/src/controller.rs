//! A controller with fixed or with self-tuned gains, for code that handles both alike.

use fspid_numeric::Real;

use crate::equations::PidEquations;
use crate::gains::Gains;
use crate::guard::Faults;
use crate::pid::{Fspid, Pid};
use crate::pid_config::{PidConfig, may_be_remembered};
use crate::sample::Sample;
use crate::state::{State, Step};

/// A controller of the loop; it sees radians and answers radians.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "there is no heap, and a controller is built once and then borrowed"
)]
pub enum Controller<R> {
    /// Fixed gains.
    Fixed(Pid<R>),
    /// Gains tuned by the fuzzy supervisor.
    SelfTuning(Fspid<R>),
}

impl<R: Real> Controller<R> {
    /// Answers one sample.
    #[inline]
    pub fn step(&self, state: &mut State<R>, sample: Sample<R>) -> Step<R> {
        match self {
            Self::Fixed(pid) => pid.step(state, sample),
            Self::SelfTuning(fspid) => fspid.step(state, sample),
        }
    }

    /// Answers the last command, bit for bit, and latches a fault: for a sample that the caller knows to be bad.
    pub fn hold(&self, state: &mut State<R>, fault: Faults) -> Step<R> {
        self.config().hold(state, fault, self.nominal())
    }

    /// Takes part in a sample that another has commanded, so that taking over bumps nothing; call it instead of
    /// [`step`](Self::step) while a pilot or another controller flies.
    ///
    /// Gains, derivative and reference model move on as in a step; the command is `command_rad` within the limits,
    /// and the integral is what the other terms leave of it. The next step at an unchanged sample starts from that
    /// command: it differs by one sample of the integral, $k_i e T$, by the derivative that fades and, in a
    /// self-tuning controller, by what the gains move; never by more than the slew limit. The whole difference
    /// from `command_rad` may come back, within the slew limit, where $k_i$ is zero or where clamping leaves the
    /// integral too little room: there is no memory that could hold it.
    ///
    /// A command that is not finite or beyond the guard, and a sample that a step would hold, are held and latched.
    pub fn track(&self, state: &mut State<R>, sample: Sample<R>, command_rad: R) -> Step<R> {
        if let Some(fault) = self.config().guard.fault_of(command_rad) {
            return self.hold(state, fault);
        }
        let latched = state.take_faults();
        let step = self.step(state, sample);
        let held = step.faults.is_held();
        state.latch(latched);
        let Some(memory) = state.memory().filter(|_| !held) else {
            return Step { faults: state.faults, ..step };
        };
        let tracked_rad = self.equations().within_limits(command_rad);
        let used = self.used(sample);
        let integral = self.equations().tracking(&memory, &used, tracked_rad);
        if may_be_remembered(integral) {
            state.integral = integral;
        }
        state.command_rad = tracked_rad;
        let saturated = tracked_rad != command_rad;
        Step { command_rad: tracked_rad, saturated, faults: state.faults, ..step }
    }

    /// The sample with a rate of zero where no rate matters.
    fn used(&self, sample: Sample<R>) -> Sample<R> {
        if self.uses_rate() { sample } else { Sample { rate_rad_s: R::ZERO, ..sample } }
    }

    /// Everything but the gains.
    #[must_use]
    pub fn config(&self) -> &PidConfig<R> {
        match self {
            Self::Fixed(pid) => pid.config(),
            Self::SelfTuning(fspid) => fspid.config(),
        }
    }

    /// The gains it starts from: fixed or nominal.
    #[must_use]
    pub fn nominal(&self) -> Gains<R> {
        match self {
            Self::Fixed(pid) => pid.gains(),
            Self::SelfTuning(fspid) => fspid.tuner().nominal(),
        }
    }

    /// Everything but the gains, as it is at these gains.
    #[must_use]
    pub fn config_at(&self, gains: Gains<R>) -> PidConfig<R> {
        match self {
            Self::Fixed(pid) => *pid.config(),
            Self::SelfTuning(fspid) => fspid.config_at(gains),
        }
    }

    /// Everything behind the gains in numbers, with which it flies.
    #[must_use]
    pub fn equations(&self) -> &PidEquations<R> {
        match self {
            Self::Fixed(pid) => pid.equations(),
            Self::SelfTuning(fspid) => fspid.equations(),
        }
    }

    /// True if the measured pitch rate matters.
    #[must_use]
    pub fn uses_rate(&self) -> bool {
        match self {
            Self::Fixed(pid) => pid.config().rate_gain_s != R::ZERO,
            Self::SelfTuning(fspid) => fspid.uses_rate(),
        }
    }
}
