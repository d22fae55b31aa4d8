//! A gain as a function of error and change of error: seen in space, or as a map.

use super::axis::{Axis, extent, short_number};
use super::contour::Grid;
use super::cursor::{self, Cells};
use super::gaps;
use super::page::{self, EDGE, LABEL_PX};
use super::plot::TICK_PX;
use super::style::{Rgb, Role, diverging, sequential};
use super::svg::{Anchor, Canvas, Font, Paint, Rect, Svg, polyline_data};
use super::text::{text_width, unmarked};
use super::view::{Light, Observer, View};

/// How a [`Surface`] is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurfaceKind {
    /// Seen from above and aside, right-handed axes.
    View,
    /// A map with lines of equal value: full where positive, dashed where negative, thick at zero.
    Map,
    /// Both side by side, the view lit from the left so that its slopes show.
    Relief,
}

/// Values over a rectangular grid; the colour scale is centred at zero, or runs from the lowest to
/// the highest value where all have one sign and no limit is given.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Name and unit along `xs`.
    pub x_label: String,
    /// Name and unit along `ys`.
    pub y_label: String,
    /// Name and unit of the values.
    pub z_label: String,
    /// Ascending abscissas.
    pub xs: Vec<f64>,
    /// Ascending ordinates.
    pub ys: Vec<f64>,
    /// `values[i][j]` belongs to `xs[j]` and `ys[i]`; what is not finite or missing is left out.
    pub values: Vec<Vec<f64>>,
    /// Largest magnitude of the colour scale, to compare figures; `None` takes that of the values.
    pub limit: Option<f64>,
}

const WIDTH: f64 = 500.0;
/// Width of a map whose axes may have long numbers.
const WIDE: f64 = 548.0;
const MAP: f64 = 336.0;
const VIEW: f64 = 330.0;
const BAR: f64 = 14.0;

/// Which colour a value has.
#[derive(Debug, Clone, Copy)]
enum Scale {
    /// White at zero, up to this magnitude.
    AboutZero(f64),
    /// From light to dark.
    Between(f64, f64),
}

impl Scale {
    fn colour(self, value: f64) -> Rgb {
        match self {
            Self::AboutZero(limit) => diverging(value, limit),
            Self::Between(lo, hi) => sequential((value - lo) / (hi - lo)),
        }
    }
}

impl Surface {
    /// Draws the surface.
    #[must_use]
    pub fn render(&self, kind: SurfaceKind) -> Svg {
        match kind {
            SurfaceKind::View => self.view(),
            SurfaceKind::Map => self.map(),
            SurfaceKind::Relief => self.relief(),
        }
    }

    /// Names of the abscissa, the ordinate and the values as they are read, without marks for the drawing.
    #[must_use]
    pub fn spoken_labels(&self) -> [String; 3] {
        [&self.x_label, &self.y_label, &self.z_label].map(|label| unmarked(label))
    }

    fn extent(&self) -> Option<(f64, f64)> {
        extent(self.values.iter().flatten().copied())
    }

    /// The colours of the values.
    fn scale(&self) -> Scale {
        match self.extent() {
            Some((lo, hi)) if self.limit.is_none() && (lo >= 0.0 || hi <= 0.0) && lo < hi => {
                Scale::Between(lo, hi)
            }
            _ => Scale::AboutZero(self.limit()),
        }
    }

    fn limit(&self) -> f64 {
        let largest = self.extent().map_or(1.0, |(lo, hi)| lo.abs().max(hi.abs()));
        let limit = self.limit.filter(|limit| limit.is_finite() && *limit > 0.0).unwrap_or(largest);
        if limit > 0.0 { limit } else { 1.0 }
    }

    fn view(&self) -> Svg {
        let top = page::title_height(&self.title, WIDTH);
        let mut canvas = Canvas::new(WIDTH, top + VIEW + EDGE);
        page::title(&mut canvas, &self.title);
        let z = self.draw_view(&mut canvas, top, WIDTH - 2.0 * EDGE - 56.0, Light::Flat);
        let bar = Rect { x: WIDTH - EDGE - 52.0, y: top + 24.0, width: BAR, height: 186.0 };
        self.bar(&mut canvas, bar, &z, &shades(&z));
        canvas.finish(&self.title, &self.describe("Surface in space"))
    }

