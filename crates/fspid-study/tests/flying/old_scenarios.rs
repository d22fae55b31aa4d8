//! Scenarios of version 0.1.0 still fly, and are answered as they were.
//!
//! `tests/data/of_0_1` holds files as commit 558a6257 of 20 November 2026 had them, and beside each the answer of the program that
//! was built from it (`fspid simulate FILE --format json`, rustc 1.95.0, x86-64). They are never written anew: a number that moves
//! here moves for everybody who kept a scenario, and needs a line under **Numbers** in the changelog and a row of [`OTHERWISE`].

use std::path::{Path, PathBuf};

use fspid_scenario::file;
use fspid_study::simulation::Simulation;
use serde_json::Value;

/// Flights that are judged otherwise since: file, controller, and how the verdict begins. Loops that diverge without an end were
/// judged by their flight alone (errata E-1 and E-2).
const OTHERWISE: [(&str, &str, &str); 2] =
    [("every-key", "fspid isa", "unstable at rest"), ("figure-5", "FSPID", "unstable at rest")];

/// Steps that came into their band less than a tenth of that time before their window ends, and have no time to settle since:
/// file, controller, and how many numbers that are.
const TOO_LATE: [(&str, &str, usize); 1] = [("square-literal", "FSPID", 2)];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/of_0_1")
}

/// Names of the stored scenarios, without their ending.
fn names() -> Vec<String> {
    let entries = std::fs::read_dir(folder()).expect("the stored scenarios");
    let paths = entries.map(|it| it.expect("an entry").path());
    let scenarios = paths.filter(|path| path.extension().is_some_and(|it| it == "toml"));
    let stems = scenarios.map(|it| it.file_stem().and_then(|it| it.to_str()).map(str::to_owned));
    let mut names: Vec<String> = stems.map(|it| it.expect("a name")).collect();
    names.sort();
    names
}

/// Every value of the old answer that the new one has otherwise or not at all, by its path. The new one may tell more.
fn differences(old: &Value, new: &Value, path: &str, found: &mut Vec<String>) {
    match (old, new) {
        (Value::Object(old), Value::Object(new)) => {
            for (key, value) in old {
                let path = format!("{path}.{key}");
                match new.get(key) {
                    Some(now) => differences(value, now, &path, found),
                    None => found.push(format!("{path} is gone")),
                }
            }
        }
        (Value::Array(old), Value::Array(new)) if old.len() == new.len() => {
            for (index, (value, now)) in old.iter().zip(new).enumerate() {
                differences(value, now, &format!("{path}[{index}]"), found);
            }
        }
        _ if old == new => {}
        _ => found.push(format!("{path}: {new}, and was {old}")),
    }
}

/// The answer that was stored, and the one that is given now.
fn answers(name: &str) -> (Value, Value) {
    let study = file::load(&folder().join(format!("{name}.toml")), &[]);
    let study = study.unwrap_or_else(|error| panic!("{name}: {error}"));
    let old = std::fs::read_to_string(folder().join(format!("{name}.json"))).expect("an answer");
    let simulation = Simulation::of(&study).expect("it flies");
    (serde_json::from_str(&old).expect("JSON"), simulation.json())
}

#[test]
fn scenarios_of_the_first_version_fly_and_have_the_answers_of_its_program_to_the_last_digit() {
    let names = names();
    assert_eq!(names.len(), 11, "{names:?}");
    let mut otherwise = 0;
    for name in names {
        let (old, new) = answers(&name);
        let controllers =
            |answer: &Value| answer["controllers"].as_array().expect("a list").clone();
        let (before, now) = (controllers(&old), controllers(&new));
        assert_eq!(before.len(), now.len(), "{name}");
        for (was, is) in before.iter().zip(&now) {
            let known = OTHERWISE.iter().find(|row| row.0 == name && was["name"] == row.1);
            if let Some((_, _, verdict)) = known {
                let says = is["verdict"].as_str().unwrap_or_default();
                assert!(says.starts_with(verdict), "{name}: {is}");
                otherwise += 1;
                continue;
            }
            let mut found = Vec::new();
            differences(was, is, &format!("{name}: {}", was["name"]), &mut found);
            let is_late = |it: &String| {
                ["settling_time_s: null", "transient_time_s: null"]
                    .iter()
                    .any(|end| it.contains(end))
            };
            if let Some((.., late)) =
                TOO_LATE.iter().find(|row| row.0 == name && was["name"] == row.1)
            {
                assert_eq!(found.iter().filter(|it| is_late(it)).count(), *late, "{found:?}");
                found.retain(|it| !is_late(it));
            }
            assert!(found.is_empty(), "{}", found.join("\n"));
        }
        assert_eq!(old["schema"], new["schema"], "{name}");
        assert_eq!(old["scenario"], new["scenario"], "{name}");
    }
    assert_eq!(otherwise, OTHERWISE.len());
}

/// Without this, a value that is gone could pass.
#[test]
fn a_number_that_moves_in_its_last_digit_is_seen_and_one_that_is_new_is_not() {
    let (old, new) = answers("747-pitch-step");
    let mut moved = old.clone();
    let iae = &mut moved["controllers"][0]["metrics"]["iae"];
    *iae = Value::from(iae.as_f64().expect("a number").next_up());
    let mut found = Vec::new();
    differences(&moved, &new, "", &mut found);
    assert_eq!(found.len(), 1, "{found:?}");
    let mut more = new.clone();
    more["new"] = Value::from(1);
    found.clear();
    differences(&old, &more, "", &mut found);
    assert!(found.is_empty(), "{found:?}");
    differences(&more, &old, "", &mut found);
    assert!(!found.is_empty());
}
