//! One front beside another: the difference at equal travel, with a band that holds all along it at once.
//!
//! In every case both curves have a common range of travels; along it, in equal ratios, the difference of the logarithms of
//! the errors is taken at [`PLACES`] places. Cases and seeds are drawn anew (with replacement, each on its own: the
//! pigeonhole bootstrap), so that the spread has a part for cases and a part for tunings. The band is the mean ± q standard
//! deviations, with q the quantile of the *largest* standardised deviation along the front, after Bonferroni's correction
//! for the number of controllers: it holds everywhere at once.
//!
//! A front is better as a whole where all of the band is below zero. That asks more than a test at one travel, whichever;
//! nobody wins by choosing the effort.
//!
//! # What is assumed
//! Cases are like draws of those that matter, and so are seeds; a straight line between rungs (in logarithms) is near the
//! truth. The bootstrap needs some cases: with fewer than [`FEWEST_CASES`] and with one seed nothing is claimed.
//!
//! # Source
//! A. B. Owen, *The pigeonhole bootstrap*, Annals of Applied Statistics 1 (2007) 386; for the largest deviation, J. L.
//! Montiel Olea and M. Plagborg-Møller, *Simultaneous confidence bands*, Journal of Applied Econometrics 34 (2019) 1.

use super::Rung;
use super::curves::{Curve, of_case};
use crate::draw::Draw;

/// Places along a front.
pub(super) const PLACES: usize = 9;
/// Fewer cases say nothing.
pub(super) const FEWEST_CASES: usize = 6;
/// How often cases and seeds are drawn.
pub(super) const DRAWS: usize = 2000;
/// How sure all bands together are.
pub(super) const CONFIDENCE: f64 = 0.95;
/// Seed of the draws.
const SEED: u64 = 0x6672_6f6e_7473;

/// How one front stands beside another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dominance {
    /// Less error at every travel.
    Dominates,
    /// More error at every travel.
    Dominated,
    /// Less at some and at none more; the rest is open.
    BetterInPart,
    /// More at some and at none less.
    WorseInPart,
    /// Less at some and more at others.
    Crosses,
    /// Nothing is significant.
    Open,
    /// Less error at every travel, and more flights fail.
    FailsMore,
    /// One tuning each, too few cases, or no common travel.
    NotTold,
}

impl Dominance {
    /// In words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Dominates => "better on the whole front",
            Self::Dominated => "worse on the whole front",
            Self::BetterInPart => "better on a part of the front",
            Self::WorseInPart => "worse on a part of the front",
            Self::Crosses => "better on one part, worse on another",
            Self::Open => "not significant anywhere",
            Self::FailsMore => "less error on the whole front, but more flights fail",
            Self::NotTold => "not told: it takes two seeds, six cases and a common range of travel",
        }
    }
}

/// A front beside the one compared with.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// Place of the controller.
    pub contestant: usize,
    /// Its name.
    pub name: String,
    /// Cases in which both have curves with a common range, of how many.
    pub cases: (usize, usize),
    /// Mean difference of the logarithm of the error along the front, from the least to the most common travel.
    pub middle: Vec<f64>,
    /// Lower and upper end of the band.
    pub ends: [Vec<f64>; 2],
    /// Flights that failed on all rungs: its own, and of the one compared with.
    pub failed: [u64; 2],
    /// What that amounts to.
    pub dominance: Dominance,
}

/// Logarithms of the error along the common range: by case, for each of the two by seed and place.
type Along = [Vec<[f64; PLACES]>; 2];

