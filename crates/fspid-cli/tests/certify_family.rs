//! `fspid certify --family`: all that dispersions can draw, at once.

use crate::common;

use common::{code, fspid, json, text};

/// What both loops have.
const LOOP: &str = r#"
[actuator]
time_constant_s = 0.1

[loop]
sample_period_s = 0.02
duration_s = 8.0

[setpoint]
kind = "step"
amplitude_deg = 3.0

[[controller]]
"#;

const SCENARIO: &str = r#"
schema = 1
name = "Drawn"

[plant]
numerator = [1.151, 0.1774]
denominator = [1.0, 0.739, 0.921, 0.0]
elevator_sign = "nose-up-positive"

LOOP
name = "PID"
kind = "pid"
kp = 1.2
ki = 0.4
kd = 0.5

[[dispersion]]
name = "effectiveness"
paths = ["plant.numerator[0]", "plant.numerator[1]"]
distribution = "normal"
mean = 1.0
standard_deviation = 0.1
lower = 0.8
upper = 1.2
relative = true

[[dispersion]]
name = "damping"
path = "plant.denominator[1]"
distribution = "uniform"
lower = 0.65
upper = 0.85

[[dispersion]]
name = "servo"
path = "actuator.time_constant_s"
distribution = "log-uniform"
lower = 0.08
upper = 0.12

[[dispersion]]
path = "setpoint.amplitude_deg"
distribution = "uniform"
lower = 1.0
upper = 4.0
"#;

fn folder(scenario: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let text = scenario.replace("LOOP\n", LOOP);
    std::fs::write(folder.path().join("drawn.toml"), text).expect("written");
    folder
}

#[test]
fn a_family_is_proved_written_checked_and_compared_with_what_the_scenario_draws() {
    let folder = folder(SCENARIO);
    let output = fspid(&["certify", "drawn.toml", "--family", "--out", "proofs"], folder.path());
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let told = text(&output.stdout);
    let box_in_words = "effectiveness (plant.numerator[0], plant.numerator[1]) from 0.8 to 1.2 times as large; damping (plant.denominator[1]) from 0.65 to 0.85; servo (actuator.time_constant_s) from 0.08 to 0.12";
    assert!(told.contains(box_in_words) && !told.contains("that a campaign draws"), "{told}");
    let output = fspid(&["certify", "--check", "proofs/pid.certificate.json"], folder.path());
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let alone = text(&output.stdout);
    let unbound = "is computed by --against SCENARIO";
    assert!(alone.contains(box_in_words) && alone.contains(unbound), "{alone}");
    let against = |setting: &str| {
        let words = [
            "certify",
            "--check",
            "proofs/pid.certificate.json",
            "--against",
            "drawn.toml",
            "--set",
            setting,
        ];
        fspid(&words, folder.path())
    };
    let bound = against("setpoint.amplitude_deg=2.5");
    assert_eq!(code(&bound), 0);
    assert!(!text(&bound.stdout).contains(unbound), "{}", text(&bound.stdout));
    let wider = against("dispersion[1].upper=0.9");
    assert_eq!(code(&wider), 1);
    assert!(text(&wider.stdout).contains("from 0.65 to 0.9"), "{}", text(&wider.stdout));
    // The same proof says nothing of a scenario that draws what it does not know.
    let unknown = against("dispersion[1].path=loop.sample_period_s");
    assert_ne!(code(&unknown), 0);
}

#[test]
fn what_no_family_can_hold_is_refused_by_name() {
    let changed = |from: &str, to: &str| {
        assert!(SCENARIO.contains(from), "{from}");
        let folder = folder(&SCENARIO.replace(from, to));
        let words = ["certify", "drawn.toml", "--family", "--format", "json"];
        let output = fspid(&words, folder.path());
        assert_eq!(code(&output), 1, "{}", text(&output.stderr));
        let family = json(&output)["controllers"][0]["family"].clone();
        assert_eq!(family["verdict"], "open");
        family["in_words"].as_str().expect("words").to_owned()
    };
    let open_end = changed("lower = 0.8\nupper = 1.2\n", "");
    assert!(open_end.contains("has no ends"), "{open_end}");
    let gain = changed("path = \"plant.denominator[1]\"", "path = \"controller[0].kp\"");
    assert!(gain.contains("`controller[0].kp`: families know"), "{gain}");
    let sensor = "[sensor]\npreset = \"ideal\"\npitch = { resolution_deg = 0.001 }\n";
    let servo = "[[dispersion]]\nname = \"servo\"";
    let steps = changed(servo, &format!("{sensor}\n{servo}"));
    assert!(steps.contains("a sensor resolves in steps"), "{steps}");
}

