//! Gains of outer loops that move with their error multiply what the loops hold, as those of the pitch loop do.

use fspid_sim::Doubt;
use fspid_study::analysis::{Analysis, Question, Stability};
use fspid_study::simulation::ControllerResult;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::flying::{column, doubt, result, study};

/// A Navion whose altitude is held by a self-tuner, and is to be a hair higher.
const HOLD: &str = include_str!("../data/altitude-hold.toml");

fn flown(set: &[&str]) -> ControllerResult {
    result(HOLD, set)
}

/// Largest distances from 1000 ft within the 10 s before each of these times, m.
fn off_m(result: &ControllerResult, before_s: [usize; 2]) -> [f64; 2] {
    let altitude_m = column(&result.trace, "altitude_m");
    before_s.map(|s| {
        let seen = &altitude_m[50 * (s - 10)..50 * s];
        seen.iter().map(|it| (it - 304.8).abs()).fold(0.0, f64::max)
    })
}

/// kp falls with the error, and 30 % of 305 m with it: "stable", proved, "stable with its outer loops", while the altitude swings
/// by 20 m.
#[test]
fn a_self_tuner_around_the_pitch_loop_grows_by_the_target_that_its_gains_multiply() {
    let long = "loop.duration_s=100.0";
    for set in [&[long][..], &[long, "outer_loop[0].setpoint_weights.proportional=0.8"]] {
        let flight = flown(set);
        let unstable = flight.at_rest.unstable.expect("it grows");
        assert_eq!(unstable.mode, Some(0));
        let [before, after] = off_m(&flight, [80, 100]);
        let doubling_s = 20.0 * std::f64::consts::LN_2 / (after / before).ln();
        let told_s = unstable.doubling_s;
        assert!((doubling_s / told_s - 1.0).abs() < 0.02, "{doubling_s} {told_s} {after}");
    }
    let study = study(HOLD, &[]);
    let analysis = Analysis::of(&study, Question::default()).expect("a loop");
    assert_eq!(analysis.stability(), Stability::Unstable);
    let text = analysis.text();
    assert!(text.contains("mode level: UNSTABLE with its outer loops"), "{text}");
    // With a weight of 1 no constant is multiplied, and with one of 0.95 every side of the rules holds.
    for weight in ["1.0", "0.95"] {
        let weight = format!("outer_loop[0].setpoint_weights.proportional={weight}");
        let flight = flown(&[long, &weight]);
        assert!(flight.at_rest.unstable.is_none() && doubt(&flight).is_none());
        let [before, after] = off_m(&flight, [30, 100]);
        assert!(after < before && after < 1e-6, "{weight} {after}");
    }
}

/// What the gains gather follows late, and takes the same constants.
#[test]
fn gains_around_the_pitch_loop_that_remember_grow_by_the_target_too() {
    let remembers = ["outer_loop[0].law=accumulating", "outer_loop[0].leakage_per_s=0.5"];
    let flight = flown(&[&remembers[..], &["loop.duration_s=60.0"]].concat());
    assert_eq!(flight.at_rest.unstable.expect("it grows").mode, Some(0));
    assert!(off_m(&flight, [30, 60])[1] > 1.0);
    let weak = "outer_loop[0].setpoint_weights.proportional=0.97";
    let flight = flown(&[&remembers[..], &[weak]].concat());
    assert!(flight.at_rest.unstable.is_none() && doubt(&flight).is_none());
}

#[test]
fn where_nobody_can_tell_what_gains_around_the_pitch_loop_do_it_is_undecided() {
    // One side of the rules alone grows, and no motion was seen to.
    let one_side = "outer_loop[0].setpoint_weights.proportional=0.9";
    // Gains that gather without end, and an error that stays.
    for set in [one_side, "outer_loop[0].law=accumulating", "outer_loop[0].nominal.ki=0.0"] {
        let flight = flown(&[set]);
        assert!(flight.at_rest.unstable.is_none());
        assert_eq!(doubt(&flight), Some(Doubt::OuterGains), "{set}");
    }
    let study = study(HOLD, &[one_side]);
    let analysis = Analysis::of(&study, Question::default()).expect("a loop");
    assert_eq!(analysis.stability(), Stability::Undecided);
    let text = analysis.text();
    assert!(text.contains("mode level: UNDECIDED with its outer loops"), "{text}");
    assert!(text.contains("multiply what it holds"), "{text}");
}

