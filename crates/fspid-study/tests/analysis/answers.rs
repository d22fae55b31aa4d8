//! The answers for people and programs, and what is told beside the numbers.

use fspid_scenario::file;
use fspid_study::analysis::{Analysis, Question};

use super::{LOOP, analysed, margins};

#[test]
fn an_end_without_limit_is_null_with_its_reason() {
    let answer = analysed(LOOP, &[]).json();
    let controller = &answer["controllers"][0];
    assert_eq!(controller["name"], "C");
    assert_eq!(controller["stable"], true);
    assert!(controller["gain_margin_db"][0].is_null());
    assert!(controller["gain_margin_db"][1].is_f64());
    let reason = controller["reasons"]["gain_margin_db[0]"].as_str().expect("a reason");
    assert!(reason.contains("no smaller gain"), "{reason}");
    for number in ["phase_margin_deg", "delay_margin_s", "disk_margin", "sensitivity_peak"] {
        assert!(controller[number].is_f64(), "{number}");
    }
    assert!(controller["gain_crossover_rad_s"].is_f64());
    assert_eq!(controller["unstable_poles"].as_array().map(Vec::len), Some(0));
}

#[test]
fn a_loop_whose_gain_is_nowhere_1_has_no_phase_margin_and_says_why() {
    let controller = &analysed(LOOP, &["controller.C.kp=0.001"]).json()["controllers"][0];
    assert_eq!(controller["stable"], true);
    assert!(controller["phase_margin_deg"].is_null() && controller["delay_margin_s"].is_null());
    assert!(controller["reasons"]["phase_margin_deg"].is_string());
}

#[test]
fn a_stable_loop_with_poor_margins_is_told_apart_from_a_good_one() {
    let step = include_str!("../../../../scenarios/747-pitch-step.toml");
    let analysis = analysed(step, &[]);
    let poor: Vec<bool> = analysis.loops.iter().map(|found| found.has_poor_margins()).collect();
    let phase = |index: usize| analysis.loops[index].margins().expect("stable").phase_margin_deg;
    assert_eq!(poor, [phase(0) < 45.0, phase(1) < 45.0, phase(2) < 45.0]);
    assert!(poor[0] && !poor[2]);
    let text = analysis.text();
    let verdict = "stable with kp 3.5287, ki 0.0000, kd 0.0000; phase margin below 45 deg";
    assert_eq!(text.matches(verdict).count(), 1, "{text}");
}

fn transport(name: &str) -> Analysis {
    let path = format!("{}/../../data/designs/learned/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let study = file::load(std::path::Path::new(&path), &[]).unwrap_or_else(|it| panic!("{it}"));
    Analysis::of(&study, Question::default()).expect("loops")
}

/// It said that each has more than 1 at rest.
#[test]
fn the_guide_tells_the_margins_of_the_designs_for_transports_as_they_are() {
    let guide = include_str!("../../../../docs/guide/margins-requirements-proof.md");
    let names = ["transport", "transport-steps", "transport-damped"];
    let found = names.map(|name| {
        let analysis = transport(name);
        let own = analysis.loops.iter().find(|it| it.name == "FSPID").expect("the design");
        let reach = own.plants[0].reach().expect("a law that remembers");
        [own.margins(), reach.worst.margins]
            .map(|it| format!("{:.2}", it.expect("held").disk_margin))
    });
    let [[rest, stands], [steps_rest, steps_stands], [damped_rest, damped_stands]] = found;
    let words = format!(
        "{stands} (`transport.toml`), {steps_stands} (`transport-steps.toml`) and {damped_stands} (`transport-damped.toml`), where they have {rest}, {steps_rest} and {damped_rest} at rest"
    );
    assert!(guide.contains(&words), "{words}");
}

/// "UNSTABLE at rest" stood beside "all 94 … hold", and nothing said why.
#[test]
fn a_loop_that_a_held_set_point_makes_unstable_says_why_its_frozen_gains_hold() {
    let text = transport("transport").text();
    let (_, own) = text.split_once("FSPID, by formula  ").expect("a design");
    assert!(own.trim_start().starts_with("UNSTABLE at rest"), "{own}");
    let why =
        "what the motion of the gains adds at a held set-point is not among gains that stand still";
    assert_eq!((text.matches(why).count(), own.matches(why).count()), (1, 1), "{text}");
}

#[test]
fn the_delay_of_a_sensor_takes_from_the_margins() {
    let plain = margins(LOOP, &["loop.sample_period_s=0.01"]).expect("stable");
    let sensor = ["sensor.preset=\"ideal\"", "sensor.pitch.delay_s=0.03"];
    let set = ["loop.sample_period_s=0.01", sensor[0], sensor[1]];
    let late = margins(LOOP, &set).expect("stable");
    let lost_deg = (plain.gain_crossover_rad_s.expect("a crossover") * 0.03).to_degrees();
    let found_deg = plain.phase_margin_deg - late.phase_margin_deg;
    assert!((found_deg - lost_deg).abs() < 1e-6, "{found_deg} for {lost_deg}");
}

#[test]
fn what_the_linear_loop_leaves_out_is_told() {
    let text = analysed(LOOP, &["actuator.rate_limit_deg_s=40.0"]).text();
    assert!(text.contains("Limits of the actuator are left out"), "{text}");
    assert!(!analysed(LOOP, &[]).text().contains("left out"));
}
