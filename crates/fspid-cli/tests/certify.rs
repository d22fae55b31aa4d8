//! `fspid certify --check`, `--against` and `check` of a shipped design, as scripts meet them.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn fspid(arguments: &[&str]) -> Output {
    let program = Command::new(env!("CARGO_BIN_EXE_fspid")).args(arguments).output();
    program.expect("the program starts")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("an exit code")
}

fn out(output: &Output) -> &str {
    std::str::from_utf8(&output.stdout).expect("UTF-8")
}

fn told(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).expect("UTF-8")
}

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

/// A shipped design and its certificate in a folder of their own.
fn design() -> (tempfile::TempDir, PathBuf, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let designs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/designs");
    let copied = |name: &str| {
        let to = folder.path().join(name);
        std::fs::copy(designs.join(name), &to).expect("copied");
        to
    };
    let (scenario, certificate) =
        (copied("b747-paper.toml"), copied("b747-paper.certificate.json"));
    (folder, scenario, certificate)
}

fn replace(path: &Path, from: &str, to: &str) {
    let text = std::fs::read_to_string(path).expect("readable");
    assert!(text.contains(from), "{from}");
    std::fs::write(path, text.replacen(from, to, 1)).expect("written");
}

#[test]
fn a_shipped_design_is_checked_with_its_certificate() {
    let (_folder, scenario, certificate) = design();
    let good = fspid(&["check", text(&scenario)]);
    assert_eq!(code(&good), 0, "{}{}", out(&good), told(&good));
    assert!(out(&good).ends_with("HOLDS, AND IS WHAT FLIES\n"), "{}", out(&good));
    // The gains of the file are edited: the certificate beside it used to say nothing of that.
    replace(&scenario, "kp = 4.0", "kp = 4.25");
    let edited = fspid(&["check", text(&scenario)]);
    assert_eq!(code(&edited), 1, "{}", out(&edited));
    let expected = "controller.gains.kp: certified 4.0, flown 4.25";
    assert!(out(&edited).contains(expected), "{}", out(&edited));
    assert!(told(&edited).contains("about another loop"), "{}", told(&edited));
    // A change that was asked for is told, and is no failure of the file.
    replace(&scenario, "kp = 4.25", "kp = 4.0");
    let asked = fspid(&["check", text(&scenario), "--set", "controller.FSPID.nominal.kp=4.25"]);
    assert_eq!(code(&asked), 0, "{}", told(&asked));
    assert!(told(&asked).contains("warning: "), "{}", told(&asked));
    // An edited name.
    replace(&certificate, "747 pitch hold, proved", "777 pitch hold, proved");
    let named = fspid(&["check", text(&scenario)]);
    assert_eq!(code(&named), 1);
    assert!(out(&named).contains("origin.scenario: certified \"777"), "{}", out(&named));
    assert!(out(&named).contains("content_digest is"), "{}", out(&named));
}

#[test]
fn a_certificate_is_checked_alone_and_against_a_scenario() {
    let (_folder, scenario, certificate) = design();
    let alone = fspid(&["certify", "--check", text(&certificate)]);
    assert_eq!(code(&alone), 0, "{}", told(&alone));
    assert!(out(&alone).ends_with("\nHOLDS\n"), "{}", out(&alone));
    let against = ["certify", "--check", text(&certificate), "--against", text(&scenario)];
    let same = fspid(&against);
    assert_eq!(code(&same), 0, "{}", told(&same));
    // The schema knew two digests alone, and nothing said why there are none.
    let words = [&against[..], &["--format", "json"]].concat();
    let same = crate::common::fspid(&words, Path::new("."));
    let answer = crate::common::json(&same);
    assert!(answer["against"]["digests"].is_null(), "{answer}");
    let why = answer["null"]["digests"].as_str().expect("a reason");
    assert!(why.contains("is the one that was certified"), "{why}");
    let changes = ["--set", "controller.FSPID.nominal.ki=0.3", "--format", "json"];
    let other = fspid(&[&against[..], &changes].concat());
    assert_eq!(code(&other), 1);
    let answer: Value = serde_json::from_str(out(&other)).expect("JSON");
    assert_eq!(answer["holds"], false);
    let differences = answer["against"]["differences"].as_array().expect("a list");
    assert_eq!(differences.len(), 1, "{answer}");
    assert_eq!(differences[0]["path"], "controller.gains.ki");
    let both = fspid(&["certify", text(&scenario), "--check", text(&certificate)]);
    assert_eq!(code(&both), 2);
    assert!(told(&both).contains("--against"), "{}", told(&both));
    let lost = fspid(&["certify", "--check", text(&certificate), "--set", "name=\"x\""]);
    assert_eq!(code(&lost), 2);
    assert!(told(&lost).contains("--against"), "{}", told(&lost));
    // What was advised, a scenario beside both, is refused.
    let alone = fspid(&["certify", "--against", text(&scenario)]);
    assert_eq!(code(&alone), 2);
    assert_eq!(told(&alone), "fspid: `--against` needs `--check CERTIFICATE`\n");
}

