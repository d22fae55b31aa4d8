//! Gains that a self-tuner has at rest and nowhere else, or does not have at all, and integrals and samples that limits hold: what
//! is said of such loops, and what long flights make of them.

use fspid_sim::Doubt;
use fspid_study::analysis::{Analysis, Question, Stability};
use fspid_study::simulation::{ControllerResult, Simulation};

use super::{Draw, doubt, is_lost, last_fifths_move_deg, result, study};

/// How far the error moves in the last fifth of a flight, deg.
fn moves_deg(flown: &ControllerResult) -> f64 {
    last_fifths_move_deg(flown)[0]
}

/// The flight with these changes, and where it is called stable, ten times as long.
fn flown_on(text: &str, set: &[String], duration_s: f64) -> Option<ControllerResult> {
    let set: Vec<&str> = set.iter().map(String::as_str).collect();
    let flown = result(text, &set);
    let is_stable = flown.at_rest.stability_word() == Some("stable");
    let long = format!("loop.duration_s={:?}", 10.0 * duration_s);
    is_stable.then(|| result(text, &[&set[..], &[long.as_str()]].concat()))
}

/// What flight, requirement and analysis say: all the same word, with the same reason where there is one.
fn word(text: &str, set: &[&str]) -> &'static str {
    let study = study(text, set);
    let simulation = Simulation::of(&study).expect("it flies");
    let word = simulation.results[0].at_rest.stability_word().expect("a word");
    let question = Question { map_points: 0, ..Question::default() };
    let analysis = Analysis::of(&study, question).expect("a loop");
    assert_eq!(analysis.loops[0].stability().word(), word, "{}", analysis.text());
    assert_eq!(analysis.json()["controllers"][0]["stability"], word);
    assert_eq!(simulation.json()["controllers"][0]["stability"], word);
    let required = simulation.judgements[0].value_in_words();
    match Stability::Undecided.word() == word {
        true => assert!(required.starts_with("undecided: "), "{required}"),
        false => assert_eq!(required, word),
    }
    word
}

/// A 747 whose proportional term does not see the set-point, with the printed rules.
const ZONED: &str = r#"
schema = 1
name = "dead zone"
[plant]
preset = "b747-paper"
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.01
duration_s = 60.0
[setpoint]
kind = "step"
amplitude_deg = -20.0
[[controller]]
name = "C"
kind = "fspid"
nominal = { kp = 2.0, ki = 0.5, kd = 1.0 }
setpoint_weights = { proportional = 0.0 }
dead_zone = { error_deg = 1e-6, change_deg_s = 1e-5 }
[controller.supervisor]
table = "printed"
range = 5.0
error_scale = 1.0
change_scale = 0.2
output_scale = { kp = 0.2, ki = 0.05, kd = 0.1 }
[[requirement]]
measure = "stable"
"#;

/// It was stable with margins of the nominal gains, and swung for ever; without the zone it was unstable.
#[test]
fn a_dead_zone_hides_no_rest_that_is_unstable_without_it() {
    assert!(matches!(doubt(&result(ZONED, &[])), Some(Doubt::DeadZone { .. })));
    assert_eq!(word(ZONED, &[]), "undecided");
    assert!(moves_deg(&result(ZONED, &["loop.duration_s=600.0"])) > 0.1);
    let (zone, without) = ("dead_zone = { error_deg = 1e-6, change_deg_s = 1e-5 }\n", "");
    assert_eq!(word(&ZONED.replace(zone, without), &[]), "unstable");
    assert_eq!(word(ZONED, &["setpoint.amplitude_deg=-2.0"]), "stable");
    // Within the zone unstable: certain.
    let grows = ["controller.C.nominal.ki=9.0"];
    assert_eq!(word(ZONED, &grows), "unstable");
}

