//! Intervals in which a number can move: against stability limits in closed form, and every value asked again.

use std::path::Path;

use fspid_study::verify::interval::{Interval, Question, TOLERANCE, Why, interval};
use fspid_study::verify::{Question as Verify, verify_text};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::JUMBO;

fn around(text: &str, path: &str) -> Interval {
    let question = Question { text, name: "test.toml", folder: None, path, sets: &[] };
    interval(&question).unwrap_or_else(|error| panic!("{error}"))
}

/// An integrator under a gain: its pole is 1 - kp dt, and with a sample of delay z^2 - z + kp dt = 0.
fn integrator(delay_samples: u32, kp: f64) -> String {
    format!(
        "schema = 1\nname = \"integrator\"\n[plant]\nnumerator = [1.0]\ndenominator = [1.0, 0.0]\nelevator_sign = \"nose-up-positive\"\n[actuator]\ndelay_samples = {delay_samples}\n[loop]\nsample_period_s = 0.1\nduration_s = 5.0\n[setpoint]\nkind = \"step\"\namplitude_deg = 1.0\n[[controller]]\nname = \"P\"\nkind = \"pid\"\nkp = {kp:?}\n[[requirement]]\nmeasure = \"stable\"\n"
    )
}

#[test]
fn the_interval_of_a_gain_ends_at_the_limit_of_stability_in_closed_form() {
    for (delay_samples, limit) in [(0, 20.0), (1, 10.0)] {
        for kp in [0.5 * limit, 0.21 * limit, 0.93 * limit] {
            let found = around(&integrator(delay_samples, kp), "controller.P.kp");
            let within = TOLERANCE * kp;
            assert!(found.holds(), "{}", found.text());
            let [below, above] = &found.search.ends;
            assert!(below.holds > 0.0 && below.holds <= within, "{}", found.text());
            assert!(above.holds < limit && above.holds >= limit - within, "{}", found.text());
            let beyond = above.beyond.as_ref().expect("an end");
            assert!(beyond.value >= limit && beyond.value <= limit + within, "{}", found.text());
            // On the limit itself nobody can tell, and that is not good either.
            let why = beyond.why.words();
            assert!(why.contains("unstable") || why.contains("undecided"), "{why}");
        }
    }
}

#[test]
fn a_present_value_that_fails_is_told_with_its_reason_and_the_nearest_that_holds() {
    let found = around(&integrator(0, 24.0), "controller.P.kp");
    assert!(!found.holds() && found.inside() == 0, "{}", found.text());
    let nearest = found.search.nearest.expect("one");
    assert!(nearest < 20.0 && nearest > 20.0 - 24.0 * TOLERANCE, "{nearest}");
    let text = found.text();
    assert!(text.starts_with("Does not hold at the present value 24: P: stable "), "{text}");
    assert_eq!(found.json()["least"], serde_json::Value::Null);
}

#[test]
fn the_limits_of_a_key_end_the_interval_and_what_is_no_number_has_none() {
    let text = integrator(0, 5.0);
    let found = around(&text, "setpoint.amplitude_deg");
    let found = [around(&text, "loop.sample_period_s"), found];
    let [below, above] = &found[0].search.ends;
    let refused = below.beyond.as_ref().map(|it| &it.why);
    assert!(matches!(refused, Some(Why::Refused(_) | Why::TooLong { .. })), "{refused:?}");
    assert!((above.holds - 0.4).abs() < 0.4 * TOLERANCE, "{}", found[0].text());
    for path in ["controller.P.name", "controller.Q.kp", "plant.numerator"] {
        let question = Question { text: &text, name: "test.toml", folder: None, path, sets: &[] };
        assert!(interval(&question).is_err(), "{path}");
    }
}

/// `controller[0].kp` was not there, which `--set` takes as `controller.P.kp`.
#[test]
fn a_number_has_its_interval_by_every_path_that_set_takes() {
    let text = integrator(0, 5.0);
    let (named, numbered) = (around(&text, "controller.P.kp"), around(&text, "controller[0].kp"));
    assert_eq!((numbered.present, &numbered.asked), (named.present, &named.asked));
    assert_eq!(numbered.search, named.search);
    let question =
        |path| Question { text: &text, name: "test.toml", folder: None, path, sets: &[] };
    for path in ["controller[1].kp", "plant[0].numerator", "controller[0]"] {
        assert!(interval(&question(path)).is_err(), "{path}");
    }
}

