//! What a candidate is worth, against what a single flight measures.
#![allow(clippy::float_cmp, reason = "the same bits are asked for")]

use fspid_scenario::file;
use fspid_scenario::units::degrees;
use fspid_study::simulation::Simulation;
use fspid_tune::{Crew, Effort, FORBIDDEN, Search, Source, Trial, Tuned, TuningProblem};

const SCENARIO: &str = r#"schema = 1
name = "to be tuned"

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
name = "PID"
kind = "pid"
kp = { tune = [0.1, 40.0], scale = "log", start = 1.0 }
ki = { tune = [0.01, 5.0], scale = "log", start = 0.5 }
kd = 0.1
derivative_filter_s = 0.05

[[controller]]
name = "P"
kind = "p"
kp = { tune = [0.1, 2.0] }

[[dispersion]]
path = "plant.preset.numerator[0]"
distribution = "uniform"
lower = 0.7
upper = 1.3
relative = true

[tuning]
controller = "PID"

[[tuning.objective]]
measure = "iae_deg_s"

[[tuning.objective]]
measure = "elevator_travel_deg"
weight = 0.05
"#;

/// The scenario with changes of its text, in a folder of its own.
fn problem(changes: &[(&str, &str)]) -> TuningProblem {
    let text = changes.iter().fold(SCENARIO.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    });
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pitch.toml");
    std::fs::write(&path, text).expect("written");
    let source = Source { path, overrides: Vec::new() };
    TuningProblem::new(&source, None).unwrap_or_else(|error| panic!("{error}"))
}

/// The scenario was read once more at the end: edited during a search, its new text got numbers that were found for the old
/// one, at places where the marks had been, and without the file the whole search was in vain.
#[test]
fn a_design_is_made_of_the_scenario_as_it_was_when_the_search_began() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pitch.toml");
    std::fs::write(&path, SCENARIO).expect("written");
    let source = Source { path: path.clone(), overrides: vec!["loop.duration_s=3".to_owned()] };
    let problem = TuningProblem::new(&source, None).unwrap_or_else(|error| panic!("{error}"));
    let design = || {
        let text = problem.design(&problem.space().start(), &["a design".to_owned()]);
        text.unwrap_or_else(|error| panic!("{error}"))
    };
    let expected = design();
    let begin = "# a design\nset = [\"loop.duration_s=3\"]\nschema = 1\n";
    assert!(expected.starts_with(begin), "{expected}");
    assert!(expected.contains("kd = 0.1\n") && !expected.contains("start = 1.0"), "{expected}");
    std::fs::write(&path, SCENARIO.replace("kd = 0.1", "# edited\nkd = 0.2")).expect("written");
    assert_eq!(design(), expected);
    std::fs::remove_file(&path).expect("removed");
    assert_eq!(design(), expected);
}

fn reasons(problem: &TuningProblem, point: &[f64]) -> Vec<String> {
    problem.reasons(point, Crew::UNSTOPPED).expect("flown")
}

/// A place in the unit cube where the proportional gain is `kp`.
fn with_kp(problem: &TuningProblem, kp: f64) -> Vec<f64> {
    let mut point = problem.space().start();
    point[0] = libm::log(kp / 0.1) / libm::log(400.0);
    point
}

#[test]
fn the_cost_of_a_candidate_is_the_weighted_sum_of_what_a_flight_measures() {
    let problem = problem(&[]);
    let point = with_kp(&problem, 1.7);
    let score = problem.scores(std::slice::from_ref(&point)).remove(0);
    let kp = problem.space().numbers(&point)[0];
    let plain = SCENARIO
        .replace("{ tune = [0.1, 40.0], scale = \"log\", start = 1.0 }", &format!("{kp:?}"));
    let study = file::parse(&plain, "plain.toml", None, &[]).expect("a scenario");
    let flown = Simulation::of(&study).expect("it flies");
    let iae = degrees(flown.results[0].metrics.integrals.expect("measured").iae_rad_s);
    let elevator = &flown.results[0].trace.elevator_rad;
    let travel: f64 = elevator.windows(2).map(|two| degrees((two[1] - two[0]).abs())).sum();
    assert_eq!(score.values[0], iae);
    assert!((score.values[1] - travel).abs() < 1e-9, "{score:?} {travel}");
    assert!((score.cost - (iae + 0.05 * travel)).abs() < 1e-9, "{score:?}");
    assert!(score.is_allowed());
}

