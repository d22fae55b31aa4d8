//! Margins by flying against those of the linear loop, and where there is no linear loop to ask.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use fspid_core::fuzzy::{Defuzzifier, OutOfRange, RuleTable, Supervisor};
use fspid_core::{
    AntiWindup, Fspid, Gains, InputScale, Limits, Pid, SelfTuner, Shell, TunerSettings,
};
use fspid_sim::describing::OpenLoop;
use fspid_sim::flown::empirical::{
    EmpiricalAnswer, EmpiricalMargins, EmpiricalOptions, empirical_margins,
};
use fspid_sim::flown::{Failure, Margin};
use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
use fspid_sim::stability::loop_spectral_radius;
use fspid_sim::{
    Controller, ElevatorSign, LinearPlant, NamedController, Outcome, Perturbation, Scenario, Servo,
    Surroundings, Timing, fly, fly_perturbed,
};

const DT_S: f64 = 0.01;
const DEG: f64 = PI / 180.0;

fn b747() -> LinearPlant {
    LinearPlant::new(
        &[-1.69144, -0.84341, -0.009_909_6],
        &[1.0, 1.17103, 1.55405, 0.012_538, 0.007_277_1],
        ElevatorSign::NoseDownPositive,
    )
    .expect("the paper's plant")
}

/// Unstable without a controller, with a pole at 0.5 1/s, so that there is a least gain as well.
fn unstable() -> LinearPlant {
    LinearPlant::new(&[2.0, 1.0], &[1.0, 2.5, -1.5, 0.0], ElevatorSign::NoseUpPositive)
        .expect("allowed")
}

fn plain() -> Shell<f64> {
    Shell::sampled_every(DT_S)
}

fn pid(kp: f64, ki: f64, kd: f64) -> Controller {
    Controller::Fixed(Pid::new(Gains { kp, ki, kd }, plain()).expect("allowed"))
}

fn scenario(plant: LinearPlant, controller: Controller, duration_s: f64) -> Scenario {
    Scenario {
        name: "margins".into(),
        plant: plant.into(),
        plant_changes: Vec::new(),
        servo: Servo::first_order(0.1).expect("allowed"),
        timing: Timing::new(DT_S, duration_s).expect("allowed"),
        setpoint: Profile::new(5.0 * DEG, Shape::Step { at_s: 0.0 }).expect("allowed"),
        disturbances: Vec::new(),
        controllers: vec![NamedController { name: "C".into(), controller }],
        surroundings: Surroundings::default(),
    }
}

fn answer(scenario: &Scenario) -> EmpiricalAnswer {
    let controller = scenario.controllers[0].controller;
    empirical_margins(scenario, &controller, &EmpiricalOptions::default()).expect("flies")
}

fn margins(scenario: &Scenario) -> EmpiricalMargins {
    match answer(scenario) {
        EmpiricalAnswer::Margins(margins) => *margins,
        other => panic!("{other:?}"),
    }
}

/// The border of a property that holds at `good` and not at `bad`.
fn border(mut good: f64, mut bad: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (good + bad);
        *(if holds(middle) { &mut good } else { &mut bad }) = middle;
    }
    0.5 * (good + bad)
}

/// Radius of the linear loop with its command multiplied.
fn radius(scenario: &Scenario, gains: Gains<f64>, factor: f64) -> f64 {
    let gains = Gains { kp: factor * gains.kp, ki: factor * gains.ki, kd: factor * gains.kd };
    loop_spectral_radius(scenario, gains, &plain()).expect("found")
}

fn lies_within(margin: &Margin, expected: f64, relative: f64) {
    let Margin::Between { holds, fails, .. } = *margin else {
        panic!("{margin:?} is not {expected}");
    };
    let (least, most) = (holds.min(fails), holds.max(fails));
    let slack = relative * expected;
    assert!(least - slack <= expected && expected <= most + slack, "{margin:?} is not {expected}");
}

const FLIGHT_S: f64 = 300.0;
/// A flight of 300 s counts a decay of less than 0.5 % in 100 s as lasting: 5e-5 1/s from the border,
/// which moves the gain by less than this.
const FLIGHT_TOLERANCE: f64 = 1e-3;

#[test]
fn a_linear_loop_bears_the_gains_of_its_eigenvalues() {
    for (plant, gains) in [
        (b747(), Gains { kp: 2.0, ki: 0.3, kd: 0.4 }),
        (unstable(), Gains { kp: 4.0, ki: 0.2, kd: 0.5 }),
    ] {
        let controller = pid(gains.kp, gains.ki, gains.kd);
        let scenario = scenario(plant, controller, FLIGHT_S);
        let margins = margins(&scenario);
        let stable = |factor: f64| radius(&scenario, gains, factor) < 1.0;
        lies_within(&margins.gain_up, border(1.0, 60.0, stable), FLIGHT_TOLERANCE);
        if stable(1e-3) {
            // Slower than a flight can see: not told apart from what lasts.
            assert!(margins.gain_down.holds() < 0.05, "{:?}", margins.gain_down);
        } else {
            lies_within(&margins.gain_down, border(1.0, 1e-3, stable), FLIGHT_TOLERANCE);
        }
    }
}

#[test]
fn a_linear_loop_bears_the_delay_and_the_lag_of_its_phase_margin() {
    let gains = Gains { kp: 2.0, ki: 0.3, kd: 0.4 };
    let scenario = scenario(b747(), pid(gains.kp, gains.ki, gains.kd), FLIGHT_S);
    let margins = margins(&scenario);
    let open = OpenLoop::of(&scenario, &b747(), &plain(), gains).expect("a loop");
    let lags: Vec<(f64, f64)> = open
        .gain_crossovers_rad_s()
        .into_iter()
        .map(|at_rad_s| {
            let returned = open.at(at_rad_s).expect("no pole").returned;
            (at_rad_s, (PI + libm::atan2(returned.im, returned.re)).rem_euclid(2.0 * PI))
        })
        .collect();
    println!("{lags:?}\n{margins:?}");
    assert_eq!(margins.phase.len(), lags.len());
    // The lag at the highest crossover, which is the smallest there.
    let (at_rad_s, lag_rad) = *lags.last().expect("a crossover");
    let phase = margins.phase.last().expect("a crossover");
    assert!((phase.at_rad_s - at_rad_s).abs() < 1e-12);
    lies_within(&phase.lag_rad, lag_rad, FLIGHT_TOLERANCE);
    let delay_s = lags.iter().map(|(at, lag)| lag / at).fold(f64::INFINITY, f64::min);
    lies_within(&margins.delay_s, delay_s, FLIGHT_TOLERANCE);
    // Whole samples by the eigenvalues of the loop that has them.
    let stable = |samples: usize| {
        let servo = Servo::first_order(0.1).and_then(|servo| servo.with_delay(samples));
        let late = Scenario { servo: servo.expect("allowed"), ..scenario.clone() };
        radius(&late, gains, 1.0) < 1.0
    };
    let most = (0..500).take_while(|samples| stable(*samples)).last().expect("stable at 0");
    let Margin::Between { holds, fails, .. } = margins.delay_s else {
        panic!("{:?}", margins.delay_s);
    };
    assert!(fails > most as f64 * DT_S && holds < (most + 1) as f64 * DT_S, "{most} {margins:?}");
}
