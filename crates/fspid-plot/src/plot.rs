//! The one place that knows the drawing library.
//!
//! A [`Frame`] is a plot area with its axes. `kuva` lays out grid, axes, ticks, bands, lines and markers
//! into a scene; the scene's primitives are then drawn on our [`Canvas`], which rounds, themes, numbers
//! and escapes. Its own SVG writer is not used: it numbers clip paths by a counter of the process, so the
//! same figure would come out with other bytes the second time.

use kuva::plot::{LinePlot, LineStyle, MarkerShape, ScatterPlot};
use kuva::render::annotations::{ReferenceLine, ShadedRegion};
use kuva::render::color::Color;
use kuva::render::layout::{Layout, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor, render_multiple};
use kuva::render::theme::Theme;

use super::axis::Axis;
use super::style::{Role, SeriesStyle};
use super::svg::{Anchor, Canvas, Font, Paint, Rect};
use super::thin;

/// Size of tick labels (px).
pub(super) const TICK_PX: f64 = 11.0;
/// Room that the library gets around the plot area for ticks and their labels (px).
const ROOM_ABOVE: f64 = 12.0;
const ROOM_BELOW: f64 = 28.0;
const TICK_LENGTH: f64 = 4.0;

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
    pub(super) curves: Vec<Curve>,
}

/// A line, perhaps with marked points.
#[derive(Debug, Clone)]
pub(super) struct Curve {
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
}

/// Draws grid, axes and content of `frame`.
pub(super) fn draw(canvas: &mut Canvas, frame: &Frame, content: &Content) {
    let area = &frame.area;
    let mut plots = Vec::new();
    for curve in &content.curves {
        push_curve(&mut plots, frame, curve);
    }
    if plots.is_empty() {
        // Without any plot the library draws no axes.
        plots.push(Plot::Line(LinePlot::new()));
    }
    for (axis_is_x, axis) in [(true, &frame.x), (false, &frame.y)] {
        if axis.log {
            log_ticks(canvas, frame, axis, axis_is_x);
        }
    }
    let scene = render_multiple(plots, layout(canvas.width(), frame, content));
    canvas.begin_shift(0.0, area.y - ROOM_ABOVE);
    let clip = Rect { x: area.x, y: ROOM_ABOVE, width: area.width, height: area.height };
    replay(canvas, &scene, clip);
    canvas.end();
}

fn push_curve(plots: &mut Vec<Plot>, frame: &Frame, curve: &Curve) {
    let style = curve.style;
    let units = curve.points.iter().map(|&(x, y)| (frame.x.unit(x), frame.y.unit(y)));
    let marks: Vec<(f64, f64)> =
        units.clone().filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
    for mut run in thin::runs(units, frame.scale(), curve.stairs) {
        if let [only] = *run.as_slice() {
            run.push(only);
        }
        let mut line = LinePlot::new()
            .with_data(run)
            .with_color(style.role().token())
            .with_stroke_width(style.width());
        if !style.dash().is_empty() {
            line = line.with_line_style(LineStyle::Custom(style.dash().to_owned()));
        }
        plots.push(Plot::Line(line));
    }
    if curve.marked {
        let shape =
            [MarkerShape::Circle, MarkerShape::Square, MarkerShape::Triangle, MarkerShape::Diamond]
                .get(style.marker())
                .copied()
                .unwrap_or(MarkerShape::Circle);
        let dots = ScatterPlot::new()
            .with_data(marks)
            .with_color(style.role().token())
            .with_size(3.4)
            .with_marker(shape);
        plots.push(Plot::Scatter(dots));
    }
}

fn layout(canvas_width: f64, frame: &Frame, content: &Content) -> Layout {
    let (area, x, y) = (&frame.area, frame.x.unit_range(), frame.y.unit_range());
    let (x_axis, y_axis) = (frame.x, frame.y);
    let below = if frame.x_labels { ROOM_BELOW } else { ROOM_ABOVE };
    let named = frame.x_labels && !x_axis.log;
    let layout = Layout::new(x, y)
        .with_width(canvas_width)
        .with_height(area.height + ROOM_ABOVE + below)
        .with_force_margins(area.x, canvas_width - area.x - area.width)
        .with_force_margins_y(ROOM_ABOVE, below)
        .with_x_axis_min(x.0)
        .with_x_axis_max(x.1)
        .with_y_axis_min(y.0)
        .with_y_axis_max(y.1)
        .with_x_tick_step(1.0)
        .with_y_tick_step(1.0)
        .with_x_tick_format(TickFormat::Custom(std::sync::Arc::new(move |unit| {
            if named { x_axis.label(unit) } else { String::new() }
        })))
        .with_y_tick_format(TickFormat::Custom(std::sync::Arc::new(move |unit| {
            if y_axis.log { String::new() } else { y_axis.label(unit) }
        })))
        .with_tick_size(TICK_PX as u32)
        .with_tick_length(TICK_LENGTH)
        .with_grid_line_width(0.7)
        .with_axis_line_width(1.0)
        .with_theme(theme());
    marks(layout, frame, content)
}

