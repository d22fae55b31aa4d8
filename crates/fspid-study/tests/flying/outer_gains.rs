//! Gains of outer loops that move with their error multiply what the loops hold, as those of the pitch loop do.

use fspid_sim::Doubt;
use fspid_study::analysis::{Analysis, AtRest, Question, Stability};
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

/// The rules of the middle make the throttle's loop unstable, and a millionth of a metre a second around it lie in a dead zone:
/// `stable`, `certified` and "HOLDS, AND IS WHAT FLIES" of an airspeed that swings by 4.8 m/s for ever.
#[test]
fn a_dead_zone_of_an_outer_loop_hides_no_rest_that_is_unstable_without_it() {
    let at_rest = |set: &[&str]| {
        let study = study(ZONED, set);
        AtRest::of(&study.scenario, &study.scenario.controllers[0].controller)
    };
    for zone in ["1e-9", "1e-6", "0.01"] {
        let zone = format!(
            "outer_loop.autothrottle.dead_zone={{ error_deg = {zone}, change_deg_s = {zone} }}"
        );
        let found = at_rest(&[&zone]).undecided.expect("nobody can tell");
        assert_eq!(found.doubt, Doubt::OuterGains, "{zone}");
    }
    let without = ZONED.replace("dead_zone = { error_deg = 1e-06, change_deg_s = 1e-06 }\n", "");
    let grows = AtRest::of(
        &study(&without, &[]).scenario,
        &study(&without, &[]).scenario.controllers[0].controller,
    );
    assert!(grows.unstable.is_some());
    // Beside another loop with a zone, whose rules hold, as well.
    let vertical = "[[outer_loop]]\nname = \"vertical speed\"\nkind = \"pid\"\nholds = \"vertical-speed\"\nmoves = \"pitch\"\nkp = 0.5\nki = 0.5\n";
    let tuned = "[[outer_loop]]\nname = \"vertical speed\"\nkind = \"fspid\"\nholds = \"vertical-speed\"\nmoves = \"pitch\"\nnominal = { kp = 0.5, ki = 0.5, kd = 0.0 }\ndead_zone = { error_deg = 1e-06, change_deg_s = 1e-06 }\nsupervisor = { table = \"mirrored\", range = 5.0, output_scale = { kp = 0.01, ki = 0.01, kd = 0.0 } }\n";
    let both = ZONED.replace(vertical, tuned);
    assert_ne!(both, ZONED);
    let both = study(&both, &[]);
    let found = AtRest::of(&both.scenario, &both.scenario.controllers[0].controller);
    assert_eq!(found.undecided.expect("nobody can tell").doubt, Doubt::OuterGains);
    // Rules that hold without it leave no doubt.
    let calm = "outer_loop.autothrottle.supervisor.output_scale={ kp = 0.1, ki = 0.1, kd = 0.0 }";
    assert_eq!(at_rest(&[calm]).stability_word(), Some("stable"));
    let swings = result(ZONED, &["loop.duration_s=180.0"]);
    let airspeed_m_s = column(&swings.trace, "airspeed_m_s");
    let last = &airspeed_m_s[airspeed_m_s.len() - 1500..];
    let most = last.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    assert!(most - last.iter().copied().fold(f64::INFINITY, f64::min) > 2.0);
}

/// A Navion whose throttle is moved by a self-tuner with rules in the middle of its range alone.
const ZONED: &str = r#"
schema = 1
name = "Navion, altitude capture"

[aircraft]
name = "navion"
airspeed_ft_s = 176.0
altitude_ft = 1000.0
thrust = "with-speed"

[engine]
kind = "first-order"
time_constant_s = 1.0

[actuator]
time_constant_s = 0.1

[loop]
sample_period_s = 0.02
duration_s = 60.0

[setpoint]
kind = "step"
amplitude_deg = 0.0

[[outer_loop]]
name = "altitude"
kind = "pid"
holds = "altitude"
moves = "vertical speed"
kp = 0.15
least = -2.54
most = 2.54
most_per_s = 1.0

[[outer_loop]]
name = "vertical speed"
kind = "pid"
holds = "vertical-speed"
moves = "pitch"
kp = 0.5
ki = 0.5
least = -10.0
most = 10.0
most_per_s = 2.0

[[outer_loop]]
name = "autothrottle"
kind = "fspid"
holds = "airspeed"
moves = "throttle"
nominal = { kp = 0.2, ki = 0.02, kd = 0.0 }
law = "memoryless"
dead_zone = { error_deg = 1e-06, change_deg_s = 1e-06 }
[outer_loop.supervisor]
range = 1.0
numbers = { delta_kp = [[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -0.19, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]], delta_ki = [[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.03, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]], delta_kd = [[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]] }
error_scale = 0.05
change = "rate"
change_scale = 0.05
output_scale = { kp = 1.0, ki = 1.0, kd = 0.0 }

[[mode]]
name = "level"
engage = ["altitude", "vertical speed", "autothrottle"]

[[mode]]
name = "climb"
at_s = 5.0
engage = ["altitude", "vertical speed", "autothrottle"]
target = { altitude_ft = 1010.0 }

[[controller]]
name = "PID"
kind = "pid"
kp = 0.82
ki = 0.43
kd = 0.165
derivative_filter_s = 0.05
"#;
