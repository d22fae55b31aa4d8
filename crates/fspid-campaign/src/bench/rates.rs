//! What repeated rounds of the same work say of its rate.

use crate::statistics::Sorted;
use crate::statistics::quantile::quantile;

/// Rates of the rounds, 1/s.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    of_rounds: Vec<f64>,
    sorted: Sorted,
}

impl Rates {
    pub(super) fn new(of_rounds: Vec<f64>) -> Self {
        let sorted = Sorted::of(&of_rounds);
        Self { of_rounds, sorted }
    }

    /// In the order of the rounds, 1/s.
    #[must_use]
    pub fn of_rounds(&self) -> &[f64] {
        &self.of_rounds
    }

    /// What half of the rounds reached, 1/s.
    #[must_use]
    pub fn median_per_s(&self) -> f64 {
        self.at(0.5)
    }

    /// What three in four rounds reached, 1/s.
    #[must_use]
    pub fn lower_quartile_per_s(&self) -> f64 {
        self.at(0.25)
    }

    /// What one in four rounds reached, 1/s.
    #[must_use]
    pub fn upper_quartile_per_s(&self) -> f64 {
        self.at(0.75)
    }

    /// The best round, 1/s: what the machine does when nothing else runs on it.
    #[must_use]
    pub fn best_per_s(&self) -> f64 {
        self.at(1.0)
    }

    /// From the lower to the upper quartile, of the median, %.
    #[must_use]
    pub fn spread_pct(&self) -> f64 {
        let between = self.upper_quartile_per_s() - self.lower_quartile_per_s();
        100.0 * between / self.median_per_s()
    }

    /// How many times the other's rate, round by round: the median of the rounds' own ratios, so that what
    /// slows a round down as a whole does not count.
    #[must_use]
    pub fn times(&self, other: &Self) -> f64 {
        let ratios =
            self.of_rounds.iter().zip(&other.of_rounds).map(|(mine, theirs)| mine / theirs);
        Self::new(ratios.collect()).median_per_s()
    }

    fn at(&self, share: f64) -> f64 {
        quantile(&self.sorted, share).unwrap_or(f64::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spread_is_what_lies_between_the_quartiles_in_per_cent_of_the_median() {
        let rates = Rates::new(vec![5.0, 1.0, 4.0, 2.0, 3.0]);
        assert_eq!((rates.median_per_s(), rates.best_per_s()), (3.0, 5.0));
        assert_eq!((rates.lower_quartile_per_s(), rates.upper_quartile_per_s()), (2.0, 4.0));
        assert!((rates.spread_pct() - 200.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_round_that_is_slow_as_a_whole_does_not_change_the_ratio() {
        let scalar = Rates::new(vec![10.0, 2.0, 10.0]);
        let batch = Rates::new(vec![40.0, 8.0, 40.0]);
        assert_eq!(batch.times(&scalar), 4.0);
    }
}
