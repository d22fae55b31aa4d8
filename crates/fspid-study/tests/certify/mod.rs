//! What is certified of scenarios, and what is refused by name.

use std::path::Path;

use fspid_proof::{Asked, LoopDescription, NotProvable, Range};
use fspid_scenario::file::{self, Study};
use fspid_sim::LinearPlant;
use fspid_study::analysis::{Analysis, Question};

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
