//! Every gain that a self-tuner can produce, as boxes over cells of the supervisor's inputs.
//!
//! The plane of the supervisor's inputs, error and change, is cut into cells. Over each the
//! increments of the three gains are enclosed by interval arithmetic ([`IncrementMap`]); with the
//! nominal gains, the output factors, the law and the gain limits they become a [`GainSet`]: a box
//! of gains for each cell, which holds whatever the controller flies with while its inputs are in
//! the cell, rounding of its own arithmetic included.
//!
//! A set is used in two ways: whole, for gains that move in it as they like ([`GainSet::corners`],
//! [`GainSet::hull`]), and cell by cell, for gains that belong to the inputs ([`GainSet::cones`]).
//! Beside the boxes there are the gains that are really produced at a point ([`producible`],
//! [`grid`]).
//!
//! Symbols: $k'$ nominal gains, $\Delta k$ increments, $s$ output factors, $\lambda$ leakage, $T$
//! sample period.
//!
//! # What is covered
//! The gains of every sample that a controller answers. A sample that it does not believe (not
//! finite, beyond its guard, or overflowing) is answered by its last command, whatever the gains.

mod cones;
mod held;
mod hull;
mod increments;
mod inputs;
mod law;
mod lines;
mod network;
mod numbers;
mod over;
mod produced;
mod reached;
mod slopes;

use fspid_core::Gains;
use fspid_numeric::scalar::Interval;

use crate::remembered::{Remembered, RememberedCorner};
pub use cones::Cone;
pub(crate) use held::{HeldCommand, KnownSlopes};
pub use increments::{IncrementCell, IncrementMap};
pub(crate) use inputs::input_rows;
pub(crate) use lines::Lines;
pub(crate) use over::GainsOver;
pub use produced::{grid, producible};
pub(crate) use reached::MOST_CORNERS;
pub use reached::Reached;
pub use slopes::{IncrementSlopes, NoSlopes};

/// Names of the gains in the order of all arrays here.
const NAMES: [&str; 3] = ["kp", "ki", "kd"];
/// All inputs.
const EVERYWHERE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Why the gains of a self-tuner have no bounds.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoBound {
    /// The accumulating law adds to a gain for ever.
    #[error(
        "{gain} has no bounds: the accumulating law adds to it for as long as the flight lasts; give \
         the law a leakage above 0, or {gain} both gain limits"
    )]
    Accumulating {
        /// Which gain.
        gain: &'static str,
    },
}

/// Every gain that a controller can fly with.
#[derive(Clone, Debug, PartialEq)]
pub struct GainSet {
    /// The nominal gains $k'$.
    pub nominal: Gains<f64>,
    /// The gains at rest, where error and change are zero; under the accumulating law those that it
    /// then tends to.
    pub rest: [Interval; 3],
    /// The gains cell by cell; together the cells fill the plane of the supervisor's inputs.
    pub cells: Vec<GainCell>,
    /// Most that each gain changes by in a second, where that is bounded: not under the memoryless law,
    /// under which gains jump as the inputs do.
    pub rate_per_s: Option<[f64; 3]>,
    /// Of an accumulating law, which combinations of gains within the one cell it reaches, where that is known.
    pub reached: Option<Reached>,
    /// What an accumulating law makes of a held command.
    pub(crate) remembered: Option<Remembered>,
}

/// Gains, and what a held command adds to the gain on the change of the error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeldGains {
    pub(crate) gains: Gains<f64>,
    pub(crate) change_gain: f64,
    /// With the memory of an accumulating law, where something is held.
    pub(crate) remembered: Option<RememberedCorner>,
}

/// The gains over a cell of the supervisor's inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GainCell {
    /// Errors, in supervisor units, at which a gain of the cell may be in force.
    pub error: [f64; 2],
    /// Changes of error, in supervisor units, at which a gain of the cell may be in force.
    pub change: [f64; 2],
    /// Bounds of kp, ki and kd.
    pub gains: [Interval; 3],
    /// Most, either way, that a held command adds to the gain on the change of the error in a sample; what it
    /// adds to the gain on the error stands with kp. 0 where nothing is held.
    pub change_gain: f64,
}

