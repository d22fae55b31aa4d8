//! Estimates with their confidence intervals: a row each, one or more columns, a sign for each series.

use super::areas::{self, abscissa, fitted, name_abscissa, room, sign};
use crate::axis::{Axis, extent, short_number};
use crate::page::{self, EDGE, Entry, LABEL_PX, Legend, Swatch};
use crate::style::{Role, SeriesStyle};
use crate::svg::{Anchor, Canvas, Font, Paint, Rect, Svg};

/// Estimates with intervals: rows of names, columns of quantities.
#[derive(Debug, Clone, PartialEq)]
pub struct IntervalFigure {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Quantities from left to right, each with its axis.
    pub columns: Vec<IntervalColumn>,
    /// Rows from top to bottom.
    pub rows: Vec<IntervalRow>,
    /// Names of the series in the legend; empty where the rows say it all.
    pub series: Vec<(String, SeriesStyle)>,
    /// Width of the figure (px); the height follows from the rows.
    pub width_px: f64,
}

/// A quantity of an [`IntervalFigure`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct IntervalColumn {
    /// Its name and unit.
    pub label: String,
    /// Ends of its axis; `None` takes those of the intervals, and zero.
    pub range: Option<(f64, f64)>,
    /// True draws a stem from zero to each estimate.
    pub stems: bool,
}

/// A row of an [`IntervalFigure`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct IntervalRow {
    /// What the row is about, left of it.
    pub name: String,
    /// What is said of it, right of it; may be empty.
    pub words: String,
    /// Estimates, below one another within the row.
    pub marks: Vec<IntervalMark>,
}

/// An estimate; numbers that are not finite are not drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntervalMark {
    /// Position of its column.
    pub column: usize,
    /// Colour and sign of the controller.
    pub style: SeriesStyle,
    /// The estimate.
    pub value: f64,
    /// Lower end of its interval.
    pub lower: f64,
    /// Upper end of its interval.
    pub upper: f64,
}

/// Height that a mark takes (px).
const MARK: f64 = 13.0;
/// Free height above and below the marks of a row (px).
const PAD: f64 = 6.0;
/// Gap between columns (px).
const GAP: f64 = 44.0;

/// Where everything stands.
struct Places {
    names: f64,
    words: f64,
    columns: Vec<(Rect, Axis)>,
}

impl IntervalFigure {
    /// Draws the figure.
    #[must_use]
    pub fn render(&self) -> Svg {
        let width = page::sane_width(self.width_px);
        let entries = self.series.iter().map(|(name, style)| Entry {
            name: fitted(name, LABEL_PX, width / 2.0),
            swatch: Swatch::Sign(sign(*style), style.role()),
        });
        let legend = Legend::set(entries.collect(), width - 2.0 * EDGE);
        let shown = areas::title(&self.title, width);
        let title = page::title_height(&shown, width);
        let top = title + legend.height() + 2.0;
        let height: f64 = self.rows.iter().map(IntervalRow::height).sum::<f64>().max(MARK);
        let mut canvas = Canvas::new(width, top + height + 48.0);
        page::title(&mut canvas, &shown);
        legend.draw(&mut canvas, EDGE, title);
        let places = self.places(width, (top, height));
        for (column, (area, axis)) in self.columns.iter().zip(&places.columns) {
            abscissa(&mut canvas, *area, axis, true);
            zero_line(&mut canvas, *area, axis);
            let label = fitted(&column.label, LABEL_PX, area.width + GAP - 6.0);
            name_abscissa(&mut canvas, *area, &label);
        }
        let mut y = top;
        for (n, row) in self.rows.iter().enumerate() {
            if n > 0 {
                let ends = [(EDGE, y), (width - EDGE, y)];
                canvas.line(ends[0], ends[1], &Paint::line(Role::Grid, 0.7));
            }
            self.row(&mut canvas, &places, row, y);
            y += row.height();
        }
        canvas.finish(&self.title, &self.describe())
    }

    fn places(&self, width: f64, (top, height): (f64, f64)) -> Places {
        let names = room(self.rows.iter().map(|row| row.name.as_str()), LABEL_PX, width * 0.3);
        let words = room(self.rows.iter().map(|row| row.words.as_str()), LABEL_PX, width * 0.36);
        let left = EDGE + names + 16.0;
        let right = if words > 0.0 { words + 14.0 } else { 4.0 };
        let count = self.columns.len().max(1) as f64;
        let each = ((width - left - right - EDGE - GAP * (count - 1.0)) / count).max(40.0);
        let columns = self.columns.iter().enumerate().map(|(n, column)| {
            let x = left + n as f64 * (each + GAP);
            let area = Rect { x, y: top, width: each, height };
            (area, self.axis(n, column, (each / 62.0) as usize))
        });
        Places { names, words, columns: columns.collect() }
    }

