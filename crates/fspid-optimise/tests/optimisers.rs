//! Optimisers against the medians of reference libraries, made by `oracles/make_optimisers.py`, and
//! the promises that all of them make: same bits, resumable, within bounds, no number that is none.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use std::f64::consts::{E, PI, TAU};

use fspid_optimise::{
    CmaEs, Kind, NsgaII, Optimiser, ParetoOptimiser, Plan, Restarts, Snapshot, Start, Stop,
    hypervolume, minimise,
};

const SEEDS: std::ops::RangeInclusive<u64> = 1..=20;
/// Costs below this count as found, as in the COCO platform (Hansen et al., 2021): what a library
/// does there depends on when it stops.
const FOUND: f64 = 1e-8;

/// The optimum does not lie in the middle of the box; the same numbers as in the script.
fn shifted(x: &[f64]) -> impl Iterator<Item = f64> + '_ {
    x.iter().enumerate().map(|(j, x)| x - (1.2 - 0.3 * (j % 5) as f64))
}

fn sphere(x: &[f64]) -> f64 {
    shifted(x).map(|z| z * z).sum()
}

fn rosenbrock(x: &[f64]) -> f64 {
    let term = |p: &[f64]| {
        let (bend, rest) = (p[1] - p[0] * p[0], 1.0 - p[0]);
        100.0 * bend * bend + rest * rest
    };
    x.windows(2).map(term).sum()
}

fn rastrigin(x: &[f64]) -> f64 {
    shifted(x).map(|z| z * z - 10.0 * libm::cos(TAU * z) + 10.0).sum()
}

fn ackley(x: &[f64]) -> f64 {
    let n = x.len() as f64;
    let square = shifted(x).map(|z| z * z).sum::<f64>() / n;
    let wave = shifted(x).map(|z| libm::cos(TAU * z)).sum::<f64>() / n;
    -20.0 * libm::exp(-0.2 * square.sqrt()) - libm::exp(wave) + 20.0 + E
}

fn function(name: &str) -> (fn(&[f64]) -> f64, f64) {
    match name {
        "sphere" => (sphere, 5.12),
        "rosenbrock" => (rosenbrock, 5.12),
        "rastrigin" => (rastrigin, 5.12),
        "ackley" => (ackley, 32.768),
        other => panic!("no function {other}"),
    }
}

/// A row of the file: whose median it is.
struct Row {
    optimiser: String,
    library: String,
    function: String,
    budget: usize,
    median: f64,
}

fn rows() -> Vec<Row> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/optimisers.csv");
    let text = std::fs::read_to_string(path).expect("a reference file");
    let row = |line: &str| {
        let words: Vec<&str> = line.split(',').collect();
        Row {
            optimiser: words[0].into(),
            library: words[1].into(),
            function: words[2].into(),
            budget: words[3].parse().expect("a budget"),
            median: words[6].parse().expect("a median"),
        }
    };
    text.lines().skip(1).map(row).collect()
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    0.5 * (values[values.len() / 2 - 1] + values[values.len() / 2])
}

fn start(kind: Kind, dimension: usize, budget: usize, seed: u64) -> Box<dyn Optimiser> {
    let population = kind.usual_population(dimension);
    kind.start(Plan { dimension, population, budget, seed }, Start::Anywhere)
}

fn reached(kind: Kind, name: &str, budget: usize, seed: u64) -> f64 {
    let (cost, bound) = function(name);
    let mut optimiser = start(kind, 10, budget, seed);
    let evaluate = |candidates: &[Vec<f64>]| {
        let at = |u: &Vec<f64>| u.iter().map(|u| bound * (2.0 * u - 1.0)).collect::<Vec<_>>();
        candidates.iter().map(|candidate| cost(&at(candidate))).collect()
    };
    minimise(&mut *optimiser, budget, 0.1 * FOUND, evaluate);
    assert!(optimiser.spent() <= budget);
    optimiser.best().1
}

/// Compares with every row of this optimiser's name.
fn is_no_worse(kind: Kind, rows_of: &str) {
    let rows: Vec<Row> = rows().into_iter().filter(|row| row.optimiser == rows_of).collect();
    assert!(rows.len() >= 4);
    for name in ["sphere", "rosenbrock", "rastrigin", "ackley"] {
        let these: Vec<&Row> = rows.iter().filter(|row| row.function == name).collect();
        let ours = median(SEEDS.map(|seed| reached(kind, name, these[0].budget, seed)));
        for row in these {
            let what = (kind.name(), name, &row.library);
            assert!(ours.max(FOUND) <= row.median.max(FOUND), "{what:?}: {ours} {}", row.median);
        }
    }
}

