//! The outline of cut or scaled sets that are all piecewise linear, in closed form.
//!
//! The corners of all sets divide the universe into cells in each of which every set is one straight
//! line. An evaluation walks over the cells: minimum cuts a line at its strength, product tilts it;
//! between the cuts every conclusion is a straight line, and the highest of them (or their sum) is
//! the outline. No sample is taken.

use alloc::vec::Vec;
use core::ops::Range;

use super::super::build::System;
use super::super::norms::SNorm;
use super::super::parts::{Conclusion, Membership, Output};
use super::actors::{Actors, Level};
use super::joined::{Joined, Piece};
use crate::membership::Vertex;
use crate::norm::{SNormKind, TNormKind};

/// How conclusions are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Join {
    Maximum,
    Sum,
    /// The sum, but no more than 1.
    BoundedSum,
}

impl Join {
    fn of(norm: &SNorm) -> Option<Self> {
        match norm {
            SNorm::Kind(SNormKind::Maximum) => Some(Self::Maximum),
            SNorm::Kind(SNormKind::UnboundedSum) => Some(Self::Sum),
            // Of two numbers, and so of any number of them, the same.
            SNorm::Kind(SNormKind::BoundedSum | SNormKind::NormalizedSum) => Some(Self::BoundedSum),
            _ => None,
        }
    }
}

/// A part of the universe in which every set is straight.
#[derive(Clone, Debug)]
struct Cell {
    x: [f64; 2],
    /// Its lines.
    lines: Range<usize>,
}

/// A term within a cell, where it is not 0.
#[derive(Clone, Copy, Debug)]
struct Line {
    term: usize,
    /// Grades at the ends of the cell.
    grade: [f64; 2],
}

/// The piecewise-linear sets of an output, cut into cells.
#[derive(Clone, Debug)]
pub(crate) struct Outline {
    join: Join,
    cells: Vec<Cell>,
    lines: Vec<Line>,
    /// Whether each actor scales its set (product); the others cut theirs (minimum).
    scales: Vec<bool>,
    middle: f64,
}

/// Memory for an outline.
#[derive(Clone, Debug, Default)]
pub(crate) struct Room {
    active: Vec<Active>,
    cuts: Vec<f64>,
    edges: Vec<Edge>,
    pub(crate) joined: Joined,
}

/// A conclusion within a cell.
#[derive(Clone, Copy, Debug)]
struct Active {
    x: [f64; 2],
    grade: [f64; 2],
    strength: f64,
    /// From where to where the strength cuts.
    cut: [f64; 2],
    conclusion: usize,
}

/// A conclusion between two cuts: a straight line.
#[derive(Clone, Copy, Debug)]
struct Edge {
    grade: [f64; 2],
    conclusion: usize,
    cut: bool,
}

impl Outline {
    /// The outline of an output whose sets are all piecewise linear and stay so when joined.
    pub(crate) fn of(output: &Output, actors: &Actors) -> Option<Self> {
        let (join, universe) = (Join::of(&output.aggregation)?, output.universe?);
        let polylines: Vec<Vec<Vertex>> =
            output.terms.iter().map(|term| polyline(&term.conclusion)).collect::<Option<_>>()?;
        let scales = actors.list().iter().map(|actor| {
            let scales = actor.implication.is(TNormKind::AlgebraicProduct);
            (scales || actor.implication.is(TNormKind::Minimum)).then_some(scales)
        });
        let scales = scales.collect::<Option<_>>()?;
        let (cells, lines) = cells([universe.lower, universe.upper], &polylines);
        Some(Self { join, cells, lines, scales, middle: universe.middle() })
    }

    /// Makes room for it.
    pub(crate) fn reserve(&self, actors: &Actors, room: &mut Room) {
        let of_cell = |cell: &Cell| -> usize {
            let lines = self.lines.get(cell.lines.clone()).unwrap_or_default();
            lines.iter().map(|line| actors.about(line.term).len()).sum()
        };
        let most = self.cells.iter().map(of_cell).max().unwrap_or(0);
        // The upper envelope of m conclusions of two segments each has fewer than 16 m pieces.
        let pieces = self.cells.iter().map(|cell| of_cell(cell).min(16) * of_cell(cell) + 2).sum();
        room.active.reserve(most);
        room.cuts.reserve(most + 1);
        room.edges.reserve(most);
        room.joined.reserve(pieces);
    }

    /// Joins what the actors conclude at their levels.
    pub(crate) fn join(&self, actors: &Actors, levels: &[Level], room: &mut Room) {
        room.joined.restart(self.middle);
        for cell in &self.cells {
            self.join_cell(cell, actors, levels, room);
        }
    }

