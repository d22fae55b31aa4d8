//! Lines on which two grades tie.
//!
//! Strengths joined by the minimum have kinks where two grades are equal. For two Gaussian sets, on
//! inputs $x$ and $y$, that is where $|x - c| / \sigma = |y - c'| / \sigma'$: on straight lines, and
//! with evenly spaced sets many ties share a line. A box that such a line crosses is enclosed twice,
//! once for each side, so that its slopes are those of either side and not of mixtures that occur on
//! neither.
//!
//! The rounding of centres moves lines that should be one a little apart. They are taken for one if
//! they are no further apart than [`STRIP`] times their distance from the origin; what is said of
//! slopes leaves out strips of that width along them. Across a strip no output changes by more than
//! its width times a slope, far below any tolerance.

use alloc::vec::Vec;

use crate::membership::ShapeKind;
use crate::system::{Membership, Statement, System, Variable};
use fspid_numeric::scalar::Interval;

/// Width of the strips that are left out, as a share of the distances in question.
pub(super) const STRIP: f64 = 1e-12;
/// Most lines across a box that are told apart.
const MOST_LINES: usize = 4;

/// The straight line $x_a + r x_b = d$, or $x_a = d$.
#[derive(Clone, Debug)]
struct Line {
    inputs: [usize; 2],
    ratio: f64,
    offset: f64,
    /// Distances of which the lines that were taken for this one may be off by a small share.
    scale: f64,
    ties: Vec<Tie>,
}

/// Two statements whose grades are equal on a line.
#[derive(Clone, Copy, Debug)]
struct Tie {
    statements: [usize; 2],
    /// The tie holds where the inputs are on these sides of the centres: the side of each set's
    /// centre, -1, 1 or, on a line across one input, 0.
    sides: [i8; 2],
    centres: [f64; 2],
    /// Beyond the line the first grade is the smaller one.
    first_falls: bool,
}

/// A Gaussian set that a statement asks for.
#[derive(Clone, Copy, Debug)]
struct Bell {
    statement: usize,
    input: usize,
    centre: f64,
    sigma: f64,
    height: f64,
}

/// Where a box lies with respect to a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Below,
    Above,
    Across,
}

/// All lines of a system on which grades tie.
#[derive(Clone, Debug)]
pub(super) struct Ties {
    lines: Vec<Line>,
    /// Where the box at hand lies with respect to each.
    sides: Vec<Side>,
    /// Lines across the box.
    crossing: Vec<usize>,
    polygon: [Vec<[f64; 2]>; 2],
}

impl Ties {
    pub(super) fn of(system: &System) -> Self {
        let statements = system.program.statements.iter().take(128).enumerate();
        let bells: Vec<Bell> =
            statements.filter_map(|(index, statement)| bell(system, index, statement)).collect();
        let mut ties = Self {
            lines: Vec::new(),
            sides: Vec::new(),
            crossing: Vec::new(),
            polygon: [Vec::new(), Vec::new()],
        };
        for (index, &one) in bells.iter().enumerate() {
            for &other in bells.get(..index).unwrap_or_default() {
                ties.add(other, one);
            }
        }
        ties
    }

    fn add(&mut self, one: Bell, other: Bell) {
        let alike = |a: f64, b: f64| a.total_cmp(&b).is_eq();
        if !alike(one.height, other.height) {
            return;
        }
        if one.input == other.input {
            if alike(one.sigma, other.sigma) && !alike(one.centre, other.centre) {
                self.add_across_one(one, other);
            }
            return;
        }
        let [one, other] = if one.input < other.input { [one, other] } else { [other, one] };
        let ratio = one.sigma / other.sigma;
        for [x, y] in [[1_i8, 1], [1, -1], [-1, 1], [-1, -1]] {
            // |x - c| >= r |y - c'|, and the first grade is the smaller one.
            let slope = if x == y { -ratio } else { ratio };
            let tie = Tie {
                statements: [one.statement, other.statement],
                sides: [x, y],
                centres: [one.centre, other.centre],
                first_falls: x > 0,
            };
            let offset = one.centre + slope * other.centre;
            let scale = one.centre.abs() + ratio * other.centre.abs() + one.sigma;
            let (inputs, ties) = ([one.input, other.input], Vec::from([tie]));
            self.add_line(Line { inputs, ratio: slope, offset, scale, ties });
        }
    }

