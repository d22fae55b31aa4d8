//! Where a curve is highest: by halving the universe and leaving out what is proved to be lower.
//!
//! # Source
//! Hansen and Walster, *Global Optimization Using Interval Analysis*, 2nd ed. 2004, chapter 12.

use fspid_numeric::quadrature::Curve;
use fspid_numeric::scalar::{Interval, Jet};

/// Grades that differ by this fraction count as equally high.
const SLACK: f64 = 32.0 * f64::EPSILON;
/// Halvings of the universe beyond which a part is taken as it is.
const HALVINGS: u32 = 44;
/// Evaluations for one question.
const BUDGET: u32 = 20_000;
/// Samples with which the search for the highest grade begins.
const SAMPLES: u32 = 64;
/// Parts of the universe shorter than this share of it are single points.
const POINT: f64 = 1e-5;

/// A part of the universe, and how often it has been halved.
#[derive(Clone, Copy)]
struct Part {
    x: [f64; 2],
    halvings: u32,
}

impl Part {
    fn halves(&self) -> [Self; 2] {
        let middle = 0.5 * self.x[0] + 0.5 * self.x[1];
        let halvings = self.halvings + 1;
        [[self.x[0], middle], [middle, self.x[1]]].map(|x| Self { x, halvings })
    }

    fn width(&self) -> f64 {
        self.x[1] - self.x[0]
    }
}

/// A run of points that may be the highest ones.
#[derive(Clone, Copy, Default)]
struct Run {
    /// From and to.
    x: [f64; 2],
    /// The points of the run that are certainly within the slack.
    sure: Option<[f64; 2]>,
}

/// What is known about where a curve is highest.
pub(super) struct Search {
    universe: f64,
    first: Run,
    last: Run,
    /// Of all runs: length and moment about the first; number and sum of places of the points.
    length: [f64; 2],
    points: [f64; 2],
}

impl Search {
    /// Searches; nothing for a curve that is nowhere above 0.
    pub(super) fn new<C: Curve>(curve: &C, x: [f64; 2], corners: &[f64]) -> Option<Self> {
        let top = top(curve, x, corners);
        if !(top > 0.0) {
            return None;
        }
        let mut found: Option<Self> = None;
        let mut run: Option<Run> = None;
        let close = |run: Option<Run>, found: &mut Option<Self>| {
            if let Some(run) = run {
                found.get_or_insert_with(|| Self::begin(x[1] - x[0], run)).add(run);
            }
        };
        walk(x, |part| {
            let grade = range(curve, part);
            if grade.upper() < top * (1.0 - SLACK) {
                close(run.take(), &mut found);
                return false;
            }
            // A range this narrow will not become narrower than rounding lets it.
            let sure = grade.lower() >= top * (1.0 - SLACK) || grade.width() <= top * SLACK;
            if !sure && part.halvings < HALVINGS {
                return true;
            }
            let own = run.get_or_insert(Run { x: part.x, sure: None });
            own.x[1] = part.x[1];
            if sure {
                own.sure = Some([own.sure.map_or(part.x[0], |[from, _]| from), part.x[1]]);
            }
            false
        });
        close(run, &mut found);
        found
    }

    fn begin(universe: f64, run: Run) -> Self {
        Self { universe, first: run, last: run, length: [0.0; 2], points: [0.0; 2] }
    }

    fn add(&mut self, run: Run) {
        self.last = run;
        let [from, to] = run.x.map(|x| x - self.first.x[0]);
        let middle = 0.5 * from + 0.5 * to;
        if self.is_point(&run) {
            self.points = [self.points[0] + 1.0, self.points[1] + middle];
        } else {
            self.length = [self.length[0] + (to - from), self.length[1] + (to - from) * middle];
        }
    }

    /// Around a smooth maximum there is a short run of points as high as far as can be told.
    fn is_point(&self, run: &Run) -> bool {
        run.x[1] - run.x[0] <= POINT * self.universe
    }

    /// The smallest point and how far it may be off.
    pub(super) fn smallest(&self) -> Option<(f64, f64)> {
        Some(self.end(&self.first, 0))
    }

    /// The largest point and how far it may be off.
    pub(super) fn largest(&self) -> Option<(f64, f64)> {
        Some(self.end(&self.last, 1))
    }

    fn end(&self, run: &Run, side: usize) -> (f64, f64) {
        let [from, to] = run.x;
        if self.is_point(run) {
            return (0.5 * from + 0.5 * to, 0.5 * (to - from));
        }
        let [outer, inner] = match (side, run.sure) {
            (0, sure) => [from, sure.map_or(to, |[from, _]| from)],
            (_, sure) => [to, sure.map_or(from, |[_, to]| to)],
        };
        (0.5 * outer + 0.5 * inner, 0.5 * (inner - outer).abs())
    }

    /// The mean, by length or of single points, and how far it may be off.
    pub(super) fn mean(&self) -> Option<(f64, f64)> {
        let [size, moment] = if self.length[0] > 0.0 { self.length } else { self.points };
        let bound = self.end(&self.first, 0).1 + self.end(&self.last, 1).1;
        Some((self.first.x[0] + moment / size, bound))
    }
}

/// All grades in a part: what interval arithmetic says, cut down by the mean value theorem where the
/// curve is smooth, without which rising and falling sets that are added up would take forever.
///
/// $$ f(x) \in f(m) + f'(X) (X - m) $$
fn range<C: Curve>(curve: &C, part: &Part) -> Interval {
    let x = Interval::between(part.x[0], part.x[1]);
    let series = curve.at(Jet::<Interval, 2>::variable(x));
    let [value, slope] = *series.coefficients();
    if !slope.is_bounded() {
        return value;
    }
    let middle = Interval::point(x.midpoint());
    let around = curve.at(middle) + slope * (x - middle);
    value.intersection(around).unwrap_or(value)
}

/// The highest grade, from below: samples, then every part that may be higher.
fn top<C: Curve>(curve: &C, x: [f64; 2], corners: &[f64]) -> f64 {
    let step = (x[1] - x[0]) / f64::from(SAMPLES);
    let samples = (0..SAMPLES).map(|n| x[0] + f64::from(n) * step);
    let places = samples.chain([x[1]]).chain(corners.iter().copied());
    let mut top = places.fold(0.0, |top: f64, x| top.max(curve.at(x)));
    walk(x, |part| {
        let middle = 0.5 * part.x[0] + 0.5 * part.x[1];
        top = top.max(curve.at(middle));
        let grade = range(curve, part);
        let may_be_higher = grade.upper() > top * (1.0 + 0.25 * SLACK);
        may_be_higher && grade.width() > 0.5 * SLACK * top && part.halvings < HALVINGS
    });
    top
}

/// Visits parts of `x` from left to right, halving those of which `visit` says so.
fn walk(x: [f64; 2], mut visit: impl FnMut(&Part) -> bool) {
    let whole = Part { x, halvings: 0 };
    let mut waiting = [whole; HALVINGS as usize + 2];
    let (mut count, mut left) = (1_usize, BUDGET);
    while let Some(part) = count.checked_sub(1).and_then(|last| waiting.get(last)).copied() {
        count -= 1;
        left = left.saturating_sub(1);
        let part = if left == 0 { Part { halvings: HALVINGS, ..part } } else { part };
        if visit(&part) && part.width() > 0.0 {
            let [first, second] = part.halves();
            for (place, half) in waiting.iter_mut().skip(count).zip([second, first]) {
                *place = half;
                count += 1;
            }
        }
    }
}
