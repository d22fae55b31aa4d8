//! A comparison over a sweep: cost ratio against the size of a disturbance.

use super::axis::{Axis, extent, short_number};
use super::line::Series;
use super::page::{self, EDGE, Entry, LABEL_PX, Legend, Swatch};
use super::plot::{self, Content, Curve, Frame};
use super::svg::{Canvas, Rect, Svg};

/// Marked lines over a sweep, with a line of reference such as "equal cost" at 1.
#[derive(Debug, Clone, PartialEq)]
pub struct RatioFigure {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Name and unit of the quantity that is swept.
    pub x_label: String,
    /// Name of the ratio, and which side of 1 is better.
    pub y_label: String,
    /// One line per comparison.
    pub series: Vec<Series>,
    /// True spaces the sweep by its logarithm; points that are not positive are left out.
    pub log_x: bool,
    /// True spaces the ratio by its logarithm, so that twice and half are equally far from 1.
    pub log_y: bool,
    /// Value and legend name of the line of reference.
    pub reference: Option<(f64, String)>,
    /// Width of the figure (px).
    pub width_px: f64,
}

const HEIGHT: f64 = 260.0;

impl RatioFigure {
    /// Draws the figure.
    #[must_use]
    pub fn render(&self) -> Svg {
        let width = page::sane_width(self.width_px);
        let (x, y) = self.axes(width);
        let y_label = page::wrap(&self.y_label, LABEL_PX, HEIGHT + 10.0);
        let left = EDGE + page::upright_room(y_label.len()) + page::tick_room(&y);
        let plot_width = width - left - EDGE - 10.0;
        let legend = Legend::set(self.entries(), plot_width);
        let legend_top = page::title_height(&self.title, width);
        let area = Rect {
            x: left,
            y: legend_top + legend.height() + 4.0,
            width: plot_width,
            height: HEIGHT,
        };
        let mut canvas = Canvas::new(width, area.y + HEIGHT + 48.0);
        page::title(&mut canvas, &self.title);
        legend.draw(&mut canvas, left, legend_top);
        let curve = |series: &Series| Curve {
            name: series.name.clone(),
            style: series.style,
            points: series.points().collect(),
            stairs: series.stairs,
            marked: true,
        };
        let content = Content {
            bands: Vec::new(),
            references: self.reference.iter().map(|reference| reference.0).collect(),
            beginnings: Vec::new(),
            curves: self.series.iter().map(curve).collect(),
            is_all: true,
        };
        plot::draw(&mut canvas, &Frame { area, x, y, x_labels: true }, &content);
        let label_right = EDGE + page::upright_room(y_label.len()) - 3.0;
        page::upright_label(&mut canvas, label_right, area.y + HEIGHT / 2.0, &y_label);
        let below = area.y + HEIGHT + 36.0;
        page::level_label(&mut canvas, left + plot_width / 2.0, below, &self.x_label);
        canvas.finish(&self.title, &self.describe())
    }

    fn axes(&self, width: f64) -> (Axis, Axis) {
        let points = || self.series.iter().flat_map(Series::points);
        let visible = |value: &f64, log: bool| !log || *value > 0.0;
        let xs = extent(points().map(|point| point.0).filter(|v| visible(v, self.log_x)));
        let reference = self.reference.iter().map(|reference| reference.0);
        let ys = extent(
            points().map(|point| point.1).chain(reference).filter(|v| visible(v, self.log_y)),
        );
        let axis = |range, log, ticks| {
            if log { Axis::logarithmic(range, 0.06) } else { Axis::linear(range, 0.06, ticks) }
        };
        (axis(xs, self.log_x, (width / 90.0) as usize), axis(ys, self.log_y, 6))
    }

    fn entries(&self) -> Vec<Entry> {
        let lines = self.series.iter().map(|series| Entry {
            name: series.name.clone(),
            swatch: Swatch::Line { style: series.style, marked: true },
        });
        let reference = self
            .reference
            .iter()
            .map(|(_, name)| Entry { name: name.clone(), swatch: Swatch::Reference });
        lines.chain(reference).collect()
    }

    fn describe(&self) -> String {
        let mut text = format!("{} against {}:", self.y_label, self.x_label);
        for series in &self.series {
            let (lo, hi) =
                extent(series.points().map(|point| point.1)).unwrap_or((f64::NAN, f64::NAN));
            text.push_str(&format!(
                " {} from {} to {};",
                series.name,
                short_number(lo),
                short_number(hi)
            ));
        }
        text
    }
}
