//! Means over flights, and how sure they are: parts of the plants are left out one after the other, with all their flights and
//! with what their gains are to others.

use super::flown::{Treated, Value, Values};
use super::treatment::{COUNT, Treatment};
use crate::contest::beyond;

/// Fewest plants from which an interval is told.
pub(super) const FEWEST: usize = 5;
/// Most parts of the plants, of which one after the other is left out.
const PARTS: usize = 20;
/// Chance that an interval does not hold the number.
const CHANCE: f64 = 0.05;
/// What rounding alone does to a number.
const ROUNDING: f64 = 1e-12;
/// Correlations and shares are no nearer to 1: their transformations end there.
const MOST: f64 = 1.0 - 1e-15;

/// Most parts that so many plants can have.
pub(super) fn most_parts(plants: usize) -> usize {
    plants.min(PARTS)
}

/// The parts of the plants that a number is made of; the others are in none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Parts {
    of: Vec<Option<usize>>,
    /// Of how many plants.
    plants: usize,
}

impl Parts {
    /// Of plants, each with whether it is in the number: what is not in it is no evidence.
    pub(super) fn of(is_in: &[bool]) -> Self {
        let mut plants = 0;
        let part = |is_in: &bool| {
            is_in.then(|| {
                plants += 1;
                (plants - 1) % PARTS
            })
        };
        Self { of: is_in.iter().map(part).collect(), plants }
    }

    /// The part that a plant is in.
    pub(super) fn part(&self, plant: usize) -> Option<usize> {
        self.of.get(plant).copied().flatten()
    }

    /// How many parts are left out; none where there are too few plants for an interval.
    pub(super) fn count(&self) -> usize {
        if self.plants < FEWEST { 0 } else { most_parts(self.plants) }
    }

    pub(super) fn has(&self, plant: usize) -> bool {
        self.part(plant).is_some()
    }
}

/// A number with its interval, which is told for five plants and more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// It holds the number with 95 %.
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

/// How much each plant and each seed counts, 1 or 0.
#[derive(Clone, Debug)]
pub(super) struct Weights {
    pub(super) plants: Vec<f64>,
    pub(super) seeds: Vec<f64>,
    /// The part of the plants that is left out.
    left: Option<usize>,
}

/// What kind of number has an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Any number: a logarithm, a slope.
    Any,
    /// From -1 to 1; its error is that of its hyperbolic arctangent (Fisher).
    Correlation,
    /// From 0 to 1; its error is that of the logarithm of its odds.
    Share,
}

impl Kind {
    /// On a scale on which errors are alike on both sides.
    fn scaled(self, value: f64) -> f64 {
        match self {
            Self::Correlation => libm::atanh(value.clamp(-MOST, MOST)),
            Self::Share => {
                let share = value.clamp(1.0 - MOST, MOST);
                libm::log(share / (1.0 - share))
            }
            Self::Any => value,
        }
    }

    fn unscaled(self, value: f64) -> f64 {
        match self {
            Self::Any => value,
            Self::Correlation => libm::tanh(value),
            Self::Share => 1.0 / (1.0 + libm::exp(-value)),
        }
    }
}

/// What is left out of plants and seeds.
///
/// The plants' part of a number's variance comes from leaving out one part of the plants after the other, parts of unequal
/// sizes allowed for: with $\theta$ of all $n$ plants, $\theta_g$ without the $m_g$ plants of part $g$ of $G$, and
/// $h_g = n / m_g$,
///
/// $$ s^2 = \frac{1}{G} \sum_g \frac{1}{h_g - 1} \left( h_g \theta - (h_g - 1) \theta_g - \bar\theta \right)^2,
/// \quad \bar\theta = G \theta - \sum_g \left( 1 - \frac{m_g}{n} \right) \theta_g $$
///
/// Seeds are left out one by one. Both parts are added; degrees of freedom are Satterthwaite's.
///
/// # Source
/// Busing, Meijer and van der Leeden (1999), "Delete-m jackknife for unequal m", Statistics and Computing 9.
#[derive(Clone, Debug)]
pub(super) struct Draws {
    as_flown: Weights,
    /// Without a part of the plants, with how many of all plants it has, of 1.
    parts: Vec<(f64, Weights)>,
    /// Without a seed.
    seeds: Vec<Weights>,
}

impl Draws {
    /// Of the win, which is flown again without each part of its plants.
    pub(super) fn of_win(parts: &Parts, seeds: usize) -> Self {
        let mut draws = Self::new(parts, seeds);
        for (part, (_, weights)) in draws.parts.iter_mut().enumerate() {
            weights.left = Some(part);
        }
        draws
    }