    fn add_across_one(&mut self, one: Bell, other: Bell) {
        let [left, right] = if one.centre < other.centre { [one, other] } else { [other, one] };
        let tie = Tie {
            statements: [left.statement, right.statement],
            sides: [0; 2],
            centres: [left.centre, right.centre],
            first_falls: true,
        };
        let offset = 0.5 * (left.centre + right.centre);
        let scale = left.centre.abs() + right.centre.abs();
        self.add_line(Line {
            inputs: [left.input; 2],
            ratio: 0.0,
            offset,
            scale,
            ties: Vec::from([tie]),
        });
    }

    /// A line with its ties; those of a line that is there already join it.
    fn add_line(&mut self, new: Line) {
        let near = |a: f64, b: f64, scale: f64| (a - b).abs() <= 0.25 * STRIP * scale;
        let known = self.lines.iter_mut().find(|line| {
            line.inputs == new.inputs
                && near(line.ratio, new.ratio, new.ratio.abs())
                && near(line.offset, new.offset, new.scale)
        });
        match known {
            Some(line) => {
                line.ties.extend(new.ties);
                line.scale = line.scale.max(new.scale);
            }
            None => self.lines.push(new),
        }
    }

    /// Finds where a box lies. With `strips` left out, a box that only touches a line counts as on
    /// one side; otherwise lines that are merely near are not decided.
    pub(super) fn place(&mut self, cell: &[Interval], strips: bool) {
        self.sides.clear();
        self.crossing.clear();
        for (index, line) in self.lines.iter().enumerate() {
            let side = line.side(cell, strips);
            if side == Side::Across {
                self.crossing.push(index);
            }
            self.sides.push(side);
        }
    }

    /// How many ways the box may be divided by the lines across it; 1 if there are too many.
    pub(super) fn ways(&self) -> u32 {
        let lines = self.crossing.len();
        if lines <= MOST_LINES { 1 << lines } else { 1 }
    }

    /// Chooses a side of each line across the box; false if no part of the box is on all of them.
    pub(super) fn choose(&mut self, way: u32, cell: &[Interval]) -> bool {
        if self.ways() == 1 {
            return true;
        }
        for (bit, &line) in self.crossing.iter().enumerate() {
            let above = way >> bit & 1 == 1;
            if let Some(side) = self.sides.get_mut(line) {
                *side = if above { Side::Above } else { Side::Below };
            }
        }
        (0..self.crossing.len()).all(|first| self.is_possible(first, cell))
    }

    /// Whether the sides chosen of the lines in the plane of one of them leave a part of the box.
    fn is_possible(&mut self, first: usize, cell: &[Interval]) -> bool {
        let line = |place: usize| self.lines.get(*self.crossing.get(place)?);
        let Some(plane) = line(first).map(|line| line.inputs) else { return true };
        let known = (0..first).any(|before| line(before).is_some_and(|l| l.inputs == plane));
        let (Some(x), Some(y)) = (cell.get(plane[0]), cell.get(plane[1])) else { return true };
        if known || plane[0] == plane[1] || x.is_point() || y.is_point() {
            return true;
        }
        let [polygon, room] = &mut self.polygon;
        polygon.clear();
        polygon.extend([
            [x.lower(), y.lower()],
            [x.upper(), y.lower()],
            [x.upper(), y.upper()],
            [x.lower(), y.upper()],
        ]);
        for &index in &self.crossing {
            let (Some(line), Some(&side)) = (self.lines.get(index), self.sides.get(index)) else {
                continue;
            };
            if let Some(form) = line.in_plane(plane) {
                clip(polygon, room, form, side == Side::Above);
            }
        }
        let reach = x.magnitude() + y.magnitude();
        area(polygon) > 4.0 * STRIP * reach * (x.width() + y.width())
    }

