//! Closed loops against an independent simulation (`oracles/make_traces.py`) and the sampled loop's
//! eigenvalues to 40 digits (`oracles/make_loop_stability.py`).

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use std::path::Path;

use fspid_core::fuzzy::{Defuzzifier, OutOfRange, RuleTable, Supervisor};
use fspid_core::{
    AntiWindup, Change, ControllerSetting, Derivative, ErrorSign, Fspid, GainLimits, Gains,
    InputScale, IntegralForm, Law, Limits, Pid, PidConfig, SelfTuner, SetpointWeights,
    TunerSettings,
};
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::stability::{instability, loop_spectral_radius};
use fspid_sim::{
    Actuator, Controller, EarlyEnd, ElevatorSign, EndCause, LinearPlant, NamedController, Outcome,
    Scenario, Surroundings, Timing, Trace, simulate,
};

const DEG: f64 = std::f64::consts::PI / 180.0;

fn b747() -> LinearPlant {
    LinearPlant::new(
        &[-1.69144, -0.84341, -0.009_909_6],
        &[1.0, 1.17103, 1.55405, 0.012_538, 0.007_277_1],
        ElevatorSign::NoseDownPositive,
    )
    .expect("the paper's plant")
}

fn navion() -> LinearPlant {
    let denominator = [1.0, 4.9676, 12.941, 0.0];
    LinearPlant::new(&[11.7304, 22.578], &denominator, ElevatorSign::NoseUpPositive)
        .expect("the paper's plant")
}

fn scenario(plant: LinearPlant, controller: Controller) -> Scenario {
    Scenario {
        name: "reference".into(),
        plant: plant.into(),
        plant_changes: Vec::new(),
        actuator: Actuator::first_order(0.1).expect("allowed"),
        timing: Timing::new(0.01, 20.0).expect("allowed"),
        setpoint: Profile::new(DEG, Shape::Step { at_s: 0.0 }).expect("allowed"),
        disturbances: Vec::new(),
        controllers: vec![NamedController { name: "C".into(), controller }],
        externals: Vec::new(),
        surroundings: Surroundings::default(),
        autopilot: None,
    }
}

fn square(scenario: Scenario) -> Scenario {
    let shape = Shape::Square { at_s: 0.0, half_period_s: 5.52, bipolar: true };
    Scenario { setpoint: Profile::new(DEG, shape).expect("allowed"), ..scenario }
}

fn pid(kp: f64, ki: f64, kd: f64, config: PidConfig<f64>) -> Controller {
    Controller::Fixed(Pid::new(Gains { kp, ki, kd }, config).expect("allowed"))
}

fn plain() -> PidConfig<f64> {
    PidConfig::sampled_every(0.01)
}

fn supervisor(range: f64) -> Supervisor<f64> {
    let file = include_str!("../../../data/rule-tables/printed.toml");
    let parts: Vec<&str> = file.split("\"\"\"").collect();
    let table = RuleTable::parse([parts[1], parts[3], parts[5]]).expect("a shipped table");
    Supervisor::new(&table, range, Defuzzifier::Exact, OutOfRange::Clamp).expect("allowed")
}

fn fspid(
    nominal: [f64; 3],
    range: f64,
    settings: TunerSettings<f64>,
    config: PidConfig<f64>,
) -> Controller {
    let [kp, ki, kd] = nominal;
    let tuner = SelfTuner::new(Gains { kp, ki, kd }, supervisor(range), settings).expect("allowed");
    Controller::SelfTuning(Fspid::new(tuner, config).expect("allowed"))
}

/// The example of the scenario file: factors in degrees.
fn example() -> TunerSettings<f64> {
    TunerSettings {
        input_scale: InputScale { error_per_rad: 1.0 / DEG, change_per_rad: 0.2 / DEG },
        output_scale: Gains { kp: 0.2, ki: 0.05, kd: 0.1 },
        ..TunerSettings::literal()
    }
}

fn figure_8b() -> TunerSettings<f64> {
    let floor = Limits::new(ControllerSetting::GainLimits, 0.0, f64::INFINITY).expect("allowed");
    TunerSettings {
        error_sign: ErrorSign::MeasurementMinusSetpoint,
        input_scale: InputScale { error_per_rad: 37.52 / DEG, change_per_rad: 30.14 / DEG },
        output_scale: Gains { kp: 0.3332, ki: 0.0007, kd: 0.0341 },
        gain_limits: Some(GainLimits { kp: floor, ki: floor, kd: floor }),
        ..TunerSettings::literal()
    }
}

