//! The share of runs that failed, in the boxes of a grid over two parameters.

use super::areas::{self, fitted, name_abscissa};
use super::scatter::SIDE;
use crate::axis::{Axis, extent, short_number};
use crate::cursor::{self, Cells};
use crate::gaps;
use crate::page::{self, EDGE, LABEL_PX};
use crate::plot::TICK_PX;
use crate::sign::{DARK, LIGHT};
use crate::style::{Rgb, Role, sequential, wants_dark_text};
use crate::surface::map_axes;
use crate::svg::{Anchor, Canvas, Font, Paint, Rect, Svg};
use crate::text::text_width;

/// Shares of runs over two parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct ShareMap {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Name of the parameter along `x_edges`.
    pub x_label: String,
    /// Name of the parameter along `y_edges`.
    pub y_label: String,
    /// What the shares are of, such as "runs that failed".
    pub quantity: String,
    /// The share at the upper end of the scale (%), to compare maps; `None` takes the largest.
    pub most_pct: Option<f64>,
    /// Ends of the columns, ascending.
    pub x_edges: Vec<f64>,
    /// Ends of the rows, ascending.
    pub y_edges: Vec<f64>,
    /// `cells[i][j]` lies between `y_edges[i]`, `y_edges[i + 1]`, `x_edges[j]` and `x_edges[j + 1]`.
    pub cells: Vec<Vec<ShareCell>>,
}

/// Runs in a box of the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ShareCell {
    /// How many there are.
    pub runs: u64,
    /// How many of them count.
    pub counted: u64,
}

impl ShareCell {
    /// The share in per cent; `None` without runs.
    fn share_pct(self) -> Option<f64> {
        (self.runs > 0).then(|| 100.0 * self.counted.min(self.runs) as f64 / self.runs as f64)
    }
}

const BAR: f64 = 14.0;
const RIGHT: f64 = 90.0;
/// Part of the scale of colours that is used: its lightest end is too near to white.
const FROM: f64 = 0.03;
const TO: f64 = 0.94;

impl ShareMap {
    /// Draws the map.
    #[must_use]
    pub fn render(&self) -> Svg {
        let axis = |edges: &[f64]| Axis::linear(extent(edges.iter().copied()), 0.0, 6);
        let (x, y) = (axis(&self.x_edges), axis(&self.y_edges));
        let left = EDGE + page::upright_room(1) + page::tick_room(&y);
        let width = left + SIDE + RIGHT;
        let shown = areas::title(&self.title, width);
        let top = page::title_height(&shown, width) + 22.0;
        let mut canvas = Canvas::new(width, top + SIDE + 50.0);
        page::title(&mut canvas, &shown);
        let area = Rect { x: left, y: top, width: SIDE, height: SIDE };
        canvas.begin_clip(area);
        gaps::hatch(&mut canvas, area);
        for (place, cell) in self.boxes(area, &x, &y) {
            self.cell(&mut canvas, place, cell);
        }
        canvas.end();
        map_axes(&mut canvas, area, &x, &y);
        self.read(&mut canvas, &cursor::panel(area, &x, &y));
        self.bar(&mut canvas, Rect { x: left + SIDE + 18.0, width: BAR, ..area });
        if self.cells.iter().flatten().any(|cell| cell.runs == 0) {
            hatch_key(&mut canvas, (left, top - 18.0));
        }
        name_abscissa(&mut canvas, area, &self.x_label);
        let label = [fitted(&self.y_label, LABEL_PX, SIDE)];
        page::upright_label(&mut canvas, EDGE + LABEL_PX, top + SIDE / 2.0, &label);
        canvas.finish(&self.title, &self.describe())
    }

    /// What a cursor reads of each box, where every box has its ends.
    fn read(&self, canvas: &mut Canvas, panel: &str) {
        let (columns, rows) = (&self.x_edges, &self.y_edges);
        if columns.len() < 2 || rows.len() < 2 {
            return;
        }
        let cell = |i: usize, j: usize| self.cells.get(i).and_then(|row| row.get(j)).copied();
        let words = |cell: Option<ShareCell>| {
            let share = cell.and_then(|cell| Some((cell, cell.share_pct()?)));
            share.map_or_else(
                || "no runs".to_owned(),
                |(cell, share)| format!("{} of {}, {} %", cell.counted, cell.runs, percent(share)),
            )
        };
        let all = (0..rows.len() - 1)
            .flat_map(|i| (0..columns.len() - 1).map(move |j| words(cell(i, j))));
        Cells { name: "", quantity: &self.quantity, columns, rows }.worded(canvas, panel, all);
    }

    /// Place and content of every box with runs.
    fn boxes(&self, area: Rect, x: &Axis, y: &Axis) -> Vec<(Rect, ShareCell)> {
        let mut found = Vec::new();
        for (row, down) in self.cells.iter().zip(self.y_edges.windows(2)) {
            for (cell, across) in row.iter().zip(self.x_edges.windows(2)) {
                let [west, east] =
                    [across[0], across[1]].map(|v| area.x + x.fraction(v) * area.width);
                let [north, south] =
                    [down[1], down[0]].map(|v| area.y + (1.0 - y.fraction(v)) * area.height);
                let seen = [west, east, north, south].iter().all(|edge| edge.is_finite());
                if cell.runs > 0 && seen {
                    let size = (east - west, south - north);
                    found.push((Rect { x: west, y: north, width: size.0, height: size.1 }, *cell));
                }
            }
        }
        found
    }

