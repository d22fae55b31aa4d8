//! The paper's 747 behind its servo, and rules by which its gains move.

use fspid_core::Gains;
use fspid_fuzzy::{Defuzzifier, OutOfRange, RuleTable, Supervisor};
use fspid_sim::actuator::{Actuator, Lag};
use fspid_sim::loop_model::Sensing;
use fspid_sim::{Controller, ElevatorSign};

// Of the crate for whoever asks, who may be the crate itself.
use super::LoopDescription;

pub(crate) const NOMINAL: Gains<f64> = Gains { kp: 2.0, ki: 0.5, kd: 1.0 };
/// Each gain rises with the error, and not with its change.
const RISING: &str = "NB NB NB NB NB NB NB
NM NM NM NM NM NM NM
NS NS NS NS NS NS NS
ZO ZO ZO ZO ZO ZO ZO
PS PS PS PS PS PS PS
PM PM PM PM PM PM PM
PB PB PB PB PB PB PB";

/// By which each gain rises with the error, up to 5 either way.
pub(crate) fn rising() -> Supervisor<f64> {
    let table = RuleTable::parse([RISING; 3]).expect("a table");
    Supervisor::new(&table, 5.0, Defuzzifier::Exact, OutOfRange::Clamp).expect("allowed")
}

pub(crate) fn loop_of(controller: Controller) -> LoopDescription {
    LoopDescription {
        numerator: vec![-1.69144, -0.84341, -0.0099096],
        denominator: vec![1.0, 1.17103, 1.55405, 0.012538, 0.0072771],
        elevator_sign: ElevatorSign::NoseDownPositive,
        actuator: Actuator::new(Lag::first_order(0.1).expect("allowed")),
        pitch: Sensing::DIRECT,
        rate: Sensing::DIRECT,
        controller,
    }
}
