//! A map of classes: one tile a node, such as levels of flying qualities or stable and unstable.

use super::axis::{Axis, extent};
use super::cursor::{self, Cells};
use super::gaps;
use super::page::{self, EDGE, LABEL_PX};
use super::style::{Role, sequential, wants_dark_text};
use super::surface::map_axes;
use super::svg::{Anchor, Canvas, Font, Paint, Rect, Svg};
use super::text::text_width;

const WIDTH: f64 = 500.0;
const MAP: f64 = 336.0;
const SWATCH: f64 = 18.0;
const ROW: f64 = 20.0;

/// A class for each node of a rectangular grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Tiles {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Name and unit along `xs`.
    pub x_label: String,
    /// Name and unit along `ys`.
    pub y_label: String,
    /// Ascending abscissas.
    pub xs: Vec<f64>,
    /// Ascending ordinates.
    pub ys: Vec<f64>,
    /// `classes[i][j]` belongs to `xs[j]` and `ys[i]`: a position in `names`, or `None` for a hatched tile.
    pub classes: Vec<Vec<Option<usize>>>,
    /// Sign in the tiles and name in the legend of each class, the best first.
    pub names: Vec<(String, String)>,
    /// What a hatched tile means.
    pub missing: String,
}

impl Tiles {
    /// Draws the map.
    #[must_use]
    pub fn render(&self) -> Svg {
        let top = page::title_height(&self.title, WIDTH) + 4.0;
        let legend = ROW * (self.names.len() + 1) as f64 + 6.0;
        let mut canvas = Canvas::new(WIDTH, top + MAP + 48.0 + legend);
        page::title(&mut canvas, &self.title);
        let [x, y] = [edges(&self.xs), edges(&self.ys)];
        let axes = [&x, &y].map(|edges| Axis::linear(extent(edges.iter().copied()), 0.0, 10));
        let left = EDGE + page::upright_room(1) + page::tick_room(&axes[1]);
        let area = Rect { x: left, y: top, width: MAP, height: MAP };
        canvas.begin_clip(area);
        gaps::hatch(&mut canvas, area);
        self.tiles(&mut canvas, area, [&x, &y], &axes);
        canvas.end();
        map_axes(&mut canvas, area, &axes[0], &axes[1]);
        self.read(&mut canvas, &cursor::panel(area, &axes[0], &axes[1]));
        self.labels(&mut canvas, area);
        self.legend(&mut canvas, (left, top + MAP + 50.0));
        canvas.finish(&self.title, &self.describe())
    }

    fn tiles(&self, canvas: &mut Canvas, area: Rect, [xs, ys]: [&[f64]; 2], axes: &[Axis; 2]) {
        for (row, y) in self.classes.iter().zip(ys.windows(2)) {
            for (class, x) in row.iter().zip(xs.windows(2)) {
                let (&[west, east], &[south, north], &Some(class)) = (x, y, class) else {
                    continue;
                };
                let across = [west, east].map(|x| area.x + axes[0].fraction(x) * area.width);
                let down =
                    [north, south].map(|y| area.y + (1.0 - axes[1].fraction(y)) * area.height);
                let [width, height] = [across[1] - across[0], down[1] - down[0]];
                self.tile(canvas, Rect { x: across[0], y: down[0], width, height }, class);
            }
        }
    }

    /// What a cursor reads of each tile: the name of its class.
    fn read(&self, canvas: &mut Canvas, panel: &str) {
        let (columns, rows) = (&self.xs, &self.ys);
        let class = |i: usize, j: usize| self.classes.get(i).and_then(|row| *row.get(j)?);
        let words = |class: Option<usize>| {
            let known = class.and_then(|class| self.names.get(class));
            known
                .map_or(&self.missing, |(sign, name)| if name.is_empty() { sign } else { name })
                .clone()
        };
        let all = (0..rows.len()).flat_map(|i| (0..columns.len()).map(move |j| words(class(i, j))));
        Cells { name: "", quantity: "", columns, rows }.worded(canvas, panel, all);
    }