fn flown(scenario: &Scenario) -> Trace {
    simulate(scenario).expect("a scenario that flies").traces.remove(0)
}

/// Compares every tenth sample of all nine columns.
fn assert_agrees(trace: &Trace, file: &str, tolerance: f64) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(file);
    let text = std::fs::read_to_string(path).expect("a reference file");
    for (row, line) in text.lines().skip(1).enumerate() {
        let theirs: Vec<f64> = line.split(',').map(|word| word.parse().expect("number")).collect();
        let k = row * 10;
        let gains = trace.gains[k];
        let ours = [
            trace.time_s[k],
            trace.setpoint_rad[k] / DEG,
            trace.theta_rad[k] / DEG,
            trace.q_rad_s[k] / DEG,
            trace.command_rad[k] / DEG,
            trace.elevator_rad[k] / DEG,
            gains.kp,
            gains.ki,
            gains.kd,
        ];
        for (column, (ours, theirs)) in ours.iter().zip(&theirs).enumerate() {
            let difference = (ours - theirs).abs() / theirs.abs().max(1.0);
            assert!(difference <= tolerance, "{file} row {row} column {column}: {ours} {theirs}");
        }
    }
}

/// Rounding of two thousand samples; the reference is within 1e-12 of 40 digits itself.
const TOLERANCE: f64 = 2e-12;
/// This loop grows: its kd drifts below zero, and rounding grows with it (reference: 5e-11).
const GROWING_TOLERANCE: f64 = 1e-9;

#[test]
fn a_proportional_loop_with_rate_gyro_flies_as_the_reference() {
    let config = PidConfig { rate_gain_s: 0.9144, ..plain() };
    let trace = flown(&scenario(b747(), pid(3.5287, 0.0, 0.0, config)));
    assert_agrees(&trace, "trace_747_p_rate.csv", TOLERANCE);
}

#[test]
fn a_pid_loop_flies_as_the_reference() {
    let trace = flown(&scenario(b747(), pid(2.0, 0.5, 1.0, plain())));
    assert_agrees(&trace, "trace_747_pid.csv", TOLERANCE);
    let navion_loop = scenario(navion(), pid(0.7019, 0.0739, 0.0554, plain()));
    assert_agrees(&flown(&square(navion_loop)), "trace_navion_pid_8b.csv", TOLERANCE);
}

#[test]
fn a_self_tuning_loop_flies_as_the_reference() {
    let controller = fspid([2.0, 0.5, 1.0], 5.0, example(), plain());
    assert_agrees(&flown(&scenario(b747(), controller)), "trace_747_fspid.csv", TOLERANCE);
}

#[test]
fn the_paper_s_literal_reading_flies_as_the_reference() {
    let config = PidConfig { integral: IntegralForm::Literal, ..plain() };
    let controller = fspid([0.7019, 0.0739, 0.0554], 40.0, figure_8b(), config);
    let trace = flown(&square(scenario(navion(), controller)));
    assert_agrees(&trace, "trace_navion_fspid_8b.csv", TOLERANCE);
}

#[test]
fn an_accumulating_loop_flies_as_the_reference() {
    let settings = TunerSettings {
        law: Law::Accumulating { leakage_per_s: 0.0 },
        change: Change::Delta,
        ..example()
    };
    let controller = fspid([2.0, 0.5, 1.0], 5.0, settings, plain());
    let trace = flown(&scenario(b747(), controller));
    assert_agrees(&trace, "trace_747_fspid_accumulating.csv", GROWING_TOLERANCE);
}

fn filtered(limit_deg: f64) -> Controller {
    let limit = limit_deg * DEG;
    let config = PidConfig {
        setpoint_weights: SetpointWeights { proportional: 0.7, derivative: 0.0 },
        derivative: Derivative { filter_s: 0.05 },
        limits: Some(Limits::new(ControllerSetting::OutputLimits, -limit, limit).expect("allowed")),
        anti_windup: AntiWindup::BackCalculation { tracking_s: 0.5 },
        ..plain()
    };
    pid(2.0, 0.5, 1.0, config)
}

