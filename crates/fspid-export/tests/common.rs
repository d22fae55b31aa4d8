//! A controller that several tests export.

use fspid_core::fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_core::{Controller, Fspid, Gains, PidConfig, SelfTuner, TunerSettings, paper};

/// The paper's rules around plain gains, at 100 Hz.
pub(crate) fn paper() -> Controller<f64> {
    paper_every(0.01)
}

/// The same with another period in seconds.
pub(crate) fn paper_every(dt_s: f64) -> Controller<f64> {
    let rules = Supervisor::new(&paper::rules(), 5.0, Defuzzifier::Exact, OutOfRange::Clamp);
    let nominal = Gains { kp: 1.0, ki: 0.5, kd: 0.2 };
    let tuner = SelfTuner::new(nominal, rules.expect("rules"), TunerSettings::literal());
    let fspid = Fspid::new(tuner.expect("a tuner"), PidConfig::sampled_every(dt_s));
    Controller::SelfTuning(fspid.expect("a controller"))
}
