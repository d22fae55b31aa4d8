//! Controllers against one of them: the one that all are compared with, or the first.

use std::cmp::Ordering;

use serde::Serialize;

use super::judged::{Contestant, Count, Judged, Quantity};
use super::signed_rank::SignedRank;
use super::two_way::{TwoWay, holm, mean};

/// Confidence of intervals, and of what is called significant for all comparisons together.
pub(crate) const CONFIDENCE: f64 = 0.95;

/// How a controller stands against the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// It loses a smaller share of its flights; or as many, and its error is significantly smaller over the cases.
    Better,
    /// It loses a larger share of its flights; or as many, and its error is significantly larger over the cases.
    Worse,
    /// The difference is not significant.
    Open,
    /// The one that would be better is barred: it fails too often for that.
    Barred,
}

/// Why a controller is not better than another, whatever its error and however few flights it loses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bar {
    /// Every flight of it fails.
    AllFail,
    /// None of its tunings found anything that was allowed, or fewer did than of the other.
    NotAllowed,
    /// A larger share of its flights is of loops that are unstable at rest.
    Unstable,
    /// The same with those of which nobody can tell.
    Undecided,
    /// It fails more flights, by the signed ranks of the shares that fail of each case.
    FailsMore,
}

/// Why one controller is not called better than another, if it is not. What fails is no success beside what does not,
/// and errors of flights that fail are no measure of success.
pub(crate) fn barred(judged: &Judged, one: usize, other: usize) -> Option<Bar> {
    let all = judged.all();
    let evidence = judged.evidence_between(&[one, other]).into_iter();
    let (one, other) = (judged.contestants.get(one)?, judged.contestants.get(other)?);
    let [mine, theirs] = [one, other].map(|it| judged.count(it, &all));
    if mine.failed == mine.of {
        return Some(Bar::AllFail);
    }
    let [(bad, tunings), (other_bad, other_tunings)] =
        [one, other].map(|it| it.not_allowed().into());
    // Who was not tuned is held to nothing.
    if bad > 0 && (bad == tunings || bad * other_tunings.max(1) > other_bad * tunings) {
        return Some(Bar::NotAllowed);
    }
    if mine.compared(theirs, |it| it.unstable).is_gt() {
        return Some(Bar::Unstable);
    }
    if mine.compared(theirs, Count::not_stable).is_gt() {
        return Some(Bar::Undecided);
    }
    let share = |it: &Contestant, case: usize| judged.count(it, &[case]).failed_share();
    let differences: Vec<f64> =
        evidence.map(|case| share(one, case) - share(other, case)).collect();
    let p = SignedRank::of(&differences, CONFIDENCE).map_or(1.0, |it| it.p);
    let is_more = mine.compared(theirs, |it| it.failed).is_gt();
    (is_more && p <= 1.0 - CONFIDENCE).then_some(Bar::FailsMore)
}

/// A mean ratio over cases and designs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Ratio {
    /// The geometric mean of the ratios of the cases that neither lost; none where there are no such cases.
    #[serde(rename = "ratio")]
    pub mean: Option<f64>,
    /// Its interval; none for fewer than three cases.
    pub interval: Option<[f64; 2]>,
    /// Cases that neither lost.
    pub cases: usize,
}

/// A controller compared with the other in one quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Place of the controller.
    pub contestant: usize,
    /// Cases that are evidence between both: those that they do not fly to a millionth as another, or as one of the tuning.
    pub evidence: usize,
    /// Ratio of the means over all cases and designs; infinite where it lost a flight, none where both did.
    pub ratio_of_means: Option<f64>,
    /// The mean ratio, with an interval that holds together with those of the other controllers.
    pub ratio: Ratio,
    /// The same for each group of cases, with intervals each of its own.
    pub groups: Vec<Ratio>,
    /// Logarithm of the ratio of each case; infinite where one of them lost more of its flights.
    pub(crate) cases: Vec<f64>,
    /// What the cases alone say, in logarithms; the interval each of its own.
    pub typical: Option<SignedRank>,
    /// The larger of the p-values of both tests.
    pub p: f64,
    /// The same after Holm's correction for all controllers.
    pub p_adjusted: f64,
    /// Lost flights of both.
    pub lost: Lost,
    /// How it stands.
    pub standing: Standing,
    /// Whether lost flights decided that.
    pub by_flights: bool,
    /// Whether that is significant, over cases and over tunings; never where each was tuned once.
    pub is_sure: bool,
    /// Whether it is this controller that would be better, and why it is not, where the standing is barred.
    pub(crate) bar: Option<(bool, Bar)>,
}

