//! A flight of `simulate`, sample by sample, gets its own commands.

use std::fmt::Write as _;

use fspid_scenario::units::degrees;
use fspid_study::fly::Angles;
use fspid_study::simulation::{ControllerResult, Simulation};

use super::{numbers, pilot, said, study};

/// The samples of a flight as lines, in the unit that `unit` makes of radians.
fn lines(result: &ControllerResult, unit: impl Fn(f64) -> f64) -> String {
    let trace = &result.trace;
    let mut text = String::new();
    for k in 0..trace.rows() {
        let [setpoint, theta, q] =
            [trace.setpoint_rad[k], trace.theta_rad[k], trace.q_rad_s[k]].map(&unit);
        let _ = writeln!(text, "{setpoint:?} {theta:?} 0.01 {q:?}");
    }
    text
}

#[test]
fn a_recorded_flight_in_radians_gets_the_recorded_commands_bit_for_bit() {
    let simulation = Simulation::of(&study()).expect("it flies");
    for result in &simulation.results {
        let mut pilot = pilot(&result.name, Angles::Radians);
        let (answers, told) = said(&mut pilot, lines(result, |rad| rad).as_bytes());
        let commands: Vec<u64> = numbers(&answers).iter().map(|x| x.to_bits()).collect();
        let recorded: Vec<u64> =
            result.trace.command_rad.iter().map(|x| (x + 0.0).to_bits()).collect();
        assert_eq!(commands.len(), 2001);
        assert!(commands == recorded, "{}", result.name);
        assert_eq!(told, "", "{}", result.name);
    }
}

/// Near, not equal: in degrees a recorded angle has lost up to a unit in its last place, some
/// 1e-16 of it. The derivative makes 1e-16 · 1 s / 0.01 s of that and the integral a little more.
const LAST_PLACE_TOL_DEG: f64 = 1e-12;

#[test]
fn a_recorded_flight_in_degrees_gets_the_recorded_commands_to_the_last_places() {
    let simulation = Simulation::of(&study()).expect("it flies");
    for result in &simulation.results {
        let mut pilot = pilot(&result.name, Angles::Degrees);
        let (answers, _) = said(&mut pilot, lines(result, degrees).as_bytes());
        for (command, recorded_rad) in numbers(&answers).iter().zip(&result.trace.command_rad) {
            let away = (command - degrees(*recorded_rad)).abs();
            assert!(away < LAST_PLACE_TOL_DEG, "{}: {away:e}", result.name);
        }
    }
}
