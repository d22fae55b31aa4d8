//! `fspid verify` as people and scripts meet it.

use std::path::Path;
use std::process::{Command, Output};

use fspid_scenario::measure::Measure;
use fspid_scenario::requirement::SET_NAMES;
use serde_json::Value;

fn fspid(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fspid"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("an exit code")
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

/// A folder with the starter, whose self-tuning controller has the plain one's gains.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let made = fspid(&["init", "pitch.toml"], folder.path());
    assert_eq!(code(&made), 0);
    folder
}

const OURS: &str = "[[requirement]]\nmeasure = \"phase_margin_deg\"\nleast = 45.0\n[[requirement]]\nmeasure = \"overshoot_pct\"\nmost = 99.0\n";

fn with_ours() -> tempfile::TempDir {
    let folder = folder();
    std::fs::write(folder.path().join("ours.toml"), OURS).expect("written");
    folder
}

#[test]
fn all_met_ends_with_nought_and_one_that_is_not_with_one() {
    let folder = with_ours();
    let met = fspid(&["verify", "pitch.toml", "--requirements", "ours.toml"], folder.path());
    assert_eq!(code(&met), 0, "{}{}", text(&met.stdout), text(&met.stderr));
    assert!(text(&met.stdout).ends_with("\n4 of 4 requirements met; PASS\n"));
    assert_eq!(text(&met.stderr), "");
    let strict = OURS.replace("45.0", "89.0");
    std::fs::write(folder.path().join("ours.toml"), strict).expect("written");
    let unmet = fspid(&["verify", "pitch.toml", "--requirements", "ours.toml"], folder.path());
    assert_eq!(code(&unmet), 1);
    assert!(text(&unmet.stdout).ends_with("; FAIL\n"), "{}", text(&unmet.stdout));
    assert!(text(&unmet.stderr).contains("of 4 requirements not met"));
}

#[test]
fn a_requirement_that_cannot_be_evaluated_ends_with_one() {
    let folder = folder();
    // A ready set brings its own step; a line that is written out chooses among the steps there are.
    let ours = "[[requirement]]\nmeasure = \"overshoot_pct\"\nmost = 10.0\nstep_deg = 11.46\n";
    std::fs::write(folder.path().join("ours.toml"), ours).expect("written");
    let output = fspid(&["verify", "pitch.toml", "--requirements", "ours.toml"], folder.path());
    assert_eq!(code(&output), 1);
    let told = text(&output.stdout);
    assert!(
        told.contains("the command has no step of 11.46 deg; its steps are of 5 deg"),
        "{told}"
    );
    let output = fspid(&["verify", "pitch.toml", "--set", "ctms"], folder.path());
    assert!(!text(&output.stdout).contains("not evaluated"), "{}", text(&output.stdout));
}

#[test]
fn wrong_input_ends_with_two_and_says_what_would_be_right() {
    let folder = folder();
    let told = |arguments: &[&str]| {
        let output = fspid(arguments, folder.path());
        assert_eq!((code(&output), output.stdout.len()), (2, 0), "{arguments:?}");
        text(&output.stderr).to_owned()
    };
    let nothing = told(&["verify", "pitch.toml"]);
    assert!(nothing.contains("nothing is required of it") && nothing.contains("[[requirement]]"));
    let unknown = told(&["verify", "pitch.toml", "--set", "mil-f-9490"]);
    assert!(unknown.contains("did you mean \"mil-f-9490d\"?"), "{unknown}");
    let missing = told(&["verify", "pitch.toml", "--requirements", "none.toml"]);
    assert!(missing.contains("none.toml: cannot be read: there is no such file"), "{missing}");
    assert!(told(&["verify", "nowhere.toml", "--set", "ctms"]).contains("nowhere.toml"));
    assert!(told(&["verify"]).contains("<FILE>"));
    std::fs::write(folder.path().join("ours.toml"), "[[requirement]]\nmeasure = 3\nmost = 1\n")
        .expect("written");
    let wrong = told(&["verify", "pitch.toml", "--requirements", "ours.toml"]);
    assert!(wrong.contains("ours.toml:2:11: requirement[0].measure: wrong type"), "{wrong}");
}

