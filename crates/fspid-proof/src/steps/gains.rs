//! The gains that a controller can have where its supervisor's inputs lie between bounds.

use core::cell::RefCell;

use fspid_core::Fspid;
use fspid_core::equations::TunerEquations;
use fspid_fuzzy::system::System;
use fspid_numeric::scalar::Interval;

use crate::gain_set::{GainCell, GainSet, GainsOver};

/// Gains by what the supervisor sees.
pub(super) struct SeenGains<'a> {
    /// The same for any bounds of the inputs, where the law has no memory.
    over: Option<RefCell<Asked<'a>>>,
    /// Whose gains are asked for.
    of: Option<(&'a Fspid<f64>, Option<&'a System>)>,
    /// Cells row by row: those of a row have the errors that stand beside them.
    rows: Vec<([f64; 2], Vec<GainCell>)>,
    /// None for fixed gains.
    equations: Option<TunerEquations<f64>>,
    rest: [Interval; 3],
}

/// Boxes are asked for so much wider, in supervisor units and of their own width, so that the next samples lie within them.
const WIDER: f64 = 0.004;
const OF_WIDTH: f64 = 0.1;

/// Gains that are enclosed as they are asked for, with what was asked last.
struct Asked<'a> {
    gains: GainsOver<'a>,
    last: Option<([Interval; 2], [Interval; 3])>,
}

impl Asked<'_> {
    fn over(&mut self, inputs: [Interval; 2]) -> Option<[Interval; 3]> {
        let holds = |asked: &[Interval; 2]| {
            let mut sides = asked.iter().zip(&inputs);
            sides.all(|(asked, input)| {
                asked.encloses(*input) && asked.width() <= 2.0 * (input.width() + 2.0 * WIDER)
            })
        };
        if let Some((_, gains)) = self.last.as_ref().filter(|(asked, _)| holds(asked)) {
            return Some(*gains);
        }
        let wider = inputs.map(|input| {
            let more = WIDER + OF_WIDTH * input.width();
            Interval::new(input.lower() - more, input.upper() + more).unwrap_or(input)
        });
        // Beyond the range a supervisor may refuse what is wider, and answer what is asked.
        let (asked, found) = match self.gains.over(wider) {
            Some(found) => (wider, found),
            None => (inputs, self.gains.over(inputs)?),
        };
        self.last = Some((asked, found));
        Some(found)
    }
}

/// Gains between bounds, and some of them that the whole set has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Between {
    pub(super) middle: [f64; 3],
    /// How far from these they may be.
    pub(super) radius: [f64; 3],
}

impl Between {
    /// All of a box.
    pub(super) fn holding(bounds: [Interval; 3]) -> Self {
        around(bounds.map(Interval::midpoint), bounds)
    }

    /// True where a gain may be zero.
    pub(super) fn may_be_zero(&self, gain: usize) -> bool {
        self.radius[gain] >= self.middle[gain].abs()
    }
}

fn asked<'a>((fspid, system): (&'a Fspid<f64>, Option<&'a System>)) -> Option<RefCell<Asked<'a>>> {
    let gains = GainsOver::of(fspid.tuner(), system)?;
    Some(RefCell::new(Asked { gains, last: None }))
}

/// With nothing asked yet.
impl Clone for SeenGains<'_> {
    fn clone(&self) -> Self {
        let Self { of, ref rows, equations, rest, .. } = *self;
        Self { over: of.and_then(asked), of, rows: rows.clone(), equations, rest }
    }
}

impl<'a> SeenGains<'a> {
    pub(super) fn of(
        set: &GainSet,
        fspid: Option<&'a Fspid<f64>>,
        system: Option<&'a System>,
    ) -> Self {
        let mut rows: Vec<([f64; 2], Vec<GainCell>)> = Vec::new();
        for cell in &set.cells {
            match rows.last_mut() {
                Some((error, row)) if same_side(*error, cell.error) => row.push(*cell),
                _ => rows.push((cell.error, vec![*cell])),
            }
        }
        let equations = fspid.map(|fspid| *fspid.tuner_equations());
        let of = fspid.map(|fspid| (fspid, system));
        Self { over: of.and_then(asked), of, rows, equations, rest: set.rest }
    }

    /// Forgets what was asked, so that a set of flights does not depend on those before.
    pub(super) fn forget(&self) {
        if let Some(over) = &self.over {
            over.borrow_mut().last = None;
        }
    }

    /// The gains at rest.
    pub(super) fn at_rest(&self) -> Between {
        around(self.rest.map(Interval::midpoint), self.rest)
    }

    /// The gains for errors, rad, and changes of them, rad per sample.
    pub(super) fn seen(&self, error: Interval, change: Interval) -> Option<Between> {
        let Some(equations) = &self.equations else { return Some(self.at_rest()) };
        let n = equations.numbers.map(|number| Interval::point(*number));
        let error = n.sign * (n.error_per_rad * error);
        let change = n.sign * (n.change_per_rad * (change / n.change_divisor));
        let meets =
            |side: [f64; 2], seen: Interval| side[0] <= seen.upper() && side[1] >= seen.lower();
        let middle = [error.midpoint(), change.midpoint()];
        let mut found: Option<Found> = None;
        for (_, row) in self.rows.iter().filter(|(side, _)| meets(*side, error)) {
            for cell in row.iter().filter(|cell| meets(cell.change, change)) {
                let off = beyond(cell.error, middle[0]) + beyond(cell.change, middle[1]);
                found = Some(match found {
                    None => Found { hull: cell.gains, nearest: cell.gains, off },
                    Some(before) => before.with(cell.gains, off),
                });
            }
        }
        let Found { hull, nearest, .. } = found?;
        let over = self.over.as_ref().and_then(|over| over.borrow_mut().over([error, change]));
        let Some(over) = over else {
            return Some(around(nearest.map(Interval::midpoint), hull));
        };
        // Middles are gains that the whole set has: the norm is proved to fall for these.
        let middle = [0, 1, 2].map(|gain: usize| {
            let [lower, upper] = [nearest[gain].lower(), nearest[gain].upper()];
            over[gain].midpoint().clamp(lower, upper)
        });
        Some(around(middle, over))
    }
}

fn same_side(one: [f64; 2], other: [f64; 2]) -> bool {
    one.map(f64::to_bits) == other.map(f64::to_bits)
}

/// Cells that were met.
struct Found {
    hull: [Interval; 3],
    /// The gains of the cell that is nearest to the middle, and how far it is off.
    nearest: [Interval; 3],
    off: f64,
}

impl Found {
    fn with(self, gains: [Interval; 3], off: f64) -> Self {
        let hull = [0, 1, 2].map(|gain: usize| self.hull[gain].hull(gains[gain]));
        if off < self.off {
            return Self { hull, nearest: gains, off };
        }
        Self { hull, ..self }
    }
}

/// How far a number is from a side.
fn beyond([lower, upper]: [f64; 2], value: f64) -> f64 {
    (lower - value).max(value - upper).max(0.0)
}

fn around(middle: [f64; 3], bounds: [Interval; 3]) -> Between {
    let radius =
        [0, 1, 2].map(|gain: usize| (bounds[gain] - Interval::point(middle[gain])).magnitude());
    Between { middle, radius }
}

#[cfg(test)]
mod tests;
