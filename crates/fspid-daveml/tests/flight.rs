//! An invented aircraft in `.dml` files of one's own, flown: its loads, trim and box against closed forms.
#![allow(clippy::unwrap_used, reason = "a test")]
#![allow(clippy::disallowed_methods, reason = "references may come from the platform's functions")]

use fspid_aircraft::Gearing;
use fspid_aircraft::{
    Air, AirMotion, Aircraft, Controls, Environment, Flow, ForceModel, MassProperties, RigidState,
    Travel, TrimTarget, Vector3,
};
use fspid_daveml::flight::{Body, FlightError, Setting, TableForces};
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

/// A sign was read and not used: an elevator that counts trailing edge up was told as "trailing edge down positive" and flown so.
#[test]
fn what_counts_the_other_way_in_its_file_is_turned() {
    let signed = |name: &str, sign: &str| {
        let plain = format!("name=\"{name}\"");
        assert!(AERO.contains(&plain));
        AERO.replacen(&plain, &format!("{plain} sign=\"{sign}\""), 1)
    };
    let loads = |text: &str, elevator_deg: f64, beta_deg: f64| {
        let setting = Setting {
            centre_of_mass_m: body(30.0).centre_of_mass_m,
            gearing: Gearing::Proportional,
            travel: Travel::UNLIMITED,
        };
        let forces = TableForces::new(model(text), Some(model(ENGINE)), setting).unwrap();
        let elevator_rad = elevator_deg.to_radians();
        let (sine, cosine) = beta_deg.to_radians().sin_cos();
        let air = Air::with_density(1.0, 330.0);
        let flow =
            Flow::new(Vector3::new(90.0 * cosine, 90.0 * sine, 0.0), Vector3::ZERO, 0.0, air);
        forces.loads(&flow, &Controls { elevator_rad, ..Controls::default() })
    };
    for sign in ["+TEU", "trailing edge up"] {
        let up = signed("elevatorDeflection", sign);
        assert_eq!(loads(&up, 3.0, 2.0), loads(AERO, -3.0, 2.0), "{sign}");
    }
    assert_eq!(loads(&signed("elevatorDeflection", "+TED"), 3.0, 2.0), loads(AERO, 3.0, 2.0));
    for sign in ["+ANR", "wind in left ear"] {
        let left = signed("angleOfSideslip", sign);
        assert_eq!(loads(&left, 3.0, 2.0), loads(AERO, 3.0, -2.0), "{sign}");
    }
    let down = loads(&signed("aeroBodyMomentCoefficient_Yaw", "aircraft nose left"), 3.0, 2.0);
    let up = loads(AERO, 3.0, 2.0);
    // About the centre of mass the side force has a moment as well.
    let of_force = body(30.0).centre_of_mass_m.x * up.force_n.y;
    let [yaw, turned] = [up, down].map(|it| it.moment_n_m.z + of_force);
    assert!((yaw + turned).abs() < 1e-9 * yaw.abs() && yaw.abs() > 0.0, "{yaw} {turned}");
}

