//! Gains by dynamic pressure: the factor, what it acts on, and what is refused.

use fspid_core::Gains;
use fspid_scenario::file::{self, GainSource, Study};

/// A Navion 1000 m above the sea.
const NAVION: &str = r#"
schema = 1
name = "scheduled"
[aircraft]
name = "navion"
airspeed_m_s = 60.0
altitude_m = 1000.0
model = "linear"
[loop]
sample_period_s = 0.01
duration_s = 1.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
at_s = 0.0
[[controller]]
name = "PID"
kind = "pid"
kp = 0.8
ki = 0.4
kd = 0.2
rate_gain = 0.1
derivative_filter_s = 0.05
schedule = { dynamic_pressure_pa = 1000.0, exponent = -1.0 }
[[controller]]
name = "P"
kind = "p"
kp = 0.8
rate_gain = 0.1
schedule = { dynamic_pressure_pa = 1000.0 }
"#;

/// Density at a geopotential altitude of 1000 m, kg/m³: ISO 2533 (1975), to its six digits.
const DENSITY_1000_M: f64 = 1.11164;

fn study(text: &str, set: &[&str]) -> Study {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    file::parse(text, "test.toml", None, &set).unwrap_or_else(|problems| panic!("{problems}"))
}

fn problems(text: &str, set: &[&str]) -> String {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    let problems = file::parse(text, "test.toml", None, &set).expect_err("it is wrong");
    problems.to_string()
}

/// The factor and pressure of the first controller.
fn factor(study: &Study) -> (f64, f64) {
    match study.derived_gains.first().expect("it is scheduled").source {
        GainSource::Schedule { dynamic_pressure_pa, factor, .. } => (factor, dynamic_pressure_pa),
        GainSource::Regulator => panic!("it is a schedule"),
    }
}

#[test]
fn every_gain_falls_as_the_dynamic_pressure_rises() {
    let study = study(NAVION, &[]);
    let (factor, pressure_pa) = factor(&study);
    let expected_pa = 0.5 * DENSITY_1000_M * 60.0 * 60.0;
    // The last digit of the table is worth 5e-6 of the density.
    assert!((pressure_pa / expected_pa - 1.0).abs() < 5e-6, "{pressure_pa} for {expected_pa}");
    assert!((factor - 1000.0 / pressure_pa).abs() < 1e-15, "{factor}");
    for named in &study.scenario.controllers {
        let (gains, config) = (named.controller.nominal(), named.controller.config());
        let (ki, kd) = if named.name == "P" { (0.0, 0.0) } else { (0.4, 0.2) };
        assert_eq!(gains, Gains { kp: 0.8 * factor, ki: ki * factor, kd: kd * factor });
        assert_eq!(config.rate_gain_s, 0.1 * factor);
    }
    assert_eq!(study.scenario.controllers[0].controller.config().derivative.filter_s, 0.05);
    let of_p = &study.derived_gains[1];
    assert_eq!((of_p.controller.as_str(), of_p.rate_gain_s), ("P", 0.1 * factor));
}

#[test]
fn gains_in_isa_form_are_scheduled_with_their_times_untouched() {
    let isa = "isa = { gain = 0.8, ti_s = 2.0, td_s = 0.25, n = 5.0 }";
    let text = NAVION.replacen("kp = 0.8\nki = 0.4\nkd = 0.2\n", &format!("{isa}\n"), 1).replacen(
        "derivative_filter_s = 0.05\n",
        "",
        1,
    );
    let study = study(&text, &[]);
    let (factor, _) = factor(&study);
    let controller = &study.scenario.controllers[0].controller;
    assert_eq!(
        controller.nominal(),
        Gains { kp: 0.8 * factor, ki: 0.4 * factor, kd: 0.2 * factor }
    );
    assert_eq!(controller.config().derivative.filter_s, 0.05);
}

#[test]
fn another_exponent_is_another_power_and_none_at_the_pressure_itself() {
    let (whole, pressure_pa) = factor(&study(NAVION, &[]));
    let set = |value: &str| format!("controller.PID.schedule.exponent={value}");
    let (root, _) = factor(&study(NAVION, &[&set("-0.5")]));
    assert!((root * root / whole - 1.0).abs() < 1e-15, "{root}");
    assert_eq!(factor(&study(NAVION, &[&set("0.0")])).0, 1.0);
    let there = format!("controller.PID.schedule.dynamic_pressure_pa={pressure_pa:?}");
    assert_eq!(factor(&study(NAVION, &[&there])).0, 1.0);
}

#[test]
fn limits_hold_the_factor() {
    let key = |name: &str| format!("controller.PID.schedule.{name}");
    let (most, least) = (key("most_factor=0.25"), key("least_factor=0.9"));
    assert_eq!(factor(&study(NAVION, &[&most])).0, 0.25);
    assert_eq!(factor(&study(NAVION, &[&least])).0, 0.9);
    let text = problems(NAVION, &[&most, &least]);
    assert!(text.contains("schedule.most_factor: below `least_factor`"), "{text}");
    // Beyond what a number can hold, the limits are what remains.
    let steep = key("exponent=5000.0");
    assert_eq!(factor(&study(NAVION, &[&steep, &most])).0, 0.25);
    let text = problems(NAVION, &[&steep]);
    assert!(text.contains("schedule.exponent: the gains would be multiplied by inf"), "{text}");
    let text = problems(NAVION, &[&key("exponent=-5000.0")]);
    assert!(text.contains("multiplied by 0.0"), "{text}");
}

#[test]
fn the_linear_and_the_nonlinear_aircraft_are_scheduled_alike() {
    let linear = study(NAVION, &[]);
    let nonlinear = study(NAVION, &["aircraft.model=\"nonlinear\""]);
    assert_eq!(linear.derived_gains, nonlinear.derived_gains);
    let knots = NAVION.replace("airspeed_m_s = 60.0", "airspeed_kt = 116.63066954643629");
    let (in_knots, in_metres) = (factor(&study(&knots, &[])).0, factor(&linear).0);
    assert!((in_knots / in_metres - 1.0).abs() < 1e-14, "{in_knots}");
}

#[test]
fn a_plant_of_coefficients_cannot_be_scheduled_by() {
    let aircraft = NAVION.split("[aircraft]").nth(1).and_then(|rest| rest.split("[loop]").next());
    let text = NAVION.replace(aircraft.expect("it is there"), "\npreset = \"navion-paper\"\n");
    let text = problems(&text.replace("[aircraft]", "[plant]"), &[]);
    for index in 0..2 {
        let expected = format!("controller[{index}].schedule: a `plant` has no dynamic pressure");
        assert!(text.contains(&expected), "{text}");
    }
}

#[test]
fn an_aircraft_that_cannot_be_trimmed_is_the_only_problem() {
    let text = problems(NAVION, &["aircraft.airspeed_m_s=2.0"]);
    assert!(text.contains("aircraft.airspeed_m_s") && !text.contains("schedule"), "{text}");
}

#[test]
fn a_controller_without_a_schedule_has_nothing_to_derive() {
    let bare = NAVION
        .replace("schedule = { dynamic_pressure_pa = 1000.0, exponent = -1.0 }\n", "")
        .replace("schedule = { dynamic_pressure_pa = 1000.0 }\n", "");
    let study = study(&bare, &[]);
    assert!(study.derived_gains.is_empty());
    assert_eq!(study.scenario.controllers[0].controller.nominal().kp, 0.8);
}
