//! The gains that a controller has when error and change are zero.

use fspid_core::{Gains, Law, SelfTuner};
use fspid_sim::Controller;

/// The gains at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Equilibrium {
    /// Fixed gains.
    Fixed(Gains<f64>),
    /// What the rules make of the nominal gains at rest.
    AtRest(Gains<f64>),
    /// The accumulating law moves the gains at rest, and nothing stops it: there is no equilibrium.
    Drifts {
        /// By how much each gain moves in a second.
        per_s: Gains<f64>,
    },
}

impl Equilibrium {
    /// The gains, if they stand still.
    #[must_use]
    pub fn gains(&self) -> Option<Gains<f64>> {
        match self {
            Self::Fixed(gains) | Self::AtRest(gains) => Some(*gains),
            Self::Drifts { .. } => None,
        }
    }
}

/// The gains of a controller at rest.
///
/// Under the memoryless law $k' + s \Delta k(0, 0)$; under the accumulating law
/// $k' + s \Delta k(0, 0) / \lambda$ with the leakage $\lambda$, and without a leakage the limit that
/// a gain drifts to; both moved into the gain limits.
#[must_use]
pub fn equilibrium(controller: &Controller) -> Equilibrium {
    match controller {
        Controller::Fixed(pid) => Equilibrium::Fixed(pid.gains()),
        Controller::SelfTuning(fspid) => match fspid.tuner().settings().law {
            Law::Memoryless => Equilibrium::AtRest(fspid.tuner().gains_at_rest()),
            Law::Accumulating { leakage_per_s } => accumulated(fspid.tuner(), leakage_per_s),
        },
    }
}

fn accumulated(tuner: &SelfTuner<f64>, leakage_per_s: f64) -> Equilibrium {
    let per_s = added_at_rest(tuner);
    let nominal = tuner.nominal();
    let target = |nominal: f64, per_s: f64| match per_s {
        0.0 => nominal,
        per_s => nominal + per_s / leakage_per_s,
    };
    let free = Gains {
        kp: target(nominal.kp, per_s.kp),
        ki: target(nominal.ki, per_s.ki),
        kd: target(nominal.kd, per_s.kd),
    };
    let limited = match tuner.settings().gain_limits {
        Some(limits) => Gains {
            kp: limits.kp.clamp(free.kp),
            ki: limits.ki.clamp(free.ki),
            kd: limits.kd.clamp(free.kd),
        },
        None => free,
    };
    if limited.checked().is_ok() {
        Equilibrium::AtRest(limited)
    } else {
        Equilibrium::Drifts { per_s }
    }
}

/// What the rules add at rest, scaled; nothing inside of a dead zone.
pub(super) fn added_at_rest(tuner: &SelfTuner<f64>) -> Gains<f64> {
    let settings = tuner.settings();
    if settings.dead_zone.is_some() {
        return Gains::ZERO;
    }
    // The origin is within every range, so that there always is an answer.
    let Ok(inference) = tuner.supervisor().infer(0.0, 0.0) else {
        return Gains::ZERO;
    };
    let (scale, delta) = (settings.output_scale, inference.delta);
    Gains { kp: scale.kp * delta.kp, ki: scale.ki * delta.ki, kd: scale.kd * delta.kd }
}
