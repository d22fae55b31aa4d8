//! What is certified of scenarios, and what is refused by name.

use std::path::Path;

use fspid_proof::{Asked, LeftOut, LoopDescription, NotProvable, Range};
use fspid_scenario::file::{self, Study};
use fspid_sim::LinearPlant;
use fspid_study::analysis::{Analysis, Question, not_in_the_linear_loop};

fn study(path: &str, set: &[&str]) -> Study {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(path);
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    file::load(&path, &set).unwrap_or_else(|error| panic!("{error}"))
}

fn described(study: &Study) -> Result<LoopDescription, NotProvable> {
    let scenario = &study.scenario;
    let plant = scenario.plant.aircraft().expect("an aircraft").linear().expect("a linear model");
    LoopDescription::of(scenario, &plant, &scenario.controllers[0].controller)
}

/// It used to be proved, and ends in a limit cycle of ± 0.245 deg from an error of a millionth of a degree.
#[test]
fn a_vertical_gyro_that_erects_is_refused_by_name_and_told_by_analyse() {
    let gallery = "gallery/sensor-vertical-gyro.toml";
    let erecting = study(gallery, &[]);
    assert_eq!(described(&erecting).expect_err("erection"), NotProvable::Erection);
    let question = Question { map_points: 0, ..Question::default() };
    let text = Analysis::of(&erecting, question).expect("a loop").text();
    assert!(text.contains("erection is left out"), "{text}");
    assert!(described(&study(gallery, &["sensor.pitch.erection_deg_min=0"])).is_ok());
}

fn asked(study: &Study) -> Range {
    let scenario = &study.scenario;
    let plant = scenario.plant.linear().expect("a linear plant");
    let description = described_with(study, plant);
    Asked::of(scenario, plant, &description).range
}

fn described_with(study: &Study, plant: &LinearPlant) -> LoopDescription {
    let controller = &study.scenario.controllers[0].controller;
    LoopDescription::of(&study.scenario, plant, controller).expect("provable")
}

/// A step ten seconds after the end of the flight was no part of what was asked, and the claim is about all time.
#[test]
fn set_points_and_loads_that_begin_after_the_flight_are_in_the_range_that_is_asked() {
    let later = ["setpoint.amplitude_deg=-20", "setpoint.at_s=30"];
    let range = asked(&study("747-pitch-step.toml", &later));
    assert!((range.setpoint_rad - 20.0_f64.to_radians()).abs() < 1e-12, "{range:?}");
    assert_eq!(range.load_rad.to_bits(), 0.0_f64.to_bits());
    // And nothing is no negative nothing.
    let still = asked(&study("747-pitch-step.toml", &["setpoint.amplitude_deg=0"]));
    assert_eq!(still.setpoint_rad.to_bits(), 0.0_f64.to_bits());
}

const SERVO: &str = r#"
schema = 1
name = "loads"
[plant]
preset = "navion-full"
[actuator]
time_constant_s = 0.1
position_limit_deg = 20.0
[loop]
sample_period_s = 0.02
duration_s = 60.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
[[disturbance]]
enters_at = "servo"
kind = "step"
amplitude_deg = 19.5
at_s = 5.0
[[disturbance]]
enters_at = "elevator"
kind = "step"
amplitude_deg = -19.5
at_s = 5.0
[[controller]]
name = "PID"
kind = "pid"
kp = 1.0
ki = 0.5
kd = 0.2
"#;

fn parsed(text: &str, set: &[&str]) -> Study {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    file::parse(text, "loop.toml", None, &set).unwrap_or_else(|error| panic!("{error}"))
}

/// The controller does not see it, and the servo went to its limit for ever.
#[test]
fn a_load_at_the_elevator_is_held_by_the_servo_whatever_acts_before_it() {
    let load_deg = |set: &[&str]| asked(&parsed(SERVO, set)).load_rad.to_degrees();
    assert!((load_deg(&[]) - 19.5).abs() < 1e-9, "{}", load_deg(&[]));
    // The controller holds both.
    let same = load_deg(&["disturbance[1].amplitude_deg=3.0"]);
    assert!((same - 22.5).abs() < 1e-9, "{same}");
    // One at the servo alone is none of the servo's.
    let alone = load_deg(&["disturbance[1].amplitude_deg=0.0"]);
    assert!((alone - 19.5).abs() < 1e-9, "{alone}");
}

/// The pitch is off by what the sensor has to be off to show so, and the elevator holds that.
#[test]
fn an_offset_of_the_measured_pitch_is_a_pitch_that_shows_so() {
    let offset =
        "disturbance=[{enters_at='measurement', kind='step', amplitude_deg=-1.0, at_s=1.0}]";
    let load = |scale: f64| {
        let sensor = format!("sensor={{preset='ideal', pitch={{scale_error_pct={scale:?}}}}}");
        asked(&parsed(SERVO, &[offset, &sensor])).load_rad
    };
    let [plain, fifth] = [load(0.0), load(-80.0)];
    assert!(plain > 0.0 && (fifth / plain - 5.0).abs() < 1e-9, "{fifth} of {plain}");
}

fn left_out(study: &Study) -> Vec<LeftOut> {
    let scenario = &study.scenario;
    let plant = scenario.plant.linear().expect("a linear plant");
    Asked::of(scenario, plant, &described_with(study, plant)).left_out
}

#[test]
fn what_a_sensor_shows_wrongly_at_rest_is_named_beside_the_claim() {
    let is_named = |set: &str| left_out(&parsed(SERVO, &[set])).contains(&LeftOut::SeenPitch);
    assert!(!is_named("loop.duration_s=60.0"));
    assert!(is_named("sensor={preset='ideal', pitch={scale_error_pct=2.0}}"));
    assert!(is_named("sensor={preset='ideal', pitch={bias_deg=0.1}}"));
    assert!(is_named("disturbance[0].enters_at='measurement'"));
}

/// A loop with a sensor half of 0.25 s late was proved, and with the sensor's own motion between the samples it grows.
#[test]
fn a_sensor_that_is_late_by_part_of_a_sample_and_a_plant_that_changes_bit_by_bit_are_named() {
    let late = |delay: &str| format!("sensor={{preset='ideal', pitch={{delay_s={delay}}}}}");
    let [part, whole] = [late("0.03"), late("0.04")].map(|set| parsed(SERVO, &[&set]));
    let is_named = |study: &Study| left_out(study).contains(&LeftOut::BetweenSamples);
    assert!(is_named(&part) && !is_named(&whole));
    let told = |study: &Study| not_in_the_linear_loop(&study.scenario).join("\n");
    assert!(told(&part).contains("no whole number of samples"), "{}", told(&part));
    assert!(!told(&whole).contains("no whole number of samples"), "{}", told(&whole));
    let change = |ramp_s: f64| {
        let change = "[[plant_change]]\nat_s = 5.0\npreset = \"navion-full\"\n";
        told(&parsed(&format!("{SERVO}{change}ramp_s = {ramp_s:?}\n"), &[]))
    };
    let [ramp, jump] = [change(2.0), change(0.0)];
    assert!(
        ramp.contains("passes plants that are not asked") && !jump.contains("passes"),
        "{ramp}"
    );
}
