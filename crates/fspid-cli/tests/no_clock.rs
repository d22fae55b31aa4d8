//! No test depends on time: on a busy machine `cargo test --workspace` failed because one compared
//! wall times. Work is counted, speed is benched, and what is waited for is waited for without end.

use std::fs;
use std::path::{Path, PathBuf};

/// What a test would ask for the time with, or stop waiting by. In halves: this file is looked at too.
const CLOCKS: [(&str, &str); 6] = [
    ("Instant", "::now"),
    ("System", "Time"),
    (".elaps", "ed("),
    ("recv_", "timeout("),
    ("wait_", "timeout("),
    ("park_", "timeout("),
];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry")) {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
}

/// What of a file is compiled for tests only.
fn for_tests<'t>(path: &Path, text: &'t str) -> &'t str {
    let tests = path.components().any(|part| part.as_os_str() == "tests");
    if tests || path.file_name().is_some_and(|name| name == "tests.rs") {
        return text;
    }
    text.find("#[cfg(test)]\nmod tests {").map_or("", |begin| &text[begin..])
}

#[test]
fn no_test_of_the_workspace_asks_what_time_it_is() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = Vec::new();
    for one in fs::read_dir(&crates).expect("the workspace").map(|one| one.expect("a crate")) {
        for part in ["src", "tests"].map(|part| one.path().join(part)) {
            if part.is_dir() {
                sources(&part, &mut found);
            }
        }
    }
    assert!(found.len() > 500, "{} files", found.len());
    for path in found {
        let text = fs::read_to_string(&path).expect("a text");
        for (first, second) in CLOCKS {
            let clock = [first, second].concat();
            let asked = for_tests(&path, &text).contains(&clock);
            assert!(!asked, "{} asks for the time: `{clock}`", path.display());
        }
    }
}
