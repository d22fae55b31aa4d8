//! Open-loop gain over phase, with lines of equal closed-loop gain.

use super::bode::critical_phases;
use super::chart::{self, Chart};
use super::clip::Point;
use super::response::{LoopCurve, Polar, polar_at};
use super::{dots, frequency};
use crate::axis::{Axis, extent, short_number};
use crate::page::{self, EDGE, Entry, Legend, Swatch};
use crate::plot::Frame;
use crate::sign::Sign;
use crate::style::{Role, SeriesStyle};
use crate::svg::{Canvas, Paint, Rect, Svg};

/// Open loops in the plane of phase and gain.
#[derive(Debug, Clone, PartialEq)]
pub struct NicholsFigure {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// One curve a loop.
    pub curves: Vec<LoopCurve>,
    /// Levels of $|L / (1 + L)|$ to be drawn as contours (dB), such as [`CLOSED_LOOP_DB`].
    pub contours_db: Vec<f64>,
    /// The region around each critical point that the curves shall stay out of.
    pub exclusion: Option<Exclusion>,
    /// Width of the figure (px).
    pub width_px: f64,
}

/// Levels of the closed loop's gain that a Nichols chart usually shows (dB).
pub const CLOSED_LOOP_DB: [f64; 7] = [6.0, 3.0, 1.0, 0.0, -1.0, -3.0, -6.0];

/// A region around the critical points at 0 dB and odd multiples of 180 deg.
#[derive(Debug, Clone, PartialEq)]
pub struct Exclusion {
    /// Name in the legend.
    pub name: String,
    /// Corners of its outline as offsets from the critical point: phase (deg), gain (dB).
    pub corners: Vec<(f64, f64)>,
}

impl Exclusion {
    /// A box that reaches `gain_db` up and down and `phase_deg` to both sides, such as 6 dB and 45 deg of
    /// MIL-F-9490D 3.1.3.6. The clause asks for each margin alone; to stay out of the box is more than that.
    #[must_use]
    pub fn boxed(name: &str, gain_db: f64, phase_deg: f64) -> Self {
        let (g, p) = (gain_db, phase_deg);
        Self { name: name.to_owned(), corners: vec![(-p, -g), (p, -g), (p, g), (-p, g)] }
    }

    /// A diamond with the same reach: what the two margins alone ask for, joined by straight lines.
    #[must_use]
    pub fn diamond(name: &str, gain_db: f64, phase_deg: f64) -> Self {
        let (g, p) = (gain_db, phase_deg);
        Self { name: name.to_owned(), corners: vec![(0.0, -g), (p, 0.0), (0.0, g), (-p, 0.0)] }
    }
}

/// Gains that are shown at most and at least (dB).
const GAIN_DB: (f64, f64) = (-30.0, 30.0);
const GAIN_SHOWN: (f64, f64) = (-18.0, 18.0);
/// The same for phases (deg).
const PHASE_DEG: (f64, f64) = (-600.0, 90.0);
const PHASE_SHOWN: (f64, f64) = (-270.0, -80.0);
const HEIGHT: f64 = 420.0;

impl NicholsFigure {
    /// Draws the figure.
    #[must_use]
    pub fn render(&self) -> Svg {
        let curves: Vec<Vec<Polar>> = self.curves.iter().map(LoopCurve::polar).collect();
        let width = page::sane_width(self.width_px);
        let y = Axis::linear(Some(gain_range(&curves)), 0.02, 9);
        let left = EDGE + page::upright_room(1) + page::tick_room(&y);
        let legend = Legend::set(self.entries(), width - left - EDGE);
        let legend_top = page::title_height(&self.title, width);
        let top = legend_top + legend.height() + 4.0;
        let mut canvas = Canvas::new(width, top + HEIGHT + 48.0);
        page::title(&mut canvas, &self.title);
        legend.draw(&mut canvas, left, legend_top);
        let area = Rect { x: left, y: top, width: width - left - EDGE - 8.0, height: HEIGHT };
        let phases = phase_range(&curves);
        let x = Axis::degrees(Some(phases), 0.02, (width / 80.0) as usize);
        let mut chart = Chart::new(Frame { area, x, y, x_labels: true });
        let centres = critical_phases((x.lo, x.hi));
        self.exclude(&mut canvas, &chart, &centres);
        chart.axes(&mut canvas, &[0.0]);
        chart.name_axes(&mut canvas, "open-loop phase [deg]", "open-loop gain [dB]");
        self.contours(&mut canvas, &mut chart, &centres);
        self.draw(&mut canvas, &mut chart, &curves, &centres);
        canvas.finish(&self.title, &self.describe())
    }

