//! The controllers a loop can be flown with.

use fspid_core::{Fspid, Gains, Pid, Sample, Shell, State, Step};

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
    pub fn shell(&self) -> &Shell<f64> {
        match self {
            Self::Fixed(pid) => pid.shell(),
            Self::SelfTuning(fspid) => fspid.shell(),
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
    pub fn shell_at(&self, gains: Gains<f64>) -> Shell<f64> {
        match self {
            Self::Fixed(pid) => *pid.shell(),
            Self::SelfTuning(fspid) => fspid.shell_at(gains),
        }
    }

    /// True if the measured pitch rate matters.
    #[must_use]
    pub fn uses_rate(&self) -> bool {
        match self {
            Self::Fixed(pid) => pid.shell().rate_gain_s != 0.0,
            Self::SelfTuning(fspid) => fspid.uses_rate(),
        }
    }
}
