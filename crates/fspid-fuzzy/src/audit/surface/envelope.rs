//! The upper envelope of all clipped or scaled output sets at given levels, and bounds of its centroid.

use alloc::vec::Vec;

use super::layers::{Layers, Slice};
use fspid_numeric::scalar::Interval;

/// Steps towards a bound; they double its digits.
const STEPS: usize = 30;

/// A straight piece of the edge.
#[derive(Clone, Copy, Debug)]
struct Piece {
    left: f64,
    right: f64,
    /// Grade at either end.
    grades: [f64; 2],
    /// Area and moment of all pieces before.
    before: [f64; 2],
}

impl Piece {
    /// Area and moment of the piece from its left end to `x`.
    fn up_to(&self, x: f64) -> [f64; 2] {
        let [start, end] = self.grades;
        let width = x - self.left;
        let grade = start + (end - start) * (width / (self.right - self.left));
        let area = 0.5 * width * (start + grade);
        // From the left end, then moved: $\int t \mu = w^2 (\mu_0 + 2 \mu_1) / 6$.
        let own = width * width * (start + 2.0 * grade) / 6.0;
        [area, own + self.left * area]
    }
}

/// The upper edge of all layers, from left to right.
#[derive(Clone, Debug, Default)]
pub(super) struct Envelope {
    pieces: Vec<Piece>,
    /// Area and moment.
    total: [f64; 2],
    places: Vec<f64>,
    /// The straight functions of a slice: value at its left end, and slope.
    straight: Vec<[f64; 2]>,
}

impl Envelope {
    /// The edge at these levels, one for each layer.
    pub(super) fn trace(&mut self, layers: &Layers, levels: &[f64]) {
        self.pieces.clear();
        self.total = [0.0; 2];
        for slice in &layers.slices {
            self.trace_slice(layers, slice, levels);
        }
    }

    /// Area under the edge.
    pub(super) fn area(&self) -> f64 {
        self.total[0]
    }

    fn trace_slice(&mut self, layers: &Layers, slice: &Slice, levels: &[f64]) {
        self.find_places(layers, slice, levels);
        let mut start = None;
        for &place in &self.places {
            let grade = edge(layers, slice, levels, place);
            if let Some((left, grade_left)) = start.filter(|&(left, _)| left < place) {
                let piece =
                    Piece { left, right: place, grades: [grade_left, grade], before: self.total };
                let [area, moment] = piece.up_to(place);
                self.total = [self.total[0] + area, self.total[1] + moment];
                self.pieces.push(piece);
            }
            start = Some((place, grade));
        }
    }

    /// The ends of the slice and all places where two straight functions meet.
    fn find_places(&mut self, layers: &Layers, slice: &Slice, levels: &[f64]) {
        self.straight.clear();
        for line in &slice.lines {
            let level = levels.get(line.layer).copied().unwrap_or(0.0);
            if layers.layers.get(line.layer).is_some_and(|layer| layer.scaled) {
                self.straight.push([level * line.start, level * line.slope]);
            } else {
                self.straight.extend([[level, 0.0], [line.start, line.slope]]);
            }
        }
        self.places.clear();
        self.places.extend([slice.left, slice.right]);
        for (index, &one) in self.straight.iter().enumerate() {
            let others = self.straight.get(..index).unwrap_or_default();
            let met = others.iter().filter_map(|&other| meeting(slice, one, other));
            self.places.extend(met);
        }
        self.places.sort_unstable_by(f64::total_cmp);
    }

    /// Area and moment left of `x`.
    fn left_of(&self, x: f64) -> [f64; 2] {
        let index = self.pieces.partition_point(|piece| piece.left < x);
        let Some(piece) = index.checked_sub(1).and_then(|index| self.pieces.get(index)) else {
            return [0.0; 2];
        };
        if x >= piece.right && index == self.pieces.len() {
            return self.total;
        }
        let [area, moment] = piece.up_to(x.min(piece.right));
        [piece.before[0] + area, piece.before[1] + moment]
    }
}

