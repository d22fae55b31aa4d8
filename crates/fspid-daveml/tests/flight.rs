//! An invented aircraft in `.dml` files of one's own, flown: its loads, trim and box against closed forms.
#![allow(clippy::unwrap_used, reason = "a test")]
#![allow(clippy::disallowed_methods, reason = "references may come from the platform's functions")]

use fspid_aircraft::{
    Air, Aircraft, Controls, Environment, Flow, ForceModel, Travel, TrimTarget, Vector3,
};
use fspid_daveml::flight::{Body, FlightError, Gearing, Setting, TableForces};
use fspid_daveml::{Model, read};

const FOOT_M: f64 = 0.3048;
const POUND_N: f64 = 4.448_221_615_260_5;
const AERO: &str = include_str!("data/glider_aero.dml");
const ENGINE: &str = include_str!("data/glider_engine.dml");
const BODY: &str = include_str!("data/glider_body.dml");

fn model(text: &str) -> Model {
    read(text).unwrap().model
}

fn body(cg_pct: f64) -> Body {
    Body::of(&model(BODY), &[cg_pct], 0.0).unwrap()
}

fn forces(cg_pct: f64) -> TableForces {
    let setting = Setting {
        centre_of_mass_m: body(cg_pct).centre_of_mass_m,
        gearing: Gearing::Proportional,
        travel: Travel::UNLIMITED,
    };
    TableForces::new(model(AERO), Some(model(ENGINE)), setting).unwrap()
}

/// 300 ft/s at 4 deg and 2 deg of sideslip, pitching up at 6 deg/s, in air of 0.002 slug/ft³.
fn flow() -> Flow {
    let (alpha, beta) = (4.0_f64.to_radians(), 2.0_f64.to_radians());
    let ((sin_a, cos_a), (sin_b, cos_b)) = (alpha.sin_cos(), beta.sin_cos());
    let velocity = 300.0 * FOOT_M * Vector3::new(cos_a * cos_b, sin_b, sin_a * cos_b);
    let air = Air::with_density(0.002 * POUND_N / FOOT_M.powi(4), 330.0);
    Flow::new(velocity, Vector3::new(0.0, 6.0_f64.to_radians(), 0.0), 0.0, air)
}

fn near(found: Vector3, expected: [f64; 3], unit: f64) {
    for (found, expected) in found.to_array().into_iter().zip(expected) {
        let off = found / unit - expected;
        assert!(off.abs() < 1e-9 * (1.0 + expected.abs()), "{found} is not {expected} units");
    }
}

#[test]
fn loads_are_coefficients_times_dynamic_pressure_with_moments_moved_to_the_centre_of_mass() {
    let controls =
        Controls { elevator_rad: 1.0_f64.to_radians(), throttle: 0.5, ..Controls::default() };
    let loads = forces(30.0).loads(&flow(), &controls);
    // q̄S = 0.5·0.002·300²·200 = 18 000 lbf; thrust 1000 lbf; Cm = 0.02 − 0.04 − 0.02 − 0.012; dx = −0.3 ft.
    let force = [-0.03 * 18_000.0 + 1000.0, -0.02 * 18_000.0, -0.52 * 18_000.0];
    near(loads.force_n, force, POUND_N);
    let pitch = 6.0 * -0.052 * 18_000.0 - 1000.0 - 0.3 * force[2];
    let yaw = 30.0 * 0.004 * 18_000.0 + 0.3 * force[1];
    near(loads.moment_n_m, [30.0 * -0.002 * 18_000.0, pitch, yaw], FOOT_M * POUND_N);
    assert!((forces(30.0).thrust_n(&flow(), &controls) / POUND_N - 1000.0).abs() < 1e-9);
}