#[test]
fn candidates_fly_with_the_same_draws_whoever_flies_beside_them() {
    let problem = problem(&[("controller = \"PID\"\n\n", "controller = \"PID\"\nruns = 5\n\n")]);
    assert_eq!(problem.flights(), 5);
    let points: Vec<Vec<f64>> = [0.5, 1.0, 2.0, 1.0].map(|kp| with_kp(&problem, kp)).to_vec();
    let together = problem.scores(&points);
    assert_eq!(together[1], together[3]);
    for (point, score) in points.iter().zip(&together) {
        assert_eq!(problem.scores(std::slice::from_ref(point))[0], *score);
    }
}

#[test]
fn the_worst_flight_costs_no_less_than_the_tail_and_the_tail_no_less_than_the_mean() {
    let cost = |over: &str| {
        let to = format!("controller = \"PID\"\nruns = 7\nover = \"{over}\"\n\n");
        let problem = problem(&[("controller = \"PID\"\n\n", &to)]);
        problem.scores(&[problem.space().start()])[0].cost
    };
    let (mean, tail, worst) = (cost("mean"), cost("tail\"\nshare = 0.3 # \""), cost("worst"));
    assert!(mean < tail && tail < worst, "{mean} {tail} {worst}");
}

#[test]
fn a_lost_flight_costs_more_than_a_broken_requirement_and_that_more_than_any_allowed_one() {
    let limit = "\n[[requirement]]\nmeasure = \"overshoot_pct\"\nmost = 15.0\n\n[tuning]";
    let problem = problem(&[("\n[tuning]", limit)]);
    let kps = [1.0, 3.0, 10.0, 40.0];
    let points: Vec<Vec<f64>> = kps.map(|kp| with_kp(&problem, kp)).to_vec();
    let scores = problem.scores(&points);
    assert!(scores[0].is_allowed() && scores[0].cost < FORBIDDEN, "{scores:?}");
    assert!(!scores[1].is_allowed() && scores[1].values.len() == 2, "{scores:?}");
    assert!(scores[3].values.is_empty(), "{scores:?}");
    let costs: Vec<f64> = scores.iter().map(|score| score.cost).collect();
    assert!(costs.is_sorted(), "{costs:?}");
    assert!(
        reasons(&problem, &points[1])[0].contains("overshoot_pct"),
        "{:?}",
        reasons(&problem, &points[1])
    );
    assert!(
        reasons(&problem, &points[3])[0].contains("diverged"),
        "{:?}",
        reasons(&problem, &points[3])
    );
}

#[test]
fn a_search_spends_its_budget_and_no_more_and_keeps_its_best() {
    let problem = problem(&[]);
    for optimiser in Effort::optimisers() {
        let effort = Effort {
            optimiser: optimiser.to_owned(),
            budget: 33,
            seed: 4,
            population: None,
            anywhere: false,
        };
        let mut search = Search::begin(&problem, effort, Crew::UNSTOPPED).expect("it begins");
        while search.advance().expect("flown").is_none() {}
        assert_eq!(search.spent(), 33, "{optimiser}");
        let least = search.trials().iter().map(|trial| trial.score.cost).fold(f64::MAX, f64::min);
        assert_eq!(search.best().score.cost, least, "{optimiser}");
        assert!(search.trials().iter().all(|it| it.point.iter().all(|x| (0.0..=1.0).contains(x))));
    }
}

