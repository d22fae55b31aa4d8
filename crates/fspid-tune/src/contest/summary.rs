//! What one controller came to.

use fspid_campaign::statistics::binomial::clopper_pearson;
use serde::Serialize;

use super::compare::CONFIDENCE;
use super::flight::{IAE, OVERSHOOT};
use super::judged::{Contestant, Count, Judged, Quantity};

/// Median and quartiles over the designs; infinite where flights are lost.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// A quarter of the designs is below.
    #[serde(rename = "lower_quartile")]
    pub lower: f64,
    /// Half of them is below.
    pub median: f64,
    /// Three quarters are below.
    #[serde(rename = "upper_quartile")]
    pub upper: f64,
}

/// How alike cases and their mirror images are flown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror {
    /// Largest relative difference of the error integral over pairs, designs and runs: the larger by the smaller,
    /// less 1; infinite where one of both is lost.
    pub error: f64,
    /// Largest difference of the overshoot, in points of a per cent; none where no pair has a step.
    pub overshoot_pct: Option<f64>,
    /// Place of the mirrored case that the difference of the error is from.
    pub case: usize,
}

/// What one controller came to on some cases.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Spread over designs of the mean over the cases, in the order of [`MEASURES`](super::MEASURES), then of the
    /// cost; none without values.
    pub spreads: Vec<Option<Spread>>,
    /// The same on the cases that nobody lost a flight of.
    pub kept: Vec<Option<Spread>>,
    /// Lost and failed flights.
    pub count: Count,
}

/// What one controller came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// On all cases.
    pub whole: Part,
    /// On each group.
    pub groups: Vec<Part>,
    /// On each case.
    pub cases: Vec<Part>,
    /// Interval of the probability that a flight of another case like these is lost, over cases; seeds are as they were found.
    pub lost: [f64; 2],
    /// The same of the probability that it fails.
    pub failed: [f64; 2],
    /// How alike mirrored cases are flown; none where there are none.
    pub mirror: Option<Mirror>,
}

impl Part {
    /// The spread of a quantity.
    #[must_use]
    pub fn spread(&self, quantity: Quantity) -> Option<Spread> {
        let place = Quantity::all().position(|it| it == quantity)?;
        self.spreads.get(place).copied().flatten()
    }

    /// The spread of a quantity on the cases that nobody lost a flight of.
    #[must_use]
    pub fn kept_spread(&self, quantity: Quantity) -> Option<Spread> {
        let place = Quantity::all().position(|it| it == quantity)?;
        self.kept.get(place).copied().flatten()
    }
}

impl Summary {
    pub(crate) fn of(judged: &Judged, place: usize) -> Self {
        let contestant = &judged.contestants[place];
        let part = |cases: &[usize]| part(judged, contestant, cases);
        let whole = part(&judged.all());
        Self {
            lost: interval(judged, place, Count::lost_share),
            failed: interval(judged, place, Count::failed_share),
            groups: judged.groups().iter().map(|group| part(&group.cases)).collect(),
            cases: judged.all().into_iter().map(|case| part(&[case])).collect(),
            mirror: mirror(judged, contestant),
            whole,
        }
    }
}

/// Draws and designs of a case fail together, so that each case counts as one flight, a share of which fails: Clopper and
/// Pearson's interval, its lower end that of as many whole cases as have failed at least, its upper end of those at most.
/// Shares scatter less than whole cases do, so that the interval is somewhat too wide rather than too narrow.
fn interval(judged: &Judged, place: usize, share: fn(Count) -> f64) -> [f64; 2] {
    let cases = judged.evidence_between(&[place]);
    let of = cases.len() as u64;
    let shares = cases.iter().map(|case| share(judged.count(&judged.contestants[place], &[*case])));
    let sum: f64 = shares.sum();
    // Of a sum that rounding moved off a whole number, the number is meant.
    let whole = [libm::floor(sum + 1e-9), libm::ceil(sum - 1e-9)];
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and the number of cases"
    )]
    let ends = whole.map(|failed| {
        clopper_pearson((failed.max(0.0) as u64).min(of), of, CONFIDENCE).unwrap_or([0.0, 1.0])
    });
    [ends[0][0], ends[1][1]]
}

