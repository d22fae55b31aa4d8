//! One verdict on the stability of a loop, whatever its limits are and whoever is asked.

use fspid_sim::stability::loop_spectral_radius;
use fspid_sim::{Controller, EarlyEnd, EndCause};
use fspid_study::analysis::{Analysis, AtRest, Question, Stability};
use fspid_study::metrics::Verdict;
use fspid_study::simulation::Simulation;
use rand_chacha::rand_core::Rng;

use super::{Draw, study};

/// A loop without limits, flown for a moment; requirements ask the loop and the flight.
const LOOP: &str = r#"
schema = 1
name = "drawn"
[plant]
preset = "navion-paper"
[loop]
sample_period_s = 0.01
duration_s = 0.1
[setpoint]
kind = "step"
amplitude_deg = 5.0
[[controller]]
name = "PID"
kind = "pid"
kp = 1.0
ki = 0.5
kd = 0.05
[[requirement]]
measure = "stable"
[[requirement]]
measure = "iae_deg_s"
most = 1e9
"#;

/// What nobody can tell from eigenvalues is left to the computed verdict.
const KNOWN: f64 = 1e-7;

impl Draw {
    /// A plant, a servo and gains; many of them grow slowly.
    fn free(&mut self) -> Vec<String> {
        let plant = self.of(&[
            "b747-paper",
            "navion-paper",
            "b747-short-period",
            "navion-full",
            "ctms-pitch",
        ]);
        let size = |exponent: f64| 10f64.powf(exponent);
        let kp = self.of(&[0.0, 1.0, 1.0, -0.1]) * size(self.between(-2.0, 1.7));
        let ki = self.of(&[0.0, 1.0, -1.0]) * size(self.between(-4.0, 0.7));
        let kd = self.of(&[0.0, 1.0, 1.0]) * size(self.between(-2.0, 0.7));
        vec![
            format!("plant.preset={plant}"),
            format!("actuator={{time_constant_s={:.4}}}", self.between(0.02, 0.3)),
            format!("actuator.delay_samples={}", self.of(&[0, 1, 5, 20])),
            format!("controller.PID.kp={kp:e}"),
            format!("controller.PID.ki={ki:e}"),
            format!("controller.PID.kd={kd:e}"),
        ]
    }

    fn limits(&mut self) -> Vec<String> {
        let limit = self.between(0.01, 30.0);
        let all = [
            format!("controller.PID.output_limits_deg=[-{limit:.3},{limit:.3}]"),
            format!("controller.PID.slew_limit_deg_s={limit:.3}"),
            format!("actuator.position_limit_deg={limit:.3}"),
            format!("actuator.rate_limit_deg_s={limit:.3}"),
        ];
        let wanted = 1 + self.0.next_u32() % 15;
        all.into_iter()
            .enumerate()
            .filter(|(bit, _)| wanted >> bit & 1 == 1)
            .map(|it| it.1)
            .collect()
    }
}

