//! Panels above one another over one abscissa, with title and legend.

use super::chart::Chart;
use crate::axis::Axis;
use crate::page::{self, EDGE, Entry, LABEL_PX, Legend};
use crate::plot::Frame;
use crate::svg::{Canvas, Rect};

/// What a figure of panels needs to be laid out.
pub(super) struct Stack<'a> {
    pub(super) title: &'a str,
    pub(super) legend: Vec<Entry>,
    pub(super) x_label: &'a str,
    pub(super) x: Axis,
    /// From top to bottom.
    pub(super) panels: Vec<Panel<'a>>,
    pub(super) width_px: f64,
}

/// One panel.
pub(super) struct Panel<'a> {
    pub(super) y_label: &'a str,
    pub(super) y: Axis,
    pub(super) height: f64,
    /// Dashed horizontal lines.
    pub(super) references: Vec<f64>,
}

/// Room between two panels (px).
const GAP: f64 = 16.0;

impl Stack<'_> {
    /// Draws everything but the curves; one chart per panel.
    pub(super) fn open(self) -> (Canvas, Vec<Chart>) {
        let width = page::sane_width(self.width_px);
        let ticks = self.panels.iter().map(|panel| page::tick_room(&panel.y)).fold(0.0, f64::max);
        let lines =
            self.panels.iter().map(|panel| page::wrap(panel.y_label, LABEL_PX, panel.height + 8.0));
        let left =
            EDGE + page::upright_room(lines.map(|found| found.len()).max().unwrap_or(0)) + ticks;
        let plot_width = width - left - EDGE - 8.0;
        let legend = Legend::set(self.legend, plot_width);
        let legend_top = page::title_height(self.title, width);
        let top = legend_top + legend.height() + 4.0;
        let heights: f64 = self.panels.iter().map(|panel| panel.height + GAP).sum();
        let mut canvas = Canvas::new(width, top + heights - GAP + 48.0);
        page::title(&mut canvas, self.title);
        legend.draw(&mut canvas, left, legend_top);
        let (mut y, last) = (top, self.panels.len().saturating_sub(1));
        let mut charts = Vec::new();
        for (n, panel) in self.panels.iter().enumerate() {
            let area = Rect { x: left, y, width: plot_width, height: panel.height };
            let frame = Frame { area, x: self.x, y: panel.y, x_labels: n == last };
            let mut chart = Chart::new(frame);
            chart.axes(&mut canvas, &panel.references);
            chart.name_ordinate(&mut canvas, panel.y_label, ticks);
            charts.push(chart);
            y += panel.height + GAP;
        }
        let below = (left + plot_width / 2.0, y - GAP + 36.0);
        page::level_label(&mut canvas, below.0, below.1, self.x_label);
        (canvas, charts)
    }
}