fn part(judged: &Judged, contestant: &Contestant, cases: &[usize]) -> Part {
    let spread_of = |cases: &[usize], quantity| {
        let designs = contestant.designs.iter();
        let values: Vec<f64> =
            designs.filter_map(|design| judged.mean(design, cases, quantity)).collect();
        spread(values)
    };
    let kept = judged.kept(judged.contestants.iter(), cases);
    Part {
        spreads: Quantity::all().map(|quantity| spread_of(cases, quantity)).collect(),
        kept: Quantity::all().map(|quantity| spread_of(&kept, quantity)).collect(),
        count: judged.count(contestant, cases),
    }
}

/// Quartiles by linear interpolation (Hyndman and Fan, definition 7), with infinite values as the largest.
fn spread(mut values: Vec<f64>) -> Option<Spread> {
    values.sort_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    let at = |share: f64| {
        let place = last as f64 * share;
        let below = place.floor();
        let (low, high) = (values[below as usize], values[(below as usize + 1).min(last)]);
        // Infinity less infinity is no number.
        let part = place - below;
        let is_one = part <= 0.0 || low.total_cmp(&high).is_eq();
        if is_one { low } else { low + part * (high - low) }
    };
    Some(Spread { lower: at(0.25), median: at(0.5), upper: at(0.75) })
}

fn mirror(judged: &Judged, contestant: &Contestant) -> Option<Mirror> {
    let mut worst: Option<Mirror> = None;
    for (case, mirrored) in
        judged.cases.iter().enumerate().filter_map(|(at, it)| Some((at, it.mirror_of?)))
    {
        for design in &contestant.designs {
            let pairs = judged.flights(design, case).iter().zip(judged.flights(design, mirrored));
            for (one, other) in pairs {
                let values = |measure: usize| {
                    let of = |flight: &super::Flight| flight.counted.get(measure).copied();
                    Some((of(one)??, of(other)??))
                };
                let error = values(IAE).map_or(f64::INFINITY, |(a, b)| unlike(a, b));
                let overshoot = values(OVERSHOOT).map(|(a, b)| difference(a, b));
                let so_far = worst.get_or_insert(Mirror { error, overshoot_pct: None, case });
                if error > so_far.error {
                    (so_far.error, so_far.case) = (error, case);
                }
                let most = so_far.overshoot_pct.into_iter().chain(overshoot);
                so_far.overshoot_pct = most.reduce(f64::max);
            }
        }
    }
    worst
}

/// By how much the larger is more than the smaller.
fn unlike(a: f64, b: f64) -> f64 {
    if a.total_cmp(&b).is_eq() {
        return 0.0;
    }
    let (smaller, larger) = if a < b { (a, b) } else { (b, a) };
    larger / smaller - 1.0
}

fn difference(a: f64, b: f64) -> f64 {
    if a.total_cmp(&b).is_eq() { 0.0 } else { (a - b).abs() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lost_design_is_the_worst_of_the_spread_and_not_out_of_it() {
        let found = spread(vec![f64::INFINITY, 1.0, 2.0, 3.0, 4.0]).expect("values");
        assert_eq!(found, Spread { lower: 2.0, median: 3.0, upper: 4.0 });
        let found = spread(vec![f64::INFINITY, 1.0]).expect("values");
        assert_eq!((found.lower, found.median), (f64::INFINITY, f64::INFINITY));
        assert_eq!(spread(Vec::new()), None);
    }

    #[test]
    fn both_directions_lost_are_flown_alike_and_one_is_not() {
        assert_eq!(unlike(f64::INFINITY, f64::INFINITY), 0.0);
        assert_eq!(unlike(1.0, f64::INFINITY), f64::INFINITY);
        assert_eq!(unlike(4.0, 5.0), 0.25);
    }
}
