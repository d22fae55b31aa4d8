//! Hatching where a map has no values.

use super::contour::Grid;
use super::style::Role;
use super::svg::{Anchor, Canvas, Font, Paint, Rect};
use super::text::{LABEL_PX, text_width};

/// Height of the legend (px).
pub(super) const LEGEND: f64 = 20.0;

const GAP: f64 = 7.0;
const SWATCH: f64 = 26.0;

/// Hatches an area with slanting lines; the caller clips.
pub(super) fn hatch(canvas: &mut Canvas, area: Rect) {
    slant(canvas, area, &Paint::line(Role::Setpoint, 0.7));
}

/// The same with strong lines, for what must not be overlooked.
pub(super) fn hatch_boldly(canvas: &mut Canvas, area: Rect) {
    slant(canvas, area, &Paint::line(Role::Ink, 1.5));
}

fn slant(canvas: &mut Canvas, area: Rect, paint: &Paint) {
    let (bottom, count) = (area.y + area.height, ((area.width + area.height) / GAP) as usize);
    for n in 0..=count {
        let x = area.x - area.height + n as f64 * GAP;
        canvas.line((x, bottom), (x + area.height, area.y), paint);
    }
}

/// Marks the nodes without a value.
pub(super) fn crosses(canvas: &mut Canvas, grid: &Grid) {
    let paint = Paint::line(Role::Ink, 1.1);
    for (row, &y) in grid.values.iter().zip(&grid.ys) {
        for (_, &x) in row.iter().zip(&grid.xs).filter(|(value, _)| !value.is_finite()) {
            cross(canvas, (x, y), &paint);
        }
    }
}

fn cross(canvas: &mut Canvas, (x, y): (f64, f64), paint: &Paint) {
    let arm = 2.6;
    canvas.line((x - arm, y - arm), (x + arm, y + arm), paint);
    canvas.line((x - arm, y + arm), (x + arm, y - arm), paint);
}

/// A hatched swatch with a cross and what it means, centred at `x`.
pub(super) fn legend(canvas: &mut Canvas, (x, top): (f64, f64), words: &str) {
    let left = x - (SWATCH + 6.0 + text_width(words, LABEL_PX)) / 2.0;
    let area = Rect { x: left, y: top, width: SWATCH, height: 12.0 };
    canvas.begin_clip(area);
    hatch(canvas, area);
    canvas.end();
    canvas.rect(area.x, area.y, area.width, area.height, &Paint::line(Role::Ink, 0.6));
    cross(canvas, (left + SWATCH / 2.0, top + 6.0), &Paint::line(Role::Ink, 1.1));
    canvas.text(left + SWATCH + 6.0, top + 10.2, words, Font::new(LABEL_PX, Anchor::Start));
}
