//! Flights by others: the same bits however orders are parted, and searches that somebody stops in the middle.

use std::cell::Cell;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use fspid_tune::contest::Then as After;
use fspid_tune::{
    Crew, Effort, Engine, Kept, Order, Search, Source, Then, Trial, TuneError, TuningProblem,
    Unfit, Worker,
};
use tempfile::TempDir;

use crate::contest::{files, marked, place};

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

[[requirement]]
measure = "overshoot_pct"
most = 40.0

[[dispersion]]
path = "plant.preset.numerator[0]"
distribution = "uniform"
lower = 0.7
upper = 1.3
relative = true

[tuning]
runs = 3

[[tuning.objective]]
measure = "iae_deg_s"

[[tuning.objective]]
measure = "elevator_travel_deg"
weight = 0.05

[[tuning.case]]
name = "weak elevator"
set = ["plant.preset.numerator[0]=9.0"]

[[tuning.case]]
name = "as it is"
set = []
"#;

struct Tuning {
    _folder: TempDir,
    source: Source,
    problem: TuningProblem,
    state: PathBuf,
}

fn tuning(text: &str) -> Tuning {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("pitch.toml");
    std::fs::write(&path, text).expect("written");
    let source = Source { path, overrides: Vec::new() };
    let problem = TuningProblem::new(&source, None).unwrap_or_else(|error| panic!("{error}"));
    let state = folder.path().join("state.json");
    Tuning { _folder: folder, source, problem, state }
}

fn effort(optimiser: &str) -> Effort {
    let optimiser = optimiser.to_owned();
    Effort { optimiser, budget: 40, seed: 4, population: None, anywhere: false }
}

/// Workers in this process, who get parts of such a size in turn.
struct Parted<'a> {
    workers: [&'a Worker; 2],
    size: usize,
}

impl Parted<'_> {
    fn parts(&self, flights: usize) -> impl Iterator<Item = Range<usize>> {
        let size = self.size;
        (0..flights).step_by(size).map(move |first| first..(first + size).min(flights))
    }
}

impl Engine for Parted<'_> {
    fn fly(&self, order: &Order) -> Result<Vec<String>, TuneError> {
        let workers = self.workers.iter().cycle();
        let parts = self.parts(order.flights()).zip(workers);
        parts.map(|(part, worker)| worker.fly(&order.text(), part)).collect()
    }
}

/// Does something else with what workers answer.
struct Spoilt<'a>(Parted<'a>, fn(&mut Vec<String>));

impl Engine for Spoilt<'_> {
    fn fly(&self, order: &Order) -> Result<Vec<String>, TuneError> {
        let mut answers = self.0.fly(order)?;
        (self.1)(&mut answers);
        Ok(answers)
    }
}

fn trials(tuning: &Tuning, optimiser: &str, crew: Crew<'_>) -> Vec<Trial> {
    let search = Search::begin(&tuning.problem, effort(optimiser), crew);
    let mut search = search.unwrap_or_else(|error| panic!("{error}"));
    while search.advance().unwrap_or_else(|error| panic!("{error}")).is_none() {}
    search.trials().to_vec()
}

#[test]
fn a_search_has_the_same_bits_whoever_flies_and_however_its_flights_are_parted() {
    let tuning = tuning(SCENARIO);
    let here = trials(&tuning, "cma-es", Crew::UNSTOPPED);
    assert!(here.iter().any(|it| it.score.is_allowed()));
    assert!(here.iter().any(|it| !it.score.is_allowed()));
    for size in [1, 3, 7, 1000] {
        let (one, other) = (Worker::new(tuning.source.clone()), Worker::new(tuning.source.clone()));
        let engine = Parted { workers: [&one, &other], size };
        assert_eq!(trials(&tuning, "cma-es", Crew::Others(&engine)), here, "{size}");
    }
}

#[test]
fn a_contest_has_the_same_bytes_whoever_flies() {
    let here = place(&marked());
    here.held();
    let there = place(&marked());
    let (one, other) = (Worker::new(there.source.clone()), Worker::new(there.source.clone()));
    let engine = Parted { workers: [&one, &other], size: 5 };
    let held = there.contest().hold(&there.out(), Crew::Others(&engine), &mut |_| After::GoOn);
    held.expect("an outcome");
    assert!(files(&there.out()) == files(&here.out()));
}

