//! What is certified of scenarios, and what is refused by name.

use std::path::Path;

use fspid_proof::{LoopDescription, NotProvable};
use fspid_study::analysis::{Analysis, Question};
use fspid_study::file::{self, Study};

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
