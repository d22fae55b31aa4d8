//! How far a bilinear table can be off its supervisor, by interval arithmetic and branch and bound.
//!
//! Over a box with the middle m the difference $D = T - S$ of the table and the supervisor, in sides of a cell, lies in
//!
//! $$ D(m) + \sum_i \left( \frac{\partial T}{\partial x_i}(X) - \frac{\partial S}{\partial x_i}(X) \right) (X_i - m_i), $$
//!
//! where the supervisor's slopes are enclosed by [`Reach`] and the table's by its ends: where the surface is smooth, few boxes
//! are needed. Boxes in which the difference can be larger than what was seen somewhere are halved.

use fspid_core::fuzzy::Supervisor;
use fspid_fuzzy::audit::Reach;
use fspid_fuzzy::system::{Parts, System};
use fspid_numeric::scalar::Interval;

use super::{SurfaceTable, infer};

/// The bound may be larger than a difference that was seen by this share.
const TOLERANCE: f64 = 0.03;
/// Boxes are halved so often along both inputs; those that are left count as they are enclosed.
const HALVINGS: u32 = 10;
/// Differences are looked at in so many places along both sides of a cell before the proof begins.
const LOOKS: usize = 4;
/// What a value at a point of the grid may be off where rules conclude numbers, as a share of the range: two products and
/// a sum of 64 bits round by far less.
const ROUNDING: f64 = 1.0 / (1_u64 << 40) as f64;

pub(super) struct Found {
    pub(super) bounds: [f64; 3],
    pub(super) boxes: u64,
}

/// The largest differences of the interpolation in real numbers from the supervisor in real numbers.
pub(super) fn of(table: &SurfaceTable, supervisor: &Supervisor<f64>) -> Found {
    if supervisor.numbers().is_some() {
        // Bilinear between the centres of its sets, all of which are points of the table.
        let rounded = |k: usize| {
            let largest = table.values.iter().map(|value| f64::from(value[k].abs()));
            largest.fold(0.0, f64::max) * super::UNIT + supervisor.range() * ROUNDING
        };
        return Found { bounds: [0, 1, 2].map(rounded), boxes: 0 };
    }
    let range = supervisor.range();
    let system = Parts::try_from(supervisor).ok().and_then(|parts| System::new(parts).ok());
    let Some(system) = system else {
        // Nothing is known but that both lie in the range.
        return Found { bounds: [2.0 * range; 3], boxes: 0 };
    };
    let reach = Reach::new(&system);
    let seen = seen(table, supervisor);
    let mut search = Search { table, supervisor, reach, seen, bounds: [0.0; 3], boxes: 0 };
    let cells = table.points - 1;
    for cell in 0..cells * cells {
        search.divide(&Square {
            cell: [cell / cells, cell % cells],
            from: [0.0; 2],
            side: 1.0,
            halvings: 0,
            open: [true; 3],
        });
    }
    Found { bounds: search.bounds, boxes: search.boxes }
}

/// A part of a cell of the table.
struct Square {
    /// Row and column of the cell.
    cell: [usize; 2],
    /// Where it begins and how large it is, in sides of the cell; these are short binary fractions.
    from: [f64; 2],
    side: f64,
    halvings: u32,
    /// Outputs that are not bounded yet.
    open: [bool; 3],
}

impl Square {
    fn middle(&self) -> [f64; 2] {
        self.from.map(|from| from + 0.5 * self.side)
    }
}

/// Enclosures of three outputs; of which nothing is known where there are not three.
fn three(found: &[Interval]) -> [Interval; 3] {
    found.try_into().unwrap_or([Interval::ENTIRE; 3])
}

struct Search<'a> {
    table: &'a SurfaceTable,
    supervisor: &'a Supervisor<f64>,
    reach: Reach<'a>,
    seen: [f64; 3],
    bounds: [f64; 3],
    boxes: u64,
}

