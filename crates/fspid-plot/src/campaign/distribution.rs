//! Histograms of one measure, a row each on the same axis, with medians, percentiles and limits.

use super::areas::{self, abscissa, fitted, name_abscissa};
use crate::axis::{Axis, extent, short_number};
use crate::cursor::{self, Cells};
use crate::page::{self, EDGE, LABEL_PX};
use crate::plot::TICK_PX;
use crate::style::{Role, SeriesStyle};
use crate::svg::{Anchor, Canvas, Font, Paint, Rect, Svg};
use crate::text::text_width;

/// How a measure is distributed, for each of some controllers.
#[derive(Debug, Clone, PartialEq)]
pub struct DistributionFigure {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Name and unit of the measure.
    pub x_label: String,
    /// Rows from top to bottom.
    pub rows: Vec<DistributionRow>,
    /// What is required of the measure: an upright line each.
    pub limits: Vec<LimitLine>,
    /// Width of the figure (px); the height follows from the rows.
    pub width_px: f64,
}

/// The histogram of one controller.
#[derive(Debug, Clone, PartialEq)]
pub struct DistributionRow {
    /// Name of the controller.
    pub name: String,
    /// What is said of it, right of the name; may be empty.
    pub words: String,
    /// How its bins are painted.
    pub style: SeriesStyle,
    /// Ends of the bins, ascending, one more than counts.
    pub edges: Vec<f64>,
    /// Runs in each bin; heights are relative to the highest bin of the row.
    pub counts: Vec<u64>,
    /// Runs that the heights' percentages are parts of.
    pub of: u64,
    /// 5, 25, 50, 75 and 95 % of the runs are below these.
    pub quantiles: Option<[f64; 5]>,
}

/// A limit on the measure.
#[derive(Debug, Clone, PartialEq)]
pub struct LimitLine {
    /// Where it is.
    pub at: f64,
    /// What is written at it, such as "at most 35".
    pub name: String,
    /// True where values above it are not as required; false where those below it are not.
    pub most: bool,
}

/// Height of the name of a row, of its bins and of its percentiles (px).
const NAME: f64 = 20.0;
const BINS: f64 = 64.0;
const STRIP: f64 = 20.0;
/// Room for the share of the highest bin, left of it (px).
const LEFT: f64 = 52.0;
/// Height of a row of names of limits (px), and how many there are at most.
const LIMIT: f64 = 14.0;
const LIMIT_ROWS: usize = 2;
/// Limits farther from the data than this many times its width are named at the edge instead.
const FAR: f64 = 0.6;

impl DistributionFigure {
    /// Draws the figure.
    #[must_use]
    pub fn render(&self) -> Svg {
        let width = page::sane_width(self.width_px);
        let left = EDGE + LEFT;
        let shown = areas::title(&self.title, width);
        let title = page::title_height(&shown, width);
        let top = title + LIMIT * self.limits.len().min(LIMIT_ROWS) as f64 + 3.0;
        let height = (NAME + BINS + STRIP) * self.rows.len().max(1) as f64;
        let mut canvas = Canvas::new(width, top + height + 50.0);
        page::title(&mut canvas, &shown);
        let plot = width - left - EDGE - 8.0;
        let area = Rect { x: left, y: top, width: plot, height };
        let axis = self.axis((plot / 80.0) as usize);
        abscissa(&mut canvas, area, &axis, true);
        for (n, row) in self.rows.iter().enumerate() {
            let y = top + n as f64 * (NAME + BINS + STRIP);
            let bins = Rect { x: left, y: y + NAME, width: plot, height: BINS };
            row.draw(&mut canvas, bins, &axis);
            row.read(&mut canvas, bins, &axis);
        }
        self.limits(&mut canvas, area, &axis);
        for (n, row) in self.rows.iter().enumerate() {
            row.title(&mut canvas, area, top + n as f64 * (NAME + BINS + STRIP));
        }
        name_abscissa(&mut canvas, area, &self.x_label);
        canvas.finish(&self.title, &self.describe())
    }

