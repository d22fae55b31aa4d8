//! Tables: finding a value between breakpoints, and reading a grid there.

use crate::model::Model;
use crate::number::Number;

/// Breakpoints and the variable that is found between them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Axis {
    pub(crate) slot: usize,
    /// Rising, at least two.
    pub(crate) points: Vec<f64>,
    /// Where the variable is held.
    pub(crate) min: f64,
    pub(crate) max: f64,
}

/// Values on a grid.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Grid {
    pub(crate) axes: Vec<usize>,
    /// Distance of neighbours along each axis.
    pub(crate) strides: Vec<usize>,
    pub(crate) values: Vec<f64>,
}

/// Between which breakpoints a variable is, and how far from the first to the second.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Location<N> {
    pub(crate) cell: usize,
    pub(crate) part: N,
}

/// Range of a variable in which every table that it enters has values.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// Index of the variable in [`Model::variables`].
    pub variable: usize,
    /// Lower end, in the units of the variable.
    pub min: f64,
    /// Upper end, in the units of the variable.
    pub max: f64,
}

impl Axis {
    /// Where a value is; held at the limits first. A NaN stays one.
    ///
    /// $$ t = \frac{x - x_i}{x_{i+1} - x_i} $$
    /// with the first cell for what lies before the breakpoints and the last for what lies behind.
    pub(crate) fn locate<N: Number>(&self, value: N) -> Location<N> {
        let value = limited(value, self.min, self.max);
        let at = value.value();
        let above = self.points.partition_point(|&point| point <= at);
        let cell = above.saturating_sub(1).min(self.points.len().saturating_sub(2));
        let (low, high) = match self.points.get(cell..) {
            Some(&[low, high, ..]) => (low, high),
            _ => (0.0, 1.0),
        };
        Location { cell, part: (value - N::constant(low)) / N::constant(high - low) }
    }
}

/// A value held between limits; a NaN stays one.
pub(crate) fn limited<N: Number>(value: N, min: f64, max: f64) -> N {
    if value.value() < min {
        N::constant(min)
    } else if value.value() > max {
        N::constant(max)
    } else {
        value
    }
}

impl Grid {
    /// Value at locations along all axes, linear along each.
    pub(crate) fn read<N: Number>(&self, locations: &[Location<N>]) -> N {
        self.along(0, 0, locations)
    }

    /// Value from one axis on, at an index along the axes before.
    fn along<N: Number>(&self, axis: usize, index: usize, locations: &[Location<N>]) -> N {
        let place = self.axes.get(axis).and_then(|&axis| locations.get(axis));
        let (Some(place), Some(&stride)) = (place, self.strides.get(axis)) else {
            return N::constant(self.values.get(index).copied().unwrap_or(f64::NAN));
        };
        let low = index + place.cell * stride;
        between(
            self.along(axis + 1, low, locations),
            self.along(axis + 1, low + stride, locations),
            place.part,
        )
    }
}

/// Point on the line through two values: exactly the first at 0, the second at 1, and never outside of them between.
///
/// $$ a + t (b - a) \ \text{for}\ t < \tfrac{1}{2}, \quad b - (1 - t)(b - a) \ \text{else} $$
fn between<N: Number>(low: N, high: N, part: N) -> N {
    let rise = high - low;
    if part.value() < 0.5 { low + part * rise } else { high - (N::one() - part) * rise }
}

impl Model {
    /// For each variable that enters tables the range in which all of them have values.
    ///
    /// Outside a table holds the value at its end or goes on straight, as the file says.
    #[must_use]
    pub fn bounds(&self) -> Vec<Bounds> {
        let mut bounds: Vec<Bounds> = Vec::new();
        for axis in &self.axes {
            let ends = (axis.points.first().copied(), axis.points.last().copied());
            let min = axis.min.max(ends.0.unwrap_or(f64::NEG_INFINITY));
            let max = axis.max.min(ends.1.unwrap_or(f64::INFINITY));
            match bounds.iter_mut().find(|known| known.variable == axis.slot) {
                Some(known) => (known.min, known.max) = (known.min.max(min), known.max.min(max)),
                None => bounds.push(Bounds { variable: axis.slot, min, max }),
            }
        }
        bounds
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_numeric::scalar::Dual;
    use proptest::prelude::*;

    fn axis(points: &[f64]) -> Axis {
        Axis { slot: 0, points: points.to_vec(), min: points[0], max: points[points.len() - 1] }
    }

    fn plane() -> (Vec<Axis>, Grid) {
        let axes = vec![axis(&[0.0, 1.0, 3.0]), axis(&[-1.0, 2.0])];
        let values = vec![0.0, 0.7, 0.1, -0.3, 5.0, 0.2];
        (axes, Grid { axes: vec![0, 1], strides: vec![2, 1], values })
    }

    fn read(x: f64, y: f64) -> f64 {
        let (axes, grid) = plane();
        grid.read(&[axes[0].locate(x), axes[1].locate(y)])
    }

    #[test]
    fn a_grid_answers_its_own_values_at_its_nodes() {
        let (axes, grid) = plane();
        for (i, &x) in axes[0].points.iter().enumerate() {
            for (j, &y) in axes[1].points.iter().enumerate() {
                assert_eq!(read(x, y).to_bits(), grid.values[2 * i + j].to_bits());
            }
        }
    }

    #[test]
    fn beyond_the_ends_the_value_is_held() {
        assert_eq!(read(-5.0, -1.0), read(0.0, -1.0));
        assert_eq!(read(9.0, 7.0), read(3.0, 2.0));
        assert!(read(f64::NAN, 0.0).is_nan());
    }

    #[test]
    fn a_table_that_goes_on_goes_on_straight() {
        let open = Axis { max: f64::INFINITY, ..axis(&[0.0, 1.0, 3.0]) };
        let grid = Grid { axes: vec![0], strides: vec![1], values: vec![0.0, 1.0, 2.0] };
        assert_eq!(grid.read(&[open.locate(5.0)]), 3.0);
        assert_eq!(grid.read(&[open.locate(-5.0)]), 0.0);
    }

    #[test]
    fn a_derivative_is_the_slope_of_the_cell() {
        let (axes, grid) = plane();
        let [x, y] = Dual::variables([2.0, -1.0]);
        let found = grid.read(&[axes[0].locate(x), axes[1].locate(y)]);
        assert!((found.derivative[0] - 2.45).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn between_nodes_a_value_is_between_those_of_the_corners(x in 0.0..3.0, y in -1.0..2.0) {
            let (axes, grid) = plane();
            let place = (axes[0].locate(x), axes[1].locate(y));
            let corner = 2 * place.0.cell;
            let corners = &grid.values[corner..corner + 4];
            let low = corners.iter().copied().fold(f64::INFINITY, f64::min);
            let high = corners.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let found = grid.read(&[place.0, place.1]);
            prop_assert!(low <= found && found <= high);
        }

        #[test]
        fn a_point_on_a_line_is_never_outside(a in -1e9..1e9, b in -1e9..1e9, part in 0.0..=1.0) {
            let found = between::<f64>(a, b, part);
            prop_assert!(a.min(b) <= found && found <= a.max(b));
        }
    }
}
