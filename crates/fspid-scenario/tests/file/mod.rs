//! Scenario files: what is read, what is refused, and in which words.
#![allow(clippy::float_cmp, reason = "what is read from a file is compared bit by bit")]

mod abuse;
mod arrival;
mod bad_values;
mod cases;
mod contests;
mod dispersions;
mod marks;
mod messages;
mod network;
mod numbers;
mod overrides;
mod reading;
mod renamed;
mod schedule;
mod schema;
mod settings;
mod words;

use std::path::PathBuf;

/// A file of the repository.
pub(crate) fn repository(path: &str) -> PathBuf {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.join(path)
}

/// The text of a file of the repository.
pub(crate) fn text(path: &str) -> String {
    std::fs::read_to_string(repository(path)).expect("the file is part of the repository")
}

/// Names and texts of the scenarios that come with the program, those of the gallery too.
pub(crate) fn shipped() -> Vec<(String, String)> {
    let mut names = scenarios_in("");
    names.extend(scenarios_in("gallery/"));
    names.extend(scenarios_in("tuning/"));
    names.extend(scenarios_in("contest/"));
    let read = |name: String| {
        let text = text(&format!("scenarios/{name}"));
        (name, text)
    };
    names.into_iter().map(read).collect()
}

/// Names and texts of the scenarios with marks.
pub(crate) fn marked() -> Vec<(String, String)> {
    let named = |name: String| (name.clone(), text(&format!("scenarios/{name}")));
    let names = scenarios_in("tuning/").into_iter().chain(scenarios_in("contest/"));
    names.map(named).collect()
}

/// Names of the scenarios in a folder of `scenarios`, in order, with the folder.
fn scenarios_in(folder: &str) -> Vec<String> {
    let entries = std::fs::read_dir(repository("scenarios").join(folder)).expect("a folder");
    let names = entries.map(|entry| entry.expect("readable").file_name());
    let names = names.map(|name| format!("{folder}{}", name.to_string_lossy()));
    let mut names: Vec<String> = names.filter(|name| name.ends_with(".toml")).collect();
    names.sort();
    names
}
