//! Where limits leave less than what is held takes, and what such flights come to.

use fspid_sim::{Doubt, EarlyEnd, EndCause};
use fspid_study::metrics::Verdict;

use crate::flying::result;

/// An unstable plant under a load that it holds with nine tenths of its limit, and to which it comes with a jump.
const AT_A_LIMIT: &str = include_str!("../data/at_a_limit.toml");

/// It went through 467 deg and further, without a step that it could have failed to settle after: "flown", `stable` met.
#[test]
fn an_unstable_plant_that_is_lost_at_a_limit_is_not_called_stable() {
    let doubt = |set: &[&str]| result(AT_A_LIMIT, set).at_rest.undecided.map(|it| it.doubt);
    let of = |load: f64, more: &[&str]| {
        let load = format!("disturbance[0].amplitude_deg={load:?}");
        doubt(&[&[load.as_str()], more].concat())
    };
    assert_eq!(of(9.0, &[]), Some(Doubt::RunsAway));
    assert_eq!(of(3.0, &[]), None);
    // However short the flight: beyond what there is, or lost when it goes on.
    assert_eq!(of(11.0, &["loop.duration_s=1.5"]), Some(Doubt::BeyondLimits));
    assert_eq!(of(9.0, &["loop.duration_s=1.5"]), Some(Doubt::SwingAtLimits));
    assert_eq!(of(3.0, &["loop.duration_s=1.5"]), None);
    // A servo's own limits as well, which a load at it does not reach.
    let servo = ["actuator={time_constant_s=0.05, position_limit_deg=2.0}", "loop.duration_s=1.5"];
    assert_eq!(of(3.0, &servo), None);
    let elevator = [&servo[..], &["disturbance[0].enters_at=elevator"]].concat();
    assert_eq!(of(3.0, &elevator), Some(Doubt::BeyondLimits));
    // A plant that holds by itself rests somewhere, and its flight tells where.
    assert_eq!(of(11.0, &["plant.denominator=[1.0, 0.6, 0.4]"]), None);
}

/// Feedforward holds an unstable plant with half a degree, and the limit ends a fiftieth before that.
const FED_FORWARD: &str = r#"
schema = 1
name = "held by feedforward"
[plant]
numerator = [1.0]
denominator = [1.0, 1.0, -0.05]
elevator_sign = "nose-up-positive"
[loop]
sample_period_s = 0.01
duration_s = 20.0
[setpoint]
kind = "step"
amplitude_deg = 10.0
at_s = 0.0
[[controller]]
name = "C"
kind = "pid"
kp = 1.0
rate_gain = 1.0
feedforward = -0.05
output_limits_deg = [-0.49, 10.0]
"#;

/// It was settled in 6 s, `stable` met, and diverged after 333 s: without an integral limits were not asked.
#[test]
fn a_rest_without_an_integral_beyond_a_limit_is_undecided_and_is_left_in_a_longer_flight() {
    let doubt = |set: &[&str]| result(FED_FORWARD, set).at_rest.undecided.map(|it| it.doubt);
    assert_eq!(doubt(&[]), Some(Doubt::BeyondLimits));
    assert_eq!(doubt(&["controller.C.output_limits_deg=[-0.51, 10.0]"]), None);
    let long = result(FED_FORWARD, &["loop.duration_s=400.0"]);
    assert!(
        matches!(
            long.metrics.verdict,
            Verdict::EndedEarly(EarlyEnd { cause: EndCause::Diverged, .. })
        ),
        "{:?}",
        long.metrics.verdict
    );
}

/// A load on a plant that integrates, of which the limit leaves a tenth.
const RUNS_AWAY: &str = r#"
schema = 1
name = "a load that the limit does not hold"
[plant]
preset = "navion-paper"
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.01
duration_s = 60.0
[setpoint]
kind = "ramp"
amplitude_deg = 5.0
at_s = 0.0
width_s = 3.0
[[disturbance]]
kind = "step"
enters_at = "elevator"
amplitude_deg = 12.0
at_s = 5.0
[[controller]]
name = "PID"
kind = "pid"
kp = 1.0
ki = 0.5
kd = 0.3
rate_gain = 0.3
output_limits_deg = [-8.0, 8.0]
anti_windup = { kind = "conditional" }
"#;

/// It ended at 392 deg, and `stable` was met: a pole at the origin was none that is unstable.
#[test]
fn a_load_that_a_limit_does_not_hold_makes_a_plant_that_integrates_undecided() {
    let doubt = |set: &[&str]| result(RUNS_AWAY, set).at_rest.undecided.map(|it| it.doubt);
    let load = |size: f64| format!("disturbance[0].amplitude_deg={size:?}");
    assert_eq!(doubt(&[]), Some(Doubt::BeyondLimits));
    assert_eq!(doubt(&[&load(7.9)]), None);
    assert_eq!(doubt(&[&load(8.1)]), Some(Doubt::BeyondLimits));
    assert_eq!(doubt(&[&load(-8.1), "controller.PID.ki=0.0"]), Some(Doubt::BeyondLimits));
}

