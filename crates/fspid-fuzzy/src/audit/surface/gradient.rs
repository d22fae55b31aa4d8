//! How fast the centre of gravity of the joined set moves.
//!
//! With $A$ the area and $c$ the centre of gravity of the joined set $\mu$
//!
//! $$ \frac{\partial c}{\partial p} = \frac1A \int (x - c) \frac{\partial \mu}{\partial p} \ dx $$
//!
//! Where a layer's cut is the upper edge, $\partial \mu / \partial p$ is the slope of its level;
//! where the side of a set is, it is zero. Over a box of inputs a place may have several candidates
//! for the edge, and the derivative lies in the hull of theirs (Clarke's generalised gradient of a
//! maximum). The universe is divided into parts in which the candidates stay the same.
//!
//! # Source
//! F. H. Clarke, *Optimization and Nonsmooth Analysis*, 1983, propositions 2.3.12 and 2.7.2.

use alloc::vec;
use alloc::vec::Vec;

use super::envelope::{Bounds, meeting};
use super::layers::{Layers, Line, Slice};
use fspid_numeric::scalar::{Interval, Scalar};

/// The level of a layer over a box.
#[derive(Clone, Debug)]
pub(super) struct Level {
    pub(super) lower: f64,
    pub(super) upper: f64,
    /// Its slope along the input in question.
    pub(super) slope: Interval,
    /// Conclusions one of which is the strongest.
    pub(super) tops: Vec<usize>,
}

impl Level {
    pub(super) fn nothing() -> Self {
        Self { lower: 0.0, upper: 0.0, slope: Interval::ZERO, tops: Vec::new() }
    }
}

/// Room for the computation.
#[derive(Clone, Debug, Default)]
pub(super) struct Gradient {
    places: Vec<f64>,
    steady: Vec<[f64; 2]>,
    moving: Vec<[f64; 2]>,
    candidates: Vec<usize>,
    /// For each layer, length and moment of the parts where it alone is the edge.
    alone: Vec<[f64; 2]>,
    sum: Option<Interval>,
}

/// What is known of the joined set over the box.
pub(super) struct Known<'k, Below> {
    pub(super) layers: &'k Layers,
    pub(super) levels: &'k [Level],
    pub(super) bounds: &'k Bounds,
    /// Whether one layer's level is nowhere above another's.
    pub(super) below: Below,
}

/// Which layers may be the edge in a part of a slice.
struct Part {
    left: f64,
    right: f64,
    /// The side of a set may be the edge.
    side: bool,
    /// A set that is scaled may be the edge.
    scaled: bool,
}

impl Part {
    /// True if the edge is the cut of one and the same layer throughout.
    fn level(&self) -> bool {
        !self.side && !self.scaled
    }
}

impl<Below: Fn(usize, usize) -> bool> Known<'_, Below> {
    fn level(&self, line: &Line) -> Option<&Level> {
        self.levels.get(line.layer)
    }

    fn scaled(&self, line: &Line) -> bool {
        self.layers.layers.get(line.layer).is_some_and(|layer| layer.scaled)
    }

    /// Least height that a line contributes at `x`, somewhere below what it may contribute there.
    fn least(&self, slice: &Slice, line: &Line, x: f64) -> f64 {
        let (grade, lower) = (slice.grade(line, x), self.level(line).map_or(0.0, |l| l.lower));
        if self.scaled(line) { lower * grade } else { lower.min(grade) }
    }
}

impl Gradient {
    /// The slope of the centre of gravity.
    pub(super) fn slope<Below: Fn(usize, usize) -> bool>(
        &mut self,
        known: &Known<'_, Below>,
    ) -> Interval {
        if known.bounds.area.lower() <= 0.0 {
            return Interval::ENTIRE;
        }
        self.alone.clear();
        self.alone.resize(known.levels.len(), [0.0; 2]);
        self.sum = Some(Interval::ZERO);
        for slice in &known.layers.slices {
            self.divide(known, slice);
            for index in 1..self.places.len() {
                let ends = (self.places.get(index - 1), self.places.get(index));
                if let (Some(&left), Some(&right)) = ends
                    && left < right
                {
                    self.part(known, slice, left, right);
                }
            }
        }
        self.total(known) / known.bounds.area
    }

    /// The ends of the slice, the bounds of the centre, and every place where the candidates for the
    /// edge may change.
    fn divide<Below: Fn(usize, usize) -> bool>(&mut self, known: &Known<'_, Below>, slice: &Slice) {
        let slack = 2.0 * known.layers.slack;
        self.steady.clear();
        self.moving.clear();
        for line in &slice.lines {
            let Some(level) = known.level(line) else { continue };
            let (start, slope) = (line.start, line.slope);
            if known.scaled(line) {
                self.steady.push([level.lower * start, level.lower * slope]);
                self.moving.push([level.upper * start + slack, level.upper * slope]);
            } else {
                self.steady.extend([[level.lower, 0.0], [start, slope], [level.upper, 0.0]]);
                self.moving.extend([[start, slope], [level.upper, 0.0], [start + slack, slope]]);
            }
        }
        self.places.clear();
        self.places.extend([slice.left, slice.right]);
        let centre = known.bounds.centre;
        let inside = |x: &f64| *x > slice.left && *x < slice.right;
        self.places.extend([centre.lower(), centre.upper()].iter().filter(|x| inside(x)));
        for &one in &self.moving {
            self.places.extend(self.steady.iter().filter_map(|&other| meeting(slice, one, other)));
        }
        self.places.sort_unstable_by(f64::total_cmp);
    }