    fn entries(&self) -> Vec<Entry> {
        let region = self
            .exclusion
            .iter()
            .map(|exclusion| Entry { name: exclusion.name.clone(), swatch: Swatch::Band });
        let contours = (!self.contours_db.is_empty()).then(|| Entry {
            name: "closed-loop gain [dB]".to_owned(),
            swatch: Swatch::Line { style: SeriesStyle::SetpointDashed, marked: false },
        });
        let dots = Entry {
            name: "frequency [rad/s]".to_owned(),
            swatch: Swatch::Sign(Sign::Dot, Role::Ink),
        };
        frequency::legend(&self.curves)
            .into_iter()
            .chain(region)
            .chain(contours)
            .chain([dots])
            .collect()
    }

    fn exclude(&self, canvas: &mut Canvas, chart: &Chart, centres: &[f64]) {
        let Some(exclusion) = &self.exclusion else { return };
        canvas.begin_clip(chart.frame.area);
        for centre in centres {
            let corner = |&(phase, gain): &(f64, f64)| chart.frame.place(centre + phase, gain);
            let outline: Vec<Point> = exclusion.corners.iter().map(corner).collect();
            if outline.iter().all(|(x, y)| x.is_finite() && y.is_finite()) {
                canvas.polyline(&outline, true, &Paint::face(Role::Band).opacity(0.3));
                canvas.polyline(&outline, true, &Paint::line(Role::Band, 1.4));
            }
        }
        canvas.end();
    }

    fn contours(&self, canvas: &mut Canvas, chart: &mut Chart, centres: &[f64]) {
        let style = SeriesStyle::SetpointDashed;
        let paint = Paint::line(style.role(), 0.9).dashed(style.dash());
        for &level in self.contours_db.iter().filter(|level| level.is_finite()) {
            for centre in centres {
                let line = contour(level).into_iter().map(|(phase, gain)| (centre + phase, gain));
                chart.quiet_line(canvas, line, &paint);
            }
        }
    }

    fn draw(&self, canvas: &mut Canvas, chart: &mut Chart, curves: &[Vec<Polar>], centres: &[f64]) {
        for (points, curve) in curves.iter().zip(&self.curves) {
            let line = points.iter().map(|p| (p.phase_deg, p.gain_db));
            let runs = chart.curve(canvas, line, curve.style);
            chart::arrows(canvas, &runs, curve.style.role());
        }
        for centre in centres {
            chart.sign(canvas, (*centre, 0.0), Sign::Plus, Role::Ink);
        }
        dots::frequencies(canvas, chart, &self.curves, |curve, at| {
            let n = self.curves.iter().position(|other| std::ptr::eq(other, curve))?;
            polar_at(curves.get(n)?, at).map(|p| (p.phase_deg, p.gain_db))
        });
        self.name_contours(canvas, chart, centres);
    }

    /// The level on each contour, once per critical point.
    fn name_contours(&self, canvas: &mut Canvas, chart: &mut Chart, centres: &[f64]) {
        for &level in self.contours_db.iter().filter(|level| level.is_finite()) {
            let text = format!("{} dB", short_number(level));
            let line = contour(level);
            for centre in centres {
                // From the top of a closed contour, from the left end of another.
                let from = if level > 0.0 { line.len() / 4 } else { 0 };
                let places = line.iter().cycle().skip(from).take(line.len());
                let seen: Vec<Point> =
                    places.filter_map(|at| chart.visible(centre + at.0, at.1)).step_by(4).collect();
                chart.labels.put_first(canvas, &seen, &text);
            }
        }
    }

