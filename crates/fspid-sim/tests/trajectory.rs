//! The linearised flight against the difference of two flights that start a little apart.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use std::f64::consts::PI;
use std::ops::ControlFlow;

use fspid_aircraft::aerodynamics::derivatives::{DragLaw, ThrustLaw};
use fspid_aircraft::data::Laws;
use fspid_aircraft::{Aircraft, Environment, TrimTarget};
use fspid_core::fuzzy::{Defuzzifier, NumberTable, OutOfRange, RuleTable, Supervisor};
use fspid_core::{
    AntiWindup, Change, ControllerSetting, DeadZone, Derivative, ErrorSign, Fspid, GainLimits,
    Gains, Guard, InputScale, IntegralForm, Law, Limits, Pid, PidConfig, SecondInput, SelfTuner,
    SetpointWeights, TunerSettings,
};
use fspid_sim::actuator::{Actuator, Lag};
use fspid_sim::aircraft::Forces;
use fspid_sim::flown::trajectory::{SmallSignal, linearise_along, walk_along};
use fspid_sim::sensor::{PITCH, RATE, Sensor, SensorModel};
use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
use fspid_sim::stability::loop_spectral_radius;
use fspid_sim::{
    AircraftPlant, Controller, ElevatorSign, LinearPlant, NamedController, PlantChange, Scenario,
    SimError, Surroundings, Timing, simulate,
};

use crate::support;

const DT_S: f64 = 0.01;
const DEG: f64 = PI / 180.0;
/// Of a command, rad: what is quadratic is below 1e-7 of what is linear, and what is rounded below 1e-8.
const KICK_RAD: f64 = 1e-7;
/// Of the largest difference: what a kick leaves that turns a corner of the rules (a rule that takes
/// over from another) one sample earlier or later.
const TOLERANCE: f64 = 1e-4;
/// Before the set-point's step at 50 ms, which drives what is limited into its limits.
const BEFORE_S: f64 = 0.03;

fn b747() -> LinearPlant {
    LinearPlant::new(
        &[-1.69144, -0.84341, -0.009_909_6],
        &[1.0, 1.17103, 1.55405, 0.012_538, 0.007_277_1],
        ElevatorSign::NoseDownPositive,
    )
    .expect("the paper's plant")
}

fn table() -> RuleTable {
    let file = include_str!("../../../data/rule-tables/printed.toml");
    let parts: Vec<&str> = file.split("\"\"\"").collect();
    RuleTable::parse([parts[1], parts[3], parts[5]]).expect("a shipped table")
}

struct Case {
    settings: TunerSettings<f64>,
    config: PidConfig<f64>,
    defuzzifier: Defuzzifier,
    out_of_range: OutOfRange,
    actuator: Actuator,
    surroundings: Surroundings,
}

fn base() -> Case {
    let settings = TunerSettings {
        input_scale: InputScale { error_per_rad: 180.0 / PI, change_per_rad: 60.0 / PI },
        output_scale: Gains { kp: 0.1, ki: 0.05, kd: 0.08 },
        ..TunerSettings::literal()
    };
    Case {
        settings,
        config: PidConfig::sampled_every(DT_S),
        defuzzifier: Defuzzifier::Exact,
        out_of_range: OutOfRange::Clamp,
        actuator: Actuator::first_order(0.1).expect("allowed"),
        surroundings: Surroundings::default(),
    }
}

impl Case {
    fn controller(&self) -> Controller {
        let supervisor = Supervisor::new(&table(), 5.0, self.defuzzifier, self.out_of_range);
        let nominal = Gains { kp: 1.2, ki: 0.3, kd: 0.5 };
        let tuner = SelfTuner::new(nominal, supervisor.expect("allowed"), self.settings);
        Controller::SelfTuning(Fspid::new(tuner.expect("allowed"), self.config).expect("allowed"))
    }

    fn scenario(&self) -> Scenario {
        let named = NamedController { name: "C".into(), controller: self.controller() };
        Scenario {
            name: "apart".into(),
            plant: b747().into(),
            plant_changes: Vec::new(),
            actuator: self.actuator,
            timing: Timing::new(DT_S, 4.0).expect("allowed"),
            setpoint: Profile::new(4.0 * DEG, Shape::Step { at_s: 0.05 }).expect("allowed"),
            disturbances: Vec::new(),
            controllers: vec![named],
            externals: Vec::new(),
            surroundings: self.surroundings.clone(),
            autopilot: None,
        }
    }
}

fn kicked(mut scenario: Scenario, at_s: f64) -> Scenario {
    let kick = Shape::Pulse { at_s, width_s: DT_S };
    scenario.disturbances.push(Disturbance::new(Entry::Servo, KICK_RAD, kick).expect("allowed"));
    scenario
}