/// Of 60, those that swung were called stable.
#[test]
fn flights_of_drawn_dead_zones_that_are_called_stable_come_to_rest() {
    let mut draw = Draw::seeded(109);
    let mut seen = [0; 2];
    for _ in 0..60 {
        let leaks = draw.of(&[true, false]);
        let mut set: Vec<String> = match leaks {
            true => vec!["controller.C.law=accumulating", "controller.C.leakage_per_s=8.0"],
            false => vec!["controller.C.law=memoryless"],
        }
        .into_iter()
        .map(str::to_owned)
        .collect();
        let by = if leaks { 8.0 } else { 1.0 };
        let mut scale = |size: f64| by * size * draw.between(0.3, 2.0);
        let scales = [scale(0.2), scale(0.05), scale(0.1)];
        let (amplitude_deg, zone_deg) = (draw.between(-25.0, 25.0), draw.of(&[1e-5, 1e-3, 0.02]));
        set.extend([
            format!(
                "controller.C.supervisor.output_scale={{kp={:?}, ki={:?}, kd={:?}}}",
                scales[0], scales[1], scales[2]
            ),
            format!("controller.C.integral={}", draw.of(&["literal", "bumpless"])),
            format!("controller.C.setpoint_weights.proportional={:?}", draw.between(0.0, 1.2)),
            format!("controller.C.supervisor.error_scale={:?}", draw.between(0.5, 3.0)),
            format!("setpoint.amplitude_deg={amplitude_deg:?}"),
            format!("controller.C.dead_zone.error_deg={zone_deg:?}"),
            format!("controller.C.dead_zone.change_deg_s={:?}", draw.of(&[1e-4, 1e-2, 0.2])),
        ]);
        let flown = flown_on(ZONED, &set, 60.0);
        seen[usize::from(flown.is_some())] += 1;
        let Some(flown) = flown else { continue };
        // Where gains jump at the border a small swing may stay around it.
        let allowed_deg = f64::max(0.02 * amplitude_deg.abs(), 20.0 * zone_deg);
        assert!(moves_deg(&flown) < allowed_deg, "{set:?}: {}", moves_deg(&flown));
    }
    assert!(seen.iter().all(|count| *count > 5), "{seen:?}");
}

/// Rules that move the integral's gain wherever an error is, and not where there is none, of a law that may accumulate.
const GATHERING: &str = r#"
schema = 1
name = "gains that move while an error is"
[plant]
preset = "navion-paper"
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.01
duration_s = 20.0
[setpoint]
kind = "square"
amplitude_deg = 5.0
half_period_s = 6.0
bipolar = true
[[controller]]
name = "C"
kind = "fspid"
nominal = { kp = 0.8, ki = 0.3, kd = 0.1 }
law = "accumulating"
[controller.supervisor]
table = "mirrored"
range = 5.0
change_scale = 0.2
output_scale = { kp = 0.02, ki = 0.02, kd = 0.002 }
[[requirement]]
measure = "stable"
[[requirement]]
measure = "phase_margin_deg"
least = 20.0
"#;

/// A flight said that stability at rest was not asked, and `stable` was met beside it with the nominal gains; it diverges.
#[test]
fn gains_that_stay_where_they_have_come_to_are_undecided_in_every_answer() {
    let zone = "controller.C.dead_zone={error_deg=0.01, change_deg_s=0.1}";
    for set in [vec![], vec![zone]] {
        let flown = result(GATHERING, &set);
        let told = doubt(&flown);
        assert!(matches!(told, Some(Doubt::KeptGains | Doubt::DriftingGains)), "{told:?}");
        assert_eq!(word(GATHERING, &set), "undecided");
        let simulation = Simulation::of(&study(GATHERING, &set)).expect("it flies");
        let margin = simulation.judgements[1].value_in_words();
        assert!(!margin.ends_with("deg"), "{margin}");
    }
    // Nominal gains that are unstable are no gains of its rest either.
    let slow = [zone, "controller.C.nominal.ki=9.0"];
    assert_eq!(word(GATHERING, &slow), "undecided");
    let still = "controller.C.supervisor.output_scale={kp=0.0, ki=0.0, kd=0.0}";
    assert_eq!(word(GATHERING, &[zone, still]), "stable");
    assert_eq!(word(GATHERING, &["controller.C.leakage_per_s=0.5"]), "stable");
}

