//! What an envelope says of an aircraft that runs away by itself, and of the loop of a scenario at each point.

use fspid_study::aircraft::{
    Category, Class, Envelope, EnvelopeQuestion, LoadingQuestion, QualitiesQuestion, Question,
    envelope, qualities,
};
use fspid_study::analysis::{Analysis, Question as LoopQuestion};
use fspid_study::simulation::Simulation;
use serde_json::Value;

/// A Navion with little gain of its pitch loop, near the end of what that holds.
const NAVION: &str = r#"
schema = 1
name = "e"
[aircraft]
name = "navion"
airspeed_m_s = 53.6448
altitude_m = 500.0
cg_mac = 0.56
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.01
duration_s = 20.0
[setpoint]
kind = "step"
amplitude_deg = 2.0
at_s = 1.0
[[controller]]
name = "PID"
kind = "pid"
kp = 0.5
ki = 0.0
kd = 0.3
derivative_filter_s = 0.05
"#;

const SPEEDS: &str = "36:53.6448:2";

fn navion(cg: &str) -> Question<'_> {
    let loading = LoadingQuestion { cg: Some(cg), ..LoadingQuestion::default() };
    Question { aircraft: "navion", loading, ..Question::default() }
}

/// Answers for people and for programs over two speeds.
fn asked(cg: &str, scenario: Option<&str>) -> (String, Value) {
    let found = over(navion(cg), [SPEEDS, "500:500:1"], scenario);
    (found.text(), found.json())
}

fn over(question: Question<'_>, [speeds, altitudes]: [&str; 2], loops: Option<&str>) -> Envelope {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("loop.toml");
    std::fs::write(&path, loops.unwrap_or_default()).expect("written");
    let question = EnvelopeQuestion {
        question,
        speeds,
        altitudes,
        category: Category::B,
        scenario: loops.map(|_| path.as_path()),
        controller: None,
    };
    envelope(&question).expect("it is answered")
}

