//! Importance sampling: points are drawn where failures are, and each counts by how much likelier it is to be drawn there.
//!
//! $$ \hat p = \frac1n \sum_{i} w(x_i) \mathbf 1[\text{fails}], \qquad
//! w = \frac{\varphi(x)}{0.1 \varphi(x) + 0.6 q(x) + 0.3 q(-x)} $$
//!
//! q is the normal distribution of independent numbers that the cross-entropy method finds: level by level the means and
//! variances of the best tenth, weighted. A tenth of the points is drawn as flights are, so that no weight is above ten; that
//! keeps the variance finite, and it does not find what q has not found. The mirror image of q is there because limits often have two sides, of which q finds one. Seeds and noises of air are drawn as they are.
//!
//! # Source
//! R. Y. Rubinstein, D. P. Kroese, *The Cross-Entropy Method* (2004), chapter 3; T. Hesterberg, "Weighted average importance
//! sampling and defensive mixture distributions", Technometrics 37 (1995) 185.

use super::chains::LimitState;
use super::dice::{Dice, Place};
use super::interval::{self, Interval};
use super::point::Point;
use super::subset::{Known, Unfinished};
use crate::statistics::binomial::upper_bound;

/// Share of the points that the next distribution is fitted to.
const ELITE: f64 = 0.1;
/// Share that is drawn as flights are.
const PLAIN: f64 = 0.1;
/// Share of all points that the search for q may take, and in how many iterations at most.
const SEARCH: f64 = 0.4;
const MOST_ITERATIONS: u64 = 16;
/// Standard deviations of q are no smaller: what is as thin as its best points misses what lies beside them.
const THINNEST: f64 = 0.3;
/// Share of q, of its points and those of its mirror image together.
const STRAIGHT: f64 = 2.0 / 3.0;
/// How much wider than those points q is drawn in the end.
const WIDER: f64 = 1.2;
/// Fewest failures that count, as if their weights were alike (Kish's effective number).
pub const LEAST_EFFECTIVE: f64 = 100.0;
/// Least share of the failures that they may be: of thousands of which a few decide, chance alone makes a hundred.
const LEAST_SHARE: f64 = 0.03;
/// Numbers of streams of its own: teams have those below.
const TEAM: u64 = 100;
/// Standard normal quantile at 0.975.
const Z: f64 = 1.959_963_984_540_054;

/// What points are drawn from.
#[derive(Clone, Copy, Debug)]
struct Mixed {
    /// Share of the standard normal distribution.
    plain: f64,
    /// Of the others, those of q; the rest is of its mirror image.
    straight: f64,
}

const SEARCHED: Mixed = Mixed { plain: 0.0, straight: 1.0 };
const COUNTED: Mixed = Mixed { plain: PLAIN, straight: STRAIGHT };

/// A normal distribution of independent numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Aim {
    /// Means.
    pub means: Vec<f64>,
    /// Standard deviations.
    pub deviations: Vec<f64>,
}

/// The answer of importance sampling.
#[derive(Clone, Debug, PartialEq)]
pub struct Importance {
    /// What is known.
    pub known: Known,
    /// Where points were drawn.
    pub aim: Aim,
    /// Levels of the search, the last one 0 if failures were reached.
    pub levels: Vec<f64>,
    /// Points that failed.
    pub failing: u64,
    /// How many failures of one weight would say as much.
    pub effective: f64,
    /// Share of the largest weight in the sum of all.
    pub largest_share: f64,
    /// The likeliest failure.
    pub likeliest: Option<Point>,
    /// Points that were asked for in all.
    pub asked: u64,
    /// Those of them that are drawn as flights are, independent of all others: the first round, and a tenth of what is counted.
    pub independent: f64,
}

impl Aim {
    fn plain(dimensions: usize) -> Self {
        Self { means: vec![0.0; dimensions], deviations: vec![1.0; dimensions] }
    }

    /// The density over that of the standard normal distribution, or of the mirror image for a sign of -1.
    fn ratio(&self, point: &Point, sign: f64) -> f64 {
        let axes = self.means.iter().zip(&self.deviations).zip(&point.normals);
        let log = |((mean, deviation), x): ((&f64, &f64), &f64)| {
            let z = (sign * x - mean) / deviation;
            0.5 * (x * x - z * z) - libm::log(*deviation)
        };
        libm::exp(axes.map(log).sum())
    }

    /// The weight of a point that was drawn from a mixture.
    fn weight(&self, point: &Point, mixed: Mixed) -> f64 {
        let Mixed { plain, straight } = mixed;
        let aimed = straight * self.ratio(point, 1.0) + (1.0 - straight) * self.ratio(point, -1.0);
        1.0 / (plain + (1.0 - plain) * aimed)
    }

    /// The normal distribution of weighted points.
    fn of(points: &[(&Point, f64)], dimensions: usize) -> Self {
        let sum: f64 = points.iter().map(|(_, weight)| weight).sum();
        let mean = |axis: usize, of: &dyn Fn(f64) -> f64| {
            let terms = points
                .iter()
                .filter_map(|(point, weight)| point.normals.get(axis).map(|x| weight * of(*x)));
            terms.sum::<f64>() / sum
        };
        let means: Vec<f64> = (0..dimensions).map(|axis| mean(axis, &|x| x)).collect();
        let deviation = |(axis, centre): (usize, &f64)| {
            libm::sqrt(mean(axis, &|x| (x - centre) * (x - centre))).clamp(THINNEST, 3.0)
        };
        let deviations = means.iter().enumerate().map(deviation).collect();
        Self { means, deviations }
    }
}

