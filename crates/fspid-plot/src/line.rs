//! Stacked panels over one abscissa: pitch angle, elevator command and gains against time.

use std::collections::BTreeMap;

use super::axis::{Axis, extent, short_number};
use super::page::{self, EDGE, Entry, LABEL_PX, Legend, Swatch};
use super::plot::{self, Content, Curve, Frame};
use super::style::SeriesStyle;
use super::svg::{Canvas, Rect, Svg};

/// A figure of one or more panels above one another, with aligned abscissas.
#[derive(Debug, Clone, PartialEq)]
pub struct LineFigure {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Panels from top to bottom.
    pub panels: Vec<LinePanel>,
    /// Width of the figure (px); the height follows from the panels.
    pub width_px: f64,
}

/// One panel of a [`LineFigure`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LinePanel {
    /// Name and unit of the ordinate, such as `pitch angle [deg]`.
    pub y_label: String,
    /// Name and unit of the abscissa; written under the lowest panel, and where the next one differs.
    pub x_label: String,
    /// Lines, drawn in this order.
    pub series: Vec<Series>,
    /// Horizontal bands, drawn behind the lines.
    pub bands: Vec<Band>,
    /// Abscissas at which something begins, drawn as upright lines; a caption says what.
    pub beginnings: Vec<f64>,
    /// Range of the abscissa; `None` takes the range of all panels without one.
    pub x_range: Option<(f64, f64)>,
    /// Range of the ordinate; `None` takes that of the data and bands.
    pub y_range: Option<(f64, f64)>,
}

/// One line; points beyond the shorter of `x` and `y` are ignored.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend; nameless series have no entry.
    pub name: String,
    /// How the line is drawn.
    pub style: SeriesStyle,
    /// Abscissas.
    pub x: Vec<f64>,
    /// Ordinates; one that is not finite interrupts the line.
    pub y: Vec<f64>,
    /// True holds each value until the next abscissa, as a sampled command is.
    pub stairs: bool,
}

/// A horizontal band, such as the 2 % band around a set-point.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Name in the legend.
    pub label: String,
    /// Lower end.
    pub lower: f64,
    /// Upper end.
    pub upper: f64,
}

/// A panel whose place is known.
struct Placed<'a> {
    panel: &'a LinePanel,
    frame: Frame,
    legend: Legend,
    legend_top: f64,
    y_label: Vec<String>,
}

impl LineFigure {
    /// Draws the figure.
    #[must_use]
    pub fn render(&self) -> Svg {
        let width = page::sane_width(self.width_px);
        let (placed, height) = self.place(width);
        let mut canvas = Canvas::new(width, height);
        page::title(&mut canvas, &self.title);
        for (n, one) in placed.iter().enumerate() {
            draw(&mut canvas, one, self.names_abscissa(n));
        }
        canvas.finish(&self.title, &self.describe())
    }

    /// True where the panel carries the numbers and the name of its abscissa.
    fn names_abscissa(&self, n: usize) -> bool {
        match (self.panels.get(n), self.panels.get(n + 1)) {
            (Some(one), Some(next)) => {
                one.x_range != next.x_range
                    || (one.x_label != next.x_label && !one.x_label.is_empty())
            }
            _ => true,
        }
    }

    fn place(&self, width: f64) -> (Vec<Placed<'_>>, f64) {
        let shared = extent(
            self.panels.iter().filter(|p| p.x_range.is_none()).flat_map(LinePanel::abscissas),
        );
        let axes: Vec<(Axis, Axis)> = self
            .panels
            .iter()
            .enumerate()
            .map(|(n, panel)| panel.axes(shared, width, self.panel_height(n)))
            .collect();
        let labels: Vec<Vec<String>> = (self.panels.iter().enumerate())
            .map(|(n, p)| page::wrap(&p.y_label, LABEL_PX, self.panel_height(n) + 8.0))
            .collect();
        let ticks = axes.iter().map(|(_, y)| page::tick_room(y)).fold(0.0, f64::max);
        let lines = labels.iter().map(Vec::len).max().unwrap_or(0);
        let left = EDGE + page::upright_room(lines) + ticks;
        let plot_width = width - left - EDGE - 6.0;
        let mut shown = Vec::new();
        let mut top = page::title_height(&self.title, width);
        let mut placed = Vec::new();
        for (n, ((panel, (x, y)), y_label)) in self.panels.iter().zip(axes).zip(labels).enumerate()
        {
            let legend = Legend::set(panel.new_entries(&mut shown), plot_width);
            let legend_top = top;
            top += legend.height();
            let area = Rect { x: left, y: top, width: plot_width, height: self.panel_height(n) };
            let x_labels = self.names_abscissa(n);
            top += area.height + if x_labels { 44.0 } else { 16.0 };
            placed.push(Placed {
                panel,
                frame: Frame { area, x, y, x_labels },
                legend,
                legend_top,
                y_label,
            });
        }
        (placed, top + 4.0)
    }

