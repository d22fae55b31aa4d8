//! Loops that are proved, of flights that do not hold.

use fspid_scenario::file::parse;
use serde_json::json;

use crate::{Certification, Effort};

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
