//! The search itself: nominal gains from the CPID's claims, then the supervisor's scales, then all
//! together, tried again with other random numbers until the claims are met or the attempts used up.

use super::problem::{Bench, Cost, FigureProblem, HALF_PERIOD, Weighing, scale_parameters, scales};
use fspid_optimise::{Budget, Found, Space, Start, polish, search};

/// A cost below this is as good as nothing: every number of the fit rounds to the printed digits.
pub(super) const ACCEPTED: f64 = 0.02;
/// Where a search stops.
const ENOUGH: f64 = 1e-9;
/// Pull towards the middle of the box, for parameters that the claims leave free.
const PRIOR: f64 = 1e-3;
/// Spread of the joint search about what the stages found, as a share of the box.
const STAGED_SPREAD: f64 = 0.05;
/// Spread of the first and of the later searches about a point that is given.
const FIRST_SPREAD: f64 = 0.12;
const NEXT_SPREAD: f64 = 0.04;

/// Evaluations of the stages of one attempt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Effort {
    /// Attempts with different random numbers before the best is taken.
    pub(super) attempts: usize,
    pub(super) nominal: usize,
    pub(super) scales: usize,
    pub(super) joint: usize,
    pub(super) polish: usize,
}

impl Effort {
    /// For one figure.
    pub(super) const FIGURE: Self =
        Self { attempts: 6, nominal: 4_000, scales: 6_000, joint: 6_000, polish: 3_000 };
    /// For a figure with long flights.
    pub(super) const LONG_FIGURE: Self =
        Self { attempts: 3, nominal: 4_000, scales: 4_000, joint: 4_000, polish: 1_500 };
    /// For all figures of a range.
    pub(super) const RANGE: Self =
        Self { attempts: 2, nominal: 4_000, scales: 6_000, joint: 12_000, polish: 3_000 };
}

/// What one seed found.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SeedResult {
    pub(super) seed: u64,
    pub(super) attempts: usize,
    pub(super) evaluations: usize,
    pub(super) cost: f64,
    /// Scales, then the parameters of each figure.
    pub(super) point: Vec<f64>,
}

/// Figures that are flown with one supervisor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Set<'a> {
    pub(super) figures: &'a [FigureProblem],
    pub(super) weighing: Weighing,
    /// Gain and gyro gain of the proportional loop.
    pub(super) proportional: [f64; 2],
    pub(super) effort: Effort,
}

