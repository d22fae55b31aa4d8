//! Lines cut to a window before they are drawn, so that far points neither bend nor bloat them.

use crate::svg::Rect;
use crate::thin;

/// How far lines reach over the edge of their window (px); the clip of the area hides it.
const MARGIN: f64 = 3.0;
/// Points nearer than this to the last one kept are left out (px).
const NEAR: f64 = 0.2;

/// The runs of `points` inside `window`, thinned; a point that is not finite ends a run.
pub(super) fn runs(points: impl Iterator<Item = Point>, window: Rect) -> Vec<Vec<Point>> {
    let mut runs: Vec<Vec<Point>> = Vec::new();
    let mut before: Option<Point> = None;
    let mut open = false;
    for point in points {
        if !(point.0.is_finite() && point.1.is_finite()) {
            (before, open) = (None, false);
            continue;
        }
        match before.replace(point) {
            None => open = false,
            Some(from) => open = extend(&mut runs, open, (from, point), window),
        }
    }
    runs.into_iter()
        .flat_map(|run| thin::runs(apart(&run).into_iter(), (1.0, 1.0), false))
        .collect()
}

/// Adds the visible part of a segment; true where the next one may go on from its end.
fn extend(
    runs: &mut Vec<Vec<Point>>,
    open: bool,
    (from, to): (Point, Point),
    window: Rect,
) -> bool {
    let wide = Rect {
        x: window.x - MARGIN,
        y: window.y - MARGIN,
        width: window.width + 2.0 * MARGIN,
        height: window.height + 2.0 * MARGIN,
    };
    let Some((start, end)) = part_inside(from, to, wide) else {
        return false;
    };
    match runs.last_mut().filter(|_| open) {
        Some(run) => run.push(end),
        None => runs.push(vec![start, end]),
    }
    // Cut off at its far end, the line leaves the window here.
    (end.0 - to.0).abs() < 1e-9 && (end.1 - to.1).abs() < 1e-9
}

/// The part of the segment from `a` to `b` that lies in `window`.
///
/// # Source
/// Liang and Barsky, A new concept and method for line clipping, ACM TOG 3(1), 1984.
pub(super) fn part_inside(a: Point, b: Point, window: Rect) -> Option<(Point, Point)> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    let sides = [
        (-dx, a.0 - window.x),
        (dx, window.x + window.width - a.0),
        (-dy, a.1 - window.y),
        (dy, window.y + window.height - a.1),
    ];
    for (slope, room) in sides {
        if slope == 0.0 {
            if !(room >= 0.0) {
                return None;
            }
        } else if slope < 0.0 {
            first = first.max(room / slope);
        } else {
            last = last.min(room / slope);
        }
    }
    // Clamped because far ends leave no digits for the place where they come in.
    let at = |part: f64| {
        let (x, y) = (a.0 + dx * part, a.1 + dy * part);
        (x.clamp(window.x, window.x + window.width), y.clamp(window.y, window.y + window.height))
    };
    let end = if last >= 1.0 { b } else { at(last) };
    (first <= last && dx.is_finite() && dy.is_finite()).then(|| (at(first), end))
}

/// The first and last point and those between that are not on top of one another.
fn apart(run: &[Point]) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    for (n, &point) in run.iter().enumerate() {
        let far = |last: &Point| (point.0 - last.0).abs().max((point.1 - last.1).abs()) >= NEAR;
        if kept.last().is_none_or(far) || n + 1 == run.len() {
            kept.push(point);
        }
    }
    kept
}

/// A place on the canvas (px).
pub(super) type Point = (f64, f64);

#[cfg(test)]
mod tests {
    use super::*;

    const WINDOW: Rect = Rect { x: 0.0, y: 0.0, width: 10.0, height: 10.0 };

    #[test]
    fn a_line_through_the_window_is_cut_at_both_sides() {
        let found = part_inside((-10.0, 5.0), (20.0, 5.0), WINDOW);
        assert_eq!(found, Some(((0.0, 5.0), (10.0, 5.0))));
        assert_eq!(part_inside((-10.0, -1.0), (20.0, -1.0), WINDOW), None);
        assert_eq!(part_inside((1.0, 1.0), (1.0, 1.0), WINDOW), Some(((1.0, 1.0), (1.0, 1.0))));
    }

    #[test]
    fn a_line_that_leaves_and_returns_is_two_runs_and_keeps_its_direction() {
        let points = [(5.0, 5.0), (5.0, 1e12), (7.0, 1e12), (7.0, 5.0), (8.0, 5.0)];
        let found = runs(points.into_iter(), WINDOW);
        assert_eq!(found.len(), 2);
        assert_eq!(found[0], [(5.0, 5.0), (5.0, 13.0)]);
        assert_eq!(found[1].len(), 3);
        assert!((found[1][0].0 - 7.0).abs() < 1e-3);
    }

    #[test]
    fn what_is_not_finite_breaks_the_line() {
        let points = [(1.0, 1.0), (2.0, 2.0), (f64::NAN, 0.0), (3.0, 3.0), (4.0, 4.0)];
        assert_eq!(runs(points.into_iter(), WINDOW).len(), 2);
        assert!(runs(std::iter::once((1.0, 1.0)), WINDOW).is_empty());
    }
}
