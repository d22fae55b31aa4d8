//! Loops that are proved, of flights that do not hold.

use fspid_scenario::file::{Extra, Template, parse};
use serde_json::json;

use crate::{Certification, CheckedFile, Effort, Question, Subject, check_text};

/// A Navion at 40 m/s that is told to go down by 6 deg, which it does at 53 m/s, where the elevator goes from stop to stop.
const DIVE: &str = r#"
schema = 1
name = "dive"
[aircraft]
name = "navion"
airspeed_m_s = 40.0
altitude_ft = 3000.0
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.02
duration_s = 10.0
[setpoint]
kind = "step"
amplitude_deg = -6.0
at_s = 1.0
[[controller]]
name = "PID"
kind = "pid"
kp = 7.0
ki = 0.5
kd = 0.9
derivative_filter_s = 0.05
"#;

/// What a longer flight or the wings do that no claim speaks of: it was PROVED, "the flown loop is stable", and exit code 0, where
/// the flight diverges and the same file does not hold against the scenario.
#[test]
fn a_loop_is_not_called_proved_where_its_flight_does_not_hold() {
    let study = |set: &[&str]| {
        let set: Vec<String> = set.iter().map(|&it| it.to_owned()).collect();
        parse(DIVE, "dive.toml", None, &set).unwrap_or_else(|problems| panic!("{problems}"))
    };
    let wings = ["aircraft.name.lateral.roll.beta=0.5", "aircraft.iz_slug_ft2=100.0"];
    let calm = ["setpoint.amplitude_deg=-0.5", "controller.PID.kp=1.0"];
    for (set, holds) in [(&[][..], false), (&wings[..], false), (&calm[..], true)] {
        let study = study(set);
        let found = Certification::of(&study, None, &Effort::default()).expect("certified");
        let (text, answer) = (found.text(), found.json());
        assert_eq!(found.all_proved(), holds, "{text}");
        assert_eq!(text.contains("NOT PROVED as it flies: "), !holds, "{text}");
        assert_eq!(text.contains("\n  PROVED: "), holds, "{text}");
        let verdict = if holds { "proved" } else { "not proved as it flies" };
        assert_eq!(answer["controllers"][0]["verdict"], json!(verdict));
        assert_eq!(answer["controllers"][0]["not_held"].is_null(), holds);
        let bearing = if holds { "flown-loop-stable" } else { "pitch-loop-stable" };
        assert_eq!(answer["controllers"][0]["bearing"], json!(bearing));
    }
}

/// All airspeeds of a box at which a Navion flies on, with gains that hold its pitch loop at each.
const SPEEDS: &str = r#"
[[dispersion]]
name = "speed"
path = "aircraft.airspeed_m_s"
distribution = "uniform"
lower = 42.0
upper = 62.0
"#;

/// Holds at 52 m/s, and at 56 m/s no longer.
const OUTER_LOOP: &str = r#"
[[outer_loop]]
name = "vertical speed"
kind = "pid"
holds = "vertical-speed"
moves = "pitch"
kp = 3.2
ki = 0.5
least = -10.0
most = 10.0
[[mode]]
name = "level"
engage = ["vertical speed"]
"#;

/// That airspeeds are few enough that what flies beside the pitch loop holds at all of them.
const SLOW: &str = "dispersion[0].upper=47.0";
/// Wings that grow from some 47 m/s on.
const WINGS: &str = "aircraft.name.lateral.yaw.beta=-0.016";
/// A linear plant, as far as what flies goes.
const LINEAR: &str = "aircraft.model=linear";

fn family_of_speeds(beside: &str, set: &[&str]) -> Template {
    let text = DIVE.to_owned() + SPEEDS + beside;
    let calm = [
        "aircraft.airspeed_m_s=46.0",
        "setpoint.amplitude_deg=0.0",
        "controller.PID.kp=1.0",
        "controller.PID.ki=0.4",
        "controller.PID.kd=0.2",
    ];
    let overrides: Vec<String> = calm.iter().chain(set).map(|&it| it.to_owned()).collect();
    let extra = Extra { overrides: &overrides, ..Extra::default() };
    Template::parse(&text, "speeds.toml", None, &extra).unwrap_or_else(|it| panic!("{it}"))
}

fn asked(template: &Template) -> (Certification, String) {
    let effort = Effort::default();
    let question = Question {
        only: None,
        disturbances: false,
        family: true,
        nonlinear: false,
        effort: &effort,
    };
    let found = Certification::answering(template, question, &mut |_| {}).expect("certified");
    let page = found.page(Subject { study: template.study(), question, folder: None });
    (found, page.expect("certificates can be written"))
}

/// The written family, held against what it is of.
fn against(found: &Certification, template: &Template) -> CheckedFile {
    let file = &found.certificate_files().expect("written")[0];
    let mut checked = check_text(&file.text).expect("a certificate");
    checked.compare_family(template).expect("compared");
    checked
}