#[test]
fn outputs_that_cannot_be_written_end_with_four() {
    let folder = with_ours();
    let asked = ["verify", "pitch.toml", "--requirements", "ours.toml"];
    let of = |more: &[&str]| fspid(&[&asked[..], more].concat(), folder.path());
    let junit = of(&["--junit", "missing/out.xml"]);
    assert_eq!(code(&junit), 4, "{}", text(&junit.stderr));
    assert!(text(&junit.stderr).contains("missing/out.xml"));
    std::fs::write(folder.path().join("in-the-way"), "old").expect("written");
    let replay = of(&["--replay", "in-the-way"]);
    assert_eq!(code(&replay), 4, "{}", text(&replay.stderr));
    assert_eq!(std::fs::read_to_string(folder.path().join("in-the-way")).expect("there"), "old");
}

#[test]
fn a_replay_gives_the_number_of_its_line_again() {
    let folder = with_ours();
    let asked =
        ["verify", "pitch.toml", "--requirements", "ours.toml", "--format", "json", "--replay"];
    let output = fspid(&asked, folder.path());
    let answer: Value = serde_json::from_str(text(&output.stdout)).expect("JSON");
    let lines = answer["requirements"].as_array().expect("a list");
    assert_eq!(lines.len(), 4);
    for line in lines {
        let path = line["replay"].as_str().expect("a file");
        assert!(path.starts_with("verify-replay"), "{path}");
        let again = fspid(&["verify", path, "--format", "json"], folder.path());
        let again: Value = serde_json::from_str(text(&again.stdout)).expect("JSON");
        assert_eq!(again["requirements"][0]["value"], line["value"], "{path}");
        let flown = fspid(&["simulate", path, "--format", "json"], folder.path());
        let flown: Value = serde_json::from_str(text(&flown.stdout)).expect("JSON");
        assert_eq!(flown["requirements"][0]["value"], line["value"], "{path}");
    }
}