/// Whether one of two controllers loses more flights.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Lost {
    /// Cases of which one loses a larger share than the other.
    pub cases: usize,
    /// P-value of "no controller loses more", by the signed ranks of the cases.
    pub p: f64,
    /// The same after Holm's correction for all controllers.
    pub p_adjusted: f64,
}

/// Compares everyone with the one whom the scenario names.
pub(crate) fn compared(judged: &Judged, quantity: Quantity) -> Option<Vec<Comparison>> {
    compared_with(judged, quantity, judged.against)
}

/// Compares everyone with one of them; `None` where a value of the quantity is not above 0, so that it has no ratio.
pub(crate) fn compared_with(
    judged: &Judged,
    quantity: Quantity,
    one: usize,
) -> Option<Vec<Comparison>> {
    let reference = judged.contestants.get(one)?;
    if !is_positive(judged, quantity) {
        return None;
    }
    let others = judged.contestants.iter().enumerate().filter(|(at, _)| *at != one);
    let count = judged.contestants.len().saturating_sub(1).max(1);
    // Each interval gives up its share of the doubt, so that all hold together (Bonferroni).
    let together = 1.0 - (1.0 - CONFIDENCE) / count as f64;
    let pair = Pair { judged, quantity, reference: one, theirs: reference };
    let mut all: Vec<Comparison> =
        others.map(|(place, mine)| pair.comparison(place, mine, together)).collect();
    let adjusted = holm(&all.iter().map(|it| it.p).collect::<Vec<_>>());
    let adjusted_lost = holm(&all.iter().map(|it| it.lost.p).collect::<Vec<_>>());
    for (it, (p, p_lost)) in all.iter_mut().zip(adjusted.into_iter().zip(adjusted_lost)) {
        (it.p_adjusted, it.lost.p_adjusted) = (p, p_lost);
        let mine = judged.contestants.get(it.contestant)?;
        pair.stand(mine, it);
    }
    Some(all)
}

fn is_positive(judged: &Judged, quantity: Quantity) -> bool {
    let designs = judged.contestants.iter().flat_map(|it| &it.designs);
    let mut values = designs.flat_map(|design| {
        judged.all().into_iter().map(move |case| judged.value(design, case, quantity))
    });
    values.all(|value| value.is_some_and(|value| value > 0.0))
}

/// What comparisons have in common.
struct Pair<'a> {
    judged: &'a Judged,
    quantity: Quantity,
    /// Place of the one that is compared with.
    reference: usize,
    theirs: &'a Contestant,
}

