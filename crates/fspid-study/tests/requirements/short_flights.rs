//! What a flight that ends too early cannot show.

use fspid_scenario::file::{self, Study};
use fspid_study::judgement::NotEvaluated;
use fspid_study::metrics::{Absent, Verdict};
use fspid_study::simulation::Simulation;

/// A lag that comes to its set-point without overshoot, and settles some 3.9 s after the step.
const SLOW: &str = r#"
schema = 1
name = "a slow step"
[plant]
numerator = [1.0]
denominator = [1.0, 0.0]
elevator_sign = "nose-up-positive"
[loop]
sample_period_s = 0.01
duration_s = 10.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
at_s = 0.0
[[controller]]
name = "P"
kind = "p"
kp = 1.0
[[requirement]]
measure = "overshoot_pct"
most = 5.0
[[requirement]]
measure = "settling_time_s"
most = 8.0
[[requirement]]
measure = "recovery_time_s"
within_deg = 0.02
most = 8.0
"#;

fn judged(set: &[&str]) -> Simulation {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    let study: Study =
        file::parse(SLOW, "test.toml", None, &set).unwrap_or_else(|problems| panic!("{problems}"));
    Simulation::of(&study).expect("it flies")
}

#[test]
fn a_step_that_has_not_risen_has_no_overshoot_to_judge() {
    let found = judged(&["loop.duration_s=2.0"]);
    let overshoot = &found.judgements[0];
    assert!(!overshoot.met);
    assert!(
        matches!(overshoot.found, Err(NotEvaluated::Absent(Absent::NotRisen { .. }))),
        "{:?}",
        overshoot.found
    );
    // It still rises then, slower and slower, and not beyond its set-point.
    for duration_s in [2.5, 4.4] {
        assert!(judged(&[&format!("loop.duration_s={duration_s}")]).judgements[0].met);
    }
}

/// A step of the paper's Navion under gains that swing.
const SWINGS: &str = r#"
schema = 1
name = "swings"
[plant]
preset = "navion-paper"
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.01
duration_s = 9.88
[setpoint]
kind = "step"
amplitude_deg = 5.0
[[controller]]
name = "N"
kind = "pid"
kp = 3.0
ki = 1.0
[[requirement]]
measure = "largest_error_deg"
from_s = 9.87
most = 0.1
[[requirement]]
measure = "rms_error_deg"
from_s = 9.87
most = 0.1
[[requirement]]
measure = "final_error_pct"
most = 2
[[requirement]]
measure = "overshoot_pct"
most = 5
"#;

const CREEPS: &str = r#"
schema = 1
name = "s94"

[plant]
numerator = [8.6921, 40.473894]
denominator = [1.0, 7.39422199, 27.6644441, 0.0]
elevator_sign = "nose-up-positive"

[actuator]
time_constant_s = 0.05458

[loop]
sample_period_s = 0.05
duration_s = 9.16

[setpoint]
kind = "step"
amplitude_deg = 5.0
at_s = 0.0

[sensor]
preset = "ideal"
seed = 284
pitch = { delay_s = 0.19249, scale_error_pct = -4.2397 }

[[controller]]
name = "C"
kind = "lqi"
design = { pitch_damping_per_s = 0.31412, elevator_power_per_s2 = 8.6485 }
weights = { pitch = 2.6683, rate = 0.98007, integral = 0.30212 }

[[requirement]]
measure = "overshoot_pct"
most = 1.307
"#;

const SWINGS_ON: &str = r#"
schema = 1
name = "s42"

[plant]
numerator = [1.7649, 1.714918, 0.33716142]
denominator = [1.0, 0.216985255, 0.541975716, 0.0]
elevator_sign = "nose-up-positive"

[actuator]
time_constant_s = 0.089313
rate_limit_deg_s = 25.616
bias_deg = 0.61164

[loop]
sample_period_s = 0.1
duration_s = 8.12

[setpoint]
kind = "step"
amplitude_deg = 5.0
at_s = 0.0

[sensor]
preset = "ideal"
seed = 850
pitch = { delay_s = 0.3 }

[[controller]]
name = "C"
kind = "fspid"
nominal = { kp = 0.18221, ki = 0.089017, kd = 0.0 }
setpoint_weights = { proportional = 0.76197, derivative = 0.46226 }
output_limits_deg = [-6.33, 6.33]
anti_windup = { kind = "back-calculation", tracking_s = 1.6364 }
supervisor = { table = "printed", range = 20.0, error_scale = 6.1672, change_scale = 1.0446, second_input = "error-and-model-error", model = { bandwidth_rad_s = 1.5783, damping = 1.1193 }, output_scale = { kp = 0.0029284, ki = 0.00031795, kd = 6.9815e-05 } }

[[requirement]]
measure = "overshoot_pct"
most = 44.45
"#;

fn swings(set: &[&str]) -> Vec<Result<f64, NotEvaluated>> {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    let study: Study = file::parse(SWINGS, "test.toml", None, &set)
        .unwrap_or_else(|problems| panic!("{problems}"));
    let judgements = Simulation::of(&study).expect("it flies").judgements;
    judgements.into_iter().map(|it| it.found.map(|case| case.value)).collect()
}