/// The Navion as it is, at one speed and altitude.
fn at(place: [&str; 2], scenario: &str) -> Envelope {
    let question = Question { aircraft: "navion", ..Question::default() };
    over(question, place, Some(scenario))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// A margin of 1.85 dB downwards was "gain margin up to 40 dB, least 18.9141 dB".
#[test]
fn the_gain_margin_of_an_envelope_is_the_smaller_of_both_ways() {
    let (text, json) = asked("0.56", Some(NAVION));
    let fast = &json["points"][1];
    let margin_db = number(&fast["loop_gain_margin_db"]);
    assert!((margin_db - 1.85).abs() < 0.02, "{margin_db}");
    assert!(text.contains("loop, smaller gain margin up to 40 dB"), "{text}");
}

/// Every point was asked with the gains of the scenario's own trim: stable at all of them.
#[test]
fn an_envelope_asks_with_the_gains_that_a_schedule_makes_at_each_point() {
    let fixed = NAVION
        .replace("cg_mac = 0.56", "cg_mac = 0.3")
        .replace("kp = 0.5\nki = 0.0\nkd = 0.3", "kp = 6.0\nki = 3.0\nkd = 1.5");
    let scheduled = format!("{fixed}schedule = {{ dynamic_pressure_pa = 1763.0 }}\n");
    let (text, json) = asked("0.3", Some(&scheduled));
    let radius =
        |json: &Value, point: usize| number(&json["points"][point]["loop_spectral_radius"]);
    assert!(radius(&json, 0) > 1.0 && radius(&json, 1) < 1.0, "{json}");
    assert!(text.contains("at its gains as scheduled at each point\n  stable at 1 of 2"), "{text}");
    for (point, airspeed_m_s) in [36.0, 53.6448].into_iter().enumerate() {
        let set = [format!("aircraft.airspeed_m_s={airspeed_m_s:?}")];
        let study = fspid_scenario::file::parse(&scheduled, "loop.toml", None, &set);
        let flown = Simulation::of(&study.expect("a scenario")).expect("it flies");
        let unstable = flown.results[0].at_rest.unstable.is_some();
        assert_eq!(unstable, radius(&json, point) > 1.0, "{airspeed_m_s}");
    }
    let (text, json) = asked("0.3", Some(&fixed));
    assert!(radius(&json, 0) < 1.0 && text.contains("at its gains\n"), "{text}");
}

/// The scenario's own mass and inertia went unused without a word.
#[test]
fn an_envelope_says_whose_aircraft_the_loop_is_asked_around() {
    let heavy = NAVION.replace("cg_mac", "mass_kg = 900.0\ncg_mac");
    let (text, json) = asked("0.3", Some(&heavy));
    let told = "aircraft, loading and air are those of this command";
    assert!(text.contains(told), "{text}");
    assert!(json["loop"].as_str().is_some_and(|words| words.contains(told)), "{json}");
    let (_, other) = asked("0.3", Some(&NAVION.replace("cg_mac = 0.56", "cg_mac = 0.2")));
    assert_eq!(json["points"], other["points"]);
    let (_, none) = asked("0.3", None);
    assert!(none["loop"].is_null() && none["null"]["loop"].is_string(), "{none}");
}

/// "4 of 4 points can be flown" was all that was said of a divergence that doubles in 2.7 s, and three levels of 1.
#[test]
fn a_divergence_that_has_no_name_is_judged_and_told() {
    let (text, json) = asked("0.5", None);
    assert!(text.contains("grows by itself at 2 of them, at the fastest to double in"), "{text}");
    let doubles_s = number(&json["points"][1]["longitudinal_time_to_double_s"]);
    let judged = qualities(&QualitiesQuestion {
        question: navion("0.5"),
        category: Category::B,
        class: Some(Class::I),
        servo_rad_s: 0.0,
        delay: "0",
    });
    let judged = judged.expect("it is judged").json();
    let of_qualities_s = number(&judged["values"]["divergence_time_to_double_s"]);
    assert!((of_qualities_s - 2.74).abs() < 0.01, "{judged}");
    assert!(doubles_s > 2.0 && doubles_s < 3.5, "{doubles_s}");
    let levels = judged["levels"].as_array().expect("levels");
    let of_speed = levels.iter().find(|level| level["requirement"] == "speed stability");
    assert_eq!(of_speed.expect("it is judged")["level_in_words"], "worse than level 3");
    let (text, json) = asked("0.2", None);
    assert!(!text.contains("grows by itself"), "{text}");
    assert!(json["points"][1]["longitudinal_time_to_double_s"].is_null(), "{json}");
}

/// Sensors of a Navion's loop, late by so much, each with its clock or without.
fn late_sensors(pitch: &str, rate: &str) -> String {
    format!(
        r#"
schema = 1
name = "late sensor"
[aircraft]
name = "navion"
airspeed_m_s = 53.6
altitude_m = 300.0
[actuator]
time_constant_s = 0.05
[loop]
sample_period_s = 0.01
duration_s = 20.0
[setpoint]
kind = "step"
amplitude_deg = 0.1
at_s = 1.0
[sensor]
preset = "ideal"
[sensor.pitch]
{pitch}
delay_s = 0.03
[sensor.rate]
{rate}
delay_s = 0.03
[[controller]]
name = "PID"
kind = "pid"
kp = 4.0
ki = 0.5
kd = 0.4
derivative_on = "measurement"
derivative_filter_s = 0.03
rate_gain = 1.7
"#
    )
}

const SLOW: [&str; 2] = ["53.6:53.6:1", "300:300:1"];

/// What `analyse` says of the only controller of a scenario.
fn analysed(scenario: &str) -> Value {
    let study = fspid_scenario::file::parse(scenario, "loop.toml", None, &[]).expect("a scenario");
    let analysis = Analysis::of(&study, LoopQuestion::default()).expect("it is answered");
    analysis.json()["controllers"][0].clone()
}

/// It was "stable at 1 of 1 points" with 17.86 dB: sensors with a clock were left out.
#[test]
fn an_envelope_calls_a_loop_unstable_that_the_clocks_of_its_sensors_make_so() {
    let scenario = late_sensors("period_s = 0.024", "period_s = 0.078");
    assert_eq!(analysed(&scenario)["stability"], "unstable");
    let found = at(SLOW, &scenario);
    let (text, csv, json) = (found.text(), found.csv(), found.json());
    let point = &json["points"][0];
    assert_eq!(point["loop_stability"], "unstable");
    let radius = number(&point["loop_spectral_radius"]);
    assert!((radius - 1.016265).abs() < 1e-6, "{radius}");
    assert!(point["loop_gain_margin_db"].is_null() && number(&point["loop_decay_per_s"]) < 0.0);
    assert!(text.contains("stable at 0 of 1 points, unstable at 1\n"), "{text}");
    assert!(csv.lines().nth(1).is_some_and(|line| line.contains(",unstable,")), "{csv}");
    assert_eq!(
        json["loop_points"],
        serde_json::json!({"stable": 0, "unstable": 1, "undecided": 0})
    );
}

/// Of `sensor-irs` and `sensor-ahrs` 18.69 dB were told in place of 12.66 and 14.18, and `sensor-vertical-gyro` was called stable.
#[test]
fn an_envelope_says_of_a_loop_behind_sensors_what_analyse_says_at_that_trim() {
    for (scenario, stability) in [
        (include_str!("../../../scenarios/gallery/sensor-irs.toml"), "stable"),
        (include_str!("../../../scenarios/gallery/sensor-ahrs.toml"), "stable"),
        (include_str!("../../../scenarios/gallery/sensor-vertical-gyro.toml"), "undecided"),
    ] {
        let json = at(["176ft/s:176ft/s:1", "1000ft:1000ft:1"], scenario).json();
        let (point, expected) = (&json["points"][0], analysed(scenario));
        assert_eq!(point["loop_stability"], stability, "{point}");
        assert_eq!(expected["stability"], stability, "{expected}");
        let margin_db = &point["loop_gain_margin_db"];
        if stability == "stable" {
            // Nothing becomes unstable by less gain.
            let expected_db = number(&expected["gain_margin_db"][1]);
            assert!((number(margin_db) - expected_db).abs() < 1e-6, "{margin_db} {expected_db}");
        } else {
            assert!(margin_db.is_null() && point["loop_spectral_radius"].is_null(), "{point}");
            let reason = point["loop_reason"].as_str().expect("a reason");
            assert_eq!(expected["undecided"], format!("undecided: {reason}"));
        }
    }
}

#[test]
fn an_undecided_point_of_an_envelope_is_counted_and_told_wherever_points_are() {
    let gyro = include_str!("../../../scenarios/gallery/sensor-vertical-gyro.toml");
    let found = at(["176ft/s:200ft/s:2", "1000ft:1000ft:1"], gyro);
    let (text, csv, json) = (found.text(), found.csv(), found.json());
    let count = |word: &str| json["loop_points"][word].as_u64().expect("a count");
    assert!(count("undecided") > 0 && count("stable") + count("undecided") == 2, "{json}");
    assert!(
        text.contains(&format!(" of 2 points, undecided at {}\n", count("undecided"))),
        "{text}"
    );
    let why = "with the erection of the vertical gyro small motions grow";
    assert!(text.contains(&format!("undecided first at 53.6448 m/s, 304.8 m: {why}")), "{text}");
    assert!(csv.lines().nth(1).is_some_and(|line| line.contains(",undecided,")), "{csv}");
    assert!(csv.contains(why), "{csv}");
    let figures = found.figures();
    let map = figures.iter().find(|(name, _)| *name == "loop_stability").expect("a map");
    assert!(map.1.as_str().contains("undecided"), "{}", map.1.as_str());
}

/// Told before clocks were asked: 2.266 dB, found to a hundredth, and a radius of 0.9995180795.
#[test]
fn an_envelope_says_of_sensors_without_a_clock_what_it_said() {
    let json = at(SLOW, &late_sensors("", "")).json();
    let point = &json["points"][0];
    assert_eq!(point["loop_stability"], "stable");
    let read = |key: &str| number(&point[key]);
    assert!((read("loop_gain_margin_db") - 2.266).abs() < 0.02, "{point}");
    assert!((read("loop_spectral_radius") - 0.999_518_079_5).abs() < 1e-7, "{point}");
    assert!((read("loop_decay_per_s") - 0.048_203_66).abs() < 1e-5, "{point}");
    assert!(point["loop_reason"].is_null(), "{point}");
}
