//! A plot area with its axes: grid, ticks, tolerance bands, lines of reference, curves and markers.

use super::axis::Axis;
use super::cursor;
use super::style::{Role, SeriesStyle};
use super::svg::{Anchor, Canvas, Font, Paint, Rect};
use super::thin;

/// Marks grid lines, ticks and their numbers: what a script puts others in place of.
const GROUND: &str = "data-ground=\"\"";
/// Size of tick labels (px).
pub(super) const TICK_PX: f64 = 11.0;
/// Length of ticks (px).
const TICK_LENGTH: f64 = 4.0;
/// Where the drawing of a frame begins above its area (px).
const ROOM_ABOVE: f64 = 12.0;
/// Half the size of a mark (px).
const MARK_PX: f64 = 3.4;
/// Room between a tick and a number beside it (px).
const TICK_GAP_PX: f64 = 3.0;
/// Height of a tick's number above its baseline, and half of that of a capital letter, by the measures of DejaVu
/// Sans, 1901 and 1493 of 2048 (px).
const TICK_ASCENT_PX: f64 = TICK_PX * 1901.0 / 2048.0;
const TICK_CENTRE_PX: f64 = TICK_PX * 1493.0 / 2048.0 / 2.0;

/// A plot area and its axes.
#[derive(Debug, Clone)]
pub(super) struct Frame {
    pub(super) area: Rect,
    pub(super) x: Axis,
    pub(super) y: Axis,
    /// False where the panel below carries the numbers.
    pub(super) x_labels: bool,
}

/// What is drawn in a frame, from back to front, all in display units.
#[derive(Debug, Clone, Default)]
pub(super) struct Content {
    /// Tolerance bands: lower and upper end.
    pub(super) bands: Vec<(f64, f64)>,
    /// Horizontal reference lines.
    pub(super) references: Vec<f64>,
    /// Abscissas at which something begins: upright lines.
    pub(super) beginnings: Vec<f64>,
    pub(super) curves: Vec<Curve>,
    /// True where nothing else is drawn in the frame, so that a script may stretch all of it.
    pub(super) is_all: bool,
}

/// A line, perhaps with marked points.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    /// Empty for one that only its style names.
    pub(super) name: String,
    pub(super) style: SeriesStyle,
    pub(super) points: Vec<(f64, f64)>,
    pub(super) stairs: bool,
    pub(super) marked: bool,
}

impl Frame {
    /// Position of `x`, `y` on the canvas.
    pub(super) fn place(&self, x: f64, y: f64) -> (f64, f64) {
        let a = &self.area;
        (a.x + self.x.fraction(x) * a.width, a.y + (1.0 - self.y.fraction(y)) * a.height)
    }

    /// px per tick unit in x and y.
    fn scale(&self) -> (f64, f64) {
        let (x, y) = (self.x.unit_range(), self.y.unit_range());
        (self.area.width / (x.1 - x.0), self.area.height / (y.1 - y.0))
    }

    /// Position in tick units on the canvas.
    fn unit_place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.x_of_unit(x), self.y_of_unit(y))
    }

    fn x_of_unit(&self, unit: f64) -> f64 {
        let scale = self.scale().0;
        (self.area.x - self.x.unit_range().0 * scale) + unit * scale
    }

    fn y_of_unit(&self, unit: f64) -> f64 {
        let scale = self.scale().1;
        let bottom = self.area.y + self.area.height;
        (bottom + self.y.unit_range().0 * scale) - unit * scale
    }
}

/// Draws grid, axes and content of `frame`.
pub(super) fn draw(canvas: &mut Canvas, frame: &Frame, content: &Content) {
    canvas.begin_marked(&data(frame, content.is_all));
    let logarithmic =
        [(true, &frame.x), (false, &frame.y)].into_iter().filter(|(_, axis)| axis.log);
    for (axis_is_x, axis) in logarithmic {
        canvas.begin_marked(GROUND);
        log_ticks(canvas, frame, axis, axis_is_x);
        canvas.end();
    }
    canvas.begin_shift(0.0, frame.area.y - ROOM_ABOVE);
    let area = Rect { y: ROOM_ABOVE, ..frame.area };
    let frame = Frame { area, ..frame.clone() };
    canvas.begin_marked(GROUND);
    grid(canvas, &frame);
    ticks_and_numbers(canvas, &frame);
    canvas.end();
    axes(canvas, &frame);
    canvas.begin_clip(area);
    bands(canvas, &frame, content);
    for curve in &content.curves {
        draw_curve(canvas, &frame, curve);
    }
    lines(canvas, &frame, content);
    canvas.end();
    canvas.end();
    canvas.end();
}