/// Words that were not known were taken as ours, without a word.
#[test]
fn signs_that_are_not_known_are_refused_where_they_count() {
    let made = |name: &str, sign: &str| {
        let plain = format!("name=\"{name}\"");
        let text = AERO.replacen(&plain, &format!("{plain} sign=\"{sign}\""), 1);
        let setting = Setting {
            centre_of_mass_m: body(30.0).centre_of_mass_m,
            gearing: Gearing::Proportional,
            travel: Travel::UNLIMITED,
        };
        TableForces::new(model(&text), Some(model(ENGINE)), setting)
    };
    let told = made("elevatorDeflection", "towards the tail").unwrap_err().to_string();
    let expected = "`elevatorDeflection` counts by the sign `towards the tail`, which is not known for it: ted, trailing edge down (as here), \
                    or teu, trailing edge up (turned); or leave it out";
    assert_eq!(told, expected);
    for sign in ["", "+ANU", "Aircraft nose up", "AND"] {
        assert!(made("angleOfAttack", sign).is_ok(), "{sign}");
    }
    // Ailerons are told by many words, of one side or of both.
    assert!(made("aileronDeflection", "inside out").is_ok());
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

/// The aircraft with a part of its pitching moment by the rate of the angle of attack.
fn by_the_rate(part: &str) -> String {
    let input = "<variableDef name=\"angleOfAttackRate\" varID=\"ad\" units=\"deg_s\"><isInput/></variableDef>";
    let first = "  <variableDef name=\"gearPosition\"";
    let text = AERO.replacen(first, &format!("{input}{first}"), 1);
    text.replacen("<cn>0.02</cn>", &format!("<cn>0.02</cn>{part}"), 1)
}

fn times(factors: &str) -> String {
    format!("<apply><times/><cn>-0.0003</cn>{factors}</apply>")
}

/// A moment that is 0 at small rates and not at large ones used to be flown as another, and a limit or a dead zone too:
/// the slope between 0 and 1 rad/s was taken at every rate.
#[test]
fn loads_that_are_not_linear_in_the_rate_of_the_angle_of_attack_are_refused_by_name() {
    let refused = |part: &str| engineless(&by_the_rate(part), Vector3::ZERO).unwrap_err();
    let size = "<apply><abs/><ci>ad</ci></apply>";
    let held = "<apply><min/><cn>100</cn><ci>ad</ci></apply>";
    let beyond = "<apply><max/><cn>0.1</cn><ci>ad</ci></apply>";
    let square = "<ci>ad</ci><ci>ad</ci>";
    let stalled = "<apply><piecewise><piece><ci>ad</ci><apply><lt/><ci>alpha</ci><cn>12</cn></apply></piece>\
                   <otherwise><apply><abs/><ci>ad</ci></apply></otherwise></piecewise></apply>";
    let odd = format!("<ci>ad</ci>{size}");
    for part in [size, held, beyond, square, stalled, odd.as_str()] {
        let error = refused(&times(part));
        let FlightError::NotLinear { name, .. } = error else { panic!("{part}: {error}") };
        assert_eq!(name, "aeroBodyMomentCoefficient_Pitch");
    }
    let told = refused(&times(&format!("<ci>ad</ci>{size}"))).to_string();
    assert!(told.contains("not linear in `angleOfAttackRate`: at 0.001 rad/s"), "{told}");
}

#[test]
fn the_rate_of_the_angle_of_attack_may_have_any_factor_but_a_control() {
    let flies = |factors: &str| engineless(&by_the_rate(&times(factors)), Vector3::ZERO);
    for factors in [
        "<ci>ad</ci>",
        "<ci>ad</ci><ci>alpha</ci><ci>q</ci>",
        "<apply><divide/><ci>ad</ci><ci>V</ci></apply>",
    ] {
        assert!(flies(factors).is_ok(), "{factors}");
    }
    let error = flies("<ci>ad</ci><ci>el</ci>").unwrap_err();
    assert!(matches!(error, FlightError::RateByControl { .. }), "{error}");
}

/// An input with another name than the standard's used to stay at its initial value without a word, and with `pitchRate` for
/// `bodyAngularRate_Pitch` the damping was gone.
#[test]
fn inputs_that_a_flight_does_not_have_are_told_with_the_value_at_which_they_stay() {
    let held = |name: &str| {
        let text = AERO.replace(
            "name=\"bodyAngularRate_Pitch\" varID=\"q\" units=\"deg_s\"",
            &format!("name=\"{name}\" varID=\"q\" units=\"deg_s\" initialValue=\"0\""),
        );
        engineless(&text, Vector3::ZERO).unwrap().held_inputs()
    };
    let gear = "a flight has no `gearPosition`, which stays at its initial value, 0.0; known are trueAirspeed, ";
    let [only] = held("bodyAngularRate_Pitch").try_into().unwrap();
    assert!(only.starts_with(gear), "{only}");
    let [rate, _] = held("pitchRate").try_into().unwrap();
    assert!(
        rate.starts_with(
            "a flight has no `pitchRate`, which stays at its initial value, 0.0 deg_s; known are"
        ),
        "{rate}"
    );
    let [near, _] = held("bodyAngularRate_Ptich").try_into().unwrap();
    assert!(
        near.contains("; did you mean `bodyAngularRate_Pitch`? Known are trueAirspeed"),
        "{near}"
    );
    assert!(forces(25.0).held_inputs_of_the_engine().is_empty());
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

/// The same aircraft with drag and lift in place of X and Z.
fn in_wind_axes() -> String {
    let named = AERO.replace("aeroBodyForceCoefficient_X", "totalCoefficientOfDrag");
    let named = named.replace("aeroBodyForceCoefficient_Z", "totalCoefficientOfLift");
    // Drag 0.03 and lift from -0.6 to 1.4, with the signs of their axes.
    named.replace("<cn>-0.03</cn>", "<cn>0.03</cn>").replace("0.6, -1.4", "-0.6, 1.4")
}

fn engineless(text: &str, centre_of_mass_m: Vector3) -> Result<TableForces, FlightError> {
    let setting =
        Setting { centre_of_mass_m, gearing: Gearing::Proportional, travel: Travel::UNLIMITED };
    TableForces::new(model(text), None, setting)
}

/// Models with lift and drag used to be refused: "the output aeroBodyForceCoefficient_X is missing".
#[test]
fn lift_and_drag_are_forces_across_and_against_the_flow() {
    let forces = engineless(&in_wind_axes(), Vector3::ZERO).unwrap();
    let loads = forces.loads(&flow(), &Controls::default());
    let (alpha, beta) = (4.0_f64.to_radians(), 2.0_f64.to_radians());
    let ((sin_a, cos_a), (sin_b, cos_b)) = (alpha.sin_cos(), beta.sin_cos());
    let (drag, side, lift) = (0.03, -0.02, 0.52);
    let expected = [
        -drag * cos_a * cos_b + lift * sin_a,
        -drag * sin_b + side,
        -drag * sin_a * cos_b - lift * cos_a,
    ];
    near(loads.force_n, expected.map(|part| 18_000.0 * part), POUND_N);
    assert!(!forces.has_engine());
}

/// Without an engine straight flight is a glide: the path is down by the angle between drag and lift.
#[test]
fn a_glider_is_trimmed_in_its_glide() {
    let forces = engineless(&in_wind_axes(), body(25.0).centre_of_mass_m).unwrap();
    let environment = Environment::uniform(9.8, 1.0, 330.0);
    let aircraft = Aircraft::new(body(25.0).mass, forces, environment).unwrap();
    let target = TrimTarget { airspeed_m_s: 80.0, altitude_m: 0.0, flight_path_rad: 0.0 };
    let trim = aircraft.trim(target).unwrap();
    let lift = 0.2 + 0.08 * trim.point.alpha_rad.to_degrees();
    let path_rad = trim.target.flight_path_rad;
    assert!((path_rad.tan() + 0.03 / lift).abs() < 1e-9, "{path_rad}");
    assert!(path_rad < -0.02 && trim.point.throttle == 0.0 && trim.thrust_n == 0.0);
    let theta_rad = trim.state.euler().theta_rad;
    assert!((theta_rad - trim.point.alpha_rad - path_rad).abs() < 1e-12);
}

/// A ball has no span and no chord, and needs none: it used to be refused for them.
const BALL: &str = r#"<DAVEfunc xmlns="http://daveml.org/2010/DAVEML">
  <fileHeader name="Ball"><creationDate date="2026-11-21"/></fileHeader>
  <variableDef name="referenceWingArea" varID="S" units="m2" initialValue="0.02"><isOutput/></variableDef>
  <variableDef name="totalCoefficientOfLift" varID="CL" units="nd" initialValue="0.0"><isOutput/></variableDef>
  <variableDef name="totalCoefficientOfDrag" varID="CD" units="nd" initialValue="0.1"><isOutput/></variableDef>
  <variableDef name="aeroBodyForceCoefficient_Y" varID="CY" units="nd" initialValue="0.0"><isOutput/></variableDef>
  <variableDef name="aeroBodyMomentCoefficient_Roll" varID="Cl" units="nd" initialValue="0.0"><isOutput/></variableDef>
  <variableDef name="aeroBodyMomentCoefficient_Pitch" varID="Cm" units="nd" initialValue="0.0"><isOutput/></variableDef>
  <variableDef name="aeroBodyMomentCoefficient_Yaw" varID="Cn" units="nd" initialValue="0.0"><isOutput/></variableDef>
</DAVEfunc>"#;

/// Falling with v² drag: v = v_t tanh(g t / v_t), v_t² = 2 m g / (ρ S CD).
#[test]
fn a_ball_falls_as_drag_and_weight_say() {
    let forces = engineless(BALL, Vector3::ZERO).unwrap();
    let mass = MassProperties {
        mass_kg: 14.6,
        ix_kg_m2: (2.0 / 5.0) * 0.1,
        iy_kg_m2: 0.04,
        iz_kg_m2: 0.04,
        ixz_kg_m2: 0.0,
        engine_kg_m2_s: 0.0,
    };
    let ball = Aircraft::new(mass, forces, Environment::uniform(9.8, 1.2, 340.0)).unwrap();
    let start = RigidState::AT_REST;
    let end = (0..2000)
        .fold(start, |state, _| ball.step(&state, &Controls::default(), &AirMotion::STILL, 0.01));
    let terminal = f64::sqrt(2.0 * 14.6 * 9.8 / (1.2 * 0.02 * 0.1));
    let expected = terminal * f64::tanh(9.8 * 20.0 / terminal);
    let found = end.velocity_body_m_s.z;
    assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
}

#[test]
fn a_length_is_missed_where_a_moment_needs_it() {
    let turning = BALL.replace(
        r#"varID="Cm" units="nd" initialValue="0.0">"#,
        r#"varID="Cm" units="nd" initialValue="0.1">"#,
    );
    assert_ne!(turning, BALL);
    let refused = engineless(&turning, Vector3::ZERO).unwrap_err();
    assert_eq!(refused, FlightError::Output { name: "referenceWingChord" });
}

/// NASA's orbital sphere writes its inertia as (2/5)π; this used to be "not a number that can be used".
#[test]
fn a_number_that_is_written_out_is_worked_out_and_told() {
    let text = BALL.replace(r#"initialValue="0.1""#, r#"initialValue="(2/5)&#960;""#);
    let reading = read(&text).unwrap();
    assert_eq!(reading.model.constant("totalCoefficientOfDrag"), Some(0.4 * std::f64::consts::PI));
    let told: Vec<String> = reading.notes.iter().map(|note| format!("{note:?}")).collect();
    assert!(told.iter().any(|note| note.contains("(2/5)π")), "{told:?}");
    assert!(read(&BALL.replace(r#"initialValue="0.1""#, r#"initialValue="(2/5)x""#)).is_err());
}

/// The aircraft with a table of its pitching moment from 0 to 2, entered by a variable.
fn with_a_table_by(id: &str, more: &str) -> String {
    let table = format!(
        "<breakpointDef bpID=\"K\"><bpVals>0, 2</bpVals></breakpointDef>\
         <function name=\"cm\"><independentVarRef varID=\"{id}\"/><dependentVarRef varID=\"CmA\"/><functionDefn>\
         <griddedTableDef><breakpointRefs><bpRef bpID=\"K\"/></breakpointRefs><dataTable>0.02, 0</dataTable>\
         </griddedTableDef></functionDefn></function>"
    );
    let text = AERO.replacen("<cn>0.02</cn>", "<ci>CmA</ci>", 1);
    let variable = "<variableDef name=\"cma\" varID=\"CmA\" units=\"nd\"/>";
    let text =
        text.replacen("  <breakpointDef", &format!("  {variable}{more}\n  <breakpointDef"), 1);
    text.replacen("</DAVEfunc>", &format!("{table}</DAVEfunc>"), 1)
}

/// Ranges of tables used to count only where speed, Mach number, angles of the flow or altitude entered them themselves: a
/// copy of the angle of attack, or a control, left them without a word.
#[test]
fn a_table_that_is_read_beyond_its_data_is_told_whatever_enters_it() {
    let copy = "<variableDef name=\"copy\" varID=\"a2\" units=\"deg\"><calculation><math><apply><times/><cn>1</cn>\
                <ci>alpha</ci></apply></math></calculation></variableDef>";
    let controls = Controls { elevator_rad: 3.0_f64.to_radians(), ..Controls::default() };
    let told = |id: &str, more: &str| {
        let forces = engineless(&with_a_table_by(id, more), Vector3::ZERO).unwrap();
        forces.departure(&flow(), &controls).map(|departure| departure.to_string())
    };
    // The flow is at 4 deg, pitching up by 6 deg/s.
    for (id, more, value, unit) in
        [("a2", copy, "4", "deg"), ("el", "", "3", "deg"), ("q", "", "6", "deg_s")]
    {
        let told = told(id, more).unwrap_or_else(|| panic!("{id} leaves its table"));
        assert!(told.starts_with(&format!("table input {id} {value}")), "{told}");
        assert!(told.ends_with(&format!(" {unit}, allowed 0 to 2 {unit}")), "{told}");
    }
    let told_by_the_box = told("alpha", "").unwrap();
    assert!(told_by_the_box.starts_with("angle of attack"), "{told_by_the_box}");
    // What no flight moves is read where its file holds it.
    assert_eq!(told("gear", ""), None);
}

#[test]
fn a_table_that_is_read_at_its_very_end_is_not_left() {
    let forces = engineless(&with_a_table_by("el", ""), Vector3::ZERO).unwrap();
    let departs = |elevator_deg: f64| {
        let elevator_rad = elevator_deg.to_radians();
        forces.departure(&flow(), &Controls { elevator_rad, ..Controls::default() }).is_some()
    };
    assert_eq!([0.0, 1.0, 2.0].map(departs), [false; 3]);
    assert_eq!([-0.001, 2.001].map(departs), [true; 2]);
    assert_eq!(forces.table_inputs().len(), 1);
}

/// A trim is found within the tables or refused by the one that it would leave.
#[test]
fn a_trim_that_would_read_a_table_beyond_its_data_is_refused_by_it() {
    let centre_of_mass_m = body(25.0).centre_of_mass_m;
    let forces = engineless(&with_a_table_by("el", ""), centre_of_mass_m).unwrap();
    let environment = Environment::uniform(9.8, 1.0, 330.0);
    let aircraft = Aircraft::new(body(25.0).mass, forces, environment).unwrap();
    let failure = aircraft
        .trim(TrimTarget { airspeed_m_s: 61.0, altitude_m: 0.0, flight_path_rad: 0.0 })
        .unwrap_err();
    let limits: Vec<_> = failure.limits.iter().map(ToString::to_string).collect();
    assert!(limits.iter().any(|limit| limit.starts_with("table input el")), "{limits:?}");
}