#[test]
fn cma_es_is_no_worse_than_the_library_of_its_author() {
    is_no_worse(Kind::CmaEs, "cma-es");
}

#[test]
fn differential_evolution_is_no_worse_than_three_of_two_libraries() {
    is_no_worse(Kind::De, "de");
}

#[test]
fn l_shade_is_no_worse_than_differential_evolution_of_two_libraries() {
    is_no_worse(Kind::LShade, "de");
}

#[test]
fn the_swarm_is_no_worse_than_those_of_two_libraries() {
    is_no_worse(Kind::Pso, "pso");
}

#[test]
fn the_genetic_algorithm_is_no_worse_than_a_library() {
    is_no_worse(Kind::Ga, "ga");
}

#[test]
fn the_simplex_that_begins_anew_is_no_worse_than_a_library() {
    is_no_worse(Kind::NelderMead, "nelder-mead");
}

/// ZDT1 to ZDT3 of Zitzler, Deb and Thiele (Evolutionary Computation 8, 2000).
fn zdt(name: &str, x: &[f64]) -> Vec<f64> {
    let first = x[0];
    let g = 1.0 + 9.0 * x[1..].iter().sum::<f64>() / (x.len() - 1) as f64;
    let ratio = first / g;
    let shape = match name {
        "zdt1" => 1.0 - ratio.sqrt(),
        "zdt2" => 1.0 - ratio * ratio,
        _ => 1.0 - ratio.sqrt() - ratio * libm::sin(10.0 * PI * first),
    };
    vec![first, g * shape]
}

fn volume(name: &str, budget: usize, seed: u64) -> f64 {
    let plan = Plan { dimension: 30, population: 100, budget, seed };
    let mut optimiser = NsgaII::new(plan, 2, Start::Anywhere);
    loop {
        let candidates = optimiser.ask();
        if candidates.is_empty() {
            break;
        }
        assert!(candidates.iter().flatten().all(|x| (0.0..=1.0).contains(x)));
        optimiser.tell(&candidates.iter().map(|x| zdt(name, x)).collect::<Vec<_>>());
    }
    assert_eq!((optimiser.spent(), optimiser.stop()), (budget, Some(Stop::Budget)));
    let front: Vec<&[f64]> = optimiser.front().iter().map(|m| m.objectives.as_slice()).collect();
    hypervolume(&front, &[1.1, 1.1])
}

#[test]
fn nsga_ii_dominates_no_less_than_that_of_a_library() {
    for row in rows().iter().filter(|row| row.optimiser == NsgaII::NAME) {
        let ours = median(SEEDS.map(|seed| volume(&row.function, row.budget, seed)));
        assert!(ours >= row.median, "{}: {ours} {}", row.function, row.median);
    }
}

/// A curved valley with a corner where there is no number and one where it is infinite.
fn holed(x: &[f64]) -> f64 {
    if x[0] + x[1] > 1.8 {
        f64::NAN
    } else if x[0] + x[1] < 0.1 {
        f64::INFINITY
    } else {
        rosenbrock(&x.iter().map(|x| 4.0 * x - 2.0).collect::<Vec<_>>())
    }
}

fn holed_costs(candidates: &[Vec<f64>]) -> Vec<f64> {
    candidates.iter().map(|candidate| holed(candidate)).collect()
}

fn bits(points: &[Vec<f64>]) -> Vec<u64> {
    points.iter().flatten().map(|x| x.to_bits()).collect()
}

/// Bits of every candidate until the optimiser stops.
fn path(mut optimiser: Box<dyn Optimiser>) -> Vec<u64> {
    let mut path = Vec::new();
    loop {
        let candidates = optimiser.ask();
        if candidates.is_empty() {
            return path;
        }
        path.extend(bits(&candidates));
        optimiser.tell(&holed_costs(&candidates));
    }
}

#[test]
fn the_same_seed_walks_the_same_bits_and_another_seed_does_not() {
    for (kind, name) in Kind::NAMES {
        assert_eq!(path(start(kind, 3, 600, 7)), path(start(kind, 3, 600, 7)), "{name}");
        assert_ne!(path(start(kind, 3, 600, 7)), path(start(kind, 3, 600, 8)), "{name}");
    }
}

fn resumed(optimiser: &dyn Optimiser) -> Box<dyn Optimiser> {
    let text = serde_json::to_string(&optimiser.snapshot()).expect("plain data");
    serde_json::from_str::<Snapshot>(&text).expect("what was written").resume().expect("sound")
}

