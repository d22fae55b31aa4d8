//! The loop that tests of single parts fly: the Navion of the books, with gains that hold it.

use fspid_core::Gains;
use fspid_sim::actuator::Actuator;
use fspid_sim::loop_model::Sensing;
use fspid_sim::{Controller, ElevatorSign};

use crate::{Asked, Certificate, Effort, LoopDescription, Range, Verdict, certify};

pub(in crate::steps) const NUMERATOR: [f64; 3] = [-11.01, -22.6, -1.31];
const DENOMINATOR: [f64; 5] = [1.0, 5.1, 13.3, 0.684, 0.632];
pub(in crate::steps) const GAINS: Gains<f64> = Gains { kp: 0.82, ki: 0.43, kd: 0.165 };

/// It with a servo and a controller.
pub(in crate::steps) fn navion(actuator: Actuator, controller: Controller) -> LoopDescription {
    LoopDescription {
        numerator: NUMERATOR.to_vec(),
        denominator: DENOMINATOR.to_vec(),
        elevator_sign: ElevatorSign::NoseDownPositive,
        actuator,
        pitch: Sensing::DIRECT,
        rate: Sensing::DIRECT,
        controller,
    }
}

/// What is proved of a loop without loads, steps among it.
pub(in crate::steps) fn proved(description: &LoopDescription) -> Certificate {
    let asked = Asked::within(Range { setpoint_rad: 0.05, load_rad: 0.0 });
    let outcome = certify(description, &asked, &Effort::default()).expect("an answer");
    let Verdict::Proved(certificate, _) = outcome.verdict else { panic!("not proved") };
    certificate
}
