//! What moves a flight of 2 s and 201 samples after its end, and what changes in its last fifth, which begins at 1.61 s.

use super::*;
use crate::air::{Follows, FullCycle, Severity, Specification, Steady, Turbulence, Wind};
use crate::plant::{ElevatorSign, LinearPlant, PlantChange};
use crate::sensor::{Sensor, SensorModel};
use crate::signal::{Profile, Shape};
use crate::surroundings::{Course, Weather};

const STEP: Shape = Shape::Step { at_s: 0.0 };

fn plant() -> LinearPlant {
    LinearPlant::new(&[1.0], &[1.0, 1.0], ElevatorSign::NoseUpPositive).expect("proper")
}

fn scenario(setpoint: Profile) -> Scenario {
    Scenario::new("moved", plant(), Timing::new(0.01, 2.0).expect("allowed"), setpoint)
}

fn commanded(amplitude_rad: f64, shape: Shape) -> Scenario {
    scenario(Profile::new(amplitude_rad, shape).expect("allowed"))
}

fn disturbed(amplitude_rad: f64, shape: Shape) -> Scenario {
    let disturbance = Disturbance::new(Entry::Servo, amplitude_rad, shape).expect("allowed");
    Scenario { disturbances: vec![disturbance], ..commanded(0.1, STEP) }
}

fn seen(model: SensorModel) -> Scenario {
    let mut own = commanded(0.1, STEP);
    own.surroundings.pitch_sensor = Some(Sensor::new(model, 1, 0).expect("allowed"));
    own
}

fn noise(at_s: f64) -> Shape {
    Shape::Noise { at_s, seed: 1 }
}

fn sine(at_s: f64) -> Shape {
    Shape::Sine { at_s, frequency_hz: 0.7 }
}

/// By what moves it with noise and swings, with swings, and with neither.
fn moved(scenario: &Scenario) -> [Moved; 3] {
    [Afterwards::Noise, Afterwards::Swings, Afterwards::Quiet].map(|it| Moved::of(scenario, it))
}

#[test]
fn a_flight_is_moved_by_what_has_a_size_and_begins_within_it() {
    let [nothing, swings, by_noise] = [Moved::Nothing, Moved::BySwings, Moved::ByNoise];
    let drift = SensorModel { drift: 0.01, drift_time_s: 5.0, ..SensorModel::default() };
    let dense = SensorModel { noise_density: 0.01, ..SensorModel::default() };
    let biased = SensorModel { bias: 0.01, ..SensorModel::default() };
    for (scenario, wanted) in [
        (commanded(0.1, STEP), [nothing; 3]),
        (disturbed(0.1, STEP), [nothing; 3]),
        // What is commanded swings on, whatever else ends with the flight.
        (commanded(0.1, sine(2.0)), [swings; 3]),
        (commanded(0.1, sine(2.01)), [nothing; 3]),
        (commanded(0.0, sine(0.0)), [nothing; 3]),
        (commanded(0.1, noise(0.0)), [by_noise, nothing, nothing]),
        (commanded(0.0, noise(0.0)), [nothing; 3]),
        (disturbed(0.1, sine(2.0)), [swings, swings, nothing]),
        (disturbed(0.1, sine(2.01)), [nothing; 3]),
        (disturbed(0.0, sine(0.0)), [nothing; 3]),
        (disturbed(0.1, noise(2.0)), [by_noise, nothing, nothing]),
        (disturbed(0.1, noise(2.01)), [nothing; 3]),
        (seen(drift), [by_noise, nothing, nothing]),
        (seen(dense), [by_noise, nothing, nothing]),
        (seen(biased), [nothing; 3]),
    ] {
        let about = (&scenario.setpoint, &scenario.disturbances, &scenario.surroundings);
        assert_eq!(moved(&scenario), wanted, "{about:?}");
    }
    let mut both = disturbed(0.1, noise(0.0));
    both.disturbances.extend(disturbed(0.1, sine(0.0)).disturbances);
    assert_eq!(moved(&both), [by_noise, swings, nothing]);
}

