//! Whether a controller's integral acts, and whether it brings the error to zero where its gain at rest is zero.

use fspid_core::{Fspid, GainLimits, Gains, IntegralForm};

use super::{Holding, leakage_per_s};
use crate::controller::Controller;

/// Steps from the middle of the supervisor's range to each of its ends in which its answers are looked at: a multiple of the
/// distances between its sets.
const STEPS: i32 = 24;
/// Inputs beyond the range, as multiples of it.
const BEYOND: [f64; 4] = [-4.0, -1.5, 1.5, 4.0];
/// A gain of less than this share of the largest is zero but for rounding.
const NOTHING: f64 = 1e-9;

/// True for a controller whose integral acts, at rest or elsewhere.
pub(crate) fn has_integral(controller: &Controller) -> bool {
    match controller {
        Controller::Fixed(pid) => pid.gains().ki != 0.0,
        Controller::SelfTuning(fspid) => integrates(fspid),
    }
}

/// True where the gain of the integral may be other than zero.
pub(super) fn integrates(fspid: &Fspid<f64>) -> bool {
    let settings = fspid.tuner().settings();
    let asked = fspid.tuner().nominal().ki != 0.0 || settings.output_scale.ki != 0.0;
    let allowed = |limits: GainLimits<f64>| limits.ki.lower() != 0.0 || limits.ki.upper() != 0.0;
    asked && settings.gain_limits.is_none_or(allowed)
}

/// True where the integral of a self-tuner with these gains at rest need not come to rest with the error at zero: its gain is
/// zero there, so that nothing of the loop at rest tells, and elsewhere negative, which drives the error away; or it multiplies
/// the sum of all errors, which grows until the product holds the load, and the loop with it.
pub(crate) fn may_not_come_to_rest(controller: &Controller, at_rest: Gains<f64>) -> bool {
    let Controller::SelfTuning(fspid) = controller else { return false };
    if at_rest.ki != 0.0 || !integrates(fspid) {
        return false;
    }
    let [least, most] = ends_of_gain(fspid);
    let nothing = NOTHING * f64::max(-least, most);
    let is_literal = fspid.config().integral == IntegralForm::Literal;
    least < -nothing || (is_literal && most > nothing)
}

/// The least and the largest gain of the integral that rules and limits are seen to bring about.
fn ends_of_gain(fspid: &Fspid<f64>) -> [f64; 2] {
    let leakage_per_s = leakage_per_s(fspid);
    let held = Holding { fspid, command_per_pitch: 0.0, gains: Gains::ZERO, leakage_per_s };
    let range = fspid.tuner().supervisor().range();
    let inside = (-STEPS..=STEPS).map(|step| f64::from(step) / f64::from(STEPS));
    let places: Vec<f64> = inside.chain(BEYOND).map(|share| share * range).collect();
    let pairs = places.iter().flat_map(|error| places.iter().map(|beside| [*error, *beside]));
    pairs
        .map(|seen| held.gains_at(seen).ki)
        .fold([0.0, 0.0], |[least, most], ki| [f64::min(least, ki), f64::max(most, ki)])
}
