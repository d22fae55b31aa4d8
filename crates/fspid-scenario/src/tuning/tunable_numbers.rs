//! A grid of numbers that are free, each near to where it starts.

use fspid_fuzzy::{LABEL_COUNT, NumberGrid};

/// Digits of the reach to which a number is rounded, so that a design can be read.
const DIGITS: i32 = 4;
/// Most digits behind the point that make a difference for any number above `1e-15`.
const MOST_DIGITS: i32 = 17;

const LAST: usize = LABEL_COUNT - 1;

/// A free grid of numbers, in the units of the supervisor's range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TunableNumbers {
    /// The grid that a search begins from.
    pub start: NumberGrid<f64>,
    /// How far a cell may move from there; above 0.
    pub reach: f64,
    /// Whether opposite error and change have the same answer: cell (i, j) is cell (6 - i, 6 - j).
    pub symmetric: bool,
}

impl TunableNumbers {
    /// Rows and columns of the cells that are chosen; the others follow from them.
    #[must_use]
    pub fn cells(&self) -> Vec<(usize, usize)> {
        let all = (0..LABEL_COUNT).flat_map(|i| (0..LABEL_COUNT).map(move |j| (i, j)));
        let is_chosen = |&(i, j): &(usize, usize)| {
            !self.symmetric || i * LABEL_COUNT + j <= (LAST - i) * LABEL_COUNT + (LAST - j)
        };
        all.filter(is_chosen).collect()
    }

    /// Least and greatest number of each chosen cell.
    #[must_use]
    pub fn bounds(&self) -> Vec<[f64; 2]> {
        let around = |(i, j): (usize, usize)| {
            let start = self.start[i][j];
            [start - self.reach, start + self.reach]
        };
        self.cells().into_iter().map(around).collect()
    }

    /// The grid at these coordinates, each from 0 to 1; one half is the start's number, and other numbers are
    /// rounded to a few digits of the reach.
    #[must_use]
    pub fn at(&self, unit: &[f64]) -> NumberGrid<f64> {
        let mut grid = self.start;
        for ((i, j), &unit) in self.cells().into_iter().zip(unit) {
            let number = self.moved(self.start[i][j], unit);
            grid[i][j] = number;
            if self.symmetric {
                grid[LAST - i][LAST - j] = number;
            }
        }
        grid
    }

    /// Numbers of the chosen cells.
    #[must_use]
    pub fn numbers(&self, unit: &[f64]) -> Vec<f64> {
        let grid = self.at(unit);
        self.cells().into_iter().map(|(i, j)| grid[i][j]).collect()
    }

    /// True if the start is as symmetric as the mark asks.
    #[must_use]
    #[allow(clippy::float_cmp, reason = "cells that are written alike are the same number")]
    pub fn start_is_allowed(&self) -> bool {
        let is_mirrored =
            |(i, j): (usize, usize)| self.start[i][j] == self.start[LAST - i][LAST - j];
        !self.symmetric || self.cells().into_iter().all(is_mirrored)
    }

    fn moved(&self, start: f64, unit: f64) -> f64 {
        let shift = (2.0 * unit - 1.0) * self.reach;
        if shift == 0.0 {
            return start;
        }
        let digits =
            (DIGITS - 1 - libm::floor(libm::log10(self.reach)) as i32).clamp(0, MOST_DIGITS);
        let number = start + shift;
        let rounded = format!("{number:.*}", digits as usize).parse().unwrap_or(number);
        rounded.clamp(start - self.reach, start + self.reach)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Symmetric numbers, each pair its own.
    fn start() -> NumberGrid<f64> {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let (own, other) = (i * 7 + j, (6 - i) * 7 + (6 - j));
                own.min(other) as f64 / 10.0 - 1.0
            })
        })
    }

    #[test]
    fn a_symmetric_grid_has_25_free_numbers_and_answers_a_fall_as_a_rise() {
        let mark = TunableNumbers { start: start(), reach: 0.5, symmetric: true };
        assert!(mark.start_is_allowed());
        assert_eq!((mark.cells().len(), mark.bounds().len()), (25, 25));
        let unit: Vec<f64> = (0..25).map(|k| f64::from(k) / 24.0).collect();
        let grid = mark.at(&unit);
        for i in 0..7 {
            for j in 0..7 {
                assert_eq!(grid[i][j].to_bits(), grid[6 - i][6 - j].to_bits());
            }
        }
        assert_ne!(grid, start());
    }

    #[test]
    fn one_half_is_the_start_and_the_ends_are_its_reach() {
        let mut uneven = start();
        uneven[0][0] = 1.0 / 3.0;
        let mark = TunableNumbers { start: uneven, reach: 0.5, symmetric: false };
        assert_eq!(mark.cells().len(), 49);
        assert_eq!(mark.at(&[0.5; 49]), uneven);
        let [least, most] = [mark.at(&[0.0; 49]), mark.at(&[1.0; 49])];
        assert!((least[3][3] - (uneven[3][3] - 0.5)).abs() < 1e-15, "{least:?}");
        assert!((most[6][0] - (uneven[6][0] + 0.5)).abs() < 1e-15, "{most:?}");
        assert!(!TunableNumbers { symmetric: true, ..mark }.start_is_allowed());
    }

    #[test]
    fn numbers_that_were_moved_have_few_digits_and_stay_within_their_reach() {
        let mark = TunableNumbers { start: [[1.0 / 3.0; 7]; 7], reach: 0.05, symmetric: false };
        for unit in [0.0, 0.123_456_789, 0.7, 1.0] {
            let number = mark.at(&[unit; 49])[2][2];
            let shift = number - 1.0 / 3.0;
            assert!(shift.abs() <= 0.05 && (shift - (2.0 * unit - 1.0) * 0.05).abs() < 1e-5);
        }
        assert_eq!(mark.at(&[0.7; 49])[0][0].to_string(), "0.35333");
    }
}