    fn panel_height(&self, n: usize) -> f64 {
        match (self.panels.len(), n) {
            (1, _) => 250.0,
            (_, 0) => 200.0,
            _ => 130.0,
        }
    }

    fn describe(&self) -> String {
        let mut text = format!("Line chart with {} panel(s).", self.panels.len());
        for panel in &self.panels {
            text.push_str(&format!(" {} against {}:", panel.y_label, panel.x_label));
            for series in &panel.series {
                let range = extent(series.points().map(|point| point.1));
                let (lo, hi) = range.map_or((f64::NAN, f64::NAN), |range| range);
                text.push_str(&format!(
                    " {} from {} to {};",
                    series.name,
                    short_number(lo),
                    short_number(hi)
                ));
            }
        }
        text
    }
}

impl LinePanel {
    fn abscissas(&self) -> impl Iterator<Item = f64> + '_ {
        self.series.iter().flat_map(|series| series.points().map(|point| point.0))
    }

    fn axes(&self, shared: Option<(f64, f64)>, width: f64, height: f64) -> (Axis, Axis) {
        let (x_ticks, y_ticks) = ((width / 90.0) as usize, (height / 30.0) as usize);
        let x = Axis::fixed(self.x_range, x_ticks)
            .unwrap_or_else(|| Axis::linear(shared, 0.0, x_ticks));
        let data = self.series.iter().flat_map(|series| series.points().map(|point| point.1));
        let bands = self.bands.iter().flat_map(|band| [band.lower, band.upper]);
        let y = Axis::fixed(self.y_range, y_ticks)
            .unwrap_or_else(|| Axis::linear(extent(data.chain(bands)), 0.06, y_ticks));
        (x, y)
    }

    /// Legend entries that no panel above has shown.
    fn new_entries(&self, shown: &mut Vec<Entry>) -> Vec<Entry> {
        let lines = self.series.iter().map(|series| Entry {
            name: series.name.clone(),
            swatch: Swatch::Line { style: series.style, marked: false },
        });
        let bands =
            self.bands.iter().map(|band| Entry { name: band.label.clone(), swatch: Swatch::Band });
        let mut fresh: Vec<Entry> = Vec::new();
        for entry in lines.chain(bands) {
            if !shown.contains(&entry) {
                shown.push(entry.clone());
                fresh.push(entry);
            }
        }
        fresh
    }
}

impl Series {
    pub(super) fn points(&self) -> impl Iterator<Item = (f64, f64)> + Clone + '_ {
        self.x.iter().copied().zip(self.y.iter().copied())
    }
}

fn draw(canvas: &mut Canvas, placed: &Placed<'_>, named: bool) {
    let area = placed.frame.area;
    placed.legend.draw(canvas, area.x, placed.legend_top);
    let curves = placed.panel.series.iter().map(|series| Curve {
        name: series.name.clone(),
        style: series.style,
        points: series.points().collect(),
        stairs: series.stairs,
        marked: false,
    });
    let content = Content {
        bands: merged(&placed.panel.bands),
        references: Vec::new(),
        beginnings: placed.panel.beginnings.clone(),
        curves: curves.collect(),
        is_all: true,
    };
    plot::draw(canvas, &placed.frame, &content);
    let label_right = EDGE + page::upright_room(placed.y_label.len()) - 3.0;
    page::upright_label(canvas, label_right, area.y + area.height / 2.0, &placed.y_label);
    if named {
        let y = area.y + area.height + 36.0;
        page::level_label(canvas, area.x + area.width / 2.0, y, &placed.panel.x_label);
    }
}

/// Bands with the same ends are drawn once, or they would darken one another.
fn merged(bands: &[Band]) -> Vec<(f64, f64)> {
    let keyed: BTreeMap<(u64, u64), (f64, f64)> = bands
        .iter()
        .map(|band| ((band.lower.to_bits(), band.upper.to_bits()), (band.lower, band.upper)))
        .collect();
    keyed.into_values().collect()
}