#[test]
fn a_filtered_and_limited_pid_with_back_calculation_flies_as_the_reference() {
    let trace = flown(&scenario(b747(), filtered(2.0)));
    assert_agrees(&trace, "trace_747_pid_filtered.csv", TOLERANCE);
    let trace = flown(&scenario(b747(), filtered(0.8)));
    assert!(trace.saturated_samples > 0);
    assert_agrees(&trace, "trace_747_pid_limited.csv", TOLERANCE);
}

#[test]
fn a_servo_at_its_rate_and_position_limits_flies_as_the_reference() {
    let mut scenario = scenario(b747(), pid(3.5, 0.0, 0.0, plain()));
    scenario.actuator = Actuator::first_order(0.1)
        .and_then(|servo| servo.with_position_limit(3.0 * DEG))
        .and_then(|servo| servo.with_rate_limit(10.0 * DEG))
        .expect("allowed");
    assert_agrees(&flown(&scenario), "trace_747_p_limited_servo.csv", TOLERANCE);
}

#[test]
fn the_spectral_radius_of_the_sampled_loop_agrees_with_forty_digits() {
    let text = include_str!("data/loop_stability.csv");
    let mut rows = 0;
    for line in text.lines().skip(1) {
        let words: Vec<&str> = line.split(',').collect();
        let number = |index: usize| words[index].parse::<f64>().expect("a number");
        let plant = if words[0] == "b747-paper" { b747() } else { navion() };
        let config = PidConfig { rate_gain_s: number(5), ..PidConfig::sampled_every(number(1)) };
        let controller = pid(number(2), number(3), number(4), config);
        let mut scenario = scenario(plant, controller);
        scenario.timing = Timing::new(number(1), 20.0).expect("allowed");
        let gains = controller.nominal();
        let ours = loop_spectral_radius(&scenario, gains, &config).expect("eigenvalues");
        assert!((ours - number(6)).abs() < 1e-9, "{line}: {ours}");
        let unstable = instability(&scenario, &controller).expect("eigenvalues").is_some();
        assert_eq!(unstable, words[7] == "unstable", "{line}: {ours}");
        rows += 1;
    }
    assert_eq!(rows, 67);
}

#[test]
fn the_sampled_loop_turns_unstable_at_its_neutral_gain() {
    for line in include_str!("data/neutral_gain.csv").lines().skip(1) {
        let words: Vec<&str> = line.split(',').collect();
        let number = |index: usize| words[index].parse::<f64>().expect("a number");
        let plant = if words[0] == "b747-paper" { b747() } else { navion() };
        for (factor, expected) in [(1.0 - 1e-6, false), (1.0 + 1e-6, true)] {
            let config = PidConfig::sampled_every(number(1));
            let controller = pid(number(2) * factor, 0.0, 0.0, config);
            let mut scenario = scenario(plant.clone(), controller);
            scenario.timing = Timing::new(number(1), 20.0).expect("allowed");
            let unstable = instability(&scenario, &controller).expect("eigenvalues").is_some();
            assert_eq!(unstable, expected, "{line} times {factor}");
        }
    }
}

#[test]
fn an_unstable_loop_ends_its_trace_when_it_diverges() {
    let trace = flown(&scenario(b747(), pid(100.0, 0.0, 0.0, plain())));
    let Outcome::EndedEarly(EarlyEnd { at_s, cause: EndCause::Diverged }) = trace.outcome else {
        panic!("did not diverge")
    };
    assert!(at_s > 0.0 && trace.rows() < 2001);
    assert!(trace.theta_rad.iter().all(|theta| theta.abs() <= 1e6 * DEG));
}

#[test]
fn the_wrong_elevator_sign_diverges() {
    let plant = LinearPlant::new(
        &[-1.69144, -0.84341, -0.009_909_6],
        &[1.0, 1.17103, 1.55405, 0.012_538, 0.007_277_1],
        ElevatorSign::NoseUpPositive,
    );
    let controller = pid(2.0, 0.5, 1.0, plain());
    let scenario = scenario(plant.expect("proper"), controller);
    assert!(instability(&scenario, &controller).expect("eigenvalues").is_some());
}
