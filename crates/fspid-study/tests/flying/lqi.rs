//! The regulator with integral action: what its keys make of it, and how it flies its own model.

use fspid_core::{AntiWindup, IntegralForm};
use fspid_lti::{TransferFunction, step_response};
use fspid_scenario::file::{self, GainSource, Study};
use fspid_study::simulation::Simulation;

/// A plant that is the design model: q' = -0.9 q + 2 u.
const OWN_MODEL: &str = r#"
schema = 1
name = "own model"
[plant]
numerator = [2.0]
denominator = [1.0, 0.9, 0.0]
elevator_sign = "nose-up-positive"
[loop]
sample_period_s = 0.01
duration_s = 6.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
at_s = 0.0
[[controller]]
name = "LQI"
kind = "lqi"
design = { pitch_damping_per_s = 0.9, elevator_power_per_s2 = 2.0 }
weights = { pitch = 4.0, rate = 0.6, integral = 9.0 }
"#;

fn study(text: &str, set: &[&str]) -> Study {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    file::parse(text, "test.toml", None, &set).unwrap_or_else(|problems| panic!("{problems}"))
}

fn problems(set: &[&str]) -> String {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    file::parse(OWN_MODEL, "test.toml", None, &set).expect_err("it is wrong").to_string()
}

/// Pitch in degrees, sample after sample.
fn pitch_deg(study: &Study) -> Vec<f64> {
    let simulation = Simulation::of(study).expect("it flies");
    simulation.results[0].trace.theta_rad.iter().map(|rad| rad.to_degrees()).collect()
}

/// Largest distance of a flight from the continuous loop that was designed, ki b / p(s), in degrees.
fn distance(dt_s: f64) -> f64 {
    let study = study(OWN_MODEL, &[&format!("loop.sample_period_s={dt_s:?}")]);
    let controller = &study.scenario.controllers[0].controller;
    let (gains, rate_gain_s) = (controller.nominal(), controller.config().rate_gain_s);
    let (a, b) = (0.9, 2.0);
    let closed = TransferFunction::new(
        &[b * gains.ki],
        &[1.0, a + b * rate_gain_s, b * gains.kp, b * gains.ki],
    );
    let flown = pitch_deg(&study);
    let designed = step_response(&closed.expect("a transfer function"), dt_s, flown.len());
    let designed = designed.expect("it is stable");
    flown
        .iter()
        .zip(&designed)
        .map(|(flown, designed)| (flown - designed).abs())
        .fold(0.0, f64::max)
}

#[test]
fn on_its_own_model_it_flies_the_response_that_was_designed() {
    let (coarse, fine) = (distance(0.01), distance(0.005));
    // The samples hold the command, a delay of half a period: the error goes with the period.
    assert!(coarse < 0.02, "{coarse}");
    assert!((coarse / fine - 2.0).abs() < 0.1, "{coarse} and {fine}");
}

#[test]
fn the_set_point_acts_through_the_integral_alone_unless_it_is_weighted() {
    let study_of =
        |weight: &str| study(OWN_MODEL, &[&format!("controller.LQI.setpoint_weight={weight}")]);
    let plain = study(OWN_MODEL, &[]);
    assert_eq!(plain.scenario, study_of("0.0").scenario);
    let controller = &plain.scenario.controllers[0].controller;
    assert_eq!(controller.config().setpoint_weights.proportional, 0.0);
    assert_eq!((controller.nominal().ki, controller.nominal().kd), (3.0, 0.0));
    let overshoot = |study: &Study| pitch_deg(study).into_iter().fold(0.0, f64::max) - 1.0;
    let (without, with) = (overshoot(&plain), overshoot(&study_of("1.0")));
    assert!(without < 0.08 && with > without + 0.02, "{without} and {with}");
    assert!((pitch_deg(&plain)[600] - 1.0).abs() < 1e-3);
}

#[test]
fn limits_and_anti_windup_are_those_of_a_pid() {
    let study = study(
        OWN_MODEL,
        &[
            "controller.LQI.output_limits_deg=[-2.0, 2.0]",
            "controller.LQI.anti_windup={ kind = \"back-calculation\", tracking_s = 0.5 }",
        ],
    );
    let config = study.scenario.controllers[0].controller.config();
    assert_eq!(config.anti_windup, AntiWindup::BackCalculation { tracking_s: 0.5 });
    assert_eq!(config.integral, IntegralForm::Bumpless);
    assert_eq!(config.limits.map(|limits| limits.upper()), Some(2.0_f64.to_radians()));
    let text = problems(&["controller.LQI.anti_windup={ kind = \"conditional\" }"]);
    assert!(text.contains("anti_windup: \"conditional\" has no limit to act at"), "{text}");
}

#[test]
fn what_is_not_above_zero_is_refused_at_its_key() {
    for key in ["weights.pitch", "weights.rate", "weights.integral", "design.elevator_power_per_s2"]
    {
        for bad in ["0.0", "-1.0"] {
            let text = problems(&[&format!("controller.LQI.{key}={bad}")]);
            assert!(text.contains(&format!("controller[0].{key}: out of range")), "{text}");
        }
    }
    let text = problems(&[
        "controller.LQI.design.elevator_power_per_s2=1e-300",
        "controller.LQI.weights.integral=1e300",
    ]);
    assert!(text.contains("controller[0].design: the gain of the regulator lies beyond"), "{text}");
    // What a PID has and a regulator cannot: its integral is the state that was weighted.
    let text = problems(&["controller.LQI.rate_gain=1.0"]);
    assert!(text.contains("rate_gain: belongs to kind"), "{text}");
}

#[test]
fn the_gains_are_told_because_no_key_states_them() {
    let study = study(OWN_MODEL, &[]);
    let [gains] = study.derived_gains.as_slice() else { panic!("{:?}", study.derived_gains) };
    assert_eq!(gains.source, GainSource::Regulator);
    let controller = &study.scenario.controllers[0].controller;
    assert_eq!(gains.gains, controller.nominal());
    assert_eq!(gains.rate_gain_s, controller.config().rate_gain_s);
    assert!(gains.to_string().starts_with("LQI: kp 4.168650, ki 3.000000 1/s"), "{gains}");
}
