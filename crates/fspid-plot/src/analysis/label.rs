//! Where labels stand: inside the plot area, off each other and, where there is room, off the lines.

use super::clip::Point;
use crate::plot::TICK_PX;
use crate::style::Role;
use crate::svg::{Anchor, Canvas, Font, Paint, Rect};
use crate::text::{num, text_width};

/// What labels of one plot area must keep clear of.
#[derive(Debug, Clone)]
pub(super) struct Labels {
    area: Rect,
    taken: Vec<Rect>,
    lines: Vec<[Point; 2]>,
}

/// Directions in which a label may stand from its point, the better ones first.
const DIRECTIONS: [Point; 12] = [
    (1.0, 0.0),
    (-1.0, 0.0),
    (0.8, -0.8),
    (0.8, 0.8),
    (-0.8, -0.8),
    (-0.8, 0.8),
    (0.0, -1.0),
    (0.0, 1.0),
    (1.0, -0.4),
    (1.0, 0.4),
    (-1.0, -0.4),
    (-1.0, 0.4),
];
/// Gaps between a point and its label (px).
const GAPS: [f64; 6] = [7.0, 13.0, 21.0, 32.0, 46.0, 64.0];
/// From here on a thin line leads from the point to its label (px).
const LEADER_PX: f64 = 18.0;
/// What a crossed line costs, in px of distance.
const CROSSED: f64 = 14.0;
/// Most lines of a plot area that labels avoid; beyond, a picture is full anyway.
const MOST_LINES: usize = 6_000;

impl Labels {
    /// No labels yet.
    pub(super) const fn new(area: Rect) -> Self {
        Self { area, taken: Vec::new(), lines: Vec::new() }
    }

    /// Keeps labels off a line.
    pub(super) fn avoid_line(&mut self, line: &[Point]) {
        let room = MOST_LINES.saturating_sub(self.lines.len());
        self.lines.extend(
            line.windows(2).filter_map(|pair| <[Point; 2]>::try_from(pair).ok()).take(room),
        );
    }

    /// Keeps labels off a sign at `at`.
    pub(super) fn avoid_sign(&mut self, (x, y): Point) {
        self.taken.push(Rect { x: x - 5.0, y: y - 5.0, width: 10.0, height: 10.0 });
    }

    /// Writes `text` near `at`; false where there is no room left.
    ///
    /// Words are in ink, as the colours of lines are too light for small letters; the role of a line
    /// becomes a bar of its colour beside them.
    pub(super) fn put(&mut self, canvas: &mut Canvas, at: Point, text: &str, role: Role) -> bool {
        self.put_along(canvas, &[at], text, role)
    }

    /// The same near any of several points, the first ones preferred.
    pub(super) fn put_along(
        &mut self,
        canvas: &mut Canvas,
        along: &[Point],
        text: &str,
        role: Role,
    ) -> bool {
        let size = (text_width(text, TICK_PX) + bar_room(role), TICK_PX * 1.15);
        let ways = || GAPS.iter().flat_map(|gap| DIRECTIONS.iter().map(move |way| (*gap, *way)));
        let tried = along.iter().flat_map(|at| ways().map(move |(gap, way)| (*at, gap, way)));
        let places = tried.enumerate().filter_map(|(order, (at, gap, way))| {
            let place = placed(at, size, gap, way);
            self.is_free(place).then(|| {
                let crossed = self.crossed(place).min(6) as f64;
                (gap + CROSSED * crossed + 0.01 * order as f64, (at, gap), place)
            })
        });
        let Some((_, (at, gap), place)) = places.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            return false;
        };
        let [x, y] = [at.0, at.1].map(num);
        // A script that enlarges the figure keeps the words this near to their point.
        begin(canvas, role, &format!(" data-anchor=\"{x} {y}\""));
        if gap > LEADER_PX {
            canvas.line(at, nearest(place, at), &Paint::line(Role::Muted, 0.7));
        }
        self.write(canvas, place, text, role);
        true
    }

    /// Writes `text` centred at `at` if there is room exactly there.
    pub(super) fn put_here(
        &mut self,
        canvas: &mut Canvas,
        (x, y): Point,
        text: &str,
        role: Role,
    ) -> bool {
        let (width, height) = (text_width(text, TICK_PX) + bar_room(role), TICK_PX * 1.15);
        let place = Rect { x: x - width / 2.0, y: y - height / 2.0, width, height };
        let free = self.is_free(place) && self.crossed(place) == 0;
        if free {
            begin(canvas, role, "");
            self.write(canvas, place, text, role);
        }
        free
    }

    /// Writes a secondary label centred at the first of these places that is free.
    pub(super) fn put_first(&mut self, canvas: &mut Canvas, places: &[Point], text: &str) {
        let _ = places.iter().any(|at| self.put_here(canvas, *at, text, Role::Muted));
    }

    /// Writes into the group that was begun, and ends it.
    fn write(&mut self, canvas: &mut Canvas, place: Rect, text: &str, role: Role) {
        // Grid lines behind the words would make them hard to read.
        let ground = Rect { x: place.x - 1.5, width: place.width + 3.0, ..place };
        canvas.rounded(ground, 2.0, &Paint::face(Role::Face).opacity(0.8));
        let (ink, bar) = (if role == Role::Muted { role } else { Role::Ink }, bar_room(role));
        if bar > 0.0 {
            canvas.rect(place.x, place.y, 3.0, place.height, &Paint::face(role));
        }
        let font = Font::new(TICK_PX, Anchor::Middle).role(ink);
        let middle = (place.x + (place.width + bar) / 2.0, place.y + place.height / 2.0);
        canvas.text(middle.0, middle.1 + TICK_PX * 0.36, text, font);
        canvas.end();
        self.taken.push(place);
    }

    fn is_free(&self, place: Rect) -> bool {
        let a = self.area;
        let inside = place.x >= a.x + 2.0
            && place.y >= a.y + 2.0
            && place.x + place.width <= a.x + a.width - 2.0
            && place.y + place.height <= a.y + a.height - 2.0;
        inside && !self.taken.iter().any(|taken| overlap(*taken, place))
    }

    fn crossed(&self, place: Rect) -> usize {
        self.lines.iter().filter(|line| crosses(line, place)).count()
    }
}

