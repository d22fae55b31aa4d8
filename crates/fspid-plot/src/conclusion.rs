//! What rules concluded about one variable: the aggregated set, with each rule's part of it, and the
//! number that was read off.

use super::axis::{Axis, extent, short_number};
use super::page::{self, EDGE, Entry, LABEL_PX, Legend, Swatch};
use super::plot::{self, Content, Curve, Frame};
use super::style::{Role, SeriesStyle};
use super::svg::{Anchor, Canvas, Font, Paint, Rect, Svg, polyline_data};

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 220.0;

/// The conclusions about one variable.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ConclusionFigure {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Name of the variable.
    pub x_label: String,
    /// Where the variable lives; `None` takes the range of what is drawn.
    pub range: Option<(f64, f64)>,
    /// The sets before anything was concluded: name, and points (value, grade).
    pub sets: Vec<(String, Vec<(f64, f64)>)>,
    /// What belongs to each rule.
    pub parts: Vec<Part>,
    /// The answer.
    pub answer: Option<f64>,
}

/// What belongs to one rule.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Part {
    /// Name in the legend.
    pub name: String,
    /// Straight pieces of the outline: both places, and the grade at each.
    pub pieces: Vec<([f64; 2], [f64; 2])>,
    /// Single numbers with their weights.
    pub stems: Vec<(f64, f64)>,
}

impl ConclusionFigure {
    /// Draws the figure.
    #[must_use]
    pub fn render(&self) -> Svg {
        let legend = Legend::set(self.entries(), WIDTH - 2.0 * EDGE - 30.0);
        let top = page::title_height(&self.title, WIDTH) + legend.height() + 16.0;
        let frame = self.frame(top);
        let area = frame.area;
        let mut canvas = Canvas::new(WIDTH, top + HEIGHT + 48.0);
        page::title(&mut canvas, &self.title);
        legend.draw(&mut canvas, area.x, top - legend.height() - 16.0);
        canvas.begin_clip(area);
        for (n, part) in self.parts.iter().enumerate() {
            draw(&mut canvas, &frame, part, Role::Series(n));
        }
        canvas.end();
        plot::draw(&mut canvas, &frame, &self.content());
        for (n, part) in self.parts.iter().enumerate() {
            stems(&mut canvas, &frame, part, Role::Series(n));
        }
        self.names(&mut canvas, &frame);
        self.answer(&mut canvas, &frame);
        let right = EDGE + page::upright_room(1) - 3.0;
        let is_weighted = self.parts.iter().any(|part| !part.stems.is_empty());
        let label = if is_weighted { "weight" } else { "grade" };
        page::upright_label(&mut canvas, right, area.y + HEIGHT / 2.0, &[label.to_owned()]);
        let below = (area.x + area.width / 2.0, area.y + HEIGHT + 36.0);
        page::level_label(&mut canvas, below.0, below.1, &self.x_label);
        canvas.finish(&self.title, &self.describe())
    }

    fn entries(&self) -> Vec<Entry> {
        let entry = |(n, part): (usize, &Part)| Entry {
            name: part.name.clone(),
            swatch: Swatch::Area(SeriesStyle::Numbered(n)),
        };
        self.parts.iter().enumerate().map(entry).collect()
    }

    fn frame(&self, top: f64) -> Frame {
        let of_sets = self.sets.iter().flat_map(|set| set.1.iter().map(|point| point.0));
        let stems = self.parts.iter().flat_map(|part| part.stems.iter().map(|stem| stem.0));
        let seen = extent(of_sets.chain(stems).chain(self.answer));
        // A set without width, such as one number alone, gets room at its sides.
        let margin = if self.range.is_none() { 0.06 } else { 0.0 };
        let x = Axis::linear(self.range.or(seen), margin, 9);
        let y = Axis::fixed(Some((0.0, 1.05)), 4).unwrap_or_else(|| Axis::linear(None, 0.0, 4));
        let left = EDGE + page::upright_room(1) + page::tick_room(&y);
        let area = Rect { x: left, y: top, width: WIDTH - left - EDGE - 12.0, height: HEIGHT };
        Frame { area, x, y, x_labels: true }
    }

    fn content(&self) -> Content {
        let curve = |(name, points): &(String, Vec<(f64, f64)>)| Curve {
            name: name.clone(),
            style: SeriesStyle::SetpointDashed,
            points: points.clone(),
            stairs: false,
            marked: false,
        };
        Content { curves: self.sets.iter().map(curve).collect(), ..Content::default() }
    }

    /// The name of each set above its peak.
    fn names(&self, canvas: &mut Canvas, frame: &Frame) {
        for (name, points) in &self.sets {
            let inside = points.iter().filter(|p| (0.0..=1.0).contains(&frame.x.fraction(p.0)));
            let top = inside.clone().map(|point| point.1).fold(0.0, f64::max);
            let peak = extent(inside.filter(|p| p.1 >= top - 1e-9).map(|point| point.0));
            let Some((from, to)) = peak else { continue };
            let x = frame.place((from + to) / 2.0, 0.0).0;
            let font = Font::new(LABEL_PX, Anchor::Middle).role(Role::Muted);
            canvas.text(x, frame.area.y - 5.0, name, font);
        }
    }

    fn answer(&self, canvas: &mut Canvas, frame: &Frame) {
        let Some(answer) = self.answer else { return };
        let (x, bottom) = frame.place(answer, 0.0);
        canvas.line((x, frame.area.y), (x, bottom), &Paint::line(Role::Ink, 1.6));
        let near_right = x > frame.area.x + frame.area.width - 60.0;
        let (anchor, gap) = if near_right { (Anchor::End, -5.0) } else { (Anchor::Start, 5.0) };
        let font = Font::new(LABEL_PX, anchor).bold();
        canvas.text(x + gap, frame.area.y + LABEL_PX + 2.0, &short_number(answer), font);
    }

    fn describe(&self) -> String {
        let parts: Vec<&str> = self.parts.iter().map(|part| part.name.as_str()).collect();
        let answer = self.answer.map_or("none".to_owned(), short_number);
        format!("Joined conclusions about {}: {}; answer {answer}.", self.x_label, parts.join("; "))
    }
}

fn draw(canvas: &mut Canvas, frame: &Frame, part: &Part, role: Role) {
    let mut faces = String::new();
    let mut tops = String::new();
    for ([x0, x1], [y0, y1]) in &part.pieces {
        let top = [frame.place(*x0, *y0), frame.place(*x1, *y1)];
        let face = [top[0], top[1], frame.place(*x1, 0.0), frame.place(*x0, 0.0)];
        faces.push_str(&polyline_data(&face, true));
        tops.push_str(&polyline_data(&top, false));
    }
    if !faces.is_empty() {
        canvas.path(&faces, &Paint::face(role).opacity(0.35));
        canvas.path(&tops, &Paint::line(role, 2.0));
    }
}

/// Numbers stand on the axis, as high as their weights.
fn stems(canvas: &mut Canvas, frame: &Frame, part: &Part, role: Role) {
    for &(x, weight) in &part.stems {
        let (top, foot) = (frame.place(x, weight), frame.place(x, 0.0));
        canvas.line(foot, top, &Paint::line(role, 4.0));
        canvas.circle(top, 4.5, &Paint::face(role));
    }
}