#[test]
fn a_search_written_and_read_at_any_moment_goes_on_with_the_same_bits() {
    for (kind, name) in Kind::NAMES {
        let (mut whole, mut parted) = (start(kind, 3, 900, 5), start(kind, 3, 900, 5));
        loop {
            let candidates = whole.ask();
            parted.ask();
            // Between question and answer it asks the same again.
            parted = resumed(&*parted);
            assert_eq!(bits(&candidates), bits(&parted.ask()), "{name}");
            if candidates.is_empty() {
                break;
            }
            whole.tell(&holed_costs(&candidates));
            parted.tell(&holed_costs(&candidates));
            parted = resumed(&*parted);
            assert_eq!(whole.best(), parted.best(), "{name}");
            let (one, other) = (whole.snapshot(), parted.snapshot());
            assert_eq!(format!("{one:?}"), format!("{other:?}"), "{name}");
        }
        assert_eq!((whole.stop(), whole.spent()), (parted.stop(), parted.spent()));
    }
}

#[test]
fn several_objectives_are_resumed_with_the_same_bits_too() {
    let plan = Plan { dimension: 5, population: 21, budget: 400, seed: 3 };
    let mut whole = NsgaII::new(plan, 2, Start::Anywhere);
    let mut parted = whole.clone();
    loop {
        let candidates = whole.ask();
        let text = serde_json::to_string(&parted).expect("plain data");
        let read: NsgaII = serde_json::from_str(&text).expect("what was written");
        parted = read.resumed().expect("sound");
        assert_eq!(bits(&candidates), bits(&parted.ask()));
        if candidates.is_empty() {
            break;
        }
        // One that cannot be evaluated: infinite in every objective.
        let mut told: Vec<Vec<f64>> = candidates.iter().map(|x| zdt("zdt1", x)).collect();
        told[0] = vec![f64::NAN, f64::NAN];
        whole.tell(&told);
        parted.tell(&told);
    }
    assert!(whole.front().iter().all(|member| member.objectives.iter().all(|x| x.is_finite())));
}

#[test]
fn a_state_whose_numbers_do_not_fit_together_is_refused_by_name() {
    for (kind, name) in Kind::NAMES {
        let mut optimiser = start(kind, 3, 900, 5);
        for _ in 0..6 {
            let candidates = optimiser.ask();
            optimiser.tell(&holed_costs(&candidates));
        }
        optimiser.ask();
        let mut state = serde_json::to_value(optimiser.snapshot()).expect("plain data");
        assert!(shorten_a_point(&mut state), "{name}");
        let snapshot: Snapshot = serde_json::from_value(state).expect("numbers");
        let refused = snapshot.resume().map(|_| ()).expect_err("unsound");
        assert_eq!(refused.optimiser, name);
    }
}

/// Takes a coordinate from the first point found.
fn shorten_a_point(value: &mut serde_json::Value) -> bool {
    match value {
        serde_json::Value::Object(fields) => fields.iter_mut().any(|(name, value)| match value {
            serde_json::Value::Array(point) if name == "point" => point.pop().is_some(),
            other => shorten_a_point(other),
        }),
        serde_json::Value::Array(all) => all.iter_mut().any(shorten_a_point),
        _ => false,
    }
}

#[test]
fn an_optimum_outside_the_cube_is_sought_at_its_side() {
    let away = |x: &[f64]| x.iter().map(|x| (x - 1.5) * (x - 1.5)).sum::<f64>();
    for (kind, name) in Kind::NAMES {
        let mut optimiser = start(kind, 4, 4000, 2);
        minimise(&mut *optimiser, 4000, 0.0, |candidates| {
            assert!(candidates.iter().flatten().all(|x| (0.0..=1.0).contains(x)), "{name}");
            candidates.iter().map(|x| away(x)).collect()
        });
        // At the corner the cost is exactly 4 · 0.25; a coordinate 1e-3 away costs 1e-3 more.
        assert!(optimiser.best().1 < 1.001, "{name}: {:?}", optimiser.best());
    }
}

#[test]
fn a_cost_that_is_not_a_number_never_wins() {
    for (kind, name) in Kind::NAMES {
        let mut optimiser = start(kind, 3, 600, 4);
        minimise(&mut *optimiser, 600, 0.0, holed_costs);
        let (point, cost) = optimiser.best();
        assert!(cost.is_finite() && holed(point) == cost, "{name}");
        let mut lost = start(kind, 3, 300, 4);
        minimise(&mut *lost, 300, 0.0, |candidates| vec![f64::NAN; candidates.len()]);
        assert_eq!(lost.best().1, f64::INFINITY, "{name}");
    }
}

