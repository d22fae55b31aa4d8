//! Scenarios with an autopilot around the loop: what is judged, and what is refused.

use fspid_scenario::file;
use fspid_sim::{EarlyEnd, EndCause};
use fspid_study::analysis::{Analysis, Question, Stability};
use fspid_study::metrics::Verdict;
use fspid_study::simulation::Simulation;

use crate::flying::{column, result, study};

const CAPTURE: &str = include_str!("../../../../scenarios/gallery/altitude-capture.toml");
const APPROACH: &str = include_str!("../../../../scenarios/gallery/ils-approach.toml");
const TURN: &str = include_str!("../../../../scenarios/gallery/turn.toml");
const ENERGY: &str = include_str!("../../../../scenarios/gallery/total-energy.toml");

fn flown(text: &str, set: &[&str]) -> Simulation {
    Simulation::of(&study(text, set)).expect("it flies")
}

fn ends(simulation: &Simulation, name: &str) -> f64 {
    column(&simulation.results[0].trace, name).last().copied().expect("a sample")
}

#[test]
fn the_capture_of_the_gallery_ends_at_its_altitude_and_airspeed() {
    let flight = flown(CAPTURE, &["loop.duration_s=150.0"]);
    assert_eq!(flight.results[0].verdict(), Verdict::Flown);
    assert!((ends(&flight, "altitude_m") / 0.3048 - 1300.0).abs() < 1.0);
    assert!((ends(&flight, "airspeed_m_s") / 0.3048 - 176.0).abs() < 0.5);
}

#[test]
fn the_approach_of_the_gallery_stays_on_the_beam_in_turbulence() {
    let flight = flown(APPROACH, &[]);
    assert_eq!(ends(&flight, "mode"), 2.0);
    let trace = &flight.results[0].trace;
    let (altitudes, norths) = (column(trace, "altitude_m"), column(trace, "north_m"));
    let captured = column(trace, "mode").iter().position(|mode| *mode == 2.0).expect("it is met");
    // The truth, and not what the receiver shows: 4 nautical miles before the antenna at the start.
    let slope = 3.0_f64.to_radians().tan();
    let above = altitudes.iter().zip(norths).map(|(m, north_m)| m - (7408.0 - north_m) * slope);
    let later: Vec<f64> = above.skip(captured + 1500).collect();
    let furthest = later.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    assert!(later.len() > 1500 && furthest < 10.0, "{furthest}");
}

#[test]
fn the_turn_of_the_gallery_holds_its_altitude_with_30_deg_of_bank() {
    let flight = flown(TURN, &[]);
    let trace = &flight.results[0].trace;
    let most = |name: &str| column(trace, name).iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    assert!(
        (most("bank_rad").to_degrees() - 30.0).abs() < 3.0,
        "{}",
        most("bank_rad").to_degrees()
    );
    assert!(most("sideslip_rad").to_degrees() < 3.0, "{}", most("sideslip_rad").to_degrees());
    let lost = column(trace, "altitude_m").iter().map(|it| (it - 304.8).abs()).fold(0.0, f64::max);
    assert!(lost < 12.0, "{lost}");
    assert!((ends(&flight, "heading_rad").to_degrees() - 90.0).abs() < 1.0);
}

#[test]
fn total_energy_of_the_gallery_buys_neither_altitude_nor_airspeed_with_the_other() {
    let flight = flown(ENERGY, &[]);
    assert!((ends(&flight, "altitude_m") / 0.3048 - 1200.0).abs() < 3.0);
    assert!((ends(&flight, "airspeed_m_s") / (1852.0 / 3600.0) - 95.0).abs() < 0.5);
}

#[test]
fn a_mode_that_never_begins_fails_the_flight_whatever_is_required() {
    let never = "mode.capture.when.altitude_above_ft=20000.0";
    let flight = flown(CAPTURE, &[never]);
    assert_eq!(flight.results[0].verdict(), Verdict::ModeNeverBegan { mode: 2 });
    assert!(!flight.requirements_met());
    let text = flight.text();
    assert!(text.contains("mode 3 of the autopilot never began"), "{text}");
}

