//! Differential evolution (Storn and Price, J. Global Optimization 11, 1997).

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::{Optimiser, reflected};

/// Share of the steps that start from the member itself and lean towards the best; the others
/// start from a random member. A mix keeps both speed and spread.
const TOWARDS_BEST: f64 = 0.3;
/// Probability that a coordinate is taken from the mutant.
const CROSSOVER: f64 = 0.9;
/// The factor of the difference is drawn anew for each member ("dither") from this interval.
const FACTOR: (f64, f64) = (0.4, 0.9);

/// A population that moves by differences of its own members.
#[derive(Clone, Debug)]
pub struct DifferentialEvolution {
    members: Vec<Vec<f64>>,
    costs: Vec<f64>,
    trials: Vec<Vec<f64>>,
    seed: u64,
    generation: u64,
}

impl DifferentialEvolution {
    /// `population` members (at least 5), spread at random over `dimension` coordinates.
    #[must_use]
    pub fn new(dimension: usize, population: usize, seed: u64) -> Self {
        let members: Vec<Vec<f64>> = (0..population.max(5))
            .map(|member| {
                let mut random = Random::of(seed, 0, member);
                (0..dimension).map(|_| random.unit()).collect()
            })
            .collect();
        let costs = vec![f64::INFINITY; members.len()];
        Self {
            members,
            costs,
            trials: Vec::new(),
            seed,
            generation: 0,
        }
    }

    fn best_index(&self) -> usize {
        let mut best = 0;
        for (index, cost) in self.costs.iter().enumerate() {
            if *cost < self.costs[best] {
                best = index;
            }
        }
        best
    }

    fn trial(&self, target: usize, best: usize) -> Vec<f64> {
        let mut random = Random::of(self.seed, self.generation, target);
        let [a, b, c] = random.distinct(self.members.len(), target);
        let (base, a, b, c) = (
            &self.members[target],
            &self.members[a],
            &self.members[b],
            &self.members[c],
        );
        let factor = FACTOR.0 + random.unit() * (FACTOR.1 - FACTOR.0);
        let towards_best = random.unit() < TOWARDS_BEST;
        let always = random.below(base.len());
        (0..base.len())
            .map(|j| {
                let mutant = if towards_best {
                    base[j] + factor * (self.members[best][j] - base[j]) + factor * (b[j] - c[j])
                } else {
                    a[j] + factor * (b[j] - c[j])
                };
                let taken = random.unit() < CROSSOVER || j == always;
                if taken { reflected(mutant) } else { base[j] }
            })
            .collect()
    }
}

impl Optimiser for DifferentialEvolution {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        self.trials = if self.generation == 0 {
            self.members.clone()
        } else {
            let best = self.best_index();
            (0..self.members.len())
                .map(|target| self.trial(target, best))
                .collect()
        };
        self.generation += 1;
        self.trials.clone()
    }

    fn tell(&mut self, costs: &[f64]) {
        let rivals = self.members.iter_mut().zip(&mut self.costs);
        for ((member, kept), (trial, &cost)) in rivals.zip(self.trials.drain(..).zip(costs)) {
            if cost <= *kept {
                *member = trial;
                *kept = cost;
            }
        }
    }

    fn best(&self) -> (&[f64], f64) {
        let best = self.best_index();
        (&self.members[best], self.costs[best])
    }
}

/// Random numbers that depend on seed, generation and member only.
struct Random(ChaCha8Rng);

impl Random {
    fn of(seed: u64, generation: u64, member: usize) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(generation);
        generator.set_word_pos(member as u128 * 4096);
        Self(generator)
    }

    /// In [0, 1).
    fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / 9_007_199_254_740_992.0
    }

    /// In 0..`count`; 0 for a count of 0.
    fn below(&mut self, count: usize) -> usize {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "less than count"
        )]
        let index = (self.unit() * count as f64) as usize;
        index
    }

    /// Three different members, none of them `target`.
    fn distinct(&mut self, count: usize, target: usize) -> [usize; 3] {
        let mut chosen = [target; 3];
        for place in 0..3 {
            let mut candidate = self.below(count);
            while candidate == target || chosen[..place].contains(&candidate) {
                candidate = (candidate + 1) % count;
            }
            chosen[place] = candidate;
        }
        chosen
    }
}