impl GainSet {
    /// The set of a controller with fixed gains: one point, whatever the inputs.
    #[must_use]
    pub fn fixed(gains: Gains<f64>) -> Self {
        let point = array(gains).map(Interval::point);
        Self { rate_per_s: Some([0.0; 3]), ..Self::boxed(gains, point, point) }
    }

    /// The gains of a box, whatever the inputs.
    pub(crate) fn boxed(nominal: Gains<f64>, rest: [Interval; 3], gains: [Interval; 3]) -> Self {
        let cell = GainCell { error: EVERYWHERE, change: EVERYWHERE, gains, change_gain: 0.0 };
        Self { nominal, rest, cells: vec![cell], rate_per_s: None, reached: None, remembered: None }
    }

    /// The part of the set over some of its cells.
    #[must_use]
    pub fn of_cells(&self, cells: &[usize]) -> Self {
        let cells = cells.iter().filter_map(|&cell| self.cells.get(cell).copied()).collect();
        Self { cells, ..self.clone() }
    }

    /// The smallest box that holds the set.
    #[must_use]
    pub fn bounds(&self) -> [Interval; 3] {
        let hull = |one: [Interval; 3], other: [Interval; 3]| {
            let [a, b, c] = one;
            let [d, e, f] = other;
            [a.hull(d), b.hull(e), c.hull(f)]
        };
        let boxes = self.cells.iter().map(|cell| cell.gains);
        boxes.reduce(hull).unwrap_or(array(self.nominal).map(Interval::point))
    }

    /// All of the smallest box that holds the set, whatever the inputs: more gains, and far fewer corners.
    pub(crate) fn bounding_box(&self) -> Self {
        Self::boxed(self.nominal, self.rest, self.bounds())
    }

    /// The corners of every box with the number of its cell; of a box that is flat along a gain
    /// only those that differ. Where it is known which combinations are reached, the corners of that body.
    pub fn corners(&self) -> impl Iterator<Item = (usize, Gains<f64>)> {
        let cells = match &self.reached {
            Some(_) => &[],
            None => &self.cells[..],
        };
        let cells = cells.iter().enumerate();
        let boxes =
            cells.flat_map(|(index, cell)| corners(cell.gains).map(move |corner| (index, corner)));
        let body = self.reached.iter().flat_map(|reached| &reached.corners);
        boxes.chain(body.flat_map(|corner| corners(*corner).map(|corner| (0, corner))))
    }

    /// As [`corners`](Self::corners), each with either end of its cell's change gain.
    pub(crate) fn held_corners(&self) -> impl Iterator<Item = (usize, HeldGains)> {
        let held = self.corners().flat_map(|(index, gains)| {
            let most = self.cells.get(index).map_or(0.0, |cell| cell.change_gain);
            let ends = [-most, most].into_iter().skip(usize::from(most == 0.0));
            ends.map(move |change_gain| (index, HeldGains { gains, change_gain, remembered: None }))
        });
        let corners = self.remembered.map(|remembered| remembered.corners());
        let corners = corners.map_or(vec![None], |corners| corners.into_iter().map(Some).collect());
        held.flat_map(move |(index, held)| {
            let corners = corners.clone().into_iter();
            corners.map(move |remembered| (index, HeldGains { remembered, ..held }))
        })
    }

    /// As [`hull_within`](Self::hull_within), with the change gains: of the cells that have one the largest,
    /// either way.
    pub(crate) fn held_hull(&self, tolerance: f64) -> Vec<HeldGains> {
        let most = self.cells.iter().map(|cell| cell.change_gain).fold(0.0, f64::max);
        let part = |with: bool| -> Vec<Gains<f64>> {
            let cells = self.cells.iter().filter(|cell| (cell.change_gain > 0.0) == with);
            let cells: Vec<GainCell> = cells.copied().collect();
            if cells.is_empty() {
                return Vec::new();
            }
            Self { cells, ..self.clone() }.hull_within(tolerance)
        };
        let plain = |gains| HeldGains { gains, change_gain: 0.0, remembered: None };
        let still = part(false).into_iter().map(plain);
        let held = part(true).into_iter();
        let held = held.flat_map(|gains| {
            [-most, most].map(|change_gain| HeldGains { change_gain, ..plain(gains) })
        });
        let all = still.chain(held);
        let Some(remembered) = self.remembered else { return all.collect() };
        let corners = remembered.corners();
        let with = |held: HeldGains| {
            corners.iter().map(move |corner| HeldGains { remembered: Some(*corner), ..held })
        };
        all.flat_map(with).collect()
    }