#[test]
fn a_trim_of_straight_lines_is_that_of_the_closed_form() {
    let environment = Environment::uniform(9.8, 1.0, 330.0);
    let aircraft = Aircraft::new(body(25.0).mass, forces(25.0), environment).unwrap();
    let target = TrimTarget { airspeed_m_s: 80.0, altitude_m: 0.0, flight_path_rad: 0.0 };
    let trim = aircraft.trim(target).unwrap();
    let scale_n = 0.5 * 80.0 * 80.0 * 200.0 * FOOT_M * FOOT_M;
    let weight_n = body(25.0).mass.mass_kg * 9.8;
    let alpha_deg = trim.point.alpha_rad.to_degrees();
    let lift = (-0.2 - 0.08 * alpha_deg) * scale_n + weight_n * trim.point.alpha_rad.cos();
    assert!(lift.abs() < 1e-6 * weight_n);
    let thrust = 0.03 * scale_n + weight_n * trim.point.alpha_rad.sin();
    assert!((trim.thrust_n - thrust).abs() < 1e-6 * weight_n);
    // The thrust stands 1 ft over the centre of mass: its moment is taken by the elevator.
    let moment = 6.0 * (0.02 - 0.01 * alpha_deg - 0.02 * trim.point.elevator_rad.to_degrees());
    assert!((moment * scale_n - thrust).abs() < 1e-6 * weight_n);
}

#[test]
fn the_box_of_a_flight_is_that_of_the_tables() {
    let validity = *forces(25.0).validity();
    assert!((validity.alpha_rad.min.to_degrees() + 10.0).abs() < 1e-12);
    assert!((validity.alpha_rad.max.to_degrees() - 15.0).abs() < 1e-12);
    assert!(validity.mach.max.is_infinite());
}

#[test]
fn loads_do_not_use_the_heap() {
    let (forces, flow) = (forces(25.0), flow());
    let used = allocation_counter::measure(|| {
        let _ = forces.loads(&flow, &Controls::default());
    });
    assert_eq!(used.count_total, 0);
}

fn refusal(from: &str, to: &str) -> FlightError {
    let setting = Setting {
        centre_of_mass_m: Vector3::ZERO,
        gearing: Gearing::Proportional,
        travel: Travel::UNLIMITED,
    };
    assert!(AERO.contains(from));
    TableForces::new(model(&AERO.replace(from, to)), None, setting).unwrap_err()
}

#[test]
fn what_does_not_fit_is_told_with_what_does() {
    let input = refusal(" initialValue=\"0\"><isInput/>", "><isInput/>").to_string();
    assert!(input.starts_with("a flight has no `gearPosition`, and the file gives it no initial value; known are trueAirspeed,"));
    let output = refusal("aeroBodyForceCoefficient_Z", "lift").to_string();
    assert_eq!(
        output,
        "the output `aeroBodyForceCoefficient_Z` is missing; mark a variable of that name with <isOutput/>"
    );
    let units = refusal("varID=\"el\" units=\"deg\"", "varID=\"el\" units=\"grad\"").to_string();
    assert_eq!(units, "`elevatorDeflection` is in `grad`; known units for it are rad, deg");
}

#[test]
fn a_body_that_is_not_symmetric_is_refused() {
    let text = BODY.replace(
        "varID=\"Ixy\" units=\"slugft2\" initialValue=\"0\"",
        "varID=\"Ixy\" units=\"slugft2\" initialValue=\"1\"",
    );
    let error = Body::of(&model(&text), &[25.0], 0.0).unwrap_err();
    assert!(matches!(error, FlightError::Lopsided { name: "bodyProductOfInertia_XY", .. }));
}

#[test]
fn a_body_is_placed_by_percent_of_the_chord_or_stays_where_its_file_has_it() {
    let placed = |text: &str, place| Body::placed(&model(text), place, 0.0);
    assert_eq!(placed(BODY, Some(30.0)).unwrap(), body(30.0));
    assert_eq!(placed(BODY, None).unwrap(), body(25.0));
    let open = BODY.replace(" initialValue=\"25\"", "");
    assert!(matches!(placed(&open, None).unwrap_err(), FlightError::Input { .. }));
    let fixed = BODY.replace("vrsPositionOfCM", "fuel");
    assert!(matches!(placed(&fixed, Some(30.0)).unwrap_err(), FlightError::NoInput { .. }));
}
