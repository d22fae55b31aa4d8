//! An aircraft that is made of tables, wherever one of derivatives can be asked about.

use std::path::Path;
use std::process::{Command, Output};

const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../fspid-daveml/tests/data");

const AIRCRAFT: &str = r#"
kind = "tables"
name = "lines"
title = "Straight lines"
source = "invented"

[tables]
aerodynamics = "aero.toml"
inertia = "body.toml"
propulsion = "engine.toml"

[body]
gravity_m_s2 = 9.8

[engine]
angular_momentum_kg_m2_s = 0.0

[travel]
elevator_deg = [-25.0, 20.0]
aileron_deg = [-20.0, 20.0]
rudder_deg = [-30.0, 30.0]
"#;

fn aircraft(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fspid"));
    command.arg("aircraft").args(arguments).current_dir(folder).output().expect("it starts")
}

/// A folder with the aircraft, its tables imported by the program.
fn hangar() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for part in ["aero", "body", "engine"] {
        let (from, to) = (format!("{DATA}/glider_{part}.dml"), format!("{part}.toml"));
        let output = aircraft(folder.path(), &["import", &from, "--out", &to]);
        assert_eq!(output.status.code(), Some(0));
    }
    std::fs::write(folder.path().join("lines.toml"), AIRCRAFT).expect("written");
    folder
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

#[test]
fn every_question_about_a_flight_is_answered_for_tables() {
    let folder = hangar();
    let flight = ["--speed", "80", "--altitude", "1000"];
    for verb in ["trim", "linearise", "modes", "qualities"] {
        let output = aircraft(folder.path(), &[&[verb, "lines.toml"], &flight[..]].concat());
        assert_eq!(output.status.code(), Some(0), "{verb}: {}", text(&output.stderr));
    }
    let map = ["envelope", "lines.toml", "--speeds", "70:90:3", "--altitudes", "0:1000:2"];
    assert_eq!(aircraft(folder.path(), &map).status.code(), Some(0));
    let show = aircraft(folder.path(), &["show", "lines.toml"]);
    assert!(text(&show.stdout).contains("angle of attack"), "{}", text(&show.stderr));
}

/// Closed form of `lift` and `moment` as in the tests of `fspid-daveml`, here in the standard atmosphere.
#[test]
fn a_trim_of_tables_balances_the_forces_of_its_straight_lines() {
    let folder = hangar();
    let asked = ["trim", "lines.toml", "--speed", "80", "--altitude", "0", "--format", "json"];
    let output = aircraft(folder.path(), &asked);
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let number = |key: &str| answer["trim"][key].as_f64().expect("a number");
    let (scale_n, weight_n) = (0.5 * 1.225 * 6400.0 * 18.580_608, 1_459.390_293_720_636 * 9.8);
    let (alpha_deg, thrust_n) = (number("alpha_deg"), number("thrust_n"));
    let (sin, cos) = alpha_deg.to_radians().sin_cos();
    let lift_n = (0.2 + 0.08 * alpha_deg) * scale_n;
    assert!((lift_n - weight_n * cos).abs() < 1e-4 * weight_n);
    assert!((thrust_n - 0.03 * scale_n - weight_n * sin).abs() < 1e-4 * weight_n);
    assert!((number("throttle") - thrust_n / (2000.0 * 4.448_221_615_260_5)).abs() < 1e-9);
}

#[test]
fn what_tables_cannot_answer_is_refused_with_the_reason() {
    let folder = hangar();
    let flight = ["trim", "lines.toml", "--speed", "80", "--altitude", "0"];
    let cases: [(&[&str], &str); 4] = [
        (&["trim", "lines.toml"], "--speed is missing"),
        (&["derive", "lines.toml"], "it has no stability derivatives"),
        (&[&flight[..], &["--air", "source"]].concat(), "says no air of its own"),
        (&[&flight[..], &["--drag", "polar"]].concat(), "--drag and --thrust are for derivatives"),
    ];
    for (asked, reason) in cases {
        let output = aircraft(folder.path(), asked);
        assert_eq!(output.status.code(), Some(2), "{asked:?}");
        assert!(text(&output.stderr).contains(reason), "{}", text(&output.stderr));
    }
}

const INVENTED: &str = include_str!("../../fspid-daveml/tests/data/jsbsim/invented.xml");

const FLIGHT: &str = r#"
schema = 1
name = "an aircraft of JSBSim"
[aircraft]
file = "small.toml"
airspeed_m_s = 55.0
altitude_m = 1000.0
[loop]
sample_period_s = 0.01
duration_s = 8.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
at_s = 1.0
[[controller]]
name = "PID"
kind = "pid"
kp = 1.0
ki = 0.5
kd = 0.3
"#;

/// A folder with the invented aircraft in JSBSim's format, and what importing it with these arguments answers.
fn small(arguments: &[&str]) -> (tempfile::TempDir, Output) {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("small.xml"), INVENTED).expect("written");
    let output = aircraft(folder.path(), &[&["import", "small.xml"], arguments].concat());
    (folder, output)
}