/// Without leakage none is called stable but where no gain moves.
#[test]
fn flights_of_drawn_laws_that_accumulate_and_are_called_stable_are_not_lost() {
    let mut draw = Draw::seeded(110);
    let (mut stable, mut lost) = (0, 0);
    for _ in 0..40 {
        let leakage = draw.of(&[0.0, 0.0, 1.0, 4.0]);
        // What large motions make of large gains is nothing that is said of a rest.
        let most: f64 = if leakage > 0.0 { 2.0 } else { 10.0 };
        let sizes =
            [0.02, 0.02, 0.002].map(|size| size * most.min(draw.of(&[0.0, 0.5, 2.0, 10.0])));
        let set = vec![
            format!(
                "controller.C.supervisor.output_scale={{kp={:?}, ki={:?}, kd={:?}}}",
                sizes[0], sizes[1], sizes[2]
            ),
            format!("controller.C.leakage_per_s={leakage:?}"),
            format!("controller.C.supervisor.table={}", draw.of(&["mirrored", "printed"])),
            format!("setpoint.half_period_s={:?}", draw.between(3.0, 9.0)),
        ];
        let moves = sizes.iter().any(|size| *size != 0.0);
        match flown_on(GATHERING, &set, 60.0) {
            Some(flown) => {
                assert!(leakage > 0.0 || !moves, "{set:?}");
                assert!(!is_lost(&flown), "{set:?}");
                stable += 1;
            }
            None => {
                let words: Vec<&str> = set.iter().map(String::as_str).collect();
                let long = [&words[..], &["loop.duration_s=600.0"]].concat();
                lost += usize::from(is_lost(&result(GATHERING, &long)));
            }
        }
    }
    assert!(stable > 5 && lost > 0, "{stable} {lost}");
}

/// A row of a rule table, and a table of seven rows whose middle one is zero.
fn table(middle: f64, others: f64) -> String {
    let row = |value: f64| format!("[{}]", [format!("{value:?}").as_str(); 7].join(", "));
    let rows: Vec<String> =
        (0..7).map(|index| row(if index == 3 { middle } else { others })).collect();
    format!("[{}]", rows.join(", "))
}

/// A Navion under a load, whose integral acts through its rules alone.
fn by_rules(others: f64) -> String {
    let (none, ki) = (table(0.0, 0.0), table(0.0, others));
    format!(
        r#"
schema = 1
name = "ki from the rules alone"
[plant]
preset = "navion-paper"
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.01
duration_s = 15.0
[setpoint]
kind = "step"
amplitude_deg = 5.0
[[disturbance]]
kind = "step"
enters_at = "servo"
amplitude_deg = 0.06
[[controller]]
name = "C"
kind = "fspid"
nominal = {{ kp = 1.0, kd = 0.1 }}
[controller.supervisor]
range = 5.0
error_scale = 100.0
change_scale = 0.2
output_scale = {{ kp = 0.05, ki = 0.05, kd = 0.01 }}
numbers = {{ delta_kp = {none}, delta_ki = {ki}, delta_kd = {none} }}
[[requirement]]
measure = "stable"
"#
    )
}

/// It was settled and met, and diverged: an integral with ki 0 at rest was taken to come to the set-point, whatever its sign.
#[test]
fn an_integral_whose_gain_is_zero_at_rest_and_negative_elsewhere_is_undecided() {
    let (away, home) = (by_rules(-1.0), by_rules(1.0));
    assert_eq!(doubt(&result(&away, &[])), Some(Doubt::IntegralGain));
    assert_eq!(word(&away, &[]), "undecided");
    assert!(is_lost(&result(&away, &["loop.duration_s=900.0"])));
    assert_eq!(word(&home, &[]), "stable");
    let literal = ["controller.C.integral=literal"];
    assert_eq!(word(&home, &literal), "undecided");
    assert!(moves_deg(&result(&home, &[literal[0], "loop.duration_s=300.0"])) > 1e-3);
    // What limits forbid is out of reach.
    let limits = "controller.C.gain_limits={kp_min=0.5, kp_max=2.0, ki_min=0.0, ki_max=1.0, kd_min=0.0, kd_max=1.0}";
    assert_eq!(word(&away, &[limits]), "stable");
    assert_eq!(word(&away, &["controller.C.nominal.ki=0.2"]), "stable");
}

/// Loads, scales and forms of the integral: what is called stable is nearer to its set-point ten times as late.
#[test]
fn flights_of_drawn_rules_for_the_integral_alone_that_are_called_stable_come_to_the_set_point() {
    let mut draw = Draw::seeded(111);
    let mut seen = [0; 2];
    for _ in 0..30 {
        let text = by_rules(draw.of(&[-1.0, 1.0, 1.0]));
        let set = vec![
            format!("controller.C.integral={}", draw.of(&["bumpless", "bumpless", "literal"])),
            format!("controller.C.supervisor.output_scale.ki={:?}", draw.between(0.02, 0.4)),
            format!("controller.C.supervisor.error_scale={:?}", draw.between(20.0, 500.0)),
            format!("disturbance[0].amplitude_deg={:?}", draw.between(-3.0, 3.0)),
            "loop.duration_s=60.0".to_owned(),
        ];
        let flown = flown_on(&text, &set, 60.0);
        seen[usize::from(flown.is_some())] += 1;
        let Some(flown) = flown else { continue };
        assert!(moves_deg(&flown) < 5e-3, "{set:?}: {}", moves_deg(&flown));
        let (r, y) = (flown.trace.setpoint_rad.last(), flown.trace.theta_rad.last());
        let left_deg = (r.expect("a sample") - y.expect("a sample")).to_degrees();
        assert!(left_deg.abs() < 0.02, "{set:?}: {left_deg}");
    }
    assert!(seen.iter().all(|count| *count > 5), "{seen:?}");
}

