//! `fspid certify --nonlinear`: the nonlinear aircraft near its trim.

use std::path::Path;

use crate::accepted::SCENARIOS;
use crate::common::{code, fspid, json, text};

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
    assert!(begins > 1.9, "{nonlinear:#}");
    assert!(nonlinear["box"]["pitch_deg"].as_f64().expect("a number") > begins);
    let words = nonlinear["in_words"].as_str().expect("a sentence");
    for said in ["comes to within", "ft/s", "of any density from", "linear model"] {
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

/// Of a self-tuner it is about flights after a reset, and says which gains they have.
#[test]
fn a_self_tuner_is_proved_with_the_gains_that_it_has_near_the_trim() {
    let folder = folder();
    let gains = "nominal = { kp = 0.82, ki = 0.43, kd = 0.165 }";
    let scales = "error_scale = 0.25, change_scale = 0.05, output_scale = { kp = 0.02, ki = 0.01, kd = 0.004 }";
    let rules = format!("supervisor = {{ table = \"mirrored\", range = 5.0, {scales} }}");
    let tuned = SCENARIO
        .replace("name = \"PID\"\nkind = \"pid\"", "name = \"FSPID\"\nkind = \"fspid\"")
        .replace("kp = 0.82\nki = 0.43\nkd = 0.165", &format!("{gains}\n{rules}"));
    std::fs::write(folder.path().join("tuned.toml"), tuned).expect("written");
    let asked = |words: &[&str]| fspid(words, folder.path());
    let words = ["certify", "tuned.toml", "--nonlinear", "--out", "proofs", "--format", "json"];
    let found = asked(&words);
    assert_eq!(code(&found), 0, "{}{}", text(&found.stdout), text(&found.stderr));
    let nonlinear = &json(&found)["controllers"][0]["nonlinear"];
    assert_eq!(
        (&nonlinear["verdict"], &nonlinear["begins_with"]),
        (&"proved".into(), &"reset".into())
    );
    let [least, most] =
        [0, 1].map(|end| nonlinear["gains_near_trim"]["kp"][end].as_f64().expect("a gain"));
    assert!(least < most && most < 0.9, "{nonlinear:#}");
    let certificate = "proofs/fspid.certificate.json";
    let checked = asked(&["certify", "--check", certificate, "--against", "tuned.toml"]);
    let told = text(&checked.stdout);
    assert_eq!(code(&checked), 0, "{told}{}", text(&checked.stderr));
    assert!(
        told.contains("with the controller just reset, whose gains then lie within kp 0.8"),
        "{told}"
    );
    // With any gains the same form is no proof.
    let path = folder.path().join(certificate);
    let written = std::fs::read_to_string(&path).expect("written");
    let other = written.replace("\"begins_with\": \"reset\"", "\"begins_with\": \"any-gains\"");
    assert_ne!(other, written);
    std::fs::write(&path, other).expect("written");
    assert_ne!(code(&asked(&["certify", "--check", certificate])), 0);
}

/// Bounds of disturbances were asked of the form of the nonlinear claim, which is another.
#[test]
fn what_disturbances_do_and_the_nonlinear_aircraft_are_proved_in_one_certificate() {
    let folder = folder();
    let words = ["--disturbances", "--nonlinear", "--out", "proofs", "--format", "json"];
    let found = fspid(&[&["certify", "pitch.toml"], &words[..]].concat(), folder.path());
    assert_eq!(code(&found), 0, "{}", text(&found.stderr));
    let controller = &json(&found)["controllers"][0];
    assert_eq!(controller["nonlinear"]["verdict"], "proved", "{controller:#}");
    let certificate = "proofs/pid.certificate.json";
    let checked = fspid(&["certify", "--check", certificate], folder.path());
    let told = text(&checked.stdout);
    assert_eq!(code(&checked), 0, "{told}{}", text(&checked.stderr));
    assert!(told.contains("disturbances") && told.contains("equations of motion"), "{told}");
}

#[test]
fn a_certificate_for_a_band_of_heights_goes_round_and_is_refused_with_another_height_or_density() {
    let folder = folder();
    let asked = |words: &[&str]| fspid(words, folder.path());
    let found = asked(&["certify", "pitch.toml", "--nonlinear", "--out", "proofs"]);
    assert_eq!(code(&found), 0, "{}", text(&found.stderr));
    let path = folder.path().join("proofs/pid.certificate.json");
    let written = std::fs::read_to_string(path).expect("written");
    let whole: serde_json::Value = serde_json::from_str(&written).expect("a certificate");
    assert_eq!(whole["nonlinear"]["aircraft"]["height_m"], 10.0);
    let checked = |change: &dyn Fn(&mut serde_json::Value), words: &[&str]| {
        let mut changed = whole.clone();
        change(&mut changed["nonlinear"]["aircraft"]);
        std::fs::write(folder.path().join("changed.json"), changed.to_string()).expect("written");
        asked(&[&["certify", "--check", "changed.json"], words].concat())
    };
    let against = ["--against", "pitch.toml"];
    for words in [&[][..], &against] {
        let same = checked(&|_| {}, words);
        assert_eq!(code(&same), 0, "{} {}", text(&same.stdout), text(&same.stderr));
    }
    let refused = |change: &dyn Fn(&mut serde_json::Value), words: &[&str], why: &str| {
        let found = checked(change, words);
        let said = format!("{}{}", text(&found.stdout), text(&found.stderr));
        assert!(code(&found) != 0 && said.contains(why), "{said}");
    };
    let wide = serde_json::json!([1.0, 1.4]);
    let shifted = serde_json::json!([1.3, 1.4]);
    refused(&|it| it["height_m"] = 30.0.into(), &against, "nonlinear.aircraft.densities_kg_m3");
    refused(&|it| it["height_m"] = 0.0.into(), &[], "stand together");
    refused(&|it| it["densities_kg_m3"] = wide.clone(), &[], "nonlinear");
    refused(&|it| it["densities_kg_m3"] = shifted.clone(), &[], "density of the trim");
    refused(&|it| it["density_kg_m3"] = 1.189.into(), &against, "nonlinear.aircraft.density_kg_m3");
}

#[test]
fn the_approach_of_the_747_is_proved_in_air_of_one_density() {
    let words = ["certify", "gallery/b747-approach-hold.toml", "--nonlinear", "--format", "json"];
    let found = fspid(&words, Path::new(SCENARIOS));
    assert_eq!(code(&found), 0, "{}", text(&found.stderr));
    let nonlinear = &json(&found)["controllers"][0]["nonlinear"];
    assert_eq!(nonlinear["verdict"], "proved");
    assert!(nonlinear["begins_within_deg"].as_f64().expect("a number") > 1.5, "{nonlinear:#}");
    let words = nonlinear["in_words"].as_str().expect("a sentence");
    for said in ["comes to rest at the trim", "everywhere the density of the trim"] {
        assert!(words.contains(said), "{words}");
    }
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

const CASES: &str = r#"
[[tuning.objective]]
measure = "iae_deg_s"

[[tuning.case]]
name = "up"
set = ["setpoint.amplitude_deg=2"]

[[tuning.case]]
name = "down"
set = ["setpoint.amplitude_deg=-2"]

[[tuning.case]]
name = "faster"
set = ["aircraft.airspeed_ft_s=190"]
"#;

/// The scenario with cases, each certified with the nonlinear aircraft, so written.
fn in_cases(folder: &tempfile::TempDir, more: &[&str]) -> std::process::Output {
    let scenario = format!("{SCENARIO}{CASES}");
    std::fs::write(folder.path().join("pitch.toml"), scenario).expect("written");
    let words = ["certify", "pitch.toml", "--cases", "tuning", "--nonlinear", "--out", "proofs"];
    fspid(&[&words, more].concat(), folder.path())
}

#[test]
fn the_nonlinear_aircraft_of_every_case_is_proved_about_its_own_trim_and_told_of_all_together() {
    let folder = folder();
    let output = in_cases(&folder, &["--format", "json"]);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let answer = json(&output);
    let all = &answer["in_every_case"][0]["nonlinear"];
    let each: Vec<_> =
        (0..3).map(|at| &answer["cases"][at]["controllers"][0]["nonlinear"]).collect();
    assert_eq!(each[0], each[1]);
    assert_ne!(each[0]["box"], each[2]["box"]);
    let number = |of: &serde_json::Value, keys: &str| of.pointer(keys).and_then(|it| it.as_f64());
    let of_each =
        |keys: &str| each.iter().map(|it| number(it, keys).expect("a number")).collect::<Vec<_>>();
    let least = of_each("/begins_within_deg").into_iter().fold(f64::INFINITY, f64::min);
    assert_eq!(number(all, "/begins_within_deg"), Some(least));
    for side in ["pitch_deg", "airspeed_m_s", "command_deg"] {
        let keys = format!("/box/{side}");
        let largest = of_each(&keys).into_iter().fold(0.0, f64::max);
        assert_eq!(number(all, &keys), Some(largest), "{side}");
    }
    let words = all["in_words"].as_str().expect("a sentence");
    assert!(words.contains("in every case about its own trim"), "{words}");

    let against = |certificate: &str, set: &[&str]| {
        let words = ["certify", "--check", certificate, "--against", "pitch.toml"];
        fspid(&[&words, set].concat(), folder.path())
    };
    let faster = "proofs/faster/pid.certificate.json";
    let same = against(faster, &["--set", "aircraft.airspeed_ft_s=190"]);
    let said = text(&same.stdout);
    assert_eq!(code(&same), 0, "{said}");
    assert!(said.contains("a flight that begins in the certified ellipsoid"), "{said}");
    // As the scenario stands another trim flies.
    let other = against(faster, &[]);
    assert_eq!(code(&other), 1);
    assert!(text(&other.stdout).contains("nonlinear.aircraft.airspeed_m_s"));
}

#[test]
fn a_case_without_a_nonlinear_aircraft_is_named_with_the_reason_and_nothing_is_said_of_all() {
    let folder = folder();
    let output = in_cases(&folder, &["--set", "aircraft.model=linear"]);
    let said = text(&output.stdout);
    assert_eq!(code(&output), 1, "{said}");
    let reason = "nonlinear aircraft OPEN: what flies is a linear plant";
    assert_eq!(said.matches(reason).count(), 3, "{said}");
    assert!(said.contains("PID: NOT PROVED at 3 of 3 cases of [tuning]"), "{said}");
    assert!(said.contains("OPEN: the nonlinear aircraft is not proved in every case"), "{said}");
}
