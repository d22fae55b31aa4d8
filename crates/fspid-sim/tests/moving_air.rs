//! The air between samples: gusts at each instant, and turbulence that does not know the loop's period.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use std::sync::Arc;

use crate::support;

use fspid_aircraft::aerodynamics::derivatives::{DragLaw, ThrustLaw};
use fspid_aircraft::data::Laws;
use fspid_aircraft::{Aircraft, Environment, TrimTarget};
use fspid_core::{Gains, Pid, PidConfig};
use fspid_sim::air::{
    Along, Follows, GRID_S, Intensity, Severity, Specification, TableRow, Turbulence, Wind,
    WindKind, WindTable,
};
use fspid_sim::aircraft::Forces;
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::{
    Actuator, AircraftPlant, Controller, Course, LinearPlant, NamedController, Plant, Scenario,
    Surroundings, Timing, Trace, Weather, simulate,
};
use support::{FOOT_M, derivative_data};

/// A 747 near 20 000 ft, where the gusts are met.
const NAME: &str = "b747-cruise-low";
const SPEED_M_S: f64 = 673.0 * FOOT_M;
const ALTITUDE_M: f64 = 6096.0;

fn aircraft() -> AircraftPlant {
    let data = derivative_data(NAME);
    let laws = Laws { drag: DragLaw::Polar, thrust: ThrustLaw::Constant };
    let forces = Forces::from(data.force_model(laws));
    let aircraft = Aircraft::new(data.mass_properties(), forces, Environment::STANDARD);
    let target =
        TrimTarget { airspeed_m_s: SPEED_M_S, altitude_m: ALTITUDE_M, flight_path_rad: 0.0 };
    AircraftPlant::trimmed(aircraft.expect("a body"), target).expect("flies")
}

fn linear() -> LinearPlant {
    aircraft().linear().expect("has a linear model")
}

/// Nobody answers, so that what is seen is the air alone.
fn flown(plant: impl Into<Plant>, weather: Weather, (dt_s, end_s): (f64, f64)) -> Trace {
    let gains = Gains { kp: 0.0, ki: 0.0, kd: 0.0 };
    let pid = Pid::new(gains, PidConfig::sampled_every(dt_s)).expect("allowed");
    let scenario = Scenario {
        name: "air".into(),
        plant: plant.into(),
        plant_changes: Vec::new(),
        actuator: Actuator::first_order(0.1).expect("allowed"),
        timing: Timing::new(dt_s, end_s).expect("allowed"),
        setpoint: Profile::new(0.0, Shape::Step { at_s: 0.0 }).expect("allowed"),
        disturbances: Vec::new(),
        controllers: vec![NamedController {
            name: "none".into(),
            controller: Controller::Fixed(pid),
        }],
        surroundings: Surroundings { weather: Some(weather), ..Surroundings::default() },
        externals: Vec::new(),
        autopilot: None,
    };
    simulate(&scenario).expect("flies").traces.remove(0)
}

fn course() -> Course {
    Course {
        airspeed_m_s: SPEED_M_S,
        height_m: ALTITUDE_M,
        climb_rad: 0.0,
        axes_rad: 0.0,
        heading_rad: 0.3,
        start_m: [0.0, 0.0],
    }
}

fn winds(winds: Vec<Wind>) -> Weather {
    Weather { course: course(), winds, turbulence: None }
}

/// The gust of the regulation that is shortest, 30 ft, beginning at no sample of any loop here.
fn shortest() -> Weather {
    let start_m = 0.4567 * SPEED_M_S;
    let gust = WindKind::FullCycle.build(&[0.0, 0.0, -8.4, 30.0 * FOOT_M, start_m]);
    winds(vec![gust.expect("allowed")])
}

/// Gusts along, across and upwards that overlap.
fn several() -> Weather {
    let build = |kind: WindKind, params: &[f64]| kind.build(params).expect("allowed");
    winds(vec![
        build(WindKind::FullCycle, &[3.0, 2.0, -8.4, 40.0, 60.0]),
        build(WindKind::RampHold, &[0.0, -2.0, 3.0, 70.0, 101.0]),
    ])
}

fn turbulence(seed: u64) -> Weather {
    let turbulence = Turbulence {
        specification: Specification::MilF8785c,
        intensity: Intensity::from(Severity::Moderate),
        height_m: ALTITUDE_M,
        airspeed_m_s: SPEED_M_S,
        wing_span_m: 196.0 * FOOT_M,
        noise: seed.into(),
        follows: Follows::Start,
        driven_until_s: f64::INFINITY,
    };
    Weather { turbulence: Some(turbulence), ..winds(Vec::new()) }
}

