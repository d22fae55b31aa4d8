//! `fspid certify --disturbances`: what gusts and disturbances at the elevator do at most.

use crate::common;

use common::{code, fspid, json, text};

const SCENARIO: &str = r#"
schema = 1
name = "Gusts"

[aircraft]
name = "navion"
airspeed_ft_s = 176.0
altitude_ft = 1000.0
model = "linear"

[actuator]
time_constant_s = 0.1
rate_limit_deg_s = 37.0

[loop]
sample_period_s = 0.02
duration_s = 8.0

[setpoint]
kind = "step"
amplitude_deg = 0.0

[[gust]]
kind = "full-cycle"
up_m_s = 2.0
gradient_m = 30.0
at_s = 1.0

[[controller]]
name = "PID"
kind = "pid"
kp = 0.82
ki = 0.43
kd = 0.165
derivative_filter_s = 0.05
output_limits_deg = [-20.0, 20.0]
"#;

fn folder(scenario: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("gusts.toml"), scenario).expect("written");
    folder
}

#[test]
fn bounds_of_gusts_are_told_written_checked_and_compared_with_the_air_that_flies() {
    let folder = folder(SCENARIO);
    let words = ["certify", "gusts.toml", "--disturbances", "--out", "proofs", "--format", "json"];
    let output = fspid(&words, folder.path());
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let bounds = json(&output)["controllers"][0]["scope"]["disturbances"].clone();
    let vertical = bounds.as_array().expect("bounds").iter().find(|it| {
        [&it["enters"], &it["bounds"], &it["measured_by"]] == ["vertical-gust", "pitch", "peak"]
    });
    let vertical = vertical.expect("bounded");
    assert_eq!(vertical["unit"], "m/s");
    let per_unit = vertical["deg_per_unit"].as_f64().expect("a number");
    let unlimited = vertical["no_limit_acts_up_to"].as_f64().expect("a number");
    assert!(per_unit > 0.1 && per_unit < 10.0 && unlimited > 0.1, "{per_unit} {unlimited}");

    let check = ["certify", "--check", "proofs/pid.certificate.json", "--against", "gusts.toml"];
    let output = fspid(&check, folder.path());
    let told = text(&output.stdout);
    assert_eq!(code(&output), 0, "{told}");
    for words in [
        "from rest, a gust across the body axis of at most 1 m/s, however it changes, moves the pitch angle by at most",
        "a disturbance at the servo or the elevator of at most 1 deg",
        "; no limit acts up to",
        "Moving air counts by the bounds above",
        "Apart from the lines on disturbances the claim is about constant set-points and loads",
    ] {
        assert!(told.contains(words), "{words}: {told}");
    }
    let output = fspid(&[&check[..3], &["--format", "json"]].concat(), folder.path());
    assert_eq!(json(&output)["scope"]["disturbances"], bounds);
}

/// A pulse of one sample at the servo was at its rate limit with a quarter of the energy that was told.
#[test]
fn an_energy_at_the_servo_is_not_told_to_be_without_limits() {
    let told = |scenario: &str| {
        let folder = folder(scenario);
        let words = ["certify", "gusts.toml", "--disturbances", "--format", "json"];
        let bounds = json(&fspid(&words, folder.path()))["controllers"][0]["scope"]["disturbances"]
            .as_array()
            .expect("bounds")
            .clone();
        let at_servo = |measured_by: &str| {
            let mut of = bounds
                .iter()
                .filter(|it| [&it["enters"], &it["measured_by"]] == ["elevator", measured_by]);
            of.all(|it| it["at_servo_too"] == true)
        };
        [at_servo("peak"), at_servo("energy")]
    };
    assert_eq!(told(SCENARIO), [true, false]);
    let without = SCENARIO.replace("output_limits_deg = [-20.0, 20.0]", "");
    assert_eq!(told(&without.replace("rate_limit_deg_s = 37.0", "")), [true, true]);
}

#[test]
fn a_loop_that_is_not_proved_has_no_bounds_and_says_so() {
    let folder = folder(&SCENARIO.replace("kp = 0.82", "kp = 40.0"));
    let words = ["certify", "gusts.toml", "--disturbances", "--format", "json"];
    let output = fspid(&words, folder.path());
    assert_eq!(code(&output), 1, "{}", text(&output.stderr));
    let loop_ = json(&output)["controllers"][0].clone();
    assert_eq!(loop_["disturbances_not_bounded"], "the loop itself is not proved");
    assert!(loop_["scope"]["disturbances"].is_null());
}