    fn tile(&self, canvas: &mut Canvas, r: Rect, class: usize) {
        let colour = self.colour(class);
        let paint = Paint::line(Role::Paper, 0.6).filled(Role::Fixed(colour));
        canvas.rect(r.x, r.y, r.width, r.height, &paint);
        let sign = self.names.get(class).map_or("", |(sign, _)| sign.as_str());
        if text_width(sign, LABEL_PX) + 4.0 > r.width || LABEL_PX + 2.0 > r.height {
            return;
        }
        let ink = if wants_dark_text(colour) { [26, 26, 26] } else { [255, 255, 255] };
        let font = Font::new(LABEL_PX, Anchor::Middle).role(Role::Fixed(ink));
        canvas.text(r.x + r.width / 2.0, r.y + r.height / 2.0 + LABEL_PX * 0.36, sign, font);
    }

    /// Light is good, dark is bad: it also reads in grey.
    fn colour(&self, class: usize) -> [u8; 3] {
        let last = self.names.len().saturating_sub(1).max(1);
        sequential(0.12 + 0.8 * class as f64 / last as f64)
    }

    fn labels(&self, canvas: &mut Canvas, area: Rect) {
        let middle = (area.x + area.width / 2.0, area.y + area.height + 36.0);
        page::level_label(canvas, middle.0, middle.1, &self.x_label);
        let label = std::slice::from_ref(&self.y_label);
        page::upright_label(canvas, EDGE + LABEL_PX, area.y + area.height / 2.0, label);
    }

    fn legend(&self, canvas: &mut Canvas, (left, top): (f64, f64)) {
        for (class, (sign, name)) in self.names.iter().enumerate() {
            let y = top + ROW * class as f64;
            self.tile(canvas, Rect { x: left, y, width: SWATCH, height: SWATCH - 3.0 }, class);
            let words = if name.is_empty() { sign } else { name };
            canvas.text(left + SWATCH + 8.0, y + 12.0, words, Font::new(LABEL_PX, Anchor::Start));
        }
        let y = top + ROW * self.names.len() as f64;
        let area = Rect { x: left, y, width: SWATCH, height: SWATCH - 3.0 };
        canvas.begin_clip(area);
        gaps::hatch(canvas, area);
        canvas.end();
        canvas.rect(area.x, area.y, area.width, area.height, &Paint::line(Role::Ink, 0.6));
        let font = Font::new(LABEL_PX, Anchor::Start);
        canvas.text(left + SWATCH + 8.0, y + 12.0, &self.missing, font);
    }

    fn describe(&self) -> String {
        let all = self.classes.iter().flatten();
        let count = |class: Option<usize>| all.clone().filter(|found| **found == class).count();
        let names = self.names.iter().enumerate();
        let mut parts: Vec<String> =
            names.map(|(class, (_, name))| format!("{name}: {}", count(Some(class)))).collect();
        parts.push(format!("{}: {}", self.missing, count(None)));
        format!("Map of {} over {}; {}.", self.y_label, self.x_label, parts.join(", "))
    }
}

/// Edges of tiles around nodes, half way between them.
pub(super) fn edges(nodes: &[f64]) -> Vec<f64> {
    let inner = nodes.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0);
    let half = |pair: Option<&[f64]>| pair.map_or(0.5, |pair| (pair[1] - pair[0]) / 2.0);
    let (first, last) = (nodes.first(), nodes.last());
    let first = first.map(|first| first - half(nodes.get(..2)));
    let end = nodes.len().checked_sub(2).and_then(|from| nodes.get(from..));
    let last = last.map(|last| last + half(end));
    first.into_iter().chain(inner).chain(last).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_lie_around_their_nodes() {
        assert_eq!(edges(&[1.0, 2.0, 4.0]), [0.5, 1.5, 3.0, 5.0]);
        assert_eq!(edges(&[3.0]), [2.5, 3.5]);
        assert!(edges(&[]).is_empty());
    }

    #[test]
    fn a_map_of_classes_tells_how_many_there_are_of_each() {
        let tiles = Tiles {
            title: "levels".to_owned(),
            x_label: "speed".to_owned(),
            y_label: "altitude".to_owned(),
            xs: vec![1.0, 2.0],
            ys: vec![0.0],
            classes: vec![vec![Some(0), None]],
            names: vec![("1".to_owned(), "level 1".to_owned())],
            missing: "no trim".to_owned(),
        };
        let svg = tiles.render();
        assert!(svg.as_str().contains("level 1: 1, no trim: 1."));
    }
}
