//! Flights behind limits that have not come to rest go on, whatever hides what comes of them: noise, few samples, a plant that
//! holds by itself; and every command says the same of them.

use fspid_sim::{Doubt, EndCause};
use fspid_study::analysis::{Analysis, Question, Stability};
use fspid_study::metrics::Verdict;

use crate::flying::{doubt, result, study};

/// An unstable plant that follows a slow sine, which takes more than its limits leave from the second quarter of a period on.
const SLOW_SINE: &str = r#"
schema = 1
name = "slow sine"
[plant]
numerator = [1.0]
denominator = [1.0, 0.5, -0.5]
elevator_sign = "nose-up-positive"
[loop]
sample_period_s = 0.01
duration_s = 10.0
[setpoint]
kind = "sine"
amplitude_deg = 10.0
frequency_hz = 0.01
[[controller]]
name = "PID"
kind = "pid"
kp = 2.0
ki = 0.3
kd = 1.0
derivative_filter_s = 0.05
output_limits_deg = [-4.0, 4.0]
anti_windup = { kind = "conditional" }
"#;

fn diverges(text: &str, set: &[&str]) -> bool {
    let verdict = result(text, set).metrics.verdict;
    matches!(verdict, Verdict::EndedEarly(end) if end.cause == EndCause::Diverged)
}

/// With a noise of a millionth of a degree, or of none, the flight that meets no limit was "stable", and diverged at 42 s.
#[test]
fn noise_does_not_hide_what_a_flight_comes_to() {
    for size in ["0.0", "1e-6"] {
        let noise = format!(
            "[[disturbance]]\nkind = \"noise\"\nenters_at = \"measurement\"\nstandard_deviation_deg = {size}\nseed = 1\n"
        );
        let text = format!("{SLOW_SINE}{noise}");
        assert_eq!(doubt(&result(&text, &[])), Some(Doubt::SwingAtLimits), "{size}");
        assert!(diverges(&text, &["loop.duration_s=60.0"]), "{size}");
        assert_eq!(doubt(&result(&text, &["setpoint.amplitude_deg=5.0"])), None, "{size}");
    }
}

/// 49 samples, at the end of which the pitch is twice as far as it was told to go.
#[test]
fn a_flight_of_few_samples_is_flown_on_as_any_other() {
    let few = ["setpoint.kind=step", "loop.sample_period_s=0.1", "loop.duration_s=4.8"];
    let limited = |set: &[&str]| {
        let limits = "controller.PID.output_limits_deg=[-6.0, 6.0]";
        let text = SLOW_SINE
            .replace("frequency_hz = 0.01\n", "")
            .replace("derivative_filter_s = 0.05\n", "");
        let set = [&few[..], &[limits], set].concat();
        (
            doubt(&result(&text, &set)),
            diverges(&text, &[&set[..], &["loop.duration_s=60.0"]].concat()),
        )
    };
    assert_eq!(limited(&[]), (Some(Doubt::SwingAtLimits), true));
    assert_eq!(limited(&["setpoint.amplitude_deg=3.0"]), (None, false));
}

/// Half a second of a step that is lost after half a minute: no limit is met by then, and noise, or a sine that has shown many
/// periods, was all that moved it.
#[test]
fn what_moves_a_flight_for_ever_does_not_hide_a_beginning_that_is_not_over() {
    let step = [
        "setpoint.kind=step",
        "controller.PID.output_limits_deg=[-6.0, 6.0]",
        "controller.PID.kd=0.0",
        "controller.PID.kp=0.55",
        "controller.PID.ki=0.02",
        "loop.duration_s=0.5",
    ];
    let text = SLOW_SINE.replace("frequency_hz = 0.01\n", "");
    let noise =
        "kind = \"noise\"\nenters_at = \"measurement\"\nstandard_deviation_deg = 1e-6\nseed = 1\n";
    let sine =
        "kind = \"sine\"\nenters_at = \"servo\"\namplitude_deg = 1e-6\nfrequency_hz = 20.0\n";
    for moves in ["", noise, sine] {
        let table = if moves.is_empty() { "" } else { "[[disturbance]]\n" };
        let text = format!("{text}{table}{moves}");
        let flight = result(&text, &step);
        assert!(flight.trace.command_rad.iter().all(|it| it.to_degrees().abs() < 6.0), "{moves}");
        assert_eq!(doubt(&flight), Some(Doubt::SwingAtLimits), "{moves}");
        assert!(diverges(&text, &[&step[..], &["loop.duration_s=60.0"]].concat()), "{moves}");
    }
}