fn thetas(scenario: &Scenario) -> Vec<f64> {
    simulate(scenario).expect("flies").traces.remove(0).theta_rad
}

/// Largest error of the predicted difference of two flights, relative to the largest difference; the
/// share of limited samples after the kick. What arrives at the servo after a delay was a change of the
/// command so many samples before.
fn error(scenario: &Scenario, at_s: f64, delay: usize) -> (f64, f64) {
    let arrives = (at_s / DT_S).round() as usize;
    let from = arrives - delay;
    let kicked = thetas(&kicked(scenario.clone(), at_s));
    let apart: Vec<f64> = kicked.iter().zip(thetas(scenario)).map(|(a, b)| a - b).collect();
    let largest = apart.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let (mut state, mut worst, mut limited) = (Vec::new(), 0.0_f64, 0);
    let controller = scenario.controllers[0].controller;
    let visit = |small: &SmallSignal| {
        if small.k == from {
            state = small.by_command.iter().map(|by| by * KICK_RAD).collect();
        } else if small.k > from {
            limited += usize::from(small.limited);
            worst = worst.max((state[0] - apart[small.k]).abs());
            let product = |row: &Vec<f64>| row.iter().zip(&state).map(|(a, x)| a * x).sum();
            state = small.matrix.iter().map(product).collect();
        }
        ControlFlow::Continue(())
    };
    let (_, names) = walk_along(scenario, &controller, visit).expect("flies");
    assert_eq!(names.len(), state.len(), "{names:?}");
    (worst / largest, limited as f64 / (apart.len() - from) as f64)
}

/// Share of limited samples of a case whose differences are as linearised.
fn agrees(case: &Case, at_s: f64) -> f64 {
    let (off, limited) = error(&case.scenario(), at_s, case.actuator.delay_samples());
    assert!(off < TOLERANCE, "{off:e}, limited {limited}");
    limited
}

#[test]
fn small_differences_of_flights_are_as_linearised() {
    for at_s in [0.3, 0.8, 2.0] {
        agrees(&base(), at_s);
    }
}

#[test]
fn gains_that_accumulate_are_linearised_as_states() {
    let mut case = base();
    case.settings.law = Law::Accumulating { leakage_per_s: 0.7 };
    agrees(&case, 0.8);
}

fn sensor(delay_s: f64, channel: u32) -> Option<Sensor> {
    let model = SensorModel { delay_s, scale_error: 0.02, ..SensorModel::default() };
    Some(Sensor::new(model, 1, channel).expect("allowed"))
}

fn limits(size: f64) -> Option<Limits<f64>> {
    Some(Limits::new(ControllerSetting::OutputLimits, -size, size).expect("allowed"))
}

#[test]
fn every_form_of_controller_and_every_part_of_the_loop_is_linearised() {
    let mut case = base();
    case.config.integral = IntegralForm::Literal;
    agrees(&case, 0.8);
    case.settings.change = Change::Delta;
    case.settings.input_scale.change_per_rad = 2000.0 / PI;
    case.settings.error_sign = ErrorSign::MeasurementMinusSetpoint;
    agrees(&case, 0.8);
    case.config.derivative = Derivative { filter_s: 0.05 };
    case.config.setpoint_weights = SetpointWeights { proportional: 0.4, derivative: 0.0 };
    case.config.rate_gain_s = 0.3;
    agrees(&case, 0.8);
    let lag = Lag::second_order(30.0, 0.7).expect("allowed");
    case.actuator = Actuator::new(lag).with_delay(2).expect("allowed");
    case.surroundings.pitch_sensor = sensor(0.015, PITCH);
    case.surroundings.rate_sensor = sensor(0.02, RATE);
    agrees(&case, 0.8);
}

#[test]
fn limits_of_the_tuner_are_linearised_as_they_act() {
    let mut case = base();
    let within =
        |lower, upper| Limits::new(ControllerSetting::GainLimits, lower, upper).expect("allowed");
    let (kp, ki, kd) = (within(1.1, 1.3), within(0.25, 0.35), within(0.4, 0.6));
    case.settings.gain_limits = Some(GainLimits { kp, ki, kd });
    agrees(&case, 0.8);
    case.settings.law = Law::Accumulating { leakage_per_s: 0.0 };
    agrees(&case, 0.8);
    case = base();
    case.settings.dead_zone = Some(DeadZone { error_rad: 0.5 * DEG, change_rad: 1.0 * DEG });
    agrees(&case, 0.8);
    // A supervisor whose range is left.
    for out_of_range in OutOfRange::ALL {
        case = Case { out_of_range, ..base() };
        case.settings.input_scale.error_per_rad = 400.0;
        agrees(&case, 0.2);
    }
}

