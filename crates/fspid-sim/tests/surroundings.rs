//! Flights in moving air, behind actuators with limits, through sensors.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use std::ops::ControlFlow;

use fspid_core::{Gains, Pid, PidConfig};
use fspid_sim::actuator::{Actuator, Lag};
use fspid_sim::air::{Follows, Intensity, Severity, Specification, Turbulence, WindKind};
use fspid_sim::sensor::{PITCH, RATE, Sensor, SensorModel, SensorPreset};
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::stability::{instability, loop_poles, loop_spectral_radius};
use fspid_sim::{
    Controller, Course, ElevatorSign, LinearPlant, LongitudinalDerivatives, NamedController,
    PlantChange, Scenario, SimError, Surroundings, Timing, Trace, Weather, fly, simulate,
};
use proptest::prelude::*;

const DT_S: f64 = 0.01;
const FOOT_M: f64 = 0.3048;
const STEP: Shape = Shape::Step { at_s: 0.0 };

/// Nelson's rounded derivatives of the Navion, ft and s.
const NAVION: LongitudinalDerivatives = LongitudinalDerivatives {
    u0: 176.0,
    gravity: 32.2,
    x: [-0.045, 0.036, 0.0],
    z: [-0.369, -2.02, 0.0, 0.0, -28.15],
    m: [0.0, -0.05, -0.0051, -2.05, -11.874],
};

fn navion() -> LinearPlant {
    NAVION.plant(FOOT_M).expect("allowed")
}

fn pid(kp: f64, ki: f64, kd: f64) -> Controller {
    let config = PidConfig::sampled_every(DT_S);
    Controller::Fixed(Pid::new(Gains { kp, ki, kd }, config).expect("allowed"))
}

