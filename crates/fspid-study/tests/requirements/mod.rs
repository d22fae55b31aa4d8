//! Requirements: what they ask, how they are judged, what the answers look like, what replays them.
#![allow(clippy::float_cmp, reason = "the same bits are asked for")]

mod answers;
mod frozen;
mod intervals;
mod judging;
mod loops;
mod page;
mod replays;
mod sets;
mod short_flights;

use std::path::{Path, PathBuf};

use fspid_scenario::file::{self, Study};
use fspid_scenario::measure::Measure;
use fspid_study::judgement::Judgement;
use fspid_study::simulation::Simulation;
use fspid_study::verify::{Question, Verification, verify};

/// The full 747 of the paper behind its servo: a proportional controller and a self-tuning one.
const JUMBO: &str = r#"
schema = 1
name = "jumbo"
[plant]
preset = "b747-paper"
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.01
duration_s = 20.0
[setpoint]
kind = "step"
amplitude_deg = 5.0
[[controller]]
name = "P"
kind = "pid"
kp = 1.0
[[controller]]
name = "FSPID"
kind = "fspid"
nominal = { kp = 1.33, ki = 1.0, kd = 1.22 }
derivative_filter_s = 0.05
law = "memoryless"
[controller.supervisor]
table = "mirrored"
range = 5.0
error_scale = 1.0
change_scale = 0.2
output_scale = { kp = 0.1, ki = 0.05, kd = 0.05 }
"#;

fn study(text: &str, set: &[&str]) -> Study {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    file::parse(text, "test.toml", None, &set).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Every judgement of a scenario with requirements behind it.
fn judged(text: &str, requirements: &str, set: &[&str]) -> Vec<Judgement> {
    let study = study(&format!("{text}\n{requirements}"), set);
    Simulation::of(&study).expect("it flies").judgements
}

/// The only judgement.
fn one(text: &str, requirement: &str, set: &[&str]) -> Judgement {
    let mut judgements = judged(text, &format!("[[requirement]]\n{requirement}"), set);
    assert_eq!(judgements.len(), 1, "{judgements:?}");
    judgements.remove(0)
}

/// The same for one controller of the jumbo.
fn of(controller: &str, requirement: &str, set: &[&str]) -> Judgement {
    one(JUMBO, &format!("{requirement}\ncontroller = \"{controller}\"\n"), set)
}

/// The value of a measure for the controllers of a scenario, whatever the limit.
fn values(text: &str, measure: Measure, conditions: &str, set: &[&str]) -> Vec<f64> {
    let requirement =
        format!("[[requirement]]\nmeasure = \"{}\"\nleast = 0.0\n{conditions}", measure.name());
    let value = |judgement: &Judgement| match &judgement.found {
        Ok(case) => case.value,
        Err(reason) => panic!("{}: {reason}", judgement.controller),
    };
    judged(text, &requirement, set).iter().map(value).collect()
}

fn repository(path: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

/// A scenario in a file, verified.
fn verified(path: &Path, settings: &[&str], requirement_files: &[&Path]) -> Verification {
    let settings: Vec<String> = settings.iter().map(|&text| text.to_owned()).collect();
    let question = Question { path, settings: &settings, requirement_files };
    verify(&question).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A folder with a file in it.
fn written(text: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scenario.toml");
    std::fs::write(&path, text).expect("written");
    (folder, path)
}