impl Pair<'_> {
    fn comparison(&self, place: usize, mine: &Contestant, together: f64) -> Comparison {
        let all = self.judged.all();
        let cases: Vec<f64> = all.iter().map(|case| self.case(mine, *case)).collect();
        let evidence = self.judged.evidence_between(&[place, self.reference]);
        let of_evidence: Vec<f64> = evidence.iter().map(|case| self.case(mine, *case)).collect();
        let typical = SignedRank::of(&of_evidence, CONFIDENCE);
        let (over, ratio) = self.ratio(mine, &evidence, together);
        let groups = self.judged.groups();
        let groups = groups.into_iter().map(|mut it| {
            it.cases.retain(|case| evidence.binary_search(case).is_ok());
            self.ratio(mine, &it.cases, CONFIDENCE).1
        });
        let p = match (over, typical) {
            // Two tests that point in different directions have found nothing.
            (Some(over), Some(typical)) if over.estimate * typical.estimate >= 0.0 => {
                over.p().max(typical.p)
            }
            _ => 1.0,
        };
        Comparison {
            contestant: place,
            evidence: evidence.len(),
            ratio_of_means: self.ratio_of_means(mine),
            ratio,
            groups: groups.collect(),
            cases,
            typical,
            p,
            p_adjusted: 1.0,
            lost: self.lost(mine, &evidence),
            standing: Standing::Open,
            by_flights: false,
            is_sure: false,
            bar: None,
        }
    }

    fn lost(&self, mine: &Contestant, evidence: &[usize]) -> Lost {
        let share = |it: &Contestant, case: usize| self.judged.count(it, &[case]).lost_share();
        let difference = |case: usize| share(mine, case) - share(self.theirs, case);
        let differences: Vec<f64> = evidence.iter().copied().map(difference).collect();
        Lost {
            cases: differences.iter().filter(|it| **it != 0.0).count(),
            p: SignedRank::of(&differences, CONFIDENCE).map_or(1.0, |it| it.p),
            p_adjusted: 1.0,
        }
    }

    /// Logarithm of the ratio on a case, averaged over designs.
    fn case(&self, mine: &Contestant, case: usize) -> f64 {
        let [lost_mine, lost_theirs] = [mine, self.theirs].map(|it| self.judged.count(it, &[case]));
        match lost_mine.cmp_lost(lost_theirs) {
            Ordering::Greater => return f64::INFINITY,
            Ordering::Less => return f64::NEG_INFINITY,
            // Both lose as many: nobody is better.
            Ordering::Equal if lost_mine.lost > 0 => return 0.0,
            Ordering::Equal => {}
        }
        let [mine, theirs] = [mine, self.theirs].map(|it| {
            let logarithms = self.logarithms(it, &[case]);
            mean(logarithms.iter().map(|row| row.first().copied().unwrap_or(f64::NAN)))
        });
        let difference = mine - theirs;
        // A cost without a value on either side says nothing of the case.
        if difference.is_nan() { 0.0 } else { difference }
    }

    /// Logarithms of the values, `[design][case]`.
    fn logarithms(&self, of: &Contestant, cases: &[usize]) -> Vec<Vec<f64>> {
        let value = |design, case| self.judged.value(design, case, self.quantity);
        let row = |design| {
            let values = cases.iter().map(|&case| value(design, case).map_or(f64::NAN, libm::log));
            values.collect()
        };
        of.designs.iter().map(row).collect()
    }

    fn ratio(
        &self,
        mine: &Contestant,
        cases: &[usize],
        confidence: f64,
    ) -> (Option<TwoWay>, Ratio) {
        let kept = self.judged.kept([mine, self.theirs].into_iter(), cases);
        let none = (None, Ratio { mean: None, interval: None, cases: kept.len() });
        if kept.is_empty() {
            return none;
        }
        let (a, b) = (self.logarithms(mine, &kept), self.logarithms(self.theirs, &kept));
        let Some(over) = TwoWay::of(&a, &b) else {
            return none;
        };
        let ratio = Ratio {
            mean: Some(libm::exp(over.estimate)),
            interval: over.interval(confidence).map(|ends| ends.map(libm::exp)),
            cases: kept.len(),
        };
        (Some(over), ratio)
    }

    fn ratio_of_means(&self, mine: &Contestant) -> Option<f64> {
        let all = self.judged.all();
        let [mine, theirs] = [mine, self.theirs].map(|it| {
            let means = it.designs.iter().map(|design| {
                self.judged.mean(design, &all, self.quantity).unwrap_or(f64::INFINITY)
            });
            mean(means)
        });
        let ratio = mine / theirs;
        (!ratio.is_nan()).then_some(ratio)
    }

    /// Lost flights come first, whatever the error elsewhere.
    fn stand(&self, mine: &Contestant, found: &mut Comparison) {
        let all = self.judged.all();
        let [lost_mine, lost_theirs] = [mine, self.theirs].map(|it| self.judged.count(it, &all));
        let flights = lost_mine.cmp_lost(lost_theirs);
        found.by_flights = flights.is_ne();
        let p = if found.by_flights { found.lost.p_adjusted } else { found.p_adjusted };
        let is_significant = p <= 1.0 - CONFIDENCE;
        // One tuning each says nothing of what another seed would have found: the p-values are of these designs alone.
        found.is_sure = is_significant && !self.judged.is_tuned_once();
        found.standing = match (flights, found.ratio.mean) {
            (Ordering::Greater, _) => Standing::Worse,
            (Ordering::Less, _) => Standing::Better,
            (Ordering::Equal, Some(ratio)) if is_significant && ratio < 1.0 => Standing::Better,
            (Ordering::Equal, Some(ratio)) if is_significant && ratio > 1.0 => Standing::Worse,
            _ => Standing::Open,
        };
        let bar = match found.standing {
            Standing::Better => barred(self.judged, found.contestant, self.reference),
            Standing::Worse => barred(self.judged, self.reference, found.contestant),
            Standing::Open | Standing::Barred => None,
        };
        if let Some(bar) = bar {
            found.bar = Some((found.standing == Standing::Better, bar));
            (found.standing, found.is_sure) = (Standing::Barred, false);
        }
    }
}

#[cfg(test)]
mod tests;
