//! Means over flights, and how sure they are: plants are drawn anew, and with them their flights.

use super::flown::{Value, Values};
use super::treatment::{COUNT, Treatment};
use crate::draw::Draw;

/// How often plants and seeds are drawn anew.
pub(super) const DRAWS: usize = 2000;
/// Fewest plants from which an interval is told.
pub(super) const FEWEST: usize = 5;
/// Share of the draws beyond each end of an interval.
const BEYOND: f64 = 0.025;
/// Random stream of the draws, behind those of the flights.
const STREAM: u64 = 1 << 40;

/// A number with its interval, which is told for five plants and more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// 95 % of the draws lie in it.
    pub interval: Option<[f64; 2]>,
}

impl Estimate {
    /// The same of a function that keeps the order.
    #[must_use]
    pub fn map(self, of: fn(f64) -> f64) -> Self {
        Self { value: of(self.value), interval: self.interval.map(|ends| ends.map(of)) }
    }

    /// True where the whole interval is above a number; never without one.
    #[must_use]
    pub fn is_above(&self, number: f64) -> bool {
        self.interval.is_some_and(|[lower, _]| lower > number)
    }
}

/// How often each plant and each seed counts.
#[derive(Clone, Debug)]
pub(super) struct Weights {
    pub(super) plants: Vec<f64>,
    pub(super) seeds: Vec<f64>,
}

/// The draws of plants and seeds.
#[derive(Clone, Debug)]
pub(super) struct Draws {
    as_flown: Weights,
    drawn: Vec<Weights>,
}

impl Draws {
    pub(super) fn new(plants: usize, seeds: usize, seed: u64) -> Self {
        let as_flown = Weights { plants: vec![1.0; plants], seeds: vec![1.0; seeds] };
        let drawn = |number: usize| {
            let mut draw = Draw::of(seed, STREAM + number as u64);
            let mut counts = |many: usize| {
                let mut counts = vec![0.0; many];
                for _ in 0..many {
                    counts[draw.below(many)] += 1.0;
                }
                counts
            };
            Weights { plants: counts(plants), seeds: counts(seeds) }
        };
        let count = if plants < FEWEST { 0 } else { DRAWS };
        Self { as_flown, drawn: (0..count).map(drawn).collect() }
    }

    /// A number that depends on how often plants and seeds count; `None` where it has no value, and without an interval
    /// where too many draws have none.
    pub(super) fn estimate(&self, of: impl Fn(&Weights) -> Option<f64>) -> Option<Estimate> {
        let finite = |weights: &Weights| of(weights).filter(|value| value.is_finite());
        let value = finite(&self.as_flown)?;
        let mut drawn: Vec<f64> = self.drawn.iter().filter_map(finite).collect();
        drawn.sort_unstable_by(f64::total_cmp);
        let is_enough =
            !drawn.is_empty() && drawn.len() + self.drawn.len() / 100 >= self.drawn.len();
        let interval =
            is_enough.then(|| [quantile(&drawn, BEYOND), quantile(&drawn, 1.0 - BEYOND)]);
        Some(Estimate { value, interval })
    }
}

/// Of sorted numbers, between neighbours in a straight line.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * (sorted.len().saturating_sub(1)) as f64;
    let below = libm::floor(place);
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "not negative, and less than the length"
    )]
    let index = below as usize;
    let at = |index: usize| sorted.get(index).or(sorted.last()).copied().unwrap_or(f64::NAN);
    at(index) + (place - below) * (at(index + 1) - at(index))
}

/// Sums over the flights of a plant: of each seed, how far the logarithm is from that of the flight as it is.
#[derive(Clone, Debug, Default)]
struct Sums {
    flights: f64,
    iae: Vec<f64>,
    travel: Vec<f64>,
}

/// Which of a flight's sums.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    Iae,
    Travel,
}

/// The flights of all plants, as far as nobody lost them.
#[derive(Clone, Debug)]
pub(super) struct Means {
    plants: Vec<[Sums; COUNT]>,
    /// Flights that nobody of the chain lost.
    pub(super) kept: usize,
    /// What the win is made of.
    pub(super) chain: Vec<Treatment>,
}

impl Means {
    /// Of flights, each with the number of its plant.
    pub(super) fn of(flights: &[(usize, Values)], plants: usize) -> Self {
        let mut sums: Vec<[Sums; COUNT]> = vec![Default::default(); plants];
        // What nobody flew is no part of the chain; what somebody flew is asked of every flight in it.
        let has = |values: &Values, it: Treatment| !values[it.place()].is_empty();
        let chain = Treatment::CHAIN.into_iter();
        let chain: Vec<Treatment> =
            chain.filter(|it| flights.iter().any(|(_, values)| has(values, *it))).collect();
        let mut kept = 0;
        for (plant, values) in flights {
            let is_lost = |treatment: Treatment| values[treatment.place()].iter().any(|it| it.lost);
            let Some(&as_it_is) = values[Treatment::AsItIs.place()].first() else { continue };
            let Some(sums) = sums.get_mut(*plant) else { continue };
            if chain.iter().any(|it| is_lost(*it) || !has(values, *it)) {
                continue;
            }
            kept += 1;
            for treatment in Treatment::ALL.into_iter().filter(|it| !is_lost(*it)) {
                sums[treatment.place()].add(&values[treatment.place()], as_it_is);
            }
        }
        Self { plants: sums, kept, chain }
    }

