//! The spectral radius of the frozen loop along a flight.

use super::chart::Chart;
use super::stack::{Panel, Stack};
use crate::axis::{Axis, extent, short_number, with_minus};
use crate::line::Series;
use crate::page::{Entry, Swatch};
use crate::sign::Sign;
use crate::style::Role;
use crate::svg::{Canvas, Paint, Svg};

/// Spectral radii along a flown path, over the gains flown there.
#[derive(Debug, Clone, PartialEq)]
pub struct RadiusFigure {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Name and unit of the abscissa, such as "time" in s.
    pub x_label: String,
    /// One line a linearisation: gains frozen, gains with their derivatives.
    pub radii: Vec<Series>,
    /// Gains or anything else over the same abscissa, in a panel of its own; empty for none.
    pub below: Vec<Series>,
    /// Name of the lower panel's ordinate.
    pub below_label: String,
    /// Width of the figure (px).
    pub width_px: f64,
}

/// Radii beyond these are cut off.
const RADII: (f64, f64) = (0.0, 3.0);

impl RadiusFigure {
    /// Draws the figure; shaded where any radius is not below 1.
    #[must_use]
    pub fn render(&self) -> Svg {
        let all = self.radii.iter().chain(&self.below);
        let x = extent(all.flat_map(|series| series.points().map(|point| point.0)));
        let mut panels = vec![Panel {
            y_label: "spectral radius",
            y: self.ordinate(),
            height: 220.0,
            references: vec![1.0],
        }];
        if !self.below.is_empty() {
            let y = extent(self.below.iter().flat_map(|series| series.points().map(|p| p.1)));
            let y = Axis::linear(y, 0.06, 5);
            panels.push(Panel {
                y_label: &self.below_label,
                y,
                height: 140.0,
                references: Vec::new(),
            });
        }
        let stack = Stack {
            title: &self.title,
            legend: self.entries(),
            x_label: &self.x_label,
            x: Axis::linear(x, 0.0, (self.width_px.clamp(300.0, 2400.0) / 90.0) as usize),
            panels,
            width_px: self.width_px,
        };
        let (mut canvas, mut charts) = stack.open();
        for (chart, series) in charts.iter_mut().zip([&self.radii, &self.below]) {
            self.shade(&mut canvas, chart);
            for one in series {
                chart.curve(&mut canvas, one.points(), one.style);
            }
        }
        if let Some(chart) = charts.first_mut() {
            self.mark(&mut canvas, chart);
        }
        canvas.finish(&self.title, &self.describe())
    }

    /// Radii are shown around 1, from where most of them are.
    fn ordinate(&self) -> Axis {
        let found = extent(self.radii.iter().flat_map(|series| series.points().map(|p| p.1)));
        let (lo, hi) = found.unwrap_or((0.9, 1.0));
        let (lo, hi) = (lo.clamp(RADII.0, RADII.1).min(1.0), hi.clamp(RADII.0, RADII.1).max(1.0));
        let span = (hi - lo).max(1e-6);
        // Room above for what is written at the greatest radius.
        Axis::linear(Some((lo, hi + 0.14 * span)), 0.04, 6)
    }

    fn entries(&self) -> Vec<Entry> {
        let line = |series: &Series| Entry {
            name: series.name.clone(),
            swatch: Swatch::Line { style: series.style, marked: false },
        };
        let limit = Entry { name: "limit of stability".to_owned(), swatch: Swatch::Reference };
        let mut entries: Vec<Entry> = self.radii.iter().chain(&self.below).map(line).collect();
        entries.push(limit);
        if !self.spans().is_empty() {
            entries.push(Entry { name: "not below 1".to_owned(), swatch: Swatch::Band });
        }
        entries
    }

    /// Where any of the radii is not below 1: from its sample to the next one.
    fn spans(&self) -> Vec<(f64, f64)> {
        let mut spans: Vec<(f64, f64)> = Vec::new();
        for series in &self.radii {
            let points: Vec<(f64, f64)> = series.points().collect();
            for (n, &(x, radius)) in points.iter().enumerate() {
                if radius >= 1.0 && x.is_finite() {
                    let end = points.get(n + 1).map_or(x, |next| next.0);
                    spans.push((x, if end >= x { end } else { x }));
                }
            }
        }
        spans.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut joined: Vec<(f64, f64)> = Vec::new();
        for span in spans {
            match joined.last_mut() {
                Some(last) if span.0 <= last.1 => last.1 = last.1.max(span.1),
                _ => joined.push(span),
            }
        }
        joined
    }

    fn shade(&self, canvas: &mut Canvas, chart: &Chart) {
        let a = chart.frame.area;
        canvas.begin_clip(a);
        for (from, to) in self.spans() {
            let (west, east) = (chart.frame.place(from, 0.0).0, chart.frame.place(to, 0.0).0);
            // An excursion of one sample shall be seen too.
            let width = (east - west).max(1.0);
            if west.is_finite() && width.is_finite() {
                canvas.rect(west, a.y, width, a.height, &Paint::face(Role::Band).opacity(0.3));
            }
        }
        canvas.end();
    }

    /// The greatest radius of each line.
    fn mark(&self, canvas: &mut Canvas, chart: &mut Chart) {
        let greatest: Vec<(f64, f64, Role)> = self
            .radii
            .iter()
            .filter_map(|series| {
                let (x, radius) = greatest(series)?;
                Some((x, radius, series.style.role()))
            })
            .collect();
        for &(x, radius, role) in &greatest {
            chart.sign(canvas, (x, radius), Sign::Triangle, role);
        }
        for &(x, radius, role) in &greatest {
            let text = format!("{} at {}", precise(radius), short_number(x));
            chart.label(canvas, (x, radius), &text, role);
        }
    }

    fn describe(&self) -> String {
        let mut text = format!("Spectral radius against {}; stable below 1.", self.x_label);
        for series in &self.radii {
            if let Some((x, radius)) = greatest(series) {
                let (radius, x) = (precise(radius), short_number(x));
                text.push_str(&format!(" {}: at most {radius}, at {x};", series.name));
            }
        }
        text
    }
}

fn greatest(series: &Series) -> Option<(f64, f64)> {
    let finite = series.points().filter(|point| point.0.is_finite() && point.1.is_finite());
    finite.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// A radius to five decimals: those of slow loops differ from 1 in the third.
fn precise(radius: f64) -> String {
    if radius.abs() < 100.0 { with_minus(&format!("{radius:.5}")) } else { short_number(radius) }
}
