//! NSGA-II: a population that spreads over the best trade-offs of several objectives (Deb, Pratap,
//! Agarwal and Meyarivan, IEEE Transactions on Evolutionary Computation 6, 2002).

use serde::{Deserialize, Serialize};

use super::kind::{Plan, UnsoundState};
use super::member::{finite_or_nothing_each, first_points, in_cube, sane_cost};
use super::random::Random;
use super::sorting::{crowding, fronts};
use super::variation::Variation;
use super::{Start, Stop};

/// Mutation and share of crossover of section IV of the article; its crossover index of 20 keeps
/// children too close to their parents for budgets of ten thousand.
const VARIATION: Variation =
    Variation { crossover_index: 10.0, mutation_index: 20.0, crossover: 0.9 };

/// The random numbers of the tournaments lie above those of every population.
const SHUFFLES: usize = 1 << 30;

/// Proposes candidates in the unit cube and absorbs their objectives, all of them minimised.
pub trait ParetoOptimiser {
    /// The next candidates to be evaluated, the same until they are told; none when there is nothing
    /// left to try.
    fn ask(&mut self) -> Vec<Vec<f64>>;

    /// Takes the objectives of the candidates of the last [`ask`](Self::ask), in their order. An
    /// objective that is missing or not a number counts as infinite.
    fn tell(&mut self, objectives: &[Vec<f64>]);

    /// What nothing else dominates, in ascending order of the first objective.
    fn front(&self) -> Vec<&ParetoMember>;

    /// Candidates it was told.
    fn spent(&self) -> usize;

    /// Why it proposes nothing more, if so.
    fn stop(&self) -> Option<Stop>;
}

/// A point of the unit cube and its objectives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParetoMember {
    /// Coordinates, each in [0, 1].
    pub point: Vec<f64>,
    /// Its objectives, infinite where they are not known; written as nothing where infinite.
    #[serde(with = "finite_or_nothing_each")]
    pub objectives: Vec<f64>,
}

/// A population that is sorted by rank and crowding. Its state is plain data.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct NsgaII {
    plan: Plan,
    objectives: usize,
    members: Vec<ParetoMember>,
    /// Rank of each member and its place among those of all ranks, the least crowded first.
    ranks: Vec<usize>,
    places: Vec<usize>,
    children: Vec<Vec<f64>>,
    generation: u64,
    spent: usize,
}

impl NsgaII {
    /// Its name in files and on the command line.
    pub const NAME: &'static str = "nsga-ii";

    /// A population of at least four, made even, for so many objectives.
    #[must_use]
    pub fn new(plan: Plan, objectives: usize, start: Start<'_>) -> Self {
        let plan = Plan { population: plan.population.max(4).next_multiple_of(2), ..plan };
        let points = first_points(plan.population, plan.dimension, plan.seed, start);
        let unknown = |point| ParetoMember { point, objectives: vec![f64::INFINITY; objectives] };
        Self {
            objectives,
            members: points.into_iter().map(unknown).collect(),
            ranks: vec![0; plan.population],
            places: (0..plan.population).collect(),
            children: Vec::new(),
            generation: 0,
            spent: 0,
            plan,
        }
    }

    /// The optimiser of a state that was read.
    ///
    /// # Errors
    /// [`UnsoundState`] where the numbers do not fit together.
    pub fn resumed(self) -> Result<Self, UnsoundState> {
        let n = self.plan.dimension;
        let member = |m: &ParetoMember| {
            in_cube(&m.point, n)
                && m.objectives.len() == self.objectives
                && m.objectives.iter().all(|x| !x.is_nan())
        };
        let count = self.members.len();
        let sound = count >= 4
            && count.is_multiple_of(2)
            && self.places.iter().all(|place| *place < count)
            && count == self.plan.population
            && [self.ranks.len(), self.places.len()] == [count; 2]
            && self.members.iter().all(member)
            && self.children.iter().all(|child| in_cube(child, n));
        if sound { Ok(self) } else { Err(UnsoundState { optimiser: Self::NAME }) }
    }

