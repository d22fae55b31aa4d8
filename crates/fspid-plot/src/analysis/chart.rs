//! A plot area of an analysis: axes, curves that are cut to it, arrows and labels.

use super::clip;
use super::clip::Point;
use super::label::Labels;
use crate::axis::Axis;
use crate::page::{self, LABEL_PX};
use crate::plot::{self, Content, Frame};
use crate::sign::Sign;
use crate::style::{Role, SeriesStyle};
use crate::surface::map_axes;
use crate::svg::{Canvas, Paint, Rect};

/// A plot area with what has been drawn in it so far.
#[derive(Debug, Clone)]
pub(super) struct Chart {
    pub(super) frame: Frame,
    pub(super) labels: Labels,
}

/// Visible runs of one curve, in px.
pub(super) type Runs = Vec<Vec<Point>>;

impl Chart {
    pub(super) const fn new(frame: Frame) -> Self {
        let labels = Labels::new(frame.area);
        Self { frame, labels }
    }

    /// Draws grid, axes and dashed horizontal lines of reference.
    pub(super) fn axes(&mut self, canvas: &mut Canvas, references: &[f64]) {
        let content = Content { references: references.to_vec(), ..Content::default() };
        plot::draw(canvas, &self.frame, &content);
        let a = self.frame.area;
        for value in references {
            let y = self.frame.place(0.0, *value).1;
            if y.is_finite() {
                self.labels.avoid_line(&[(a.x, y), (a.x + a.width, y)]);
            }
        }
    }

    /// Draws a frame with ticks, without a grid.
    pub(super) fn bare_axes(&self, canvas: &mut Canvas) {
        map_axes(canvas, self.frame.area, &self.frame.x, &self.frame.y);
    }

    /// Writes the names of both axes below and left of the area.
    pub(super) fn name_axes(&self, canvas: &mut Canvas, x_label: &str, y_label: &str) {
        let a = self.frame.area;
        let below = (a.x + a.width / 2.0, a.y + a.height + 36.0);
        page::level_label(canvas, below.0, below.1, x_label);
        self.name_ordinate(canvas, y_label, page::tick_room(&self.frame.y));
    }

    /// Writes the name of the ordinate left of the `room` for its numbers.
    pub(super) fn name_ordinate(&self, canvas: &mut Canvas, y_label: &str, room: f64) {
        let a = self.frame.area;
        let lines = page::wrap(y_label, LABEL_PX, a.height + 8.0);
        let right = a.x - room - 1.0;
        page::upright_label(canvas, right, a.y + a.height / 2.0, &lines);
    }

    /// Place of a point of display units on the canvas; `None` where it cannot be seen.
    pub(super) fn visible(&self, x: f64, y: f64) -> Option<Point> {
        let (x, y) = self.frame.place(x, y);
        let (a, slack) = (self.frame.area, 0.5);
        let inside = x >= a.x - slack
            && x <= a.x + a.width + slack
            && y >= a.y - slack
            && y <= a.y + a.height + slack;
        inside.then_some((x, y))
    }

    /// Draws a curve through points of display units; labels will keep off it.
    pub(super) fn curve(
        &mut self,
        canvas: &mut Canvas,
        points: impl Iterator<Item = Point> + Clone,
        style: SeriesStyle,
    ) -> Runs {
        let paint = Paint::line(style.role(), style.width()).dashed(style.dash());
        canvas.begin_curve(&style.key(), "");
        let runs = self.line(canvas, points.clone(), &paint);
        canvas.end();
        if runs.is_empty() {
            // A single point makes no line, but it shall be seen.
            for at in points.filter_map(|(x, y)| self.visible(x, y)).take(1) {
                Sign::Dot.draw(canvas, at, style.role());
            }
        }
        runs
    }

    /// Draws a line through points of display units in `paint`.
    pub(super) fn line(
        &mut self,
        canvas: &mut Canvas,
        points: impl Iterator<Item = Point>,
        paint: &Paint,
    ) -> Runs {
        let runs = self.quiet_line(canvas, points, paint);
        for run in &runs {
            self.labels.avoid_line(run);
        }
        runs
    }