    /// Of what is not flown again.
    pub(super) fn new(parts: &Parts, seeds: usize) -> Self {
        let plants = parts.of.len();
        let often = |stays: &dyn Fn(usize) -> bool| -> Vec<f64> {
            (0..plants).map(|it| if parts.has(it) && stays(it) { 1.0 } else { 0.0 }).collect()
        };
        let as_flown = Weights { plants: often(&|_| true), seeds: vec![1.0; seeds], left: None };
        let part = |part: usize| {
            let kept = often(&|plant| parts.part(plant) != Some(part));
            let share = 1.0 - kept.iter().sum::<f64>() / parts.plants as f64;
            (share, Weights { plants: kept, ..as_flown.clone() })
        };
        let seed = |seed: usize| {
            let mut without = as_flown.clone();
            without.seeds[seed] = 0.0;
            without
        };
        // Of one seed nobody knows what another would do.
        let left_seeds = if seeds < 2 { 0 } else { seeds };
        let (parts, seeds) = ((0..parts.count()).map(part), (0..left_seeds).map(seed));
        Self { parts: parts.collect(), seeds: seeds.collect(), as_flown }
    }

    /// A number that depends on how much plants and seeds count; `None` where it has no value, and without an interval
    /// where it has none without some of them.
    pub(super) fn estimate(
        &self,
        kind: Kind,
        of: impl Fn(&Weights) -> Option<f64>,
    ) -> Option<Estimate> {
        let finite = |weights: &Weights| of(weights).filter(|value| value.is_finite());
        let value = finite(&self.as_flown)?;
        let middle = kind.scaled(value);
        let interval = self.beyond(middle, |it| finite(it).map(|value| kind.scaled(value)));
        let interval =
            interval.map(|far| [middle - far, middle + far].map(|end| kind.unscaled(end)));
        Some(Estimate { value, interval })
    }

    /// Half of an interval of 95 % about the number that is had of all.
    fn beyond(&self, middle: f64, of: impl Fn(&Weights) -> Option<f64>) -> Option<f64> {
        let parts = self.parts.iter().map(|(share, weights)| Some((*share, of(weights)?)));
        let parts: Vec<(f64, f64)> = parts.collect::<Option<_>>()?;
        let seeds: Vec<f64> = self.seeds.iter().map(&of).collect::<Option<_>>()?;
        if parts.is_empty() {
            return None;
        }
        let variances = [of_parts(middle, &parts), of_seeds(&seeds)];
        let freedoms = [parts.len() as f64 - 1.0, seeds.len().saturating_sub(1).max(1) as f64];
        let whole: f64 = variances.iter().sum();
        let doubts = variances.iter().zip(freedoms).map(|(it, freedom)| it * it / freedom);
        let freedom = whole * whole / doubts.sum::<f64>();
        let far = match freedom >= 1.0 {
            true => beyond(CHANCE, freedom) * libm::sqrt(whole),
            false => 0.0,
        };
        Some(far.max(ROUNDING * (1.0 + middle.abs())))
    }
}

/// The plants' part of a variance, from numbers without a part of them, each with its share of the plants.
fn of_parts(whole: f64, parts: &[(f64, f64)]) -> f64 {
    let count = parts.len() as f64;
    let mean = count * whole - parts.iter().map(|(share, it)| (1.0 - share) * it).sum::<f64>();
    let square = |&(share, without): &(f64, f64)| {
        let times = 1.0 / share;
        let pseudo = times * whole - (times - 1.0) * without;
        (pseudo - mean) * (pseudo - mean) / (times - 1.0)
    };
    parts.iter().map(square).sum::<f64>() / count
}

/// The seeds' part of a variance, from numbers without one of them.
fn of_seeds(seeds: &[f64]) -> f64 {
    let count = seeds.len() as f64;
    let mean = seeds.iter().sum::<f64>() / count;
    let squares = seeds.iter().map(|it| (it - mean) * (it - mean)).sum::<f64>();
    if seeds.is_empty() { 0.0 } else { squares * (count - 1.0) / count }
}

/// Sums over the flights of a plant: of each seed, how far the logarithm is from that of the flight as it is.
#[derive(Clone, Debug, Default)]
struct Sums {
    flights: usize,
    iae: Vec<f64>,
    travel: Vec<f64>,
}

/// Which of a flight's sums.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    Iae,
    Travel,
}

/// Sums over the flights of each plant.
type OfPlants = Vec<[Sums; COUNT]>;

