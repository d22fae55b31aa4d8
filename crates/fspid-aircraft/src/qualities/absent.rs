//! Why a flying quality has no value.

use fspid_lti::LtiError;
use thiserror::Error;

use super::level::Category;

/// Why a flying quality has no value.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum Absent {
    /// The fast half of the motion is not a mode of its own.
    #[error("short period and phugoid have lent each other a pole: there is no short period")]
    ThirdOscillation,
    /// The fast half of the motion runs away.
    #[error(
        "the short period is unstable: a pole at {real_rad_s} rad/s doubles it in {doubles_s} s"
    )]
    ShortPeriodDiverges {
        /// Real part of the pole.
        real_rad_s: f64,
        /// Time to double.
        doubles_s: f64,
    },
    /// The short period does not swing.
    #[error("the short period does not swing: its two poles are real")]
    ShortPeriodDoesNotSwing,
    /// Of three poles the real one is faster than the pair, so that none is the integral of the pitch rate.
    #[error(
        "of three poles the pair is slower than the real one: which of them is the short period nobody can tell"
    )]
    SlowPair,
    /// A model without the slow half of the motion.
    #[error("the model holds the speed, so it has no phugoid")]
    NoPhugoid,
    /// A denominator of another degree than three or four.
    #[error("pitch over elevator has {found} poles; three (speed held) or four are understood")]
    OtherModel {
        /// How many poles it has.
        found: usize,
    },
    /// A numerator without the zero of the lift.
    #[error("pitch over elevator has no real zero on the left that could be the lift's")]
    NoLiftZero,
    /// A phase that does not reach −180°.
    #[error(
        "the phase never falls through -180 degrees: the attitude can be followed at any frequency"
    )]
    NoPhaseLimit,
    /// A phase that is beyond −135° at every frequency.
    #[error("the phase is never above -135 degrees below the frequency of -180")]
    NoPhaseReserve,
    /// A gain that never is twice that at −180°.
    #[error("the gain is nowhere twice that at -180 degrees")]
    NoGainReserve,
    /// A requirement that exists, but whose chart was not at hand.
    #[error("no chart for category {0:?} was at hand")]
    NoChart(Category),
    /// A linear system that could not be solved.
    #[error(transparent)]
    Linear(#[from] LtiError),
}