/// A pulse takes it beyond what the limit holds back: 19.8 deg and growing, where its first step was 10 deg off.
#[test]
fn a_flight_lost_at_a_limit_after_a_larger_step_is_not_called_stable() {
    let pulse = r#"
[[disturbance]]
kind = "pulse"
enters_at = "servo"
amplitude_deg = 0.2
at_s = 20.0
width_s = 20.0
"#;
    let text = FED_FORWARD.to_owned() + pulse;
    let law = ["controller.C.ki=0.1", "controller.C.feedforward=0.0"];
    let winds = "controller.C.anti_windup={ kind = \"conditional\" }";
    let of = |least: f64| {
        let limit = format!("controller.C.output_limits_deg=[{least:?}, 10.0]");
        let found = result(&text, &[&law[..], &[&limit, winds, "loop.duration_s=45.0"]].concat());
        found.at_rest.undecided.map(|it| it.doubt)
    };
    assert_eq!(of(-0.6), Some(Doubt::RunsAway));
    assert_eq!(of(-2.0), None);
}

/// A lightly damped plant that runs away, behind a servo with an end of its travel that a ramp takes a swing to.
const SWINGS_LATER: &str = r#"
schema = 1
name = "swings later"
[plant]
numerator = [1.7654880430491657, 8.472202540070402]
denominator = [1.0, 0.6666822977238218, 84.78151392738918, -21.98228273256644]
elevator_sign = "nose-up-positive"
[actuator]
time_constant_s = 0.1
delay_samples = 2
position_limit_deg = 17.455
[loop]
sample_period_s = 0.005
duration_s = 10.0
[setpoint]
kind = "ramp"
amplitude_deg = -3.26846
width_s = 5.0
[[controller]]
name = "PID"
kind = "pid"
kp = 2.5506819644042293
ki = 4.74469695678181
kd = 0.0
setpoint_weights = { proportional = 0.6 }
"#;

/// A plant that runs away and follows a sine, for a few periods.
const FOLLOWS: &str = r#"
schema = 1
name = "follows"
[plant]
numerator = [2.27650982088445, 16.627479239817916, 8.411935970196069]
denominator = [1.0, 3.0094589925450723, 20.600145626717342, -17.433253915810855, 0.0]
elevator_sign = "nose-up-positive"
[actuator]
delay_samples = 3
[loop]
sample_period_s = 0.02
duration_s = 10.0
[setpoint]
kind = "sine"
amplitude_deg = 3.0
frequency_hz = 0.2
[[controller]]
name = "PID"
kind = "pid"
kp = 2.4
ki = 0.05
kd = 0.0
output_limits_deg = [-3.42706, 7.68064]
anti_windup = { kind = "back-calculation", tracking_s = 1.0 }
setpoint_weights = { proportional = 0.6 }
"#;

/// A plant that integrates and swings from limit to limit for ever after a step.
const SWINGS_FOR_EVER: &str = r#"
schema = 1
name = "swings for ever"
[plant]
numerator = [0.05480746048453045, 0.17393605397913903, 0.05603308968525515]
denominator = [1.0, 0.1542436020494921, 0.018670660527296115, 0.0]
elevator_sign = "nose-up-positive"
[actuator]
delay_samples = 1
[loop]
sample_period_s = 0.05
duration_s = 10.0
[setpoint]
kind = "step"
amplitude_deg = -5.10501
[[disturbance]]
kind = "step"
enters_at = "servo"
amplitude_deg = -2.54097
at_s = 2.0
[[controller]]
name = "PID"
kind = "pid"
kp = 7.061723068717123
ki = 0.0
kd = 0.11734663779217713
derivative_filter_s = 0.05
output_limits_deg = [-13.8042, 12.0815]
"#;

/// Their rests are within the limits, and their flights of 10 s end with nothing to be seen: "flown", `stable` met.
#[test]
fn a_short_flight_whose_swing_at_limits_grows_or_stays_when_it_goes_on_is_undecided() {
    for text in [SWINGS_LATER, FOLLOWS, SWINGS_FOR_EVER] {
        let found = result(text, &[]);
        assert!(!found.verdict().is_failure(), "{text}");
        assert_eq!(
            found.at_rest.undecided.map(|it| it.doubt),
            Some(Doubt::SwingAtLimits),
            "{text}"
        );
        // A third of what is commanded, or limits of three times as much, and it comes to rest.
        let (small, wide) = match text {
            SWINGS_LATER => ("setpoint.amplitude_deg=-1.0", "actuator.position_limit_deg=60.0"),
            FOLLOWS => {
                ("setpoint.amplitude_deg=0.5", "controller.PID.output_limits_deg=[-20.0, 20.0]")
            }
            _ => ("setpoint.amplitude_deg=-1.0", "controller.PID.output_limits_deg=[-90.0, 90.0]"),
        };
        let decided = |set| result(text, &[set]).at_rest.undecided.is_none();
        assert!(decided(small) && decided(wide), "{text}");
    }
    // A little noise made it "stable" again: its swing neither grows nor shrinks.
    let noise = "[[disturbance]]\nkind = \"noise\"\nenters_at = \"measurement\"\nstandard_deviation_deg = 0.001\nat_s = 0.0\nseed = 1\n";
    for noise in [noise, "[sensor]\npreset = \"mems\"\n"] {
        let found = |set: &[&str]| {
            let found = result(&format!("{SWINGS_FOR_EVER}{noise}"), set);
            found.at_rest.undecided.map(|it| it.doubt)
        };
        assert_eq!(found(&[]), Some(Doubt::SwingAtLimits), "{noise}");
        assert_eq!(found(&["setpoint.amplitude_deg=-1.0"]), None, "{noise}");
    }
}
