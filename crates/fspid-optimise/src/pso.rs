//! Particle swarm with constriction (Clerc and Kennedy, IEEE Transactions on Evolutionary Computation
//! 6, 2002), every particle drawn to the best place of all. The particle that remembers this place
//! does not fly on: it looks about there, one coordinate at a time (polynomial mutation, Deb and
//! Goyal, 1996), since it alone would have nothing else to follow.

use serde::{Deserialize, Serialize};

use super::kind::{Plan, Snapshot};
use super::member::{Member, first_points, in_cube, least, sane};
use super::progress::Progress;
use super::random::Random;
use super::variation::Variation;
use super::{Optimiser, Start, Stop};

/// χ = 2 / (φ - 2 + √(φ² - 4 φ)) and χ φ / 2 of Clerc and Kennedy for φ = 4.25; with their 4.1 the
/// swarm is still wide when a thousand evaluations a coordinate are spent.
const INERTIA: f64 = 0.6096117967977924;
const ATTRACTION: f64 = 1.295425068195309;
/// Share of the velocity that comes back from a side.
const BOUNCE: f64 = -0.5;
/// The random numbers of the first velocities lie above those of every population.
const VELOCITIES: usize = 1 << 30;
/// How the best place is looked about; only the index of the mutation counts.
const ABOUT: Variation = Variation { crossover_index: 15.0, mutation_index: 10.0, crossover: 0.0 };

/// Particles that remember where it was best.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ParticleSwarm {
    plan: Plan,
    places: Vec<Vec<f64>>,
    velocities: Vec<Vec<f64>>,
    remembered: Vec<Member>,
    generation: u64,
    asked: bool,
    spent: usize,
    progress: Progress,
}

impl ParticleSwarm {
    /// A swarm of at least two.
    #[must_use]
    pub fn new(plan: Plan, start: Start<'_>) -> Self {
        let plan = Plan { population: plan.population.max(2), ..plan };
        let places = first_points(plan.population, plan.dimension, plan.seed, start);
        let spread = match start {
            Start::Anywhere => 1.0,
            Start::About(_, spread) if spread.is_finite() => spread,
            Start::About(..) => 0.0,
        };
        let velocity = |(index, place): (usize, &Vec<f64>)| {
            let mut random = Random::of(plan.seed, 0, VELOCITIES + index);
            place.iter().map(|x| 0.5 * spread * (random.unit() - x)).collect()
        };
        Self {
            velocities: places.iter().enumerate().map(velocity).collect(),
            remembered: places.iter().cloned().map(Member::unknown).collect(),
            places,
            plan,
            generation: 0,
            asked: false,
            spent: 0,
            progress: Progress::default(),
        }
    }

    pub(super) fn is_sound(&self) -> bool {
        let (n, count) = (self.plan.dimension, self.plan.population);
        let finite = |v: &Vec<f64>| v.len() == n && v.iter().all(|x| x.is_finite());
        count >= 2
            && [self.places.len(), self.velocities.len(), self.remembered.len()] == [count; 3]
            && self.places.iter().all(|place| in_cube(place, n))
            && self.velocities.iter().all(finite)
            && self.remembered.iter().all(|member| member.is_sound(n))
    }

    fn advance(&mut self) {
        let leader = least(&self.remembered);
        for index in 0..self.places.len() {
            let mut random = Random::of(self.plan.seed, self.generation, index);
            if index == leader {
                self.places[index].clone_from(&self.remembered[leader].point);
                ABOUT.mutate_one(&mut random, &mut self.places[index]);
                continue;
            }
            let (own, best) = (&self.remembered[index].point, &self.remembered[leader].point);
            let (place, velocity) = (&mut self.places[index], &mut self.velocities[index]);
            for j in 0..place.len() {
                let towards_own = ATTRACTION * random.unit() * (own[j] - place[j]);
                let towards_best = ATTRACTION * random.unit() * (best[j] - place[j]);
                velocity[j] = INERTIA * velocity[j] + towards_own + towards_best;
                place[j] += velocity[j];
                if !(0.0..=1.0).contains(&place[j]) {
                    place[j] = place[j].clamp(0.0, 1.0);
                    velocity[j] *= BOUNCE;
                }
            }
        }
    }
}

impl Optimiser for ParticleSwarm {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        if self.stop().is_some() {
            return Vec::new();
        }
        if !self.asked {
            if self.generation > 0 {
                self.advance();
            }
            self.generation += 1;
            self.asked = true;
        }
        self.places.clone()
    }

    fn tell(&mut self, costs: &[f64]) {
        if !std::mem::take(&mut self.asked) {
            return;
        }
        self.spent += costs.len().min(self.places.len());
        let costs = sane(costs, self.places.len());
        for (member, (place, cost)) in self.remembered.iter_mut().zip(self.places.iter().zip(costs))
        {
            member.improve(place, cost);
        }
        self.progress.note(&self.remembered);
    }

    fn best(&self) -> (&[f64], f64) {
        let best = self.remembered.get(least(&self.remembered));
        best.map_or((&[], f64::INFINITY), Member::borrowed)
    }

    fn spent(&self) -> usize {
        self.spent
    }

    fn stop(&self) -> Option<Stop> {
        self.plan.over(self.spent).or(self.progress.stop())
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot::Pso(self.clone())
    }
}