    fn axis(&self, ticks: usize) -> Axis {
        let edges = self.rows.iter().flat_map(|row| row.edges.iter().copied());
        let quantiles = self.rows.iter().filter_map(|row| row.quantiles).flatten();
        let data = extent(edges.chain(quantiles));
        let near = |limit: &&LimitLine| {
            let room = data.map_or(f64::INFINITY, |(lo, hi)| FAR * (hi - lo));
            data.is_none_or(|(lo, hi)| limit.at >= lo - room && limit.at <= hi + room)
        };
        let limits = self.limits.iter().filter(near).map(|limit| limit.at);
        let ends = data.into_iter().flat_map(|(lo, hi)| [lo, hi]);
        Axis::linear(extent(ends.chain(limits)), 0.03, ticks)
    }

    /// Limits as lines with their names above all rows, or at the edge that they lie beyond.
    fn limits(&self, canvas: &mut Canvas, area: Rect, axis: &Axis) {
        let mut rows: [Vec<(f64, f64)>; LIMIT_ROWS] = Default::default();
        for limit in &self.limits {
            let part = axis.fraction(limit.at);
            if !part.is_finite() {
                continue;
            }
            let inside = (0.0..=1.0).contains(&part);
            let name = match (inside, part > 1.0) {
                (true, _) => limit.name.clone(),
                (_, true) => format!("{} \u{25b8}", limit.name),
                _ => format!("\u{25c2} {}", limit.name),
            };
            let name = fitted(&name, TICK_PX, area.width);
            let x = area.x + part.clamp(0.0, 1.0) * area.width;
            if inside {
                limit.line(canvas, area, x);
            }
            let half = text_width(&name, TICK_PX) / 2.0;
            let middle = x.clamp(area.x + half, (area.x + area.width - half).max(area.x + half));
            // Where no row has room for a name, it stands in the caption alone.
            let ends = (middle - half - 4.0, middle + half + 4.0);
            let is_free =
                |row: &Vec<(f64, f64)>| row.iter().all(|it| ends.1 < it.0 || ends.0 > it.1);
            if let Some(row) = rows.iter().position(is_free) {
                rows[row].push(ends);
                let y = area.y - 5.0 - LIMIT * row as f64;
                canvas.text(middle, y, &name, Font::new(TICK_PX, Anchor::Middle));
            }
        }
    }

    fn describe(&self) -> String {
        let mut text = format!("Histograms of {}.", self.x_label);
        for row in &self.rows {
            text.push_str(&format!(" {}: {}.", row.name, row.words));
        }
        for limit in &self.limits {
            text.push_str(&format!(" Required: {}.", limit.name));
        }
        text
    }
}

impl LimitLine {
    /// The line, with short strokes towards what is not allowed.
    fn line(&self, canvas: &mut Canvas, area: Rect, x: f64) {
        let bottom = area.y + area.height;
        canvas.line((x, area.y), (x, bottom), &Paint::line(Role::Ink, 1.4).dashed("6 3"));
        let way = if self.most { 5.0 } else { -5.0 };
        let count = (area.height / 14.0) as usize;
        for n in 0..count {
            let y = area.y + 7.0 + n as f64 * 14.0;
            canvas.line((x, y), (x + way, y - 5.0), &Paint::line(Role::Ink, 0.8));
        }
    }
}

impl DistributionRow {
    fn title(&self, canvas: &mut Canvas, area: Rect, top: f64) {
        let (left, right) = (area.x + 2.0, area.x + area.width);
        // The name may have two fifths of the row, and all that the words leave.
        let wanted = text_width(&self.name, LABEL_PX).min(0.4 * area.width);
        let words = fitted(&self.words, TICK_PX, area.width - wanted - 26.0);
        let used = text_width(&words, TICK_PX);
        let name = fitted(&self.name, LABEL_PX, area.width - used - 26.0);
        let named = text_width(&name, LABEL_PX);
        // Grid and limits behind the words would make them hard to read.
        for (x, width) in [(left - 2.0, named + 10.0), (right - used - 3.0, used + 3.0)] {
            if width > 10.0 {
                canvas.rect(x, top + 3.0, width, 14.0, &Paint::face(Role::Face).opacity(0.85));
            }
        }
        canvas.rect(left - 2.0, top + 3.0, 3.0, 14.0, &Paint::face(self.style.role()));
        let font = Font::new(LABEL_PX, Anchor::Start);
        canvas.text(left + 5.0, top + 14.2, &name, font.bold());
        canvas.text(right, top + 14.0, &words, Font::new(TICK_PX, Anchor::End));
    }

