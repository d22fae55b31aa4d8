//! What a proved claim implies for the flown loop: whether loop and gains of the certificate are those of the scenario.

use core::fmt;

use fspid_sim::Controller;

use crate::certificate::{Certificate, Claim};
use crate::recheck::Rechecked;
use crate::scope::LeftOut;

/// What the proved inequalities imply for the flown loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bearing {
    /// The flown loop is stable, within the scope that the certificate states.
    Stable,
    /// The pitch loop is stable, within the scope that the certificate states; outer loops fly around it, of which it says nothing.
    PitchLoopStable,
    /// The flown loop grows: its gains are fixed, or these are the gains that it has at rest.
    Grows,
    /// Gains that stand still let the loop grow, and those at rest are not known to. In flight they move, and the loop may still settle.
    GrowsStandingStill,
    /// Gains in an order that no flight may bring about let the loop grow.
    GrowsInSomeOrder,
    /// Nothing: the gains are those of another output scale.
    OtherScale {
        /// Times the controller's own.
        factor: f64,
    },
    /// Nothing: the proof asks for gains slower than the law is known to keep to.
    RateNotKept,
}

impl Certificate {
    /// What the claim says of the flown loop, of what its re-check found.
    #[must_use]
    pub fn bearing(&self, rechecked: &Rechecked) -> Bearing {
        // Bit for bit: a factor next to 1 is another loop as well.
        if self.output_factor.to_bits() != 1.0_f64.to_bits() {
            return Bearing::OtherScale { factor: self.output_factor };
        }
        let stable = match self.left_out.contains(&LeftOut::OuterLoops) {
            true => Bearing::PitchLoopStable,
            false => Bearing::Stable,
        };
        let is_fixed = matches!(self.description.controller, Controller::Fixed(_));
        match (&self.claim, rechecked.keeps_to_the_rate) {
            (Claim::CommonQuadratic { .. } | Claim::SProcedure { .. }, _) => stable,
            (Claim::BoundedRate(_), true) => stable,
            (Claim::BoundedRate(_), false) => Bearing::RateNotKept,
            (Claim::FrozenGrowth { .. } | Claim::SequenceGrowth { .. }, _) if is_fixed => {
                Bearing::Grows
            }
            // The supervisor sees nothing there: these are the gains around which the flown loop is linear.
            (Claim::FrozenGrowth { input: [0.0, 0.0], .. }, _) => Bearing::Grows,
            (Claim::FrozenGrowth { .. }, _) => Bearing::GrowsStandingStill,
            (Claim::SequenceGrowth { .. }, _) => Bearing::GrowsInSomeOrder,
        }
    }
}

impl Bearing {
    /// True if the flown loop is proved stable; where outer loops fly around it, the pitch loop.
    #[must_use]
    pub const fn is_stability(self) -> bool {
        matches!(self, Self::Stable | Self::PitchLoopStable)
    }

    /// True if the claim says something, if only of gains that stand still: it was proved to refute.
    #[must_use]
    pub const fn is_refutation(self) -> bool {
        matches!(self, Self::Grows | Self::GrowsStandingStill | Self::GrowsInSomeOrder)
    }

    /// Name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stable => "flown-loop-stable",
            Self::PitchLoopStable => "pitch-loop-stable",
            Self::Grows => "flown-loop-unstable",
            Self::GrowsStandingStill => "unstable-with-gains-standing-still",
            Self::GrowsInSomeOrder => "unstable-with-gains-in-some-order",
            Self::OtherScale { .. } => "nothing-other-output-scale",
            Self::RateNotKept => "nothing-rate-not-kept",
        }
    }
}

impl fmt::Display for Bearing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stable => f.write_str("the flown loop is stable"),
            Self::PitchLoopStable => f.write_str(
                "the pitch loop is stable; of the outer loops that fly around it nothing is claimed",
            ),
            Self::Grows => f.write_str("the flown loop itself leaves rest"),
            Self::GrowsStandingStill => f.write_str(
                "this refutes gains that stand still; in flight the gains move on, and the flown loop may still settle",
            ),
            Self::GrowsInSomeOrder => f.write_str(
                "this refutes gains that move in any order; no flight need bring this order about, and the flown loop may still settle",
            ),
            Self::OtherScale { factor } => write!(
                f,
                "the claim is about {factor:?} times the controller's output scale, and so not about the flown loop"
            ),
            Self::RateNotKept => f.write_str(
                "the claim asks for gains that move no faster than stated, and the law is not shown to keep to that: it is not about the flown loop",
            ),
        }
    }
}
