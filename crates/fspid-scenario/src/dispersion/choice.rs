//! One of several values.

use super::error::DispersionError;

/// A choice among values that somebody else keeps, by their place in the list.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    count: usize,
    /// Sums of the weights up to each value, the last one positive; empty where all weigh the same.
    sums: Vec<f64>,
}

impl Choice {
    /// A choice among `count` values, equally likely or in proportion to weights. A value with
    /// weight 0 never comes.
    ///
    /// # Errors
    /// [`DispersionError`] for no values, another number of weights than of values, weights that
    /// are negative or not finite, and weights whose sum is 0 or not finite.
    pub fn new(count: usize, weights: Option<&[f64]>) -> Result<Self, DispersionError> {
        if count == 0 {
            return Err(DispersionError::NoValues);
        }
        let sums = weights.map_or(Ok(Vec::new()), |weights| sums(count, weights))?;
        Ok(Self { count, sums })
    }

    /// How many values there are.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.count
    }

    /// The share of each value.
    pub fn shares(&self) -> impl Iterator<Item = f64> + '_ {
        let total = self.sums.last().copied();
        (0..self.count).map(move |place| match total {
            Some(total) => {
                let below = place.checked_sub(1).and_then(|it| self.sums.get(it)).copied();
                (self.sums.get(place).copied().unwrap_or(total) - below.unwrap_or(0.0)) / total
            }
            None => 1.0 / self.count as f64,
        })
    }

    /// The place of the value for a coordinate.
    pub(super) fn index(&self, u: f64) -> usize {
        match self.sums.last() {
            // Strictly above, so that a value without weight is passed over.
            Some(total) => {
                let share = u * total;
                self.sums.partition_point(|sum| *sum <= share).min(self.ends()[1])
            }
            None => ((u * self.count as f64) as usize).min(self.count - 1),
        }
    }

    /// The first and the last place that can come.
    pub(super) fn ends(&self) -> [usize; 2] {
        let total = self.sums.last().copied().unwrap_or(0.0);
        let first = self.sums.partition_point(|sum| *sum <= 0.0);
        let last = self.sums.partition_point(|sum| *sum < total);
        if self.sums.is_empty() { [0, self.count - 1] } else { [first, last] }
    }
}

/// Sums of the weights up to each value.
fn sums(count: usize, weights: &[f64]) -> Result<Vec<f64>, DispersionError> {
    if weights.len() != count {
        return Err(DispersionError::Weights { found: weights.len(), allowed: count });
    }
    if let Some(index) = weights.iter().position(|w| !(w.is_finite() && *w >= 0.0)) {
        return Err(DispersionError::Weight { index, value: weights[index] });
    }
    let mut total = 0.0;
    let sums: Vec<f64> = weights
        .iter()
        .map(|weight| {
            total += weight;
            total
        })
        .collect();
    if !(total > 0.0) {
        return Err(DispersionError::NoWeight);
    }
    if !total.is_finite() {
        return Err(DispersionError::BeyondRange { what: "sum of the weights" });
    }
    Ok(sums)
}