#[test]
fn no_entry_of_a_front_beats_another_and_the_front_beats_every_candidate() {
    let problem = problem(&[]);
    let effort = Effort {
        optimiser: "nsga-ii".to_owned(),
        budget: 120,
        seed: 1,
        population: Some(20),
        anywhere: false,
    };
    let mut search = Search::begin(&problem, effort, Crew::UNSTOPPED).expect("it begins");
    while search.advance().expect("flown").is_none() {}
    let front = search.front();
    let objectives = |index: usize| &front[index].score.objectives;
    for index in 1..front.len() {
        assert!(objectives(index)[0] > objectives(index - 1)[0]);
        assert!(objectives(index)[1] < objectives(index - 1)[1]);
    }
    for trial in search.trials().iter().filter(|trial| trial.score.is_allowed()) {
        let covered = front.iter().any(|one| {
            one.score.objectives.iter().zip(&trial.score.objectives).all(|(a, b)| a <= b)
        });
        assert!(covered, "{trial:?}");
    }
    assert!(search.front_volume().expect("a front") > 0.0);
}

#[test]
fn a_mean_beyond_its_limit_is_not_allowed_however_small_the_cost() {
    let limit = |most: f64| {
        let text = format!(
            "[tuning]\ncontroller = \"PID\"\n[[tuning.limit]]\nmeasure = \"elevator_travel_deg\"\nmost = {most:?}\n"
        );
        problem(&[("[tuning]\ncontroller = \"PID\"\n", &text)])
    };
    let free = limit(1e6);
    let point = with_kp(&free, 1.7);
    let score = free.scores(std::slice::from_ref(&point)).remove(0);
    let travel = score.limited[0];
    assert!(score.is_allowed() && travel == score.values[1], "{score:?}");
    let tight = limit(travel / 2.0).scores(std::slice::from_ref(&point)).remove(0);
    assert!((tight.violation - 1.0).abs() < 1e-9 && tight.cost >= FORBIDDEN, "{tight:?}");
    // What it came to is told all the same.
    assert_eq!(tight.values, score.values);
    assert!(limit(travel).scores(&[point]).remove(0).is_allowed());
}

#[test]
fn a_requirement_counts_in_its_cases_alone() {
    let with = |words: &str| {
        let text = format!(
            "[tuning]\ncontroller = \"PID\"\n[[tuning.case]]\nname = \"up\"\nset = []\n[[tuning.case]]\nname = \"down\"\n\
             group = \"falls\"\nset = [\"setpoint.amplitude_deg=-2\"]\n[[requirement]]\nmeasure = \"overshoot_pct\"\nmost = 0.0\n{words}\n"
        );
        let problem = problem(&[("[tuning]\ncontroller = \"PID\"\n", &text)]);
        let point = problem.space().start();
        problem.scores(&[point]).remove(0).violation
    };
    let all = with("");
    assert!(all > 0.0);
    assert_eq!(with("not_in = [\"falls\"]"), all / 2.0);
    assert_eq!(with("only_in = [\"up\"]"), all / 2.0);
    assert_eq!(with("not_in = [\"falls\", \"up\"]"), 0.0);
}

#[test]
fn the_digest_of_a_tuning_is_of_what_it_flies_and_not_of_other_controllers_or_words() {
    let digest = |changes: &[(&str, &str)]| problem(changes).digest();
    let own = digest(&[]);
    for same in [
        ("kp = { tune = [0.1, 2.0] }", "kp = 0.3"),
        ("schema = 1\n", "# A remark.\nschema = 1\n"),
        ("duration_s = 4.0", "duration_s = 4.00"),
    ] {
        assert_eq!(digest(&[same]), own, "{same:?}");
    }
    for other in [
        ("duration_s = 4.0", "duration_s = 4.1"),
        ("start = 0.5", "start = 0.51"),
        ("kd = 0.1", "kd = 0.11"),
        ("weight = 0.05", "weight = 0.06"),
        ("preset = \"navion-paper\"", "preset = \"b747-paper\""),
    ] {
        assert_ne!(digest(&[other]), own, "{other:?}");
    }
}

