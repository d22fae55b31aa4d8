//! One front beside another: the difference at equal travel, with a band that holds all along it at once.
//!
//! In every case of which neither lost a flight both curves have a common range of travels; along it, in equal ratios, the
//! difference of the logarithms of the errors is taken at [`PLACES`] places. Cases and seeds are what was drawn, as in a
//! contest, and the band around the mean difference holds everywhere at once, and for all controllers together
//! ([`joint`](super::joint)).
//!
//! A front is better as a whole where all of the band is below zero, where the signed ranks of the cases say so at every place,
//! too, with a lost case as the largest defeat, and where nothing bars it. That asks more than a contest at one travel,
//! whichever; nobody wins by choosing the effort.
//!
//! # What is assumed
//! Cases are like draws of those that matter, and so are seeds; a straight line between rungs (in logarithms) is near the
//! truth. With fewer than [`FEWEST_CASES`] cases or [`FEWEST_SEEDS`] seeds nothing is claimed.

use std::cmp::Ordering;

use super::curves::{Curve, of_case};
use super::joint::{Along, CONFIDENCE, Ends, FEWEST_CASES, FEWEST_SEEDS, Means, PLACES, mean};
use super::standing::{Dominance, Everywhere, FrontBar, Missing};
use crate::contest::{Judged, SignedRank};

/// A range of travel, as the logarithm of its ends, below which the ladder has not changed how far the elevator goes: a
/// hundredth of the travel.
const NARROWEST: f64 = 0.01;

/// A front beside the one compared with.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// Place of the controller.
    pub contestant: usize,
    /// Its name.
    pub name: String,
    /// What became of the cases.
    pub cases: Cases,
    /// What the whole front is; none without a case that is compared.
    pub travel: Option<Travel>,
    /// Mean difference of the logarithm of the error along the front, from the least to the most common travel.
    pub middle: Vec<f64>,
    /// Lower and upper end of the band.
    pub ends: [Vec<f64>; 2],
    /// What cannot be a success on all rungs: its own, and of the one compared with.
    pub flights: [Unsuccessful; 2],
    /// What that amounts to.
    pub dominance: Dominance,
}

/// What became of the cases in a comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cases {
    /// Those in which both have curves with a common range of travel.
    pub compared: usize,
    /// Those of which one of them lost a flight on some rung: they have no error, and count in the ranks as defeats.
    pub lost: usize,
    /// Those without a common range of travel, or in which the ladder changes no travel.
    pub apart: usize,
    /// Those that are no evidence between both, and are in none of the others: at some effort they fly them to a millionth
    /// as another case, or as one of the tuning.
    pub alike: usize,
}

impl Cases {
    /// All that are evidence.
    #[must_use]
    pub const fn of(self) -> usize {
        self.compared + self.lost + self.apart
    }
}

/// The common range of travel, least and most, deg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Travel {
    /// The mean over the cases that are compared (geometric).
    pub mean_deg: [f64; 2],
    /// That of the case in which it is narrowest.
    pub narrowest_deg: [f64; 2],
}

/// Flights on all rungs that are no success.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unsuccessful {
    /// Lost ones.
    pub lost: u64,
    /// Those that fail, lost ones among them.
    pub failed: u64,
    /// Those of loops that are unstable at rest.
    pub unstable: u64,
    /// Those of loops of which nobody can tell whether they are stable.
    pub undecided: u64,
    /// All flights.
    pub of: u64,
}

/// Logarithms of the error along the common range of a case, for each of the two by seed.
struct OfCase {
    /// Logarithms of the least and the most travel.
    range: [f64; 2],
    errors: [Vec<Along>; 2],
}

/// All tuned controllers beside the one compared with.
pub(super) fn all(rungs: &[&Judged]) -> Vec<Band> {
    let Some(everywhere) = Everywhere::of(rungs) else {
        return Vec::new();
    };
    let judged = &everywhere.together;
    let tuned = |place: &usize| judged.contestants.get(*place).is_some_and(|it| it.is_tuned);
    let others: Vec<usize> = (0..judged.contestants.len())
        .filter(|place| *place != judged.against && tuned(place))
        .collect();
    if !tuned(&judged.against) {
        return Vec::new();
    }
    let pair = |&contestant: &usize| Pair { rungs, everywhere: &everywhere, contestant };
    others.iter().map(|it| pair(it).band(others.len())).collect()
}

