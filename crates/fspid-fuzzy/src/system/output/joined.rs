//! The aggregated output set as a polygon, and the defuzzified values computed from it.

use alloc::vec::Vec;

use super::roomy_clone;

/// Areas that differ by this fraction count as halves of the same size, and grades that differ by
/// it as equally high: a few roundings.
const SLACK: f64 = 16.0 * f64::EPSILON;

/// A straight piece of the outline of a joined set, with what it belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Piece {
    /// Where it begins and ends, in the unit of the variable.
    pub x: [f64; 2],
    /// Grade at either end.
    pub grade: [f64; 2],
    /// The conclusion that the piece belongs to, as [`System::origin`](super::super::System::origin)
    /// understands it; `None` where several are added up.
    pub conclusion: Option<usize>,
    /// True where the set is cut off and the grade is the strength of the conclusion itself; false
    /// where the outline follows the set.
    pub cut: bool,
}

impl Piece {
    /// A piece of nobody's.
    pub(super) fn plain(x: [f64; 2], grade: [f64; 2]) -> Self {
        Self { x, grade, ..Self::default() }
    }

    /// Length along the universe.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.x[1] - self.x[0]
    }

    /// Area between the piece and the universe.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.width() * (0.5 * self.grade[0] + 0.5 * self.grade[1])
    }

    /// First moment of that area about `reference`: with $\xi$ the middle of the piece,
    ///
    /// $$ M = w \left( \tfrac12 (y_0 + y_1)(\xi - r) + \tfrac1{12} w (y_1 - y_0) \right) $$
    #[must_use]
    pub fn moment(&self, reference: f64) -> f64 {
        let middle = 0.5 * (self.x[0] - reference) + 0.5 * (self.x[1] - reference);
        let tilt = self.width() * (self.grade[1] - self.grade[0]) / 12.0;
        self.width() * (middle * (0.5 * self.grade[0] + 0.5 * self.grade[1]) + tilt)
    }

    fn scaled(&self, scale: f64) -> Self {
        Self { grade: self.grade.map(|grade| grade * scale), ..*self }
    }

    fn highest(&self) -> f64 {
        self.grade[0].max(self.grade[1])
    }
}

/// The joined set of an output over its universe: straight pieces from left to right. Where there
/// is no piece the grade is 0; where a set jumps two pieces meet at different heights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AggregatedSet {
    pieces: Vec<Piece>,
    /// The highest grade.
    top: f64,
    /// Moments are taken about the middle of the universe, which keeps their digits.
    reference: f64,
}

impl AggregatedSet {
    /// Makes room for so many pieces.
    pub(super) fn reserve(&mut self, pieces: usize) {
        self.pieces.reserve(pieces);
    }

    pub(super) fn roomy_clone(&self) -> Self {
        Self { pieces: roomy_clone(&self.pieces), ..*self }
    }

    pub(crate) fn capacity(&self) -> usize {
        self.pieces.capacity()
    }

    pub(super) fn restart(&mut self, reference: f64) {
        self.pieces.clear();
        (self.top, self.reference) = (0.0, reference);
    }

    pub(super) fn len(&self) -> usize {
        self.pieces.len()
    }

    /// Appends a piece. Pieces from `cell` on lie in one cell of the sets' corners: there the
    /// outline stays on one line as long as it belongs to one set.
    pub(super) fn push(&mut self, piece: Piece, cell: usize) {
        if piece.x[0] >= piece.x[1] || piece.highest() <= 0.0 {
            return;
        }
        self.top = self.top.max(piece.highest());
        let count = self.pieces.len();
        match self.pieces.last_mut() {
            Some(last) if continues(last, &piece, count > cell) => {
                (last.x[1], last.grade[1]) = (piece.x[1], piece.grade[1]);
            }
            _ => self.pieces.push(piece),
        }
    }

    /// The outline from left to right.
    #[must_use]
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// The highest grade.
    #[must_use]
    pub fn top(&self) -> f64 {
        self.top
    }