/// The pitch loop alone is stable; the altitude loop around it is far too fast.
#[test]
fn outer_loops_that_grow_are_called_unstable_by_flight_and_analysis_alike() {
    let fast = ["outer_loop.altitude.kp=4.0"];
    let flight = flown(CAPTURE, &fast);
    let verdict = flight.results[0].verdict();
    assert!(
        matches!(
            verdict,
            Verdict::Unstable { .. }
                | Verdict::EndedEarly(EarlyEnd { cause: EndCause::Diverged, .. })
        ),
        "{verdict}"
    );
    let analysis = Analysis::of(&study(CAPTURE, &fast), Question::default()).expect("analysed");
    assert_eq!(analysis.stability(), Stability::Unstable);
    assert!(!analysis.all_held());
    let text = analysis.text();
    assert!(text.contains("UNSTABLE with the outer loops of 2 of 3 modes"), "{text}");
    // The JSON said that the pitch loop alone is stable, and nothing else by that name.
    let told = analysis.json()["controllers"][0].clone();
    assert!(told["stable"] == false && told["stability"] == "unstable", "{told}");
    let good = Analysis::of(&study(CAPTURE, &[]), Question::default()).expect("analysed");
    assert_eq!(good.stability(), Stability::Stable);
    assert!(good.text().contains("mode capture: stable with its outer loops"), "{}", good.text());
}

#[test]
fn every_problem_of_loops_and_modes_is_told_at_once_with_its_place() {
    let wrong = [
        "outer_loop.altitude.moves=vertcal speed",
        "mode.climb.engage=[\"vertical speed\", \"autotrottle\"]",
        "mode.capture.target.heading_deg=3.0",
    ];
    let overrides: Vec<String> = wrong.iter().map(|it| (*it).to_owned()).collect();
    let problems = file::parse(CAPTURE, "capture.toml", None, &overrides).expect_err("refused");
    let text = problems.to_string();
    for expected in ["did you mean `vertical speed`?", "did you mean `autothrottle`?"] {
        assert!(text.contains(expected), "{text}");
    }
    let alone = [overrides[2].clone()];
    let text = file::parse(CAPTURE, "capture.toml", None, &alone).expect_err("refused").to_string();
    assert!(text.contains("mode \"capture\" has a target for heading"), "{text}");
}

#[test]
fn an_autopilot_around_a_linear_plant_is_refused_by_every_table() {
    let linear = ["aircraft.model=linear".to_owned()];
    let problems = file::parse(CAPTURE, "capture.toml", None, &linear).expect_err("refused");
    let text = problems.to_string();
    for table in ["engine", "outer_loop[0]", "outer_loop[2]", "mode[1]"] {
        assert!(text.contains(table), "{table}: {text}");
    }
}

#[test]
fn an_outer_loop_may_tune_itself() {
    let supervised = CAPTURE.replace(
        "name = \"altitude\"\nkind = \"pid\"\nholds = \"altitude\"\nmoves = \"vertical speed\"\nkp = 0.15\n",
        "name = \"altitude\"\nkind = \"fspid\"\nholds = \"altitude\"\nmoves = \"vertical speed\"\nnominal = { kp = 0.15 }\n\
         supervisor = { table = \"mirrored\", range = 5.0, error_scale = 0.1, output_scale = { kp = 0.02, ki = 0.0, kd = 0.0 } }\n",
    );
    assert_ne!(supervised, CAPTURE);
    let flight = flown(&supervised, &["loop.duration_s=150.0"]);
    assert!((ends(&flight, "altitude_m") / 0.3048 - 1300.0).abs() < 3.0);
    let plain = flown(CAPTURE, &["loop.duration_s=150.0"]);
    assert_ne!(
        column(&flight.results[0].trace, "altitude_m"),
        column(&plain.results[0].trace, "altitude_m")
    );
}

/// Of a Navion whose pitch loop grows by itself: in 104 s a load left 10^102 deg "for good", and in 400 s nothing could be asked.
#[test]
fn what_a_constant_load_does_is_not_asked_of_a_pitch_loop_that_outer_loops_hold() {
    const TOTAL_ENERGY: &str = include_str!("../../../../scenarios/gallery/total-energy.toml");
    let flown = |speed: &str, duration: &str| {
        let [speed, duration] =
            [format!("aircraft.airspeed_ft_s={speed}"), format!("loop.duration_s={duration}")];
        let at_rest = result(TOTAL_ENERGY, &[&speed, &duration]).at_rest;
        (at_rest.stability_word(), at_rest.load.is_some(), at_rest.not_asked)
    };
    for duration in ["104.0", "400.0"] {
        assert_eq!(flown("209.0", duration), (Some("stable"), false, None), "{duration} s");
    }
    assert_eq!(flown("176.0", "104.0"), (Some("stable"), true, None));
}