/// Where the panel is and what its axes span: what a script needs to read values off the drawing.
fn data(frame: &Frame, is_all: bool) -> String {
    let all = if is_all { " data-all=\"\"" } else { "" };
    cursor::panel(frame.area, &frame.x, &frame.y) + all
}

/// Whole tick units within a range.
fn ticks((lo, hi): (f64, f64)) -> impl Iterator<Item = f64> {
    let count = if hi - lo <= 400.0 { (hi.floor() - lo.ceil()).max(-1.0) as usize + 1 } else { 0 };
    (0..count).map(move |index| lo.ceil() + index as f64)
}

/// Lines at the ticks, but for those that would lie under an axis.
fn grid(canvas: &mut Canvas, frame: &Frame) {
    let Rect { x: left, y: top, width, height } = frame.area;
    let (right, bottom) = (left + width, top + height);
    let paint = Paint::line(Role::Grid, 0.7);
    for x in ticks(frame.x.unit_range()).map(|unit| frame.x_of_unit(unit)) {
        if (x - left).abs() >= 1.0 {
            canvas.line((x, top), (x, bottom), &paint);
        }
    }
    for y in ticks(frame.y.unit_range()).map(|unit| frame.y_of_unit(unit)) {
        if (y - bottom).abs() >= 1.0 {
            canvas.line((left, y), (right, y), &paint);
        }
    }
}

/// The lines of the axes.
fn axes(canvas: &mut Canvas, frame: &Frame) {
    let Rect { x: left, y: top, width, height } = frame.area;
    let bottom = top + height;
    let paint = Paint::line(Role::Ink, 1.0);
    canvas.line((left, bottom), (left + width, bottom), &paint);
    canvas.line((left, top), (left, bottom), &paint);
}

/// The ticks of the axes and their numbers.
fn ticks_and_numbers(canvas: &mut Canvas, frame: &Frame) {
    let Rect { x: left, y: top, height, .. } = frame.area;
    let bottom = top + height;
    let paint = Paint::line(Role::Ink, 1.0);
    for unit in ticks(frame.x.unit_range()) {
        let x = frame.x_of_unit(unit);
        canvas.line((x, bottom), (x, bottom + TICK_LENGTH), &paint);
        if frame.x_labels && !frame.x.log {
            let font = Font::new(TICK_PX, Anchor::Middle);
            canvas.text(x, bottom + TICK_LENGTH + TICK_ASCENT_PX, &frame.x.label(unit), font);
        }
    }
    for unit in ticks(frame.y.unit_range()) {
        let y = frame.y_of_unit(unit);
        canvas.line((left - TICK_LENGTH, y), (left, y), &paint);
        if !frame.y.log {
            let font = Font::new(TICK_PX, Anchor::End);
            let x = left - TICK_LENGTH - TICK_GAP_PX;
            canvas.text(x, y + TICK_CENTRE_PX, &frame.y.label(unit), font);
        }
    }
}

/// Bands, behind the curves.
fn bands(canvas: &mut Canvas, frame: &Frame, content: &Content) {
    let Rect { x: left, width, .. } = frame.area;
    for band in content.bands.iter().filter_map(|band| Band::of(frame, *band)) {
        // A band too thin for an outline is made darker instead.
        let paint = Paint::face(Role::Band).opacity(if band.is_thin { 0.45 } else { 0.2 });
        canvas.rect(left, band.top, width, band.bottom - band.top, &paint);
    }
}

/// The edges of bands and the lines of reference, before the curves.
fn lines(canvas: &mut Canvas, frame: &Frame, content: &Content) {
    let Rect { x: left, width, .. } = frame.area;
    let mut line = |y: f64, paint: &Paint| canvas.line((left, y), (left + width, y), paint);
    let edge = Paint::line(Role::Band, 0.8).dashed("3 2.5");
    for band in content.bands.iter().filter_map(|band| Band::of(frame, *band)) {
        if !band.is_thin {
            band.edges.iter().for_each(|y| line(*y, &edge));
        }
    }
    let reference = Paint::line(Role::Ink, 1.0).dashed("6 3");
    let (lowest, highest) = frame.y.unit_range();
    for at in content.references.iter().map(|value| frame.y.unit(*value)) {
        if (lowest..=highest).contains(&at) {
            line(frame.y_of_unit(at), &reference);
        }
    }
    beginnings(canvas, frame, content);
}

/// Upright lines, thinner than those of reference.
fn beginnings(canvas: &mut Canvas, frame: &Frame, content: &Content) {
    let Rect { y: top, height, .. } = frame.area;
    let paint = Paint::line(Role::Muted, 0.8).dashed("1.5 2.5");
    let (first, last) = frame.x.unit_range();
    for at in content.beginnings.iter().map(|value| frame.x.unit(*value)) {
        if (first..=last).contains(&at) {
            let x = frame.x_of_unit(at);
            canvas.line((x, top), (x, top + height), &paint);
        }
    }
}