/// A step, pulse or change of the plant at sample 160 is the last that leaves a fifth of the flight alone.
#[test]
fn what_changes_in_the_last_fifth_changes_late() {
    let is_late = |scenario: &Scenario| {
        let mut trace = Trace::with_room(&scenario.prepare().expect("flies"));
        trace.time_s = (0..scenario.timing.rows()).map(|k| scenario.timing.time_s(k)).collect();
        changes_late(scenario, &trace)
    };
    let changing = |at_s: f64, ramp_s: f64| {
        let change = PlantChange::new(at_s, ramp_s, plant()).expect("allowed");
        Scenario { plant_changes: vec![change], ..commanded(0.1, STEP) }
    };
    let at = |at_s: f64| Shape::Step { at_s };
    let ends = |at_s: f64| Shape::Pulse { at_s: 0.0, width_s: at_s };
    for (wanted, scenario) in [
        (false, commanded(0.1, at(1.6))),
        (true, commanded(0.1, at(1.61))),
        (true, commanded(0.1, at(2.0))),
        (false, commanded(0.1, at(2.01))),
        (false, disturbed(0.1, at(1.6))),
        (true, disturbed(0.1, at(1.61))),
        (true, disturbed(0.1, at(2.0))),
        (false, disturbed(0.1, at(2.01))),
        (false, disturbed(0.1, ends(1.5))),
        (true, disturbed(0.1, ends(1.7))),
        // What moves for ever has no last change.
        (false, commanded(0.1, sine(0.0))),
        (false, disturbed(0.1, sine(0.0))),
        (false, disturbed(0.1, noise(0.0))),
        (false, changing(1.6, 0.0)),
        (true, changing(1.61, 0.0)),
        (true, changing(0.5, 1.2)),
        (true, changing(2.0, 0.0)),
        (false, changing(2.01, 0.0)),
    ] {
        let about = (&scenario.setpoint, &scenario.disturbances, &scenario.plant_changes);
        assert_eq!(is_late(&scenario), wanted, "{about:?}");
    }
}

/// What acts at the servo beyond the end of a flight that is flown on: at its last sample, and far behind it.
fn at_servo(scenario: &Scenario, afterwards: Afterwards) -> [f64; 2] {
    let prepared = held_on(scenario, 1001, afterwards).expect("it is flown on");
    let at_servo = prepared.at_servo.expect("something acts there");
    assert_eq!(at_servo.len(), 1001);
    [at_servo[200], at_servo[1000]]
}

#[test]
fn what_stands_at_the_end_of_a_flight_is_held_and_what_would_begin_later_does_not() {
    let all = [Afterwards::Noise, Afterwards::Swings, Afterwards::Quiet];
    let pulse = |width_s: f64| Shape::Pulse { at_s: 0.5, width_s };
    for afterwards in all {
        assert_eq!(at_servo(&disturbed(0.1, STEP), afterwards), [0.1, 0.1]);
        assert_eq!(at_servo(&disturbed(0.1, pulse(3.0)), afterwards), [0.1, 0.1]);
        assert_eq!(at_servo(&disturbed(0.1, pulse(1.0)), afterwards), [0.0, 0.0]);
        assert_eq!(at_servo(&disturbed(0.1, Shape::Step { at_s: 3.0 }), afterwards), [0.0, 0.0]);
        assert_eq!(at_servo(&disturbed(0.1, sine(3.0)), afterwards), [0.0, 0.0]);
    }
}

#[test]
fn noise_and_swings_go_on_only_where_they_are_to() {
    let is_moving = |scenario: &Scenario| {
        let acts = |afterwards| at_servo(scenario, afterwards).map(|it| it != 0.0);
        [Afterwards::Noise, Afterwards::Swings, Afterwards::Quiet].map(acts)
    };
    assert_eq!(
        is_moving(&disturbed(0.1, noise(0.0))),
        [[true, true], [true, false], [true, false]]
    );
    assert_eq!(is_moving(&disturbed(0.1, sine(0.1))), [[true, true], [true, true], [true, false]]);
    let commanded = |amplitude_rad: f64, shape: Shape, afterwards: Afterwards| {
        let prepared = held_on(&commanded(amplitude_rad, shape), 1001, afterwards);
        let setpoint_rad = prepared.expect("it is flown on").setpoint_rad;
        [setpoint_rad[200], setpoint_rad[1000]].map(|it| it != 0.0)
    };
    for afterwards in [Afterwards::Noise, Afterwards::Swings, Afterwards::Quiet] {
        assert_eq!(commanded(0.1, sine(0.1), afterwards), [true, true]);
        assert_eq!(commanded(0.1, STEP, afterwards), [true, true]);
        assert_eq!(commanded(0.1, Shape::Step { at_s: 3.0 }, afterwards), [false, false]);
        let goes_on = afterwards == Afterwards::Noise;
        assert_eq!(commanded(0.1, noise(0.0), afterwards), [true, goes_on]);
    }
}

