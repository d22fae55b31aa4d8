//! Margins by flying against those of the linear loop, and where there is no linear loop to ask.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use std::f64::consts::PI;
use std::ops::ControlFlow;

use fspid_aircraft::aerodynamics::derivatives::{DragLaw, ThrustLaw};
use fspid_aircraft::data::Laws;
use fspid_aircraft::{Aircraft, Environment, TrimTarget};
use fspid_core::fuzzy::{Defuzzifier, OutOfRange, RuleTable, Supervisor};
use fspid_core::{Fspid, Gains, InputScale, Pid, PidConfig, SelfTuner, TunerSettings};
use fspid_sim::aircraft::Forces;
use fspid_sim::describing::OpenLoop;
use fspid_sim::flown::empirical::{
    EmpiricalAnswer, EmpiricalMargins, EmpiricalOptions, empirical_margins,
};
use fspid_sim::flown::{Failure, Margin};
use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
use fspid_sim::stability::loop_spectral_radius;
use fspid_sim::{
    Actuator, AircraftPlant, Controller, EarlyEnd, ElevatorSign, EndCause, LinearPlant,
    NamedController, Outcome, Perturbation, Scenario, Surroundings, Timing, fly, fly_perturbed,
};

use crate::support;

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

fn plain() -> PidConfig<f64> {
    PidConfig::sampled_every(DT_S)
}

fn pid(kp: f64, ki: f64, kd: f64) -> Controller {
    Controller::Fixed(Pid::new(Gains { kp, ki, kd }, plain()).expect("allowed"))
}