/// All were met at 9.88 s, where the swing goes through its set-point, and none of them at 12 s.
#[test]
fn errors_of_a_swing_are_not_met_by_its_last_samples() {
    let found = swings(&[]);
    for at in [0, 1] {
        assert!(matches!(found[at], Err(NotEvaluated::LittleFlown { .. })), "{found:?}");
    }
    assert!(matches!(found[2], Err(NotEvaluated::NotLeft { .. })), "{found:?}");
    let longer = swings(&["loop.duration_s=12", "requirement[2].most=99"]);
    assert!(longer[..3].iter().all(Result::is_ok), "{longer:?}");
}

/// 3 % when the flight ended after 0.68 s, and 39 % in a longer one.
#[test]
fn a_response_that_goes_on_at_the_end_has_no_overshoot_to_judge() {
    let slower = ["controller[0].kp=1.0", "controller[0].ki=0.9"];
    let found = swings(&[
        slower[0],
        slower[1],
        "loop.duration_s=0.68",
        "requirement[0].from_s=0.0",
        "requirement[1].from_s=0.0",
    ]);
    assert!(matches!(found[3], Err(NotEvaluated::StillRising { .. })), "{found:?}");
    let found = swings(&[
        slower[0],
        slower[1],
        "loop.duration_s=5.0",
        "requirement[0].from_s=0.0",
        "requirement[1].from_s=0.0",
    ]);
    assert!(found[3].as_ref().is_ok_and(|pct| *pct > 39.0), "{found:?}");
}

/// A delayed loop of a lag and an integrator under a regulator with an integral, which goes 4.4 % beyond its set-point in 30 s,
/// and one whose second peak, of 48.5 %, is larger than the first.
#[test]
fn an_overshoot_is_not_met_while_it_grows_or_swings_beyond_its_limit() {
    let judged = |text: &str, duration_s: f64| {
        let set = [format!("loop.duration_s={duration_s:?}")];
        let study = file::parse(text, "test.toml", None, &set).expect("allowed");
        let mut judgements = Simulation::of(&study).expect("it flies").judgements;
        judgements.remove(0).found.map(|case| case.value)
    };
    let is_open =
        |found: &Result<f64, NotEvaluated>| matches!(found, Err(NotEvaluated::StillRising { .. }));
    // It had settled within 2 %, and was met with 0.78 %.
    let creeps = judged(CREEPS, 9.16);
    assert!(is_open(&creeps), "{creeps:?}");
    assert!(judged(CREEPS, 60.0).is_ok_and(|pct| pct > 4.4));
    // Its first peak was met.
    let swings = judged(SWINGS_ON, 8.12);
    assert!(is_open(&swings), "{swings:?}");
    assert!(judged(SWINGS_ON, 60.0).is_ok_and(|pct| pct > 48.0));
}

/// Within the longest time that is allowed, or for a tenth of its own time after it.
#[test]
fn a_time_to_settle_counts_where_the_flight_goes_on() {
    for (duration_s, most_s, met) in [
        (10.0, 8.0, true),
        (4.0, 8.0, false),
        (4.0, 4.0, true),
        (4.25, 8.0, false),
        (4.4, 8.0, true),
    ] {
        let found = judged(&[
            &format!("loop.duration_s={duration_s}"),
            &format!("requirement[1].most={most_s}"),
            &format!("requirement[2].most={most_s}"),
        ]);
        for judgement in &found.judgements[1..] {
            assert_eq!(judgement.met, met, "{duration_s} {most_s}: {:?}", judgement.found);
            let is_short = matches!(judgement.found, Err(NotEvaluated::TooShort { .. }));
            assert_eq!(is_short, !met, "{duration_s} {most_s}: {:?}", judgement.found);
        }
    }
}

/// A swing that goes on was "settled", for its last sample lay in the band.
#[test]
fn a_step_that_is_not_seen_to_stay_in_its_band_is_not_called_settled() {
    for (duration_s, settled) in [(4.0, false), (4.25, false), (4.4, true), (10.0, true)] {
        let found = judged(&[&format!("loop.duration_s={duration_s}")]);
        let verdict = found.results[0].metrics.verdict;
        assert_eq!(verdict == Verdict::Settled, settled, "{duration_s}: {verdict}");
        if !settled {
            assert!(matches!(verdict, Verdict::NotSettled { since_s: Some(_), .. }), "{verdict:?}");
            assert!(verdict.to_string().ends_with("s, too late to see it stay"), "{verdict}");
        }
    }
    assert!(matches!(
        judged(&["loop.duration_s=3.0"]).results[0].metrics.verdict,
        Verdict::NotSettled { since_s: None, .. }
    ));
}

/// At its last sample an error within the band had "recovered in 0 s", and left it again.
#[test]
fn an_error_that_never_left_its_band_is_seen_there_for_as_long_as_it_may_take_to_come_back() {
    for (from_s, met) in [(9.9, false), (9.5, true), (9.0, true)] {
        let found = judged(&[
            "loop.duration_s=10.0",
            &format!("requirement[2].from_s={from_s:?}"),
            "requirement[2].most=0.5",
        ]);
        let recovery = &found.judgements[2];
        assert_eq!(recovery.met, met, "{from_s}: {:?}", recovery.found);
        let is_short = matches!(recovery.found, Err(NotEvaluated::TooShort { .. }));
        assert_eq!(is_short, !met, "{from_s}: {:?}", recovery.found);
    }
}