    /// Mean of how far the logarithm is from that of the flights as they are; `None` where nobody flew so.
    pub(super) fn beyond(
        &self,
        treatment: Treatment,
        quantity: Quantity,
        weights: &Weights,
    ) -> Option<f64> {
        let (mut sum, mut whole) = (0.0, 0.0);
        for (plant, often) in self.plants.iter().zip(&weights.plants) {
            let Sums { flights, iae, travel } = &plant[treatment.place()];
            let sums = if quantity == Quantity::Iae { iae } else { travel };
            let drawn = Treatment::DRAWN.contains(&treatment);
            let seed = |place: usize| match drawn {
                true => weights.seeds.get(place).copied().unwrap_or(0.0),
                false => 1.0,
            };
            for (place, part) in sums.iter().enumerate() {
                sum += often * seed(place) * part;
                whole += often * seed(place) * flights;
            }
        }
        (whole > 0.0).then_some(sum / whole)
    }
}

impl Sums {
    fn add(&mut self, values: &[Value], as_it_is: Value) {
        if values.is_empty() {
            return;
        }
        self.flights += 1.0;
        self.iae.resize(values.len(), 0.0);
        self.travel.resize(values.len(), 0.0);
        for (place, value) in values.iter().enumerate() {
            self.iae[place] += libm::log(value.iae_deg_s / as_it_is.iae_deg_s);
            self.travel[place] += libm::log(value.travel_deg / as_it_is.travel_deg);
        }
    }
}

/// Correlation of pairs, and the slope of the straight line of the second by the first, each pair with its weight.
pub(super) fn line(pairs: impl Iterator<Item = (f64, f64, f64)> + Clone) -> Option<[f64; 2]> {
    let sum = |of: fn((f64, f64, f64)) -> f64| pairs.clone().map(of).sum::<f64>();
    let whole = sum(|(_, _, weight)| weight);
    let (x, y) = (sum(|(x, _, w)| w * x) / whole, sum(|(_, y, w)| w * y) / whole);
    let product =
        |of: fn(f64, f64) -> f64| pairs.clone().map(|(a, b, w)| w * of(a - x, b - y)).sum::<f64>();
    let (xx, yy, xy) = (product(|a, _| a * a), product(|_, b| b * b), product(|a, b| a * b));
    // Rounding alone is no spread.
    let spreads = |squares: f64, mean: f64| squares > 1e-20 * whole * (1.0 + mean * mean);
    (spreads(xx, x) && spreads(yy, y)).then(|| [xy / libm::sqrt(xx * yy), xy / xx])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_through_points_has_their_slope_and_no_line_is_laid_through_equal_ones() {
        let line_of = |pairs: &[(f64, f64, f64)]| line(pairs.iter().copied());
        let found = line_of(&[(0.0, 1.0, 1.0), (1.0, -1.0, 1.0), (3.0, -5.0, 2.0)]);
        assert!(
            found.is_some_and(|[r, slope]| (r + 1.0).abs() < 1e-12 && (slope + 2.0).abs() < 1e-12)
        );
        // Twice the weight is the same point twice.
        let [twice, weighted] = [
            line_of(&[(0.0, 1.0, 1.0), (1.0, 0.0, 1.0), (1.0, 0.0, 1.0), (2.0, 5.0, 1.0)]),
            line_of(&[(0.0, 1.0, 1.0), (1.0, 0.0, 2.0), (2.0, 5.0, 1.0)]),
        ];
        assert_eq!(twice, weighted);
        assert_eq!(line_of(&[(1.0, 1.0, 1.0), (1.0, 2.0, 1.0)]), None);
        assert_eq!(line_of(&[]), None);
    }

    #[test]
    fn intervals_of_a_mean_hold_it_and_shrink_with_the_number_of_plants() {
        let width = |plants: usize| {
            let values: Vec<f64> =
                (0..plants).map(|it| if it % 2 == 0 { 1.0 } else { 3.0 }).collect();
            let draws = Draws::new(plants, 1, 1);
            let mean = |weights: &Weights| {
                let sum: f64 = weights.plants.iter().zip(&values).map(|(w, it)| w * it).sum();
                Some(sum / weights.plants.iter().sum::<f64>())
            };
            let found = draws.estimate(mean).expect("a mean");
            let [lower, upper] = found.interval.expect("enough plants");
            assert!(found.value == 2.0 && lower < 2.0 && upper > 2.0, "{found:?}");
            upper - lower
        };
        // Of n draws the standard deviation is 1 / sqrt(n): about 3.92 times it.
        let [few, many] = [width(16), width(144)];
        assert!(
            (few - 3.92 / 4.0).abs() < 0.15 && (many - 3.92 / 12.0).abs() < 0.05,
            "{few} {many}"
        );
        assert!(
            Draws::new(FEWEST - 1, 1, 1)
                .estimate(|_| Some(1.0))
                .is_some_and(|it| it.interval.is_none())
        );
    }
}
