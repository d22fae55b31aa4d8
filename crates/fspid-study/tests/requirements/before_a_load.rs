//! What a step has not done by itself when a load begins, the load may do for it.

use fspid_scenario::file;
use fspid_study::judgement::NotEvaluated;
use fspid_study::metrics::{Absent, Verdict};
use fspid_study::simulation::Simulation;

/// A lag of 1 s: 86 % of the way after 2 s, 90 % after 2.3 s, settled after 3.91 s.
const SLOW: &str = r#"
schema = 1
name = "a slow step and a load"
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
[[disturbance]]
kind = "step"
enters_at = "elevator"
amplitude_deg = 0.015
at_s = 2.0
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
measure = "rise_time_s"
most = 8.0
[[requirement]]
measure = "recovery_time_s"
within_deg = 0.02
most = 8.0
"#;

fn judged(set: &[&str]) -> Simulation {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    let study =
        file::parse(SLOW, "test.toml", None, &set).unwrap_or_else(|problems| panic!("{problems}"));
    Simulation::of(&study).expect("it flies")
}

/// Overshoot, settling, rise, recovery: a value, or whether a disturbance is the reason that there is none.
fn found(simulation: &Simulation) -> Vec<Result<f64, bool>> {
    let of = |found: &Result<_, _>| match found {
        Ok(fspid_study::judgement::Case { value, .. }) => Ok(*value),
        Err(NotEvaluated::Absent(Absent::Disturbed { .. })) => Err(true),
        Err(_) => Err(false),
    };
    simulation.judgements.iter().map(|judgement| of(&judgement.found)).collect()
}

fn verdict(simulation: &Simulation) -> Verdict {
    simulation.results[0].verdict()
}

/// It was "settled", and met what is asked of its times, of a step that stops at 88 % of its way without the load.
#[test]
fn a_step_that_a_load_pushes_into_its_band_has_not_settled() {
    let pushed = judged(&[]);
    assert_eq!(verdict(&pushed).to_string(), "not settled before the disturbance at 2 s");
    let expected = found(&pushed);
    assert_eq!(expected[..3], [Err(true); 3], "{expected:?}");
    assert!(expected[3].is_ok(), "what comes back is no step");
    assert!(pushed.judgements[..3].iter().all(|judgement| !judgement.met));
    let text = pushed.text();
    let why = "at 2 s, when a disturbance begins or changes, the step is 86.";
    assert!(text.contains(why), "{text}");
    // It has risen by itself, and not settled.
    let risen = found(&judged(&["disturbance[0].at_s=3.0"]));
    assert!(risen[0] == Err(true) && risen[1] == Err(true) && risen[2].is_ok(), "{risen:?}");
    // With the step there is no time at all that is its own.
    let at_once = judged(&["disturbance[0].at_s=0.0"]);
    assert!(matches!(verdict(&at_once), Verdict::NotSettled { disturbed_from_s: Some(0.0), .. }));
}

#[test]
fn a_step_that_has_settled_before_a_load_begins_keeps_its_numbers() {
    let alone = judged(&["disturbance[0].amplitude_deg=0.0"]);
    let later = judged(&["disturbance[0].at_s=4.4"]);
    assert_eq!(verdict(&later), Verdict::Settled);
    assert_eq!(found(&later)[1..3], found(&alone)[1..3]);
    // In its band for less than a tenth of the time that it took it may swing out again.
    let soon = judged(&["disturbance[0].at_s=4.2"]);
    let Verdict::NotSettled { since_s: Some(since_s), disturbed_from_s: Some(from_s), .. } =
        verdict(&soon)
    else {
        panic!("{:?}", verdict(&soon))
    };
    assert!((since_s - 3.91).abs() < 0.02 && from_s == 4.2, "{since_s} {from_s}");
    // What is not settled at the end of the flight either is told as that.
    let lost = judged(&["disturbance[0].amplitude_deg=0.5"]);
    let told = verdict(&lost).to_string();
    assert_eq!(told, "not settled within 10 s");
    assert_eq!(found(&lost)[0], Err(true));
}

#[test]
fn a_load_that_ends_or_turns_within_a_step_moves_it_as_one_that_begins() {
    let late = "setpoint.at_s=1.0";
    let pulse = "disturbance=[{kind='pulse', enters_at='servo', amplitude_deg=-0.015, at_s=0.0, width_s=3.0}]";
    let ended = judged(&[late, pulse]);
    assert_eq!(verdict(&ended).to_string(), "not settled before the disturbance at 3 s");
    let square = "disturbance=[{kind='square', enters_at='measurement', amplitude_deg=0.001, at_s=0.5, half_period_s=1.0}]";
    let turned = judged(&[late, square]);
    assert_eq!(verdict(&turned).to_string(), "not settled before the disturbance at 1.5 s");
}

#[test]
fn noise_that_moves_all_the_time_is_no_load_that_begins() {
    let noise = "disturbance=[{kind='noise', enters_at='measurement', amplitude_deg=0.001, at_s=2.0, seed=1}]";
    assert_eq!(verdict(&judged(&[noise])), Verdict::Settled);
}