/// A self-tuning controller whose rules take the integral away at rest met everything that was required.
#[test]
fn a_candidate_that_keeps_a_constant_load_is_refused_unless_the_file_ignores_loads() {
    let fspid = "[[controller]]\nname = \"FSPID\"\nkind = \"fspid\"\n\
        nominal = { kp = { tune = [0.1, 2.0], start = 1.0 }, ki = { tune = [0.0, 1.0], start = 0.5 }, kd = 0.05 }\n\
        law = \"memoryless\"\nsupervisor = { table = \"mirrored\", range = 5.0, error_scale = 1.0, change_scale = 0.2, output_scale = { kp = 0.05, ki = 0.05, kd = 0.01 } }\n\
        gain_limits = { kp_min = 0.0, ki_min = 0.0, kd_min = 0.0 }\n\n[[dispersion]]";
    let tuned = [
        ("[[dispersion]]", fspid),
        ("controller = \"PID\"", "controller = \"FSPID\""),
        ("duration_s = 4.0", "duration_s = 20.0"),
    ];
    let problem = |more: &[(&str, &str)]| problem(&[&tuned[..], more].concat());
    let asked = problem(&[]);
    let (well, mut lost) = (asked.space().start(), asked.space().start());
    lost[1] = 0.0;
    let scores = asked.scores(&[well.clone(), lost.clone()]);
    assert!(scores[0].is_allowed() && !scores[1].is_allowed(), "{scores:?}");
    let reasons = reasons(&asked, &lost);
    assert!(reasons[0].contains("no integral at rest (ki = 0): a constant load"), "{reasons:?}");
    assert!(asked.removes_constant_load());
    let told = asked.at_rest(&lost);
    assert!(told[0].starts_with("gains nominal kp 1, ki 0,") && told.len() == 2, "{told:?}");
    let ignored = problem(&[(
        "controller = \"FSPID\"\n",
        "controller = \"FSPID\"\nconstant_load = \"ignored\"\n",
    )]);
    assert!(ignored.scores(&[lost])[0].is_allowed() && !ignored.removes_constant_load());
    assert_ne!(asked.digest(), ignored.digest());
    assert_eq!(asked.scores(std::slice::from_ref(&well)), ignored.scores(&[well]));
}

/// A design of a quarter of each range, which is read again with the numbers that were found.
fn design_with_its_numbers(source: &Source) -> String {
    let problem = TuningProblem::new(source, None).unwrap_or_else(|error| panic!("{error}"));
    let mut point = problem.space().start();
    point.iter_mut().for_each(|it| *it = 0.25);
    let design = problem.design(&point, &["found".to_owned()]);
    let design = design.unwrap_or_else(|error| panic!("{error}"));
    let read = file::parse(&design, "design.toml", None, &[]);
    let read = read.unwrap_or_else(|problems| panic!("{problems}\n{design}"));
    for (path, value) in problem.space().values(&point) {
        let found = file::Template::parse(&design, "design.toml", None, &Default::default());
        let found = found.expect("it was read").number_at(path).map(|it| format!("{it:?}"));
        assert_eq!(found, Some(value.to_string()), "{}\n{design}", path.text());
    }
    assert_eq!(read.tunable_parameters.len(), 1, "that of the other controller\n{design}");
    design
}

/// A second list was written, in front: a file that nobody could read, with exit code 0.
#[test]
fn a_design_has_its_changes_behind_those_that_its_scenario_lists() {
    let mark = r#""controller.PID.ki={ tune = [0.01, 5.0], scale = \"log\", start = 0.5 }""#;
    let lists = [
        format!("set = [{mark}]\n"),
        format!("\"set\" = [\n  'loop.duration_s=3', # shorter\n  {mark}, # free\n]\n"),
        "set = []\n".to_owned(),
    ];
    for (list, overrides) in lists.iter().flat_map(|list| {
        [Vec::new(), vec!["controller.PID.kd={ tune = [0.0, 0.2] }".to_owned()]]
            .map(|overrides| (list, overrides))
    }) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("pitch.toml");
        let plain = match list.contains("ki=") {
            true => "ki = 0.5",
            false => "ki = { tune = [0.01, 5.0], start = 0.5 }",
        };
        let own = "ki = { tune = [0.01, 5.0], scale = \"log\", start = 0.5 }";
        let text = format!("{list}{}", SCENARIO.replace(own, plain));
        std::fs::write(&path, text).expect("written");
        let design = design_with_its_numbers(&Source { path, overrides });
        assert!(!list.contains("duration") || design.contains("# shorter"), "{design}");
    }
}