/// Sensors that see more or less than there is, each within a share of it.
const SENSORS: &str = r#"
[sensor]
preset = "ideal"
pitch = { delay_s = 0.03, scale_error_pct = 1.0 }
rate = { delay_s = 0.01, scale_error_pct = -2.0 }

[[dispersion]]
name = "pitch sensor"
path = "sensor.pitch.scale_error_pct"
distribution = "uniform"
lower = -15.0
upper = 10.0

[[dispersion]]
name = "rate gyro"
path = "sensor.rate.scale_error_pct"
distribution = "normal"
mean = 1.0
standard_deviation = 1.0
lower = -4.0
upper = 6.0
relative = true

[[dispersion]]
name = "servo"
"#;

#[test]
fn sensors_of_any_scale_between_limits_are_proved_with_plants_and_compared() {
    let scenario = SCENARIO.replacen("[[dispersion]]\nname = \"servo\"\n", SENSORS, 1);
    let scenario = scenario.replace("kd = 0.5", "kd = 0.5\nrate_gain = 0.3");
    let folder = folder(&scenario);
    let output = fspid(&["certify", "drawn.toml", "--family", "--out", "proofs"], folder.path());
    let told = text(&output.stdout);
    assert_eq!(code(&output), 0, "{told}{}", text(&output.stderr));
    let sensors = "pitch sensor (sensor.pitch.scale_error_pct) from -15 to 10; rate gyro (sensor.rate.scale_error_pct) from -4 to 6 times as large";
    assert!(told.contains(sensors) && !told.contains("that a campaign draws"), "{told}");
    let check = |more: &[&str]| {
        let words = ["certify", "--check", "proofs/pid.certificate.json"];
        let output = fspid(&[&words, more].concat(), folder.path());
        (code(&output), text(&output.stdout).to_owned())
    };
    assert_eq!(check(&[]).0, 0);
    assert_eq!(check(&["--against", "drawn.toml"]).0, 0);
    let wider = check(&["--against", "drawn.toml", "--set", "dispersion[2].upper=12"]);
    assert!(wider.0 == 1 && wider.1.contains("from -15 to 12"), "{}", wider.1);
    // Factors are of the loop's own error: with another it is another loop.
    let other = "sensor.rate.scale_error_pct=-4";
    assert_eq!(check(&["--against", "drawn.toml", "--set", other]).0, 1);
    // One draw of both, and one of a sensor and a plant.
    let paths = "paths = [\"sensor.pitch.scale_error_pct\", \"sensor.rate.scale_error_pct\"]";
    let both = scenario.replace("path = \"sensor.pitch.scale_error_pct\"", paths);
    let both = both.replace("path = \"sensor.rate.scale_error_pct\"", "path = \"setpoint.at_s\"");
    let both = both.replace(
        "relative = true\n\n[[dispersion]]\nname = \"servo\"",
        "\n[[dispersion]]\nname = \"servo\"",
    );
    let mixed = both.replace("\"sensor.rate.scale_error_pct\"]", "\"plant.denominator[2]\"]");
    for (file, scenario) in [("both.toml", &both), ("mixed.toml", &mixed)] {
        std::fs::write(folder.path().join(file), scenario.replace("LOOP\n", LOOP))
            .expect("written");
    }
    let output = fspid(&["certify", "both.toml", "--family"], folder.path());
    assert_eq!(code(&output), 0, "{}{}", text(&output.stdout), text(&output.stderr));
    // Together they are proved, and not each by itself.
    assert!(!text(&output.stdout).contains("may change in flight"), "{}", text(&output.stdout));
    let output = fspid(&["certify", "mixed.toml", "--family"], folder.path());
    let refused = text(&output.stdout);
    assert!(code(&output) == 1 && refused.contains("a [[dispersion]] for each"), "{refused}");
}

/// A scenario whose family is proved: where its file and its certificate are, and what is said of it for programs.
fn proved(scenario: &str) -> (tempfile::TempDir, serde_json::Value) {
    let folder = folder(scenario);
    let words = ["certify", "drawn.toml", "--family", "--format", "json", "--out", "proofs"];
    let output = fspid(&words, folder.path());
    assert_eq!(code(&output), 0, "{}{}", text(&output.stdout), text(&output.stderr));
    let family = json(&output)["controllers"][0]["family"].clone();
    (folder, family)
}