    fn join_cell(&self, cell: &Cell, actors: &Actors, levels: &[Level], room: &mut Room) {
        let Room { active, cuts, edges, joined } = room;
        active.clear();
        cuts.clear();
        for line in self.lines.get(cell.lines.clone()).unwrap_or_default() {
            let about = actors.about(line.term);
            let (levels, scales) = (levels.get(about.clone()), self.scales.get(about));
            let (Some(levels), Some(scales)) = (levels, scales) else { continue };
            for (level, &scales) in levels.iter().zip(scales) {
                if level.strength > 0.0 {
                    let own = Active::new(cell.x, line.grade, level, scales);
                    cuts.extend(own.cut.into_iter().filter(|&x| cell.x[0] < x && x < cell.x[1]));
                    active.push(own);
                }
            }
        }
        if active.is_empty() {
            return;
        }
        cuts.sort_unstable_by(f64::total_cmp);
        cuts.push(cell.x[1]);
        let (first, mut from) = (joined.len(), cell.x[0]);
        for &to in cuts.iter() {
            if from < to {
                edges.clear();
                edges.extend(active.iter().map(|own| own.edge(from, to)));
                match self.join {
                    Join::Maximum => highest([from, to], edges, first, joined),
                    Join::Sum => sum([from, to], edges, f64::INFINITY, first, joined),
                    Join::BoundedSum => sum([from, to], edges, 1.0, first, joined),
                }
                from = to;
            }
        }
    }
}

impl Active {
    fn new(x: [f64; 2], grade: [f64; 2], level: &Level, scales: bool) -> Self {
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
    fn edge(&self, from: f64, to: f64) -> Edge {
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
fn highest(x: [f64; 2], edges: &[Edge], cell: usize, joined: &mut Joined) {
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
fn sum(x: [f64; 2], edges: &[Edge], limit: f64, cell: usize, joined: &mut Joined) {
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

/// The corners of a piecewise-linear type-1 set, its height included.
fn polyline(conclusion: &Conclusion) -> Option<Vec<Vertex>> {
    let Conclusion::Set { membership: Membership::Shape { kind, params, height }, lower: None } =
        conclusion
    else {
        return None;
    };
    let mut corners = Vec::new();
    kind.vertices(params, &mut |vertex| {
        corners.push(Vertex { grade: vertex.grade * height, ..vertex });
    });
    (kind.is_piecewise_linear() && !corners.is_empty()).then_some(corners)
}

/// The cells between all corners inside the universe, and the lines in them.
fn cells(universe: [f64; 2], polylines: &[Vec<Vertex>]) -> (Vec<Cell>, Vec<Line>) {
    let mut corners = universe.to_vec();
    let inside = |x: &f64| universe[0] < *x && *x < universe[1];
    corners.extend(polylines.iter().flatten().map(|vertex| vertex.x).filter(inside));
    corners.sort_by(f64::total_cmp);
    corners.dedup();
    let (mut cells, mut lines) = (Vec::new(), Vec::new());
    for ends in corners.windows(2) {
        let &[from, to] = ends else { continue };
        let begin = lines.len();
        for (term, polyline) in polylines.iter().enumerate() {
            let grade = line(polyline, from, to);
            if grade[0] > 0.0 || grade[1] > 0.0 {
                lines.push(Line { term, grade });
            }
        }
        cells.push(Cell { x: [from, to], lines: begin..lines.len() });
    }
    (cells, lines)
}

/// Grades at both ends of a cell without corners inside, as seen from within.
fn line(polyline: &[Vertex], from: f64, to: f64) -> [f64; 2] {
    let after = polyline.partition_point(|vertex| vertex.x <= from);
    let (left, right) = (after.checked_sub(1).and_then(|i| polyline.get(i)), polyline.get(after));
    match (left, right) {
        (Some(left), Some(right)) => [from, to].map(|x| between(left, right, x)),
        (Some(only), None) | (None, Some(only)) => [only.grade; 2],
        (None, None) => [0.0; 2],
    }
}

#[allow(clippy::float_cmp, reason = "a corner has the grade that it is given")]
fn between(left: &Vertex, right: &Vertex, x: f64) -> f64 {
    if x == left.x {
        left.grade
    } else if x == right.x {
        right.grade
    } else {
        (left.grade * (right.x - x) + right.grade * (x - left.x)) / (right.x - left.x)
    }
}

impl System {
    /// Where a conclusion comes from: the rule block, the rule within it and the consequent within
    /// that; nothing for a number that is not one of a conclusion.
    #[must_use]
    pub fn origin(&self, conclusion: usize) -> Option<[usize; 3]> {
        let found = self.conclusions.get(conclusion)?;
        let rule = self.rules.get(found.rule)?;
        Some([found.block, rule.rule, conclusion - rule.conclusions.start])
    }
}
