//! What may stand in a product, where tables end, which units are known.

use super::class::{Class, Share};
use super::*;

const INVENTED: &str = include_str!("../../tests/data/jsbsim/invented.xml");

const PRESSURE: Class = Class { pressure: true, rate: Share::None, control: false };
const RATE: Class = Class { pressure: false, rate: Share::Proportional, control: false };
const SURFACE: Class = Class { pressure: false, rate: Share::None, control: true };

#[test]
fn a_product_has_the_pressure_once_and_the_rate_once_and_no_surface_beside_the_rate() {
    let load = Class::product(&[PRESSURE, RATE, Class::default()]).expect("a load");
    assert!(load.pressure && load.rate == Share::Proportional);
    assert!(Class::product(&[PRESSURE, PRESSURE]).is_err());
    assert!(Class::product(&[RATE, RATE]).is_err());
    assert!(Class::product(&[RATE, SURFACE]).is_err());
    assert!(Class::product(&[PRESSURE, SURFACE]).expect("a load").control);
}

#[test]
fn a_sum_has_the_pressure_in_each_term_or_in_none() {
    assert!(Class::sum(&[PRESSURE, Class::default()]).is_err());
    assert_eq!(Class::sum(&[RATE, Class::default()]).expect("a sum").rate, Share::Linear);
    // A surface beside the rate is no factor of it.
    let both = Class::sum(&[RATE, SURFACE]).expect("a sum");
    assert!(Class::product(&[both, PRESSURE]).is_ok() && Class::product(&[both, SURFACE]).is_err());
}

#[test]
fn neither_pressure_nor_rate_stands_inside_of_a_function_or_under_a_quotient() {
    assert!(Class::function(&[PRESSURE]).is_err() && Class::function(&[RATE]).is_err());
    assert!(Class::quotient(Class::default(), PRESSURE).is_err());
    assert!(Class::quotient(PRESSURE, SURFACE).expect("a load").pressure);
}

fn invented() -> JsbsimAircraft {
    read(INVENTED, &Assumptions::default()).expect("an aircraft")
}

#[test]
fn the_box_is_that_of_the_tables_and_a_table_of_two_lines_does_not_narrow_it() {
    let (_, forces) = invented().flies().expect("it flies");
    let validity = *fspid_aircraft::ForceModel::validity(&forces);
    assert!((validity.alpha_rad.min + 0.09).abs() < 1e-12);
    assert!((validity.alpha_rad.max - 0.30).abs() < 1e-12);
    assert!((validity.beta_rad.max - 0.35).abs() < 1e-12);
    assert!((validity.mach.min, validity.mach.max) == (0.0, 1.8));
}

#[test]
fn stops_are_those_of_the_flight_control_system_with_its_gain_and_else_assumed() {
    let Stops { elevator, aileron, rudder } = invented().stops;
    assert!((elevator.0 + 28.0 * 0.01745 * 57.295_779_513).abs() < 1e-5);
    assert!(elevator.1 > 22.9 && elevator.1 < 23.0);
    assert_eq!((aileron, rudder), ((-25.0, 25.0), (-25.0, 25.0)));
}

#[test]
fn everything_that_was_assumed_is_noted_once() {
    let notes: Vec<String> = invented().notes.iter().map(|note| note.message.clone()).collect();
    for words in [
        "engines are no tables and are left out",
        "no range of fcs/left-aileron-pos-rad is found",
        "180 lb of fuel stay in the tanks",
        "<alphalimits> is left out",
        "aero/h_b-mac-ft is held at 100",
        "aero/stall-hyst-norm is held at 0",
        "aero/cl-squared is the square of the lift without its part by the rate",
        "1 table(s) of two lines by aero/alpha-rad are continued",
        "1 table(s) of two lines by velocities/mach are continued",
        "flown as symmetric",
    ] {
        let count = notes.iter().filter(|note| note.contains(words)).count();
        assert_eq!(count, 1, "{words}: {notes:#?}");
    }
}