#[test]
fn junit_is_written_beside_the_answer() {
    let folder = with_ours();
    let asked = ["verify", "pitch.toml", "--requirements", "ours.toml", "--junit", "out.xml"];
    assert_eq!(code(&fspid(&asked, folder.path())), 0);
    let xml = std::fs::read_to_string(folder.path().join("out.xml")).expect("written");
    assert!(xml.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites "), "{xml}");
    assert!(xml.contains("tests=\"4\" failures=\"0\""), "{xml}");
    let again = fspid(&asked, folder.path());
    assert_eq!(code(&again), 0);
    assert_eq!(std::fs::read_to_string(folder.path().join("out.xml")).expect("written"), xml);
}

#[test]
fn the_help_names_every_measure_and_every_set() {
    let folder = tempfile::tempdir().expect("a folder");
    let help = fspid(&["verify", "--help"], folder.path());
    let help = text(&help.stdout);
    for name in Measure::ALL.map(Measure::name).into_iter().chain(SET_NAMES) {
        assert!(
            help.split(|c: char| c.is_whitespace() || c == '"').any(|word| word == name),
            "{name}"
        );
    }
    let short = fspid(&["verify", "-h"], folder.path());
    assert!(text(&short.stdout).contains("Examples:"));
}

#[test]
fn simulate_judges_margins_by_the_same_numbers() {
    let folder = folder();
    let starter = std::fs::read_to_string(folder.path().join("pitch.toml")).expect("made");
    std::fs::write(folder.path().join("pitch.toml"), format!("{starter}\n{OURS}"))
        .expect("written");
    let read = |command: &str| -> Value {
        let output = fspid(&[command, "pitch.toml", "--format", "json"], folder.path());
        serde_json::from_str(text(&output.stdout)).expect("JSON")
    };
    let (flown, verified) = (read("simulate"), read("verify"));
    let numbers = |answer: &Value| -> Vec<(Value, Value)> {
        let lines = answer["requirements"].as_array().expect("a list");
        lines.iter().map(|line| (line["value"].clone(), line["met"].clone())).collect()
    };
    assert_eq!(numbers(&flown).len(), 4);
    assert_eq!(numbers(&flown), numbers(&verified));
}

/// A Navion at 300 ft with a step of -10 deg flew on to -276 m and passed every requirement of its loop.
#[test]
fn a_flight_into_the_ground_fails_whatever_is_required() {
    let folder = tempfile::tempdir().expect("a folder");
    let step = include_str!("../../../scenarios/gallery/navion-step.toml");
    let (flight, _) = step.split_once("[[requirement]]").expect("it asks for an overshoot");
    let scenario = format!("{flight}[[requirement]]\nmeasure = \"stable\"\n");
    std::fs::write(folder.path().join("low.toml"), scenario).expect("written");
    let down = ["aircraft.altitude_ft=300", "setpoint.amplitude_deg=-10", "loop.duration_s=60"];
    let set = down.map(|change| ["--set", change]).concat();
    let ask = |more: &[&str]| {
        let arguments = [&["verify", "low.toml"], more, &set[..]].concat();
        fspid(&arguments, folder.path())
    };
    let output = ask(&["--junit", "out.xml"]);
    assert_eq!(code(&output), 1, "{}", text_of(&output));
    let out = text(&output.stdout);
    assert!(out.contains("- PID: hit the ground at t = 11.66 s."), "{out}");
    assert!(out.ends_with("\n1 of 1 requirement met; 1 flight failed; FAIL\n"), "{out}");
    let junit = std::fs::read_to_string(folder.path().join("out.xml")).expect("written");
    assert!(junit.contains("tests=\"2\" failures=\"1\""), "{junit}");
    assert!(junit.contains("<failure type=\"failed flight\" message=\"hit the ground"), "{junit}");
    let answer: Value = serde_json::from_slice(&ask(&["--format", "json"]).stdout).expect("JSON");
    assert_eq!(answer["all_met"], false);
    assert_eq!(answer["failed_flights"][0]["controller"], "PID");
    let flown = fspid(&[&["simulate", "low.toml"], &set[..]].concat(), folder.path());
    assert_eq!(code(&flown), 1);
    assert!(text(&flown.stderr).contains("fspid: 1 flight failed"), "{}", text(&flown.stderr));
}

fn text_of(output: &Output) -> String {
    format!("{}{}", text(&output.stdout), text(&output.stderr))
}

#[test]
fn an_interval_is_told_with_what_holds_on_both_sides_and_the_file_is_judged_alike_there() {
    let folder = folder();
    let folder = folder.path();
    let starter = std::fs::read_to_string(folder.join("pitch.toml")).expect("the starter");
    std::fs::write(folder.join("pitch.toml"), starter + "\n" + OURS).expect("written");
    let path = "controller.FSPID.nominal.kp";
    let strict = fspid(&["verify", "pitch.toml", "--set", "ctms", "--interval", path], folder);
    assert!(text(&strict.stdout).contains("requirements, with ctms."), "{}", text(&strict.stdout));
    let asked = ["verify", "pitch.toml", "--interval", path];
    let told = fspid(&asked, folder);
    let words = text(&told.stdout);
    assert!(words.starts_with(&format!("{path}: Holds at all ")), "{words}");
    let answer = fspid(&[&asked[..], &["--format", "json"]].concat(), folder);
    let answer: Value = serde_json::from_slice(&answer.stdout).expect("JSON");
    let found = &answer["intervals"][0];
    assert_eq!(code(&told), i32::from(!found["holds"].as_bool().expect("a verdict")));
    let values = found["values"].as_array().expect("values");
    for it in values.iter().step_by(values.len() / 4) {
        let value = format!("{path}={}", it[0]);
        let judged = fspid(&["verify", "pitch.toml", "--set", &value, "--format", "json"], folder);
        let judged: Value = serde_json::from_slice(&judged.stdout).expect("JSON");
        // What the scenario may not be is no value that holds.
        let own = judged["requirements"].as_array();
        let is_met = own.is_some_and(|all| {
            all.iter().all(|it| it["controller"] != "FSPID" || it["met"] == true)
        });
        assert_eq!(it[1], is_met, "{value}");
    }
    for wrong in ["controller.FSPID.nominal.kq", "controller.FSPID.name"] {
        let refused = fspid(&["verify", "pitch.toml", "--interval", wrong], folder);
        assert_eq!(code(&refused), 2);
        assert!(text(&refused.stderr).contains(wrong), "{}", text(&refused.stderr));
    }
    let near = fspid(&["verify", "pitch.toml", "--interval", "controller.FSPID.nominl.kp"], folder);
    let meant = "did you mean `controller.FSPID.nominal.kp`?";
    assert!(text(&near.stderr).contains(meant), "{}", text(&near.stderr));
    // What is required of the aircraft alone is required around a controller's number too.
    let airframe =
        fspid(&["verify", "pitch.toml", "--set", "mil-f-8785c", "--interval", path], folder);
    assert!(
        !text(&airframe.stdout).contains("as nothing is required"),
        "{}",
        text(&airframe.stdout)
    );
    let mixed = [&asked[..], &["--set", "loop.sample_period_s=0.02"]].concat();
    let refused = fspid(&mixed, folder);
    assert_eq!(code(&refused), 2);
    assert!(text(&refused.stderr).contains("allowed beside it are ready sets"));
}
