//! Scenario files: what is read, what is refused, and in which words.
#![allow(clippy::float_cmp, reason = "what is read from a file is compared bit by bit")]

mod abuse;
mod arrival;
mod bad_values;
mod messages;
mod overrides;
mod reading;
mod schema;
mod settings;

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

/// Names and texts of the scenarios that come with the program.
pub(crate) fn shipped() -> Vec<(String, String)> {
    let folder =
        std::fs::read_dir(repository("scenarios")).expect("there is a folder of scenarios");
    let mut names: Vec<String> = folder
        .map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".toml"))
        .collect();
    names.sort();
    let read = |name: String| {
        let text = text(&format!("scenarios/{name}"));
        (name, text)
    };
    names.into_iter().map(read).collect()
}