    /// The same for a line of a background grid, which labels may cross.
    pub(super) fn quiet_line(
        &self,
        canvas: &mut Canvas,
        points: impl Iterator<Item = Point>,
        paint: &Paint,
    ) -> Runs {
        let runs = clip::runs(points.map(|(x, y)| self.frame.place(x, y)), self.frame.area);
        if !runs.is_empty() {
            canvas.begin_clip(self.frame.area);
            for run in &runs {
                canvas.polyline(run, false, paint);
            }
            canvas.end();
        }
        runs
    }

    /// Draws a sign and keeps labels off it; false where it cannot be seen.
    pub(super) fn sign(&mut self, canvas: &mut Canvas, at: Point, sign: Sign, role: Role) -> bool {
        let Some(place) = self.visible(at.0, at.1) else {
            return false;
        };
        sign.draw(canvas, place, role);
        self.labels.avoid_sign(place);
        true
    }

    /// Writes a label near a point of display units, if that can be seen.
    pub(super) fn label(&mut self, canvas: &mut Canvas, at: Point, text: &str, role: Role) -> bool {
        let place = self.visible(at.0, at.1);
        place.is_some_and(|place| self.labels.put(canvas, place, text, role))
    }

    /// A dotted upright line across the area.
    pub(super) fn upright(&mut self, canvas: &mut Canvas, x: f64, paint: &Paint) {
        let a = self.frame.area;
        let at = self.frame.place(x, 0.0).0;
        if at >= a.x && at <= a.x + a.width {
            let ends = [(at, a.y), (at, a.y + a.height)];
            canvas.line(ends[0], ends[1], paint);
            self.labels.avoid_line(&ends);
        }
    }
}

/// A plot area of `size` px a side around the middle of which both axes reach `reach` units.
pub(super) fn square(corner: Point, size: f64, centre: Point, reach: f64) -> Frame {
    let ticks = (size / 62.0) as usize;
    let axis = |middle: f64| {
        Axis::fixed(Some((middle - reach, middle + reach)), ticks)
            .unwrap_or_else(|| Axis::linear(None, 0.0, ticks))
    };
    let area = Rect { x: corner.0, y: corner.1, width: size, height: size };
    Frame { area, x: axis(centre.0), y: axis(centre.1), x_labels: true }
}

/// Arrow heads along a curve that show which way it runs.
pub(super) fn arrows(canvas: &mut Canvas, runs: &Runs, role: Role) {
    for run in runs {
        let length: f64 = run.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
        let count = ((length / 170.0).round() as usize).clamp(usize::from(length > 50.0), 4);
        for n in 0..count {
            let along = length * (n as f64 + 0.5) / count as f64;
            if let Some((tip, way)) = walk(run, along) {
                head(canvas, tip, way, role);
            }
        }
    }
}

/// The point at that length along a line, and the direction there.
fn walk(run: &[Point], along: f64) -> Option<(Point, Point)> {
    let mut left = along;
    for pair in run.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let length = distance(a, b);
        if length >= left && length > 0.0 {
            let way = ((b.0 - a.0) / length, (b.1 - a.1) / length);
            return Some(((a.0 + way.0 * left, a.1 + way.1 * left), way));
        }
        left -= length;
    }
    None
}

/// A head of an arrow: where its tip is and where it points, as a unit vector.
pub(super) fn head(canvas: &mut Canvas, (x, y): Point, (dx, dy): Point, role: Role) {
    let (long, wide) = (8.0, 3.6);
    let (bx, by) = (x - dx * long, y - dy * long);
    let corners = [(x, y), (bx - dy * wide, by + dx * wide), (bx + dy * wide, by - dx * wide)];
    canvas.polyline(&corners, true, &Paint::face(role));
}

pub(super) fn distance(a: Point, b: Point) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    (dx * dx + dy * dy).sqrt()
}
