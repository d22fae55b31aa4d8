//! What is marked free is what flies, whatever dispersions draw and cases set.
#![allow(clippy::float_cmp, reason = "the same bits are asked for")]

use std::path::Path;

use fspid_campaign::Draws;
use fspid_campaign::sample::Sampling;
use fspid_scenario::file::Template;
use fspid_scenario::units::degrees;
use fspid_study::simulation::Simulation;
use fspid_tune::contest::{Contest, Options};
use fspid_tune::{Source, TuneError, TuningProblem, Written};
use tempfile::TempDir;

const SCENARIO: &str = r#"schema = 1
name = "gains off by a tenth"

[plant]
preset = "navion-paper"

[actuator]
time_constant_s = 0.1

[loop]
sample_period_s = 0.02
duration_s = 4.0

[setpoint]
kind = "step"
amplitude_deg = 2.0

[[controller]]
name = "fixed"
kind = "pid"
kp = 1.0
ki = 0.4
kd = 0.1
derivative_filter_s = 0.05

[[controller]]
name = "PID"
kind = "pid"
kp = { tune = [0.1, 40.0], scale = "log", start = 1.0 }
ki = { tune = [0.01, 5.0], scale = "log", start = 0.5 }
kd = 0.1
derivative_filter_s = 0.05

[tuning]
controller = "PID"
runs = 4

[[tuning.objective]]
measure = "iae_deg_s"
"#;

fn drawn(path: &str, [lower, upper]: [f64; 2], relative: bool) -> String {
    format!(
        "\n[[dispersion]]\npath = '{path}'\ndistribution = \"uniform\"\nlower = {lower:?}\nupper = {upper:?}\nrelative = {relative}\n"
    )
}

fn of_tenth(path: &str) -> String {
    drawn(path, [0.9, 1.1], true)
}

fn case(of: &str, name: &str, set: &str) -> String {
    format!("\n[[{of}.case]]\nname = \"{name}\"\nset = [\"{set}\"]\n")
}

/// The scenario with more behind it, in a folder of its own.
fn place(more: &str) -> (TempDir, Source) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pitch.toml");
    std::fs::write(&path, format!("{SCENARIO}{more}")).expect("written");
    (folder, Source { path, overrides: Vec::new() })
}

fn problem(more: &str, controller: &str) -> Result<TuningProblem, TuneError> {
    TuningProblem::new(&place(more).1, Some(controller))
}

fn refused(more: &str) -> String {
    problem(more, "PID").expect_err("refused").to_string()
}

fn checked(more: &str) -> String {
    let text = format!("{SCENARIO}{more}");
    let written = Written { text: &text, name: "pitch.toml", folder: None, overrides: &[] };
    written.check().map_or_else(|wrong| wrong.to_string(), |()| String::new())
}

/// The mean error integral of a controller of a design, flown by the draws that a campaign of it has, deg s.
fn flown(design: &str, controller: &str) -> f64 {
    let template = Template::parse(design, "design.toml", Some(Path::new("")), &Default::default());
    let template = template.unwrap_or_else(|problems| panic!("{problems}"));
    let seed = template.study().tuning.as_ref().expect("it is tuned").run_seed;
    let draws = Draws::new(&template, Sampling::LatinHypercube, 4, seed).expect("draws");
    let flights = (0..4).map(|run| {
        let study = template.with(&draws.values(&draws.drawn(run))).expect("a scenario");
        let flown = Simulation::of(&study).expect("it flies");
        let names = study.scenario.controllers.iter().map(|named| named.name.as_str());
        let (_, mine) = names.zip(&flown.results).find(|(it, _)| *it == controller).expect("here");
        degrees(mine.metrics.integrals.expect("measured").iae_rad_s)
    });
    flights.sum::<f64>() / 4.0
}

/// The start was drawn and written over what was tuned, so that every candidate flew as the start.
#[test]
fn factors_are_of_what_is_tuned_as_a_campaign_of_the_design_draws_them() {
    for paths in [
        &["controller.PID.kp"][..],
        &["controller[1].kp", "controller.fixed.kp", "plant.preset.numerator[0]"],
        &["controller[0].kp", "controller[1].ki", "controller.PID.kd"],
    ] {
        let more: String = paths.iter().map(|path| of_tenth(path)).collect();
        let problem = problem(&more, "PID").unwrap_or_else(|error| panic!("{error}"));
        let mut point = problem.space().start();
        for place in [0.1, 0.3, 0.45] {
            point[0] = place;
            let told = problem.scores(std::slice::from_ref(&point))[0].values[0];
            let design = problem.design(&point, &[]).unwrap_or_else(|error| panic!("{error}"));
            let flown = flown(&design, "PID");
            assert!((told / flown - 1.0).abs() < 1e-9, "{paths:?}: {told} and {flown}");
        }
    }
}

