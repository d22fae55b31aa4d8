//! Gain and phase of open loops over frequency, with their margins.

use super::chart::{Chart, head};
use super::frequency::{self, nyquist_line};
use super::response::{LoopCurve, Margin, MarginMark, Polar, polar_at};
use super::stack::{Panel, Stack};
use crate::axis::{Axis, extent, short_number};
use crate::style::Role;
use crate::svg::{Canvas, Paint, Svg};

/// Gain over phase of one or more open loops.
#[derive(Debug, Clone, PartialEq)]
pub struct BodeFigure {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// One curve a loop.
    pub curves: Vec<LoopCurve>,
    /// Margins to be drawn; none for a loop whose closed loop is unstable.
    pub margins: Vec<MarginMark>,
    /// Nyquist frequency of the sampling, $\pi / T$ (rad/s), marked by an upright line.
    pub nyquist_rad_s: Option<f64>,
    /// Width of the figure (px).
    pub width_px: f64,
}

/// Gains beyond these are cut off (dB): what is below matters to no margin, what is above is an integrator.
const GAIN_DB: (f64, f64) = (-80.0, 100.0);
/// Phases beyond these are cut off (deg).
const PHASE_DEG: (f64, f64) = (-900.0, 180.0);

impl BodeFigure {
    /// Draws the figure.
    #[must_use]
    pub fn render(&self) -> Svg {
        let curves: Vec<Vec<Polar>> = self.curves.iter().map(LoopCurve::polar).collect();
        let all = || curves.iter().flatten();
        let gain = frequency::cut(extent(all().map(|p| p.gain_db)), GAIN_DB, (-12.0, 12.0));
        let phase = frequency::cut(extent(all().map(|p| p.phase_deg)), PHASE_DEG, (-200.0, -160.0));
        let gains = Panel {
            y_label: "open-loop gain [dB]",
            y: Axis::linear(Some(gain), 0.05, 7),
            height: 220.0,
            references: vec![0.0],
        };
        let phases = Panel {
            y_label: "open-loop phase [deg]",
            y: Axis::degrees(Some(phase), 0.06, 8),
            height: 190.0,
            references: critical_phases(phase),
        };
        let stack = Stack {
            title: &self.title,
            legend: frequency::legend(&self.curves),
            x_label: "frequency [rad/s]",
            x: frequency::axis(all().map(|p| p.frequency_rad_s), self.nyquist_rad_s),
            panels: vec![gains, phases],
            width_px: self.width_px,
        };
        let (mut canvas, mut charts) = stack.open();
        if let [gain, phase] = charts.as_mut_slice() {
            self.draw(&mut canvas, (gain, phase), &curves);
        }
        canvas.finish(&self.title, &self.describe())
    }

    fn draw(
        &self,
        canvas: &mut Canvas,
        (gain, phase): (&mut Chart, &mut Chart),
        curves: &[Vec<Polar>],
    ) {
        for (points, curve) in curves.iter().zip(&self.curves) {
            let gains = points.iter().map(|p| (p.frequency_rad_s, p.gain_db));
            let phases = points.iter().map(|p| (p.frequency_rad_s, p.phase_deg));
            gain.curve(canvas, gains, curve.style);
            phase.curve(canvas, phases, curve.style);
        }
        let marks: Vec<Drawn> = self.margins.iter().filter_map(|m| self.place(m, curves)).collect();
        for mark in &marks {
            mark.guide(canvas, gain, phase);
        }
        nyquist_line(canvas, gain, self.nyquist_rad_s, true);
        nyquist_line(canvas, phase, self.nyquist_rad_s, false);
        for mark in &marks {
            mark.label(canvas, if mark.on_gain { gain } else { phase });
        }
    }

    fn place(&self, mark: &MarginMark, curves: &[Vec<Polar>]) -> Option<Drawn> {
        let curve = self.curves.get(mark.curve)?;
        let at = polar_at(curves.get(mark.curve)?, mark.frequency_rad_s)?;
        let (on_gain, from, to, text) = match mark.margin {
            Margin::GainDb(db) => (true, -db, 0.0, format!("GM {} dB", short_number(db))),
            Margin::PhaseDeg(deg) => {
                let turn = libm::round((at.phase_deg - deg + 180.0) / 360.0);
                let limit = turn * 360.0 - 180.0;
                (false, limit, limit + deg, format!("PM {}\u{b0}", short_number(deg)))
            }
        };
        let frequency = mark.frequency_rad_s;
        let text = format!("{text} at {} rad/s", short_number(frequency));
        Some(Drawn { on_gain, frequency, from, to, text, role: curve.style.role() })
    }