/// All tuned controllers beside the one compared with.
pub(super) fn all(rungs: &[Rung]) -> Vec<Band> {
    let Some(judged) = rungs.first().map(|rung| &rung.outcome.judged) else {
        return Vec::new();
    };
    let tuned = |place: &usize| judged.contestants.get(*place).is_some_and(|it| it.is_tuned);
    let others: Vec<usize> = (0..judged.contestants.len())
        .filter(|place| *place != judged.against && tuned(place))
        .collect();
    if !tuned(&judged.against) {
        return Vec::new();
    }
    let comparisons = others.len();
    let band = |contestant: usize| {
        let cases: Vec<(f64, Along)> = (0..judged.cases.len())
            .filter_map(|case| {
                let weight = judged.cases.get(case)?.weight;
                let own = of_case(rungs, contestant, case)?;
                Some((weight, along(&own, &of_case(rungs, judged.against, case)?)?))
            })
            .collect();
        let failed = [contestant, judged.against].map(|place| failed(rungs, place));
        let mut band = Band {
            contestant,
            name: judged.contestants[contestant].name.clone(),
            cases: (cases.len(), judged.cases.len()),
            middle: Vec::new(),
            ends: [Vec::new(), Vec::new()],
            failed,
            dominance: Dominance::NotTold,
        };
        let seeds = cases.first().map_or(0, |(_, [own, other])| own.len().min(other.len()));
        if cases.is_empty() {
            return band;
        }
        band.middle = mean(&cases, &Redrawn::as_it_is(&cases)).to_vec();
        if cases.len() >= FEWEST_CASES && seeds > 1 {
            band.ends = ends(&cases, &band.middle, comparisons);
            band.dominance = dominance(&band);
        }
        band
    };
    others.into_iter().map(band).collect()
}

fn failed(rungs: &[Rung], place: usize) -> u64 {
    let designs = rungs.iter().flat_map(|rung| &rung.outcome.judged.contestants[place].designs);
    designs.flat_map(|it| &it.flights).map(|flight| u64::from(flight.failed)).sum()
}

/// Both along the range that all seeds of both have; none where there is none.
fn along(own: &[Curve], other: &[Curve]) -> Option<Along> {
    let ranges = || own.iter().chain(other).map(Curve::range);
    let least = ranges().map(|it| it[0]).fold(f64::NEG_INFINITY, f64::max);
    let most = ranges().map(|it| it[1]).fold(f64::INFINITY, f64::min);
    // Written so that NaN is none.
    if !(least < most) {
        return None;
    }
    let at = |place: usize| least + (most - least) * place as f64 / (PLACES - 1) as f64;
    let values = |curve: &Curve| std::array::from_fn(|place| curve.at(at(place)));
    Some([own, other].map(|curves| curves.iter().map(values).collect()))
}

/// Which cases, and which seeds of each of the two.
struct Redrawn {
    cases: Vec<usize>,
    seeds: [Vec<usize>; 2],
}

impl Redrawn {
    fn as_it_is(cases: &[(f64, Along)]) -> Self {
        let seeds = [0, 1].map(|who| (0..seeds(cases, who)).collect());
        Self { cases: (0..cases.len()).collect(), seeds }
    }

    fn new(cases: &[(f64, Along)], random: &mut Draw) -> Self {
        let mut drawn = |of: usize| (0..of).map(|_| random.below(of)).collect::<Vec<usize>>();
        let own = drawn(cases.len());
        Self { cases: own, seeds: [0, 1].map(|who| drawn(seeds(cases, who))) }
    }
}

fn seeds(cases: &[(f64, Along)], who: usize) -> usize {
    cases.iter().map(|(_, along)| along[who].len()).min().unwrap_or(0)
}

/// The mean difference along the front.
fn mean(cases: &[(f64, Along)], draw: &Redrawn) -> [f64; PLACES] {
    let mut sum = [0.0; PLACES];
    let mut weights = 0.0;
    for &case in &draw.cases {
        let (weight, along) = &cases[case];
        weights += weight;
        for (who, sign) in [(0, 1.0), (1, -1.0)] {
            let share = sign * weight / draw.seeds[who].len() as f64;
            for &seed in &draw.seeds[who] {
                sum.iter_mut().zip(&along[who][seed]).for_each(|(sum, it)| *sum += share * it);
            }
        }
    }
    sum.map(|it| it / weights)
}

/// Lower and upper ends of the band.
fn ends(cases: &[(f64, Along)], middle: &[f64], comparisons: usize) -> [Vec<f64>; 2] {
    let mut random = Draw::of(SEED, 0);
    let drawn: Vec<[f64; PLACES]> =
        (0..DRAWS).map(|_| mean(cases, &Redrawn::new(cases, &mut random))).collect();
    around(&drawn, middle, comparisons)
}