/// What everybody says of the loop, each in its own way.
fn said(set: &[String]) -> [(&'static str, Stability); 5] {
    let set: Vec<&str> = set.iter().map(String::as_str).collect();
    let study = study(LOOP, &set);
    let controller = &study.scenario.controllers[0].controller;
    let at_rest = AtRest::stability(&study.scenario, controller);
    let asked = match (at_rest.unstable, at_rest.undecided) {
        (Some(_), _) => Stability::Unstable,
        (None, Some(_)) => Stability::Undecided,
        (None, None) if at_rest.not_asked.is_none() => Stability::Stable,
        other => panic!("{other:?} {:?}", at_rest.not_asked),
    };
    let flight = Simulation::of(&study).expect("it flies");
    let flown = match (flight.results[0].verdict(), flight.results[0].at_rest.undecided) {
        (
            Verdict::Unstable { .. }
            | Verdict::EndedEarly(EarlyEnd { cause: EndCause::Diverged, .. }),
            _,
        ) => Stability::Unstable,
        (_, Some(_)) => Stability::Undecided,
        (_, None) => Stability::Stable,
    };
    let of_word = |word: &str| match word {
        "stable" => Stability::Stable,
        "unstable" => Stability::Unstable,
        other => {
            assert!(other.starts_with("undecided: "), "{other}");
            Stability::Undecided
        }
    };
    let required = of_word(&flight.judgements[0].value_in_words());
    let question = Question { map_points: 0, ..Question::default() };
    let analysis = Analysis::of(&study, question).expect("a loop");
    let told = of_word(match analysis.json()["controllers"][0]["stability"].as_str() {
        Some("undecided") => "undecided: ",
        word => word.expect("a word"),
    });
    [
        ("at rest", asked),
        ("flight", flown),
        ("requirement", required),
        ("analysis", analysis.stability()),
        ("JSON", told),
    ]
}

/// A PID with limits and a loop that grows was called settled, and the same PID without limits unstable.
#[test]
fn limits_change_nothing_about_stability_at_rest_but_what_they_make_swing_and_everybody_says_the_same()
 {
    let mut draw = Draw::seeded(22);
    let (mut seen, mut swings) = ([0; 2], 0);
    for _ in 0..120 {
        let free = draw.free();
        let limited: Vec<String> = free.iter().cloned().chain(draw.limits()).collect();
        let words: Vec<&str> = free.iter().map(String::as_str).collect();
        let without = study(LOOP, &words);
        let Controller::Fixed(pid) = without.scenario.controllers[0].controller else {
            panic!("a PID")
        };
        let radius = loop_spectral_radius(&without.scenario, pid.gains(), pid.config());
        let radius = radius.expect("eigenvalues");
        let (with, alone) = (said(&limited), said(&free));
        let [at_rest, of_flight @ ..] = with;
        if of_flight != alone[1..] {
            // A swing that limits keep up is one of the flight, and of everybody who speaks of it.
            assert_eq!([at_rest, alone[1]].map(|it| it.1), [Stability::Stable; 2], "{limited:?}");
            assert!(of_flight.iter().all(|it| it.1 == Stability::Undecided), "{limited:?}");
            swings += 1;
            continue;
        }
        assert_eq!(at_rest, alone[0], "{limited:?}");
        for (who, verdict) in with {
            assert_eq!(verdict, with[0].1, "{who}, {radius}: {limited:?}");
            let is_right = match verdict {
                Stability::Stable => radius < 1.0 + KNOWN,
                Stability::Unstable => radius > 1.0 - KNOWN,
                Stability::Undecided => (radius - 1.0).abs() < KNOWN,
            };
            assert!(is_right, "{who} says {} of {radius}: {limited:?}", verdict.word());
        }
        seen[usize::from(radius > 1.0 + KNOWN)] += usize::from((radius - 1.0).abs() > KNOWN);
    }
    assert!(seen.iter().all(|count| *count >= 25), "stable and unstable: {seen:?}");
    assert!(swings <= 20, "{swings}");
}

/// A pole on the unit circle was UNSTABLE in `analyse`, without a pole and without a reason, and in requirements, and
/// nothing at all in a flight.
#[test]
fn a_pole_on_the_unit_circle_is_undecided_with_one_reason_everywhere() {
    let off = ["kp", "ki", "kd"].map(|gain| format!("controller.PID.{gain}=0.0"));
    let limits = "controller.PID.output_limits_deg=[-20,20]".to_owned();
    for set in [off.to_vec(), [off.as_slice(), &[limits]].concat()] {
        for (who, verdict) in said(&set) {
            assert_eq!(verdict, Stability::Undecided, "{who}");
        }
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let study = study(LOOP, &set);
        let reason = "undecided: rounding may carry poles across the unit circle (spectral radius 1.000000000 as computed)";
        let flight = Simulation::of(&study).expect("it flies");
        let analysis = Analysis::of(&study, Question::default()).expect("a loop");
        let page = fspid_study::report::of_analysis(&study, &analysis).expect("a page");
        let told = analysis.json()["controllers"][0].clone();
        assert!(told["stable"].is_null() && told["absent"] == reason, "{told}");
        assert_eq!(told["unstable_poles"], serde_json::json!([]));
        assert!(analysis.text().contains("UNDECIDED with kp"), "{}", analysis.text());
        assert!(flight.text().matches(reason).count() >= 3, "{}", flight.text());
        for text in [analysis.text(), page] {
            assert!(text.contains(reason), "{text}");
        }
    }
}
