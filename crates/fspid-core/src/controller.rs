//! Either controller, for what does not care which.

use fspid_numeric::Real;

use crate::equations::PidEquations;
use crate::gains::Gains;
use crate::pid::{Fspid, Pid};
use crate::pid_config::PidConfig;
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