    /// The better of two, of lower rank or less crowded, for as many pairs as there are members:
    /// everyone takes part as often as everyone else.
    fn winners(&self) -> Vec<usize> {
        let count = self.members.len();
        let drawn: Vec<usize> = (0..2).flat_map(|round| self.shuffled(round)).collect();
        let better = |two: &[usize]| {
            if self.places[two[1]] < self.places[two[0]] { two[1] } else { two[0] }
        };
        drawn.chunks_exact(2).map(better).take(count).collect()
    }

    /// Indices of the members in an order of their own for each round of tournaments.
    fn shuffled(&self, round: usize) -> Vec<usize> {
        let mut random = Random::of(self.plan.seed, self.generation, SHUFFLES + round);
        let mut order: Vec<usize> = (0..self.members.len()).collect();
        for last in (1..order.len()).rev() {
            order.swap(last, random.below(last + 1));
        }
        order
    }

    fn offspring(&self) -> Vec<Vec<f64>> {
        let pair = |(index, two): (usize, &[usize])| {
            let mut random = Random::of(self.plan.seed, self.generation, index);
            let (a, b) = (&self.members[two[0]].point, &self.members[two[1]].point);
            VARIATION.children(&mut random, a, b)
        };
        self.winners().chunks_exact(2).enumerate().flat_map(pair).collect()
    }

    /// Keeps the best ranks, and of the last that has room those that are least crowded.
    fn select(&mut self) {
        let objectives: Vec<&[f64]> =
            self.members.iter().map(|m| m.objectives.as_slice()).collect();
        let mut kept = Vec::with_capacity(self.plan.population);
        for (rank, front) in fronts(&objectives).into_iter().enumerate() {
            let distance = crowding(&objectives, &front);
            let mut order: Vec<usize> = (0..front.len()).collect();
            order.sort_by(|&a, &b| distance[b].total_cmp(&distance[a]));
            kept.extend(order.into_iter().map(|place| (rank, front[place])));
            kept.truncate(self.plan.population);
            if kept.len() == self.plan.population {
                break;
            }
        }
        self.ranks = kept.iter().map(|(rank, _)| *rank).collect();
        self.places = (0..kept.len()).collect();
        self.members = kept.iter().map(|&(_, index)| self.members[index].clone()).collect();
    }
}

impl ParetoOptimiser for NsgaII {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        if self.stop().is_some() {
            return Vec::new();
        }
        if self.children.is_empty() {
            self.children = if self.generation == 0 {
                self.members.iter().map(|member| member.point.clone()).collect()
            } else {
                self.offspring()
            };
            self.generation += 1;
        }
        self.children.clone()
    }

    fn tell(&mut self, objectives: &[Vec<f64>]) {
        let children = std::mem::take(&mut self.children);
        self.spent += objectives.len().min(children.len());
        let told = |index: usize, objective: usize| {
            let value = objectives.get(index).and_then(|all| all.get(objective));
            value.map_or(f64::INFINITY, |&value| sane_cost(value))
        };
        let member = |(index, point)| {
            let objectives = (0..self.objectives).map(|o| told(index, o)).collect();
            ParetoMember { point, objectives }
        };
        let children: Vec<_> = children.into_iter().enumerate().map(member).collect();
        if self.generation == 1 {
            self.members = children;
        } else {
            self.members.extend(children);
        }
        self.select();
    }

    fn front(&self) -> Vec<&ParetoMember> {
        let ranked = self.members.iter().zip(&self.ranks);
        let mut front: Vec<_> = ranked.filter(|(_, rank)| **rank == 0).map(|(m, _)| m).collect();
        let first = |member: &ParetoMember| member.objectives.first().copied().unwrap_or(0.0);
        front.sort_by(|a, b| first(a).total_cmp(&first(b)));
        front
    }

    fn spent(&self) -> usize {
        self.spent
    }

    fn stop(&self) -> Option<Stop> {
        self.plan.over(self.spent)
    }
}
