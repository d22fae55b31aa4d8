//! L-SHADE: differential evolution that learns its factors from its successes and shrinks its
//! population as the budget runs out (Tanabe and Fukunaga, IEEE CEC 2014).

use serde::{Deserialize, Serialize};

use super::kind::Snapshot;
use super::member::{Member, first_points, in_cube, least, sane, within};
use super::random::Random;
use super::{Optimiser, Start, Stop};

/// Remembered means of successful factors.
const MEMORY: usize = 6;
/// Share of the population among which a leader is drawn.
const LEADERS: f64 = 0.11;
/// Size of the archive of beaten members, in populations.
const ARCHIVE: f64 = 2.6;
/// Smallest population.
const SMALLEST: usize = 4;
/// First guess of both factors, and their spread about the remembered means.
const FIRST_FACTOR: f64 = 0.5;
const FIRST_CROSSOVER: f64 = 0.8;
const SPREAD: f64 = 0.1;

/// A population that moves by differences of its own members.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct LShade {
    members: Vec<Member>,
    archive: Vec<Vec<f64>>,
    trials: Vec<Trial>,
    memory: [(f64, f64); MEMORY],
    oldest: usize,
    seed: u64,
    generation: u64,
    first_population: usize,
    budget: usize,
    spent: usize,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Trial {
    point: Vec<f64>,
    factor: f64,
    crossover: f64,
}

impl LShade {
    /// A population over `dimension` coordinates that will be given `budget` evaluations.
    #[must_use]
    pub fn new(
        dimension: usize,
        population: usize,
        budget: usize,
        seed: u64,
        start: Start<'_>,
    ) -> Self {
        let population = population.max(SMALLEST);
        let points = first_points(population, dimension, seed, start);
        Self {
            members: points.into_iter().map(Member::unknown).collect(),
            archive: Vec::new(),
            trials: Vec::new(),
            memory: [(FIRST_FACTOR, FIRST_CROSSOVER); MEMORY],
            oldest: 0,
            seed,
            generation: 0,
            first_population: population,
            budget: budget.max(1),
            spent: 0,
        }
    }

    pub(super) fn is_sound(&self) -> bool {
        let n = self.members.first().map_or(0, |member| member.point.len());
        let factors = |trial: &Trial| trial.factor.is_finite() && trial.crossover.is_finite();
        let remembered = |(factor, crossover): &(f64, f64)| *factor > 0.0 && crossover.is_finite();
        self.members.len() >= SMALLEST
            && self.first_population >= self.members.len()
            && self.budget > 0
            && self.oldest < MEMORY
            && self.members.iter().all(|member| member.is_sound(n))
            && self.archive.iter().all(|point| in_cube(point, n))
            && self.trials.iter().all(|trial| in_cube(&trial.point, n) && factors(trial))
            && self.memory.iter().all(remembered)
    }