/// Settings of a self-tuner around the pitch loop, drawn.
fn drawn(seed: u64) -> Vec<String> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut part = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let mut between = |lower: f64, upper: f64| lower + (upper - lower) * part();
    let [kp, ki] = [between(0.05, 0.3), between(0.002, 0.02)];
    let [by_kp, by_ki] = [between(-4.0, -2.0), between(-6.0, -4.0)].map(|it| 10_f64.powf(it));
    let weight = between(0.3, 1.2);
    let mut set = vec![
        "loop.duration_s=200.0".to_owned(),
        format!("outer_loop[0].nominal={{ kp = {kp}, ki = {ki}, kd = 0.0 }}"),
        format!("outer_loop[0].setpoint_weights.proportional={weight}"),
        format!("outer_loop[0].supervisor.output_scale={{ kp = {by_kp}, ki = {by_ki}, kd = 0.0 }}"),
    ];
    if between(0.0, 1.0) < 0.4 {
        set.push("outer_loop[0].law=accumulating".to_owned());
        set.push(format!("outer_loop[0].leakage_per_s={}", between(0.1, 2.0)));
    }
    if between(0.0, 1.0) < 0.4 {
        set.push("outer_loop[0].integral=literal".to_owned());
    }
    if between(0.0, 1.0) < 0.3 {
        set.push(format!("outer_loop[0].supervisor.change_scale={}", between(0.0, 5.0)));
    }
    if between(0.0, 1.0) < 0.3 {
        set.push("outer_loop[0].supervisor.table=mirrored".to_owned());
    }
    set
}

/// From a hair off its target, what is called stable dies out, and what doubles within 20 s has left.
#[test]
fn what_is_told_of_drawn_self_tuners_around_the_pitch_loop_is_flown() {
    let mut told = [0; 2];
    for seed in 0..60 {
        let set = drawn(seed);
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let flight = flown(&set);
        let [before, after] = off_m(&flight, [140, 200]);
        match (flight.at_rest.unstable, doubt(&flight)) {
            (Some(unstable), _) => {
                told[0] += 1;
                let is_slow = unstable.doubling_s > 20.0;
                assert!(is_slow || after > 1e-6, "{set:?}: {before} {after} {unstable:?}");
            }
            (None, None) => {
                told[1] += 1;
                // The target itself is 3e-8 m away.
                assert!(after < before.max(1e-7), "{set:?}: {before} {after}");
            }
            (None, Some(_)) => {}
        }
    }
    assert_eq!(told, [14, 40]);
}

/// With gains of the first second at rest this mode was "stable", and `stable` was met. They gather to 5.6, and the altitude swings.
#[test]
fn a_mode_is_asked_with_the_gains_that_a_self_tuner_around_the_pitch_loop_comes_to() {
    let gathers = [
        "outer_loop[0].setpoint_weights.proportional=1.0",
        "outer_loop[0].supervisor.error_scale=0.001",
        "outer_loop[0].supervisor.change_scale=0.001",
        "outer_loop[0].supervisor.output_scale.kp=0.5",
        "outer_loop[0].law=accumulating",
        "outer_loop[0].least=-50.0",
        "outer_loop[0].most=50.0",
    ];
    let leaks = [&gathers[..], &["outer_loop[0].leakage_per_s=0.02", "loop.duration_s=300.0"]];
    let flight = flown(&leaks.concat());
    assert_eq!(flight.at_rest.unstable.expect("it grows").mode, Some(0));
    let [before, after] = off_m(&flight, [200, 300]);
    assert!(after > 1.0 && after > 2.0 * before, "{before} {after}");
    // Without a leak they never stand still.
    let flight = flown(&gathers);
    assert!(flight.at_rest.unstable.is_none());
    assert_eq!(doubt(&flight), Some(Doubt::OuterGains));
}