/// An unstable plant that the integral alone holds, of which a load takes more than its limits leave.
const CLAMPED: &str = r#"
schema = 1
name = "integral clamp"
[plant]
numerator = [1.0, 0.5]
denominator = [1.0, 1.9, -0.2]
elevator_sign = "nose-up-positive"
[loop]
sample_period_s = 0.02
duration_s = 70.0
[setpoint]
kind = "step"
amplitude_deg = -10.0
[[disturbance]]
kind = "ramp"
enters_at = "servo"
amplitude_deg = -2.02
at_s = 40.0
width_s = 28.0
[[controller]]
name = "C"
kind = "pid"
kp = 0.2
ki = 0.8
anti_windup = { kind = "clamping", lower_deg = -6.0, upper_deg = 6.0 }
[[requirement]]
measure = "stable"
"#;

/// It was settled and met, and diverged after 398 s; `certify` knew.
#[test]
fn a_rest_that_takes_more_of_the_integral_than_its_limits_leave_is_undecided() {
    assert_eq!(doubt(&result(CLAMPED, &[])), Some(Doubt::IntegralLimits));
    assert_eq!(word(CLAMPED, &[]), "undecided");
    assert!(is_lost(&result(CLAMPED, &["loop.duration_s=600.0"])));
    let wide = "controller.C.anti_windup={kind='clamping', lower_deg=-8.0, upper_deg=8.0}";
    assert_eq!(word(CLAMPED, &[wide]), "stable");
    // What the proportional part holds rests with an error, for good.
    let held = ["controller.C.kp=2.0", "disturbance[0].amplitude_deg=-12.0"];
    let (flown, load) = (result(CLAMPED, &held), |it: &ControllerResult| it.at_rest.load);
    assert_eq!(doubt(&flown), None);
    let left = load(&flown).expect("asked");
    assert!(left.is_cut && !left.is_removed() && left.for_good > 0.1, "{left:?}");
    let text = flown.notes().join("\n");
    assert!(text.contains("the limits of the integral leave it less"), "{text}");
    let room = load(&result(CLAMPED, &[held[0], wide])).expect("asked");
    assert!(!room.is_cut && room.is_removed(), "{room:?}");
}

/// A degree more of load at the end of the flight leaves what is told of one.
#[test]
fn flights_under_a_load_that_the_limits_of_the_integral_cut_are_left_with_the_error_that_is_told() {
    let mut draw = Draw::seeded(112);
    let mut cut = 0;
    for _ in 0..20 {
        let size = draw.between(0.2, 2.0);
        let clamp = format!(
            "controller.C.anti_windup={{kind='clamping', lower_deg=-{size:?}, upper_deg={size:?}}}"
        );
        let kp = format!("controller.C.kp={:?}", draw.between(1.0, 4.0));
        let stable = "plant.denominator=[1.0, 1.9, 0.4]";
        let calm = ["setpoint.amplitude_deg=0.0", stable, "disturbance[0].at_s=0.0"];
        let at = |load: f64| format!("disturbance[0].amplitude_deg={load:?}");
        let ramp = "disturbance[0].width_s=1.0";
        let without = at(0.0);
        let told = result(CLAMPED, &[&calm[..], &[&clamp, &kp, ramp, &without]].concat());
        let told = told.at_rest.load.expect("asked");
        let loaded = at(1.0);
        let flown = result(
            CLAMPED,
            &[&calm[..], &[&clamp, &kp, ramp, &loaded, "loop.duration_s=300.0"]].concat(),
        );
        let left_deg = flown.trace.theta_rad.last().expect("a sample").to_degrees().abs();
        assert!((left_deg - told.for_good).abs() < 1e-3, "{size} {left_deg} {told:?}");
        cut += usize::from(told.is_cut);
    }
    assert!((5..20).contains(&cut), "{cut}");
}