    fn describe(&self) -> String {
        let names: Vec<&str> = self.curves.iter().map(|curve| curve.name.as_str()).collect();
        let region = self.exclusion.as_ref().map_or("none", |exclusion| exclusion.name.as_str());
        format!(
            "Open-loop gain in dB over open-loop phase in degrees: {}. Region to stay out of: {region}.",
            names.join("; ")
        )
    }
}

fn gain_range(curves: &[Vec<Polar>]) -> (f64, f64) {
    let gains = curves.iter().flatten().map(|p| p.gain_db);
    frequency::cut(extent(gains), GAIN_DB, GAIN_SHOWN)
}

/// The phases of what is within the gains that are shown.
fn phase_range(curves: &[Vec<Polar>]) -> (f64, f64) {
    let (lo, hi) = gain_range(curves);
    let seen = curves.iter().flatten().filter(|p| p.gain_db >= lo && p.gain_db <= hi);
    frequency::cut(extent(seen.map(|p| p.phase_deg)), PHASE_DEG, PHASE_SHOWN)
}

/// Points (deg from the critical phase, dB) at which the closed loop has the gain `level_db`.
///
/// With $M$ the level and $\psi$ the phase from -180 deg, $g = |L|$ solves
/// $$ g^2 (M^2 - 1) - 2 g M^2 \cos\psi + M^2 = 0 $$
fn contour(level_db: f64) -> Vec<Point> {
    let m = libm::exp10(level_db.clamp(-200.0, 200.0) / 20.0);
    let point = |psi: f64, gain: f64| (psi.to_degrees(), 20.0 * libm::log10(gain));
    let part = |n: i32| f64::from(n) / 90.0;
    if level_db.abs() < 1e-6 {
        // The gain is 1 / (2 cos psi): half the distance between the origin and -1.
        let psi = |n: i32| part(n) * 0.9999 * std::f64::consts::FRAC_PI_2;
        return (-90..=90).map(|n| point(psi(n), 0.5 / libm::cos(psi(n)))).collect();
    }
    let root = |psi: f64, sign: f64| {
        let (sine, cosine) = (libm::sin(psi), libm::cos(psi));
        let rest = (1.0 - m * m * sine * sine).max(0.0).sqrt();
        m * (m * cosine + sign * rest) / (m * m - 1.0)
    };
    if m < 1.0 {
        // The circle goes around the origin: every phase has one gain.
        let psi = |n: i32| part(n) * std::f64::consts::PI;
        return (-90..=90).map(|n| point(psi(n), root(psi(n), -1.0))).collect();
    }
    // The circle goes around -1: two gains up to the phase at which a ray only touches it.
    let most = libm::asin(1.0 / m);
    let psi = |n: i32| most * libm::sin(part(n) * std::f64::consts::FRAC_PI_2);
    let upper = (-90..=90).map(|n| point(psi(n), root(psi(n), 1.0)));
    upper.chain((-90..=90).rev().map(|n| point(psi(n), root(psi(n), -1.0)))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closed_loop_has_its_level_everywhere_on_a_contour() {
        for level in [12.0, 6.0, 3.0, 1.0, 0.25, 0.0, -0.5, -3.0, -20.0] {
            for (psi_deg, gain_db) in contour(level) {
                let (g, phase) = (10_f64.powf(gain_db / 20.0), (psi_deg - 180.0).to_radians());
                let (re, im) = (g * phase.cos(), g * phase.sin());
                let closed = g / ((1.0 + re).powi(2) + im * im).sqrt();
                // Near the rays that only touch, a rounded root still is one to 1e-6 dB.
                let found = 20.0 * closed.log10();
                assert!((found - level).abs() < 1e-6, "{level}: {found} at {psi_deg}");
            }
        }
    }

    #[test]
    fn a_contour_above_0_db_goes_around_the_critical_point() {
        let loop_ = contour(6.0);
        let above = loop_.iter().any(|point| point.0.abs() < 1e-9 && point.1 > 0.0);
        let below = loop_.iter().any(|point| point.0.abs() < 1e-9 && point.1 < 0.0);
        assert!(above && below);
        assert!((loop_[0].0 - loop_[loop_.len() - 1].0).abs() < 1e-9);
    }
}
