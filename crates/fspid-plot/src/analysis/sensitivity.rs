//! Sensitivity and complementary sensitivity over frequency.

use super::chart::Chart;
use super::clip::Point;
use super::frequency::{self, nyquist_line};
use super::response::{LoopCurve, LoopPoint};
use super::stack::{Panel, Stack};
use crate::axis::{Axis, extent, short_number};
use crate::sign::Sign;
use crate::style::Role;
use crate::svg::{Canvas, Paint, Svg};

/// $|S| = |1/(1+L)|$, $|T| = |L/(1+L)|$ and, for the disk margin, $|S - T|/2$.
#[derive(Debug, Clone, PartialEq)]
pub struct SensitivityFigure {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// One curve a loop.
    pub curves: Vec<LoopCurve>,
    /// Peaks to be marked, with their values as computed by the caller.
    pub peaks: Vec<PeakMark>,
    /// Disk margins $\alpha$ of zero skew: position of the curve, and size. $1/\alpha$ is the peak of
    /// $|S - T|/2$, which is shown in a panel of its own if there is any.
    pub disk_margins: Vec<(usize, f64)>,
    /// Nyquist frequency of the sampling (rad/s), marked by an upright line.
    pub nyquist_rad_s: Option<f64>,
    /// Width of the figure (px).
    pub width_px: f64,
}

/// A transfer from the loop's edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Transfer {
    /// $S = 1/(1+L)$.
    Sensitivity,
    /// $T = L/(1+L)$.
    Complementary,
}

/// The peak of a transfer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeakMark {
    /// Position of the curve in the figure.
    pub curve: usize,
    /// Which transfer.
    pub transfer: Transfer,
    /// Where it is (rad/s).
    pub frequency_rad_s: f64,
    /// How high it is (dB).
    pub peak_db: f64,
}

/// Values beyond these are cut off (dB).
const RANGE_DB: (f64, f64) = (-30.0, 40.0);
const SHOWN_DB: (f64, f64) = (-12.0, 6.0);

impl SensitivityFigure {
    /// Draws the figure.
    #[must_use]
    pub fn render(&self) -> Svg {
        let kinds = self.kinds();
        let labels = ["|S| [dB]", "|T| [dB]", "|S \u{2212} T| / 2 [dB]"];
        let panels = kinds.iter().zip(labels).map(|(kind, y_label)| Panel {
            y_label,
            y: self.axis(*kind),
            height: 160.0,
            references: if matches!(kind, Kind::Of(_)) { vec![0.0] } else { Vec::new() },
        });
        let frequencies =
            self.curves.iter().flat_map(|c| c.points.iter().map(|p| p.frequency_rad_s));
        let stack = Stack {
            title: &self.title,
            legend: frequency::legend(&self.curves),
            x_label: "frequency [rad/s]",
            x: frequency::axis(frequencies, self.nyquist_rad_s),
            panels: panels.collect(),
            width_px: self.width_px,
        };
        let (mut canvas, mut charts) = stack.open();
        for (n, (chart, kind)) in charts.iter_mut().zip(kinds).enumerate() {
            for curve in &self.curves {
                chart.curve(&mut canvas, values(curve, kind), curve.style);
            }
            nyquist_line(&mut canvas, chart, self.nyquist_rad_s, n == 0);
            match kind {
                Kind::Of(transfer) => self.mark(&mut canvas, chart, transfer),
                Kind::Difference => self.mark_disks(&mut canvas, chart),
            }
        }
        canvas.finish(&self.title, &self.describe())
    }

    fn kinds(&self) -> Vec<Kind> {
        let mut kinds = vec![Kind::Of(Transfer::Sensitivity), Kind::Of(Transfer::Complementary)];
        if !self.disk_margins.is_empty() {
            kinds.push(Kind::Difference);
        }
        kinds
    }

    fn axis(&self, kind: Kind) -> Axis {
        let found = extent(self.curves.iter().flat_map(|c| values(c, kind)).map(|point| point.1));
        let marked = self.peaks.iter().map(|peak| peak.peak_db);
        let (lo, hi) = frequency::cut(found, RANGE_DB, SHOWN_DB);
        let top = marked.filter(|db| *db <= RANGE_DB.1).fold(hi, f64::max);
        // Room above the peaks for what is written there.
        Axis::linear(Some((lo, top + 0.16 * (top - lo))), 0.03, 6)
    }