#[test]
fn of_a_front_of_the_worst_flights_the_design_is_said_to_be_what_it_is() {
    let told = |over: &str| {
        let to = format!("controller = \"PID\"\nruns = 5\nover = \"{over}\"\n\n");
        let problem = problem(&[("controller = \"PID\"\n\n", &to)]);
        let effort = Effort {
            optimiser: "nsga-ii".to_owned(),
            budget: 40,
            seed: 3,
            population: Some(10),
            anywhere: false,
        };
        let mut search = Search::begin(&problem, effort, Crew::UNSTOPPED).expect("it begins");
        let stop = loop {
            if let Some(stop) = search.advance().expect("flown") {
                break stop;
            }
        };
        let tuned = Tuned::of(&problem, &search, stop).expect("flown");
        let sum = |it: &Trial| it.score.objectives.iter().sum::<f64>();
        let least = tuned.front.iter().map(sum).fold(f64::INFINITY, f64::min);
        (tuned.text(), sum(&tuned.best) - least)
    };
    let (text, beyond) = told("mean");
    assert!(text.contains("the one with the least weighted sum.\n"), "{text}");
    assert!(beyond.abs() < 1e-9, "{beyond}");
    for (over, words) in [
        ("worst", "greatest weighted sum of a flight"),
        ("tail\"\nshare = 0.4 # \"", "mean of the greatest weighted sums"),
    ] {
        let (text, _) = told(over);
        assert!(text.contains(words) && !text.contains("the one with the least"), "{text}");
    }
}

/// The design that was found is lost after 303 s, ten times its flights, and nothing was said of it.
#[test]
fn a_design_of_which_nobody_can_tell_whether_it_is_stable_is_told_so() {
    let case = |name: &str, duration_s: u32| {
        format!("\n[[tuning.case]]\nname = \"{name}\"\nset = [\"loop.duration_s={duration_s}\"]\n")
    };
    let text = RUNS_AWAY.to_owned() + HELD_BEYOND_A_LIMIT + &case("short", 20) + &case("long", 25);
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("held.toml");
    std::fs::write(&path, text).expect("a file");
    let problem = TuningProblem::new(&Source { path, overrides: Vec::new() }, None).expect("good");
    let told = problem.at_rest(&problem.space().start());
    let doubts: Vec<&String> = told.iter().filter(|it| it.contains("undecided")).collect();
    assert_eq!(doubts.len(), 1, "{told:?}");
    let said =
        "short and 1 more: stability at rest: undecided: the plant does not come to rest by itself";
    assert!(doubts[0].starts_with(said), "{told:?}");
}

/// An unstable plant, which a controller behind a limit holds until it is lost.
pub(crate) const RUNS_AWAY: &str = r#"
schema = 1
name = "held beyond its limit"
[plant]
numerator = [1.0]
denominator = [1.0, 0.95, -0.05]
elevator_sign = "nose-up-positive"
[actuator]
time_constant_s = 0.05
[loop]
sample_period_s = 0.02
duration_s = 20.0
[setpoint]
kind = "step"
amplitude_deg = 10.0
"#;

const HELD_BEYOND_A_LIMIT: &str = r#"
[[controller]]
name = "B"
kind = "pid"
kp = { tune = [0.6, 1.2], start = 0.8 }
ki = 0.0
kd = 0.5
setpoint_weights = { proportional = 0.9375, derivative = 0.0 }
output_limits_deg = [-0.49, 5.0]
[tuning]
constant_load = "ignored"
[[tuning.objective]]
measure = "iae_deg_s"
"#;
