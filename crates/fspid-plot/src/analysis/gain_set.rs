//! The gains for which a certificate speaks, seen along each of the three axes.

use super::chart::Chart;
use super::clip::Point;
use super::cover;
use super::notes::Notes;
use crate::axis::{Axis, extent};
use crate::page::{self, EDGE, Entry, LABEL_PX, Swatch};
use crate::plot::Frame;
use crate::sign::Sign;
use crate::style::{Role, SeriesStyle};
use crate::svg::{Anchor, Canvas, Font, Paint, Rect, Svg};

/// A set of gain triples (kp, ki, kd) and what is known of it.
#[derive(Debug, Clone, PartialEq)]
pub struct GainSet {
    /// Printed above the figure and read out by screen readers.
    pub title: String,
    /// Names and units of the three gains, in the order of the triples.
    pub labels: [String; 3],
    /// Boxes that together hold every gain that the supervisor can produce.
    pub cells: Vec<GainCell>,
    /// Corners of the polytope for which the proof speaks; their hull is outlined.
    pub hull: Vec<[f64; 3]>,
    /// Gains before any increment.
    pub nominal: Option<[f64; 3]>,
    /// Gains at rest.
    pub equilibrium: Option<[f64; 3]>,
    /// Gains that, frozen, make the loop unstable.
    pub unstable: Vec<[f64; 3]>,
    /// Gains of a flight; empty for none.
    pub flown: Vec<[f64; 3]>,
}

/// A box of gains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GainCell {
    /// Lower end of each gain.
    pub lower: [f64; 3],
    /// Upper end of each gain.
    pub upper: [f64; 3],
    /// What is known of it.
    pub state: CellState,
}

/// What is known of a box of gains.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum CellState {
    /// Stable for arbitrary motion inside.
    Proved,
    /// Neither proved nor refuted.
    Open,
    /// Holds a gain for which the loop is unstable.
    Refuted,
}

const WIDTH: f64 = 720.0;
/// Side of a panel (px).
const SIDE: f64 = 268.0;
/// Most signs of unstable gains and most points of a flight that are drawn.
const MOST: usize = 500;

/// Which gains a panel shows: abscissa and ordinate.
type Pair = (usize, usize);

impl GainSet {
    /// Draws three panels: ki over kp, ki over kd and, below the first, kd over kp.
    #[must_use]
    pub fn render(&self) -> Svg {
        let axes = [0, 1, 2].map(|n| Axis::linear(self.extent(n), 0.06, 5));
        let left = EDGE
            + page::upright_room(1)
            + [1, 2].map(|n| page::tick_room(&axes[n])).into_iter().fold(0.0, f64::max);
        let second = WIDTH - EDGE - SIDE - 4.0;
        let top = page::title_height(&self.title, WIDTH) + 4.0;
        let lower = top + SIDE + 50.0;
        let notes = Notes::set(self.entries(), SIDE);
        let height = (SIDE + 48.0).max(notes.height() + 20.0);
        let mut canvas = Canvas::new(WIDTH, lower + height);
        page::title(&mut canvas, &self.title);
        let panels = [((0, 1), left, top), ((2, 1), second, top), ((0, 2), left, lower)];
        for (pair, x, y) in panels {
            self.panel(&mut canvas, pair, &axes, (x, y));
        }
        notes.draw(&mut canvas, second - 40.0, lower + 6.0);
        canvas.finish(&self.title, &self.describe())
    }

    fn extent(&self, n: usize) -> Option<(f64, f64)> {
        let boxes = self.cells.iter().flat_map(|cell| [cell.lower[n], cell.upper[n]]);
        let points = self.hull.iter().chain(&self.unstable).chain(&self.flown);
        let single = self.nominal.iter().chain(&self.equilibrium);
        extent(boxes.chain(points.chain(single).map(|gains| gains[n])))
    }

    fn panel(&self, canvas: &mut Canvas, (x, y): Pair, axes: &[Axis; 3], corner: Point) {
        let area = Rect { x: corner.0, y: corner.1, width: SIDE, height: SIDE };
        let frame = Frame { area, x: axes[x], y: axes[y], x_labels: true };
        let mut chart = Chart::new(frame);
        chart.axes(canvas, &[]);
        self.cells(canvas, &chart, (x, y));
        let of = |gains: &[f64; 3]| (gains[x], gains[y]);
        let corners = hull(self.hull.iter().map(of).collect());
        chart.line(
            canvas,
            corners.iter().chain(corners.first()).copied(),
            &Paint::line(Role::Ink, 1.6),
        );
        chart.curve(canvas, self.flown.iter().map(of), FLOWN);
        for gains in self.unstable.iter().take(MOST) {
            chart.sign(canvas, of(gains), Sign::Cross, UNSTABLE);
        }
        for (gains, sign) in [(&self.nominal, Sign::Ring), (&self.equilibrium, Sign::Plus)] {
            if let Some(gains) = gains {
                chart.sign(canvas, of(gains), sign, Role::Ink);
            }
        }
        let below = (area.x + SIDE / 2.0, area.y + SIDE + 36.0);
        canvas.text(below.0, below.1, &self.labels[x], Font::new(LABEL_PX, Anchor::Middle));
        chart.name_ordinate(canvas, &self.labels[y], page::tick_room(&axes[y]));
    }