/// Opens the group of a label: whose it is, and what else a script has to know.
fn begin(canvas: &mut Canvas, role: Role, more: &str) {
    let of = role.variable().unwrap_or_default();
    canvas.begin_marked(&format!("data-of=\"{of}\"{more}"));
}

/// Room for the bar in the colour of a line (px).
fn bar_room(role: Role) -> f64 {
    if matches!(role, Role::Ink | Role::Muted) { 0.0 } else { 5.0 }
}

/// The box of a text of that size, `gap` px from `at`.
fn placed(at: Point, (width, height): Point, gap: f64, way: Point) -> Rect {
    // Aside means wholly aside: with its corner, not its middle, in that direction.
    let aside = |way: f64| if way.abs() < 0.8 { way } else { way.signum() };
    let x = at.0 + way.0 * gap + aside(way.0) * width / 2.0;
    let y = at.1 + way.1 * gap + aside(way.1) * height / 2.0;
    Rect { x: x - width / 2.0, y: y - height / 2.0, width, height }
}

fn nearest(place: Rect, (x, y): Point) -> Point {
    (x.clamp(place.x, place.x + place.width), y.clamp(place.y, place.y + place.height))
}

fn overlap(a: Rect, b: Rect) -> bool {
    let apart = 3.0;
    a.x < b.x + b.width + apart
        && b.x < a.x + a.width + apart
        && a.y < b.y + b.height + 1.0
        && b.y < a.y + a.height + 1.0
}

/// True where the straight line between two points passes through the box.
fn crosses(line: &[Point; 2], place: Rect) -> bool {
    super::clip::part_inside(line[0], line[1], place).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Rect = Rect { x: 0.0, y: 0.0, width: 300.0, height: 200.0 };

    #[test]
    fn labels_at_one_point_do_not_cover_one_another() {
        let mut labels = Labels::new(AREA);
        let mut canvas = Canvas::new(300.0, 200.0);
        for n in 0..12 {
            labels.put(&mut canvas, (150.0, 100.0), &format!("label number {n}"), Role::Ink);
        }
        assert!(labels.taken.len() >= 6, "{}", labels.taken.len());
        for (n, a) in labels.taken.iter().enumerate() {
            assert!(labels.taken.iter().take(n).all(|b| !overlap(*a, *b)));
        }
    }

    #[test]
    fn labels_stay_inside_and_too_long_ones_are_left_out() {
        let mut labels = Labels::new(AREA);
        let mut canvas = Canvas::new(300.0, 200.0);
        assert!(labels.put(&mut canvas, (299.0, 1.0), "in the corner", Role::Ink));
        let place = labels.taken[0];
        assert!(place.x + place.width <= 300.0 && place.y >= 0.0);
        assert!(!labels.put(&mut canvas, (10.0, 100.0), &"long ".repeat(40), Role::Ink));
        assert!(!labels.put(&mut canvas, (f64::NAN, 1.0), "nowhere", Role::Ink));
    }

    #[test]
    fn a_label_prefers_the_side_without_a_line() {
        let mut labels = Labels::new(AREA);
        let mut canvas = Canvas::new(300.0, 200.0);
        labels.avoid_line(&[(165.0, 0.0), (165.0, 200.0)]);
        assert!(labels.put(&mut canvas, (150.0, 100.0), "beside the line", Role::Ink));
        assert!(labels.taken[0].x + labels.taken[0].width < 150.0);
    }
}