    /// Those of the [`corners`](Self::corners) that span the convex hull of all.
    ///
    /// Every corner lies inside or no further outside than $10^{-9}$, measured in halves of the
    /// set's extent along each gain. Computed in ordinary arithmetic: good to look for a
    /// certificate with, while the proof asks all corners.
    #[must_use]
    pub fn hull(&self) -> Vec<Gains<f64>> {
        self.hull_within(0.0)
    }

    /// As [`hull`](Self::hull), but with fewer points: corners may lie outside by the share
    /// `tolerance` of half the set's extent along each gain.
    #[must_use]
    pub fn hull_within(&self, tolerance: f64) -> Vec<Gains<f64>> {
        let corners: Vec<[f64; 3]> = self.corners().map(|(_, corner)| array(corner)).collect();
        hull::spanning(&corners, tolerance).into_iter().map(gains).collect()
    }

    /// True if the gains lie in one of the boxes.
    #[must_use]
    pub fn contains(&self, gains: Gains<f64>) -> bool {
        let inside = |cell: &GainCell| {
            cell.gains.iter().zip(array(gains)).all(|(bounds, gain)| bounds.contains(gain))
        };
        self.cells.iter().any(inside)
            && self.reached.as_ref().is_none_or(|reached| reached.may_hold(array(gains)))
    }
}

/// Up to eight corners of a box.
fn corners(sides: [Interval; 3]) -> impl Iterator<Item = Gains<f64>> {
    let [kp, ki, kd] = sides.map(|side| {
        let other = (!side.is_point()).then_some(side.upper());
        core::iter::once(side.lower()).chain(other)
    });
    kp.flat_map(move |kp| {
        let kd = kd.clone();
        ki.clone().flat_map(move |ki| kd.clone().map(move |kd| Gains { kp, ki, kd }))
    })
}

fn array(gains: Gains<f64>) -> [f64; 3] {
    [gains.kp, gains.ki, gains.kd]
}

fn gains([kp, ki, kd]: [f64; 3]) -> Gains<f64> {
    Gains { kp, ki, kd }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_boxes(boxes: &[[Interval; 3]]) -> GainSet {
        let cell =
            |&gains| GainCell { error: EVERYWHERE, change: EVERYWHERE, gains, change_gain: 0.0 };
        let nominal = Gains { kp: 1.0, ki: 0.5, kd: 0.25 };
        let rest = array(nominal).map(Interval::point);
        GainSet {
            nominal,
            rest,
            cells: boxes.iter().map(cell).collect(),
            rate_per_s: None,
            reached: None,
            remembered: None,
        }
    }

    #[test]
    fn a_box_has_eight_corners_and_a_flat_one_fewer() {
        let (wide, flat) = (Interval::between(1.0, 2.0), Interval::ONE);
        let set = of_boxes(&[[wide; 3], [wide, flat, wide], [flat; 3]]);
        let counts =
            [0, 1, 2].map(|cell| set.corners().filter(|&(found, _)| found == cell).count());
        assert_eq!(counts, [8, 4, 1]);
        assert!(set.corners().all(|(_, corner)| set.contains(corner)));
    }

    #[test]
    fn fixed_gains_are_one_point() {
        let gains = Gains { kp: 2.0, ki: 0.0, kd: -1.0 };
        let set = GainSet::fixed(gains);
        assert_eq!(set.corners().collect::<Vec<_>>(), [(0, gains)]);
        assert_eq!(set.hull(), [gains]);
        assert_eq!(set.bounds(), set.rest);
        assert!(set.contains(gains) && !set.contains(Gains { kd: 0.0, ..gains }));
    }
}