#[test]
fn supervisors_with_sampled_centroids_are_linearised() {
    for defuzzifier in [Defuzzifier::Midpoint(100), Defuzzifier::Vertices(101)] {
        agrees(&Case { defuzzifier, ..base() }, 0.8);
    }
}

#[test]
fn a_cut_command_is_linearised_with_every_anti_windup() {
    for integral in [IntegralForm::Bumpless, IntegralForm::Literal] {
        for anti_windup in [
            AntiWindup::None,
            AntiWindup::Conditional,
            AntiWindup::BackCalculation { tracking_s: 0.5 },
            AntiWindup::Clamping(limits(0.5 * DEG).expect("given")),
        ] {
            let mut case = base();
            case.config =
                PidConfig { integral, anti_windup, limits: limits(3.0 * DEG), ..case.config };
            let limited = agrees(&case, BEFORE_S);
            assert!(limited > 0.0, "{limited}");
            case.config = PidConfig { limits: None, slew_rad_s: Some(8.0 * DEG), ..case.config };
            let limited = agrees(&case, BEFORE_S);
            assert!(limited > 0.0, "{limited}");
        }
    }
}

#[test]
fn limits_of_servo_and_actuator_are_linearised_as_they_act() {
    let servo = Actuator::first_order(0.1).expect("allowed");
    let limited_servo = servo
        .with_position_limit(3.0 * DEG)
        .and_then(|servo| servo.with_rate_limit(12.0 * DEG))
        .expect("allowed");
    let limited = agrees(&Case { actuator: limited_servo, ..base() }, BEFORE_S);
    assert!(limited > 0.0, "{limited}");
    let lag = Lag::second_order(30.0, 0.7).expect("allowed");
    let actuator = Actuator::new(lag)
        .with_travel(-2.0 * DEG, 3.0 * DEG)
        .and_then(|actuator| actuator.with_rate_limit(15.0 * DEG))
        .and_then(|actuator| actuator.with_delay(3))
        .expect("allowed");
    let mut case = base();
    case.actuator = actuator;
    let limited = agrees(&case, BEFORE_S);
    assert!(limited > 0.0, "{limited}");
}

#[test]
fn a_change_of_the_plant_and_a_held_sample_are_linearised() {
    let mut scenario = base().scenario();
    let weaker = LinearPlant::new(
        &[-1.2, -0.7, -0.009],
        &[1.0, 1.0, 1.5, 0.012, 0.007],
        ElevatorSign::NoseDownPositive,
    );
    scenario.plant_changes =
        vec![PlantChange::new(1.0, 0.5, weaker.expect("allowed")).expect("allowed")];
    let (off, _) = error(&scenario, 0.8, 0);
    assert!(off < TOLERANCE, "{off:e}");
    let mut case = base();
    case.config.guard = Guard::new(5.0).expect("allowed");
    let mut scenario = case.scenario();
    let glitch = Shape::Pulse { at_s: 1.0, width_s: 0.05 };
    scenario.disturbances =
        vec![Disturbance::new(Entry::Measurement, 9.0, glitch).expect("allowed")];
    let (off, limited) = error(&scenario, 0.8, 0);
    assert!(off < TOLERANCE && (limited * 321.0 - 5.0).abs() < 1e-9, "{off:e} {limited}");
}

#[test]
fn frozen_gains_do_not_tell_what_gains_that_move_do_to_a_disturbance() {
    let scenario = base().scenario();
    let (mut moving, mut frozen) = (Vec::new(), Vec::new());
    let visit = |small: &SmallSignal| {
        if small.k == 30 {
            moving.clone_from(&small.by_command);
            frozen.clone_from(&small.by_command);
        } else if small.k > 30 && small.k <= 130 {
            let next = |rows: &[Vec<f64>], state: &[f64]| -> Vec<f64> {
                rows.iter().map(|row| row.iter().zip(state).map(|(a, x)| a * x).sum()).collect()
            };
            moving = next(&small.matrix, &moving);
            frozen = next(&small.frozen, &frozen);
        }
        ControlFlow::Continue(())
    };
    walk_along(&scenario, &scenario.controllers[0].controller, visit).expect("flies");
    assert!((moving[0] / frozen[0] - 1.0).abs() > 0.05, "{} {}", moving[0], frozen[0]);
}