/// A tolerance band on the canvas.
struct Band {
    top: f64,
    bottom: f64,
    /// Of the two ends, in the order in which they were given.
    edges: [f64; 2],
    is_thin: bool,
}

impl Band {
    /// Nothing for ends that cannot be shown.
    fn of(frame: &Frame, (lower, upper): (f64, f64)) -> Option<Self> {
        let ends = [frame.y.unit(lower), frame.y.unit(upper)];
        let [lower, upper] = ends;
        (lower.is_finite() && upper.is_finite()).then(|| Self {
            top: frame.y_of_unit(lower.max(upper)),
            bottom: frame.y_of_unit(lower.min(upper)),
            edges: ends.map(|end| frame.y_of_unit(end)),
            is_thin: (upper - lower).abs() * frame.scale().1 < 8.0,
        })
    }
}

fn draw_curve(canvas: &mut Canvas, frame: &Frame, curve: &Curve) {
    let style = curve.style;
    canvas.begin_curve(&style.key(), &curve.name);
    let units = curve.points.iter().map(|&(x, y)| (frame.x.unit(x), frame.y.unit(y)));
    let paint = Paint::line(style.role(), style.width()).dashed(style.dash());
    for mut run in thin::runs(units.clone(), frame.scale(), curve.stairs) {
        for point in &mut run {
            *point = frame.unit_place(*point);
        }
        canvas.polyline(&run, false, &paint);
    }
    if curve.marked {
        for point in units.filter(|(x, y)| x.is_finite() && y.is_finite()) {
            draw_mark(canvas, style, frame.unit_place(point));
        }
    }
    canvas.end();
}

/// A circle, square, triangle or diamond, by the number of the style.
fn draw_mark(canvas: &mut Canvas, style: SeriesStyle, (x, y): (f64, f64)) {
    let face = Paint::face(style.role());
    let outlined = || Paint::line(style.role(), 0.5).filled(style.role());
    match style.marker() {
        1 => canvas.rect(x - MARK_PX, y - MARK_PX, 2.0 * MARK_PX, 2.0 * MARK_PX, &face),
        2 => {
            let (above, below) = (y - MARK_PX * 1.7 * 0.6, y + MARK_PX * 1.7 * 0.4);
            canvas.path(
                &corners(&[(x, above), (x - MARK_PX, below), (x + MARK_PX, below)]),
                &outlined(),
            );
        }
        3 => {
            let s = MARK_PX * 1.3;
            canvas.path(&corners(&[(x, y - s), (x + s, y), (x, y + s), (x - s, y)]), &outlined());
        }
        _ => canvas.circle((x, y), MARK_PX, &face),
    }
}

/// Path data of a closed polygon.
fn corners(points: &[(f64, f64)]) -> String {
    let rounded = |value: f64| (value * 100.0).round() / 100.0;
    let corner = |&(x, y): &(f64, f64)| format!("{:?},{:?}", rounded(x), rounded(y));
    format!("M{} Z", points.iter().map(corner).collect::<Vec<_>>().join(" L"))
}

/// Ticks of a logarithmic axis, which the library cannot place at will.
fn log_ticks(canvas: &mut Canvas, frame: &Frame, axis: &Axis, is_x: bool) {
    let area = &frame.area;
    let (bottom, left) = (area.y + area.height, area.x);
    for tick in axis.ticks() {
        let minor = tick.label.is_empty();
        let length = if minor { TICK_LENGTH * 0.6 } else { TICK_LENGTH };
        let paint = Paint::line(Role::Ink, 1.0);
        let grid = Paint::line(Role::Grid, if minor { 0.35 } else { 0.7 });
        if is_x {
            let x = area.x + tick.at * area.width;
            canvas.line((x, area.y), (x, bottom - 1.0), &grid);
            canvas.line((x, bottom), (x, bottom + length), &paint);
            if frame.x_labels {
                canvas.text(
                    x,
                    bottom + TICK_LENGTH + TICK_PX,
                    &tick.label,
                    Font::new(TICK_PX, Anchor::Middle),
                );
            }
        } else {
            let y = bottom - tick.at * area.height;
            canvas.line((left + 1.0, y), (area.x + area.width, y), &grid);
            canvas.line((left - length, y), (left, y), &paint);
            canvas.text(
                left - TICK_LENGTH - 3.0,
                y + TICK_PX * 0.36,
                &tick.label,
                Font::new(TICK_PX, Anchor::End),
            );
        }
    }
}