/// A controller and the one that it is compared with.
struct Pair<'a> {
    rungs: &'a [&'a Judged],
    everywhere: &'a Everywhere<'a>,
    contestant: usize,
}

impl Pair<'_> {
    fn band(&self, bands: usize) -> Band {
        let judged = &self.everywhere.together;
        let both = [self.contestant, judged.against];
        let (lost, kept): (Vec<usize>, Vec<usize>) =
            self.evidence().into_iter().partition(|case| self.lost(*case).is_some());
        let found: Vec<OfCase> = kept
            .iter()
            .filter_map(|&case| {
                let [own, other] = both.map(|it| of_case(self.rungs, it, case));
                OfCase::along(&own?, &other?)
            })
            .collect();
        let compared = found.len();
        let cases = Cases {
            compared,
            lost: lost.len(),
            apart: kept.len() - compared,
            alike: judged.cases.len() - lost.len() - kept.len(),
        };
        let defeats: Vec<f64> = lost.iter().filter_map(|case| self.lost(*case)).collect();
        let mut band = Band {
            contestant: self.contestant,
            name: judged.contestants[self.contestant].name.clone(),
            cases,
            travel: travel(&found),
            middle: Vec::new(),
            ends: [Vec::new(), Vec::new()],
            flights: both.map(|it| self.unsuccessful(it)),
            dominance: Dominance::NotTold(Missing::Cases),
        };
        if found.is_empty() {
            return band;
        }
        let means = means(&found);
        band.middle = means.middle.to_vec();
        // Seeds that find the same at an effort are one tuning.
        let tunings = |judged: &&Judged| both.map(|it| judged.contestants[it].tunings());
        let seeds = self.rungs.iter().flat_map(tunings).min().unwrap_or(0);
        if seeds < FEWEST_SEEDS {
            band.dominance = Dominance::NotTold(Missing::Seeds);
        } else if compared >= FEWEST_CASES {
            band.ends = means.ends(bands);
            let ranked = signs(&means.parts[0], &defeats, bands);
            let bars = [(both[0], both[1]), (both[1], both[0])];
            let bars = bars.map(|(one, other)| self.everywhere.bar(one, other));
            band.dominance = allowed(&band.ends, &ranked, bars);
        }
        band
    }

    /// Cases that are evidence between both at every effort.
    fn evidence(&self) -> Vec<usize> {
        let against = self.everywhere.together.against;
        let mut kept = self.everywhere.together.all();
        for rung in self.rungs {
            let evidence = rung.evidence_between(&[self.contestant, against]);
            kept.retain(|case| evidence.binary_search(case).is_ok());
        }
        kept
    }

    /// A case of which one lost a flight, as the contest counts it: the largest defeat of the one that lost the larger
    /// share, nothing where both lost as many. None of a case without lost flights.
    fn lost(&self, case: usize) -> Option<f64> {
        let judged = &self.everywhere.together;
        let count = |place: usize| judged.count(&judged.contestants[place], &[case]);
        let (mine, theirs) = (count(self.contestant), count(judged.against));
        (mine.lost + theirs.lost > 0).then(|| match mine.cmp_lost(theirs) {
            Ordering::Greater => f64::INFINITY,
            Ordering::Less => f64::NEG_INFINITY,
            Ordering::Equal => 0.0,
        })
    }

    fn unsuccessful(&self, place: usize) -> Unsuccessful {
        let judged = &self.everywhere.together;
        let count = judged.count(&judged.contestants[place], &judged.all());
        let (lost, failed, unstable) = (count.lost, count.failed, count.unstable);
        Unsuccessful { lost, failed, unstable, undecided: count.undecided, of: count.of }
    }
}

impl OfCase {
    /// Both along the range that all seeds of both have; none where there is none, or next to none.
    fn along(own: &[Curve], other: &[Curve]) -> Option<Self> {
        let ranges = || own.iter().chain(other).map(Curve::range);
        let least = ranges().map(|it| it[0]).fold(f64::NEG_INFINITY, f64::max);
        let most = ranges().map(|it| it[1]).fold(f64::INFINITY, f64::min);
        // Written so that NaN is none.
        if !(most - least >= NARROWEST) {
            return None;
        }
        let at = |place: usize| least + (most - least) * place as f64 / (PLACES - 1) as f64;
        let values = |curve: &Curve| std::array::from_fn(|place| curve.at(at(place)));
        let errors = [own, other].map(|curves| curves.iter().map(values).collect());
        Some(Self { range: [least, most], errors })
    }
}