/// The flights of all plants, as far as nobody lost them.
#[derive(Clone, Debug)]
pub(super) struct Means {
    plants: OfPlants,
    /// The same without each part of the plants, whose gains are then in nobody's mean.
    left: Vec<OfPlants>,
    /// Flights that nobody of the chain lost.
    pub(super) kept: usize,
    /// What the win is made of.
    pub(super) chain: Vec<Treatment>,
}

/// What the win is made of: what nobody flew is no part of it; what somebody flew is asked of every flight in it.
fn chain<'a>(flights: impl Iterator<Item = &'a Values> + Clone) -> Vec<Treatment> {
    let flown = |treatment: &Treatment| flights.clone().any(|values| has(values, *treatment));
    Treatment::CHAIN.into_iter().filter(flown).collect()
}

/// Which plants have a flight in the win; of flights, and the plant of each.
pub(super) fn in_the_win(flights: &[Values], of: &[usize], plants: usize) -> Vec<bool> {
    let chain = chain(flights.iter());
    let all = of.iter().copied().zip(flights.iter().cloned());
    let (sums, _) = sums(all, plants, &chain);
    sums.iter().map(|plant| plant[Treatment::AsItIs.place()].flights > 0).collect()
}

impl Means {
    /// Of flights, each with the number of its plant.
    pub(super) fn of(flights: &[(usize, &Treated)], parts: &Parts) -> Self {
        let plants = parts.of.len();
        let chain = chain(flights.iter().map(|(_, flight)| &flight.values));
        let all = flights.iter().map(|(plant, flight)| (*plant, flight.values.clone()));
        let (as_flown, kept) = sums(all, plants, &chain);
        let without = |part: usize| {
            let others = flights.iter().filter(|(plant, _)| parts.part(*plant) != Some(part));
            let others = others.map(|(plant, flight)| (*plant, flight.without(part)));
            sums(others, plants, &chain).0
        };
        Self { plants: as_flown, left: (0..parts.count()).map(without).collect(), kept, chain }
    }

    /// Which plants have a flight among those that a mean is of.
    pub(super) fn plants_of(&self, treatment: Treatment) -> Vec<bool> {
        self.flights_of(treatment).map(|flights| flights > 0).collect()
    }

    /// How many flights of each plant a mean is of.
    pub(super) fn flights_of(&self, treatment: Treatment) -> impl Iterator<Item = usize> {
        self.plants.iter().map(move |plant| plant[treatment.place()].flights)
    }

    /// Mean of how far the logarithm is from that of the flights as they are; `None` where nobody flew so.
    pub(super) fn beyond(
        &self,
        treatment: Treatment,
        quantity: Quantity,
        weights: &Weights,
    ) -> Option<f64> {
        let (mut sum, mut whole) = (0.0, 0.0);
        let plants = weights.left.map_or(Some(&self.plants), |part| self.left.get(part))?;
        for (plant, often) in plants.iter().zip(&weights.plants) {
            let Sums { flights, iae, travel } = &plant[treatment.place()];
            let sums = if quantity == Quantity::Iae { iae } else { travel };
            let drawn = Treatment::DRAWN.contains(&treatment);
            let seed = |place: usize| match drawn {
                true => weights.seeds.get(place).copied().unwrap_or(0.0),
                false => 1.0,
            };
            for (place, part) in sums.iter().enumerate() {
                sum += often * seed(place) * part;
                whole += often * seed(place) * *flights as f64;
            }
        }
        (whole > 0.0).then_some(sum / whole)
    }
}

fn has(values: &Values, treatment: Treatment) -> bool {
    !values[treatment.place()].is_empty()
}

/// Sums of flights, and how many of them nobody of the chain lost.
fn sums(
    flights: impl Iterator<Item = (usize, Values)>,
    plants: usize,
    chain: &[Treatment],
) -> (OfPlants, usize) {
    let mut sums: OfPlants = vec![Default::default(); plants];
    let mut kept = 0;
    for (plant, values) in flights {
        let is_lost = |treatment: Treatment| values[treatment.place()].iter().any(|it| it.lost);
        let Some(&as_it_is) = values[Treatment::AsItIs.place()].first() else { continue };
        let Some(sums) = sums.get_mut(plant) else { continue };
        if chain.iter().any(|it| is_lost(*it) || !has(&values, *it)) {
            continue;
        }
        kept += 1;
        for treatment in Treatment::ALL.into_iter().filter(|it| !is_lost(*it)) {
            sums[treatment.place()].add(&values[treatment.place()], as_it_is);
        }
    }
    (sums, kept)
}

