//! The controllers a loop can be flown with.

use fspid_core::equations::PidEquations;
use fspid_core::{Fspid, Gains, Pid, PidConfig, Sample, State, Step};

/// A controller of the loop; it sees radians and answers radians.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "a handful per scenario, and a box would put the supervisor behind a pointer"
)]
pub enum Controller {
    /// Fixed gains.
    Fixed(Pid<f64>),
    /// Gains tuned by the fuzzy supervisor.
    SelfTuning(Fspid<f64>),
}

impl Controller {
    /// Answers one sample.
    #[inline]
    pub fn step(&self, state: &mut State<f64>, sample: Sample<f64>) -> Step<f64> {
        match self {
            Self::Fixed(pid) => pid.step(state, sample),
            Self::SelfTuning(fspid) => fspid.step(state, sample),
        }
    }

    /// Everything but the gains.
    #[must_use]
    pub fn config(&self) -> &PidConfig<f64> {
        match self {
            Self::Fixed(pid) => pid.config(),
            Self::SelfTuning(fspid) => fspid.config(),
        }
    }

    /// The gains it starts from: fixed or nominal.
    #[must_use]
    pub fn nominal(&self) -> Gains<f64> {
        match self {
            Self::Fixed(pid) => pid.gains(),
            Self::SelfTuning(fspid) => fspid.tuner().nominal(),
        }
    }

    /// Everything but the gains, as it is at these gains.
    #[must_use]
    pub fn config_at(&self, gains: Gains<f64>) -> PidConfig<f64> {
        match self {
            Self::Fixed(pid) => *pid.config(),
            Self::SelfTuning(fspid) => fspid.config_at(gains),
        }
    }

    /// Everything behind the gains in numbers, with which it flies.
    #[must_use]
    pub fn equations(&self) -> &PidEquations<f64> {
        match self {
            Self::Fixed(pid) => pid.equations(),
            Self::SelfTuning(fspid) => fspid.equations(),
        }
    }

    /// True if the measured pitch rate matters.
    #[must_use]
    pub fn uses_rate(&self) -> bool {
        match self {
            Self::Fixed(pid) => pid.config().rate_gain_s != 0.0,
            Self::SelfTuning(fspid) => fspid.uses_rate(),
        }
    }
}
