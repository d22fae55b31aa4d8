//! Margins over the inputs of the supervisor, the gains frozen at each node: a map of tiles.

use super::clip;
use super::clip::Point;
use super::map_cells::{Grading, coarse};
use super::notes::Notes;
use crate::axis::{Axis, extent, short_number};
use crate::cursor::{self, Cells};
use crate::gaps;
use crate::page::{self, EDGE, Entry, LABEL_PX, Swatch};
use crate::plot::TICK_PX;
use crate::sign::{DARK, LIGHT, Sign};
use crate::style::{Role, wants_dark_text};
use crate::surface::map_axes;
use crate::svg::{Anchor, Canvas, Font, Paint, Rect, Svg, polyline_data};
use crate::text::text_width;
use crate::tiles::edges;

/// A margin at each node of a grid of error and change of error, with the gains frozen there.
#[derive(Debug, Clone, PartialEq)]
pub struct GainMap {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Name and unit along `xs`.
    pub x_label: String,
    /// Name and unit along `ys`.
    pub y_label: String,
    /// Name and unit of the margin, such as "gain margin" in dB.
    pub quantity: String,
    /// Ascending abscissas.
    pub xs: Vec<f64>,
    /// Ascending ordinates.
    pub ys: Vec<f64>,
    /// `cells[i][j]` belongs to `xs[j]` and `ys[i]`; what is missing is [`MapCell::Unknown`].
    pub cells: Vec<Vec<MapCell>>,
    /// Ends of the colour scale, to compare maps; `None` takes those of the values.
    pub scale: Option<(f64, f64)>,
    /// The margin that is asked for, and its name; a thick line divides the map there.
    pub required: Option<(f64, String)>,
    /// The worst node, named with its gains.
    pub worst: Option<MapPoint>,
    /// Where the loop rests, named with its gains.
    pub equilibrium: Option<MapPoint>,
    /// A flown path over the inputs; empty for none.
    pub flown: Vec<(f64, f64)>,
}

/// The margin with the gains of one node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MapCell {
    /// So large; a value that is not finite counts as unknown.
    Value(f64),
    /// No change of this kind makes the loop unstable.
    Unbounded,
    /// The loop is unstable with these gains.
    Unstable,
    /// Not computed.
    Unknown,
}

impl MapCell {
    /// Whether the margin is at least `required`; not known where nothing was computed.
    fn meets(self, required: f64) -> Option<bool> {
        match self {
            Self::Value(value) => Some(value >= required),
            Self::Unbounded => Some(true),
            Self::Unstable => Some(false),
            Self::Unknown => None,
        }
    }
}

/// A named point of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapPoint {
    /// Abscissa and ordinate.
    pub at: (f64, f64),
    /// What is said of it in the legend, such as its margin and gains.
    pub name: String,
}

const SIDE: f64 = 396.0;
const RIGHT: f64 = 84.0;
const BAR: f64 = 14.0;
/// More nodes than these each way have no numbers and are gathered, each tile showing its worst node.
const MOST: usize = 64;

impl GainMap {
    /// Draws the map.
    #[must_use]
    pub fn render(&self) -> Svg {
        let map = coarse(self, MOST);
        let x = Axis::linear(extent(edges(&map.xs)), 0.0, 10);
        let y = Axis::linear(extent(edges(&map.ys)), 0.0, 10);
        let left = EDGE + page::upright_room(1) + page::tick_room(&y);
        let width = left + SIDE + RIGHT;
        let notes = Notes::set(self.entries(), width - left - EDGE);
        let top = page::title_height(&self.title, width) + 4.0;
        let mut canvas = Canvas::new(width, top + SIDE + 54.0 + notes.height());
        page::title(&mut canvas, &self.title);
        let area = Rect { x: left, y: top, width: SIDE, height: SIDE };
        let drawing = Drawing { map: &map, area, axes: [x, y], grading: Grading::of(&map) };
        drawing.draw(&mut canvas);
        notes.draw(&mut canvas, left, top + SIDE + 48.0);
        canvas.finish(&self.title, &self.describe())
    }