    /// Indices of the members, best first.
    fn ranking(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.members.len()).collect();
        order.sort_by(|&a, &b| self.members[a].cost.total_cmp(&self.members[b].cost));
        order
    }

    fn trial(&self, index: usize, ranking: &[usize]) -> Trial {
        let mut random = Random::of(self.seed, self.generation, index);
        let (mean_factor, mean_crossover) = self.memory[random.below(MEMORY)];
        let crossover = (mean_crossover + SPREAD * random.normal()).clamp(0.0, 1.0);
        let factor = loop {
            let factor = mean_factor + SPREAD * random.cauchy();
            if factor > 0.0 {
                break factor.min(1.0);
            }
        };
        let leaders = ((LEADERS * self.members.len() as f64).round() as usize).max(2);
        let leader = &self.members[ranking[random.below(leaders.min(ranking.len()))]].point;
        let (other, beaten) = self.two_others(&mut random, index);
        let own = &self.members[index].point;
        let always = random.below(own.len());
        let point = (0..own.len())
            .map(|j| {
                if random.unit() >= crossover && j != always {
                    return own[j];
                }
                let step = factor * (leader[j] - own[j]) + factor * (other[j] - beaten[j]);
                within(own[j], own[j] + step)
            })
            .collect();
        Trial { point, factor, crossover }
    }

    /// Another member, and one more member or a beaten one.
    fn two_others(&self, random: &mut Random, index: usize) -> (&[f64], &[f64]) {
        let count = self.members.len();
        let mut first = random.below(count);
        while first == index {
            first = (first + 1) % count;
        }
        let mut second = random.below(count + self.archive.len());
        while second == index || second == first {
            second = (second + 1) % (count + self.archive.len());
        }
        let second = match second.checked_sub(count) {
            None => &self.members[second].point,
            Some(beaten) => &self.archive[beaten],
        };
        (&self.members[first].point, second)
    }

    /// Moves the means towards what succeeded, weighted by how much it gained.
    fn learn(&mut self, successes: &[(f64, f64, f64)]) {
        let sum = |value: fn(&(f64, f64, f64)) -> f64| successes.iter().map(value).sum::<f64>();
        let gain = sum(|s| s.0);
        if !(gain > 0.0 && gain.is_finite()) {
            return;
        }
        let factor = sum(|s| s.0 * s.1 * s.1) / sum(|s| s.0 * s.1);
        let crossover = sum(|s| s.0 * s.2) / gain;
        self.memory[self.oldest] = (factor, crossover);
        self.oldest = (self.oldest + 1) % MEMORY;
    }

    fn shrink(&mut self) {
        let share = (self.spent as f64 / self.budget as f64).min(1.0);
        let span = (self.first_population - SMALLEST) as f64;
        let wanted = self.first_population - (span * share).round() as usize;
        while self.members.len() > wanted.max(SMALLEST) {
            if let Some(&worst) = self.ranking().last() {
                self.members.remove(worst);
            }
        }
        let room = (ARCHIVE * self.members.len() as f64) as usize;
        let mut random = Random::of(self.seed, self.generation, usize::from(u16::MAX));
        while self.archive.len() > room {
            let dropped = random.below(self.archive.len());
            self.archive.swap_remove(dropped);
        }
    }
}

impl Optimiser for LShade {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        if self.stop().is_some() {
            return Vec::new();
        }
        if self.trials.is_empty() {
            self.trials = if self.generation == 0 {
                let first = |member: &Member| {
                    let point = member.point.clone();
                    Trial { point, factor: FIRST_FACTOR, crossover: FIRST_CROSSOVER }
                };
                self.members.iter().map(first).collect()
            } else {
                let ranking = self.ranking();
                (0..self.members.len()).map(|index| self.trial(index, &ranking)).collect()
            };
            self.generation += 1;
        }
        self.trials.iter().map(|trial| trial.point.clone()).collect()
    }

    fn tell(&mut self, costs: &[f64]) {
        let trials = std::mem::take(&mut self.trials);
        self.spent += costs.len().min(trials.len());
        let costs = sane(costs, trials.len());
        let mut successes = Vec::new();
        for (member, (trial, cost)) in self.members.iter_mut().zip(trials.into_iter().zip(costs)) {
            if cost < member.cost && self.generation > 1 {
                successes.push((member.cost.min(f64::MAX) - cost, trial.factor, trial.crossover));
                self.archive.push(std::mem::take(&mut member.point));
            }
            if cost <= member.cost {
                *member = Member { point: trial.point, cost };
            }
        }
        self.learn(&successes);
        self.shrink();
    }

    fn best(&self) -> (&[f64], f64) {
        self.members.get(least(&self.members)).map_or((&[], f64::INFINITY), Member::borrowed)
    }

    fn spent(&self) -> usize {
        self.spent
    }

    fn stop(&self) -> Option<Stop> {
        (self.spent >= self.budget).then_some(Stop::Budget)
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot::LShade(self.clone())
    }
}