#[test]
fn a_budget_is_kept_to_the_evaluation_and_a_target_ends_the_search() {
    for (kind, name) in Kind::NAMES {
        let mut optimiser = start(kind, 3, 333, 4);
        assert_eq!(minimise(&mut *optimiser, 333, -1.0, holed_costs), Stop::Budget, "{name}");
        assert_eq!((optimiser.spent(), optimiser.ask().len()), (333, 0), "{name}");
        let mut easy = start(kind, 3, 333, 4);
        assert_eq!(minimise(&mut *easy, 333, 1e3, holed_costs), Stop::Target, "{name}");
        let mut none = start(kind, 3, 0, 4);
        assert_eq!(minimise(&mut *none, 0, 0.0, holed_costs), Stop::Budget, "{name}");
    }
}

#[test]
fn what_has_no_slope_ends_without_progress_and_what_has_one_bottom_collapses() {
    let plan = Plan { dimension: 3, population: 12, budget: 20_000, seed: 1 };
    let flat = |candidates: &[Vec<f64>]| vec![1.0; candidates.len()];
    let bowl = |candidates: &[Vec<f64>]| {
        let cost = |x: &Vec<f64>| x.iter().map(|x| (x - 0.3).abs()).sum::<f64>();
        candidates.iter().map(cost).collect::<Vec<f64>>()
    };
    for kind in [Kind::De, Kind::Pso, Kind::Ga] {
        let mut optimiser = kind.start(plan, Start::Anywhere);
        assert_eq!(minimise(&mut *optimiser, 20_000, 0.0, flat), Stop::NoProgress);
    }
    let mut evolution = Kind::De.start(plan, Start::Anywhere);
    assert_eq!(minimise(&mut *evolution, 20_000, -1.0, bowl), Stop::Collapsed);
    let mut once = CmaEs::new(plan, Restarts::Never, Start::Anywhere);
    assert_eq!(minimise(&mut once, 20_000, 0.0, flat), Stop::NoProgress);
    let mut once = CmaEs::new(plan, Restarts::Never, Start::Anywhere);
    let stopped = minimise(&mut once, 20_000, -1.0, bowl);
    assert!(stopped != Stop::Budget && once.best().1 < 1e-10, "{stopped:?}");
}

#[test]
fn a_design_to_begin_from_is_evaluated_first_and_never_lost() {
    let design = [0.6, 0.7, 0.8];
    for (kind, name) in Kind::NAMES {
        let population = kind.usual_population(3);
        let plan = Plan { dimension: 3, population, budget: 200, seed: 6 };
        let mut optimiser = kind.start(plan, Start::About(&design, 0.05));
        assert_eq!(optimiser.ask()[0], design, "{name}");
        minimise(&mut *optimiser, 200, 0.0, holed_costs);
        assert!(optimiser.best().1 <= holed(&design), "{name}");
    }
}

#[test]
fn senseless_starts_and_sizes_are_put_right() {
    let starts: [(&[f64], f64); 4] =
        [(&[], 0.1), (&[f64::NAN; 3], f64::NAN), (&[9.0; 5], -1.0), (&[-1.0; 3], f64::INFINITY)];
    for (kind, name) in Kind::NAMES {
        for (dimension, population) in [(3, 0), (1, 1), (0, 5)] {
            for (point, spread) in starts {
                let plan = Plan { dimension, population, budget: 90, seed: 1 };
                let mut optimiser = kind.start(plan, Start::About(point, spread));
                minimise(&mut *optimiser, 90, -1.0, |candidates| {
                    assert!(candidates.iter().flatten().all(|x| (0.0..=1.0).contains(x)), "{name}");
                    candidates.iter().map(|x| x.iter().sum()).collect()
                });
            }
        }
    }
}

#[test]
fn small_runs_between_the_growing_ones_find_the_deep_holes_as_well() {
    let plan = Plan { dimension: 2, population: 6, budget: 20_000, seed: 9 };
    let cost = |u: &Vec<f64>| rastrigin(&u.iter().map(|u| 10.24 * u - 5.12).collect::<Vec<_>>());
    for restarts in [Restarts::Growing, Restarts::GrowingAndSmall] {
        let mut optimiser = CmaEs::new(plan, restarts, Start::Anywhere);
        let stop = minimise(&mut optimiser, 20_000, FOUND, |c| c.iter().map(cost).collect());
        assert_eq!(stop, Stop::Target, "{restarts:?}");
    }
}

#[test]
fn every_kind_is_found_by_its_name() {
    for (kind, name) in Kind::NAMES {
        assert_eq!((Kind::from_name(name), kind.name()), (Some(kind), name));
    }
    assert_eq!(Kind::from_name("annealing"), None);
}