/// Where two straight functions of a slice meet inside it.
#[inline]
pub(super) fn meeting(slice: &Slice, one: [f64; 2], other: [f64; 2]) -> Option<f64> {
    let (height, closing) = (other[0] - one[0], one[1] - other[1]);
    // Most do not meet inside; that is told without the division.
    let width = slice.right - slice.left;
    let meets = height * closing > 0.0 && height.abs() <= 1.5 * width * closing.abs();
    let place = if meets { slice.left + height / closing } else { slice.left };
    (place > slice.left && place < slice.right).then_some(place)
}

/// Height of the edge.
fn edge(layers: &Layers, slice: &Slice, levels: &[f64], x: f64) -> f64 {
    let mut height = 0.0_f64;
    for line in &slice.lines {
        let level = levels.get(line.layer).copied().unwrap_or(0.0);
        let grade = slice.grade(line, x);
        let scaled = layers.layers.get(line.layer).is_some_and(|layer| layer.scaled);
        height = height.max(if scaled { level * grade } else { level.min(grade) });
    }
    height
}

/// Bounds of the centre of gravity of every set between two edges, and of its area.
///
/// With $\underline\mu \le \mu \le \overline\mu$ and any $c$
///
/// $$ \int (x - c) \mu \ dx \ge G(c) =
///    \int_{x < c} (x - c) \overline\mu \ dx + \int_{x > c} (x - c) \underline\mu \ dx $$
///
/// so that $c$ is a lower bound where $G(c) \ge 0$. $G$ falls at least as fast as the area under
/// the lower edge, $G(c - \delta) \ge G(c) + \delta \underline A$; this makes a bound of any guess
/// of $c$, however it was rounded. The guess is improved as Karnik and Mendel do for type reduction.
///
/// # Source
/// Karnik and Mendel, *Centroid of a type-2 fuzzy set*, Information Sciences 132 (2001) 195–220.
pub(super) struct Bounds {
    /// Of the centre of gravity, from the middle of the universe.
    pub(super) centre: Interval,
    /// Of the area; its lower bound may be zero.
    pub(super) area: Interval,
}

impl Bounds {
    pub(super) fn between(layers: &Layers, low: &Envelope, high: &Envelope) -> Self {
        let error = rounding(layers, low.pieces.len() + high.pieces.len());
        let least_area = (low.area() - error).max(0.0);
        let area = Interval::between(least_area, high.area() + error);
        let ends = layers.ends();
        if least_area <= 0.0 {
            return Self { centre: ends, area };
        }
        let error = error * layers.span;
        let guess = low.total[1] / low.area();
        let (lower, rest) = settle(high, low, guess);
        let shift = ((rest - error).min(0.0) / least_area).next_down();
        let (upper, more) = settle(low, high, guess);
        let growth = ((more + error).max(0.0) / least_area).next_up();
        let centre = Interval::new((lower + shift).next_down(), (upper + growth).next_up());
        Self { centre: centre.and_then(|c| c.intersection(ends)).unwrap_or(ends), area }
    }
}

/// The place about which the moment of one edge on its left and another on its right vanishes, and
/// the moment that is left there.
fn settle(left: &Envelope, right: &Envelope, guess: f64) -> (f64, f64) {
    let mut place = guess;
    for _ in 0..STEPS {
        let [area, moment] = mixed(left, right, place);
        let next = moment / area;
        let near = (next - place).abs() <= 1e-15 * next.abs();
        if near || !next.is_finite() {
            break;
        }
        place = next;
    }
    let [area, moment] = mixed(left, right, place);
    (place, moment - place * area)
}

fn mixed(left: &Envelope, right: &Envelope, place: f64) -> [f64; 2] {
    let (one, other) = (left.left_of(place), right.left_of(place));
    [0, 1].map(|i: usize| match (one.get(i), right.total.get(i), other.get(i)) {
        (Some(one), Some(total), Some(other)) => one + (total - other),
        _ => f64::NAN,
    })
}

/// How far an area computed of so many pieces may be off; a moment, by this times the span.
///
/// Grades are at most 1, so that no area is larger than the span; each piece suffers some ten
/// roundings, and sums of $n$ terms $n$ more.
fn rounding(layers: &Layers, pieces: usize) -> f64 {
    let roundings = (64.0 + 8.0 * pieces as f64) * f64::EPSILON;
    (roundings + 4.0 * layers.slack) * layers.span
}