    /// For each statement those whose grade is at least as large everywhere in the box.
    pub(super) fn relate(&self, cell: &[Interval], above: &mut [u128]) {
        above.fill(0);
        for (line, &side) in self.lines.iter().zip(&self.sides) {
            for tie in &line.ties {
                tie.relate(line, side, cell, above);
            }
        }
    }
}

impl Line {
    fn side(&self, cell: &[Interval], strips: bool) -> Side {
        let [a, b] = self.inputs;
        let (Some(&x), Some(&y)) = (cell.get(a), cell.get(b)) else { return Side::Across };
        let offset = Interval::point(self.offset);
        let place = if a == b { x } else { x + y * Interval::point(self.ratio) };
        let distance = place - offset;
        let reach = x.magnitude() + y.magnitude() * self.ratio.abs() + self.scale;
        let strip = if strips { -STRIP * reach } else { STRIP * reach };
        if distance.lower() >= strip {
            Side::Above
        } else if distance.upper() <= -strip {
            Side::Below
        } else {
            Side::Across
        }
    }

    /// Coefficients of the line in a plane, if it lies in it.
    fn in_plane(&self, plane: [usize; 2]) -> Option<[f64; 3]> {
        match self.inputs {
            inputs if inputs == plane => Some([1.0, self.ratio, self.offset]),
            [a, b] if a == b && a == plane[0] => Some([1.0, 0.0, self.offset]),
            [a, b] if a == b && a == plane[1] => Some([0.0, 1.0, self.offset]),
            _ => None,
        }
    }
}

impl Tie {
    fn relate(&self, line: &Line, side: Side, cell: &[Interval], above: &mut [u128]) {
        if side == Side::Across {
            return;
        }
        let sides = self.sides.iter().zip(&self.centres).zip(&line.inputs);
        let applies = sides.into_iter().all(|((&side, &centre), &input)| {
            cell.get(input).is_some_and(|values| match side {
                0 => true,
                1 => values.lower() >= centre,
                _ => values.upper() <= centre,
            })
        });
        if !applies {
            return;
        }
        let [one, other] = self.statements;
        let first_is_smaller = self.first_falls == (side == Side::Above);
        let (smaller, larger) = if first_is_smaller { (one, other) } else { (other, one) };
        if let Some(mask) = above.get_mut(smaller) {
            *mask |= 1 << larger;
        }
    }
}

fn bell(system: &System, index: usize, statement: &Statement) -> Option<Bell> {
    let Variable::Input(input) = statement.variable else { return None };
    let part = system.parts.inputs.get(input)?;
    let term = part.terms.get(statement.term?)?;
    let Membership::Shape { kind: ShapeKind::Gaussian, params, height } = &term.membership else {
        return None;
    };
    let &[centre, sigma] = params.as_slice() else { return None };
    let plain = part.enabled && statement.hedges.is_empty();
    plain.then_some(Bell { statement: index, input, centre, sigma, height: *height })
}

/// Keeps of a polygon the part above (or below) the line $a x + b y = d$.
fn clip(polygon: &mut Vec<[f64; 2]>, room: &mut Vec<[f64; 2]>, [a, b, d]: [f64; 3], above: bool) {
    let sign = if above { 1.0 } else { -1.0 };
    let height = |[x, y]: [f64; 2]| sign * (a * x + b * y - d);
    room.clear();
    let next = polygon.iter().skip(1).chain(polygon.first());
    for (&from, &to) in polygon.iter().zip(next) {
        let (one, other) = (height(from), height(to));
        if one >= 0.0 {
            room.push(from);
        }
        if (one > 0.0 && other < 0.0) || (one < 0.0 && other > 0.0) {
            let share = one / (one - other);
            let between = |i: usize| from[i] + share * (to[i] - from[i]);
            room.push([between(0), between(1)]);
        }
    }
    core::mem::swap(polygon, room);
}

fn area(polygon: &[[f64; 2]]) -> f64 {
    let Some(&[x0, y0]) = polygon.first() else { return 0.0 };
    let next = polygon.iter().skip(1);
    let cross = polygon
        .iter()
        .zip(next)
        .map(|(&[x1, y1], &[x2, y2])| (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0));
    0.5 * cross.sum::<f64>().abs()
}
