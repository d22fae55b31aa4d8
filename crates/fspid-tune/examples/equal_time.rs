//! Searches by slopes and without, for the same time of one processor, on three problems:
//!
//! ```sh
//! cargo run --release -p fspid-tune --example equal_time -- 60 5
//! ```
//!
//! The first number is the time of each search, s, the second how many seeds there are. Time is that of the process, so
//! that other programs do not show; where the system does not tell it, it is that of the clock. The table has the median
//! over the seeds of the least allowed cost after a quarter, half and all of the time.

#![allow(
    clippy::print_stdout,
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "a table for people, of what searches find in a time"
)]

use std::path::{Path, PathBuf};
use std::time::Instant;

use fspid_tune::{Crew, Effort, Search, Source, TuningProblem};

const OPTIMISERS: [&str; 3] = ["cma-es", "bfgs", "sqp"];
/// Shares of the time at which costs are told.
const SHARES: [f64; 3] = [0.25, 0.5, 1.0];

struct Problem {
    name: &'static str,
    scenario: &'static str,
    controller: &'static str,
    overrides: Vec<String>,
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let mut number = |otherwise: f64| {
        arguments
            .next()
            .and_then(|it| it.parse::<f64>().ok())
            .filter(|it| *it > 0.0)
            .unwrap_or(otherwise)
    };
    let (time_s, seeds) = (number(60.0), number(5.0));
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    let seeds = seeds as u64;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for problem in problems() {
        let path = root().join(problem.scenario);
        let source = Source { path, overrides: problem.overrides.clone() };
        let tuning = TuningProblem::new(&source, Some(problem.controller))
            .unwrap_or_else(|it| panic!("{it}"));
        let (free, flights) = (tuning.space().dimension(), tuning.flights());
        println!("\n{}: {free} free numbers, {flights} flights of a candidate", problem.name);
        let mut last = Vec::new();
        for optimiser in OPTIMISERS {
            let runs: Vec<Run> = (1..=seeds)
                .map(|seed| pool.install(|| searched(&tuning, optimiser, seed, time_s)))
                .collect();
            report(optimiser, &runs, time_s);
            last.push(runs);
        }
        for (one, other) in [(0, 1), (0, 2), (1, 2)] {
            let pairs = last[one].iter().zip(&last[other]);
            let won = pairs.filter(|(one, other)| other.costs[2] < one.costs[2]).count();
            let (one, other) = (OPTIMISERS[one], OPTIMISERS[other]);
            println!("{other} beats {one} with {won} of {seeds} seeds");
        }
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn problems() -> Vec<Problem> {
    let row = format!("[{}]", ["0.0"; 7].join(","));
    let zeros = format!("[{}]", vec![row; 7].join(","));
    let conclusions = ["kp", "ki", "kd"].map(|gain| {
        format!(
            "controller.\"FSPID, learned\".supervisor.numbers.delta_{gain}={{tune=\"numbers\",reach=1.0,symmetric=true,start={zeros}}}"
        )
    });
    vec![
        Problem {
            name: "PID of the gallery",
            scenario: "scenarios/gallery/tune-navion.toml",
            controller: "PID",
            overrides: Vec::new(),
        },
        Problem {
            name: "self-tuner of the light contest, its settings free",
            scenario: "scenarios/contest/light.toml",
            controller: "FSPID, learned",
            overrides: Vec::new(),
        },
        Problem {
            name: "the same, and every conclusion of its rules free, from 0",
            scenario: "scenarios/contest/light.toml",
            controller: "FSPID, learned",
            overrides: conclusions.to_vec(),
        },
    ]
}

/// What a search has found, and what it has done.
struct Run {
    costs: [f64; 3],
    candidates: usize,
    slopes: usize,
    analyses: usize,
    descents: usize,
}

fn searched(problem: &TuningProblem, optimiser: &str, seed: u64, time_s: f64) -> Run {
    let effort = Effort {
        optimiser: optimiser.to_owned(),
        budget: 10_000_000,
        seed,
        population: None,
        anywhere: false,
    };
    let watch = Watch::start();
    let mut search =
        Search::begin(problem, effort, Crew::UNSTOPPED).unwrap_or_else(|it| panic!("{it}"));
    let mut costs = [f64::NAN; 3];
    loop {
        let now_s = watch.elapsed_s();
        let best = search.best().score.clone();
        for (cost, share) in costs.iter_mut().zip(SHARES) {
            if cost.is_nan() && now_s >= share * time_s {
                *cost = if best.is_allowed() { best.cost } else { f64::INFINITY };
            }
        }
        if now_s >= time_s || search.advance().unwrap_or_else(|it| panic!("{it}")).is_some() {
            break;
        }
    }
    // One that has ended before has what it has.
    let end = search.best().score.cost;
    costs.iter_mut().filter(|cost| cost.is_nan()).for_each(|cost| *cost = end);
    let counted = search.counted().unwrap_or_default();
    Run {
        costs,
        candidates: search.trials().len(),
        slopes: counted.slopes,
        analyses: counted.analyses,
        descents: counted.descents,
    }
}

fn report(optimiser: &str, runs: &[Run], time_s: f64) {
    let median = |of: &dyn Fn(&Run) -> f64| {
        let mut all: Vec<f64> = runs.iter().map(of).collect();
        all.sort_by(f64::total_cmp);
        all[all.len() / 2]
    };
    let mut line = format!("{optimiser:>8}:");
    for (index, share) in SHARES.iter().enumerate() {
        line.push_str(&format!(
            " {:.5} after {:.0} s,",
            median(&|run| run.costs[index]),
            share * time_s
        ));
    }
    let least = runs.iter().map(|run| run.costs[2]).fold(f64::INFINITY, f64::min);
    let most = runs.iter().map(|run| run.costs[2]).fold(0.0, f64::max);
    line.push_str(&format!(" from {least:.5} to {most:.5};"));
    line.push_str(&format!(" {:.0} candidates", median(&|run| run.candidates as f64)));
    let slopes = median(&|run| run.slopes as f64);
    if slopes > 0.0 {
        let (analyses, descents) =
            (median(&|run| run.analyses as f64), median(&|run| run.descents as f64));
        line.push_str(&format!(
            ", {slopes:.0} slopes, {analyses:.0} loops, {descents:.0} descents"
        ));
    }
    println!("{line}");
}

/// Time of this process.
struct Watch {
    begun: Instant,
    processor_s: Option<f64>,
}

impl Watch {
    fn start() -> Self {
        Self { begun: Instant::now(), processor_s: processor_s() }
    }

    fn elapsed_s(&self) -> f64 {
        let of_process = processor_s().zip(self.processor_s).map(|(now, then)| now - then);
        of_process.unwrap_or_else(|| self.begun.elapsed().as_secs_f64())
    }
}

/// Time that the processor has spent for this process, s: fields 14 and 15 of Linux's `/proc/self/stat`, in hundredths.
fn processor_s() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = text.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |field: usize| fields.get(field - 3)?.parse::<f64>().ok();
    Some((ticks(14)? + ticks(15)?) / 100.0)
}
