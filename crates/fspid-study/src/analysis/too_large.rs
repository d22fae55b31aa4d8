//! Which number of a controller is to blame for a loop that leaves the range of numbers.

use fspid_lti::LtiError;
use fspid_sim::{Controller, NamedController, SimError};

/// A sampled loop that leaves the range of numbers, blamed on the gain that is farthest out.
pub(crate) fn too_large(error: SimError, named: &NamedController) -> SimError {
    let SimError::Linear(LtiError::NotFinite { .. } | LtiError::OutOfRange { .. }) = error else {
        return error;
    };
    let gains = named.controller.nominal();
    let all = [("kp", gains.kp), ("ki", gains.ki), ("kd", gains.kd)];
    let rate = ("rate_gain", named.controller.config().rate_gain_s);
    let largest = all.into_iter().fold(rate, |a, b| if b.1.abs() > a.1.abs() { b } else { a });
    let key = match &named.controller {
        Controller::SelfTuning(_) if largest.0 != "rate_gain" => format!("nominal.{}", largest.0),
        _ => largest.0.to_owned(),
    };
    SimError::TooLarge { key: format!("controller.{}.{key}", named.name), found: largest.1 }
}
