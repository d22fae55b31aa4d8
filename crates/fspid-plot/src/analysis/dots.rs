//! Dots along curves that tell the frequency there.

use super::chart::{Chart, distance};
use super::clip::Point;
use super::response::{LoopCurve, round_frequencies};
use crate::axis::{extent, short_number};
use crate::sign::Sign;
use crate::style::Role;
use crate::svg::Canvas;

/// Smallest distance of two dots of one curve (px).
const APART: f64 = 34.0;

/// Marks round frequencies on each curve; `place` tells where a curve is at a frequency.
pub(super) fn frequencies(
    canvas: &mut Canvas,
    chart: &mut Chart,
    curves: &[LoopCurve],
    place: impl Fn(&LoopCurve, f64) -> Option<Point>,
) {
    let mut labelled = Vec::new();
    for curve in curves {
        let range = extent(curve.points.iter().map(|p| p.frequency_rad_s).filter(|f| *f > 0.0));
        let mut last: Option<Point> = None;
        for frequency in round_frequencies(range) {
            let Some(at) = place(curve, frequency) else { continue };
            let Some(seen) = chart.visible(at.0, at.1) else { continue };
            if last.is_none_or(|last| distance(last, seen) >= APART) {
                last = Some(seen);
                chart.sign(canvas, at, Sign::Dot, curve.style.role());
                labelled.push((at, frequency, curve.style.role()));
            }
        }
    }
    // One curve needs no colours to tell whose frequency it is.
    let alone = curves.len() < 2;
    for (at, frequency, role) in labelled {
        let role = if alone { Role::Ink } else { role };
        chart.label(canvas, at, &short_number(frequency), role);
    }
}
