//! Runs over two of their parameters: which failed, and which did not.

use super::areas::{self, abscissa, fitted, name_abscissa, ordinate};
use crate::axis::{Axis, extent};
use crate::cursor;
use crate::page::{self, EDGE, Entry, LABEL_PX, Legend, Swatch};
use crate::sign::Sign;
use crate::style::Role;
use crate::svg::{Canvas, Paint, Rect, Svg, polyline_data};
use crate::text::{escape, unmarked};

/// Runs over two parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct RunScatter {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Name of the parameter along the abscissa.
    pub x_label: String,
    /// Name of the parameter along the ordinate.
    pub y_label: String,
    /// Ends of both axes; `None` takes those of the points.
    pub ranges: [Option<(f64, f64)>; 2],
    /// Runs that are well.
    pub passed: Vec<(f64, f64)>,
    /// Runs that failed, drawn above the others.
    pub failed: Vec<(f64, f64)>,
    /// What is said of both in the legend: passed, failed.
    pub names: [String; 2],
    /// Numbers of the runs of both, in the order of their points; empty where they are not known.
    pub runs: [Vec<u64>; 2],
}

/// Side of the plot area (px).
pub(super) const SIDE: f64 = 380.0;

impl RunScatter {
    /// Draws the figure.
    #[must_use]
    pub fn render(&self) -> Svg {
        let all = || self.passed.iter().chain(&self.failed);
        let axis = |n: usize, found| {
            Axis::fixed(self.ranges[n], 6).unwrap_or_else(|| Axis::linear(found, 0.02, 6))
        };
        let x = axis(0, extent(all().map(|point| point.0)));
        let y = axis(1, extent(all().map(|point| point.1)));
        let left = EDGE + page::upright_room(1) + page::tick_room(&y);
        let width = left + SIDE + 30.0;
        let swatches =
            [Swatch::Sign(Sign::Ring, Role::Series(0)), Swatch::Sign(Sign::Cross, Role::Series(1))];
        let entries = self
            .names
            .iter()
            .zip(swatches)
            .map(|(name, swatch)| Entry { name: fitted(name, LABEL_PX, SIDE - 40.0), swatch });
        let legend = Legend::set(entries.collect(), SIDE);
        let shown = areas::title(&self.title, width);
        let title = page::title_height(&shown, width);
        let top = title + legend.height() + 2.0;
        let mut canvas = Canvas::new(width, top + SIDE + 50.0);
        page::title(&mut canvas, &shown);
        legend.draw(&mut canvas, left, title);
        let area = Rect { x: left, y: top, width: SIDE, height: SIDE };
        abscissa(&mut canvas, area, &x, true);
        ordinate(&mut canvas, area, &y);
        canvas.begin_marked(&cursor::panel(area, &x, &y));
        canvas.begin_clip(area);
        let place = |(px, py): &(f64, f64)| {
            let at = (area.x + x.fraction(*px) * SIDE, area.y + (1.0 - y.fraction(*py)) * SIDE);
            let near = |v: f64, from: f64| v >= from - 9.0 && v <= from + SIDE + 9.0;
            (near(at.0, area.x) && near(at.1, area.y)).then_some(at)
        };
        let [rings, crosses] = [(&self.passed, 0), (&self.failed, 1)].map(|(points, n)| {
            let seen =
                points.iter().enumerate().filter_map(|(at, point)| Some((at, place(point)?)));
            let numbers = seen.clone().filter_map(|(at, _)| self.runs[n].get(at).copied());
            let sign = if n == 0 { ring } else { cross };
            (
                seen.clone().map(|(_, at)| sign(at)).collect::<String>(),
                numbers.collect::<Vec<u64>>(),
            )
        });
        let passed = (rings, Paint::line(Role::Series(0), 0.9).opacity(0.7), RING_MARK);
        let failed = (crosses, Paint::line(Role::Series(1), 1.5), CROSS_MARK);
        for (((d, runs), paint, mark), name) in [passed, failed].into_iter().zip(&self.names) {
            if !d.is_empty() {
                let name = escape(&unmarked(name));
                canvas.begin_marked(&format!("{mark} data-name=\"{name}\"{}", numbered(&runs)));
                canvas.path(&d, &paint);
                canvas.end();
            }
        }
        canvas.end();
        canvas.end();
        name_abscissa(&mut canvas, area, &self.x_label);
        let label = [fitted(&self.y_label, LABEL_PX, SIDE)];
        page::upright_label(&mut canvas, EDGE + LABEL_PX, area.y + SIDE / 2.0, &label);
        canvas.finish(&self.title, &self.describe())
    }

    fn describe(&self) -> String {
        format!(
            "Runs over {} and {}: {} {}, {} {}.",
            self.x_label,
            self.y_label,
            self.passed.len(),
            self.names[0],
            self.failed.len(),
            self.names[1]
        )
    }
}

/// Where the point of a sign is from its first corner (px), and how many strokes a sign has.
const RING_MARK: &str = "data-points=\"-2.4 1 1\"";
const CROSS_MARK: &str = "data-points=\"3.2 3.2 2\"";

/// The numbers of the runs, each less the one before: those that follow are short.
fn numbered(runs: &[u64]) -> String {
    if runs.is_empty() {
        return String::new();
    }
    let before = std::iter::once(0).chain(runs.iter().copied());
    let steps = runs
        .iter()
        .zip(before)
        .map(|(run, before)| (i128::from(*run) - i128::from(before)).to_string());
    format!(" data-runs=\"{}\"", steps.collect::<Vec<_>>().join(" "))
}

/// One path for all of a kind keeps the file small; a ring of eight corners looks round at this size.
fn ring((x, y): (f64, f64)) -> String {
    let (a, b) = (2.4, 1.0);
    let corners = [(a, -b), (a, b), (b, a), (-b, a), (-a, b), (-a, -b), (-b, -a), (b, -a)];
    polyline_data(&corners.map(|(dx, dy)| (x + dx, y + dy)), true)
}

fn cross((x, y): (f64, f64)) -> String {
    let a = 3.2;
    let stroke = |dy: f64| polyline_data(&[(x - a, y - dy), (x + a, y + dy)], false);
    stroke(a) + &stroke(-a)
}