impl Sums {
    fn add(&mut self, values: &[Value], as_it_is: Value) {
        if values.is_empty() {
            return;
        }
        self.flights += 1;
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

    /// All of so many plants.
    fn all_of(plants: usize, seeds: usize) -> Draws {
        Draws::new(&Parts::of(&vec![true; plants]), seeds)
    }

    /// Mean of numbers, one for each plant.
    fn mean(values: &[f64], weights: &Weights) -> Option<f64> {
        let sum: f64 = weights.plants.iter().zip(values).map(|(w, it)| w * it).sum();
        Some(sum / weights.plants.iter().sum::<f64>())
    }

    #[test]
    fn the_interval_of_a_mean_is_students_with_parts_of_any_size() {
        for plants in [5, 16, 20, 23, 60, 144] {
            // As good as drawn.
            let value = |it: usize| (1e4 * (1.0 + libm::sin(1.0 + 12.9898 * it as f64))) % 1.0;
            let values: Vec<f64> = (0..plants).map(value).collect();
            let mean_of_all = values.iter().sum::<f64>() / plants as f64;
            let found = all_of(plants, 1).estimate(Kind::Any, |it| mean(&values, it));
            let found = found.expect("a mean");
            let [lower, upper] = found.interval.expect("enough plants");
            assert!((0.5 * (lower + upper) - mean_of_all).abs() < 1e-12, "{found:?}");
            let square = |it: &f64| (it - mean_of_all) * (it - mean_of_all);
            let squares: f64 = values.iter().map(square).sum();
            let error = libm::sqrt(squares / (plants * (plants - 1)) as f64);
            let far = beyond(0.05, most_parts(plants) as f64 - 1.0) * error;
            // Parts of several plants each scatter as they happen to.
            let near = if plants <= PARTS { 1e-9 } else { 0.5 };
            assert!((0.5 * (upper - lower) / far - 1.0).abs() < near, "{plants}: {found:?} {far}");
        }
        let few = all_of(FEWEST - 1, 1).estimate(Kind::Any, |_| Some(1.0));
        assert!(few.is_some_and(|it| it.interval.is_none()));
    }

    #[test]
    fn the_interval_of_a_correlation_stays_within_one_and_that_of_a_share_within_its_ends() {
        let draws = all_of(5, 1);
        let pairs = [(0.0, 0.1), (1.0, 0.9), (2.0, 2.2), (3.0, 2.9), (4.0, 4.4)];
        let part = |which: usize| {
            let pairs = &pairs;
            move |weights: &Weights| {
                let pairs = pairs.iter().zip(&weights.plants).map(|(&(x, y), w)| (x, y, *w));
                line(pairs).map(|found| found[which])
            }
        };
        let found = draws.estimate(Kind::Correlation, part(0)).expect("a line");
        let [lower, upper] = found.interval.expect("enough plants");
        assert!(-1.0 < lower && lower < found.value && found.value < upper && upper < 1.0);
        let share = |weights: &Weights| {
            let counted = weights.plants.iter().zip([0.1, 0.2, 0.6, 0.9, 0.9]);
            Some(counted.map(|(w, it)| w * it).sum::<f64>() / weights.plants.iter().sum::<f64>())
        };
        let found = draws.estimate(Kind::Share, share).expect("a mean");
        let [lower, upper] = found.interval.expect("enough plants");
        assert!(0.0 < lower && lower < 0.3 && 0.7 < upper && upper < 1.0, "{found:?}");
        // Of what is nothing without some plant, nothing is known.
        let one = draws.estimate(Kind::Share, |weights| Some(0.5 * weights.plants[0]));
        let [lower, upper] = one.and_then(|it| it.interval).expect("enough plants");
        assert!(lower < 1e-9 && upper > 1.0 - 1e-9, "{one:?}");
    }

    /// Seeds that scatter make an interval wider than plants alone do.
    #[test]
    fn seeds_are_in_the_interval() {
        let values = [1.0, 2.0, 3.0, 4.0, 5.0];
        let width = |seeds: usize| {
            let draws = all_of(5, seeds);
            let found = draws.estimate(Kind::Any, |weights| {
                let seeds = weights.seeds.iter().enumerate().map(|(at, w)| w * at as f64);
                let count: f64 = weights.seeds.iter().sum();
                Some(mean(&values, weights)? + 10.0 * seeds.sum::<f64>() / count)
            });
            let [lower, upper] = found.and_then(|it| it.interval).expect("enough plants");
            upper - lower
        };
        assert!(width(3) > 4.0 * width(1), "{} {}", width(3), width(1));
    }
}
