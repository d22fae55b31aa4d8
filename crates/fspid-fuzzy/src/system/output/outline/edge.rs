//! Conclusions within a cell: where they are cut, how they join.

use super::super::actors::Level;
use super::super::joined::{AggregatedSet, Piece};

/// A conclusion within a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Active {
    pub(super) x: [f64; 2],
    pub(super) grade: [f64; 2],
    pub(super) strength: f64,
    /// From where to where the strength cuts.
    pub(super) cut: [f64; 2],
    pub(super) conclusion: usize,
}

/// A conclusion between two cuts: a straight line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) grade: [f64; 2],
    pub(super) conclusion: usize,
    pub(super) cut: bool,
}

impl Active {
    pub(super) fn new(x: [f64; 2], grade: [f64; 2], level: &Level, scales: bool) -> Self {
        let &Level { strength, conclusion } = level;
        let never = [f64::INFINITY; 2];
        if scales {
            let grade = grade.map(|g| g * strength);
            return Self { x, grade, strength: f64::INFINITY, cut: never, conclusion };
        }
        let cut = match grade.map(|g| g > strength) {
            [false, false] => never,
            [true, true] => x,
            [false, true] => [place(x, grade, strength), x[1]],
            [true, false] => [x[0], place(x, grade, strength)],
        };
        Self { x, grade, strength, cut, conclusion }
    }

    /// What it is between two places in the cell that no cut lies between.
    pub(super) fn edge(&self, from: f64, to: f64) -> Edge {
        let conclusion = self.conclusion;
        if self.cut[0] <= from && to <= self.cut[1] {
            return Edge { grade: [self.strength; 2], conclusion, cut: true };
        }
        Edge { grade: [self.at(from), self.at(to)], conclusion, cut: false }
    }

    /// Grade at a place where the line is not cut, or just so.
    #[allow(clippy::float_cmp, reason = "the ends of cells and cuts are known exactly")]
    fn at(&self, x: f64) -> f64 {
        let ([from, to], [begin, end]) = (self.x, self.grade);
        if x == from {
            begin.min(self.strength)
        } else if x == to {
            end.min(self.strength)
        } else if self.cut.contains(&x) {
            self.strength
        } else {
            ((begin * (to - x) + end * (x - from)) / (to - from)).min(self.strength)
        }
    }
}

/// Where a line has a grade between those at its ends; counted from its lower end, so that small
/// grades keep their digits.
fn place([from, to]: [f64; 2], [begin, end]: [f64; 2], grade: f64) -> f64 {
    let width = to - from;
    if begin < end {
        (from + width * ((grade - begin) / (end - begin))).min(to)
    } else {
        (to - width * ((grade - end) / (begin - end))).max(from)
    }
}

/// The upper envelope of straight lines over `x`: start on the highest and change to whichever
/// crosses first.
pub(super) fn highest(x: [f64; 2], edges: &[Edge], cell: usize, joined: &mut AggregatedSet) {
    let higher = |a: &Edge, b: &Edge| {
        a.grade[0] > b.grade[0] || (a.grade[0] >= b.grade[0] && a.grade[1] > b.grade[1])
    };
    let best = edges.iter().reduce(|best, edge| if higher(edge, best) { edge } else { best });
    let Some(mut current) = best else { return };
    let (mut begin, mut begin_grade) = (0.0_f64, current.grade[0]);
    let at = |t: f64| if t < 1.0 { x[0] + (x[1] - x[0]) * t } else { x[1] };
    loop {
        let next = next_crossing(current, edges).map(|(t, edge)| (t.max(begin), edge));
        let end = next.map_or(1.0, |(t, _)| t);
        let end_grade = current.grade[0] * (1.0 - end) + current.grade[1] * end;
        let piece = Piece {
            x: [at(begin), at(end)],
            grade: [begin_grade, end_grade],
            conclusion: Some(current.conclusion),
            cut: current.cut,
        };
        joined.push(piece, cell);
        let Some((_, edge)) = next else { return };
        (current, begin, begin_grade) = (edge, end, end_grade);
    }
}

/// The sum of straight lines over `x`, cut off at `limit`.
pub(super) fn sum(
    x: [f64; 2],
    edges: &[Edge],
    limit: f64,
    cell: usize,
    joined: &mut AggregatedSet,
) {
    let grade = [0, 1].map(|end| edges.iter().filter_map(|edge| edge.grade.get(end)).sum::<f64>());
    let (conclusion, cut) = match edges {
        [only] => (Some(only.conclusion), only.cut),
        _ => (None, false),
    };
    let mut push = |x, grade| joined.push(Piece { x, grade, conclusion, cut }, cell);
    let limited = grade.map(|g| g.min(limit));
    if grade.iter().any(|&g| g < limit) && grade.iter().any(|&g| g > limit) {
        let middle = place(x, grade, limit);
        push([x[0], middle], [limited[0], limit]);
        push([middle, x[1]], [limit, limited[1]]);
    } else {
        push(x, limited);
    }
}

/// The first line to cross the current one from below, and at which fraction of the way: the
/// smallest $d_0 / (d_0 + d_1)$, where a line begins $d_0$ below and ends $d_1$ above.
fn next_crossing<'e>(current: &Edge, edges: &'e [Edge]) -> Option<(f64, &'e Edge)> {
    let mut first: Option<(f64, &Edge)> = None;
    for edge in edges {
        let above = edge.grade[1] - current.grade[1];
        if above > 0.0 {
            let below = (current.grade[0] - edge.grade[0]).max(0.0);
            let t = below / (below + above);
            let sooner = first.is_none_or(|(found, other)| {
                t < found || (t <= found && edge.grade[1] > other.grade[1])
            });
            first = if sooner { Some((t, edge)) } else { first };
        }
    }
    first
}