/// Largest difference at common times, as a share of the largest value.
fn apart(coarse: &[f64], by_coarse: usize, fine: &[f64], by_fine: usize) -> f64 {
    let pairs = coarse.iter().step_by(by_coarse).zip(fine.iter().step_by(by_fine));
    let most = fine.iter().map(|value| value.abs()).fold(0.0, f64::max);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / most
}

fn column<'a>(trace: &'a Trace, name: &str) -> &'a [f64] {
    trace.column(name).expect("there")
}

/// It used to be held over a sample, so that the pitch of the linear aircraft was off by 12 to 23 % of its peak at 50 ms.
#[test]
fn a_gust_moves_a_linear_aircraft_alike_at_any_period() {
    for weather in [shortest(), several()] {
        let fine = flown(linear(), weather.clone(), (0.001, 3.0));
        for (dt_s, by) in [(0.005, 5), (0.01, 10), (0.025, 25), (0.05, 50)] {
            let coarse = flown(linear(), weather.clone(), (dt_s, 3.0));
            let off = apart(&coarse.theta_rad, 1, &fine.theta_rad, by);
            // Sub-steps of 10 ms through a gust of 89 ms: the sixth power of an eighth of it.
            assert!(off < 2e-6, "{dt_s}: {off}");
        }
    }
}

/// A nonlinear aircraft met the gust of the beginning of each step, 1.9 % of the peak off at 10 ms.
#[test]
fn a_gust_moves_a_nonlinear_aircraft_alike_at_any_period() {
    let fine = flown(aircraft(), shortest(), (0.0005, 3.0));
    for (dt_s, by) in [(0.005, 10), (0.01, 20), (0.025, 50), (0.05, 100)] {
        let coarse = flown(aircraft(), shortest(), (dt_s, 3.0));
        let off = apart(&coarse.theta_rad, 1, &fine.theta_rad, by);
        assert!(off < 1e-4, "{dt_s}: {off}");
    }
}

/// Half the step is a sixteenth of the error, through the corners of the gusts too. Within 10 ms, over which the wing
/// leveller holds its aileron.
#[test]
fn the_error_of_a_step_through_gusts_falls_with_its_fourth_power() {
    let theta = |dt_s: f64| flown(aircraft(), several(), (dt_s, 1.0)).theta_rad;
    let exact = theta(0.000_312_5);
    let error = |dt_s: f64, by: usize| apart(&theta(dt_s), 1, &exact, by);
    let (ten, five, two) = (error(0.01, 32), error(0.005, 16), error(0.0025, 8));
    let orders = [ten / five, five / two].map(libm::log2);
    for order in orders {
        assert!(order > 3.7, "{orders:?}: {ten} {five} {two}");
    }
}

/// A study of sample periods compares the same gusts. Sample k used to take the k-th number, so that each period met another
/// air.
#[test]
fn the_same_seed_is_the_same_air_at_any_period() {
    let end_s = 20.0;
    let reference = flown(linear(), turbulence(3), (0.005, end_s));
    let flown_at = |dt_s: f64| flown(linear(), turbulence(3), (dt_s, end_s));
    for (dt_s, by) in [(0.01, 2), (0.02, 4), (0.025, 5), (0.04, 8)] {
        let other = flown_at(dt_s);
        for name in ["gust_forward_m_s", "gust_down_m_s", "gust_pitch_rad_s"] {
            let (other, reference) = (column(&other, name), column(&reference, name));
            let common = other.iter().zip(reference.iter().step_by(by));
            for (k, (a, b)) in common.enumerate() {
                assert_eq!(a.to_bits(), b.to_bits(), "{name} at {k} of {dt_s}");
            }
        }
        // The air between the samples is the same too: so is what it does.
        let off = apart(&other.theta_rad, 1, &reference.theta_rad, by);
        assert!(off < 1e-10, "{dt_s}: {off}");
    }
}

