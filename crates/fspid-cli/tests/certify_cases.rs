//! `fspid certify --cases`: a scenario as each of several changes makes it.

use crate::common;

use common::{code, fspid, json, text};

const SCENARIO: &str = r#"
schema = 1
name = "Chosen"

[aircraft]
name = "navion"
airspeed_ft_s = 176.0
altitude_ft = 0.0
model = "linear"

[actuator]
time_constant_s = 0.1
delay_samples = 1

[loop]
sample_period_s = 0.02
duration_s = 8.0

[setpoint]
kind = "step"
amplitude_deg = 3.0

[[controller]]
name = "PID"
kind = "pid"
kp = 1.0
ki = 0.4
kd = 0.2
"#;

const CHOICES: &str = r#"
[[dispersion]]
name = "delay"
path = "actuator.delay_samples"
distribution = "choice"
values = [0, 2]

[[dispersion]]
name = "aircraft"
path = "aircraft.name"
distribution = "choice"
values = ["navion", "cessna-172"]
"#;

const SERVO: &str = r#"
[[dispersion]]
name = "servo"
path = "actuator.time_constant_s"
distribution = "uniform"
lower = 0.09
upper = 0.11
"#;

const TUNING: &str = r#"
[[tuning.objective]]
measure = "iae_deg_s"

[[tuning.case]]
name = "up"
set = ["setpoint.amplitude_deg=3"]

[[tuning.case]]
name = "down"
set = ["setpoint.amplitude_deg=-3"]

[[tuning.case]]
name = "another aircraft"
set = ["aircraft.name=cessna-172"]
"#;

fn folder(more: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let scenario = format!("{SCENARIO}{more}");
    std::fs::write(folder.path().join("chosen.toml"), scenario).expect("written");
    folder
}

/// What `--check --against` answers of a certificate, with values set.
fn against(folder: &tempfile::TempDir, certificate: &str, set: &[&str]) -> std::process::Output {
    let mut words = vec!["certify", "--check", certificate, "--against", "chosen.toml"];
    words.extend(set.iter().flat_map(|it| ["--set", it]));
    fspid(&words, folder.path())
}

#[test]
fn every_combination_of_choices_is_proved_and_has_a_certificate_of_its_own() {
    let folder = folder(&format!("{CHOICES}{SERVO}"));
    let words = ["certify", "chosen.toml", "--cases", "choices", "--family", "--out", "proofs"];
    let output = fspid(&words, folder.path());
    let told = text(&output.stdout);
    assert_eq!(code(&output), 0, "{told}{}", text(&output.stderr));
    assert!(told.contains("PID: PROVED at all 4 choices of the dispersions"), "{told}");
    assert!(told.contains("servo (actuator.time_constant_s) from 0.09 to 0.11"), "{told}");
    let certificate = "proofs/delay-2--aircraft-cessna-172/pid.certificate.json";
    let chosen = ["actuator.delay_samples=2", "aircraft.name=cessna-172"];
    let bound = against(&folder, certificate, &chosen);
    let told = text(&bound.stdout);
    assert_eq!(code(&bound), 0, "{told}");
    assert!(told.contains("others have certificates of their own"), "{told}");
    // As the scenario stands it flies another aircraft.
    assert_eq!(code(&against(&folder, certificate, &[])), 1);
}

#[test]
fn choices_alone_leave_nothing_else_that_differs_out_of_a_claim() {
    let folder = folder(CHOICES);
    let words = ["certify", "chosen.toml", "--cases", "choices", "--family", "--out", "proofs"];
    assert_eq!(code(&fspid(&words, folder.path())), 0);
    let certificate = "proofs/delay-0--aircraft-navion/pid.certificate.json";
    let chosen = ["actuator.delay_samples=0"];
    assert_eq!(code(&against(&folder, certificate, &chosen)), 0);
    // Since then something else is drawn, of which the claim does not speak.
    let scenario = format!("{SCENARIO}{CHOICES}{SERVO}");
    std::fs::write(folder.path().join("chosen.toml"), scenario).expect("written");
    let other = against(&folder, certificate, &chosen);
    assert_eq!(code(&other), 1);
    assert!(text(&other.stdout).contains("dispersions"), "{}", text(&other.stdout));
}

#[test]
fn a_family_that_says_nothing_of_other_choices_is_not_that_of_a_scenario_that_has_them() {
    let folder = folder(SERVO);
    let words = ["certify", "chosen.toml", "--family", "--out", "proofs"];
    assert_eq!(code(&fspid(&words, folder.path())), 0);
    let scenario = format!("{SCENARIO}{CHOICES}{SERVO}");
    std::fs::write(folder.path().join("chosen.toml"), scenario).expect("written");
    let other = against(&folder, "proofs/pid.certificate.json", &[]);
    assert_eq!(code(&other), 1);
    assert!(text(&other.stdout).contains("other-choices"), "{}", text(&other.stdout));
}