    fn relief(&self) -> Svg {
        let top = page::title_height(&self.title, 2.0 * WIDTH);
        let mut canvas = Canvas::new(2.0 * WIDTH, top + MAP + 52.0);
        page::title(&mut canvas, &self.title);
        self.draw_view(&mut canvas, top + 12.0, WIDTH - 2.0 * EDGE, Light::FromTheLeft);
        canvas.begin_shift(WIDTH, 0.0);
        self.draw_map(&mut canvas, top + 4.0, false);
        canvas.end();
        canvas.finish(&self.title, &self.describe("Surface in space, and as a map"))
    }

    /// The surface as `observer` sees it, with the same light as a relief and without a bar of colours.
    #[must_use]
    pub fn seen_by(&self, observer: Observer) -> Svg {
        let top = page::title_height(&self.title, WIDTH);
        let mut canvas = Canvas::new(WIDTH, top + MAP + 52.0);
        page::title(&mut canvas, &self.title);
        let room = Rect { x: EDGE, y: top, width: WIDTH - 2.0 * EDGE, height: MAP + 44.0 };
        let view = View::from(self.axes(), room, observer);
        self.draw(&mut canvas, &view, Light::FromTheLeft);
        canvas.finish(&self.title, &self.describe("Surface in space"))
    }

    fn axes(&self) -> [Axis; 3] {
        let ranges =
            [extent(self.xs.iter().copied()), extent(self.ys.iter().copied()), self.extent()];
        ranges.map(|range| Axis::linear(range, 0.0, 5))
    }

    /// Draws the surface in space and returns the axis of its values.
    fn draw_view(&self, canvas: &mut Canvas, top: f64, width: f64, light: Light) -> Axis {
        let axes = self.axes();
        let view = View::new(axes, Rect { x: EDGE, y: top, width, height: VIEW });
        self.draw(canvas, &view, light);
        let [_, _, z] = axes;
        z
    }

    fn draw(&self, canvas: &mut Canvas, view: &View, light: Light) {
        let scale = self.scale();
        view.room(canvas, [&self.x_label, &self.y_label, &self.z_label]);
        view.faces(canvas, &self.coarse(), light, |value| scale.colour(value));
    }

    /// At most 40 cells each way: more would only thicken the lines.
    fn coarse(&self) -> Grid {
        let pick = |count: usize| -> Vec<usize> {
            let step = count.saturating_sub(1).div_ceil(40).max(1);
            let mut kept: Vec<usize> = (0..count).step_by(step).collect();
            if kept.last().is_some_and(|last| last + 1 < count) {
                kept.push(count - 1);
            }
            kept
        };
        let (rows, columns) = (pick(self.ys.len()), pick(self.xs.len()));
        let value = |i: &usize, j: &usize| {
            self.values.get(*i).and_then(|row| row.get(*j)).copied().unwrap_or(f64::NAN)
        };
        Grid {
            values: rows.iter().map(|i| columns.iter().map(|j| value(i, j)).collect()).collect(),
            xs: columns.iter().filter_map(|j| self.xs.get(*j).copied()).collect(),
            ys: rows.iter().filter_map(|i| self.ys.get(*i).copied()).collect(),
        }
    }

    fn map(&self) -> Svg {
        let top = page::title_height(&self.title, WIDTH) + 4.0;
        let mut canvas = Canvas::new(WIDTH, top + MAP + 48.0);
        page::title(&mut canvas, &self.title);
        self.draw_map(&mut canvas, top, false);
        canvas.finish(&self.title, &self.describe("Map with lines of equal value"))
    }