/// Estimates the probability that a score is above 0 with about `points` points.
///
/// # Errors
/// Those of the scores.
pub fn importance<L: LimitState>(
    state: &mut L,
    seed: u64,
    points: u64,
) -> Result<Importance, L::Error> {
    let dimensions = state.shape().normals;
    let search = SEARCH * points as f64;
    let each = ((search / MOST_ITERATIONS as f64) as usize).clamp(200, 2000);
    let mut aim = Aim::plain(dimensions);
    let (mut levels, mut asked, mut plain_failing) = (Vec::new(), 0_u64, 0);
    let mut round = 0;
    while round < MOST_ITERATIONS && (asked + each as u64) as f64 <= search.max(each as f64) {
        let drawn = drawn(state, seed, round, each, (&aim, SEARCHED))?;
        asked += each as u64;
        if round == 0 {
            plain_failing = drawn.iter().filter(|(_, score)| *score > 0.0).count();
        }
        let mut scores: Vec<f64> = drawn.iter().map(|(_, score)| *score).collect();
        scores.sort_by(|a, b| b.total_cmp(a));
        let best = scores.get((ELITE * each as f64) as usize).copied().unwrap_or(0.0);
        let failed = best > 0.0;
        let level = best.min(0.0);
        levels.push(level);
        let is_elite = |score: f64| if failed { score > 0.0 } else { score >= level };
        let elite: Vec<(&Point, f64)> = drawn
            .iter()
            .filter(|(_, score)| is_elite(*score))
            .map(|(point, _)| (point, aim.weight(point, SEARCHED)))
            .collect();
        aim = Aim::of(&elite, dimensions);
        round += 1;
        if failed {
            break;
        }
    }
    let reached = levels.last().is_some_and(|level| *level >= 0.0);
    aim.deviations.iter_mut().for_each(|it| *it *= WIDER);
    let count = (points.saturating_sub(asked) as usize).max(each);
    let last = drawn(state, seed, MOST_ITERATIONS, count, (&aim, COUNTED))?;
    asked += count as u64;
    let mut found = weighed(&last, &aim);
    let plain = upper_bound(plain_failing as u64, each as u64, interval::CONFIDENCE).unwrap_or(1.0);
    if !reached && found.effective < LEAST_EFFECTIVE {
        found.known = Known::Below { most: plain, why: Unfinished::Spent };
    } else if let Known::Below { most, .. } = &mut found.known {
        *most = plain;
    }
    let independent = each as f64 + PLAIN * count as f64;
    Ok(Importance { aim, levels, asked, independent, ..found })
}

/// Points of a round with their scores: the first ones of the standard normal distribution, as many as their share asks for.
fn drawn<L: LimitState>(
    state: &mut L,
    seed: u64,
    round: u64,
    count: usize,
    (aim, mixed): (&Aim, Mixed),
) -> Result<Vec<(Point, f64)>, L::Error> {
    let shape = state.shape();
    let point = |member: u64| {
        let mut dice = Dice::at(seed, Place { team: TEAM, rung: round, step: 0, member });
        // By lot, so that every point is of the mixture.
        let (is_plain, is_straight) =
            (dice.uniform() < mixed.plain, dice.uniform() < mixed.straight);
        let mut point = Point::drawn(shape, &mut dice);
        if !is_plain {
            let axes = point.normals.iter_mut().zip(&aim.means).zip(&aim.deviations);
            let sign = if is_straight { 1.0 } else { -1.0 };
            axes.for_each(|((x, mean), deviation)| *x = sign * (mean + deviation * *x));
        }
        point
    };
    let points: Vec<Point> = (0..count as u64).map(point).collect();
    let scores = state.scores(&points)?;
    Ok(points.into_iter().zip(scores).collect())
}

/// What the weighted failures say.
fn weighed(drawn: &[(Point, f64)], aim: &Aim) -> Importance {
    let count = drawn.len() as f64;
    let failures = || drawn.iter().filter(|(_, score)| *score > 0.0).map(|(point, _)| point);
    let weights: Vec<f64> = failures().map(|point| aim.weight(point, COUNTED)).collect();
    let sum: f64 = weights.iter().sum();
    let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
    let largest = weights.iter().copied().fold(0.0, f64::max);
    let effective = if squares > 0.0 { sum * sum / squares } else { 0.0 };
    let estimate = sum / count;
    let variance = (squares / count - estimate * estimate) / count;
    let error = libm::sqrt(variance.max(0.0)) / estimate;
    let least = LEAST_EFFECTIVE.max(LEAST_SHARE * weights.len() as f64);
    let known = if effective >= least {
        let at = |sign: f64| (estimate * libm::exp(sign * Z * error)).min(1.0);
        Known::Within(Interval { estimate, low: at(-1.0), high: at(1.0), spread: error })
    } else {
        Known::Below { most: 1.0, why: Unfinished::Uneven }
    };
    let likeliest =
        failures().min_by(|a, b| a.distance_squared().total_cmp(&b.distance_squared())).cloned();
    Importance {
        known,
        aim: aim.clone(),
        levels: Vec::new(),
        failing: weights.len() as u64,
        effective,
        largest_share: if sum > 0.0 { largest / sum } else { 0.0 },
        likeliest,
        asked: 0,
        independent: 0.0,
    }
}