/// `certify --out .` names its files by controllers, and `check` was silent about them.
#[test]
fn certificates_in_the_folder_that_name_the_scenario_are_told_by_check() {
    let (folder, scenario, certificate) = design();
    let own = fspid(&["check", text(&scenario)]);
    assert!(!told(&own).contains("not checked"), "{}", told(&own));
    let other = folder.path().join("fspid.certificate.json");
    std::fs::rename(certificate, &other).expect("renamed");
    let checked = fspid(&["check", text(&scenario)]);
    assert_eq!(code(&checked), 0, "{}", told(&checked));
    let expected = format!(
        "1 certificate here names this scenario and is not checked: fspid certify --check {} --against {}\n",
        text(&other),
        text(&scenario)
    );
    assert!(told(&checked).contains(&expected), "{}", told(&checked));
    replace(&scenario, "747 pitch hold, proved", "another");
    let another = fspid(&["check", text(&scenario)]);
    assert!(!told(&another).contains("not checked"), "{}", told(&another));
}

#[test]
fn a_claim_about_nothing_that_flies_ends_with_one_and_without_the_word_holds() {
    let (_folder, _, certificate) = design();
    replace(&certificate, "\"output_factor\": 1.0", "\"output_factor\": 0.0");
    let checked = fspid(&["certify", "--check", text(&certificate)]);
    assert_eq!(code(&checked), 1, "{}", out(&checked));
    assert!(!out(&checked).contains("HOLDS"), "{}", out(&checked));
}

#[test]
fn every_problem_of_a_certificate_stands_behind_its_file() {
    let (_folder, _, certificate) = design();
    replace(&certificate, "\"delay_samples\": 0", "\"delay_samples\": 10000");
    replace(&certificate, "\"divisions\": 24", "\"divisions\": 1000");
    let refused = fspid(&["certify", "--check", text(&certificate)]);
    assert_eq!(code(&refused), 2);
    let lines: Vec<&str> = told(&refused).lines().collect();
    let name = text(&certificate);
    let expected = [
        format!(
            "{name}: loop.actuator.delay_samples: found 10000; allowed are whole numbers from 0 to 128"
        ),
        format!("{name}: divisions: found 1000; allowed are whole numbers from 1 to 96"),
    ];
    assert_eq!(lines, expected);
}

#[test]
fn a_loop_of_too_many_states_is_refused_by_name() {
    let (_folder, scenario, _) = design();
    let delay = ["--set", "actuator.delay_samples=300"];
    let refused = fspid(&[&["certify", text(&scenario)][..], &delay].concat());
    assert_eq!(code(&refused), 1, "{}", told(&refused));
    let expected = "NOT PROVABLE: loop: 308 states";
    assert!(out(&refused).contains(expected), "{}{}", out(&refused), told(&refused));
    // With fixed gains 108 samples took 1.2 GB and more than a minute.
    let (delay, pid) = (["--set", "actuator.delay_samples=108"], ["--controller", "PID"]);
    let refused = fspid(&[&["certify", text(&scenario)][..], &delay, &pid].concat());
    assert_eq!(code(&refused), 1, "{}", told(&refused));
    assert!(out(&refused).contains("allowed are up to 40"), "{}{}", out(&refused), told(&refused));
}

/// The certificate of the plant of the start, which is proved, was told to be what flies.
#[test]
fn a_flight_that_grows_where_the_certificate_does_not_look_is_not_what_is_certified() {
    let (_folder, scenario, certificate) = design();
    let change = "\n[[plant_change]]\nat_s = 10.0\nnumerator = [0.843, 0.00991]\ndenominator = [1.0, 1.17, 1.55, 0.0125, 0.00728]\n";
    let designed = std::fs::read_to_string(&scenario).expect("readable");
    std::fs::write(&scenario, designed + change).expect("written");
    let against = ["certify", "--check", text(&certificate), "--against", text(&scenario)];
    let told = fspid(&against);
    assert_eq!(code(&told), 1, "{}", out(&told));
    let expected = "at_rest: certified stable, flown UNSTABLE while the set-point is held at 0 deg, with the plant from 10 s on";
    assert!(out(&told).contains(expected), "{}", out(&told));
}
