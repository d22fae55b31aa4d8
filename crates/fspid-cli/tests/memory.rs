//! `--max-memory`: what needs more is not begun, what grows beyond stops, and nothing is lost by it.

use std::path::Path;

use crate::common::{code, fspid, json, text};

const STEP: &str = "scenarios/747-pitch-step.toml";

/// What flies is read where the repository has it.
fn in_repository(arguments: &[&str]) -> std::process::Output {
    fspid(arguments, &Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."))
}

#[test]
fn a_flight_that_needs_more_memory_is_not_begun() {
    let long = ["simulate", STEP, "--set", "loop.duration_s=40000", "--max-memory", "512MiB"];
    let refused = in_repository(&long);
    let told = text(&refused.stderr);
    assert_eq!(code(&refused), 2, "{told}");
    assert!(
        told.contains("flights of 4 000 001 samples on 1 thread")
            && told.contains("--max-memory allows 512 MiB"),
        "{told}"
    );
    let asked = in_repository(&["simulate", STEP, "--max-memory", "512MiB"]);
    assert_ne!(code(&asked), 2, "{}", text(&asked.stderr));
}

#[test]
fn threads_that_have_no_flight_need_no_memory() {
    let search = |budget: &str| {
        let flights = ["--measure", "iae_deg_s", "--budget", budget, "--threads", "256"];
        let words = ["campaign", "search", "scenarios/campaign.toml", "--max-memory", "200MiB"];
        in_repository(&[&words[..], &flights[..]].concat())
    };
    let refused = search("2000");
    assert_eq!(code(&refused), 2);
    assert!(text(&refused.stderr).contains("on 250 threads"), "{}", text(&refused.stderr));
    let flown = search("8");
    assert_eq!(code(&flown), 0, "{}", text(&flown.stderr));
}

#[test]
fn a_program_that_grows_too_large_says_so_and_ends() {
    // Less than the program itself has, and of a proof nothing is known before.
    let words = ["certify", "scenarios/campaign.toml", "--max-memory", "1MiB", "--format", "json"];
    let ended = in_repository(&words);
    assert_eq!(code(&ended), 130, "{}", text(&ended.stderr));
    let answer = json(&ended);
    let told = answer["error"]["message"].as_str().expect("a message");
    assert!(
        told.contains("the program has grown to") && told.contains("--max-memory allows 1 MiB"),
        "{told}"
    );
}

#[test]
fn a_size_that_is_none_is_refused_with_what_is_one() {
    let refused = in_repository(&["simulate", STEP, "--max-memory", "lots"]);
    assert_eq!(code(&refused), 2);
    assert!(text(&refused.stderr).contains("such as 512MiB"), "{}", text(&refused.stderr));
}