fn scenario(plant: LinearPlant, controller: Controller, setpoint_rad: f64) -> Scenario {
    Scenario {
        name: "surroundings".into(),
        plant: plant.into(),
        plant_changes: Vec::new(),
        actuator: Actuator::first_order(0.1).expect("allowed"),
        timing: Timing::new(DT_S, 10.0).expect("allowed"),
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

fn course() -> Course {
    let airspeed_m_s = 176.0 * FOOT_M;
    Course {
        airspeed_m_s,
        height_m: 150.0,
        climb_rad: 0.0,
        axes_rad: 0.0,
        heading_rad: 0.0,
        start_m: [0.0; 2],
    }
}

fn weather(kind: WindKind, params: &[f64]) -> Weather {
    let wind = kind.build(params).expect("allowed");
    Weather { course: course(), winds: vec![wind], turbulence: None }
}

fn turbulence(w20_m_s: f64) -> Weather {
    let turbulence = Turbulence {
        specification: Specification::MilF8785c,
        intensity: Intensity::new(w20_m_s, Severity::Light).expect("allowed"),
        height_m: 150.0,
        airspeed_m_s: 176.0 * FOOT_M,
        wing_span_m: 33.4 * FOOT_M,
        noise: 9.into(),
        follows: Follows::Start,
        driven_until_s: f64::INFINITY,
    };
    Weather { course: course(), winds: Vec::new(), turbulence: Some(turbulence) }
}

fn apart(first: &[f64], second: &[f64]) -> f64 {
    assert_eq!(first.len(), second.len());
    first.iter().zip(second).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The same actuator with stops that are never reached: it is followed leg by leg.
fn by_legs(servo: Actuator) -> Actuator {
    servo.with_travel(-1e3, 1e3).expect("allowed")
}

#[test]
fn a_servo_by_legs_flies_as_it_does_as_one_with_its_plant() {
    let plain = Actuator::first_order(0.1).expect("allowed");
    let limited = plain
        .with_position_limit(0.2)
        .and_then(|servo| servo.with_rate_limit(0.6))
        .and_then(|servo| servo.with_delay(3))
        .expect("allowed");
    for servo in [plain, limited, Actuator::ideal()] {
        let mut flight = scenario(navion(), pid(1.0, 0.3, 0.2), 0.3);
        flight.actuator = servo;
        let as_one = flown(&flight);
        flight.actuator = by_legs(servo);
        let by_legs = flown(&flight);
        assert!(apart(&as_one.theta_rad, &by_legs.theta_rad) < 1e-12, "{servo:?}");
        assert!(apart(&as_one.q_rad_s, &by_legs.q_rad_s) < 1e-11, "{servo:?}");
        assert!(apart(&as_one.elevator_rad, &by_legs.elevator_rad) < 1e-11, "{servo:?}");
    }
}

#[test]
fn air_that_does_not_change_along_the_way_leaves_the_flight_as_it_is() {
    let mut flight = scenario(navion(), pid(1.0, 0.3, 0.2), 0.3);
    let calm = flown(&flight);
    flight.surroundings.weather = Some(weather(WindKind::Steady, &[-12.0, 4.0, 1.0]));
    let windy = flown(&flight);
    assert!(apart(&calm.theta_rad, &windy.theta_rad) < 1e-12);
}

/// θ = N/(s² + 3 s + 2) w_g with a step in the middle of a sample: 1/2 - e^-t + e^-2t/2. It used to come with the next one.
#[test]
fn a_step_of_the_air_is_answered_exactly_at_every_sample() {
    let plant = LinearPlant::new(&[1.0], &[1.0, 3.0, 2.0], ElevatorSign::NoseUpPositive)
        .and_then(|plant| plant.with_gusts([&[], &[0.5], &[]]))
        .expect("allowed");
    let mut flight = scenario(plant, pid(0.0, 0.0, 0.0), 0.0);
    let start_m = course().airspeed_m_s * (1.0 - 0.5 * DT_S);
    let gust = [0.0, 0.0, 4.0, 1e-6, start_m];
    flight.surroundings.weather = Some(weather(WindKind::RampHold, &gust));
    for (k, theta) in flown(&flight).theta_rad.into_iter().enumerate() {
        // A ramp of a micrometre is a step in its middle, up to the square of 10⁻⁸ s.
        let t = (k as f64 * DT_S - (start_m + 5e-7) / course().airspeed_m_s).max(0.0);
        let expected = 2.0 * (0.5 - libm::exp(-t) + 0.5 * libm::exp(-2.0 * t));
        assert!((theta - expected).abs() < 1e-13, "{k} {theta} {expected}");
    }
}

/// The four equations of motion in the gust of each instant, by the midpoint rule in steps of 0.1 ms. The gust used to be
/// held over a sample.
#[test]
fn a_gust_moves_the_plant_as_its_four_equations_of_motion_say() {
    let mut flight = scenario(navion(), pid(0.0, 0.0, 0.0), 0.0);
    flight.timing = Timing::new(DT_S, 4.0).expect("allowed");
    let gust = [2.0, 0.0, -3.0, 20.0, 10.0];
    flight.surroundings.weather = Some(weather(WindKind::FullCycle, &gust));
    let wind = WindKind::FullCycle.build(&gust).expect("allowed");
    let trace = flown(&flight);
    let model = NAVION.model().expect("allowed");
    let (mut x, steps) = ([0.0_f64; 4], 100);
    let mut most: f64 = 0.0;
    for (k, theta) in trace.theta_rad.iter().enumerate() {
        assert!((x[3] - theta).abs() < 1e-8, "{} {theta}", x[3]);
        most = most.max(theta.abs());
        for step in 0..steps {
            let step_s = DT_S / f64::from(steps);
            let time_s = k as f64 * DT_S + (f64::from(step) + 0.5) * step_s;
            let air = wind.at(&course().place(time_s));
            let [forward, _, down] = air.body_m_s.map(|speed| speed / FOOT_M);
            let inputs = [0.0, forward, down, air.body_rad_s[1]];
            let moved = |x: &[f64; 4], by: &[f64; 4], time_s: f64| -> [f64; 4] {
                std::array::from_fn(|row| {
                    let by_state: f64 = model.a[row].iter().zip(by).map(|(a, x)| a * x).sum();
                    let by_air: f64 = model.b[row].iter().zip(inputs).map(|(b, u)| b * u).sum();
                    x[row] + time_s * (by_state + by_air)
                })
            };
            let middle = moved(&x, &x, 0.5 * step_s);
            x = moved(&x, &middle, step_s);
        }
    }
    assert!(most > 0.01, "{most}");
}

/// As the edge passes from nose to tail it turns the nose up; a gust that was held over samples lost this where it was
/// shorter than one.
#[test]
fn an_updraught_turns_the_nose_down_into_the_wind() {
    let mut flight = scenario(navion(), pid(0.0, 0.0, 0.0), 0.0);
    flight.surroundings.weather = Some(weather(WindKind::RampHold, &[0.0, 0.0, -3.0, 1.0, 0.0]));
    let theta_rad = flown(&flight).theta_rad;
    assert!(theta_rad[10] > 0.0 && theta_rad[60] < -0.005);
}

#[test]
fn twice_the_turbulence_moves_a_linear_loop_twice_as_much() {
    let theta = |w20_m_s: f64| {
        let mut flight = scenario(navion(), pid(1.0, 0.3, 0.2), 0.0);
        flight.surroundings.weather = Some(turbulence(w20_m_s));
        flown(&flight).theta_rad
    };
    let (once, twice) = (theta(5.0), theta(10.0));
    let doubled: Vec<f64> = once.iter().map(|theta| 2.0 * theta).collect();
    assert!(apart(&doubled, &twice) < 1e-13);
    assert!(once.iter().any(|theta| theta.abs() > 1e-4));
}

#[test]
fn air_that_moves_around_a_plant_without_a_gust_entry_is_refused() {
    let deaf = LinearPlant::new(&[1.0], &[1.0, 3.0, 2.0], ElevatorSign::NoseUpPositive);
    let mut flight = scenario(navion(), pid(1.0, 0.0, 0.0), 0.1);
    flight.surroundings.weather = Some(turbulence(5.0));
    assert!(flight.prepare().is_ok());
    flight.plant = deaf.expect("proper").into();
    assert!(matches!(flight.prepare(), Err(SimError::NoGustEntry)));
}

#[test]
fn a_plant_that_changes_in_flight_changes_how_it_feels_gusts() {
    let weaker = LongitudinalDerivatives { m: [0.0, -0.03, -0.0051, -1.6, -11.874], ..NAVION };
    let weaker = weaker.plant(FOOT_M).expect("allowed");
    let mut changing = scenario(navion(), pid(0.0, 0.0, 0.0), 0.0);
    changing.plant_changes = vec![PlantChange::new(0.0, 0.0, weaker.clone()).expect("allowed")];
    let mut other = scenario(weaker, pid(0.0, 0.0, 0.0), 0.0);
    for flight in [&mut changing, &mut other] {
        flight.surroundings.weather = Some(turbulence(5.0));
    }
    assert_eq!(flown(&changing).theta_rad, flown(&other).theta_rad);
}

/// A loop around an actuator of second order: the spectral radius tells what the flight does.
#[test]
fn a_slow_second_order_actuator_makes_a_stable_loop_unstable() {
    let actuator = |natural_frequency_rad_s| {
        Actuator::new(Lag::second_order(natural_frequency_rad_s, 0.7).expect("allowed"))
    };
    for (natural_frequency_rad_s, stable) in [(50.0, true), (3.0, false)] {
        let mut flight = scenario(navion(), pid(2.0, 0.1, 0.0), 0.01);
        flight.timing = Timing::new(DT_S, 60.0).expect("allowed");
        flight.actuator = actuator(natural_frequency_rad_s);
        let verdict = instability(&flight, &flight.controllers[0].controller).expect("found");
        assert_eq!(verdict.is_none(), stable, "{verdict:?}");
        let theta_rad = flown(&flight).theta_rad;
        let largest = theta_rad.iter().rev().take(1000).map(|x| x.abs()).fold(0.0, f64::max);
        assert_eq!(largest < 0.1, stable, "{largest}");
    }
}

#[test]
fn a_servo_by_legs_has_the_spectral_radius_that_it_has_as_one_with_its_plant() {
    let mut flight = scenario(navion(), pid(1.0, 0.2, 0.3), 0.1);
    let (gains, config) = (Gains { kp: 1.0, ki: 0.2, kd: 0.3 }, PidConfig::sampled_every(DT_S));
    for servo in [Actuator::ideal(), Actuator::first_order(0.1).expect("allowed")] {
        flight.actuator = servo;
        let as_one = loop_spectral_radius(&flight, gains, &config).expect("found");
        flight.actuator = by_legs(servo);
        let by_legs = loop_spectral_radius(&flight, gains, &config).expect("found");
        assert!((as_one - by_legs).abs() < 1e-12, "{as_one} {by_legs}");
    }
}

/// It was the radius of the loop without that sensor.
#[test]
fn no_one_radius_and_no_poles_are_told_of_a_sensor_with_a_clock_of_its_own() {
    let mut flight = scenario(navion(), pid(1.0, 0.2, 0.3), 0.1);
    let (gains, config) = (Gains { kp: 1.0, ki: 0.2, kd: 0.3 }, PidConfig::sampled_every(DT_S));
    for (period_s, is_told) in [(0.0, true), (0.005, true), (0.024, false)] {
        let model = SensorModel { period_s, delay_s: 0.03, ..SensorModel::default() };
        flight.surroundings.pitch_sensor = Some(Sensor::new(model, 0, PITCH).expect("allowed"));
        let radius = loop_spectral_radius(&flight, gains, &config);
        let poles = loop_poles(&flight, gains, &config);
        assert_eq!((radius.is_ok(), poles.is_ok()), (is_told, is_told), "{period_s} {radius:?}");
        if let Err(error) = radius {
            assert!(error.to_string().contains("a sensor has a clock of its own"), "{error}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(30))]

    #[test]
    fn limits_of_an_actuator_hold_at_every_sample_of_a_loop(
        kp in 0.5_f64..10.0, order in 0_usize..=2, least in -0.5_f64..-0.05, most in 0.05_f64..0.5,
        rate in 0.2_f64..3.0, play in 0.0_f64..0.05, w20_m_s in 0.0_f64..20.0,
    ) {
        let lag = match order {
            0 => Lag::NONE,
            1 => Lag::first_order(0.05).expect("allowed"),
            _ => Lag::second_order(30.0, 0.6).expect("allowed"),
        };
        let actuator = Actuator::new(lag)
            .with_travel(least, most)
            .and_then(|actuator| actuator.with_rate_limit(rate))
            .and_then(|actuator| actuator.with_play(play))
            .expect("allowed");
        let mut flight = scenario(navion(), pid(kp, 0.1, 0.2), 0.5);
        flight.actuator = actuator;
        flight.surroundings.weather = Some(turbulence(w20_m_s));
        // Trailing edge down positive: the other way round than the command.
        let trace = flown(&flight);
        for pair in trace.elevator_rad.windows(2) {
            prop_assert!((least..=most).contains(&-pair[1]), "{}", pair[1]);
            prop_assert!((pair[1] - pair[0]).abs() <= rate * DT_S * (1.0 + 1e-8), "{pair:?}");
        }
    }
}

#[test]
fn an_ideal_sensor_leaves_every_bit_and_a_delayed_one_does_not() {
    let mut flight = scenario(navion(), pid(1.0, 0.3, 0.2), 0.3);
    let bare = flown(&flight);
    let with = |model| Some(Sensor::new(model, 1, PITCH).expect("allowed"));
    flight.surroundings.pitch_sensor = with(SensorModel::default());
    flight.surroundings.rate_sensor = with(SensorModel::default());
    let ideal = flown(&flight);
    assert_eq!(ideal.column("measured_theta_rad"), Some(&bare.theta_rad[..]));
    assert_eq!(Trace { columns: Vec::new(), ..ideal }, bare);
    flight.surroundings.pitch_sensor =
        with(SensorModel { delay_s: 0.05, ..SensorModel::default() });
    let delayed = flown(&flight);
    assert_eq!(delayed.command_rad[0], bare.command_rad[0]);
    assert!(apart(&delayed.theta_rad, &bare.theta_rad) > 1e-3);
}

/// Whole samples of delay in the sensor or in the servo: the same loop, a P controller.
#[test]
fn a_sensors_delay_is_worth_as_much_as_the_servos() {
    let mut by_servo = scenario(navion(), pid(1.0, 0.0, 0.0), 0.1);
    let mut by_sensor = by_servo.clone();
    by_servo.actuator = by_servo.actuator.with_delay(4).expect("allowed");
    let model = SensorModel { delay_s: 4.0 * DT_S, ..SensorModel::default() };
    by_sensor.surroundings.pitch_sensor = Some(Sensor::new(model, 1, PITCH).expect("allowed"));
    // The set-point is not delayed by a sensor; let both begin as late.
    by_sensor.setpoint = Profile::new(0.1, Shape::Step { at_s: 4.0 * DT_S }).expect("allowed");
    let (servo, sensor) = (flown(&by_servo), flown(&by_sensor));
    assert!(apart(&servo.theta_rad, &sensor.theta_rad) < 1e-12);
}

fn everything() -> Scenario {
    let mut flight = scenario(navion(), pid(1.0, 0.3, 0.2), 0.1);
    let actuator = Actuator::new(Lag::second_order(35.0, 0.7).expect("allowed"))
        .with_travel(-0.3, 0.4)
        .and_then(|actuator| actuator.with_rate_limit(0.5))
        .and_then(|actuator| actuator.with_play(0.002))
        .expect("allowed");
    let mems = SensorPreset::from_name("mems").expect("there");
    flight.actuator = actuator;
    flight.surroundings = Surroundings {
        weather: Some(turbulence(8.0)),
        pitch_sensor: Some(Sensor::new(mems.pitch, 3, PITCH).expect("allowed")),
        rate_sensor: Some(Sensor::new(mems.rate, 3, RATE).expect("allowed")),
    };
    flight
}

#[test]
fn a_flight_with_everything_has_the_same_bits_twice() {
    assert_eq!(flown(&everything()), flown(&everything()));
}

#[test]
fn a_flight_with_everything_allocates_no_more_when_it_is_longer() {
    let allocations = |duration_s: f64| {
        let mut flight = everything();
        flight.timing = Timing::new(DT_S, duration_s).expect("allowed");
        let prepared = flight.prepare().expect("prepares");
        let counted = allocation_counter::measure(|| {
            fly(&prepared, &flight.controllers[0].controller, |_| ControlFlow::Continue(()))
                .expect("flies");
        });
        counted.count_total
    };
    assert_eq!(allocations(1.0), allocations(20.0));
}
