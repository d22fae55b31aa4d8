//! Open loops in the complex plane near the critical point.

use super::chart::{self, Chart};
use super::clip::Point;
use super::response::LoopCurve;
use super::{dots, frequency};
use crate::page::{self, EDGE, Entry, Legend, Swatch};
use crate::sign::Sign;
use crate::style::{Role, SeriesStyle};
use crate::svg::{Canvas, Paint, Svg};

/// The curves $L(e^{j \omega T})$ for positive frequencies near the point -1, on equal axes.
#[derive(Debug, Clone, PartialEq)]
pub struct NyquistFigure {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// One curve a loop.
    pub curves: Vec<LoopCurve>,
    /// Disks that the curves stay out of.
    pub disks: Vec<MarginDisk>,
    /// How far the axes reach from -1 to each side (units of the loop); 2 shows the whole unit circle.
    pub reach: f64,
}

/// The disk around -1 that a loop with a disk margin stays out of.
///
/// With size $\alpha$ and skew $\sigma$ of the margin, the gain factors at its real ends are
/// $$ g = \frac{1 \mp \alpha (1 - \sigma) / 2}{1 \pm \alpha (1 + \sigma) / 2} $$
/// and the disk in the plane of the loop has the diameter from $-1/g_{min}$ to $-1/g_{max}$.
///
/// # Source
/// Seiler, Packard and Gahinet, An introduction to disk margins, IEEE Control Systems 40(5), 2020.
#[derive(Debug, Clone, PartialEq)]
pub struct MarginDisk {
    /// Name in the legend, with the size of the margin.
    pub name: String,
    /// Position of its curve in the figure; it gives the colour.
    pub curve: usize,
    /// Smallest gain factor, between 0 and 1; a disk without it is not drawn.
    pub gain_min: f64,
    /// Largest gain factor, above 1; may be infinite.
    pub gain_max: f64,
}

/// Side of the plot area (px).
const SIDE: f64 = 470.0;
const WIDTH: f64 = SIDE + 100.0;

impl NyquistFigure {
    /// Draws the figure.
    #[must_use]
    pub fn render(&self) -> Svg {
        let legend_top = page::title_height(&self.title, WIDTH);
        let left = EDGE + page::upright_room(1) + 42.0;
        let legend = Legend::set(self.entries(), WIDTH - left - EDGE);
        let top = legend_top + legend.height() + 4.0;
        let mut canvas = Canvas::new(WIDTH, top + SIDE + 48.0);
        page::title(&mut canvas, &self.title);
        legend.draw(&mut canvas, left, legend_top);
        let reach = if self.reach.is_finite() { self.reach.clamp(0.02, 1e4) } else { 2.0 };
        let mut chart = Chart::new(chart::square((left, top), SIDE, (-1.0, 0.0), reach));
        self.shade(&mut canvas, &chart);
        chart.axes(&mut canvas, &[]);
        chart.name_axes(&mut canvas, "real part", "imaginary part");
        self.ground(&mut canvas, &mut chart);
        self.draw(&mut canvas, &mut chart);
        canvas.finish(&self.title, &self.describe())
    }

    fn entries(&self) -> Vec<Entry> {
        let disks = self.disks.iter().filter(|disk| disk.diameter().is_some()).map(|disk| Entry {
            name: disk.name.clone(),
            swatch: Swatch::Area(self.style(disk.curve)),
        });
        let circle = Entry {
            name: "unit circle".to_owned(),
            swatch: Swatch::Line { style: SeriesStyle::SetpointDashed, marked: false },
        };
        let dots = Entry {
            name: "frequency [rad/s]".to_owned(),
            swatch: Swatch::Sign(Sign::Dot, Role::Ink),
        };
        frequency::legend(&self.curves).into_iter().chain([circle, dots]).chain(disks).collect()
    }

    fn style(&self, curve: usize) -> SeriesStyle {
        self.curves.get(curve).map_or(SeriesStyle::Setpoint, |curve| curve.style)
    }

    fn shade(&self, canvas: &mut Canvas, chart: &Chart) {
        canvas.begin_clip(chart.frame.area);
        for disk in &self.disks {
            let Some((west, east)) = disk.diameter() else { continue };
            let (a, b) = (chart.frame.place(west, 0.0), chart.frame.place(east, 0.0));
            let (centre, radius) = (((a.0 + b.0) / 2.0, a.1), (b.0 - a.0) / 2.0);
            let style = self.style(disk.curve);
            canvas.circle(centre, radius, &Paint::face(style.role()).opacity(0.16));
            let edge = Paint::line(style.role(), 1.0).dashed(style.dash());
            canvas.circle(centre, radius, &edge);
        }
        canvas.end();
    }

    /// Axes through the origin, the unit circle and the critical point.
    fn ground(&self, canvas: &mut Canvas, chart: &mut Chart) {
        let far = 2.0 * self.reach.clamp(1.0, 1e4) + 2.0;
        let thin = Paint::line(Role::Setpoint, 0.9);
        chart.quiet_line(canvas, [(-far, 0.0), (far, 0.0)].into_iter(), &thin);
        chart.quiet_line(canvas, [(0.0, -far), (0.0, far)].into_iter(), &thin);
        let style = SeriesStyle::SetpointDashed;
        let paint = Paint::line(style.role(), style.width()).dashed(style.dash());
        chart.line(canvas, circle((0.0, 0.0), 1.0), &paint);
        chart.sign(canvas, (-1.0, 0.0), Sign::Plus, Role::Ink);
    }

    fn draw(&self, canvas: &mut Canvas, chart: &mut Chart) {
        let mut drawn = Vec::new();
        for curve in &self.curves {
            let points = curve.points.iter().map(|point| (point.real, point.imaginary));
            drawn.push(chart.curve(canvas, points, curve.style));
        }
        for (curve, runs) in self.curves.iter().zip(&drawn) {
            chart::arrows(canvas, runs, curve.style.role());
        }
        chart.label(canvas, (-1.0, 0.0), "\u{2212}1", Role::Ink);
        dots::frequencies(canvas, chart, &self.curves, |curve, at| curve.at(at));
    }

    fn describe(&self) -> String {
        let names: Vec<&str> = self.curves.iter().map(|curve| curve.name.as_str()).collect();
        let disks: Vec<&str> = self.disks.iter().map(|disk| disk.name.as_str()).collect();
        let disks = if disks.is_empty() { "none".to_owned() } else { disks.join("; ") };
        format!(
            "Open loops in the complex plane near the point -1: {}. Disks that they stay out of: {disks}.",
            names.join("; ")
        )
    }
}

impl MarginDisk {
    /// Where the disk cuts the real axis, from left to right.
    fn diameter(&self) -> Option<(f64, f64)> {
        let holds = self.gain_min > 0.0 && self.gain_min < 1.0 && self.gain_max > 1.0;
        holds.then(|| (-1.0 / self.gain_min.max(1e-3), -1.0 / self.gain_max))
    }
}

/// Points around a circle.
pub(super) fn circle(centre: Point, radius: f64) -> impl Iterator<Item = Point> + Clone {
    (0..=180).map(move |n| {
        let angle = f64::from(n) * std::f64::consts::TAU / 180.0;
        (centre.0 + radius * libm::cos(angle), centre.1 + radius * libm::sin(angle))
    })
}