    pub(super) fn cell(&self, i: usize, j: usize) -> MapCell {
        match self.cells.get(i).and_then(|row| row.get(j)) {
            Some(MapCell::Value(value)) if !value.is_finite() => MapCell::Unknown,
            Some(cell) => *cell,
            None => MapCell::Unknown,
        }
    }

    pub(super) fn all(&self) -> impl Iterator<Item = MapCell> + '_ {
        (0..self.ys.len()).flat_map(move |i| (0..self.xs.len()).map(move |j| self.cell(i, j)))
    }

    /// What stands below the map, one line each.
    pub(super) fn entries(&self) -> Vec<Entry> {
        let entry = |name: String, swatch| Entry { name, swatch };
        let named = |name: &str, point: &MapPoint, sign| {
            entry(format!("{name}: {}", point.name), Swatch::Sign(sign, Role::Ink))
        };
        let mut entries = Vec::new();
        entries.extend(self.worst.iter().map(|point| named("worst", point, Sign::Frame)));
        entries.extend(self.equilibrium.iter().map(|p| named("equilibrium", p, Sign::Ring)));
        if self.flown.len() > 1 {
            entries.push(entry("flown path".to_owned(), Swatch::Outline));
        }
        if let Some((required, what)) = &self.required {
            let is = |met: bool| move |cell: &MapCell| cell.meets(*required) == Some(met);
            let met = self.all().filter(is(true)).count();
            let name = format!("{what} required: met at {met} of {} nodes", self.all().count());
            // A line is drawn where a node that meets it has a neighbour that does not.
            let divides = met > 0 && self.all().any(|cell| is(false)(&cell));
            entries.push(entry(name, if divides { Swatch::Divide } else { Swatch::Nothing }));
        }
        if self.all().any(|cell| cell == MapCell::Unstable) {
            entries.push(entry("UNSTABLE with the gains frozen there".to_owned(), Swatch::Hatched));
        }
        entries
    }

    pub(super) fn describe(&self) -> String {
        let unstable = self.all().filter(|cell| *cell == MapCell::Unstable).count();
        let (lo, hi) = self.extent().unwrap_or((f64::NAN, f64::NAN));
        let (lo, hi) = (short_number(lo), short_number(hi));
        let mut text = format!(
            "Map of {} over {} and {}: from {lo} to {hi}; unstable at {unstable} of {} nodes.",
            self.quantity,
            self.x_label,
            self.y_label,
            self.xs.len() * self.ys.len()
        );
        for (name, point) in [("Worst", &self.worst), ("Equilibrium", &self.equilibrium)] {
            text.extend(point.iter().map(|point| format!(" {name}: {}.", point.name)));
        }
        text
    }

    pub(super) fn extent(&self) -> Option<(f64, f64)> {
        extent(self.all().filter_map(|cell| match cell {
            MapCell::Value(value) => Some(value),
            _ => None,
        }))
    }
}

/// A node of the map and where it is drawn.
struct Tile {
    place: Rect,
    cell: MapCell,
    row: usize,
    column: usize,
}

struct Drawing<'a> {
    map: &'a GainMap,
    area: Rect,
    axes: [Axis; 2],
    grading: Grading,
}

