//! A gain over the inputs of the supervisor, seen in space and coloured by the margin there.

use super::clip::Point;
use super::gain_map::{GainMap, MapCell};
use super::map_cells::{Grading, worse};
use super::notes::Notes;
use crate::axis::{Axis, extent};
use crate::contour::Grid;
use crate::page::{self, EDGE, Swatch};
use crate::sign::{DARK, LIGHT, Sign};
use crate::style::Role;
use crate::svg::{Canvas, Paint, Rect, Svg};
use crate::view::{Face, Light, View};

/// The surface of one gain, its faces in the colours of a [`GainMap`].
#[derive(Debug, Clone, PartialEq)]
pub struct GainSurface {
    /// Margins, marked points and the flown path; its title is the figure's.
    pub map: GainMap,
    /// Name and unit of the gain.
    pub gain_label: String,
    /// `gains[i][j]` belongs to `map.xs[j]` and `map.ys[i]`; what is not finite is left out.
    pub gains: Vec<Vec<f64>>,
}

const WIDTH: f64 = 560.0;
const VIEW: f64 = 370.0;
const RIGHT: f64 = 84.0;
/// Most faces each way; one that stands for several has the colour of the worst of their nodes.
const MOST: usize = 32;

impl GainSurface {
    /// Draws the surface.
    ///
    /// A face has the colour of the worst of its corners, so no bad node hides between good ones.
    #[must_use]
    pub fn render(&self) -> Svg {
        let title = &self.map.title;
        // The line that divides the map is not drawn on the surface.
        let mut entries = self.map.entries();
        entries.retain(|entry| !matches!(entry.swatch, Swatch::Divide | Swatch::Nothing));
        let notes = Notes::set(entries, WIDTH - 2.0 * EDGE);
        let top = page::title_height(title, WIDTH);
        let mut canvas = Canvas::new(WIDTH, top + VIEW + notes.height() + EDGE);
        page::title(&mut canvas, title);
        let view = self.view(top);
        let map = &self.map;
        view.room(&mut canvas, [&map.x_label, &map.y_label, &self.gain_label]);
        let grading = Grading::of(map);
        self.faces(&mut canvas, &view, grading);
        self.flown(&mut canvas, &view);
        self.points(&mut canvas, &view);
        let bar = Rect { x: WIDTH - RIGHT + 8.0, y: top + 20.0, width: 14.0, height: 230.0 };
        grading.bar(&mut canvas, bar, &map.quantity, map.required.as_ref().map(|found| found.0));
        notes.draw(&mut canvas, EDGE, top + VIEW);
        let over = format!("Surface of {} in space, coloured by margin. ", self.gain_label);
        canvas.finish(title, &format!("{over}{}", map.describe()))
    }

    fn view(&self, top: f64) -> View {
        let heights = extent(self.gains.iter().flatten().copied());
        let nodes = [&self.map.xs, &self.map.ys].map(|nodes| extent(nodes.iter().copied()));
        let axes = [nodes[0], nodes[1], heights].map(|range| Axis::linear(range, 0.0, 5));
        let area = Rect { x: EDGE, y: top, width: WIDTH - EDGE - RIGHT, height: VIEW };
        View::new(axes, area)
    }

    fn faces(&self, canvas: &mut Canvas, view: &View, grading: Grading) {
        let (rows, columns) = (picked(self.map.ys.len()), picked(self.map.xs.len()));
        let height = |i: &usize, j: &usize| {
            self.gains.get(*i).and_then(|row| row.get(*j)).copied().unwrap_or(f64::NAN)
        };
        let nodes =
            |from: &[f64], at: &[usize]| at.iter().filter_map(|n| from.get(*n).copied()).collect();
        let grid = Grid {
            xs: nodes(&self.map.xs, &columns),
            ys: nodes(&self.map.ys, &rows),
            values: rows.iter().map(|i| columns.iter().map(|j| height(i, j)).collect()).collect(),
        };
        view.faces_by(canvas, &grid, Light::Flat, |(i, j), _| {
            let cell = self.worst_of([rows[i], rows[i + 1]], [columns[j], columns[j + 1]]);
            match grading.colour(cell) {
                Some(colour) => Face { colour, crossed: false },
                None => Face { colour: LIGHT, crossed: cell == MapCell::Unstable },
            }
        });
    }

    fn worst_of(&self, rows: [usize; 2], columns: [usize; 2]) -> MapCell {
        let nodes = (rows[0]..=rows[1])
            .flat_map(|i| (columns[0]..=columns[1]).map(move |j| self.map.cell(i, j)));
        nodes.fold(MapCell::Unknown, worse)
    }

    /// The flown path on the surface; what is behind a hill shines through.
    fn flown(&self, canvas: &mut Canvas, view: &View) {
        let points = self.map.flown.iter().map(|at| self.on_surface(*at));
        let mut runs: Vec<Vec<Point>> = vec![Vec::new()];
        for point in points.map(|point| point.map(|point| view.place(point))) {
            match (point, runs.last_mut()) {
                (Some(point), Some(run)) => run.push(point),
                _ => runs.push(Vec::new()),
            }
        }
        let thinned = crate::thin::runs;
        for (role, width) in [(Role::Fixed(LIGHT), 3.6), (Role::Fixed(DARK), 1.7)] {
            for run in runs.iter().flat_map(|run| thinned(run.iter().copied(), (1.0, 1.0), false)) {
                canvas.polyline(&run, false, &Paint::line(role, width));
            }
        }
    }

    fn points(&self, canvas: &mut Canvas, view: &View) {
        let marks = [(&self.map.equilibrium, Sign::Ring), (&self.map.worst, Sign::Frame)];
        for (point, sign) in marks {
            let found = point.as_ref().and_then(|point| self.on_surface(point.at));
            if let Some(found) = found {
                sign.draw_on_data(canvas, view.place(found), 4.2);
            }
        }
    }

    /// The surface above a point of the floor, bilinear between nodes.
    fn on_surface(&self, (x, y): Point) -> Option<[f64; 3]> {
        let (j, across) = between(&self.map.xs, x)?;
        let (i, down) = between(&self.map.ys, y)?;
        let at = |i: usize, j: usize| self.gains.get(i).and_then(|row| row.get(j)).copied();
        let mix = |a: f64, b: f64, part: f64| a + (b - a) * part;
        let low = mix(at(i, j)?, at(i, j + 1)?, across);
        let high = mix(at(i + 1, j)?, at(i + 1, j + 1)?, across);
        let z = mix(low, high, down);
        z.is_finite().then_some([x, y, z])
    }
}

/// The node below `value` and the part of the way to the next one.
fn between(nodes: &[f64], value: f64) -> Option<(usize, f64)> {
    let inside = |pair: &[f64]| pair[0] < pair[1] && pair[0] <= value && value <= pair[1];
    let n = nodes.windows(2).position(inside)?;
    Some((n, (value - nodes[n]) / (nodes[n + 1] - nodes[n])))
}

/// Positions of the nodes that are drawn: the first, the last and even steps between.
fn picked(count: usize) -> Vec<usize> {
    let step = count.saturating_sub(1).div_ceil(MOST).max(1);
    let mut kept: Vec<usize> = (0..count).step_by(step).collect();
    if kept.last().is_some_and(|last| last + 1 < count) {
        kept.push(count - 1);
    }
    kept
}