    fn mark(&self, canvas: &mut Canvas, chart: &mut Chart, transfer: Transfer) {
        let seen: Vec<&PeakMark> = self.peaks.iter().filter(|p| p.transfer == transfer).collect();
        for peak in &seen {
            let role = self.role(peak.curve);
            chart.sign(canvas, (peak.frequency_rad_s, peak.peak_db), Sign::Triangle, role);
        }
        let name = if transfer == Transfer::Sensitivity { "M_{s}" } else { "M_{t}" };
        for peak in seen {
            let (at, db) = (short_number(peak.frequency_rad_s), short_number(peak.peak_db));
            let text = format!("{name} {db} dB at {at} rad/s");
            let role = self.role(peak.curve);
            chart.label(canvas, (peak.frequency_rad_s, peak.peak_db), &text, role);
        }
    }

    /// A dashed line at each $1/\alpha$, in the colour of its curve.
    fn mark_disks(&self, canvas: &mut Canvas, chart: &mut Chart) {
        let a = chart.frame.area;
        let mut drawn = Vec::new();
        for &(curve, alpha) in self.disk_margins.iter().filter(|(_, alpha)| *alpha > 0.0) {
            let level = -20.0 * libm::log10(alpha);
            let y = chart.frame.place(0.0, level).1;
            if y >= a.y && y <= a.y + a.height {
                let ends = [(a.x, y), (a.x + a.width, y)];
                canvas.line(ends[0], ends[1], &Paint::line(self.role(curve), 1.2).dashed("6 3"));
                chart.labels.avoid_line(&ends);
                let (alpha, level) = (short_number(alpha), short_number(level));
                drawn.push((y, format!("\u{3b1} = {alpha}, 1/\u{3b1}: {level} dB"), curve));
            }
        }
        for (y, text, curve) in drawn {
            let along = [0.01, 0.2, 0.35, 0.5, 0.65].map(|part| (a.x + part * a.width, y));
            chart.labels.put_along(canvas, &along, &text, self.role(curve));
        }
    }

    fn role(&self, curve: usize) -> Role {
        self.curves.get(curve).map_or(Role::Ink, |curve| curve.style.role())
    }

    fn describe(&self) -> String {
        let mut text =
            String::from("Sensitivity and complementary sensitivity in dB against frequency:");
        for (n, curve) in self.curves.iter().enumerate() {
            text.push_str(&format!(" {}", curve.name));
            for peak in self.peaks.iter().filter(|peak| peak.curve == n) {
                let name = if peak.transfer == Transfer::Sensitivity { "Ms" } else { "Mt" };
                let (at, db) = (short_number(peak.frequency_rad_s), short_number(peak.peak_db));
                text.push_str(&format!(", {name} {db} dB at {at} rad/s"));
            }
            for (_, alpha) in self.disk_margins.iter().filter(|(curve, _)| *curve == n) {
                text.push_str(&format!(", disk margin {}", short_number(*alpha)));
            }
            text.push(';');
        }
        text
    }
}

#[derive(Debug, Clone, Copy)]
enum Kind {
    Of(Transfer),
    Difference,
}

impl LoopCurve {
    /// Magnitude of the sensitivity or of the complementary sensitivity along the curve (dB).
    #[must_use]
    pub fn transfer_db(&self, transfer: Transfer) -> Vec<f64> {
        values(self, Kind::Of(transfer)).map(|(_, magnitude_db)| magnitude_db).collect()
    }
}

fn values(curve: &LoopCurve, kind: Kind) -> impl Iterator<Item = Point> + Clone {
    curve.points.iter().map(move |point| (point.frequency_rad_s, magnitude_db(*point, kind)))
}

fn magnitude_db(point: LoopPoint, kind: Kind) -> f64 {
    let (re, im) = (point.real, point.imaginary);
    let above = match kind {
        Kind::Of(Transfer::Sensitivity) => 1.0,
        Kind::Of(Transfer::Complementary) => libm::hypot(re, im),
        Kind::Difference => libm::hypot(1.0 - re, im) / 2.0,
    };
    20.0 * libm::log10(above / libm::hypot(1.0 + re, im))
}
