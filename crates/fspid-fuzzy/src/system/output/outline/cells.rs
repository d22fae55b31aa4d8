//! The universe cut at every corner of every set.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use super::super::super::parts::{Conclusion, Membership};
use crate::membership::{ShapeKind, Vertex};

/// A part of the universe in which every set is straight.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    pub(super) x: [f64; 2],
    /// Its lines.
    pub(super) lines: Range<usize>,
}

/// A term within a cell, where it is not 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) term: usize,
    /// Grades at the ends of the cell.
    pub(super) grade: [f64; 2],
}

/// The corners of a piecewise-linear type-1 set, its height included.
pub(super) fn polyline(conclusion: &Conclusion) -> Option<Vec<Vertex>> {
    match conclusion {
        Conclusion::Set { membership, lower: None } => corners(membership),
        _ => None,
    }
}

/// The corners of a piecewise-linear set, its height included.
fn corners(set: &Membership) -> Option<Vec<Vertex>> {
    let Membership::Shape { kind, params, height } = set else { return None };
    let mut corners = Vec::new();
    kind.vertices(params, &mut |vertex| {
        corners.push(Vertex { grade: vertex.grade * height, ..vertex });
    });
    (kind.is_piecewise_linear() && !corners.is_empty()).then_some(corners)
}

/// The first of two piecewise-linear sets where it is nowhere above the second, else the smaller of
/// both at each place.
pub(crate) fn smaller_set(set: &Membership, limit: &Membership) -> Option<Membership> {
    let (own, other) = (corners(set)?, corners(limit)?);
    let mut places = vec![f64::NEG_INFINITY, f64::INFINITY];
    places.extend(own.iter().chain(&other).map(|vertex| vertex.x));
    places.sort_by(f64::total_cmp);
    places.dedup();
    let (mut params, mut is_above): (Vec<f64>, bool) = (Vec::new(), false);
    let mut add = |x: f64, grade: f64| {
        if x.is_finite() && !params.ends_with(&[x, grade]) {
            params.extend([x, grade]);
        }
    };
    for ends in places.windows(2) {
        let &[from, to] = ends else { continue };
        let (own, other) = (line(&own, from, to), line(&other, from, to));
        let above = [own[0] - other[0], own[1] - other[1]];
        is_above |= above.iter().any(|&by| by > 0.0);
        add(from, own[0].min(other[0]));
        if above[0].min(above[1]) < 0.0 && above[0].max(above[1]) > 0.0 {
            let share = above[0] / (above[0] - above[1]);
            add(from + (to - from) * share, own[0] + (own[1] - own[0]) * share);
        }
        add(to, own[1].min(other[1]));
    }
    let smaller = || Membership::Shape { kind: ShapeKind::Points, params, height: 1.0 };
    Some(if is_above { smaller() } else { set.clone() })
}

/// The cells between all corners inside the universe, and the lines in them.
pub(super) fn cells(universe: [f64; 2], polylines: &[Vec<Vertex>]) -> (Vec<Cell>, Vec<Line>) {
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