    fn axis(&self, place: usize, column: &IntervalColumn, ticks: usize) -> Axis {
        let marks = self.rows.iter().flat_map(|row| &row.marks).filter(|it| it.column == place);
        let ends = marks.flat_map(|mark| [mark.value, mark.lower, mark.upper]);
        let found = extent(ends.chain([0.0])).filter(|(lo, hi)| lo < hi);
        let widened = found.map(|(lo, hi)| {
            let pad = 0.05 * (hi - lo);
            (if lo < 0.0 { lo - pad } else { lo }, hi + pad)
        });
        Axis::fixed(column.range, ticks)
            .or_else(|| Axis::fixed(widened, ticks))
            .unwrap_or_else(|| Axis::linear(Some((0.0, 1.0)), 0.0, ticks))
    }

    fn row(&self, canvas: &mut Canvas, places: &Places, row: &IntervalRow, top: f64) {
        let middle = top + row.height() / 2.0 + 4.2;
        let name = fitted(&row.name, LABEL_PX, places.names + 1.0);
        canvas.text(EDGE, middle, &name, Font::new(LABEL_PX, Anchor::Start));
        if let Some((last, _)) = places.columns.last() {
            let words = fitted(&row.words, LABEL_PX, places.words + 1.0);
            let font = Font::new(LABEL_PX, Anchor::Start);
            canvas.text(last.x + last.width + 14.0, middle, &words, font);
        }
        for (place, (area, axis)) in places.columns.iter().enumerate() {
            let marks: Vec<_> = row.marks.iter().filter(|mark| mark.column == place).collect();
            let stems = self.columns.get(place).is_some_and(|column| column.stems);
            let first = top + (row.height() - marks.len() as f64 * MARK) / 2.0;
            for (n, mark) in marks.into_iter().enumerate() {
                let y = first + (n as f64 + 0.5) * MARK;
                if stems {
                    mark.stem(canvas, *area, axis, y);
                }
                mark.draw(canvas, *area, axis, y);
            }
        }
    }

    fn describe(&self) -> String {
        let mut text = String::from("Estimates with intervals.");
        for row in &self.rows {
            text.push_str(&format!(" {}:", row.name));
            for mark in &row.marks {
                let label = self.columns.get(mark.column).map_or("", |column| &column.label);
                let series = self.series.iter().find(|(_, style)| *style == mark.style);
                let whose = series.map_or("", |(name, _)| name.as_str());
                let [value, lower, upper] = [mark.value, mark.lower, mark.upper].map(short_number);
                text.push_str(&format!(" {whose} {label} {value}, from {lower} to {upper};"));
            }
        }
        text
    }
}

impl IntervalRow {
    fn height(&self) -> f64 {
        let mut most = 1;
        for mark in &self.marks {
            most = most.max(self.marks.iter().filter(|it| it.column == mark.column).count());
        }
        most as f64 * MARK + 2.0 * PAD
    }
}

impl IntervalMark {
    /// A broad line from zero to the value.
    fn stem(&self, canvas: &mut Canvas, area: Rect, axis: &Axis, y: f64) {
        let ends = (place(area, axis, 0.0), place(area, axis, self.value));
        if let (Some(zero), Some(at)) = ends {
            let paint = Paint::line(self.style.role(), 5.0).opacity(0.35);
            canvas.line((zero, y), (at, y), &paint);
        }
    }

    fn draw(&self, canvas: &mut Canvas, area: Rect, axis: &Axis, y: f64) {
        let place = |value: f64| place(area, axis, value);
        let role = self.style.role();
        if let (Some(lower), Some(upper)) = (place(self.lower), place(self.upper)) {
            let paint = Paint::line(role, 1.6);
            canvas.line((lower, y), (upper, y), &paint);
            for end in [lower, upper] {
                canvas.line((end, y - 3.4), (end, y + 3.4), &paint);
            }
        }
        if let Some(at) = place(self.value) {
            match sign(self.style) {
                crate::sign::Sign::Dot => {
                    canvas.circle((at, y), 3.6, &Paint::face(role));
                }
                other => other.draw(canvas, (at, y), role),
            }
        }
    }
}

/// Where a value lies across an area; none for one that is not finite.
fn place(area: Rect, axis: &Axis, value: f64) -> Option<f64> {
    let part = axis.fraction(value);
    part.is_finite().then(|| area.x + part.clamp(0.0, 1.0) * area.width)
}

/// An upright line at zero where the axis has both signs.
fn zero_line(canvas: &mut Canvas, area: Rect, axis: &Axis) {
    let part = axis.fraction(0.0);
    if part > 0.0 && part < 1.0 {
        let x = area.x + part * area.width;
        canvas.line((x, area.y), (x, area.y + area.height), &Paint::line(Role::Ink, 1.0));
    }
}
