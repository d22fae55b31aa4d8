//! A point of the space that flights are drawn from: independent standard normal numbers, and noises of air.
//!
//! A noise of air is thousands of independent standard normal numbers, which a seed stands for. A new noise near an old one
//! is a mixture of the two,
//!
//! $$ \xi' = \sqrt{1 - \beta^2} \ \xi + \beta \ \eta, \qquad \eta \sim N(0, I) $$
//!
//! which is standard normal again, whatever the dimension. So a noise is kept as the seeds that it is mixed of and their
//! weights, a list as long as its history of moves, and never as numbers.
//!
//! # Source
//! S. L. Cotter, G. O. Roberts, A. M. Stuart, D. White, "MCMC methods for functions: modifying old algorithms to make them
//! faster", Statistical Science 28 (2013) 424: the preconditioned Crank-Nicolson proposal.

use super::dice::Dice;

/// A noise that is mixed of the noises of seeds; the squares of the weights sum to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Air {
    /// Seeds with their weights, the oldest first.
    pub terms: Vec<(u64, f64)>,
}

/// Weights below this are left out: their squares are below the rounding of the sum of all.
const LEAST_WEIGHT: f64 = 1e-9;

impl Air {
    /// The noise of one seed.
    #[must_use]
    pub fn of(seed: u64) -> Self {
        Self { terms: vec![(seed, 1.0)] }
    }

    /// Mixed with the noise of a new seed, which gets this weight.
    #[must_use]
    pub fn moved(&self, weight: f64, seed: u64) -> Self {
        let left = libm::sqrt(1.0 - weight * weight);
        let old = self.terms.iter().map(|&(seed, weight)| (seed, left * weight));
        let kept = old.filter(|(_, weight)| *weight > LEAST_WEIGHT);
        Self { terms: kept.chain([(seed, weight)]).collect() }
    }
}

/// How much of everything a point has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shape {
    /// Standard normal numbers.
    pub normals: usize,
    /// Noises of air.
    pub airs: usize,
    /// Seeds of what cannot be mixed: a move draws a new one.
    pub seeds: usize,
}

/// One draw of everything.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The standard normal numbers.
    pub normals: Vec<f64>,
    /// The noises.
    pub airs: Vec<Air>,
    /// The seeds.
    pub seeds: Vec<u64>,
}

/// What a move changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// The numbers.
    Normals,
    /// The noises.
    Airs,
    /// The seeds.
    Seeds,
}

/// How far moves go: the weight of what is new, for numbers and for noises.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steps {
    /// Of the numbers.
    pub normals: f64,
    /// Of the noises.
    pub airs: f64,
}

impl Point {
    /// A point of the whole space.
    pub(super) fn drawn(shape: Shape, dice: &mut Dice) -> Self {
        Self {
            normals: (0..shape.normals).map(|_| dice.normal()).collect(),
            airs: (0..shape.airs).map(|_| Air::of(dice.seed())).collect(),
            seeds: (0..shape.seeds).map(|_| dice.seed()).collect(),
        }
    }

    /// A point beside this one, of which one part is new, and which. Whoever draws points of the whole space and moves them
    /// all has points of the whole space.
    pub(super) fn moved(&self, steps: Steps, dice: &mut Dice) -> (Self, Part) {
        let mut next = self.clone();
        let part = self.part(dice);
        match part {
            Part::Normals => {
                let left = libm::sqrt(1.0 - steps.normals * steps.normals);
                for number in &mut next.normals {
                    *number = left * *number + steps.normals * dice.normal();
                }
            }
            Part::Airs => {
                for air in &mut next.airs {
                    *air = air.moved(steps.airs, dice.seed());
                }
            }
            Part::Seeds => {
                let place = (dice.uniform() * self.seeds.len() as f64) as usize;
                if let Some(seed) = next.seeds.get_mut(place) {
                    *seed = dice.seed();
                }
            }
        }
        (next, part)
    }

    /// The part that is moved, by lot.
    fn part(&self, dice: &mut Dice) -> Part {
        let sizes = [
            (Part::Normals, self.normals.len()),
            (Part::Airs, self.airs.len()),
            (Part::Seeds, self.seeds.len()),
        ];
        let present: Vec<Part> =
            sizes.into_iter().filter(|(_, size)| *size > 0).map(|(part, _)| part).collect();
        let place =
            if present.len() > 1 { (dice.uniform() * present.len() as f64) as usize } else { 0 };
        present.get(place).copied().unwrap_or(Part::Normals)
    }

    /// Squared distance of the numbers from their means, in standard deviations: the smaller, the likelier.
    #[must_use]
    pub fn distance_squared(&self) -> f64 {
        self.normals.iter().map(|number| number * number).sum()
    }
}