#[test]
fn a_plant_that_changes_after_a_flight_does_not_change_where_it_is_flown_on() {
    let changed = |at_s: f64| {
        let change = PlantChange::new(at_s, 0.0, plant()).expect("allowed");
        let own = Scenario { plant_changes: vec![change], ..commanded(0.1, STEP) };
        held_on(&own, 1001, Afterwards::Quiet).expect("it is flown on").stages.len()
    };
    assert_eq!([changed(2.0), changed(2.01)], [2, 1]);
}

fn in_air(winds: Vec<Wind>, turbulence: Option<Turbulence>) -> Scenario {
    let course = Course {
        airspeed_m_s: 50.0,
        height_m: 100.0,
        climb_rad: 0.0,
        axes_rad: 0.0,
        heading_rad: 0.0,
        start_m: [0.0; 2],
    };
    let mut own = commanded(0.1, STEP);
    own.surroundings.weather = Some(Weather { course, winds, turbulence });
    own
}

fn light() -> Turbulence {
    Turbulence {
        specification: Specification::MilF8785c,
        intensity: Severity::Light.into(),
        height_m: 100.0,
        airspeed_m_s: 50.0,
        wing_span_m: 10.0,
        noise: 1.into(),
        follows: Follows::Start,
        driven_until_s: f64::INFINITY,
    }
}

/// Turbulence moves a flight as noise does, and a wind as a load that is held.
#[test]
fn turbulence_moves_a_flight_and_a_wind_does_not() {
    let steady = Wind::Steady(Steady { earth_m_s: [3.0, 0.0, 0.0] });
    let [nothing, by_noise] = [Moved::Nothing, Moved::ByNoise];
    assert_eq!(moved(&in_air(vec![steady], None)), [nothing; 3]);
    assert_eq!(moved(&in_air(Vec::new(), Some(light()))), [by_noise, nothing, nothing]);
}

/// A gust along a way of 80.5 m until the last fifth begins.
#[test]
fn air_that_changes_in_the_last_fifth_changes_late() {
    let sized = |down_m_s: f64, start_m: f64| {
        let amplitude_m_s = [0.0, 0.0, down_m_s];
        Wind::FullCycle(FullCycle { amplitude_m_s, gradient_m: 10.0, start_m })
    };
    let gust = |start_m: f64| sized(2.0, start_m);
    let is_late = |winds: Vec<Wind>| air_changes(&in_air(winds, None), 161);
    assert!(!is_late(vec![Wind::Steady(Steady { earth_m_s: [3.0, 0.0, 0.0] })]));
    assert!(!is_late(vec![gust(60.0)]), "it ends at 80 m");
    assert!(is_late(vec![gust(62.0)]), "it ends at 82 m");
    // A hundredth of an updraught before it is none.
    assert!(!is_late(vec![sized(-20.0, 10.0), sized(0.19, 80.5)]));
    assert!(is_late(vec![sized(-20.0, 10.0), sized(0.21, 80.5)]));
}

/// The turbulence dies away from the end of the flight on, of 2 s on a grid of 10 ms.
#[test]
fn turbulence_is_that_of_the_flight_until_its_end_and_dies_away_from_then_on() {
    let gusts = |until_s: f64| {
        let turbulence = Turbulence { driven_until_s: until_s, ..light() };
        let Some(weather) = in_air(Vec::new(), Some(turbulence)).surroundings.weather else {
            panic!("it has weather")
        };
        weather.gusts(Timing::new(0.01, 60.0).expect("allowed")).expect("allowed")
    };
    let (all, ended) = (gusts(f64::INFINITY), gusts(2.005));
    assert_eq!(all[..201], ended[..201]);
    assert_ne!(all[201], ended[201]);
    let forward = |gusts: &[[f64; 3]]| gusts.iter().map(|it| it[0].abs()).fold(0.0, f64::max);
    assert!(forward(&ended[4000..]) < 1e-3 * forward(&all[4000..]));
}