    /// The boxes, those of one state in one path; boxes that differ in the third gain only are one.
    fn cells(&self, canvas: &mut Canvas, chart: &Chart, (x, y): Pair) {
        canvas.begin_clip(chart.frame.area);
        for (state, paint) in looks() {
            let of_state = self.cells.iter().filter(|cell| cell.state == state);
            let place = |ends: [f64; 3]| chart.frame.place(ends[x], ends[y]);
            let boxes = of_state.filter_map(|cell| spanned(place(cell.lower), place(cell.upper)));
            let d = cover::path(&boxes.collect::<Vec<Rect>>(), chart.frame.area);
            if !d.is_empty() {
                canvas.path(&d, &paint);
            }
        }
        canvas.end();
    }

    fn entries(&self) -> Vec<Entry> {
        let count = |state| self.cells.iter().filter(|cell| cell.state == state).count();
        let mut entries = Vec::new();
        let mut add = |shown: bool, name: String, swatch| {
            if shown {
                entries.push(Entry { name, swatch });
            }
        };
        let (proved, open, refuted) =
            (count(CellState::Proved), count(CellState::Open), count(CellState::Refuted));
        add(proved > 0, boxes(proved, "proved"), Swatch::Area(SeriesStyle::Numbered(0)));
        add(open > 0, boxes(open, "open"), Swatch::Band);
        add(
            refuted > 0,
            boxes(refuted, "REFUTED standing still"),
            Swatch::Area(SeriesStyle::Numbered(1)),
        );
        add(self.hull.len() > 1, "hull of what the proof covers".to_owned(), Swatch::Outline);
        let flown = Swatch::Line { style: FLOWN, marked: false };
        add(self.flown.len() > 1, "gains of a flight".to_owned(), flown);
        add(
            self.nominal.is_some(),
            "nominal gains".to_owned(),
            Swatch::Sign(Sign::Ring, Role::Ink),
        );
        let rest = Swatch::Sign(Sign::Plus, Role::Ink);
        add(self.equilibrium.is_some(), "gains at rest".to_owned(), rest);
        let cross = Swatch::Sign(Sign::Cross, UNSTABLE);
        add(!self.unstable.is_empty(), "UNSTABLE when frozen".to_owned(), cross);
        entries
    }

    fn describe(&self) -> String {
        let names: Vec<String> = self.entries().into_iter().map(|entry| entry.name).collect();
        format!("Set of gains {}: {}.", self.labels.join(", "), names.join("; "))
    }
}

const FLOWN: SeriesStyle = SeriesStyle::Numbered(2);
const UNSTABLE: Role = Role::Series(1);

fn boxes(count: usize, state: &str) -> String {
    format!("{count} {} {state}", if count == 1 { "box" } else { "boxes" })
}

/// What boxes look like, the worst drawn last.
fn looks() -> [(CellState, Paint); 3] {
    let look = |role, opacity, width| Paint::line(role, width).filled(role).opacity(opacity);
    [
        (CellState::Proved, look(Role::Series(0), 0.3, 0.8)),
        (CellState::Open, look(Role::Band, 0.4, 0.8)),
        (CellState::Refuted, look(Role::Series(1), 0.5, 1.2)),
    ]
}

/// The box between two corners.
fn spanned(a: Point, b: Point) -> Option<Rect> {
    let finite = [a.0, a.1, b.0, b.1].iter().all(|edge| edge.is_finite());
    let (x, y) = (a.0.min(b.0), a.1.min(b.1));
    finite.then(|| Rect { x, y, width: (b.0 - a.0).abs(), height: (b.1 - a.1).abs() })
}

/// The convex hull of points in the plane, counterclockwise.
///
/// # Source
/// Andrew, Another efficient algorithm for convex hulls in two dimensions, IPL 9(5), 1979.
fn hull(mut points: Vec<Point>) -> Vec<Point> {
    points.retain(|(x, y)| x.is_finite() && y.is_finite());
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let half = |points: &mut dyn Iterator<Item = Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for point in points {
            while let [.., a, b] = chain.as_slice() {
                let turn = (b.0 - a.0) * (point.1 - a.1) - (b.1 - a.1) * (point.0 - a.0);
                if turn > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut lower = half(&mut points.iter().copied());
    lower.extend(half(&mut points.iter().rev().copied()));
    lower
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_has_the_corners_and_not_what_is_inside() {
        let square = vec![(0.0, 0.0), (1.0, 1.0), (0.5, 0.5), (1.0, 0.0), (0.0, 1.0), (0.5, 0.0)];
        assert_eq!(hull(square), [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        assert_eq!(hull(vec![(1.0, 2.0), (1.0, 2.0)]), [(1.0, 2.0)]);
        assert!(hull(vec![(f64::NAN, 0.0)]).is_empty());
    }
}