/// Beside a plant that stands still, by the text, for programs and of the file alone.
#[test]
fn scales_that_may_change_in_flight_are_told() {
    let (before, after) = SCENARIO.split_at(SCENARIO.find("[[dispersion]]").expect("some"));
    let sensors = SENSORS.strip_suffix("[[dispersion]]\nname = \"servo\"\n").expect("the end");
    let sensed = format!("{before}{sensors}").replace("kd = 0.5", "kd = 0.5\nrate_gain = 0.3");
    let told = |scenario: &str| {
        let (folder, family) = proved(scenario);
        let check = fspid(&["certify", "--check", "proofs/pid.certificate.json"], folder.path());
        let of_the_file = text(&check.stdout).contains("may change in flight");
        let in_words = family["in_words"].as_str().expect("words").contains("may change in flight");
        assert_eq!(in_words, of_the_file, "{}", text(&check.stdout));
        assert_eq!(family["scales_may_change"], in_words);
        in_words
    };
    assert!(told(&sensed));
    assert!(!told(&format!("{before}{after}")));
}

/// By the text, for programs and of the file alone; and not where a coefficient that moves would mean nothing.
#[test]
fn the_time_in_which_numbers_may_cross_their_ranges_in_flight_is_told() {
    let (start, rest) = SCENARIO.split_at(SCENARIO.find("[[dispersion]]").expect("some"));
    let (effect, rest) =
        rest.split_at(rest.find("[[dispersion]]\nname = \"damping\"").expect("one"));
    let (_, servo) = rest.split_at(rest.find("[[dispersion]]\nname = \"servo\"").expect("one"));
    let told = |scenario: &str| {
        let (folder, family) = proved(scenario);
        let file = "proofs/pid.certificate.json";
        let against = ["certify", "--check", file, "--against", "drawn.toml"];
        let check = fspid(&against, folder.path());
        assert_eq!(code(&check), 0, "{}", text(&check.stdout));
        let in_words = family["in_words"].as_str().expect("words").to_owned();
        let said = |text: &str| text.contains("the numbers may move in flight");
        assert_eq!(said(&in_words), said(&text(&check.stdout)), "{}", text(&check.stdout));
        (family["numbers_may_cross_in_s"].as_f64(), in_words)
    };
    let (time_s, in_words) = told(&format!("{start}{effect}{servo}"));
    let time_s = time_s.expect("a time");
    assert!((1.0..=200.0).contains(&time_s), "{time_s}");
    assert!(
        in_words.contains(&format!("at no more than the rate of its whole range in {time_s} s")),
        "{in_words}"
    );
    assert_eq!(told(SCENARIO).0, None);
}

#[test]
fn a_family_with_an_unstable_member_is_refuted_with_the_member() {
    let slow = SCENARIO.replace("lower = 0.08\nupper = 0.12", "lower = 0.08\nupper = 2.5");
    let slow = slow.replace("kp = 1.2", "kp = 8.0");
    let folder = folder(&slow);
    let output = fspid(&["certify", "drawn.toml", "--family"], folder.path());
    assert_eq!(code(&output), 1);
    let told = text(&output.stdout);
    assert!(told.contains("REFUTED: with gains that the controller has"), "{told}");
    let at = told.split("servo (actuator.time_constant_s) ").last().expect("a member");
    let lag_s = at.split_whitespace().next().expect("a number");
    let set = format!("actuator.time_constant_s={lag_s}");
    let member = fspid(&["certify", "drawn.toml", "--set", &set], folder.path());
    assert!(text(&member.stdout).contains("REFUTED"), "{}", text(&member.stdout));
}

const AIRCRAFT: &str = r#"
schema = 1
name = "Any load, any speed"

[aircraft]
name = "navion"
airspeed_m_s = 53.6
altitude_ft = 1000.0
mass_kg = 1240.0

LOOP
name = "PID"
kind = "pid"
kp = 1.0
ki = 0.4
kd = 0.2

[[dispersion]]
name = "mass"
path = "aircraft.mass_kg"
distribution = "uniform"
lower = 1150.0
upper = 1300.0

[[dispersion]]
name = "speed"
path = "aircraft.airspeed_m_s"
distribution = "uniform"
lower = 51.0
upper = 56.0

[[dispersion]]
name = "altitude"
path = "aircraft.altitude_ft"
distribution = "uniform"
lower = 100.0
upper = 2000.0

[[dispersion]]
name = "stiffness"
path = "aircraft.name.longitudinal.pitch.alpha"
distribution = "uniform"
lower = 0.9
upper = 1.1
relative = true
"#;

#[test]
fn an_aircraft_is_proved_for_any_mass_speed_and_altitude_between_limits() {
    let folder = folder(AIRCRAFT);
    let output = fspid(&["certify", "drawn.toml", "--family", "--out", "proofs"], folder.path());
    let told = text(&output.stdout);
    assert_eq!(code(&output), 0, "{told}{}", text(&output.stderr));
    assert!(told.contains("mass (aircraft.mass_kg) from 1150 to 1300; speed"), "{told}");
    let words = ["certify", "--check", "proofs/pid.certificate.json", "--against", "drawn.toml"];
    let output = fspid(&words, folder.path());
    assert_eq!(code(&output), 0, "{}", text(&output.stdout));
}