/// A number of a controller in the list led to the first one of those that were left, and the name of another controller to none.
#[test]
fn a_dispersion_of_another_controller_is_not_drawn_for_the_one_that_is_tuned() {
    let cost = |more: &str| {
        let problem = problem(more, "PID").unwrap_or_else(|error| panic!("{error}"));
        problem.scores(&[problem.space().start()])[0].values[0]
    };
    let plant = of_tenth("plant.preset.numerator[0]");
    let alone = |path: &str| cost(&of_tenth(path));
    let (still, other) = (alone("controller.fixed.kp"), alone("controller[0].ki"));
    assert_eq!(still, other);
    assert_ne!(still, alone("controller[1].ki"));
    assert_eq!(alone("controller[1].ki"), alone("controller.PID.ki"));
    // Both at once: one factor for all that it leads to.
    let both = format!(
        "{plant}\n[[dispersion]]\npaths = [\"controller[0].kp\", \"controller[1].kp\"]\ndistribution = \"uniform\"\nlower = 0.9\nupper = 1.1\nrelative = true\n"
    );
    assert!(cost(&both).is_finite());
}

#[test]
fn a_draw_that_takes_no_notice_of_what_is_tuned_is_refused_by_name() {
    let fixed = drawn("controller.fixed.kp", [0.9, 1.1], false);
    for path in ["controller.PID.kp", "controller[1].kp"] {
        let more = format!("{fixed}{}", drawn(path, [0.9, 1.1], false));
        for told in [refused(&more), checked(&more)] {
            assert!(told.contains(&format!("a value for `{path}`")), "{told}");
            assert!(told.contains("dispersion[1]") && !told.contains("dispersion[0]"), "{told}");
            assert!(told.contains("relative = true"), "{told}");
        }
    }
    assert_eq!(checked(&fixed), "");
    // By a case alone.
    let case = case("tuning", "drawn", "dispersion[0].relative=false");
    let more = format!("{}{case}", of_tenth("controller.PID.kp"));
    for told in [refused(&more), checked(&more)] {
        assert!(told.contains("\"drawn\"") && told.contains("a value for"), "{told}");
    }
}

/// A case of three times the gain was flown with the candidate's gain, and told as that case.
#[test]
fn a_case_that_sets_what_is_marked_free_is_refused_by_name() {
    let right = case("tuning", "faster", "actuator.time_constant_s=0.05");
    let of_other = case("tuning", "other", "controller.fixed.kp=3");
    let kd = case("tuning", "kd", "controller.PID.kd=0.0");
    let draws = of_tenth("controller.fixed.kp");
    let sound = format!("{draws}{right}{of_other}{kd}");
    assert_eq!(checked(&sound), "");
    assert!(problem(&sound, "PID").is_ok());
    let first = case("tuning", "by name", "controller.PID.kp=9.0");
    let second = case("tuning", "by number", "controller[1].ki = 0.0");
    let again = case("tuning", "marked", "controller.PID.kp={ tune = [1.0, 2.0] }");
    let more = format!("{sound}{first}{second}{again}");
    for told in [refused(&more), checked(&more)] {
        for name in ["\"by name\"", "\"by number\"", "\"marked\"", "`controller.PID.kp`"] {
            assert!(told.contains(name), "{name}: {told}");
        }
        assert!(told.contains("tuning.case[3].set") && !told.contains("\"faster\""), "{told}");
        assert!(!told.contains("\"other\"") && !told.contains("\"kd\""), "{told}");
    }
}

#[test]
fn a_contest_refuses_cases_and_draws_that_leave_nothing_of_what_is_tuned_all_at_once() {
    let tuned = case("tuning", "set in tuning", "controller.PID.kp=9.0");
    let judged = case("contest", "set to be judged", "controller[1].ki=0.1");
    let right = case("contest", "right", "setpoint.amplitude_deg=3.0");
    let draws = drawn("controller.PID.kp", [0.9, 1.1], false);
    let more = format!("{draws}{tuned}{judged}{right}");
    let (_folder, source) = place(&more);
    let told = Contest::new(&source, &Options::default()).expect_err("refused").to_string();
    for part in ["\"set in tuning\"", "\"set to be judged\"", "a value for `controller.PID.kp`"] {
        assert_eq!(told.matches(part).count(), 1, "{part}: {told}");
        assert!(checked(&more).contains(part), "{part}");
    }
    assert!(!told.contains("\"right\""), "{told}");
    // Of the case that only a contest has, a tuning takes no notice.
    let more = format!("{}{judged}{right}", of_tenth("controller.PID.kp"));
    assert!(problem(&more, "PID").is_ok() && !checked(&more).is_empty());
}

/// Every controller may have a dispersion of its own, and the others fly without it, on the same plants.
#[test]
fn a_contest_has_dispersions_of_one_controller_by_its_name() {
    let cases: String = (3..6)
        .map(|at| case("contest", &format!("{at} deg"), &format!("setpoint.amplitude_deg={at}.0")))
        .collect();
    let draws = format!("{}{}", of_tenth("controller.PID.kp"), of_tenth("controller[0].kd"));
    let more = format!("{draws}\n[contest]\nruns = 2\n{cases}");
    let (_folder, source) = place(&more);
    let contest = Contest::new(&source, &Options::default());
    contest.unwrap_or_else(|error| panic!("{error}"));
}
