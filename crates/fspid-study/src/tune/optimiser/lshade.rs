//! L-SHADE: differential evolution that learns its factors from its successes and shrinks its
//! population as the budget runs out (Tanabe and Fukunaga, IEEE CEC 2014).

use super::Optimiser;
use super::random::Random;

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
#[derive(Clone, Debug)]
pub struct LShade {
    members: Vec<(Vec<f64>, f64)>,
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

#[derive(Clone, Debug)]
struct Trial {
    point: Vec<f64>,
    factor: f64,
    crossover: f64,
}

/// Where a population begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start<'a> {
    /// Anywhere in the cube.
    Anywhere,
    /// At a point, the others normally distributed about it with this standard deviation.
    About(&'a [f64], f64),
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
        let member = |index: usize| {
            let mut random = Random::of(seed, 0, index);
            let point: Vec<f64> = match start {
                Start::Anywhere => (0..dimension).map(|_| random.unit()).collect(),
                Start::About(point, _) if index == 0 => point.to_vec(),
                Start::About(point, spread) => {
                    point.iter().map(|x| (x + spread * random.normal()).clamp(0.0, 1.0)).collect()
                }
            };
            (point, f64::INFINITY)
        };
        Self {
            members: (0..population).map(member).collect(),
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

    /// Indices of the members, best first.
    fn ranking(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.members.len()).collect();
        order.sort_by(|&a, &b| self.members[a].1.total_cmp(&self.members[b].1));
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
        let leader = &self.members[ranking[random.below(leaders.min(ranking.len()))]].0;
        let (other, beaten) = self.two_others(&mut random, index);
        let own = &self.members[index].0;
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
            None => &self.members[second].0,
            Some(beaten) => &self.archive[beaten],
        };
        (&self.members[first].0, second)
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

/// A coordinate that left the cube stops half way from where it was to the side.
fn within(from: f64, to: f64) -> f64 {
    if to < 0.0 {
        0.5 * from
    } else if to > 1.0 {
        0.5 * (1.0 + from)
    } else {
        to
    }
}

impl Optimiser for LShade {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        self.trials = if self.generation == 0 {
            let first = |(point, _): &(Vec<f64>, f64)| {
                let point = point.clone();
                Trial { point, factor: FIRST_FACTOR, crossover: FIRST_CROSSOVER }
            };
            self.members.iter().map(first).collect()
        } else {
            let ranking = self.ranking();
            (0..self.members.len()).map(|index| self.trial(index, &ranking)).collect()
        };
        self.generation += 1;
        self.trials.iter().map(|trial| trial.point.clone()).collect()
    }

    fn tell(&mut self, costs: &[f64]) {
        self.spent += costs.len();
        let mut successes = Vec::new();
        let trials = std::mem::take(&mut self.trials);
        for (member, (trial, &cost)) in self.members.iter_mut().zip(trials.into_iter().zip(costs)) {
            if cost < member.1 && self.generation > 1 {
                successes.push((member.1.min(f64::MAX) - cost, trial.factor, trial.crossover));
                self.archive.push(std::mem::take(&mut member.0));
            }
            if cost <= member.1 {
                *member = (trial.point, cost);
            }
        }
        self.learn(&successes);
        self.shrink();
    }

    fn best(&self) -> (&[f64], f64) {
        let best = self.members.iter().min_by(|a, b| a.1.total_cmp(&b.1));
        best.map_or((&[], f64::INFINITY), |(point, cost)| (point, *cost))
    }
}
