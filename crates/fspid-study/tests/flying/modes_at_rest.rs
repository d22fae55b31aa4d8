//! What small motions of an autopilot's modes are asked with: an aircraft that nothing turns.

use fspid_study::simulation::{ControllerResult, Simulation};

use crate::flying::study;

const CAPTURE: &str = include_str!("../../../../scenarios/gallery/altitude-capture.toml");

fn flown(text: &str, set: &[&str]) -> ControllerResult {
    let found = Simulation::of(&study(text, set)).expect("it flies");
    found.results.into_iter().next().expect("a controller")
}

/// Side speed, roll, yaw and bank of an aircraft without lateral derivatives are one pole at 1, four times. Rounding made of them
/// what doubles in 44800 s, or 30100 with a millionth of a metre a second more.
#[test]
fn an_aircraft_that_nothing_turns_aside_is_not_called_unstable_by_rounding() {
    let twin = CAPTURE.replace("name = \"navion\"", "name = \"twin-otter\"");
    let twin = twin.replace("altitude_ft = 1000.0", "altitude_m = 1500.0");
    for airspeed in ["60.0", "60.000001", "60.1"] {
        let speed = format!("airspeed_m_s = {airspeed}");
        let text = twin.replace("airspeed_ft_s = 176.0", &speed);
        let flight = flown(&text, &["loop.duration_s=10.0"]);
        assert!(flight.at_rest.unstable.is_none(), "{airspeed} {:?}", flight.at_rest.unstable);
    }
}