fn scenario(plant: LinearPlant, controller: Controller, duration_s: f64) -> Scenario {
    Scenario {
        name: "margins".into(),
        plant: plant.into(),
        plant_changes: Vec::new(),
        actuator: Actuator::first_order(0.1).expect("allowed"),
        timing: Timing::new(DT_S, duration_s).expect("allowed"),
        setpoint: Profile::new(5.0 * DEG, Shape::Step { at_s: 0.0 }).expect("allowed"),
        disturbances: Vec::new(),
        controllers: vec![NamedController { name: "C".into(), controller }],
        externals: Vec::new(),
        surroundings: Surroundings::default(),
        autopilot: None,
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

/// A margin must lie between the border of stability and that of a loop whose oscillation shrinks by a
/// quarter in a third of the longest flight, as the criterion asks; the bracket is 0.5 % wide.
fn lies_between(margin: &Margin, stable: f64, damped: f64) {
    let Margin::Between { holds, fails, .. } = *margin else {
        panic!("{margin:?} is not {damped} to {stable}");
    };
    let (least, most) = (stable.min(damped), stable.max(damped));
    let found = (holds.min(fails), holds.max(fails));
    assert!(found.1 > 0.999 * least && found.0 < 1.001 * most, "{found:?}, not {least} to {most}");
    assert!((stable / damped - 1.0).abs() < 0.02, "{stable} {damped}");
}

const FLIGHT_S: f64 = 75.0;

/// Radius of a loop whose oscillation shrinks by a quarter in a third of four times 75 s.
fn damped_radius() -> f64 {
    libm::pow(0.75, DT_S / (4.0 * FLIGHT_S / 3.0))
}

#[test]
fn a_linear_loop_bears_the_gains_of_its_eigenvalues() {
    for (plant, gains) in [
        (b747(), Gains { kp: 2.0, ki: 0.3, kd: 0.4 }),
        (unstable(), Gains { kp: 4.0, ki: 0.2, kd: 0.5 }),
    ] {
        let controller = pid(gains.kp, gains.ki, gains.kd);
        let scenario = scenario(plant, controller, FLIGHT_S);
        let margins = margins(&scenario);
        let border = |bad: f64, largest: f64| {
            border(1.0, bad, |factor| radius(&scenario, gains, factor) < largest)
        };
        lies_between(&margins.gain_up, border(200.0, 1.0), border(200.0, damped_radius()));
        if radius(&scenario, gains, 1e-3) < 1.0 {
            // No border; without a loop the phugoid shrinks more slowly than the criterion asks.
            assert!(margins.gain_down.holds() < 0.01, "{:?}", margins.gain_down);
        } else {
            lies_between(&margins.gain_down, border(1e-3, 1.0), border(1e-3, damped_radius()));
        }
    }
}

#[test]
fn a_linear_loop_bears_the_delay_and_the_lag_of_its_phase_margin() {
    let gains = Gains { kp: 2.0, ki: 0.3, kd: 0.4 };
    let scenario = scenario(b747(), pid(gains.kp, gains.ki, gains.kd), FLIGHT_S);
    let margins = margins(&scenario);
    let open = OpenLoop::of(&scenario, &b747(), &plain(), gains).expect("a loop");
    let [at_rad_s] = open.gain_crossovers_rad_s().expect("found")[..] else {
        panic!("{:?}", open.gain_crossovers_rad_s());
    };
    // With one crossover an all-pass is at the border of stability where it takes all of the phase.
    let returned = open.at(at_rad_s).expect("no pole").returned;
    let lag_rad = PI + libm::atan2(returned.im, returned.re);
    let [phase] = margins.phase[..] else {
        panic!("{:?}", margins.phase);
    };
    assert_eq!(phase.at_rad_s, at_rad_s);
    lies_between(&phase.lag_rad, lag_rad, 0.985 * lag_rad);
    lies_between(&margins.delay_s, lag_rad / at_rad_s, 0.985 * lag_rad / at_rad_s);
    // Whole samples by the eigenvalues of the loop that has them.
    let most = |largest: f64| {
        let holds = |samples: &usize| {
            let servo = Actuator::first_order(0.1).and_then(|servo| servo.with_delay(*samples));
            let late = Scenario { actuator: servo.expect("allowed"), ..scenario.clone() };
            radius(&late, gains, 1.0) < largest
        };
        (0..500).take_while(holds).last().expect("stable at 0") as f64 * DT_S
    };
    let Margin::Between { holds, fails, .. } = margins.delay_s else {
        panic!("{:?}", margins.delay_s);
    };
    assert!(fails > most(damped_radius()) && holds < most(1.0) + DT_S, "{margins:?}");
}

fn table() -> RuleTable {
    let file = include_str!("../../../data/rule-tables/printed.toml");
    let parts: Vec<&str> = file.split("\"\"\"").collect();
    RuleTable::parse([parts[1], parts[3], parts[5]]).expect("a shipped table")
}

/// Gains that the rules move by `scale`.
fn self_tuning(scale: f64) -> Controller {
    let supervisor = Supervisor::new(&table(), 5.0, Defuzzifier::Exact, OutOfRange::Clamp);
    let settings = TunerSettings {
        input_scale: InputScale { error_per_rad: 180.0 / PI, change_per_rad: 60.0 / PI },
        output_scale: Gains { kp: 0.1 * scale, ki: 0.02 * scale, kd: 0.05 * scale },
        ..TunerSettings::literal()
    };
    let nominal = Gains { kp: 1.5, ki: 0.3, kd: 0.5 };
    let tuner = SelfTuner::new(nominal, supervisor.expect("allowed"), settings);
    Controller::SelfTuning(Fspid::new(tuner.expect("allowed"), plain()).expect("allowed"))
}

#[test]
fn a_self_tuner_that_moves_nothing_bears_what_its_fixed_gains_bear() {
    let fixed = margins(&scenario(b747(), pid(1.5, 0.3, 0.5), 20.0));
    let tuned = margins(&scenario(b747(), self_tuning(0.0), 20.0));
    assert_eq!(fixed, tuned);
}

#[test]
fn a_self_tuner_bears_something_else_than_its_gains_at_rest() {
    let fixed = margins(&scenario(b747(), pid(1.5, 0.3, 0.5), 20.0));
    let tuned = margins(&scenario(b747(), self_tuning(1.0), 20.0));
    let ratio = tuned.delay_s.holds() / fixed.delay_s.holds();
    assert!((ratio - 1.0).abs() > 0.02, "{ratio}");
    assert!(tuned.flights > 40 && tuned.flights < 250, "{}", tuned.flights);
}

#[test]
fn a_nonlinear_aircraft_bears_about_what_its_linear_model_bears() {
    let data = support::derivative_data("navion");
    let laws = Laws { drag: DragLaw::Polar, thrust: ThrustLaw::Constant };
    let forces = Forces::from(data.force_model(laws));
    let aircraft = Aircraft::new(data.mass_properties(), forces, Environment::STANDARD);
    let target = TrimTarget { airspeed_m_s: 53.6, altitude_m: 500.0, flight_path_rad: 0.0 };
    let plant = AircraftPlant::trimmed(aircraft.expect("a body"), target).expect("flies");
    let linear = plant.linear().expect("a model");
    let mut flight = scenario(linear, pid(0.8, 0.2, 0.1), 10.0);
    flight.setpoint = Profile::new(0.5 * DEG, Shape::Step { at_s: 0.0 }).expect("allowed");
    let expected = margins(&flight);
    flight.plant = plant.into();
    let found = margins(&flight);
    for (found, expected) in [(found.delay_s, expected.delay_s), (found.gain_up, expected.gain_up)]
    {
        let ratio = found.holds() / expected.holds();
        assert!((ratio - 1.0).abs() < 0.05, "{found:?} {expected:?}");
    }
    assert_eq!(found.phase.len(), expected.phase.len());
}

#[test]
fn a_flight_that_does_not_hold_has_no_margins() {
    let grows = answer(&scenario(b747(), pid(6.0, 0.0, 0.0), 20.0));
    assert!(
        matches!(grows, EmpiricalAnswer::NominalFails { failure: Failure::Swings { .. }, .. }),
        "{grows:?}"
    );
    let diverges = answer(&scenario(unstable(), pid(0.0, 0.0, 0.0), 60.0));
    // Without a command the set-point is an error that stands still.
    assert!(matches!(diverges, EmpiricalAnswer::Margins(_)), "{diverges:?}");
    let diverges = answer(&scenario(unstable(), pid(0.05, 0.0, 0.0), 60.0));
    assert!(
        matches!(
            diverges,
            EmpiricalAnswer::NominalFails {
                failure: Failure::EndedEarly(EarlyEnd { cause: EndCause::Diverged, .. }),
                ..
            }
        ),
        "{diverges:?}"
    );
}

/// Unstable in the small, held by a limit in the large: the oscillation lasts.
#[test]
fn an_oscillation_that_lasts_is_a_failure() {
    let mut lasting = scenario(b747(), pid(5.2, 0.0, 0.0), 60.0);
    let limited =
        Actuator::first_order(0.1).and_then(|servo| servo.with_position_limit(10.0 * DEG));
    lasting.actuator = limited.expect("allowed");
    let answer = answer(&lasting);
    assert!(
        matches!(answer, EmpiricalAnswer::NominalFails { failure: Failure::Oscillates { .. }, .. }),
        "{answer:?}"
    );
}

#[test]
fn a_flight_without_any_error_shows_nothing() {
    let mut still = scenario(b747(), pid(1.0, 0.0, 0.0), 5.0);
    still.setpoint = Profile::new(0.0, Shape::Step { at_s: 0.0 }).expect("allowed");
    assert_eq!(answer(&still), EmpiricalAnswer::NothingMoves);
}

#[test]
fn a_flight_in_noise_is_held_to_twice_its_own_swing() {
    let mut noisy = scenario(b747(), pid(1.5, 0.3, 0.5), 60.0);
    let noise = Shape::Noise { at_s: 0.0, seed: 3 };
    noisy.disturbances =
        vec![Disturbance::new(Entry::Elevator, 0.2 * DEG, noise).expect("allowed")];
    let margins = margins(&noisy);
    assert!(!margins.quiet && margins.floor_rad > 2.0 * margins.nominal.swings_rad[1] * 0.999);
    let quiet = self::margins(&scenario(b747(), pid(1.5, 0.3, 0.5), 60.0));
    assert!(quiet.quiet);
    let ratio = margins.delay_s.holds() / quiet.delay_s.holds();
    assert!((ratio - 1.0).abs() < 0.1, "{margins:?} {quiet:?}");
}

#[test]
fn a_loop_with_a_rate_limit_bears_its_linear_margin_from_a_small_step_and_less_from_a_large_one() {
    let delay_s = |step_rad: f64| {
        let mut flight = scenario(b747(), pid(1.5, 0.3, 0.5), 60.0);
        let limited =
            Actuator::first_order(0.1).and_then(|servo| servo.with_rate_limit(20.0 * DEG));
        flight.actuator = limited.expect("allowed");
        flight.setpoint =
            Profile::new(step_rad, Shape::Ramp { at_s: 0.0, width_s: 1.0 }).expect("allowed");
        margins(&flight).delay_s
    };
    let free = margins(&scenario(b747(), pid(1.5, 0.3, 0.5), 60.0)).delay_s;
    let (small, large) = (delay_s(0.1 * DEG), delay_s(15.0 * DEG));
    assert!((small.holds() / free.holds() - 1.0).abs() < 0.02, "{small:?} {free:?}");
    assert!(large.holds() < 0.9 * small.holds(), "{small:?} {large:?}");
}

#[test]
fn an_unperturbed_flight_is_the_flight_bit_for_bit() {
    let flight = scenario(b747(), self_tuning(1.0), 20.0);
    let (prepared, controller) =
        (flight.prepare().expect("flies"), flight.controllers[0].controller);
    let mut bits = Vec::new();
    let outcome = fly(&prepared, &controller, |instant| {
        bits.push(instant.theta_rad.to_bits());
        ControlFlow::Continue(())
    });
    assert_eq!(outcome, Ok(Outcome::Completed));
    let mut at = 0;
    let perturbed = fly_perturbed(&prepared, &controller, &Perturbation::NONE, |instant| {
        assert_eq!(instant.theta_rad.to_bits(), bits[at]);
        at += 1;
        ControlFlow::Continue(())
    });
    assert_eq!((perturbed, at), (Ok(Outcome::Completed), bits.len()));
}

#[test]
fn options_that_make_no_sense_are_refused() {
    let flight = scenario(b747(), pid(1.0, 0.0, 0.0), 5.0);
    let controller = flight.controllers[0].controller;
    let good = EmpiricalOptions::default();
    for options in [
        EmpiricalOptions { tolerance: 0.0, ..good.clone() },
        EmpiricalOptions { tolerance: f64::NAN, ..good.clone() },
        EmpiricalOptions { duration_s: Some(-1.0), ..good.clone() },
        EmpiricalOptions { patience: 0.5, ..good.clone() },
        EmpiricalOptions { crossovers_rad_s: Some(vec![400.0]), ..good },
    ] {
        assert!(empirical_margins(&flight, &controller, &options).is_err(), "{options:?}");
    }
}
