//! Control laws: what they want of what they hear, against the formulas of their files.
#![allow(clippy::unwrap_used, reason = "a test")]

use fspid_daveml::flight::{Control, ControlLaw, FlightError, Heard, Wanted};
use fspid_daveml::{Model, read};

const LAW: &str = include_str!("../../../examples/control-law/altitude-and-wings.dml");

const FOOT_M: f64 = 0.3048;

fn model(text: &str) -> Model {
    read(text).unwrap().model
}

fn set() -> Vec<(String, f64)> {
    vec![("altitudeMslCommand".to_owned(), 1015.0), ("trimmedPilotControl_long".to_owned(), -1.5)]
}

fn law() -> ControlLaw {
    ControlLaw::new(model(LAW), &set()).unwrap()
}

/// 1000 ft, 2 deg of pitch, 1 deg/s of pitching, 5 deg of bank, 3 deg/s of rolling; everything else is not heard.
fn heard() -> Heard {
    let deg = 1.0_f64.to_radians();
    Heard {
        airspeed_m_s: f64::NAN,
        equivalent_airspeed_m_s: f64::NAN,
        mach: f64::NAN,
        altitude_m: 1000.0 * FOOT_M,
        alpha_rad: f64::NAN,
        sideslip_rad: f64::NAN,
        attitude_rad: [5.0 * deg, 2.0 * deg, f64::NAN],
        rates_rad_s: [3.0 * deg, deg, f64::NAN],
        right_of_course_m: f64::NAN,
    }
}

fn near(found: f64, expected_deg: f64) {
    assert!((found.to_degrees() - expected_deg).abs() < 1e-12, "{found} is not {expected_deg} deg");
}

#[test]
fn a_law_wants_what_its_formulas_say_of_the_units_of_its_file() {
    let Wanted { elevator_rad, aileron_rad, rudder_rad, power } = law().wanted(&heard());
    // The pitch command is 0.2 · 15 ft = 3 deg.
    near(elevator_rad, -1.5 + 0.6 * (2.0 - 3.0) + 0.3);
    near(aileron_rad.unwrap(), 0.4 * 5.0 + 0.2 * 3.0);
    assert_eq!((rudder_rad, power), (Some(0.0), None));
    let mut law = law();
    law.set("altitudeMslCommand", 2000.0).unwrap();
    near(law.wanted(&heard()).elevator_rad, -1.5 + 0.6 * (2.0 - 4.0) + 0.3);
    law.add("eulerAngle_Pitch", 10.0).unwrap();
    near(law.wanted(&heard()).elevator_rad, -1.5 + 0.6 * (12.0 - 4.0) + 0.3);
}

#[test]
fn a_trim_is_found_where_its_input_leads_there_and_told_where_it_does_not() {
    let mut law = law();
    let stands_rad = -0.12;
    let found =
        law.trim("trimmedPilotControl_long", &heard(), (Control::Elevator, stands_rad)).unwrap();
    assert!((found - (stands_rad.to_degrees() + 0.3)).abs() < 1e-9, "{found}");
    assert!((law.wanted(&heard()).elevator_rad - stands_rad).abs() < 1e-13);
    // This law does not move the elevator with the bank, and has no power.
    let refused = law.trim("eulerAngle_Roll", &heard(), (Control::Elevator, 0.5)).unwrap_err();
    assert!(matches!(refused, FlightError::NoTrim { .. }), "{refused}");
    let power = (Control::Power, 0.5);
    let refused = law.trim("trimmedPilotControl_long", &heard(), power).unwrap_err();
    assert_eq!(refused, FlightError::Output { name: "powerLeverAngle" });
}

#[test]
fn what_does_not_fit_is_told_with_what_does() {
    let refused = |text: &str, set: &[(String, f64)]| {
        ControlLaw::new(model(text), set).unwrap_err().to_string()
    };
    let unset = refused(LAW, &set()[1..]);
    assert!(unset.starts_with("a flight has no `altitudeMslCommand`, and neither"), "{unset}");
    let unknown = refused(LAW, &[set(), vec![("altitude".to_owned(), 1.0)]].concat());
    assert!(
        unknown.starts_with("there is no input `altitude`; the file has altitudeMsl, "),
        "{unknown}"
    );
    let without = refused(&LAW.replace("elevatorDeflection", "stick"), &set());
    assert!(without.starts_with("the output `elevatorDeflection` is missing"), "{without}");
    let units =
        refused(&LAW.replace("varID=\"alt\" units=\"ft\"", "varID=\"alt\" units=\"yd\""), &set());
    assert!(units.contains("`altitudeMsl` is in `yd`; known units for it are m, ft"), "{units}");
    let added = law().add("altitudeMslCommand", 1.0).unwrap_err().to_string();
    assert!(added.starts_with("`altitudeMslCommand` is set"), "{added}");
}

#[test]
fn a_law_does_not_use_the_heap() {
    let (law, heard) = (law(), heard());
    let used = allocation_counter::measure(|| {
        let _ = law.wanted(&heard);
    });
    assert_eq!(used.count_total, 0);
}
