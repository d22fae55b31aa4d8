//! Means over flights, of all of them and without each part of the plants.

use super::draws::{Parts, Weights};
use super::flown::{Treated, Value, Values};
use super::treatment::{COUNT, Treatment};

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
}