#[test]
fn a_nonlinear_aircraft_meets_the_same_turbulence_at_any_period() {
    let end_s = 20.0;
    let reference = flown(aircraft(), turbulence(3), (0.005, end_s));
    for (dt_s, by) in [(0.01, 2), (0.02, 4), (0.025, 5), (0.04, 8)] {
        let other = flown(aircraft(), turbulence(3), (dt_s, end_s));
        for name in ["air_forward_m_s", "air_right_m_s", "air_down_m_s"] {
            let (other, reference) = (column(&other, name), column(&reference, name));
            let same = other.iter().zip(reference.iter().step_by(by));
            assert!(same.clone().count() > 400);
            for (a, b) in same {
                assert_eq!(a.to_bits(), b.to_bits(), "{name} {dt_s}");
            }
        }
        let off = apart(&other.theta_rad, 1, &reference.theta_rad, by);
        assert!(off < 1e-5, "{dt_s}: {off}");
    }
}

/// A period that fits the grid nowhere: the same air all the same, near the nearest time of the grid.
#[test]
fn a_period_that_does_not_fit_the_grid_flies_through_the_same_air() {
    let fine = flown(linear(), turbulence(3), (0.001, 12.0));
    let dt_s = 1.0 / 120.0;
    let other = flown(linear(), turbulence(3), (dt_s, 12.0));
    let reference = column(&fine, "gust_down_m_s");
    for (k, gust) in column(&other, "gust_down_m_s").iter().enumerate() {
        let tick = (k as f64 * dt_s / GRID_S + 1e-6).floor() as usize;
        assert_eq!(*gust, reference[10 * tick], "{k}");
    }
    // Each tenth of a second is a sample of both.
    let off = apart(&other.theta_rad, 12, &fine.theta_rad, 100);
    assert!(off < 1e-10, "{off}");
}

/// Zigzag winds whose rows lie at no sample of any loop here: north, up and along the body.
fn zigzag(along: Along, spacing: f64, from: f64) -> Weather {
    let row = |index: u32| {
        let swing = if index.is_multiple_of(2) { -1.0 } else { 1.0 };
        TableRow {
            at: from + f64::from(index) * spacing,
            earth_m_s: [2.0 * swing, 0.0, -3.0 * swing],
            body_m_s: [swing, 0.0, 0.0],
        }
    };
    let table = WindTable::new(along, (0..12).map(row).collect()).expect("allowed");
    winds(vec![Wind::Table(Arc::new(table))])
}

/// Half the step is a sixteenth of the error, through the kinks of a table over time, distance and height.
#[test]
fn the_error_of_a_step_through_a_table_falls_with_its_fourth_power() {
    for weather in [
        zigzag(Along::Time, 0.091_37, 0.012_3),
        zigzag(Along::Distance, 0.091_37 * SPEED_M_S, 2.345),
        // Within the few feet that the gusts of the table move it.
        zigzag(Along::Height, 0.171, ALTITUDE_M - 1.0),
    ] {
        let theta = |dt_s: f64| flown(aircraft(), weather.clone(), (dt_s, 1.0)).theta_rad;
        let exact = theta(0.000_312_5);
        let error = |dt_s: f64, by: usize| apart(&theta(dt_s), 1, &exact, by);
        let (ten, five, two) = (error(0.01, 32), error(0.005, 16), error(0.0025, 8));
        let orders = [ten / five, five / two].map(libm::log2);
        for order in orders {
            assert!(order > 3.5, "{orders:?}: {ten} {five} {two}");
        }
    }
}

/// A linear aircraft on its straight course feels what the table says since the start, between its samples too.
#[test]
fn a_linear_aircraft_feels_a_table_alike_at_any_period() {
    for weather in [
        zigzag(Along::Time, 0.091_37, 0.012_3),
        zigzag(Along::Distance, 0.091_37 * SPEED_M_S, 2.345),
    ] {
        let fine = flown(linear(), weather.clone(), (0.001, 3.0));
        for (dt_s, by) in [(0.01, 10), (0.05, 50)] {
            let coarse = flown(linear(), weather.clone(), (dt_s, 3.0));
            let off = apart(&coarse.theta_rad, 1, &fine.theta_rad, by);
            // Straight lines between corners are polynomials, which the answer is exact for.
            assert!(off < 1e-10, "{dt_s}: {off}");
        }
        let start = weather.winds[0].at(&weather.course.place(0.0));
        for (k, gust) in column(&fine, "gust_down_m_s").iter().enumerate() {
            let here = weather.winds[0].at(&weather.course.place(k as f64 * 0.001));
            let expected = here.earth_m_s[2] - start.earth_m_s[2];
            assert!((gust - expected).abs() < 1e-12, "{k}: {gust} {expected}");
        }
        assert!(column(&fine, "gust_down_m_s").iter().any(|gust| gust.abs() > 5.0));
    }
}
