//! A search for parameters of one cost: a global search, then a local one.
//!
//! Costs are evaluated on any number of threads; since an optimiser sees the costs of a generation
//! in the order of its candidates, the result depends on the seed and the budget only.

use crate::{LShade, NelderMead, Optimiser, Space, Start};

/// Effort and seed of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// Seed of every random number of the search.
    pub seed: u64,
    /// Members of the population.
    pub population: usize,
    /// Evaluations of the global search.
    pub global: usize,
    /// Evaluations of the local polish.
    pub polish: usize,
}

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The best point, in the parameters' own units.
    pub point: Vec<f64>,
    /// Its cost.
    pub cost: f64,
    /// Evaluations spent.
    pub evaluations: usize,
}

/// Searches `space` for the least `cost`: L-SHADE, then Nelder and Mead's simplex from the best point.
/// Ends early when a cost of `enough` is reached.
///
/// A cost that is NaN counts as infinite. The point of [`Start::About`] is in the parameters' own units.
pub fn search(
    space: &Space,
    budget: Budget,
    start: Start<'_>,
    enough: f64,
    cost: impl Fn(&[f64]) -> f64 + Sync,
) -> Found {
    let Budget { seed, population, global, .. } = budget;
    let begin = |start: Start<'_>| LShade::new(space.dimension(), population, global, seed, start);
    let mut global = match start {
        Start::About(point, spread) => begin(Start::About(&space.unit(point), spread)),
        Start::Anywhere => begin(Start::Anywhere),
    };
    let spent = run(&mut global, space, budget.global, enough, &cost);
    let (best, best_cost) = global.best();
    let polished = polish(space, (&space.point(best), best_cost), budget.polish, enough, cost);
    Found { evaluations: spent + polished.evaluations, ..polished }
}

/// Rolls a simplex downhill from a point of known cost.
pub fn polish(
    space: &Space,
    from: (&[f64], f64),
    evaluations: usize,
    enough: f64,
    cost: impl Fn(&[f64]) -> f64 + Sync,
) -> Found {
    let mut local = NelderMead::new(&space.unit(from.0), from.1);
    let evaluations = run(&mut local, space, evaluations, enough, &cost);
    let (unit, cost) = local.best();
    Found { point: space.point(unit), cost, evaluations }
}

/// Asks, evaluates and tells until the allowance is spent or the cost is `enough`; evaluations spent.
fn run(
    optimiser: &mut dyn Optimiser,
    space: &Space,
    allowance: usize,
    enough: f64,
    cost: &(impl Fn(&[f64]) -> f64 + Sync),
) -> usize {
    let mut spent = 0;
    while spent < allowance && optimiser.best().1 > enough {
        let candidates = optimiser.ask();
        if candidates.is_empty() {
            break;
        }
        let costs = evaluate(space, &candidates, cost);
        spent += costs.len();
        optimiser.tell(&costs);
    }
    spent
}

/// Costs of candidates, in their order, on as many threads as there are processors.
fn evaluate(
    space: &Space,
    candidates: &[Vec<f64>],
    cost: &(impl Fn(&[f64]) -> f64 + Sync),
) -> Vec<f64> {
    let one = |candidate: &Vec<f64>| {
        let value = cost(&space.point(candidate));
        if value.is_nan() { f64::INFINITY } else { value }
    };
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    if threads == 1 || candidates.len() == 1 {
        return candidates.iter().map(one).collect();
    }
    let share = candidates.len().div_ceil(threads);
    std::thread::scope(|scope| {
        let workers: Vec<_> = candidates
            .chunks(share)
            .map(|chunk| scope.spawn(move || chunk.iter().map(one).collect::<Vec<f64>>()))
            .collect();
        workers
            .into_iter()
            .zip(candidates.chunks(share))
            // A cost that panics is no candidate; the search goes on without it.
            .flat_map(|(worker, chunk)| {
                worker.join().unwrap_or_else(|_| vec![f64::INFINITY; chunk.len()])
            })
            .collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Parameter, Scale};

    fn rosenbrock(point: &[f64]) -> f64 {
        let term = |p: &[f64]| {
            let (bend, rest) = (p[1] - p[0] * p[0], 1.0 - p[0]);
            100.0 * bend * bend + rest * rest
        };
        point.windows(2).map(term).sum()
    }

    fn space() -> Space {
        let parameter = |name| Parameter { name, lower: -5.0, upper: 5.0, scale: Scale::Linear };
        Space::new(vec![parameter("a"), parameter("b"), parameter("c")])
    }

    fn budget(seed: u64) -> Budget {
        Budget { seed, population: 30, global: 6_000, polish: 2_000 }
    }

    #[test]
    fn a_search_finds_the_bottom_of_a_curved_valley() {
        for seed in 0..5 {
            let found = search(&space(), budget(seed), Start::Anywhere, 0.0, rosenbrock);
            assert!(found.cost < 1e-10, "seed {seed}: {found:?}");
            assert!(found.evaluations <= 8_100);
        }
    }

    #[test]
    fn the_same_seed_finds_the_same_bits_and_another_seed_does_not() {
        let bits = |seed| {
            let point = search(&space(), budget(seed), Start::Anywhere, 0.0, rosenbrock).point;
            point.iter().map(|x| x.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(bits(1), bits(1));
        assert_ne!(bits(1), bits(2));
    }

    #[test]
    fn every_candidate_stays_within_its_bounds() {
        let outside = std::sync::atomic::AtomicUsize::new(0);
        let away = |point: &[f64]| {
            let inside = point.iter().all(|x| (-5.0..=5.0).contains(x));
            outside.fetch_add(usize::from(!inside), std::sync::atomic::Ordering::Relaxed);
            point.iter().map(|x| (x - 20.0).abs()).sum()
        };
        let found = search(&space(), budget(3), Start::Anywhere, 0.0, away);
        assert_eq!(outside.into_inner(), 0);
        assert!(found.point.iter().all(|x| (x - 5.0).abs() < 1e-6), "{found:?}");
    }

    #[test]
    fn a_cost_that_is_not_a_number_never_wins() {
        let cost = |point: &[f64]| {
            if point[0] > 0.0 { f64::NAN } else { rosenbrock(point) }
        };
        let found = search(&space(), budget(1), Start::Anywhere, 0.0, cost);
        assert!(found.point[0] <= 0.0 && found.cost.is_finite());
    }
}