/// A Navion whose gains a schedule moves by powers of the dynamic pressure, which are 1 at either end of each draw alone.
const SCHEDULED: &str = r#"
schema = 1
name = "scheduled"
[aircraft]
name = "navion"
model = "linear"
airspeed_m_s = 53.6
altitude_m = 1000.0
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.02
duration_s = 4.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
[[controller]]
name = "PID"
kind = "pid"
kp = 0.82
ki = 0.43
kd = 0.165
derivative_filter_s = 0.05
schedule = { dynamic_pressure_pa = 1765.0, exponent = 60.0, least_factor = 1.0 }
[[dispersion]]
path = "aircraft.airspeed_m_s"
distribution = "uniform"
lower = 50.0
upper = 56.0
[[dispersion]]
path = "aircraft.altitude_m"
distribution = "uniform"
lower = 0.0
upper = 2000.0
[[disturbance]]
kind = "step"
enters_at = "elevator"
amplitude_deg = 0.0
at_s = 1.0
[[dispersion]]
path = "disturbance[0].amplitude_deg"
distribution = "uniform"
lower = 0.0
upper = 4.0
"#;

/// The later draw had the say, and the earlier one's limits were told as if all between were members.
#[test]
fn a_number_that_is_drawn_twice_in_other_words_makes_no_family() {
    let schedule = SCHEDULED.lines().find(|line| line.starts_with("schedule")).expect("there");
    let once = "distribution = \"uniform\"\nlower = 0.1\nupper = 0.2\n";
    let twice = format!(
        "{}[[dispersion]]\npath = \"controller.PID.kp\"\n{once}[[dispersion]]\npath = \"controller[0].kp\"\n{once}",
        SCHEDULED.replace(schedule, "")
    );
    let folder = folder(&twice);
    let refused = fspid(&["certify", "drawn.toml", "--family"], folder.path());
    let told = text(&refused.stdout) + &text(&refused.stderr);
    assert_ne!(code(&refused), 0, "{told}");
    assert!(told.contains("`controller[0].kp` is drawn already, as `controller.PID.kp`"), "{told}");
}

/// It was proved for all of it, and at 56 m/s and sea level it flies apart within two seconds.
#[test]
fn numbers_that_gains_are_scheduled_by_make_no_family() {
    let folder = folder(SCHEDULED);
    let refused = fspid(&["certify", "drawn.toml", "--family"], folder.path());
    assert_eq!(code(&refused), 1);
    let told = text(&refused.stdout);
    assert!(told.contains("OPEN: `aircraft.airspeed_m_s`"), "{told}");
    assert!(told.contains("scheduled from it"), "{told}");
    let corner = ["--set", "aircraft.airspeed_m_s=56.0", "--set", "aircraft.altitude_m=0.0"];
    let flown = fspid(&[&["simulate", "drawn.toml"], &corner[..]].concat(), folder.path());
    assert!(
        code(&flown) == 1 && text(&flown.stdout).contains("diverged"),
        "{}",
        text(&flown.stdout)
    );
}

/// A family took the sentence about drawn numbers away, those of loads with it.
#[test]
fn what_is_drawn_of_loads_is_named_beside_a_family() {
    let schedule = SCHEDULED.lines().find(|line| line.starts_with("schedule")).expect("a schedule");
    let folder = folder(&SCHEDULED.replace(schedule, ""));
    let path = folder.path();
    let proved = fspid(&["certify", "drawn.toml", "--family", "--out", "c"], path);
    let told = text(&proved.stdout);
    assert_eq!(code(&proved), 0, "{told}");
    assert!(told.contains("not as the dispersions draw them"), "{told}");
    assert!(!told.contains("nominal numbers"), "{told}");
    let compared = ["certify", "--check", "c/pid.certificate.json", "--against", "drawn.toml"];
    assert_eq!(code(&fspid(&compared, path)), 0);
}

/// It was PROVED IN PART with an open family, and `check` refused it.
#[test]
fn a_dispersion_of_what_is_not_there_is_refused_before_anything_is_proved() {
    let folder =
        folder(&SCENARIO.replace("actuator.time_constant_s\"", "actuator.time_constants_s\""));
    let refused = fspid(&["certify", "drawn.toml", "--family"], folder.path());
    assert_eq!(code(&refused), 2);
    let told = text(&refused.stderr);
    assert!(
        told.contains(
            "there is no `actuator.time_constants_s`; did you mean `actuator.time_constant_s`?"
        ),
        "{told}"
    );
}
