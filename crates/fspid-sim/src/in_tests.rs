//! What unit tests of this crate fly: the Navion, with loops around its pitch loop.

#[path = "../../fspid-aircraft/tests/support/mod.rs"]
mod support;

use fspid_aircraft::aerodynamics::derivatives::{DragLaw, ThrustLaw};
use fspid_aircraft::data::{DerivativeData, Laws};
use fspid_aircraft::{Aircraft, TrimTarget};
use fspid_core::{Gains, Pid, PidConfig};

use crate::aircraft::{AircraftPlant, Forces};
use crate::autopilot::{Autopilot, Entry, Mode, Moves, OuterLoop, Quantity, Units};
use crate::controller::Controller;
use crate::scenario::Scenario;
use crate::signal::{Profile, Shape};
use crate::timing::Timing;

pub(crate) const DT_S: f64 = 0.02;
pub(crate) const ALTITUDE_M: f64 = 300.0;
/// The speed of the data.
pub(crate) const SPEED_M_S: f64 = 176.0 * support::FOOT_M;

/// The Navion at the condition of its data, in air that is the same everywhere.
pub(crate) fn navion() -> AircraftPlant {
    trimmed(&support::derivative_data("navion"))
}

/// The same with an air brake that makes so much drag.
pub(crate) fn braked(drag: f64) -> AircraftPlant {
    let mut data = support::derivative_data("navion");
    data.longitudinal.drag.reference += drag;
    trimmed(&data)
}

/// An aircraft whose aileron rolls nothing, at the condition of its data.
pub(crate) fn without_wings() -> AircraftPlant {
    trimmed(&support::derivative_data("twin-otter"))
}

fn trimmed(data: &DerivativeData) -> AircraftPlant {
    let laws = Laws { drag: DragLaw::Polar, thrust: ThrustLaw::Constant };
    let forces = Forces::from(data.force_model(laws));
    let aircraft = Aircraft::new(data.mass_properties(), forces, data.reference_environment());
    let airspeed_m_s = data.reference.airspeed_m_s;
    let target = TrimTarget { airspeed_m_s, altitude_m: ALTITUDE_M, flight_path_rad: 0.0 };
    AircraftPlant::trimmed(aircraft.expect("a body"), target).expect("flies")
}

/// What holds its pitch.
pub(crate) fn pitch() -> Controller {
    pid([0.82, 0.43, 0.165], PidConfig::sampled_every(DT_S))
}

pub(crate) fn pid([kp, ki, kd]: [f64; 3], config: PidConfig<f64>) -> Controller {
    Controller::Fixed(Pid::new(Gains { kp, ki, kd }, config).expect("allowed"))
}

/// A loop in SI units with these gains.
pub(crate) fn outer(name: &str, holds: Quantity, moves: Moves, gains: [f64; 3]) -> OuterLoop {
    let (name, controller) = (name.to_owned(), pid(gains, PidConfig::sampled_every(DT_S)));
    OuterLoop { name, holds, moves, controller, units: Units::SI, sensor: None }
}

/// A mode that holds everything as it is.
pub(crate) fn mode(name: &str, engaged: &[usize]) -> Mode {
    Mode {
        name: name.to_owned(),
        entry: Entry::default(),
        engaged: engaged.to_vec(),
        total_energy: false,
        targets: Vec::new(),
        bank_rad: 0.0,
    }
}

/// A flight of a minute whose set-point stays.
pub(crate) fn scenario(plant: AircraftPlant, autopilot: Option<Autopilot>) -> Scenario {
    let still = Profile::new(0.0, Shape::Step { at_s: 0.0 }).expect("allowed");
    let timing = Timing::new(DT_S, 60.0).expect("allowed");
    let scenario = Scenario::new("an aircraft", plant, timing, still);
    Scenario { autopilot, ..scenario }
}