/// Lower and upper ends of a band around a middle that holds everywhere at once, from what drawing anew makes of it.
pub(super) fn around(drawn: &[[f64; PLACES]], middle: &[f64], bands: usize) -> [Vec<f64>; 2] {
    let deviation = |place: usize| {
        let squares =
            drawn.iter().map(|it| (it[place] - middle[place]) * (it[place] - middle[place]));
        libm::sqrt(squares.sum::<f64>() / drawn.len() as f64)
    };
    let deviations: Vec<f64> = (0..PLACES).map(deviation).collect();
    let mut largest: Vec<f64> = drawn
        .iter()
        .map(|it| {
            let standardised = (0..PLACES).filter(|place| deviations[*place] > 0.0);
            let sizes = standardised.map(|at| (it[at] - middle[at]).abs() / deviations[at]);
            sizes.fold(0.0, f64::max)
        })
        .collect();
    largest.sort_by(f64::total_cmp);
    let beyond = (1.0 - CONFIDENCE) / bands.max(1) as f64 * drawn.len() as f64;
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and the number of draws"
    )]
    let place = largest.len().saturating_sub(1 + libm::floor(beyond) as usize);
    let q = largest[place];
    [-1.0, 1.0].map(|side| {
        let ends = middle.iter().zip(&deviations);
        ends.map(|(middle, deviation)| middle + side * q * deviation).collect()
    })
}

fn dominance(band: &Band) -> Dominance {
    let [lower, upper] = &band.ends;
    let less = upper.iter().filter(|it| **it < 0.0).count();
    let more = lower.iter().filter(|it| **it > 0.0).count();
    match (less, more) {
        (PLACES, _) if band.failed[0] > band.failed[1] => Dominance::FailsMore,
        (PLACES, _) => Dominance::Dominates,
        (_, PLACES) => Dominance::Dominated,
        (0, 0) => Dominance::Open,
        (_, 0) => Dominance::BetterInPart,
        (0, _) => Dominance::WorseInPart,
        _ => Dominance::Crosses,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cases whose difference is `shift` plus noise of cases and seeds.
    fn cases(shift: impl Fn(usize) -> f64, random: &mut Draw, count: usize) -> Vec<(f64, Along)> {
        let mut noise = |size: f64| size * (random.below(2001) as f64 / 1000.0 - 1.0);
        let designs: [Vec<f64>; 2] = [0, 1].map(|_| (0..3).map(|_| noise(0.03)).collect());
        (0..count)
            .map(|_| {
                let of_case = noise(0.1);
                let own = |who: usize, seed: usize, place: usize| {
                    if who == 0 {
                        shift(place) + of_case + designs[0][seed]
                    } else {
                        designs[1][seed]
                    }
                };
                let along = [0, 1].map(|who| {
                    (0..3).map(|seed| std::array::from_fn(|at| own(who, seed, at))).collect()
                });
                (1.0, along)
            })
            .collect()
    }

    fn stands(cases: &[(f64, Along)]) -> Dominance {
        let middle = mean(cases, &Redrawn::as_it_is(cases)).to_vec();
        let ends = ends(cases, &middle, 1);
        let (name, dominance) = (String::new(), Dominance::NotTold);
        let band =
            Band { contestant: 0, name, cases: (0, 0), middle, ends, failed: [0; 2], dominance };
        super::dominance(&band)
    }

    #[test]
    fn who_is_no_better_is_seldom_called_better() {
        let mut random = Draw::of(7, 0);
        let told = (0..120).filter(|_| stands(&cases(|_| 0.0, &mut random, 12)) != Dominance::Open);
        // Of 120 some 6 would be told wrongly, on either side and anywhere.
        let count = told.count();
        assert!(count <= 14, "{count}");
    }

    #[test]
    fn a_front_that_is_better_everywhere_dominates_and_one_that_crosses_does_not() {
        let mut random = Draw::of(8, 0);
        assert_eq!(stands(&cases(|_| -0.3, &mut random, 12)), Dominance::Dominates);
        assert_eq!(stands(&cases(|_| 0.3, &mut random, 12)), Dominance::Dominated);
        let crossing = cases(|place| 0.1 * (place as f64 - 4.0), &mut random, 12);
        assert_eq!(stands(&crossing), Dominance::Crosses);
        let in_part = cases(|place| if place < 4 { -0.3 } else { 0.0 }, &mut random, 12);
        assert_eq!(stands(&in_part), Dominance::BetterInPart);
    }
}