/// What `fspid verify --set path=value` says of a controller, or of all.
fn verified(text: &str, path: &str, value: f64, controller: Option<&str>) -> bool {
    verified_with(text, &[format!("{path}={value:?}")], controller)
}

fn verified_with(text: &str, settings: &[String], controller: Option<&str>) -> bool {
    let question = Verify { path: Path::new("test.toml"), settings, requirement_files: &[] };
    let Ok(found) = verify_text(text.to_owned(), &question, &[]) else { return false };
    let is_asked = |of: &str| controller.is_none_or(|name| name == of);
    found.judgements.iter().filter(|it| is_asked(&it.controller)).all(|it| it.met)
        && !found.failed_flights.iter().any(|it| is_asked(&it.controller))
}

#[test]
fn every_value_holds_or_fails_as_verify_judges_it_inside_and_just_outside() {
    let text = format!(
        "{}[[requirement]]\nmeasure = \"overshoot_pct\"\nmost = 25.0\n[[requirement]]\nmeasure = \"phase_margin_deg\"\nleast = 35.0\n",
        JUMBO.replace("duration_s = 20.0", "duration_s = 8.0")
    );
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let numbers = [
        ("controller.FSPID.nominal.kp", Some("FSPID")),
        ("controller.FSPID.supervisor.output_scale.kd", Some("FSPID")),
        ("controller.P.kp", Some("P")),
        ("actuator.time_constant_s", None),
    ];
    let mut outside = 0;
    for (path, controller) in numbers {
        let found = around(&text, path);
        assert_eq!(found.asked.controller.as_deref(), controller, "{path}");
        assert!(found.asked.requirements >= 2, "{path}");
        for end in &found.search.ends {
            let Some(beyond) = &end.beyond else { continue };
            assert!((beyond.value - end.holds).abs() <= found.within, "{path}");
            assert!(verified(&text, path, end.holds, controller), "{path}={}", end.holds);
            assert!(!verified(&text, path, beyond.value, controller), "{path}={}", beyond.value);
            outside += 1;
        }
        for _ in 0..6 {
            let index = random.next_u32() as usize % found.search.looks.len();
            let (value, holds) = found.search.looks[index];
            assert_eq!(verified(&text, path, value, controller), holds, "{path}={value}");
        }
    }
    assert!(outside >= 4, "{outside} ends were looked at");
}

#[test]
fn where_nothing_is_required_the_loop_has_to_be_stable_and_settled() {
    let found = around(JUMBO, "controller.FSPID.nominal.kp");
    assert_eq!(found.asked.requirements, 0);
    assert!(found.holds(), "{}", found.text());
    assert!(found.text().contains("as nothing is required"), "{}", found.text());
    assert!(found.text().contains("was not looked at"), "{}", found.text());
    // A law that keeps its gains has none of which stability could be asked.
    let kept = JUMBO.replace("\"memoryless\"", "\"accumulating\"");
    let found = around(&kept, "controller.FSPID.nominal.kp");
    let is_known = found.holds() == (found.search.ends[0].holds < found.search.ends[1].holds);
    assert!(is_known, "{}", found.text());
}

#[test]
fn ready_sets_are_required_of_every_value_as_verify_requires_them() {
    let text = JUMBO.replace("duration_s = 20.0", "duration_s = 8.0");
    let (path, sets) = ("controller.P.kp", ["ctms".to_owned()]);
    let question = Question { text: &text, name: "test.toml", folder: None, path, sets: &sets };
    let found = interval(&question).unwrap_or_else(|error| panic!("{error}"));
    let alone = around(&text, path);
    assert!(found.asked.requirements > alone.asked.requirements, "{}", found.text());
    assert!(found.text().contains("with ctms"), "{}", found.text());
    assert_eq!(found.json()["sets"], serde_json::json!(["ctms"]));
    for (value, holds) in found.search.looks.iter().step_by(5) {
        let settings = [sets[0].clone(), format!("{path}={value:?}")];
        assert_eq!(verified_with(&text, &settings, Some("P")), *holds, "{path}={value}");
    }
}