/// Whether outer loops and wings hold was asked at the scenario's own airspeed alone: PROVED, "HOLDS, AND IS WHAT FLIES" and exit
/// code 0, of a box with airspeeds at which `certify` says that they do not.
#[test]
fn a_family_is_not_called_proved_where_a_member_does_not_hold_as_it_flies() {
    for (beside, set, reason) in [
        (
            OUTER_LOOP,
            &[][..],
            "UNSTABLE with the outer loops of mode level (spectral radius 1.0063",
        ),
        ("", &[WINGS][..], "undecided: about the trim something grows that is no pitching"),
    ] {
        let template = family_of_speeds(beside, set);
        let (found, page) = asked(&template);
        let (text, answer) = (found.text(), found.json());
        let told = format!("NOT PROVED as it flies: at speed (aircraft.airspeed_m_s) 62: {reason}");
        assert!(text.contains(&told) && !found.all_proved(), "{text}");
        let family = &answer["controllers"][0]["family"];
        assert_eq!(family["verdict"], "not proved as it flies");
        assert_eq!(family["at"][0]["at"], 62.0);
        assert!(family["not_held"].as_str().expect("a reason").starts_with(reason), "{family}");
        assert!(family["in_words"].as_str().expect("words").starts_with(&told), "{family}");
        assert!(
            page.contains("NOT PROVED as it flies: at speed")
                && page.contains(if beside.is_empty() {
                    "PROVED IN PART"
                } else {
                    "for the pitch loop alone"
                })
                && !page.contains("verdict good")
        );
        let checked = against(&found, &template);
        let text = checked.text();
        let differs = format!(
            "    family.at_rest: certified stable, flown at speed (aircraft.airspeed_m_s) 62: {reason}"
        );
        assert!(!checked.holds() && text.contains(&differs), "{text}");
    }
}

/// What is proved of every member are pitch loops, and of a linear plant without limits there is nothing else.
#[test]
fn a_family_says_of_how_many_members_it_was_asked_whether_they_hold_as_they_fly() {
    for (beside, set, what) in [
        (
            OUTER_LOOP,
            &[SLOW][..],
            Some("outer loops, roll and yaw hold at rest and no flight swings at limits"),
        ),
        ("", &[SLOW][..], Some("roll and yaw hold at rest and no flight swings at limits")),
        ("", &[LINEAR, WINGS][..], None),
        ("", &[LINEAR, "actuator.rate_limit_deg_s=60"][..], Some("no flight swings at limits")),
    ] {
        let template = family_of_speeds(beside, set);
        let (found, page) = asked(&template);
        let (text, answer) = (found.text(), found.json());
        assert!(found.all_proved() && !text.contains("NOT PROVED"), "{text}");
        let family = &answer["controllers"][0]["family"];
        assert_eq!(family["verdict"], "proved");
        assert_eq!(family["members_asked"], json!(what.map(|_| 3)));
        let time_s = family["numbers_may_cross_in_s"].as_f64().expect("a time");
        let row = "time in which a number may go through its range, at least</th>";
        let (_, rest) = page.split_once(row).expect("a row of the time");
        assert!(rest.split_once("</tr>").expect("a row").0.contains(&format!(">{time_s}</td>")));
        assert!(page.contains("scales of sensors may change from sample to sample</th>"));
        let checked = against(&found, &template);
        assert!(checked.holds(), "{}", checked.text());
        let told = what.map(|what| format!("That in the family {what} was asked of 3 members, at corners of the box and in its middle, and is not proved between them."));
        for text in [&text, &page, &checked.text()] {
            assert!(told.as_ref().is_none_or(|it| text.contains(it)), "{text}");
            assert_eq!(text.contains("That in the family"), told.is_some());
        }
        let without = format!("                     {}", told.unwrap_or_default());
        assert!(text.contains(&without), "among what is not in the claim: {text}");
    }
}

/// Between the limits of its servo it swings on for ever, after a step of 10 deg; after one of 1 deg it settles.
const SWING: &str = r#"
schema = 1
name = "swing"
[plant]
numerator = [2.29451, 2.24784]
denominator = [1.0, 0.16297, 1.20207, -0.02404]
elevator_sign = "nose-up-positive"
[actuator]
natural_frequency_rad_s = 29.02
damping = 0.91
rate_limit_deg_s = 36.77
[loop]
sample_period_s = 0.02
duration_s = 20.0
[setpoint]
kind = "step"
amplitude_deg = 10.42
at_s = 1.0
[[controller]]
name = "PID"
kind = "pid"
kp = 2.798
ki = 0.28
kd = 0.699
derivative_filter_s = 0.072
[[dispersion]]
name = "kp"
path = "plant.numerator[1]"
distribution = "uniform"
lower = 2.2
upper = 2.3
"#;

/// It was PROVED, "HOLDS, AND IS WHAT FLIES", where `analyse` and `verify` call it undecided.
#[test]
fn a_loop_that_swings_at_its_limits_is_not_called_proved_and_is_not_what_flies() {
    for (set, holds) in [(&[][..], false), (&["setpoint.amplitude_deg=1.0"][..], true)] {
        let overrides: Vec<String> = set.iter().map(|&it: &&str| it.to_owned()).collect();
        let extra = Extra { overrides: &overrides, ..Extra::default() };
        let template = Template::parse(SWING, "swing.toml", None, &extra);
        let template = template.unwrap_or_else(|it| panic!("{it}"));
        let alone = Certification::of(template.study(), None, &Effort::default());
        let (family, _) = asked(&template);
        for found in [&alone.expect("certified"), &family] {
            assert_eq!(found.all_proved(), holds, "{}", found.text());
            let told =
                "NOT PROVED as it flies: undecided: limits are met, and the flight does not settle";
            assert_eq!(found.text().contains(told), !holds, "{}", found.text());
            let checked = against(found, &template);
            assert_eq!(checked.holds(), holds, "{}", checked.text());
        }
    }
}