    fn draw(&self, canvas: &mut Canvas, area: Rect, axis: &Axis) {
        let bottom = area.y + area.height;
        let ends = [(area.x, bottom), (area.x + area.width, bottom)];
        canvas.line(ends[0], ends[1], &Paint::line(Role::Ink, 0.8));
        let highest = self.counts.iter().copied().max().unwrap_or(0);
        if highest > 0 {
            let outline = self.outline(area, axis, highest);
            let role = self.style.role();
            canvas.polyline(&outline, true, &Paint::face(role).opacity(0.4));
            canvas.polyline(&outline, false, &Paint::line(role, 1.4));
            let share = 100.0 * highest as f64 / self.of.max(highest) as f64;
            let font = Font::new(TICK_PX, Anchor::End);
            canvas.line((area.x - 4.0, area.y), (area.x, area.y), &Paint::line(Role::Ink, 1.0));
            let label = format!("{} %", short_number(share));
            canvas.text(area.x - 7.0, area.y + TICK_PX * 0.36, &label, font);
            canvas.text(area.x - 7.0, bottom + TICK_PX * 0.36, "0", font);
        }
        canvas.line((area.x, area.y), (area.x, bottom), &Paint::line(Role::Ink, 1.0));
        self.strip(canvas, area, bottom + STRIP / 2.0 - 1.0, axis);
    }

    /// What a cursor reads: how many runs each bin has, and their share.
    fn read(&self, canvas: &mut Canvas, area: Rect, axis: &Axis) {
        if self.edges.len() != self.counts.len() + 1 || self.counts.is_empty() {
            return;
        }
        let words = self.counts.iter().map(|count| {
            let share = 100.0 * *count as f64 / self.of.max(1) as f64;
            format!("{count} of {}, {} %", self.of, short_number(share))
        });
        let height = Axis::linear(Some((0.0, 1.0)), 0.0, 2);
        let cells = Cells { name: &self.name, quantity: "runs", columns: &self.edges, rows: &[] };
        cells.worded(canvas, &cursor::panel(area, axis, &height), words);
    }

    /// The upper edge of the bins, from the floor to the floor.
    fn outline(&self, area: Rect, axis: &Axis, highest: u64) -> Vec<(f64, f64)> {
        let bottom = area.y + area.height;
        let place = |value: f64| area.x + axis.fraction(value).clamp(0.0, 1.0) * area.width;
        let mut points = Vec::new();
        for (ends, &count) in self.edges.windows(2).zip(&self.counts) {
            let (from, to) = (place(ends[0]), place(ends[1]));
            if !(from.is_finite() && to.is_finite()) {
                continue;
            }
            let y = bottom - area.height * count as f64 / highest as f64;
            if points.is_empty() {
                points.push((from, bottom));
            }
            points.extend([(from, y), (to, y)]);
        }
        if let Some(&(x, _)) = points.last() {
            points.push((x, bottom));
        }
        points
    }

    /// Percentiles below the bins: a thin bar, a thick one, a stroke at the median.
    fn strip(&self, canvas: &mut Canvas, area: Rect, y: f64, axis: &Axis) {
        let Some(quantiles) = self.quantiles else { return };
        let place = |value: f64| area.x + axis.fraction(value).clamp(0.0, 1.0) * area.width;
        let [low, quarter, median, upper, high] = quantiles.map(place);
        if ![low, quarter, median, upper, high].iter().all(|x| x.is_finite()) {
            return;
        }
        let role = self.style.role();
        canvas.line((low, y), (high, y), &Paint::line(role, 1.6));
        canvas.line((quarter, y), (upper, y), &Paint::line(role, 5.0));
        for end in [low, high] {
            canvas.line((end, y - 3.5), (end, y + 3.5), &Paint::line(role, 1.6));
        }
        canvas.line((median, y - 5.5), (median, y + 5.5), &Paint::line(Role::Ink, 2.4));
    }
}
