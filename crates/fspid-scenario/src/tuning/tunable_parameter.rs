//! A place of a scenario that tuning may change.

use super::{TunableGrid, TunableNumbers};
use crate::keyed::check::grid_text;
use crate::setting_path::{NewValue, SettingPath};
use fspid_optimise::Scale;

/// A place that is marked free.
#[derive(Clone, Debug, PartialEq)]
pub struct TunableParameter {
    /// Where it is, as `--set` names it.
    pub path: SettingPath,
    /// What may stand there.
    pub free: Free,
    /// Name of the controller that it belongs to.
    pub(crate) controller: Option<String>,
    /// Bytes of the file that hold the mark; a design has its value there.
    pub(crate) bytes: std::ops::Range<usize>,
}

/// What may stand at a marked place.
#[derive(Clone, Debug, PartialEq)]
pub enum Free {
    /// A number between bounds.
    Number(TunableNumber),
    /// A grid of rules.
    Grid(TunableGrid),
    /// A grid of numbers.
    Numbers(Box<TunableNumbers>),
}

/// A free number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TunableNumber {
    /// Least value.
    pub lower: f64,
    /// Greatest value, above the least.
    pub upper: f64,
    /// How it is spread.
    pub scale: Scale,
    /// Value that is flown where nothing is tuned, and from which a search begins.
    pub start: f64,
}

impl TunableNumber {
    /// Value at `unit` of the way from the lower to the upper bound.
    #[must_use]
    pub fn at(&self, unit: f64) -> f64 {
        self.scale.between(self.lower, self.upper, unit)
    }

    /// How far the start is on the way, from 0 to 1.
    #[must_use]
    pub fn unit(&self) -> f64 {
        self.scale.unit(self.lower, self.upper, self.start)
    }
}

impl TunableParameter {
    /// Name of the controller that it belongs to; none for a place outside of the controllers.
    #[must_use]
    pub fn controller(&self) -> Option<&str> {
        self.controller.as_deref()
    }

    /// Bytes of the file that hold the mark; none for one that came from outside.
    #[must_use]
    pub fn bytes(&self) -> std::ops::Range<usize> {
        self.bytes.clone()
    }

    /// Coordinates of the unit cube that decide what stands there.
    #[must_use]
    pub fn dimensions(&self) -> usize {
        match &self.free {
            Free::Number(_) => 1,
            Free::Grid(grid) => grid.cells().len(),
            Free::Numbers(numbers) => numbers.cells().len(),
        }
    }

    /// Names of the coordinates, for tables.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let path = self.path.text();
        let cells = match &self.free {
            Free::Number(_) => return vec![path.to_owned()],
            Free::Grid(grid) => grid.cells(),
            Free::Numbers(numbers) => numbers.cells(),
        };
        cells.into_iter().map(|(row, column)| format!("{path}[{row}][{column}]")).collect()
    }

    /// The coordinates of the start.
    #[must_use]
    pub fn start(&self) -> Vec<f64> {
        match &self.free {
            Free::Number(number) => vec![number.unit()],
            Free::Grid(_) | Free::Numbers(_) => vec![0.5; self.dimensions()],
        }
    }

    /// What stands there at these coordinates, each from 0 to 1.
    #[must_use]
    pub fn value(&self, unit: &[f64]) -> NewValue {
        match &self.free {
            Free::Number(number) => {
                NewValue::Number(number.at(unit.first().copied().unwrap_or(0.5)))
            }
            Free::Grid(grid) => NewValue::Text(grid_text(&grid.at(unit))),
            Free::Numbers(numbers) => {
                NewValue::Rows(numbers.at(unit).iter().map(|row| row.to_vec()).collect())
            }
        }
    }

    /// The numbers of these coordinates for tables: the value itself, or the labels from -3 to 3.
    #[must_use]
    pub fn numbers(&self, unit: &[f64]) -> Vec<f64> {
        match &self.free {
            Free::Number(number) => vec![number.at(unit.first().copied().unwrap_or(0.5))],
            Free::Grid(grid) => grid.numbers(unit),
            Free::Numbers(numbers) => numbers.numbers(unit),
        }
    }

    /// Values at the ends of what may stand there.
    #[must_use]
    pub fn ends(&self) -> Vec<NewValue> {
        let at = |unit: f64| self.value(&vec![unit; self.dimensions()]);
        vec![at(0.0), at(1.0)]
    }
}