impl Drawing<'_> {
    fn draw(&self, canvas: &mut Canvas) {
        canvas.begin_clip(self.area);
        // Tiles cover the hatching wherever the loop is not unstable.
        if self.map.all().any(|cell| cell == MapCell::Unstable) {
            gaps::hatch_boldly(canvas, self.area);
        }
        let tiles = self.tiles();
        self.faces(canvas, &tiles);
        self.signs(canvas, &tiles);
        self.divide(canvas, &tiles);
        canvas.end();
        self.flown(canvas);
        let room =
            tiles.iter().map(|tile| tile.place.width.min(tile.place.height)).reduce(f64::min);
        self.points(canvas, room.unwrap_or(0.0).min(60.0));
        map_axes(canvas, self.area, &self.axes[0], &self.axes[1]);
        self.read(canvas);
        self.labels(canvas);
        let a = self.area;
        let bar = Rect { x: a.x + a.width + 18.0, y: a.y, width: BAR, height: a.height };
        let required = self.map.required.as_ref().map(|required| required.0);
        self.grading.bar(canvas, bar, &self.map.quantity, required);
    }

    /// What a cursor reads of each node: its margin, and whether that is as required.
    fn read(&self, canvas: &mut Canvas) {
        let required = self.map.required.as_ref().map(|required| required.0);
        let words = |cell: MapCell| {
            let found = match cell {
                MapCell::Value(value) => self.grading.number(value),
                MapCell::Unbounded => "without limit".to_owned(),
                MapCell::Unstable => return "UNSTABLE".to_owned(),
                MapCell::Unknown => return "not computed".to_owned(),
            };
            match required.and_then(|required| cell.meets(required)) {
                Some(false) => format!("{found}, less than required"),
                _ => found,
            }
        };
        let (columns, rows) = (&self.map.xs, &self.map.ys);
        let panel = cursor::panel(self.area, &self.axes[0], &self.axes[1]);
        let cells = Cells { name: "", quantity: &self.map.quantity, columns, rows };
        cells.worded(canvas, &panel, self.map.all().map(words));
    }

    /// Place and cell of each node.
    fn tiles(&self) -> Vec<Tile> {
        let (xs, ys) = (edges(&self.map.xs), edges(&self.map.ys));
        let mut tiles = Vec::new();
        for (i, y) in ys.windows(2).enumerate() {
            for (j, x) in xs.windows(2).enumerate() {
                let (west, north) = self.place((x[0], y[1]));
                let (east, south) = self.place((x[1], y[0]));
                if [west, north, east, south].iter().all(|edge| edge.is_finite()) {
                    let place =
                        Rect { x: west, y: north, width: east - west, height: south - north };
                    tiles.push(Tile { place, cell: self.map.cell(i, j), row: i, column: j });
                }
            }
        }
        tiles
    }

    fn place(&self, (x, y): Point) -> Point {
        let a = self.area;
        (
            a.x + self.axes[0].fraction(x) * a.width,
            a.y + (1.0 - self.axes[1].fraction(y)) * a.height,
        )
    }

    /// One path per colour: a map of many nodes stays a small file.
    fn faces(&self, canvas: &mut Canvas, tiles: &[Tile]) {
        let mut by_colour: std::collections::BTreeMap<[u8; 3], String> = Default::default();
        let mut unknown = String::new();
        for Tile { place, cell, .. } in tiles {
            match self.grading.colour(*cell) {
                Some(colour) => by_colour.entry(colour).or_default().push_str(&outline(*place)),
                None if *cell == MapCell::Unknown => unknown.push_str(&outline(*place)),
                None => {}
            }
        }
        let numbered = self.numbered(tiles);
        for (colour, d) in by_colour {
            // Without an outline in its own colour, seams would show between tiles.
            let edge = if numbered { Role::Fixed(LIGHT) } else { Role::Fixed(colour) };
            canvas.path(&d, &Paint::line(edge, 0.6).filled(Role::Fixed(colour)));
        }
        if !unknown.is_empty() {
            canvas.path(&unknown, &Paint::line(Role::Grid, 0.6).filled(Role::Face));
        }
    }

    fn numbered(&self, tiles: &[Tile]) -> bool {
        tiles.first().is_some_and(|tile| tile.place.width >= 24.0 && tile.place.height >= 15.0)
    }

    /// Numbers in the tiles, crosses in unstable ones.
    fn signs(&self, canvas: &mut Canvas, tiles: &[Tile]) {
        let numbered = self.numbered(tiles);
        for Tile { place, cell, .. } in tiles {
            let middle = (place.x + place.width / 2.0, place.y + place.height / 2.0);
            let text = match cell {
                MapCell::Value(value) => self.grading.number(*value),
                MapCell::Unbounded => "\u{221e}".to_owned(),
                MapCell::Unstable if place.width.min(place.height) >= 20.0 => {
                    canvas.circle(middle, 8.0, &Paint::face(Role::Face));
                    Sign::Cross.draw(canvas, middle, Role::Ink);
                    continue;
                }
                _ => continue,
            };
            let size = TICK_PX - 1.0;
            if !numbered || text_width(&text, size) + 3.0 > place.width {
                continue;
            }
            let colour = self.grading.colour(*cell).unwrap_or(LIGHT);
            let ink = if wants_dark_text(colour) { DARK } else { LIGHT };
            let font = Font::new(size, Anchor::Middle).role(Role::Fixed(ink));
            canvas.text(middle.0, middle.1 + size * 0.36, &text, font);
        }
    }

    /// A thick line between tiles that meet the requirement and those that do not.
    fn divide(&self, canvas: &mut Canvas, tiles: &[Tile]) {
        let Some((required, _)) = self.map.required.as_ref() else { return };
        let meets = |i: usize, j: usize| self.map.cell(i, j).meets(*required);
        let differ = |a: Option<bool>, b: Option<bool>| a.zip(b).is_some_and(|(a, b)| a != b);
        let mut d = String::new();
        for Tile { place, row, column, .. } in tiles {
            let (east, north) = (place.x + place.width, place.y);
            if differ(meets(*row, *column), meets(*row, column + 1)) {
                d.push_str(&polyline_data(&[(east, north), (east, north + place.height)], false));
            }
            if differ(meets(*row, *column), meets(row + 1, *column)) {
                d.push_str(&polyline_data(&[(place.x, north), (east, north)], false));
            }
        }
        if !d.is_empty() {
            canvas.path(&d, &Paint::line(Role::Fixed(LIGHT), 5.0));
            canvas.path(&d, &Paint::line(Role::Fixed(DARK), 2.6));
        }
    }

    fn flown(&self, canvas: &mut Canvas) {
        let runs = clip::runs(self.map.flown.iter().map(|at| self.place(*at)), self.area);
        canvas.begin_clip(self.area);
        for (role, width) in [(Role::Fixed(LIGHT), 3.6), (Role::Fixed(DARK), 1.7)] {
            for run in &runs {
                canvas.polyline(run, false, &Paint::line(role, width));
            }
        }
        canvas.end();
    }

    fn points(&self, canvas: &mut Canvas, room: f64) {
        let marks = [(&self.map.equilibrium, Sign::Ring), (&self.map.worst, Sign::Frame)];
        for (point, sign) in marks {
            let Some((x, y)) = point.as_ref().map(|point| self.place(point.at)) else { continue };
            let a = self.area;
            if x >= a.x && x <= a.x + a.width && y >= a.y && y <= a.y + a.height {
                // Around the number of a tile, not on it.
                let arm = if room >= 24.0 { room * 0.42 } else { 4.2 };
                sign.draw_on_data(canvas, (x, y), arm);
            }
        }
    }

    fn labels(&self, canvas: &mut Canvas) {
        let a = self.area;
        page::level_label(canvas, a.x + a.width / 2.0, a.y + a.height + 36.0, &self.map.x_label);
        let label = std::slice::from_ref(&self.map.y_label);
        page::upright_label(canvas, EDGE + LABEL_PX, a.y + a.height / 2.0, label);
    }
}

fn outline(r: Rect) -> String {
    let (east, south) = (r.x + r.width, r.y + r.height);
    polyline_data(&[(r.x, r.y), (east, r.y), (east, south), (r.x, south)], true)
}