/// The mean difference along the front, every case once: a weight counts in means that are told and in no test, as in a
/// contest. Its parts are the cases, averaged over seeds, and the seeds of each controller, averaged over cases.
fn means(cases: &[OfCase]) -> Means {
    let of_seeds = |who: usize| -> Vec<Along> {
        let seeds = cases.iter().map(|it| it.errors[who].len()).min().unwrap_or(0);
        (0..seeds).map(|seed| mean(cases.iter().map(|it| &it.errors[who][seed]))).collect()
    };
    let of_case = |it: &OfCase| -> Along {
        let [own, other] = it.errors.each_ref().map(|errors| mean(errors.iter()));
        std::array::from_fn(|place| own[place] - other[place])
    };
    let differences: Vec<Along> = cases.iter().map(of_case).collect();
    Means { middle: mean(differences.iter()), parts: vec![differences, of_seeds(0), of_seeds(1)] }
}

/// What the signed ranks of the cases say at each place, lost cases among them: -1 for less error, 1 for more, 0 for
/// nothing significant.
fn signs(cases: &[Along], defeats: &[f64], bands: usize) -> [f64; PLACES] {
    std::array::from_fn(|place| {
        let differences: Vec<f64> =
            cases.iter().map(|it| it[place]).chain(defeats.iter().copied()).collect();
        match SignedRank::of(&differences, CONFIDENCE) {
            Some(it) if it.p <= (1.0 - CONFIDENCE) / bands.max(1) as f64 => {
                if it.estimate < 0.0 {
                    -1.0
                } else {
                    1.0
                }
            }
            _ => 0.0,
        }
    })
}

/// What a band amounts to at the places where something agrees: a side of zero, and a place.
fn dominance([lower, upper]: &Ends, agrees: &dyn Fn(f64, usize) -> bool) -> Dominance {
    let less = (0..PLACES).filter(|it| upper[*it] < 0.0 && agrees(-1.0, *it)).count();
    let more = (0..PLACES).filter(|it| lower[*it] > 0.0 && agrees(1.0, *it)).count();
    match (less, more) {
        (PLACES, _) => Dominance::Dominates,
        (_, PLACES) => Dominance::Dominated,
        (0, 0) => Dominance::Open,
        (_, 0) => Dominance::BetterInPart,
        (0, _) => Dominance::WorseInPart,
        _ => Dominance::Crosses,
    }
}

/// The same where the ranks agree, and nobody is called better who is barred: the controller, and the one compared with.
/// What a bar would take from the band alone is told as that, also where the ranks would have taken it.
fn allowed(ends: &Ends, ranked: &[f64; PLACES], [own, other]: [Option<FrontBar>; 2]) -> Dominance {
    use Dominance::{BetterInPart, Crosses, Dominated, Dominates, Open, WorseInPart};
    let by_band = dominance(ends, &|_, _| true);
    match (by_band, own, other) {
        (Dominates | BetterInPart | Crosses, Some(bar), _) => return Dominance::Barred(bar),
        (Dominated | WorseInPart | Crosses, _, Some(bar)) => return Dominance::OtherBarred(bar),
        _ => {}
    }
    match dominance(ends, &|side, place| side * ranked[place] > 0.0) {
        Open if by_band != Open => Dominance::OpenByRanks,
        found => found,
    }
}

/// Ranges of travel of some cases; none without a case.
fn travel(cases: &[OfCase]) -> Option<Travel> {
    let width = |it: &OfCase| it.range[1] - it.range[0];
    let narrowest = cases.iter().min_by(|one, other| width(one).total_cmp(&width(other)))?;
    let mean = |end: usize| cases.iter().map(|it| it.range[end]).sum::<f64>() / cases.len() as f64;
    Some(Travel {
        mean_deg: [0, 1].map(|end| libm::exp(mean(end))),
        narrowest_deg: narrowest.range.map(libm::exp),
    })
}

#[cfg(test)]
mod tests;