impl Search<'_> {
    fn divide(&mut self, square: &Square) {
        self.boxes += 1;
        let mut open = square.open;
        let enclosed = self.enclosed(square);
        for (k, off) in enclosed.into_iter().enumerate().filter(|(k, _)| square.open[*k]) {
            let off = off.magnitude().min(2.0 * self.supervisor.range());
            open[k] = off > self.seen[k] * (1.0 + TOLERANCE) && square.halvings < HALVINGS;
            if !open[k] {
                self.bounds[k] = self.bounds[k].max(off);
            }
        }
        if open.contains(&true) {
            self.look(square);
            self.halve(square, open);
        }
    }

    /// The differences over a part, output by output.
    fn enclosed(&mut self, square: &Square) -> [Interval; 3] {
        let inputs = [0, 1].map(|axis: usize| {
            let first = square.cell[axis] as f64 + square.from[axis];
            position(self.table, first).hull(position(self.table, first + square.side))
        });
        let middle = [0, 1].map(|axis: usize| {
            position(self.table, square.cell[axis] as f64 + square.middle()[axis])
        });
        let place = middle.map(|at| Interval::point(at.midpoint()));
        let exact = three(self.reach.over(&place));
        let at = Square { from: square.middle(), side: 0.0, ..*square };
        let mut off = [0, 1, 2].map(|k: usize| interpolated(self.table, &at, k) - exact[k]);
        let width = position(self.table, 1.0) - position(self.table, 0.0);
        let half = Interval::between(-0.5 * square.side, 0.5 * square.side);
        for axis in 0..2 {
            let slopes = three(self.reach.slopes(&inputs, axis));
            for (k, off) in off.iter_mut().enumerate() {
                let of_table = slope(self.table, square, k, axis);
                // The middle of the grid and of the inputs are rounded apart.
                let apart = slopes[k] * (middle[axis] - place[axis]);
                *off = *off + (of_table - width * slopes[k]) * half - apart;
            }
        }
        off
    }

    fn halve(&mut self, square: &Square, open: [bool; 3]) {
        let side = 0.5 * square.side;
        for [row, column] in [[0.0, 0.0], [0.0, side], [side, 0.0], [side, side]] {
            let from = [square.from[0] + row, square.from[1] + column];
            let halvings = square.halvings + 1;
            self.divide(&Square { cell: square.cell, from, side, halvings, open });
        }
    }

    /// Remembers the difference in the middle of a part.
    fn look(&mut self, square: &Square) {
        let off = difference(self.table, self.supervisor, square.cell, square.middle());
        for (seen, off) in self.seen.iter_mut().zip(off) {
            *seen = seen.max(off);
        }
    }
}

/// The input at a place of the grid, in points.
fn position(table: &SurfaceTable, at: f64) -> Interval {
    let (range, cells) = (f64::from(table.range), (table.points - 1) as f64);
    let point = Interval::point;
    point(range) * (point(2.0 * at) / point(cells) - Interval::ONE)
}

/// The interpolation of an output over a part of a cell.
fn interpolated(table: &SurfaceTable, square: &Square, output: usize) -> Interval {
    let at = square.cell[0] * table.points + square.cell[1];
    let value = |at: usize| Interval::point(f64::from(table.values[at][output]));
    let [first, second] = [at, at + table.points].map(|at| (value(at), value(at + 1)));
    let corner = |row: f64, column: f64| {
        let [row, column] = [row, column].map(Interval::point);
        let along = |(first, second): (Interval, Interval)| first + (second - first) * column;
        let (first, second) = (along(first), along(second));
        first + (second - first) * row
    };
    let [row, column] = square.from;
    let [down, right] = [row + square.side, column + square.side];
    corner(row, column)
        .hull(corner(row, right))
        .hull(corner(down, column))
        .hull(corner(down, right))
}

/// The slopes of the interpolation over a part of a cell, along an axis, per side of the cell: those at the two ends of the
/// other axis and all in between.
fn slope(table: &SurfaceTable, square: &Square, output: usize, axis: usize) -> Interval {
    let at = square.cell[0] * table.points + square.cell[1];
    let value = |at: usize| Interval::point(f64::from(table.values[at][output]));
    let [along, across] = if axis == 0 { [table.points, 1] } else { [1, table.points] };
    let first = value(at + along) - value(at);
    let second = value(at + along + across) - value(at + across);
    let from = square.from[1 - axis];
    let end = |part: f64| first + (second - first) * Interval::point(part);
    end(from).hull(end(from + square.side))
}

/// The difference in a place of a cell, as computed: only to know where to look.
fn difference(
    table: &SurfaceTable,
    supervisor: &Supervisor<f64>,
    cell: [usize; 2],
    place: [f64; 2],
) -> [f64; 3] {
    let [error, change] =
        [0, 1].map(|axis: usize| position(table, cell[axis] as f64 + place[axis]).midpoint());
    let exact = infer(supervisor, error, change);
    let at = Square { cell, from: place, side: 0.0, halvings: 0, open: [true; 3] };
    [0, 1, 2].map(|k: usize| (interpolated(table, &at, k).midpoint() - exact[k]).abs())
}

fn seen(table: &SurfaceTable, supervisor: &Supervisor<f64>) -> [f64; 3] {
    let cells = table.points - 1;
    let mut seen = [0.0_f64; 3];
    for k in 0..cells * cells * LOOKS * LOOKS {
        let (cell, place) = (k / (LOOKS * LOOKS), k % (LOOKS * LOOKS));
        let place = [place / LOOKS, place % LOOKS].map(|at| (at as f64 + 0.5) / LOOKS as f64);
        let off = difference(table, supervisor, [cell / cells, cell % cells], place);
        for (seen, off) in seen.iter_mut().zip(off) {
            *seen = seen.max(off);
        }
    }
    seen
}