#[test]
fn answers_that_are_not_those_to_the_order_are_refused() {
    let tuning = tuning(SCENARIO);
    let worker = Worker::new(tuning.source.clone());
    let points = [tuning.problem.space().start()];
    let wrong: [fn(&mut Vec<String>); 5] = [
        |answers| answers.swap(0, 1),
        |answers| drop(answers.pop()),
        |answers| answers.push(answers[0].clone()),
        |answers| answers[0].truncate(40),
        |answers| answers[1] = answers[1].replacen("\"of\":\"", "\"of\":\"0", 1),
    ];
    for spoil in wrong {
        let engine = Spoilt(Parted { workers: [&worker, &worker], size: 3 }, spoil);
        let error = tuning.problem.scores_by(&points, Crew::Others(&engine)).expect_err("refused");
        assert!(error.to_string().contains("a worker's answer cannot be used"), "{error}");
    }
}

#[test]
fn a_worker_with_another_scenario_flies_nothing() {
    let (mine, theirs) = (tuning(SCENARIO), tuning(&SCENARIO.replace("kd = 0.1", "kd = 0.2")));
    let worker = Worker::new(theirs.source.clone());
    let engine = Parted { workers: [&worker, &worker], size: 3 };
    let points = [mine.problem.space().start()];
    let error = mine.problem.scores_by(&points, Crew::Others(&engine)).expect_err("refused");
    assert!(error.to_string().contains("another one there"), "{error}");
}

#[test]
fn a_search_that_is_stopped_within_a_generation_goes_on_with_the_same_bits() {
    for optimiser in Effort::optimisers() {
        let tuning = tuning(SCENARIO);
        let whole = trials(&tuning, optimiser, Crew::UNSTOPPED);
        let mut place = Kept::at(Some(tuning.state.clone()), Unfit::Refused);
        let mut stops = 0;
        let all = loop {
            // Some groups later each time, so that generations are cut anywhere.
            let left = AtomicUsize::new(3 + 4 * stops);
            let stopped = || {
                left.try_update(Ordering::Relaxed, Ordering::Relaxed, |it| it.checked_sub(1))
                    .is_err()
            };
            let begun = place.begun(&tuning.problem, &effort(optimiser), Crew::Here(&stopped));
            let (mut search, _) = begun.unwrap_or_else(|error| panic!("{error}"));
            match place.search(&mut search, &mut |_| Then::GoOn) {
                Ok(_) => break search.trials().to_vec(),
                Err(TuneError::Stopped) => stops += 1,
                Err(error) => panic!("{error}"),
            }
        };
        assert!(stops > 1, "{optimiser}");
        assert_eq!(all, whole, "{optimiser}");
    }
}

/// Workers who are there until they are not.
struct Failing<'a>(Parted<'a>, Cell<usize>);

impl Engine for Failing<'_> {
    fn fly(&self, order: &Order) -> Result<Vec<String>, TuneError> {
        if self.1.get() == 0 {
            return Err(TuneError::Engine { reason: "nobody is there".to_owned() });
        }
        self.1.set(self.1.get() - 1);
        self.0.fly(order)
    }
}

#[test]
fn a_search_whose_engine_fails_says_so_and_goes_on_where_it_was() {
    let tuning = tuning(SCENARIO);
    let worker = Worker::new(tuning.source.clone());
    let engine = Failing(Parted { workers: [&worker, &worker], size: 4 }, Cell::new(3));
    let mut place = Kept::at(Some(tuning.state.clone()), Unfit::Refused);
    let begun = place.begun(&tuning.problem, &effort("de"), Crew::Others(&engine));
    let (mut search, _) = begun.expect("three calls are flown");
    let error = place.search(&mut search, &mut |_| Then::GoOn).expect_err("then none");
    assert_eq!(error.to_string(), "nobody is there");
    let begun = place.begun(&tuning.problem, &effort("de"), Crew::UNSTOPPED);
    let (mut search, _) = begun.expect("the state");
    assert!(search.spent() > 0);
    place.search(&mut search, &mut |_| Then::GoOn).expect("the end");
    assert_eq!(search.trials(), trials(&tuning, "de", Crew::UNSTOPPED));
}