/// Gains, limits and loads of a plant that does not come to rest by itself: of 60, those that were lost were called stable.
#[test]
fn flights_of_drawn_limits_of_the_integral_that_are_called_stable_are_not_lost() {
    let mut draw = Draw::seeded(1120);
    let mut seen = [0; 2];
    for _ in 0..60 {
        let size = draw.between(1.0, 8.0);
        let set = vec![
            format!("controller.C.kp={:?}", draw.between(0.15, 0.8)),
            format!("controller.C.ki={:?}", draw.between(0.05, 0.8)),
            format!(
                "controller.C.anti_windup={{kind='clamping', lower_deg=-{size:?}, upper_deg={size:?}}}"
            ),
            format!("disturbance[0].amplitude_deg={:?}", draw.between(-3.0, 3.0)),
        ];
        let flown = flown_on(CLAMPED, &set, 70.0);
        seen[usize::from(flown.is_some())] += 1;
        assert!(!flown.as_ref().is_some_and(is_lost), "{set:?}");
    }
    assert!(seen.iter().all(|count| *count > 5), "{seen:?}");
}

/// A step whose overshoot goes beyond what the controller believes.
const GUARDED: &str = r#"
schema = 1
name = "sample guard"
[plant]
preset = "navion-paper"
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.01
duration_s = 10.0
[setpoint]
kind = "step"
amplitude_deg = 5.0
[[controller]]
name = "C"
kind = "pid"
kp = 1.0
ki = 0.5
kd = 0.05
sample_guard_deg = 5.2
[[requirement]]
measure = "stable"
"#;

/// The command was held from the overshoot on and the pitch ran away, and `stable` was met.
#[test]
fn a_flight_that_ends_with_a_sample_beyond_the_guard_is_undecided() {
    let of = |set: &[&str]| doubt(&result(GUARDED, set));
    assert_eq!(of(&[]), Some(Doubt::HeldByGuard));
    assert_eq!(of(&["controller.C.sample_guard_deg=9.0"]), None);
    // A set-point, and what a sensor shows or a disturbance adds, are samples as well.
    assert_eq!(of(&["setpoint.amplitude_deg=6.0"]), Some(Doubt::HeldByGuard));
    let shown = "sensor={preset='ideal', seed=1, pitch={bias_deg=1.0}}";
    assert_eq!(of(&["setpoint.amplitude_deg=3.0", shown, "setpoint.at_s=1.0"]), None);
    let (short, calm) = ("loop.duration_s=1.0", "setpoint.amplitude_deg=0.1");
    let added = "disturbance=[{kind='step', enters_at='measurement', amplitude_deg=6.0, at_s=0.5}]";
    assert_eq!(of(&[short, calm, added]), Some(Doubt::HeldByGuard));
    // One that came and went has left no trace but the fault.
    let pulse = "disturbance=[{kind='pulse', enters_at='measurement', amplitude_deg=6.0, at_s=0.5, width_s=0.05}]";
    assert_eq!(of(&["loop.duration_s=5.0", calm, pulse]), None);
    let simulation = Simulation::of(&study(GUARDED, &[])).expect("it flies");
    assert!(simulation.judgements[0].value_in_words().starts_with("undecided: "));
}

/// Gains and guards: what is called stable is at its set-point ten times as late.
#[test]
fn flights_of_drawn_sample_guards_that_are_called_stable_come_to_the_set_point() {
    let mut draw = Draw::seeded(113);
    let mut seen = [0; 2];
    for _ in 0..60 {
        let set = vec![
            format!("controller.C.kp={:?}", draw.between(0.5, 2.0)),
            format!("controller.C.ki={:?}", draw.between(0.1, 0.8)),
            format!("controller.C.sample_guard_deg={:?}", draw.between(5.0, 7.5)),
            format!("loop.duration_s={:?}", draw.between(8.0, 15.0)),
        ];
        let flown = flown_on(GUARDED, &set, 15.0);
        seen[usize::from(flown.is_some())] += 1;
        let Some(flown) = flown else { continue };
        let left_deg = flown.trace.theta_rad.last().expect("a sample").to_degrees() - 5.0;
        assert!(left_deg.abs() < 0.1, "{set:?}: {left_deg}");
    }
    assert!(seen.iter().all(|count| *count > 5), "{seen:?}");
}