#[test]
fn a_loop_with_fixed_gains_has_one_radius_and_shrinks_by_it() {
    let gains = Gains { kp: 2.0, ki: 0.3, kd: 0.4 };
    let config = PidConfig::sampled_every(DT_S);
    let controller = Controller::Fixed(Pid::new(gains, config).expect("allowed"));
    let mut scenario = base().scenario();
    scenario.timing = Timing::new(DT_S, 100.0).expect("allowed");
    let radius = loop_spectral_radius(&scenario, gains, &config).expect("found");
    let flown = linearise_along(&scenario, &controller, 100).expect("flies");
    assert_eq!(flown.points.len(), 101);
    // The first sample has no last one, and so no derivative.
    for point in &flown.points[1..] {
        assert!(
            (point.radius - radius).abs() < 1e-9 && (point.frozen_radius - radius).abs() < 1e-9
        );
    }
    assert_eq!((flown.above_one, flown.frozen_above_one, flown.limited), (0.0, 0.0, 0.0));
    let growth = flown.growth;
    // The slowest mode is all that is left after 100 s, 1.16 times as large as it would be alone.
    let exponent_1_s = libm::log(radius) / DT_S;
    assert!((growth.exponent_1_s - exponent_1_s).abs() < 0.2 / 100.0, "{growth:?} {exponent_1_s}");
    assert!(growth.largest < 1.0 && growth.whole < 0.4, "{growth:?}");
}

#[test]
fn a_loop_that_grows_says_how_fast_and_when_it_is_worst() {
    let gains = Gains { kp: 6.0, ki: 0.0, kd: 0.0 };
    let config = PidConfig::sampled_every(DT_S);
    let controller = Controller::Fixed(Pid::new(gains, config).expect("allowed"));
    let mut scenario = base().scenario();
    scenario.timing = Timing::new(DT_S, 60.0).expect("allowed");
    let radius = loop_spectral_radius(&scenario, gains, &config).expect("found");
    let flown = linearise_along(&scenario, &controller, 1).expect("flies");
    assert_eq!(flown.above_one, 1.0);
    let (worst, growth) = (flown.worst.expect("free"), flown.growth);
    assert!((worst.radius - radius).abs() < 1e-9, "{worst:?}");
    let exponent_1_s = libm::log(radius) / DT_S;
    assert!((growth.exponent_1_s / exponent_1_s - 1.0).abs() < 0.1, "{growth:?} {exponent_1_s}");
    assert!((growth.from_s, growth.to_s) == (DT_S, 60.0 + DT_S), "{growth:?}");
}

/// Navion at its trim; what is left out of the linearised motion (altitude, path) is slow.
#[test]
fn the_flight_of_a_nonlinear_aircraft_is_linearised_where_it_flies() {
    let data = support::derivative_data("navion");
    let laws = Laws { drag: DragLaw::Polar, thrust: ThrustLaw::Constant };
    let forces = Forces::from(data.force_model(laws));
    let aircraft = Aircraft::new(data.mass_properties(), forces, Environment::STANDARD);
    let target = TrimTarget { airspeed_m_s: 50.0, altitude_m: 500.0, flight_path_rad: 0.0 };
    let plant = AircraftPlant::trimmed(aircraft.expect("a body"), target).expect("flies");
    let mut case = base();
    case.settings.output_scale = Gains { kp: 0.05, ki: 0.02, kd: 0.02 };
    let mut scenario = case.scenario();
    scenario.plant = plant.into();
    let (off, limited) = error(&scenario, 0.8, 0);
    assert!(off < 2e-3 && limited == 0.0, "{off:e} {limited}");
    let flown = linearise_along(&scenario, &scenario.controllers[0].controller, 20).expect("flies");
    assert!(flown.worst.is_some_and(|worst| worst.radius < 1.1), "{:?}", flown.worst);
    assert_eq!(flown.states.first().map(String::as_str), Some("plant 1"));
}

#[test]
fn a_tuner_that_sees_the_rate_has_no_small_signals_along_its_flight() {
    let mut case = base();
    case.settings.second_input = SecondInput::Rate;
    let refused = linearise_along(&case.scenario(), &case.controller(), 10);
    assert!(matches!(refused, Err(SimError::Structure)), "{refused:?}");
}

#[test]
fn rules_that_conclude_numbers_have_no_small_signals_along_a_flight() {
    let case = base();
    let numbers = NumberTable::new([[[0.5; 7]; 7]; 3]).expect("finite");
    let supervisor = Supervisor::of_numbers(&numbers, 5.0, OutOfRange::Clamp).expect("allowed");
    let Controller::SelfTuning(fspid) = case.controller() else { panic!("self-tuning") };
    let tuner = SelfTuner::new(fspid.tuner().nominal(), supervisor, *fspid.tuner().settings());
    let fspid = Fspid::new(tuner.expect("allowed"), *fspid.config()).expect("allowed");
    let refused = linearise_along(&case.scenario(), &Controller::SelfTuning(fspid), 10);
    assert!(matches!(refused, Err(SimError::Structure)), "{refused:?}");
}
