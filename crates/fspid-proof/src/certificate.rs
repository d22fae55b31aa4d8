//! What is claimed of a loop, with everything that a re-check needs.

use fspid_lti::Matrix;

use crate::description::LoopDescription;
use crate::disturbances::DisturbanceBound;
use crate::family::Family;
use crate::limits;
use crate::nonlinear::Nonlinear;
use crate::recheck::Rechecked;
use crate::scope::{LeftOut, Range, Scope};
use crate::steps::{Commanded, Steps};

/// A claim about a loop and the matrices that carry it.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// The loop.
    pub description: LoopDescription,
    /// Factor on the supervisor's output scale for which the claim is made; 1 for the loop as it is.
    pub output_factor: f64,
    /// Cells along each of the supervisor's inputs over which its gains are enclosed.
    pub divisions: usize,
    /// Constant set-points and loads that the claim is made for.
    pub range: Range,
    /// What the scenario has of which the claim does not speak.
    pub left_out: Vec<LeftOut>,
    /// What is claimed.
    pub claim: Claim,
    /// Level c of the ellipsoid $z^T P z \le c$, where one is claimed. In it no limit acts.
    pub level: Option<f64>,
    /// Steps from rest whose flights may meet limits, where such are claimed.
    pub steps: Option<Steps>,
    /// The flights that a scenario commands, which may meet limits, where such are claimed.
    pub commanded: Option<Commanded>,
    /// Plants and actuators beside the one of the description, of which the return to rest is claimed.
    pub family: Option<Family>,
    /// What disturbances do at most, from rest.
    pub disturbances: Vec<DisturbanceBound>,
    /// The nonlinear aircraft near its trim, where something is claimed of it.
    pub nonlinear: Option<Nonlinear>,
}

/// What is claimed.
#[derive(Clone, Debug, PartialEq)]
pub enum Claim {
    /// For every gain that the tuner can produce, however fast gains move,
    /// $M(k)^T P M(k) \prec \rho^2 P$.
    CommonQuadratic {
        /// P.
        form: Matrix,
        /// ρ, at most 1.
        rate: f64,
    },
    /// As the memoryless law ties the gains to error and change: with the plane of the supervisor's
    /// inputs in double cones $z^T Q_c z \ge 0$,
    /// $M(k)^T P M(k) + \tau_c Q_c \prec \rho^2 P$ for every gain that the law gives in cone c.
    SProcedure {
        /// P.
        form: Matrix,
        /// ρ, at most 1.
        rate: f64,
        /// τ of each cone, 0 or above.
        multipliers: Vec<f64>,
    },
    /// For every gain that the tuner can produce, as long as none moves too fast.
    BoundedRate(BoundedRate),
    /// Gains that the supervisor produces at an input, standing still, let the loop grow.
    FrozenGrowth {
        /// Error and change, supervisor units.
        input: [f64; 2],
        /// Factor σ per sample, at least 1, beyond which the form grows:
        /// $M^T P M \succ \sigma^2 P$.
        factor: f64,
        /// P.
        form: Matrix,
        /// A state at which it is positive.
        direction: Vec<f64>,
    },
    /// Gains that the supervisor produces at these inputs, one after the other and again, let the
    /// loop grow. It refutes arbitrary motion of the gains, not the flown loop.
    SequenceGrowth {
        /// Error and change at each sample of the period, supervisor units.
        inputs: Vec<[f64; 2]>,
        /// Factor σ per period, at least 1, beyond which the form grows.
        factor: f64,
        /// P.
        form: Matrix,
        /// A state at which it is positive.
        direction: Vec<f64>,
    },
}

/// For every gain that the tuner can produce, as long as no gain moves by more than a share of the half
/// width of its box in a sample, $V = z^T P(\kappa) z$ decreases:
///
/// $$ M(\kappa)^T P(\kappa^+) M(\kappa) \prec \rho^2 P(\kappa), \quad
/// P(\kappa) = P_0 + \sum_j \kappa_j P_j, \quad |\kappa_j^+ - \kappa_j| \le d_j $$
///
/// with gains κ counted in half widths of a box around them.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundedRate {
    /// Lower and upper end of each gain in the box.
    pub ends: [[f64; 2]; 3],
    /// Largest change d of each gain in a sample, in half widths of the box; 1 or more for a gain that
    /// jumps. A gain that the form does not move with may move as it likes.
    pub changes: [f64; 3],
    /// $P_0$, and what each gain adds to it per half width.
    pub forms: [Matrix; 4],
    /// ρ, at most 1.
    pub rate: f64,
}

impl Certificate {
    /// What is to be said beside the claim, with what its re-check found.
    #[must_use]
    pub fn scope(&self, rechecked: &Rechecked) -> Scope {
        let mut left_out = self.left_out.clone();
        left_out.extend(LeftOut::ALL.into_iter().filter(|one| one.always()));
        left_out.retain(|one| self.claim.is_of_stability() || one.of_growth());
        left_out.sort_unstable();
        left_out.dedup();
        Scope {
            range: self.range,
            any_setpoint: rechecked.any_setpoint,
            any_load: rechecked.any_load,
            rest_error_rad: rechecked.rest_error_rad,
            remains_rad: rechecked.remains_rad,
            limits: self.description.limits(),
            pitch_within_rad: rechecked.pitch_within_rad,
            limits_left_out: self.limits_left_out(rechecked),
            stepped: rechecked.stepped,
            ended: rechecked.ended,
            disturbed: rechecked.disturbed.clone(),
            left_out,
        }
    }
}

impl Certificate {
    /// Why the claim leaves limits out; none where it covers them, or there are none.
    fn limits_left_out(&self, rechecked: &Rechecked) -> Option<&'static str> {
        if rechecked.pitch_within_rad.is_some() || self.description.limits().is_empty() {
            return None;
        }
        let reason = limits::not_covered(&self.description);
        Some(reason.unwrap_or("the claim names no size of motion within which none acts"))
    }
}

impl Claim {
    /// Name in files.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::CommonQuadratic { .. } => "stable-at-any-speed",
            Self::SProcedure { .. } => "stable-as-tied-to-the-error",
            Self::BoundedRate(_) => "stable-at-bounded-rate",
            Self::FrozenGrowth { .. } => "unstable-with-frozen-gains",
            Self::SequenceGrowth { .. } => "unstable-with-a-sequence-of-gains",
        }
    }

    /// The factor per sample by which the root of the form decreases, of a claim of stability.
    #[must_use]
    pub const fn rate(&self) -> Option<f64> {
        match self {
            Self::CommonQuadratic { rate, .. }
            | Self::SProcedure { rate, .. }
            | Self::BoundedRate(BoundedRate { rate, .. }) => Some(*rate),
            Self::FrozenGrowth { .. } | Self::SequenceGrowth { .. } => None,
        }
    }

    /// True for a claim of stability.
    #[must_use]
    pub const fn is_of_stability(&self) -> bool {
        matches!(
            self,
            Self::CommonQuadratic { .. } | Self::SProcedure { .. } | Self::BoundedRate(_)
        )
    }
}