#[test]
fn a_choice_that_lets_the_loop_grow_is_named() {
    let folder = folder(&CHOICES.replace("[0, 2]", "[1, 30]"));
    let output = fspid(&["certify", "chosen.toml", "--cases", "choices"], folder.path());
    assert_eq!(code(&output), 1);
    let told = text(&output.stdout);
    let left_out =
        "not in this claim  Of what the dispersions choose among, the claim is about one choice";
    assert!(told.contains(left_out), "{told}");
    let missing = "PID: NOT PROVED at 2 of 4 choices of the dispersions: delay 30, aircraft navion; delay 30, aircraft cessna-172";
    assert!(told.contains(missing) && told.contains("PID: REFUTED: unstable"), "{told}");
    // Without being asked for each choice, a family refuses what it cannot hold.
    let family = fspid(&["certify", "chosen.toml", "--family"], folder.path());
    assert!(text(&family.stdout).contains("with --cases choices"), "{}", text(&family.stdout));
}

#[test]
fn cases_of_a_tuning_are_certified_each_and_equal_loops_once() {
    let folder = folder(TUNING);
    let words = ["certify", "chosen.toml", "--cases", "tuning", "--format", "json"];
    let output = fspid(&words, folder.path());
    let answer = json(&output);
    assert_eq!(code(&output), 0, "{answer:#}");
    assert_eq!(answer["all_proved"], true);
    let names: Vec<_> =
        answer["cases"].as_array().expect("cases").iter().map(|it| &it["name"]).collect();
    assert_eq!(names, ["up", "down", "another aircraft"]);
    let of = |case: usize| &answer["cases"][case]["controllers"][0];
    assert_eq!(of(0), of(1));
    assert_ne!(of(0)["decay_per_sample"], of(2)["decay_per_sample"]);
}

#[test]
fn a_table_that_is_not_there_is_told() {
    let folder = folder("");
    for (table, of) in
        [("tuning", "[tuning]"), ("contest", "[contest]"), ("choices", "dispersions")]
    {
        let output = fspid(&["certify", "chosen.toml", "--cases", table], folder.path());
        assert_eq!(code(&output), 2);
        let told = text(&output.stderr);
        assert!(told.contains(of) && told.contains("leave --cases out"), "{told}");
    }
}

/// The last of a hundred cases was told of after minutes of proofs, which were lost.
#[test]
fn all_cases_that_are_wrong_are_told_before_anything_is_proved() {
    let case =
        |name: &str, set: &str| format!("[[tuning.case]]\nname = \"{name}\"\nset = [\"{set}\"]\n");
    let cases = case("good", "actuator.delay_samples=0")
        + &case("slow", "loop.duration_s=-1")
        + &case("odd", "controller.PID.kpp=1");
    let objective = "\n[[tuning.objective]]\nmeasure = \"iae_deg_s\"\n";
    let folder = folder(&format!("{objective}{cases}"));
    let words = ["certify", "chosen.toml", "--cases", "tuning", "--out", "c"];
    let output = fspid(&words, folder.path());
    assert_eq!(code(&output), 2);
    let told = text(&output.stderr);
    assert!(told.contains("slow: ") && told.contains("odd: ") && told.contains("kpp"), "{told}");
    assert!(!told.contains("certifying"), "{told}");
    assert!(!folder.path().join("c").exists());
}

#[test]
fn what_disturbances_do_is_bounded_in_every_case_and_told_of_all_together() {
    let folder = folder(TUNING);
    let words =
        ["certify", "chosen.toml", "--cases", "tuning", "--disturbances", "--out", "proofs"];
    let output = fspid(&[&words[..], &["--format", "json"]].concat(), folder.path());
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let answer = json(&output);
    let of_all = answer["in_every_case"][0]["disturbances"].as_array().expect("bounds").clone();
    assert_eq!(answer["in_every_case"][0]["name"], "PID");
    let cases = answer["cases"].as_array().expect("cases").iter();
    let each = cases.map(|case| case["controllers"][0]["scope"]["disturbances"].clone());
    let each: Vec<_> = each.collect();
    assert_eq!(each.len(), 3);
    for bound in &of_all {
        let same = |it: &&serde_json::Value| {
            ["enters", "bounds", "measured_by"].iter().all(|key| it[key] == bound[key])
        };
        let own = each.iter().map(|own| own.as_array().and_then(|own| own.iter().find(same)));
        let own = own.map(|it| it.expect("in every case")["deg_per_unit"].as_f64());
        let largest = own.map(|it| it.expect("a number")).fold(0.0, f64::max);
        assert_eq!(bound["deg_per_unit"].as_f64(), Some(largest), "{bound}");
    }
    let check = ["certify", "--check", "proofs/up/pid.certificate.json"];
    let told = text(&fspid(&check, folder.path()).stdout);
    assert!(told.contains("from rest, the L2 gain of a gust across the body axis"), "{told}");
}