    /// Draws the map with hatching where values are missing; `words` say what that means.
    #[must_use]
    pub fn map_with_gaps(&self, words: &str) -> Svg {
        let top = page::title_height(&self.title, WIDE) + 4.0;
        let mut canvas = Canvas::new(WIDE, top + MAP + 48.0 + gaps::LEGEND);
        page::title(&mut canvas, &self.title);
        self.draw_map(&mut canvas, top, true);
        gaps::legend(&mut canvas, (WIDTH / 2.0, top + MAP + 46.0), words);
        let kind = format!("Map with lines of equal value; hatched: {words}");
        canvas.finish(&self.title, &self.describe(&kind))
    }

    fn draw_map(&self, canvas: &mut Canvas, top: f64, hatched: bool) {
        let [x, y] =
            [&self.xs, &self.ys].map(|nodes| Axis::linear(extent(nodes.iter().copied()), 0.0, 10));
        let left = EDGE + page::upright_room(1) + page::tick_room(&y);
        let area = Rect { x: left, y: top, width: MAP, height: MAP };
        let grid = Grid {
            xs: self.xs.iter().map(|v| area.x + x.fraction(*v) * area.width).collect(),
            ys: self.ys.iter().map(|v| area.y + (1.0 - y.fraction(*v)) * area.height).collect(),
            values: self.values.clone(),
        };
        let z = Axis::linear(self.extent(), 0.0, 10);
        canvas.begin_clip(area);
        if hatched {
            gaps::hatch(canvas, area);
        }
        self.paint_map(canvas, &grid, &z);
        canvas.end();
        map_axes(canvas, area, &x, &y);
        self.read(canvas, &cursor::panel(area, &x, &y));
        if hatched {
            gaps::crosses(canvas, &grid);
        }
        page::level_label(canvas, area.x + MAP / 2.0, top + MAP + 36.0, &self.x_label);
        page::upright_label(
            canvas,
            EDGE + LABEL_PX,
            top + MAP / 2.0,
            std::slice::from_ref(&self.y_label),
        );
        let bar = Rect { x: area.x + MAP + 22.0, y: top, width: BAR, height: MAP };
        self.bar(canvas, bar, &z, &bands(&z));
        for level in levels(&z) {
            let y = bar.y + (1.0 - z.fraction(level)) * bar.height;
            canvas.line((bar.x, y), (bar.x + bar.width, y), &level_line(level, z.step()));
        }
    }

    /// What a cursor reads of each node.
    fn read(&self, canvas: &mut Canvas, panel: &str) {
        let Some((lo, hi)) = self.extent() else { return };
        let (columns, rows) = (&self.xs, &self.ys);
        let value = |i: usize, j: usize| {
            self.values.get(i).and_then(|row| row.get(j)).copied().unwrap_or(f64::NAN)
        };
        let all = (0..rows.len()).flat_map(|i| (0..columns.len()).map(move |j| value(i, j)));
        let cells = Cells { name: "", quantity: &self.z_label, columns, rows };
        cells.graded(canvas, panel, (lo, hi), all);
    }

    fn paint_map(&self, canvas: &mut Canvas, grid: &Grid, z: &Axis) {
        let Some((lowest, _)) = self.extent() else {
            return;
        };
        let (scale, levels) = (self.scale(), levels(z));
        let floor = levels.first().map_or(lowest, |first| first - z.step());
        for base in std::iter::once(floor).chain(levels.iter().copied()) {
            let from = if base <= floor { f64::NEG_INFINITY } else { base };
            let d: String =
                grid.region(from).iter().map(|polygon| polyline_data(polygon, true)).collect();
            if !d.is_empty() {
                canvas.path(&d, &Paint::face(Role::Fixed(scale.colour(base + z.step() / 2.0))));
            }
        }
        for level in levels {
            let d: String =
                grid.lines(level).iter().map(|line| polyline_data(line, false)).collect();
            if !d.is_empty() {
                canvas.path(&d, &level_line(level, z.step()));
            }
        }
    }

