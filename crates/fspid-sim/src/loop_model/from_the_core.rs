//! The controller's rows of the matrix are what the core's own step does around rest, for every option.

use fspid_core::{Gains, ModelState, Pid, PidConfig, Previous, Sample, State};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::{Followers, LoopModel, LoopSettings, Memory, SampledPlant, Sensing};
use fspid_options::any_controller;

/// A state is moved by so much. Around rest the controller is linear, so that only rounding is left.
const MOVED: f64 = 1e-6;
/// Relative to the largest entry: rounding of values of 1e-6.
const TOLERANCE: f64 = 1e-8;

/// Two quantities that stand still, seen as pitch and rate.
fn still() -> SampledPlant<f64> {
    SampledPlant { states: 2, rows: vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0], rate: vec![0.0, 1.0] }
}

fn model(config: &PidConfig<f64>, gains: Gains<f64>) -> LoopModel<f64> {
    let settings = LoopSettings {
        config: *config,
        followers: Followers::NONE,
        memory: Memory::of_gains(gains, config),
        delay_samples: 0,
        pitch: Sensing::DIRECT,
        rate: Sensing::DIRECT,
    };
    LoopModel::new(still(), settings)
}

/// The command and the next state, in the order of the model's, after a state was moved from rest.
fn stepped(pid: &Pid<f64>, names: &[String], moved: &str) -> (f64, Vec<f64>) {
    let by = |name: &str| if name == moved { MOVED } else { 0.0 };
    let last_rad = by("last sample");
    let previous = Previous {
        error_rad: last_rad,
        derivative_input_rad: last_rad,
        gains: pid.gains(),
        model: ModelState::at(0.0),
    };
    let mut state = State { previous: Some(previous), ..State::new() };
    (state.integral, state.derivative_rad_s) = (by("integral"), by("derivative"));
    let (measurement_rad, rate_rad_s) = (by("plant 1"), by("plant 2"));
    let step = pid.step(&mut state, Sample { setpoint_rad: 0.0, measurement_rad, rate_rad_s });
    let next = |name: &String| match name.as_str() {
        "plant 1" => measurement_rad,
        "plant 2" => rate_rad_s,
        "integral" => state.integral,
        "derivative" => state.derivative_rad_s,
        _ => state.previous.expect("a good sample").derivative_input_rad,
    };
    (step.command_rad, names.iter().map(next).collect())
}

fn largest(rows: &[Vec<f64>]) -> f64 {
    rows.iter().flatten().fold(1.0, |most, entry| entry.abs().max(most))
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 400,
        rng_seed: RngSeed::Fixed(15),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn the_matrix_is_the_derivative_of_the_cores_step_at_rest(
        controller in any_controller(),
        apart in prop::array::uniform3(-0.01..0.01),
    ) {
        // The gains of a moment, and with them what is coupled to them.
        let Gains { kp, ki, kd } = controller.nominal();
        let off = |gain: f64, by: f64| if gain == 0.0 { 0.0 } else { gain + by };
        let gains = Gains { kp: kp + apart[0], ki: off(ki, apart[1]), kd: off(kd, apart[2]) };
        let config = controller.config_at(gains);
        let model = model(&config, gains);
        let pid = Pid::new(gains, config).expect("allowed");
        let (names, matrix) = (model.state_names(), model.closed(gains));
        let command = model.command_row(gains);
        let allowed = TOLERANCE * largest(&matrix).max(largest(std::slice::from_ref(&command)));
        for (column, moved) in names.iter().enumerate() {
            let (found, next) = stepped(&pid, &names, moved);
            let (found, expected) = (found / MOVED, command[column]);
            prop_assert!((found - expected).abs() <= allowed, "command by {}: {} {}", moved, found, expected);
            for (name, (row, value)) in names.iter().zip(matrix.iter().zip(next)) {
                let (found, expected) = (value / MOVED, row[column]);
                prop_assert!((found - expected).abs() <= allowed, "{} by {}: {} {}", name, moved, found, expected);
            }
        }
    }
}