    /// Area of the set.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.pieces.iter().map(Piece::area).sum()
    }

    /// The pieces, scaled so that strengths of any size keep their digits.
    fn scaled(&self) -> Option<impl DoubleEndedIterator<Item = Piece> + Clone + '_> {
        let scale = scale(self.top)?;
        Some(self.pieces.iter().map(move |piece| piece.scaled(scale)))
    }

    /// Centre of gravity; nothing for a set without area.
    #[must_use]
    pub fn centroid(&self) -> Option<f64> {
        centroid(self.scaled()?, self.reference)
    }

    /// The point that halves the area; the middle of such points if there is a gap between the
    /// halves; nothing for a set without area.
    #[must_use]
    pub fn bisector(&self) -> Option<f64> {
        bisector(self.scaled()?)
    }

    /// Smallest, mean and largest of the points of highest grade; the mean is by length, or by
    /// number where there are only single points. Nothing for a set without area.
    #[must_use]
    pub fn maximum(&self) -> Option<[f64; 3]> {
        scale(self.top)?;
        let is_top = |grade: f64| grade >= self.top * (1.0 - SLACK);
        let mut ends: Option<[f64; 2]> = None;
        let (mut length, mut moment, mut count, mut sum) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        for piece in &self.pieces {
            for (x, grade) in piece.x.into_iter().zip(piece.grade) {
                if is_top(grade) {
                    let from = ends.map_or(x, |[from, _]| from);
                    let again = ends.is_some_and(|[_, to]| to >= x);
                    ends = Some([from, x]);
                    (count, sum) = if again {
                        (count, sum)
                    } else {
                        (count + 1.0, sum + (x - self.reference))
                    };
                }
            }
            if piece.grade.into_iter().all(is_top) {
                length += piece.width();
                moment += Piece { grade: [1.0; 2], ..*piece }.moment(self.reference);
            }
        }
        let mean = if length > 0.0 { moment / length } else { sum / count };
        ends.map(|[from, to]| [from, (self.reference + mean).clamp(from, to), to])
    }
}

/// True if a piece is the straight continuation of the last one.
#[allow(clippy::float_cmp, reason = "pieces that meet have the same end, bit for bit")]
fn continues(last: &Piece, piece: &Piece, same_cell: bool) -> bool {
    let meets = last.x[1] == piece.x[0] && last.grade[1] == piece.grade[0];
    let same = last.conclusion == piece.conclusion && last.cut == piece.cut;
    meets && same && last.conclusion.is_some() && (same_cell || piece.cut)
}

/// The factor, a power of two, that brings the highest grade into [1, 2); nothing for a set without
/// height, which is one below the normal range of numbers, where digits are lost.
pub(super) fn scale(top: f64) -> Option<f64> {
    let exponent = top.to_bits() >> 52;
    // Of 2^e the bits are e + 1023; 2046 is twice as much.
    let fires = top >= f64::MIN_POSITIVE && top.is_finite();
    fires.then(|| f64::from_bits((2046 - exponent).max(1) << 52))
}

/// Centre of gravity under pieces, computed about `reference`; nothing without area.
pub(super) fn centroid(pieces: impl Iterator<Item = Piece>, reference: f64) -> Option<f64> {
    let (mut area, mut moment) = (0.0_f64, 0.0_f64);
    for piece in pieces {
        area += piece.area();
        moment += piece.moment(reference);
    }
    (area > 0.0).then(|| reference + moment / area)
}

/// The point that halves the area under pieces: from the left and from the right, which differ where
/// there is a gap; nothing without area.
pub(super) fn bisector(pieces: impl DoubleEndedIterator<Item = Piece> + Clone) -> Option<f64> {
    let area: f64 = pieces.clone().map(|piece| piece.area()).sum();
    let half = [0.5 * area, area * SLACK];
    let turned = |p: Piece| Piece::plain([p.x[1], p.x[0]], [p.grade[1], p.grade[0]]);
    let (left, right) = (reached(pieces.clone(), half)?, reached(pieces.rev().map(turned), half)?);
    (area > 0.0).then_some(0.5 * left + 0.5 * right)
}

/// Where the area of pieces that are walked one after the other reaches `half`; at the end of a
/// piece if it does so within `slack`.
///
/// From height $y_0$ with slope $k$ the area $a$ is reached after
/// $d = 2a / (y_0 + \sqrt{y_0^2 + 2 k a})$.
fn reached(pieces: impl Iterator<Item = Piece>, [half, slack]: [f64; 2]) -> Option<f64> {
    let mut left = half;
    let mut end = None;
    for piece in pieces {
        let area = piece.area().abs();
        if area >= left - slack {
            let [from, to] = piece.x;
            let along = if area > left + slack { distance(&piece, left) } else { f64::INFINITY };
            let place = if from < to { (from + along).min(to) } else { (from - along).max(to) };
            return Some(place);
        }
        left -= area;
        end = Some(piece.x[1]);
    }
    end
}

fn distance(piece: &Piece, area: f64) -> f64 {
    let [begin, end] = piece.grade;
    let slope = (end - begin) / piece.width().abs();
    2.0 * area / (begin + libm::sqrt((begin * begin + 2.0 * slope * area).max(0.0)))
}