    fn describe(&self) -> String {
        let mut text = String::from("Gain and phase of open loops against frequency in rad/s:");
        for (n, curve) in self.curves.iter().enumerate() {
            text.push_str(&format!(" {}:", curve.name));
            let of_curve = self.margins.iter().filter(|mark| mark.curve == n);
            let words: Vec<String> = of_curve.map(in_words).collect();
            let words =
                if words.is_empty() { "no margin marked".to_owned() } else { words.join(", ") };
            text.push_str(&format!(" {words};"));
        }
        text
    }
}

/// A margin that has found its place.
struct Drawn {
    on_gain: bool,
    frequency: f64,
    from: f64,
    to: f64,
    text: String,
    role: Role,
}

impl Drawn {
    /// The arrow, and a dotted line that joins the crossing with the curve in the other panel.
    fn guide(&self, canvas: &mut Canvas, gain: &mut Chart, phase: &mut Chart) {
        let dotted = Paint::line(self.role, 0.9).dashed("1.5 2.5").opacity(0.75);
        for chart in [&mut *gain, &mut *phase] {
            chart.upright(canvas, self.frequency, &dotted);
        }
        let chart = if self.on_gain { gain } else { phase };
        let (from, to) = (
            chart.frame.place(self.frequency, self.from),
            chart.frame.place(self.frequency, self.to),
        );
        let length = (to.1 - from.1).abs();
        if !length.is_finite() {
            return;
        }
        canvas.begin_clip(chart.frame.area);
        canvas.line(from, to, &Paint::line(self.role, 2.6));
        if length > 14.0 {
            let down = (to.1 - from.1).signum();
            head(canvas, to, (0.0, down), self.role);
            head(canvas, from, (0.0, -down), self.role);
        }
        canvas.end();
        chart.labels.avoid_line(&[from, to]);
    }

    fn label(&self, canvas: &mut Canvas, chart: &mut Chart) {
        let middle = (self.from + self.to) / 2.0;
        chart.label(canvas, (self.frequency, middle), &self.text, self.role);
    }
}

/// All odd multiples of 180 deg within a range.
pub(super) fn critical_phases((lo, hi): (f64, f64)) -> Vec<f64> {
    let turns = -8..8;
    let phases = turns.map(|turn| f64::from(turn) * 360.0 - 180.0);
    phases.filter(|phase| *phase >= lo - 1.0 && *phase <= hi + 1.0).collect()
}

fn in_words(mark: &MarginMark) -> String {
    let at = short_number(mark.frequency_rad_s);
    match mark.margin {
        Margin::GainDb(db) => format!("gain margin {} dB at {at} rad/s", short_number(db)),
        Margin::PhaseDeg(deg) => format!("phase margin {} deg at {at} rad/s", short_number(deg)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::LoopPoint;
    use crate::style::SeriesStyle;

    /// $L = e^{-j \phi \omega} / \omega$: gain crossing at 1 rad/s with a lag of `lag_deg`.
    fn figure(lag_deg: f64, margin: Margin) -> BodeFigure {
        let point = |n| {
            let w = 0.1 * 1.05_f64.powi(n);
            let phase = (-lag_deg * w).to_radians();
            LoopPoint { frequency_rad_s: w, real: phase.cos() / w, imaginary: phase.sin() / w }
        };
        let curve = LoopCurve {
            name: String::new(),
            style: SeriesStyle::Numbered(0),
            points: (0..80).map(point).collect(),
        };
        BodeFigure {
            title: String::new(),
            curves: vec![curve],
            margins: vec![MarginMark { curve: 0, frequency_rad_s: 1.0, margin }],
            nyquist_rad_s: None,
            width_px: 720.0,
        }
    }

    fn ends(figure: &BodeFigure) -> (f64, f64) {
        let curves: Vec<Vec<Polar>> = figure.curves.iter().map(LoopCurve::polar).collect();
        let drawn = figure.place(&figure.margins[0], &curves).unwrap();
        (drawn.from, drawn.to)
    }

    #[test]
    fn a_phase_margin_stands_on_the_critical_phase_below_its_crossing_even_turns_later() {
        assert_eq!(ends(&figure(120.0, Margin::PhaseDeg(60.0))), (-180.0, -120.0));
        assert_eq!(ends(&figure(10.0, Margin::PhaseDeg(170.0))), (-180.0, -10.0));
        assert_eq!(ends(&figure(200.0, Margin::PhaseDeg(-20.0))), (-180.0, -200.0));
        assert_eq!(ends(&figure(530.0, Margin::PhaseDeg(10.0))), (-540.0, -530.0));
    }

    #[test]
    fn a_gain_margin_reaches_from_the_curve_to_0_db() {
        assert_eq!(ends(&figure(180.0, Margin::GainDb(6.0))), (-6.0, 0.0));
        assert_eq!(ends(&figure(180.0, Margin::GainDb(-3.0))), (3.0, 0.0));
    }
}
