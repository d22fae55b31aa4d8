//! Laws that every closed loop obeys, whatever its numbers.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use core::ops::ControlFlow;

use fspid_core::{Gains, Pid, PidConfig};
use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
use fspid_sim::{
    Actuator, Controller, ElevatorSign, LinearPlant, NamedController, Outcome, PlantChange,
    Scenario, SimError, Surroundings, Timing, Trace, fly_commanded, simulate,
};
use proptest::prelude::*;

const STEP: Shape = Shape::Step { at_s: 0.0 };

fn b747() -> LinearPlant {
    let denominator = [1.0, 1.17103, 1.55405, 0.012_538, 0.007_277_1];
    let numerator = [-1.69144, -0.84341, -0.009_909_6];
    LinearPlant::new(&numerator, &denominator, ElevatorSign::NoseDownPositive).expect("proper")
}

fn navion(share: f64) -> LinearPlant {
    let numerator = [share * 11.7304, share * 22.578];
    let denominator = [1.0, 4.9676, 12.941, 0.0];
    LinearPlant::new(&numerator, &denominator, ElevatorSign::NoseUpPositive).expect("proper")
}

fn pid(kp: f64, ki: f64, kd: f64) -> Controller {
    let config = PidConfig::sampled_every(0.01);
    Controller::Fixed(Pid::new(Gains { kp, ki, kd }, config).expect("allowed"))
}

fn scenario(plant: LinearPlant, controller: Controller, setpoint_rad: f64) -> Scenario {
    Scenario {
        name: "law".into(),
        plant: plant.into(),
        plant_changes: Vec::new(),
        actuator: Actuator::first_order(0.1).expect("allowed"),
        timing: Timing::new(0.01, 5.0).expect("allowed"),
        setpoint: Profile::new(setpoint_rad, STEP).expect("allowed"),
        disturbances: Vec::new(),
        controllers: vec![NamedController { name: "C".into(), controller }],
        externals: Vec::new(),
        surroundings: Surroundings::default(),
        autopilot: None,
    }
}

fn flown(scenario: &Scenario) -> Trace {
    simulate(scenario).expect("flies").traces.remove(0)
}

fn disturbance(entry: Entry, size_rad: f64, shape: Shape) -> Disturbance {
    Disturbance::new(entry, size_rad, shape).expect("allowed")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn a_linear_loop_answers_a_sum_by_the_sum_of_its_answers(
        kp in 0.1_f64..2.0, ki in 0.0_f64..0.3, kd in 0.0_f64..0.5,
        a in -1.0_f64..1.0, b in -1.0_f64..1.0,
    ) {
        let fly = |setpoint_rad: f64, gust_rad: f64| {
            let mut scenario = scenario(navion(1.0), pid(kp, ki, kd), setpoint_rad);
            let shape = Shape::Sine { at_s: 0.5, frequency_hz: 0.7 };
            scenario.disturbances = vec![disturbance(Entry::Elevator, gust_rad, shape)];
            flown(&scenario).theta_rad
        };
        let (first, second, both) = (fly(a, 0.0), fly(0.0, b), fly(a, b));
        for ((x, y), sum) in first.iter().zip(&second).zip(&both) {
            prop_assert!((x + y - sum).abs() < 1e-12, "{x} {y} {sum}");
        }
    }

    #[test]
    fn limits_of_the_servo_hold_at_every_sample(
        kp in 0.5_f64..20.0, limit in 0.05_f64..1.0, rate in 0.2_f64..5.0, lag in 0.0_f64..0.3,
    ) {
        let mut scenario = scenario(b747(), pid(kp, 0.1, 0.5), 1.0);
        scenario.actuator = Actuator::first_order(lag)
            .and_then(|servo| servo.with_position_limit(limit))
            .and_then(|servo| servo.with_rate_limit(rate))
            .expect("allowed");
        let trace = flown(&scenario);
        for pair in trace.elevator_rad.windows(2) {
            prop_assert!(pair[1].abs() <= limit * (1.0 + 1e-12), "{}", pair[1]);
            prop_assert!((pair[1] - pair[0]).abs() <= rate * 0.01 * (1.0 + 1e-9), "{pair:?}");
        }
    }
}

