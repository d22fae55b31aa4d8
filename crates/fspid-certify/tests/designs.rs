//! The shipped designs: each flies as it says, and its certificate is of this very loop and holds.

use std::path::{Path, PathBuf};

use fspid_certify::{check_text, from_text};
use fspid_proof::LoopDescription;
use fspid_scenario::file::{self, Study};
use fspid_study::simulation::Simulation;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/designs")
}

/// Every design with the text of its certificate.
fn designs() -> Vec<(PathBuf, Study, String)> {
    let entries = std::fs::read_dir(folder()).expect("the folder is there");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("readable").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    paths.sort();
    let with_certificate = |path: PathBuf| {
        let study = file::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
        let certificate = path.with_extension("certificate.json");
        let text = std::fs::read_to_string(certificate).expect("a certificate beside the design");
        (path, study, text)
    };
    paths.into_iter().map(with_certificate).collect()
}

#[test]
fn there_is_a_design_for_each_plant_of_the_paper() {
    let names: Vec<String> = designs()
        .iter()
        .map(|(path, ..)| path.file_stem().expect("a name").to_string_lossy().into_owned())
        .collect();
    for plant in ["b747-paper", "navion-paper"] {
        assert!(names.iter().any(|name| name == plant), "{plant}");
    }
}

#[test]
fn every_certificate_holds_and_is_about_the_loop_beside_it() {
    for (path, study, text) in designs() {
        let checked = check_text(&text).unwrap_or_else(|error| panic!("{path:?}: {error}"));
        assert!(checked.result.is_ok(), "{path:?}: {:?}", checked.result);
        assert!(checked.certificate.claim.is_of_stability(), "{path:?}");
        let whole = checked.certificate.output_factor.to_bits() == 1.0_f64.to_bits();
        assert!(whole, "{path:?}: of the output scale as it is");
        let scenario = &study.scenario;
        let named =
            scenario.controllers.iter().find(|named| named.name == checked.origin.controller);
        let plant = scenario.plant.linear().expect("a linear plant");
        let controller = &named.expect("the controller of the certificate").controller;
        let described = LoopDescription::of(scenario, plant, controller).expect("provable");
        assert_eq!(described, checked.certificate.description, "{path:?}");
        assert_eq!(study.digest, checked.origin.digest, "{path:?}");
    }
}

#[test]
fn every_design_settles_within_5_s_with_gains_that_move_by_a_fifth() {
    for (path, study, text) in designs() {
        let (_, origin) = from_text(&text).expect("a certificate");
        let simulation = Simulation::of(&study).expect("it flies");
        assert!(simulation.requirements_met(), "{path:?}: {:?}", simulation.judgements);
        let result = simulation.result(&origin.controller).expect("it was flown");
        let settling_s = result.metrics.first_step().settling_time_s.expect("settled");
        assert!(settling_s <= 5.0, "{path:?}: {settling_s}");
        let named = study.scenario.controllers.iter().find(|c| c.name == origin.controller);
        let nominal = named.expect("the controller").controller.nominal();
        let gains = &result.trace.gains;
        let moves = [
            gains.iter().map(|g| (g.kp / nominal.kp - 1.0).abs()).fold(0.0, f64::max),
            gains.iter().map(|g| (g.ki / nominal.ki - 1.0).abs()).fold(0.0, f64::max),
            gains.iter().map(|g| (g.kd / nominal.kd - 1.0).abs()).fold(0.0, f64::max),
        ];
        assert!(moves.iter().all(|share| *share >= 0.2), "{path:?}: {moves:?}");
    }
}

#[test]
fn a_certificate_of_another_loop_does_not_hold() {
    for (path, _, text) in designs() {
        // Twenty times the output scale: gains far beyond what was proved.
        let from = text.find("\"output_scale\": {").expect("an output scale");
        let kp = from + text[from..].find("\"kp\": ").expect("a gain") + "\"kp\": ".len();
        let end = kp + text[kp..].find([',', '\n']).expect("its end");
        let value: f64 = text[kp..end].parse().expect("a number");
        let tampered = format!("{}{}{}", &text[..kp], 20.0 * value, &text[end..]);
        let checked = check_text(&tampered).expect("still a certificate");
        assert!(checked.result.is_err(), "{path:?}");
    }
}

/// Schema 1 did not say for which set-points a certificate is made, and its loop left out what gains that move
/// make of the command.
#[test]
fn a_certificate_of_schema_1_is_refused_with_the_reason() {
    for (path, _, text) in designs() {
        let old = text.replace("\"schema\": 2", "\"schema\": 1");
        let told = from_text(&old).expect_err("an old certificate");
        assert!(told.to_string().contains("anew"), "{path:?}: {told}");
    }
}