/// A plant that comes to rest by itself behind a slew limit, lightly damped.
const SLEW: &str = r#"
schema = 1
name = "slew"
[plant]
numerator = [1.4]
denominator = [1.0, 0.62, 0.84]
elevator_sign = "nose-up-positive"
[actuator]
delay_samples = 3
[loop]
sample_period_s = 0.02
duration_s = 30.0
[setpoint]
kind = "step"
amplitude_deg = 6.0
[[controller]]
name = "PID"
kind = "pid"
kp = 1.5
ki = 1.0
kd = 0.8
derivative_on = "measurement"
derivative_filter_s = 0.1
slew_limit_deg_s = 4.0
"#;

/// It swings by 13 deg for ever, and `stable` was met: its plant holds by itself. Short of its set-point at a limit it stands.
#[test]
fn a_swing_at_limits_of_a_plant_that_holds_by_itself_is_undecided_and_what_stands_at_a_limit_is_not()
 {
    let doubt = |set: &[&str]| doubt(&result(SLEW, set));
    assert_eq!(doubt(&[]), Some(Doubt::SwingAtLimits));
    assert_eq!(doubt(&["setpoint.amplitude_deg=1.0"]), None);
    assert_eq!(doubt(&["controller.PID.slew_limit_deg_s=60.0"]), None);
    let short_of_it =
        ["controller.PID.slew_limit_deg_s=60.0", "controller.PID.output_limits_deg=[-3.0, 3.0]"];
    assert_eq!(doubt(&short_of_it), None);
    // However long it is, and with noise that never reaches it: of rounding alone one part moves twice as much as another.
    let noise = "sensor={preset=\"ideal\", seed=1, pitch={noise_deg_rt_hz=0.0005}}";
    let long = ["loop.duration_s=2001.0", noise];
    assert_eq!(doubt(&[&short_of_it[..], &long].concat()), None);
}

/// A pitch sensor of a coarse resolution keeps a small swing up by itself: that is no swing at limits.
#[test]
fn a_swing_that_is_not_larger_than_what_the_sensor_shows_is_no_doubt() {
    let limits = "controller.PID.output_limits_deg=[-4.0, 4.0]";
    let text = SLOW_SINE
        .replace("kind = \"sine\"", "kind = \"step\"")
        .replace("frequency_hz = 0.01\n", "");
    let seen = "sensor={preset=\"ideal\", seed=1, pitch={resolution_deg=0.05}}";
    assert_eq!(doubt(&result(&text, &[limits, seen, "setpoint.amplitude_deg=1.0"])), None);
}

/// `analyse` flew nothing, and was "stable" of what `simulate` is not.
#[test]
fn analyse_says_of_a_swing_at_limits_what_its_flight_is_told() {
    for (text, set) in [(SLEW, vec![]), (SLOW_SINE, vec![])] {
        let study = study(text, &set);
        let analysis = Analysis::of(&study, Question::default()).expect("a loop");
        assert_eq!(analysis.stability(), Stability::Undecided);
        assert!(analysis.text().contains("flown on for ten times as long"), "{}", analysis.text());
    }
    let calm = study(SLEW, &["setpoint.amplitude_deg=1.0"]);
    let analysis = Analysis::of(&calm, Question::default()).expect("a loop");
    assert_eq!(analysis.stability(), Stability::Stable);
}