    /// Upper end of the scale: the largest share, at least a round one that can be told from none (%).
    fn most_pct(&self) -> f64 {
        let shares = self.cells.iter().flatten().filter_map(|cell| cell.share_pct());
        let asked = self.most_pct.filter(|most| *most > 0.0 && *most <= 100.0);
        let most = asked.unwrap_or_else(|| shares.fold(0.0, f64::max));
        [1.0, 2.0, 5.0, 10.0, 20.0, 50.0].into_iter().find(|end| most <= *end).unwrap_or(100.0)
    }

    fn cell(&self, canvas: &mut Canvas, r: Rect, cell: ShareCell) {
        let Some(share) = cell.share_pct() else { return };
        let colour = shade(share / self.most_pct());
        let paint = Paint::line(Role::Paper, 0.8).filled(Role::Fixed(colour));
        canvas.rect(r.x, r.y, r.width, r.height, &paint);
        let words = [
            (format!("{} %", percent(share)), TICK_PX, -2.0),
            (format!("of {}", short_count(cell.runs)), TICK_PX - 1.5, 10.0),
        ];
        let ink = if wants_dark_text(colour) { DARK } else { LIGHT };
        let middle = (r.x + r.width / 2.0, r.y + r.height / 2.0);
        let fits = |(text, size, _): &(String, f64, f64)| text_width(text, *size) + 2.0 <= r.width;
        if r.height >= 26.0 && words.iter().all(fits) {
            for (text, size, down) in &words {
                let font = Font::new(*size, Anchor::Middle).role(Role::Fixed(ink));
                canvas.text(middle.0, middle.1 + down, text, font);
            }
        }
    }

    fn bar(&self, canvas: &mut Canvas, r: Rect) {
        let slices = 48;
        let height = r.height / f64::from(slices);
        for n in 0..slices {
            let y = r.y + r.height - f64::from(n + 1) * height;
            let colour = shade((f64::from(n) + 0.5) / f64::from(slices));
            // Each slice reaches under the one below it, so that no seam shows.
            let over = if n == 0 { 0.0 } else { 0.6 };
            canvas.rect(r.x, y, r.width, height + over, &Paint::face(Role::Fixed(colour)));
        }
        canvas.rect(r.x, r.y, r.width, r.height, &Paint::line(Role::Ink, 0.8));
        let mut widest = 0.0_f64;
        for tick in Axis::linear(Some((0.0, self.most_pct())), 0.0, 6).ticks() {
            let (y, end) = (r.y + (1.0 - tick.at) * r.height, r.x + r.width);
            canvas.line((end, y), (end + 4.0, y), &Paint::line(Role::Ink, 1.0));
            let font = Font::new(TICK_PX, Anchor::Start);
            canvas.text(end + 7.0, y + TICK_PX * 0.36, &tick.label, font);
            widest = widest.max(text_width(&tick.label, TICK_PX));
        }
        let label = fitted(&format!("{} [%]", self.quantity), LABEL_PX, r.height);
        let x = r.x + r.width + 24.0 + widest;
        page::upright_label(canvas, x, r.y + r.height / 2.0, &[label]);
    }

    fn describe(&self) -> String {
        let all = || self.cells.iter().flatten();
        let runs: u64 = all().map(|cell| cell.runs).sum();
        let counted: u64 = all().map(|cell| cell.counted).sum();
        let worst = all().filter_map(|cell| cell.share_pct()).fold(0.0, f64::max);
        format!(
            "Map of {} over {} and {}: {counted} of {runs}; at most {} % in a box.",
            self.quantity,
            self.x_label,
            self.y_label,
            short_number(worst)
        )
    }
}

/// Light is good, dark is bad.
fn shade(part: f64) -> Rgb {
    sequential(FROM + (TO - FROM) * part.clamp(0.0, 1.0))
}

/// At most two digits, and never nought for what is not.
fn percent(share: f64) -> String {
    if share > 0.0 && share < 0.1 {
        "<0.1".to_owned()
    } else if share < 9.95 && share > 0.0 {
        format!("{share:.1}")
    } else {
        format!("{share:.0}")
    }
}

fn short_count(runs: u64) -> String {
    match runs {
        0..10_000 => runs.to_string(),
        10_000..10_000_000 => format!("{}k", runs / 1000),
        _ => format!("{}M", runs / 1_000_000),
    }
}

fn hatch_key(canvas: &mut Canvas, (left, top): (f64, f64)) {
    let area = Rect { x: left, y: top, width: 24.0, height: 11.0 };
    canvas.begin_clip(area);
    gaps::hatch(canvas, area);
    canvas.end();
    canvas.rect(area.x, area.y, area.width, area.height, &Paint::line(Role::Ink, 0.6));
    canvas.text(left + 30.0, top + 9.8, "no runs", Font::new(TICK_PX, Anchor::Start));
}
