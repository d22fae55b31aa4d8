//! Blocks, sums, arrows and labels for diagrams.

use crate::style::Role;
use crate::svg::{Anchor, Canvas, Font, Paint, Rect};

/// Font size in diagrams (px).
pub(super) const TEXT_PX: f64 = 12.5;
/// Width of signal lines (px).
pub(super) const WIRE: f64 = 1.3;

type Point = (f64, f64);

/// A box with lines of text, given by its centre.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block<'a> {
    pub(super) centre: Point,
    size: (f64, f64),
    /// The first line is the name; the others explain it.
    lines: &'a [&'a str],
}

impl<'a> Block<'a> {
    /// A block of that size around `centre`.
    pub(super) const fn new(centre: Point, size: (f64, f64), lines: &'a [&'a str]) -> Self {
        Self { centre, size, lines }
    }

    /// The point on the left edge at height `y`.
    pub(super) fn left(&self) -> Point {
        (self.centre.0 - self.size.0 / 2.0, self.centre.1)
    }

    /// The point on the right edge.
    pub(super) fn right(&self) -> Point {
        (self.centre.0 + self.size.0 / 2.0, self.centre.1)
    }

    /// The point in the middle of the upper edge.
    pub(super) fn top(&self) -> Point {
        (self.centre.0, self.centre.1 - self.size.1 / 2.0)
    }

    /// The point in the middle of the lower edge.
    pub(super) fn bottom(&self) -> Point {
        (self.centre.0, self.centre.1 + self.size.1 / 2.0)
    }

    /// Draws the block.
    pub(super) fn draw(&self, canvas: &mut Canvas) {
        let ((x, y), (width, height)) = (self.centre, self.size);
        let place = Rect { x: x - width / 2.0, y: y - height / 2.0, width, height };
        canvas.rounded(place, 3.0, &Paint::line(Role::Ink, WIRE).filled(Role::Face));
        let step = TEXT_PX + 4.0;
        let first = y - (self.lines.len().saturating_sub(1)) as f64 * step / 2.0 + TEXT_PX * 0.35;
        for (n, line) in self.lines.iter().enumerate() {
            let font = Font::new(if n == 0 { TEXT_PX } else { TEXT_PX - 1.0 }, Anchor::Middle);
            canvas.text(x, first + n as f64 * step, line, font);
        }
    }
}

/// Draws a summing circle with signs left of it and below it.
pub(super) fn sum(canvas: &mut Canvas, (x, y): Point, left: &str, below: &str) {
    canvas.circle((x, y), 9.0, &Paint::line(Role::Ink, WIRE).filled(Role::Face));
    canvas.text(x - 18.0, y - 7.0, left, Font::new(TEXT_PX, Anchor::Middle));
    canvas.text(x + 10.0, y + 22.0, below, Font::new(TEXT_PX, Anchor::Middle));
}

/// Radius of the circle that [`sum`] draws (px).
pub(super) const SUM: f64 = 9.0;

/// Draws a line through `points` with an arrow head at its end.
pub(super) fn arrow(canvas: &mut Canvas, points: &[Point]) {
    arrow_in(canvas, points, Role::Ink, WIRE);
}

/// As [`arrow`], with a colour and a width.
pub(super) fn arrow_in(canvas: &mut Canvas, points: &[Point], role: Role, width: f64) {
    let [.., from, tip] = points else { return };
    let (dx, dy) = (tip.0 - from.0, tip.1 - from.1);
    let length = (dx * dx + dy * dy).sqrt().max(1e-9);
    let (ux, uy) = (dx / length, dy / length);
    let (long, half) = (6.0 + 1.6 * width, 2.2 + width);
    let back = (tip.0 - ux * long, tip.1 - uy * long);
    let mut shaft = points.to_vec();
    if let Some(end) = shaft.last_mut() {
        *end = back;
    }
    canvas.polyline(&shaft, false, &Paint::line(role, width));
    let head =
        [*tip, (back.0 - uy * half, back.1 + ux * half), (back.0 + uy * half, back.1 - ux * half)];
    canvas.polyline(&head, true, &Paint::face(role));
}

/// Draws a plain line through `points`.
pub(super) fn wire(canvas: &mut Canvas, points: &[Point]) {
    canvas.polyline(points, false, &Paint::line(Role::Ink, WIRE));
}

/// Draws the dot where a line branches.
pub(super) fn node(canvas: &mut Canvas, at: Point) {
    canvas.circle(at, 2.6, &Paint::face(Role::Ink));
}

/// Writes the name of a signal, in italics.
pub(super) fn signal(canvas: &mut Canvas, (x, y): Point, anchor: Anchor, name: &str) {
    canvas.text(x, y, name, Font::new(TEXT_PX + 0.5, anchor).italic());
}

/// Writes an explanation.
pub(super) fn note(canvas: &mut Canvas, (x, y): Point, anchor: Anchor, text: &str) {
    canvas.text(x, y, text, Font::new(TEXT_PX - 1.5, anchor).role(Role::Muted));
}
