//! `fspid certify --nonlinear`: the nonlinear aircraft near its trim.

use crate::common;

use common::{code, fspid, json, text};

const SCENARIO: &str = r#"
schema = 1
name = "Nonlinear"

[aircraft]
name = "navion"
airspeed_ft_s = 176.0
altitude_ft = 1000.0

[actuator]
time_constant_s = 0.1

[loop]
sample_period_s = 0.01
duration_s = 8.0

[setpoint]
kind = "step"
amplitude_deg = 2.0

[[controller]]
name = "PID"
kind = "pid"
kp = 0.82
ki = 0.43
kd = 0.165
derivative_filter_s = 0.05
"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("pitch.toml"), SCENARIO).expect("written");
    folder
}

#[test]
fn the_nonlinear_aircraft_is_proved_in_a_box_and_its_certificate_knows_another_aircraft() {
    let folder = folder();
    let asked = |words: &[&str]| fspid(words, folder.path());
    let words = ["certify", "pitch.toml", "--nonlinear", "--out", "proofs", "--format", "json"];
    let found = asked(&words);
    assert_eq!(code(&found), 0, "{}", text(&found.stderr));
    let nonlinear = &json(&found)["controllers"][0]["nonlinear"];
    assert_eq!(nonlinear["verdict"], "proved");
    let begins = nonlinear["begins_within_deg"].as_f64().expect("a number");
    assert!(begins > 2.0, "{nonlinear:#}");
    assert!(nonlinear["box"]["pitch_deg"].as_f64().expect("a number") > begins);
    let words = nonlinear["in_words"].as_str().expect("a sentence");
    for said in ["comes to rest at the trim", "ft/s", "density of the trim", "linear model"] {
        assert!(words.contains(said), "{words}");
    }

    let certificate = "proofs/pid.certificate.json";
    let alone = asked(&["certify", "--check", certificate]);
    assert_eq!(code(&alone), 0, "{}", text(&alone.stderr));
    let said = text(&alone.stdout);
    assert!(said.contains("enclosed anew from the aircraft in the file"), "{said}");
    let checked = asked(&["certify", "--check", certificate, "--format", "json"]);
    assert_eq!(json(&checked)["nonlinear"]["verdict"], "proved");
    let same = asked(&["certify", "--check", certificate, "--against", "pitch.toml"]);
    assert_eq!(code(&same), 0, "{}", text(&same.stdout));
    let set = "aircraft.drag=polar";
    let other = ["certify", "--check", certificate, "--against", "pitch.toml", "--set", set];
    let other = asked(&other);
    assert_eq!(code(&other), 1, "{}", text(&other.stdout));
    let said = text(&other.stdout);
    assert!(said.contains("nonlinear.aircraft.drag_law"), "{said}");
}

#[test]
fn what_is_no_nonlinear_aircraft_of_derivatives_is_refused_by_name() {
    let folder = folder();
    let refused = |set: &str, why: &str| {
        let words = ["certify", "pitch.toml", "--nonlinear", "--set", set];
        let found = fspid(&words, folder.path());
        let said = text(&found.stdout);
        assert_eq!(code(&found), 1, "{said} {}", text(&found.stderr));
        assert!(said.contains("nonlinear          OPEN: ") && said.contains(why), "{said}");
    };
    refused("aircraft.model=linear", "a linear plant");
    refused("actuator.bias_deg=0.5", "the actuator has a bias");
}