#[test]
fn an_aircraft_of_jsbsim_becomes_an_aircraft_of_tables_that_flies_a_scenario() {
    let (folder, output) = small(&["--thrust-lbf", "600", "--out", "small.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(
        text(&output.stderr).contains("small.xml:41:17: aero/h_b-mac-ft is held at 100"),
        "{}",
        text(&output.stderr)
    );
    assert!(text(&output.stdout).contains("angleOfAttackRate"), "{}", text(&output.stdout));
    let written = std::fs::read_to_string(folder.path().join("small.toml")).expect("read");
    assert!(written.contains(". one engine of at most 600 lbf"), "{written}");
    for verb in ["trim", "linearise", "modes", "qualities"] {
        let asked = [verb, "small.toml", "--speed", "55", "--altitude", "1000"];
        let output = aircraft(folder.path(), &asked);
        assert_eq!(output.status.code(), Some(0), "{verb}: {}", text(&output.stderr));
    }
    std::fs::write(folder.path().join("flight.toml"), FLIGHT).expect("written");
    let mut command = Command::new(env!("CARGO_BIN_EXE_fspid"));
    let command = command.args(["simulate", "flight.toml", "--format", "json"]);
    let output = command.current_dir(folder.path()).output().expect("it starts");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(answer["controllers"][0]["name"], "PID", "{answer}");
}

/// With a rolling moment where nothing moves it was "good" and `stable`, banked by 54 deg at once and flew into the ground.
#[test]
fn an_aircraft_that_is_not_balanced_sideways_is_not_trimmed() {
    let folder = tempfile::tempdir().expect("a folder");
    let balanced = "<product> <property>aero/beta-rad</property> <value>-0.09</value> </product>";
    assert!(INVENTED.contains(balanced));
    let bent = INVENTED.replacen(balanced, &format!("<value>0.02</value> {balanced}"), 1);
    std::fs::write(folder.path().join("small.xml"), bent).expect("written");
    let output = aircraft(
        folder.path(),
        &["import", "small.xml", "--thrust-lbf", "600", "--out", "small.toml"],
    );
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    for verb in ["trim", "linearise", "modes", "qualities"] {
        let asked = [verb, "small.toml", "--speed", "55", "--altitude", "1000"];
        let output = aircraft(folder.path(), &asked);
        assert_eq!(output.status.code(), Some(2), "{verb}: {}", text(&output.stdout));
        let told = text(&output.stderr);
        assert!(
            told.contains("is not balanced sideways") && told.contains("deg/s² in roll"),
            "{told}"
        );
    }
    std::fs::write(folder.path().join("flight.toml"), FLIGHT).expect("written");
    let mut command = Command::new(env!("CARGO_BIN_EXE_fspid"));
    let output = command.args(["simulate", "flight.toml"]).current_dir(folder.path()).output();
    let output = output.expect("it starts");
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stdout));
    assert!(text(&output.stderr).contains("is not balanced sideways"), "{}", text(&output.stderr));
}

#[test]
fn without_a_thrust_an_aircraft_of_jsbsim_glides_and_says_so() {
    let (folder, output) = small(&["--out", "small.toml", "--format", "json"]);
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(answer["has_engine"], false);
    assert!(text(&output.stderr).contains("it glides, and cannot be trimmed in level flight"));
    let asked =
        ["trim", "small.toml", "--speed", "55", "--altitude", "1000", "--climb-angle", "0deg"];
    assert!(!folder.path().join("small-propulsion.toml").exists());
    assert_eq!(aircraft(folder.path(), &asked).status.code(), Some(2));
}

#[test]
fn an_import_of_jsbsim_that_cannot_be_says_all_that_is_in_the_way_and_writes_nothing() {
    let cases: [(&[&str], &str); 5] = [
        (&["--out", "-"], "becomes several files"),
        (&["--set", "fcs/flap-pos-deg", "--out", "small.toml"], "expected PROPERTY=NUMBER"),
        (&["--set", "fcs/flap-pos-deg=nan", "--out", "small.toml"], "expected PROPERTY=NUMBER"),
        (&["--set", "fcs/flap-pos-deg=10", "--out", "small.toml"], "asks for this property"),
        (&["--thrust-lbf=-3", "--out", "small.toml"], "thrust of -3 lbf"),
    ];
    for (arguments, reason) in cases {
        let (folder, output) = small(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(text(&output.stderr).contains(reason), "{}", text(&output.stderr));
        assert!(!folder.path().join("small.toml").exists());
    }
    let folder = hangar();
    let dml = format!("{DATA}/glider_aero.dml");
    let output = aircraft(folder.path(), &["import", &dml, "--thrust-lbf", "5"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("goes with an aircraft file of JSBSim"));
}
