//! Flights in sets of a learned self-tuner that remembers, at a condition where they are few sets.

use std::sync::OnceLock;

use serde_json::{Value, json};

use fspid_scenario::file::parse;

use super::file::resealed;
use super::tests::{certified, checked, load, written};

const DESIGN: &str = "data/designs/learned/uav-steps.toml";
const CONDITION: [&str; 3] =
    ["aircraft.name=ultra-stick-25e", "aircraft.airspeed_m_s=13", "aircraft.altitude_m=100"];

/// What is said of it, and its certificate.
fn proved() -> &'static (String, String) {
    static FOUND: OnceLock<(String, String)> = OnceLock::new();
    FOUND.get_or_init(|| {
        let found = certified(&load(DESIGN, &CONDITION));
        assert!(found.all_proved(), "{}", found.text());
        (found.text(), written(&found))
    })
}

/// Not around the trim alone, and with the limits that may act on the way: the steps of 5 deg that it is judged on.
#[test]
fn steps_of_a_learned_self_tuner_that_remembers_are_proved_with_its_limits() {
    let (said, text) = proved();
    let file = checked(text);
    assert!(file.holds());
    let rechecked = file.result.as_ref().expect("holds");
    let stepped = rechecked.stepped.expect("steps are proved");
    assert!((stepped.setpoint_rad.to_degrees() - 5.0).abs() < 1e-12, "{stepped:?}");
    // What is left of a thousandth leaks away with 0.2529 a second.
    let rested_s = stepped.rested_s.expect("gains remember");
    assert!((rested_s - libm::log(1024.0) / 0.2529).abs() < 0.1, "{rested_s}");
    assert!(said.contains("after a rest of"), "{said}");

    // Gains that are said to stay in less than they do, and a model that is said to be nearer than it is.
    let changed = |change: &dyn Fn(&mut Value)| {
        let mut value: Value = serde_json::from_str(text).expect("JSON");
        change(&mut value["steps"]["near_rest"]["gains"]);
        let file = checked(&resealed(&value).expect("a certificate"));
        assert!(!file.holds());
        file.result.as_ref().expect_err("refused").to_string()
    };
    let narrower = changed(&|gains| gains["most"] = gains["least"].clone());
    assert!(narrower.contains("gains that remember"), "{narrower}");
    let nearer = changed(&|gains| gains["model_rad"] = json!(0.0));
    assert!(nearer.contains("not shown to end near its rest"), "{nearer}");
}

/// A load at the servo from 1 s on, a step at 11 s, of any size up to those of the scenario.
#[test]
fn what_its_scenario_commands_is_proved_and_no_other_shape_or_time() {
    let (said, text) = proved();
    let file = checked(text);
    let ended = file.result.as_ref().expect("holds").ended.expect("flights are proved");
    let sizes = [ended.setpoint_rad, ended.load_rad].map(f64::to_degrees);
    assert!((sizes[0] - 5.0).abs() < 1e-12 && (sizes[1] - 1.0).abs() < 1e-12, "{ended:?}");
    assert!(ended.settled_s > 11.0 && ended.settled_s < 25.0, "{ended:?}");
    assert!(said.contains("the set-point over time as commanded"), "{said}");
    // All of it, which is said where it is not.
    assert!(!said.contains("OF LARGER ONES"), "{said}");
    let mut value: Value = serde_json::from_str(text).expect("JSON");
    value["range"]["load_rad"] = json!(0.1);
    let larger = checked(&resealed(&value).expect("a certificate")).text();
    assert!(larger.contains("OF LARGER ONES THIS IS NOT SHOWN"), "{larger}");
    let against = |more: &str| {
        let mut file = file.clone();
        let study = load(DESIGN, &[&CONDITION[..], &[more]].concat());
        file.compare(&study).expect("compared");
        let differences = file.against.expect("compared").differences.into_iter();
        differences.map(|it| format!("{} {}", it.path, it.flown)).collect::<Vec<_>>().join("; ")
    };
    assert_eq!(against("setpoint.amplitude_deg=-4"), "");
    assert_eq!(against("disturbance[0].amplitude_deg=-0.5"), "");
    let later = against("setpoint.at_s=12");
    assert_eq!(
        later,
        "commanded set-point of 5 deg times 1 from 12 s; load at the servo of 1 deg times 1 from 1 s"
    );
    assert!(against("disturbance[0].enters_at=elevator").contains("load at the elevator"));
}

/// A wagon that tips over by itself, with 6 deg of elevator at 12 deg/s.
const TIPS: &str = r#"
schema = 1
name = "tips"
[plant]
numerator = [6.0, 4.0]
denominator = [1.0, 2.0, -1.0, 0.0]
elevator_sign = "nose-up-positive"
[actuator]
time_constant_s = 0.1
position_limit_deg = 6.0
rate_limit_deg_s = 12.0
[loop]
sample_period_s = 0.02
duration_s = 30.0
[setpoint]
kind = "step"
amplitude_deg = 5.0
[[controller]]
name = "FSPID"
kind = "pid"
kp = 1.5
ki = 0.4
kd = 0.5
"#;

/// What `certify` wrote was "about another loop than the scenario flies" for the scenario that it is of.
#[test]
fn a_certificate_of_a_part_of_what_is_commanded_is_that_of_its_scenario_and_says_so() {
    let study_of = |changes: &[&str]| {
        let changes: Vec<String> = changes.iter().map(|it| (*it).to_owned()).collect();
        parse(TIPS, "tips.toml", None, &changes).expect("sound")
    };
    let large = study_of(&["setpoint.amplitude_deg=7"]);
    let mut file = checked(&written(&certified(&large)));
    let ended = file.result.as_ref().expect("holds").ended.expect("flights are proved");
    let degrees = ended.setpoint_rad.to_degrees();
    assert!(degrees > 1.0 && degrees < 6.9, "{degrees}");
    file.compare(&large).expect("compared");
    let against = file.against.clone().expect("compared");
    assert!(against.is_same() && file.holds(), "{against:?}");
    let partly = against.partly.expect("a part is shown");
    assert!(partly.contains("OF LARGER ONES THAN THOSE THIS IS NOT SHOWN"), "{partly}");
    assert!(file.text().contains(&partly));
    // All of a smaller step is shown, and of another time or place nothing.
    file.compare(&study_of(&["setpoint.amplitude_deg=3"])).expect("compared");
    assert_eq!(file.against.clone().expect("compared").partly, None);
    file.compare(&study_of(&["setpoint.amplitude_deg=7", "setpoint.at_s=3"])).expect("compared");
    assert!(!file.against.expect("compared").is_same());
}

#[test]
fn flights_within_what_is_proved_come_to_their_set_point_in_the_simulator() {
    for (step, push) in [(5.0, 1.0), (-5.0, 1.0), (0.03, -1.0), (2.9, 0.4), (-4.1, -0.02)] {
        let sizes = [
            format!("setpoint.amplitude_deg={step}"),
            format!("disturbance[0].amplitude_deg={push}"),
        ];
        let sizes: Vec<&str> = sizes.iter().map(String::as_str).collect();
        let mut scenario = load(DESIGN, &[&CONDITION[..], &sizes].concat()).scenario;
        scenario.surroundings.pitch_sensor = None;
        scenario.surroundings.rate_sensor = None;
        let flight = fspid_sim::simulate(&scenario).expect("flies");
        let named = scenario.controllers.iter().position(|it| it.name == "FSPID").expect("there");
        let theta_rad = flight.traces[named].theta_rad.last().expect("a sample");
        assert!((theta_rad.to_degrees() - step).abs() < 0.05, "{step} {push}: {theta_rad}");
    }
}