impl Set<'_> {
    /// All parameters: scales, then figure by figure.
    pub(super) fn space(&self) -> Space {
        let mut parameters = self.scale_space().parameters().to_vec();
        parameters.extend(self.figures.iter().flat_map(FigureProblem::parameters));
        Space::new(parameters)
    }

    fn scale_space(&self) -> Space {
        Space::new(self.figures.first().map(|f| scale_parameters(f.setting)).unwrap_or_default())
    }

    /// A point of this set from the points of its figures alone: the geometric mean of their scales,
    /// and each figure's own gains.
    pub(super) fn between(&self, points: &[&[f64]]) -> Vec<f64> {
        let scales = self.scale_space().dimension();
        let mean = |index: usize| {
            let logarithms =
                points.iter().filter_map(|point| point.get(index)).map(|x| libm::log(*x));
            libm::exp(logarithms.sum::<f64>() / points.len().max(1) as f64)
        };
        let parts = points.iter().flat_map(|point| point.iter().skip(scales).copied());
        (0..scales).map(mean).chain(parts).collect()
    }

    /// The part of a point that belongs to each figure.
    pub(super) fn parts<'p>(&self, point: &'p [f64]) -> Vec<&'p [f64]> {
        let mut rest = point.get(self.scale_space().dimension()..).unwrap_or_default();
        self.figures
            .iter()
            .map(|figure| {
                let (part, tail) = rest.split_at(figure.parameters().len().min(rest.len()));
                rest = tail;
                part
            })
            .collect()
    }

    fn cost(&self, bench: &Bench, point: &[f64]) -> Cost {
        let scales = scales(point);
        self.figures
            .iter()
            .zip(self.parts(point))
            .map(|(figure, part)| {
                let gyro = Some(self.proportional).filter(|_| figure.gyro);
                let mut model = figure.flight(part, Some(scales), gyro);
                // The proportional loop is settled already.
                model.controllers.retain(|controller| controller.name != "PC");
                bench.cost(figure.id, &model, self.weighing)
            })
            .fold(Cost { required: 0.0, preferred: 0.0 }, |sum, cost| Cost {
                required: sum.required + cost.required,
                preferred: sum.preferred + cost.preferred,
            })
    }

    /// Nominal gains and half period of one figure, from the CPID's claims alone.
    fn nominal(&self, bench: &Bench, figure: &FigureProblem, seed: u64) -> Found {
        let space = Space::new(figure.parameters());
        let budget = Budget { seed, population: 30, global: self.effort.nominal, polish: 0 };
        search(&space, budget, Start::Anywhere, ENOUGH, |point| {
            let gyro = Some(self.proportional).filter(|_| figure.gyro);
            let mut model = figure.flight(point, None, gyro);
            model.controllers.retain(|controller| controller.name != "PC");
            bench.cost(figure.id, &model, self.weighing).total() + prior(&space, point)
        })
    }

    /// Nominal gains, then scales, then all together.
    fn staged(&self, bench: &Bench, seed: u64) -> Found {
        let mut evaluations = 0;
        let mut nominal = Vec::new();
        for (figure, index) in self.figures.iter().zip(0..) {
            let found = self.nominal(bench, figure, seed + index);
            evaluations += found.evaluations;
            nominal.extend(found.point);
        }
        let join = |scales: &[f64]| [scales, &nominal].concat();
        let space = self.scale_space();
        let global = self.effort.scales;
        let budget = Budget { seed: seed + 10, population: 40, global, polish: 0 };
        let found = search(&space, budget, Start::Anywhere, ENOUGH, |point| {
            self.cost(bench, &join(point)).total() + prior(&space, point)
        });
        let joint = self.joint(bench, seed, &join(&found.point), STAGED_SPREAD);
        Found { evaluations: evaluations + found.evaluations + joint.evaluations, ..joint }
    }

    /// All parameters together, from about a point.
    fn joint(&self, bench: &Bench, seed: u64, begin: &[f64], spread: f64) -> Found {
        let space = self.space();
        let global = self.effort.joint;
        let budget = Budget { seed: seed + 20, population: 40, global, polish: 0 };
        let found = search(&space, budget, Start::About(begin, spread), ENOUGH, |point| {
            self.cost(bench, point).total() + prior(&space, point)
        });
        // A half period jumps from sample to sample; a simplex would only stumble over it.
        let held = |point: &[f64]| -> Vec<f64> {
            let names = space.parameters().iter().map(|parameter| parameter.name);
            let pairs = point.iter().zip(&found.point).zip(names);
            pairs.map(|((new, old), name)| if name == HALF_PERIOD { *old } else { *new }).collect()
        };
        let free_cost = self.cost(bench, &found.point).total();
        let from = (&found.point[..], free_cost);
        let polished = polish(&space, from, self.effort.polish, ENOUGH, |point| {
            self.cost(bench, &held(point)).total()
        });
        let evaluations = found.evaluations + polished.evaluations;
        Found { point: held(&polished.point), cost: polished.cost, evaluations }
    }

    /// Searches with one seed: in stages, each attempt in another part of the half period's interval;
    /// or, with a point to begin from, all parameters together about it.
    pub(super) fn solve(&self, bench: &Bench, seed: u64, begin: Option<&[f64]>) -> SeedResult {
        let mut best: Option<Found> = None;
        let mut evaluations = 0;
        let mut attempts = 0;
        while attempts < self.effort.attempts {
            let attempt_seed = 1_000_000 * seed + 1_000 * attempts as u64;
            let found = match begin {
                None => {
                    let part = |figure: &FigureProblem| figure.part(attempts, self.effort.attempts);
                    let figures: Vec<FigureProblem> = self.figures.iter().map(part).collect();
                    Set { figures: &figures, ..*self }.staged(bench, attempt_seed)
                }
                Some(begin) => match &best {
                    None => self.joint(bench, attempt_seed, begin, FIRST_SPREAD),
                    Some(best) => self.joint(bench, attempt_seed, &best.point, NEXT_SPREAD),
                },
            };
            attempts += 1;
            evaluations += found.evaluations;
            if best.as_ref().is_none_or(|best| found.cost < best.cost) {
                best = Some(found);
            }
            if best.as_ref().is_some_and(|best| best.cost <= ACCEPTED) {
                break;
            }
        }
        let (point, cost) =
            best.map_or((Vec::new(), f64::INFINITY), |best| (best.point, best.cost));
        SeedResult { seed, attempts, evaluations, cost, point }
    }
}

fn prior(space: &Space, point: &[f64]) -> f64 {
    PRIOR * space.unit(point).iter().map(|u| (u - 0.5) * (u - 0.5)).sum::<f64>()
}