#[test]
fn a_positive_disturbance_at_servo_or_elevator_turns_the_nose_up_on_both_plants() {
    for plant in [b747(), navion(1.0)] {
        for entry in [Entry::Servo, Entry::Elevator] {
            let mut scenario = scenario(plant.clone(), pid(0.0, 0.0, 0.0), 0.0);
            scenario.disturbances = vec![disturbance(entry, 0.01, STEP)];
            let theta = flown(&scenario).theta_rad;
            assert!(theta[100] > 0.0, "{entry:?}");
        }
    }
}

#[test]
fn a_disturbance_of_the_measurement_is_not_in_the_pitch_of_the_trace() {
    let mut scenario = scenario(b747(), pid(1.0, 0.0, 0.0), 0.0);
    scenario.disturbances = vec![disturbance(Entry::Measurement, 0.1, STEP)];
    let trace = flown(&scenario);
    assert_eq!((trace.theta_rad[0], trace.command_rad[0]), (0.0, -0.1));
}

#[test]
fn a_delay_shifts_the_first_motion_by_its_samples() {
    let first_motion = |delay: usize| {
        let mut scenario = scenario(b747(), pid(1.0, 0.0, 0.0), 0.1);
        scenario.actuator =
            Actuator::first_order(0.1).and_then(|s| s.with_delay(delay)).expect("allowed");
        flown(&scenario).theta_rad.iter().position(|&theta| theta != 0.0)
    };
    assert_eq!(first_motion(0), Some(1));
    assert_eq!(first_motion(7), Some(8));
}

#[test]
fn an_ideal_servo_is_where_it_is_commanded() {
    let mut scenario = scenario(b747(), pid(1.0, 0.2, 0.3), 0.1);
    scenario.actuator = Actuator::ideal();
    let trace = flown(&scenario);
    for (command, elevator) in trace.command_rad.iter().zip(&trace.elevator_rad) {
        assert_eq!(-command, *elevator);
    }
}