    /// The colour bar with its numbers; `slices` are its boundaries from below.
    fn bar(&self, canvas: &mut Canvas, r: Rect, z: &Axis, slices: &[f64]) {
        let scale = self.scale();
        let place = |value: f64| r.y + (1.0 - z.fraction(value)) * r.height;
        for pair in slices.windows(2) {
            let &[lo, hi] = pair else { continue };
            // Each slice reaches under the one above it, so that no seam shows.
            let height = (place(lo) - place(hi) + 0.6).min(r.y + r.height - place(hi));
            let colour = scale.colour(lo / 2.0 + hi / 2.0);
            canvas.rect(r.x, place(hi), r.width, height, &Paint::face(Role::Fixed(colour)));
        }
        canvas.rect(r.x, r.y, r.width, r.height, &Paint::line(Role::Ink, 0.8));
        let mut widest = 0.0_f64;
        for tick in z.ticks() {
            let y = r.y + (1.0 - tick.at) * r.height;
            canvas.line((r.x + r.width, y), (r.x + r.width + 4.0, y), &Paint::line(Role::Ink, 1.0));
            canvas.text(
                r.x + r.width + 7.0,
                y + TICK_PX * 0.36,
                &tick.label,
                Font::new(TICK_PX, Anchor::Start),
            );
            widest = widest.max(text_width(&tick.label, TICK_PX));
        }
        let x = (r.x + r.width + 22.0 + widest).min(canvas.width() - 4.0);
        page::upright_label(canvas, x, r.y + r.height / 2.0, std::slice::from_ref(&self.z_label));
    }

    fn describe(&self, kind: &str) -> String {
        let (lo, hi) = self.extent().unwrap_or((f64::NAN, f64::NAN));
        let (lo, hi) = (short_number(lo), short_number(hi));
        format!(
            "{kind}: {} over {} and {}, from {lo} to {hi}.",
            self.z_label, self.x_label, self.y_label
        )
    }
}

/// Values of the ticks of `z` strictly inside its range.
fn levels(z: &Axis) -> Vec<f64> {
    let slack = (z.hi - z.lo) * 1e-6;
    let first = (z.lo / z.step()).floor();
    (0..60)
        .map(|n| (first + f64::from(n)) * z.step())
        .filter(|level| *level > z.lo + slack && *level < z.hi - slack)
        .collect()
}

/// Boundaries of the bands of a map: the levels and both ends.
fn bands(z: &Axis) -> Vec<f64> {
    std::iter::once(z.lo).chain(levels(z)).chain(std::iter::once(z.hi)).collect()
}

/// Boundaries so close that the scale looks continuous.
fn shades(z: &Axis) -> Vec<f64> {
    (0..=64).map(|n| z.lo + (z.hi - z.lo) * f64::from(n) / 64.0).collect()
}

/// Thick at zero, full above and dashed below it.
fn level_line(level: f64, step: f64) -> Paint {
    let ink = Role::Fixed([40, 40, 40]);
    if level.abs() < step * 1e-6 {
        Paint::line(ink, 1.6)
    } else if level > 0.0 {
        Paint::line(ink, 0.7)
    } else {
        Paint::line(ink, 0.7).dashed("4 2.5")
    }
}

pub(super) fn map_axes(canvas: &mut Canvas, area: Rect, x: &Axis, y: &Axis) {
    canvas.rect(area.x, area.y, area.width, area.height, &Paint::line(Role::Ink, 1.0));
    let (bottom, ink) = (area.y + area.height, Paint::line(Role::Ink, 1.0));
    for tick in x.ticks() {
        let at = area.x + tick.at * area.width;
        canvas.line((at, bottom), (at, bottom + 4.0), &ink);
        canvas.text(at, bottom + 4.0 + TICK_PX, &tick.label, Font::new(TICK_PX, Anchor::Middle));
    }
    for tick in y.ticks() {
        let at = bottom - tick.at * area.height;
        canvas.line((area.x - 4.0, at), (area.x, at), &ink);
        canvas.text(
            area.x - 7.0,
            at + TICK_PX * 0.36,
            &tick.label,
            Font::new(TICK_PX, Anchor::End),
        );
    }
}
