//! What figures over frequency share.

use super::chart::Chart;
use super::response::LoopCurve;
use crate::axis::{Axis, extent, short_number};
use crate::page::{Entry, Swatch};
use crate::style::Role;
use crate::svg::{Canvas, Paint};

/// A logarithmic axis over the frequencies that are shown (rad/s), up to the Nyquist frequency at least.
pub(super) fn axis(frequencies: impl Iterator<Item = f64>, nyquist_rad_s: Option<f64>) -> Axis {
    let positive = frequencies.chain(nyquist_rad_s).filter(|f| *f > 0.0);
    // No loop has anything to say over more than eight decades.
    let range = extent(positive).map(|(lo, hi)| (lo.max(hi * 1e-8), hi));
    Axis::logarithmic(range, 0.015)
}

/// `range` cut to `limits`, and widened so that `shown` is in it.
pub(super) fn cut(range: Option<(f64, f64)>, limits: (f64, f64), shown: (f64, f64)) -> (f64, f64) {
    let (lo, hi) = range.unwrap_or(shown);
    (lo.clamp(limits.0, limits.1).min(shown.0), hi.clamp(limits.0, limits.1).max(shown.1))
}

/// A line for each curve.
pub(super) fn legend(curves: &[LoopCurve]) -> Vec<Entry> {
    let entry = |curve: &LoopCurve| Entry {
        name: curve.name.clone(),
        swatch: Swatch::Line { style: curve.style, marked: false },
    };
    curves.iter().map(entry).collect()
}

/// Marks the Nyquist frequency, with its name where asked.
pub(super) fn nyquist_line(
    canvas: &mut Canvas,
    chart: &mut Chart,
    nyquist_rad_s: Option<f64>,
    named: bool,
) {
    let Some(frequency) = nyquist_rad_s.filter(|f| f.is_finite() && *f > 0.0) else {
        return;
    };
    chart.upright(canvas, frequency, &Paint::line(Role::Muted, 1.2).dashed("8 3 1.5 3"));
    if named {
        let a = chart.frame.area;
        let at = (chart.frame.place(frequency, 0.0).0, a.y + 12.0);
        let text = format!("Nyquist {} rad/s", short_number(frequency));
        chart.labels.put(canvas, at, &text, Role::Muted);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_cut_and_still_shows_what_it_must() {
        assert_eq!(cut(Some((-500.0, 3.0)), (-80.0, 100.0), (-12.0, 12.0)), (-80.0, 12.0));
        assert_eq!(cut(None, (-80.0, 100.0), (-12.0, 12.0)), (-12.0, 12.0));
    }

    #[test]
    fn frequencies_of_zero_or_less_do_not_stretch_the_axis() {
        let axis = axis([0.0, -3.0, 0.1, f64::NAN].into_iter(), Some(100.0));
        assert!(axis.lo < -1.0 && axis.lo > -1.2 && axis.hi > 2.0 && axis.hi < 2.2);
    }
}