    fn part<Below: Fn(usize, usize) -> bool>(
        &mut self,
        known: &Known<'_, Below>,
        slice: &Slice,
        left: f64,
        right: f64,
    ) {
        let part = self.find_candidates(known, slice, left, right);
        let first = self.candidates.first().and_then(|&i| slice.lines.get(i));
        match (self.candidates.len(), first) {
            (0, _) => {}
            (1, Some(line)) if !part.side => self.count_alone(known, slice, line, &part),
            _ => self.count_mixed(known, slice, &part),
        }
    }

    /// The lines of the slice whose level may be the edge between two places.
    fn find_candidates<Below: Fn(usize, usize) -> bool>(
        &mut self,
        known: &Known<'_, Below>,
        slice: &Slice,
        left: f64,
        right: f64,
    ) -> Part {
        let x = 0.5 * (left + right);
        let slack = 2.0 * known.layers.slack;
        let lines = slice.lines.iter();
        let least = lines.map(|line| known.least(slice, line, x)).fold(0.0, f64::max);
        self.candidates.clear();
        let mut part = Part { left, right, side: false, scaled: false };
        for (index, line) in slice.lines.iter().enumerate() {
            let Some(level) = known.level(line) else { continue };
            let grade = slice.grade(line, x);
            let (cut, side) = if known.scaled(line) {
                (level.upper * grade + slack >= least, false)
            } else {
                let cut = grade >= level.lower && level.upper >= least;
                (cut, grade <= level.upper && grade + slack >= least)
            };
            part.side |= side;
            if cut && level.upper > 0.0 {
                part.scaled |= known.scaled(line);
                self.candidates.push(index);
            }
        }
        if part.level() {
            self.drop_dominated(known, slice);
        }
        part
    }

    /// Leaves out candidates whose level is never above that of another.
    fn drop_dominated<Below: Fn(usize, usize) -> bool>(
        &mut self,
        known: &Known<'_, Below>,
        slice: &Slice,
    ) {
        if self.candidates.len() < 2 {
            return;
        }
        let layer = |index: usize| slice.lines.get(index).map_or(usize::MAX, |line| line.layer);
        let all = core::mem::take(&mut self.candidates);
        self.candidates.extend(all.iter().filter(|&&one| {
            let one = layer(one);
            !all.iter().map(|&other| layer(other)).any(|other| {
                let below = other != one && (known.below)(one, other);
                below && (other < one || !(known.below)(other, one))
            })
        }));
    }

    fn count_alone<Below: Fn(usize, usize) -> bool>(
        &mut self,
        known: &Known<'_, Below>,
        slice: &Slice,
        line: &Line,
        part: &Part,
    ) {
        let (width, middle) = (part.right - part.left, 0.5 * (part.left + part.right));
        let [length, moment] = if known.scaled(line) {
            let grade = slice.grade(line, middle);
            // $\int x \mu = w (m \mu_m + s w^2 / 12)$
            [width * grade, width * (middle * grade + line.slope * width * width / 12.0)]
        } else {
            [width, width * middle]
        };
        if let Some([lengths, moments]) = self.alone.get_mut(line.layer) {
            (*lengths, *moments) = (*lengths + length, *moments + moment);
        }
    }

    /// A part with several candidates: their hull, times the moment of the part.
    fn count_mixed<Below: Fn(usize, usize) -> bool>(
        &mut self,
        known: &Known<'_, Below>,
        slice: &Slice,
        part: &Part,
    ) {
        let mut hull: Option<Interval> = part.side.then_some(Interval::ZERO);
        for line in self.candidates.iter().filter_map(|&index| slice.lines.get(index)) {
            let slope = known.level(line).map_or(Interval::ENTIRE, |level| level.slope);
            let slope = if known.scaled(line) {
                let grades = [part.left, part.right].map(|x| slice.grade(line, x));
                let slack = known.layers.slack;
                slope
                    * Interval::between(grades[0] - slack, grades[0] + slack)
                        .hull(Interval::between(grades[1] - slack, grades[1] + slack))
            } else {
                slope
            };
            hull = Some(hull.map_or(slope, |hull| hull.hull(slope)));
        }
        let Some(hull) = hull.filter(|hull| hull.magnitude() > 0.0) else { return };
        let [left, right] = [part.left, part.right].map(Interval::point);
        let width = right - left;
        let arm = (left + right) * Interval::half() - known.bounds.centre;
        let centre = known.bounds.centre;
        // Between the bounds of the centre the arm may change its sign from place to place.
        let within = part.left >= centre.lower() && part.right <= centre.upper();
        let reach = (Interval::point(arm.magnitude()) + width).upper();
        let arm = if within && !part.level() { Interval::between(-reach, reach) } else { arm };
        self.sum = self.sum.map(|sum| sum + hull * (width * arm));
    }

    fn total<Below: Fn(usize, usize) -> bool>(&self, known: &Known<'_, Below>) -> Interval {
        let span = known.layers.span;
        // Sums of fewer than 2^16 parts, none longer than the span.
        let error = 256.0 * f64::EPSILON * span * (1.0 + span);
        let slack = Interval::between(-error, error);
        let mut sum = self.sum.unwrap_or(Interval::ENTIRE);
        for (level, &[length, moment]) in known.levels.iter().zip(&self.alone) {
            if level.upper > 0.0 {
                let [length, moment] = [length, moment].map(|x| Interval::point(x) + slack);
                sum = sum + level.slope * (moment - known.bounds.centre * length);
            }
        }
        sum
    }
}

/// Room for the levels of an output.
pub(super) fn room(layers: &Layers) -> Vec<Level> {
    vec![Level::nothing(); layers.layers.len()]
}
