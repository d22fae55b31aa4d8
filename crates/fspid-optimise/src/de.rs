//! Differential evolution as published, DE/rand/1/bin (Storn and Price, Journal of Global
//! Optimization 11, 1997); its grown-up form is L-SHADE.

use serde::{Deserialize, Serialize};

use super::kind::{Plan, Snapshot};
use super::member::{Member, first_points, in_cube, least, sane, within};
use super::progress::Progress;
use super::random::Random;
use super::{Optimiser, Start, Stop};

/// Weight of the difference; Storn and Price advise 0.5 to 1.
const FACTOR: f64 = 0.6;
/// Probabilities of crossover, drawn anew for each trial: low where coordinates can be sought one by
/// one, high where they hang together, both from their section 4.
const CROSSOVERS: [f64; 2] = [0.1, 0.9];

/// A population that moves by differences of its own members.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct DifferentialEvolution {
    plan: Plan,
    members: Vec<Member>,
    trials: Vec<Vec<f64>>,
    generation: u64,
    spent: usize,
    progress: Progress,
}

impl DifferentialEvolution {
    /// A population of at least four.
    #[must_use]
    pub fn new(plan: Plan, start: Start<'_>) -> Self {
        let plan = Plan { population: plan.population.max(4), ..plan };
        let points = first_points(plan.population, plan.dimension, plan.seed, start);
        Self {
            plan,
            members: points.into_iter().map(Member::unknown).collect(),
            trials: Vec::new(),
            generation: 0,
            spent: 0,
            progress: Progress::default(),
        }
    }

    pub(super) fn is_sound(&self) -> bool {
        let n = self.plan.dimension;
        self.members.len() == self.plan.population
            && self.members.len() >= 4
            && self.members.iter().all(|member| member.is_sound(n))
            && self.trials.iter().all(|trial| in_cube(trial, n))
            && self.trials.len() <= self.members.len()
    }

    /// $$ v = x_a + F (x_b - x_c) $$, crossed with the member itself.
    fn trial(&self, index: usize) -> Vec<f64> {
        let mut random = Random::of(self.plan.seed, self.generation, index);
        let [a, b, c] =
            others(&mut random, self.members.len(), index).map(|i| &self.members[i].point);
        let own = &self.members[index].point;
        let crossover = CROSSOVERS[random.below(CROSSOVERS.len())];
        let always = random.below(own.len());
        (0..own.len())
            .map(|j| {
                if random.unit() < crossover || j == always {
                    within(own[j], a[j] + FACTOR * (b[j] - c[j]))
                } else {
                    own[j]
                }
            })
            .collect()
    }
}

/// Three different members, none of them `own`.
fn others(random: &mut Random, count: usize, own: usize) -> [usize; 3] {
    let mut taken = [own; 4];
    for place in 1..4 {
        let mut other = random.below(count);
        while taken[..place].contains(&other) {
            other = (other + 1) % count;
        }
        taken[place] = other;
    }
    [taken[1], taken[2], taken[3]]
}

impl Optimiser for DifferentialEvolution {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        if self.stop().is_some() {
            return Vec::new();
        }
        if self.trials.is_empty() {
            self.trials = if self.generation == 0 {
                self.members.iter().map(|member| member.point.clone()).collect()
            } else {
                (0..self.members.len()).map(|index| self.trial(index)).collect()
            };
            self.generation += 1;
        }
        self.trials.clone()
    }

    fn tell(&mut self, costs: &[f64]) {
        let trials = std::mem::take(&mut self.trials);
        self.spent += costs.len().min(trials.len());
        let costs = sane(costs, trials.len());
        for (member, (point, cost)) in self.members.iter_mut().zip(trials.into_iter().zip(costs)) {
            if cost <= member.cost {
                *member = Member { point, cost };
            }
        }
        self.progress.note(&self.members);
    }

    fn best(&self) -> (&[f64], f64) {
        self.members.get(least(&self.members)).map_or((&[], f64::INFINITY), Member::borrowed)
    }

    fn spent(&self) -> usize {
        self.spent
    }

    fn stop(&self) -> Option<Stop> {
        self.plan.over(self.spent).or(self.progress.stop())
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot::De(self.clone())
    }
}