/// Adds bands and lines of reference.
fn marks(mut layout: Layout, frame: &Frame, content: &Content) -> Layout {
    let y = frame.y.unit_range();
    for &(lo, hi) in &content.bands {
        let (lo, hi) = (frame.y.unit(lo), frame.y.unit(hi));
        if lo.is_finite() && hi.is_finite() {
            // A band too thin for an outline is made darker instead.
            let thin = (hi - lo).abs() * frame.scale().1 < 8.0;
            let opacity = if thin { 0.45 } else { 0.2 };
            layout = layout.with_shaded_region(
                ShadedRegion::horizontal(lo.min(hi), lo.max(hi))
                    .with_color(Role::Band.token())
                    .with_opacity(opacity),
            );
            for edge in [lo, hi].into_iter().filter(|_| !thin) {
                layout = layout.with_reference_line(reference(edge, Role::Band, 0.8, "3 2.5"));
            }
        }
    }
    for &value in &content.references {
        let at = frame.y.unit(value);
        if at.is_finite() && at >= y.0 && at <= y.1 {
            layout = layout.with_reference_line(reference(at, Role::Ink, 1.0, "6 3"));
        }
    }
    layout
}

fn reference(at: f64, role: Role, width: f64, dash: &str) -> ReferenceLine {
    ReferenceLine::horizontal(at)
        .with_color(role.token())
        .with_stroke_width(width)
        .with_dasharray(dash)
}

/// The library's theme, with our roles in place of colours.
fn theme() -> Theme {
    Theme {
        background: "none".to_owned(),
        axis_color: Role::Ink.token(),
        grid_color: Role::Grid.token(),
        tick_color: Role::Ink.token(),
        text_color: Role::Ink.token(),
        ..Theme::light()
    }
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

/// Draws the primitives of `scene`; those between clip marks are clipped to `clip`.
fn replay(canvas: &mut Canvas, scene: &Scene, clip: Rect) {
    for primitive in &scene.elements {
        match primitive {
            Primitive::Line { x1, y1, x2, y2, stroke, stroke_width, stroke_dasharray } => {
                let paint = Paint::line(role(stroke), *stroke_width)
                    .dashed(stroke_dasharray.as_deref().unwrap_or(""));
                canvas.line((*x1, *y1), (*x2, *y2), &paint);
            }
            Primitive::PolyLine { points, stroke, stroke_width, stroke_dasharray } => {
                let paint = Paint::line(role(stroke), *stroke_width)
                    .dashed(stroke_dasharray.as_deref().unwrap_or(""));
                canvas.polyline(points, false, &paint);
            }
            Primitive::Path(path) => replay_path(canvas, path),
            Primitive::ClipStart { .. } => canvas.begin_clip(clip),
            Primitive::ClipEnd => canvas.end(),
            other => replay_shape(canvas, other),
        }
    }
}

/// Draws texts, rectangles and circles.
fn replay_shape(canvas: &mut Canvas, primitive: &Primitive) {
    match primitive {
        Primitive::Text { x, y, content, size, anchor, .. } if !content.is_empty() => {
            let font = Font::new(f64::from(*size), anchor_of(*anchor));
            canvas.text(*x, *y, content, font);
        }
        Primitive::Rect { x, y, width, height, fill, opacity, .. } => {
            let paint = Paint { opacity: *opacity, ..Paint::face(role(fill)) };
            canvas.rect(*x, *y, *width, *height, &paint);
        }
        Primitive::Circle { cx, cy, r, fill, .. } => {
            canvas.circle((*cx, *cy), *r, &Paint::face(role(fill)));
        }
        Primitive::CircleBatch { cx, cy, r, fill, .. } => {
            for centre in cx.iter().copied().zip(cy.iter().copied()) {
                canvas.circle(centre, *r, &Paint::face(role(fill)));
            }
        }
        _ => {}
    }
}

fn replay_path(canvas: &mut Canvas, path: &PathData) {
    let fill = path.fill.as_ref().map_or(Role::None, role);
    canvas.path(&path.d, &Paint::line(role(&path.stroke), path.stroke_width).filled(fill));
}

fn anchor_of(anchor: TextAnchor) -> Anchor {
    match anchor {
        TextAnchor::Start => Anchor::Start,
        TextAnchor::Middle => Anchor::Middle,
        TextAnchor::End => Anchor::End,
    }
}

fn role(color: &Color) -> Role {
    match color {
        Color::Rgb(r, g, b) => Role::Fixed([*r, *g, *b]),
        Color::None => Role::None,
        Color::Css(token) => Role::from_token(token).unwrap_or(Role::Ink),
    }
}
