//! What quantiles and histograms ask of a column in ascending order.

use super::Sorted;

/// Finite values in ascending order, known exactly or each within bounds.
pub trait Ordered {
    /// How many values.
    fn count(&self) -> usize;

    /// The value at a place from 0, or the best guess of it.
    fn at(&self, place: usize) -> Option<f64>;

    /// What the value at a place is at least and at most.
    fn bounds(&self, place: usize) -> Option<[f64; 2]>;

    /// How many values are below `edge`, or the best guess of it; those that are equal to it too if `or_equal`.
    fn below(&self, edge: f64, or_equal: bool) -> usize;
}

impl Ordered for Sorted {
    fn count(&self) -> usize {
        self.values().len()
    }

    fn at(&self, place: usize) -> Option<f64> {
        self.values().get(place).copied()
    }

    fn bounds(&self, place: usize) -> Option<[f64; 2]> {
        self.at(place).map(|value| [value, value])
    }

    fn below(&self, edge: f64, or_equal: bool) -> usize {
        self.values().partition_point(|&value| value < edge || (or_equal && value <= edge))
    }
}