#[test]
fn a_fast_servo_is_nearly_an_ideal_one() {
    let mut scenario = scenario(b747(), pid(1.0, 0.2, 0.3), 0.1);
    scenario.actuator = Actuator::ideal();
    let ideal = flown(&scenario).theta_rad;
    scenario.actuator = Actuator::first_order(1e-6).expect("allowed");
    for (a, b) in ideal.iter().zip(flown(&scenario).theta_rad) {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
}

#[test]
fn a_change_to_the_same_plant_changes_nothing() {
    let still = scenario(navion(1.0), pid(0.7, 0.07, 0.05), 1.0);
    let mut changing = still.clone();
    changing.plant_changes = vec![PlantChange::new(1.0, 2.0, navion(1.0)).expect("allowed")];
    for (a, b) in flown(&still).theta_rad.iter().zip(flown(&changing).theta_rad) {
        assert!((a - b).abs() < 1e-13, "{a} {b}");
    }
}

#[test]
fn pitch_and_pitch_rate_do_not_jump_when_the_plant_does() {
    let still = scenario(navion(1.0), pid(0.7, 0.07, 0.05), 1.0);
    let mut changing = still.clone();
    changing.plant_changes = vec![PlantChange::new(0.5, 0.0, navion(0.3)).expect("allowed")];
    let (before, after) = (flown(&still), flown(&changing));
    // The new plant holds from sample 50 on; what is measured there is what the old one left.
    assert!((before.theta_rad[50] - after.theta_rad[50]).abs() < 1e-13);
    assert!((before.q_rad_s[50] - after.q_rad_s[50]).abs() < 1e-13);
    assert!((before.q_rad_s[51] - after.q_rad_s[51]).abs() > 1e-4);
}

#[test]
fn a_ramp_of_the_plant_ends_where_a_jump_does() {
    let after = |ramp_s: f64| {
        let mut scenario = scenario(navion(1.0), pid(0.7, 0.0, 0.05), 0.0);
        scenario.plant_changes = vec![PlantChange::new(0.0, ramp_s, navion(0.5)).expect("allowed")];
        // Disturbed only when the ramp is over.
        let late = Shape::Step { at_s: 2.0 };
        scenario.disturbances = vec![disturbance(Entry::Elevator, 0.1, late)];
        flown(&scenario).theta_rad
    };
    assert_eq!(after(0.0), after(1.0));
    assert_ne!(after(0.0), after(3.0));
}

#[test]
fn a_plant_of_another_order_cannot_follow_in_flight() {
    let mut scenario = scenario(navion(1.0), pid(0.7, 0.0, 0.0), 1.0);
    scenario.plant_changes = vec![PlantChange::new(1.0, 0.0, b747()).expect("allowed")];
    let answer = simulate(&scenario);
    assert_eq!(answer, Err(SimError::OrderChanges { before: 3, after: 4 }));
}

#[test]
fn an_added_noise_leaves_the_first_as_it_was() {
    let noise = |seed| disturbance(Entry::Elevator, 0.1, Shape::Noise { at_s: 0.0, seed });
    let fly = |disturbances: Vec<Disturbance>| {
        let mut scenario = scenario(navion(1.0), pid(0.0, 0.0, 0.0), 0.0);
        scenario.disturbances = disturbances;
        flown(&scenario).theta_rad
    };
    // Of one seed, so that only the stream keeps them apart.
    let (both, first) = (fly(vec![noise(5), noise(5)]), fly(vec![noise(5)]));
    let differ = both.iter().zip(&first).any(|(a, b)| (a - 2.0 * b).abs() > 1e-6);
    assert!(differ, "the two noises are one");
    let silent = disturbance(Entry::Elevator, 0.0, Shape::Noise { at_s: 0.0, seed: 9 });
    assert_eq!(fly(vec![noise(5), silent]), first);
}

#[test]
fn the_same_scenario_gives_the_same_bits_beside_any_other_controller() {
    let alone = scenario(b747(), pid(2.0, 0.5, 1.0), 1.0);
    let mut beside = alone.clone();
    let other = NamedController { name: "D".into(), controller: pid(50.0, 0.0, 0.0) };
    beside.controllers.insert(0, other);
    let traces = simulate(&beside).expect("flies").traces;
    assert_eq!(traces[1], flown(&alone));
}

#[test]
fn a_first_order_plant_answers_as_its_formula() {
    // θ' = -2 θ + 3 δ with a constant ideal elevator: θ = 1.5 δ (1 - e^(-2 t)), q = 3 δ e^(-2 t).
    let plant = LinearPlant::new(&[3.0], &[1.0, 2.0], ElevatorSign::NoseUpPositive);
    let mut scenario = scenario(plant.expect("proper"), pid(0.0, 0.0, 0.0), 0.0);
    scenario.actuator = Actuator::ideal();
    scenario.disturbances = vec![disturbance(Entry::Servo, 0.2, STEP)];
    let trace = flown(&scenario);
    for (k, (theta, q)) in trace.theta_rad.iter().zip(&trace.q_rad_s).enumerate().skip(1) {
        let decay = libm::exp(-2.0 * k as f64 * 0.01);
        assert!((theta - 0.3 * (1.0 - decay)).abs() < 1e-13, "{k}: {theta}");
        assert!((q - 0.6 * decay).abs() < 1e-12, "{k}: {q}");
    }
}

#[test]
fn a_function_in_the_controllers_place_flies_as_the_controller_that_it_computes() {
    let scenario = scenario(b747(), pid(2.0, 0.0, 0.0), 0.1);
    let wanted = flown(&scenario).theta_rad;
    let prepared = scenario.prepare().expect("flies");
    let mut found = Vec::new();
    let outcome = fly_commanded(
        &prepared,
        |sample| 2.0 * (sample.setpoint_rad - sample.measurement_rad),
        |instant| {
            found.push(instant.theta_rad);
            ControlFlow::Continue(())
        },
    );
    assert_eq!(outcome, Ok(Outcome::Completed));
    assert_eq!(found, wanted);
}
