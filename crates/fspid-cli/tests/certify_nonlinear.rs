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

fn written(folder: &tempfile::TempDir, name: &str, scenario: &str) -> String {
    let path = folder.path().join(name);
    std::fs::write(&path, scenario).expect("written");
    path.to_str().expect("UTF-8").to_owned()
}

#[test]
fn the_nonlinear_aircraft_is_proved_in_a_box_and_its_certificate_knows_another_aircraft() {
    let folder = tempfile::tempdir().expect("a folder");
    let scenario = written(&folder, "pitch.toml", SCENARIO);
    let out = folder.path().join("out");
    let out = out.to_str().expect("UTF-8");
    let found = fspid(&["certify", &scenario, "--nonlinear", "--out", out, "--format", "json"]);
    assert_eq!(code(&found), 0, "{}", text(&found.stderr));
    let answer = json(&found);
    let nonlinear = &answer["controllers"][0]["nonlinear"];
    assert_eq!(nonlinear["verdict"], "proved");
    let begins = nonlinear["begins_within_deg"].as_f64().expect("a number");
    assert!(begins > 2.0, "{nonlinear:#}");
    assert!(nonlinear["box"]["pitch_deg"].as_f64().expect("a number") > begins);
    let words = nonlinear["in_words"].as_str().expect("a sentence");
    for said in ["comes to rest at the trim", "ft/s", "density of the trim", "linear model"] {
        assert!(words.contains(said), "{words}");
    }

    let certificate = format!("{out}/PID.certificate.json");
    let alone = fspid(&["certify", "--check", &certificate]);
    assert_eq!(code(&alone), 0, "{}", text(&alone.stderr));
    let said = text(&alone.stdout);
    assert!(said.contains("enclosed anew from the aircraft in the file"), "{said}");
    let same = fspid(&["certify", "--check", &certificate, "--against", &scenario]);
    assert_eq!(code(&same), 0, "{}", text(&same.stdout));
    // The linear model of a heavier aircraft with the inertia of this one would differ as well; this differs in drag alone.
    let set = "aircraft.drag=polar";
    let other = ["certify", "--check", &certificate, "--against", &scenario, "--set", set];
    let other = fspid(&other);
    assert_eq!(code(&other), 1, "{}", text(&other.stdout));
    assert!(text(&other.stdout).contains("nonlinear.aircraft.drag_law"), "{}", text(&other.stdout));

    let content = std::fs::read_to_string(&certificate).expect("there");
    let wider = content.replacen("\"airspeed_m_s\": ", "\"airspeed_m_s\": 1", 1);
    let wider = written(&folder, "wider.certificate.json", &wider);
    let refused = fspid(&["certify", "--check", &wider]);
    assert_ne!(code(&refused), 0, "{}", text(&refused.stdout));
}

#[test]
fn what_is_no_nonlinear_aircraft_of_derivatives_is_refused_by_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let scenario = written(&folder, "pitch.toml", SCENARIO);
    let refused = |set: &[&str], why: &str| {
        let arguments: Vec<&str> = ["certify", scenario.as_str(), "--nonlinear"]
            .into_iter()
            .chain(set.iter().flat_map(|it| ["--set", it]))
            .collect();
        let found = fspid(&arguments);
        let said = text(&found.stdout);
        assert_eq!(code(&found), 1, "{said} {}", text(&found.stderr));
        assert!(said.contains("nonlinear          OPEN: ") && said.contains(why), "{said}");
    };
    refused(&["aircraft.model=linear"], "a linear plant");
    refused(&["actuator.bias_deg=0.5"], "the actuator has a bias");
}
