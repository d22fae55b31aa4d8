//! What is outside of the subset or wrong is refused, with its place and what would be right.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test")]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Each file in `tests/data/refused` with the sentences about it, as recorded in `tests/data/refused.txt`.
#[test]
fn each_mistake_is_refused_with_its_place_and_what_would_be_right() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let mut files: Vec<_> =
        fs::read_dir(folder.join("refused")).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let mut sentences = String::new();
    for file in &files {
        let text = fs::read_to_string(file).unwrap();
        let problems = fspid_daveml::read(&text).expect_err("the file is wrong");
        writeln!(sentences, "{}\n{problems}\n", file.file_stem().unwrap().display()).unwrap();
    }
    let recorded = fs::read_to_string(folder.join("refused.txt")).unwrap();
    assert_eq!(
        sentences, recorded,
        "if this is meant, write it to tests/data/refused.txt:\n{sentences}"
    );
}
