//! Where a curve is highest: by halving the universe and leaving out what is proved to be lower.
//!
//! Parts that only rise or only fall are left out too, but for their higher end: around a flat top
//! grades alone cannot tell one place from the next. The universe is cut beforehand where sets jump,
//! for in a part with a jump arithmetic knows little.
//!
//! # Source
//! Hansen and Walster, *Global Optimization Using Interval Analysis*, 2nd ed. 2004, chapter 12.

use super::curve::JoinedCurve;
use super::runs::{Run, Runs};
use fspid_numeric::quadrature::Curve;
use fspid_numeric::scalar::{Interval, Jet};

/// Grades that differ by this fraction count as equally high.
pub(super) const SLACK: f64 = 32.0 * f64::EPSILON;
/// A peak that is no corner of a set is found by halving, and counts as equally high within this.
const PEAK: f64 = 1e-10;
/// Halvings of the universe beyond which a part is taken as it is.
const HALVINGS: u32 = 44;
/// Evaluations for one question.
const BUDGET: u32 = 20_000;
/// Samples with which the search for the highest grade begins.
const SAMPLES: u32 = 64;
/// A slope of which halving a part leaves this share or more is known no better than rounding lets
/// it be.
const STUCK: f64 = 0.75;

/// A part of the universe, and how often it has been halved.
#[derive(Clone, Copy)]
struct Part {
    x: [f64; 2],
    halvings: u32,
}

impl Part {
    fn halves(&self) -> [Self; 2] {
        let middle = self.middle();
        let halvings = self.halvings + 1;
        [[self.x[0], middle], [middle, self.x[1]]].map(|x| Self { x, halvings })
    }

    fn middle(&self) -> f64 {
        0.5 * self.x[0] + 0.5 * self.x[1]
    }

    fn is_place(&self) -> bool {
        self.x[1] <= self.x[0]
    }
}

/// Where the joined set of an output is highest; nothing for one that is nowhere above 0.
pub(super) fn search(curve: &JoinedCurve<'_>, x: [f64; 2], corners: &[f64]) -> Option<Runs> {
    let ground = Ground { curve, x, corners };
    let top = ground.top();
    if !(top > 0.0) {
        return None;
    }
    let mut search = Search { ground, top, runs: Runs::new(x), run: None, before: Before::End };
    let mut left = BUDGET;
    for piece in ground.pieces() {
        search.before = Before::End;
        walk(piece, &mut left, |part| search.visit(part));
        if search.before == Before::Rising {
            search.keep_place(piece[1]);
        }
    }
    search.close();
    Some(search.runs)
}

/// What is asked, and where.
#[derive(Clone, Copy)]
struct Ground<'a> {
    curve: &'a JoinedCurve<'a>,
    x: [f64; 2],
    corners: &'a [f64],
}

/// What is known of a part.
struct Look {
    grade: Interval,
    /// Nothing where the curve may jump.
    slope: Option<Interval>,
}

impl Ground<'_> {
    /// All grades in a part: what interval arithmetic says, cut down by the mean value theorem where
    /// the curve is smooth, without which rising and falling sets that are added up would take
    /// forever.
    ///
    /// $$ f(x) \in f(m) + f'(X) (X - m) $$
    fn look(&self, [from, to]: [f64; 2]) -> Look {
        let x = Interval::between(from, to);
        let ends = self.curve.range(x);
        if x.is_point() {
            return Look { grade: ends, slope: None };
        }
        let series = self.curve.at(Jet::<Interval, 2>::variable(x));
        let [value, slope] = *series.coefficients();
        let grade = value.intersection(ends).unwrap_or(value);
        if !slope.is_bounded() {
            return Look { grade, slope: None };
        }
        let middle = Interval::point(x.midpoint());
        let around = self.curve.range(middle) + slope * (x - middle);
        Look { grade: grade.intersection(around).unwrap_or(grade), slope: Some(slope) }
    }

    /// The least that the grade of a place may be.
    fn at_least(&self, x: f64) -> f64 {
        self.curve.range(Interval::point(x)).lower()
    }

    /// The universe, cut where sets jump: the place of the jump is a piece of its own.
    fn pieces(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        let jumps = self.corners.iter().copied().filter(|&c| {
            let (from, to) = (c.next_down().max(self.x[0]), c.next_up().min(self.x[1]));
            self.look([from, to]).slope.is_none()
        });
        let mut begin = self.x[0];
        jumps
            .map(Some)
            .chain([None])
            .flat_map(move |jump| {
                let before = jump.map_or(self.x[1], f64::next_down);
                let piece = (begin <= before).then_some([begin, before]);
                begin = jump.map_or(f64::INFINITY, f64::next_up);
                [piece, jump.map(|x| [x, x])]
            })
            .flatten()
    }

    /// Corners of sets in a part.
    fn corners_in(&self, [from, to]: [f64; 2]) -> impl Iterator<Item = f64> + Clone + '_ {
        self.corners.iter().copied().filter(move |&c| (from..=to).contains(&c))
    }

    /// The highest grade, from below: samples, then every part that may be higher.
    fn top(&self) -> f64 {
        let step = (self.x[1] - self.x[0]) / f64::from(SAMPLES);
        let samples = (0..SAMPLES).map(|n| self.x[0] + f64::from(n) * step);
        let places = samples.chain([self.x[1]]).chain(self.corners.iter().copied());
        let mut top = places.clone().fold(0.0, |top: f64, x| top.max(self.at_least(x)));
        if !(top > 0.0) {
            // Such as a grade of 1, but for rounding, of which a norm makes more than of any less.
            top = places.fold(0.0, |top: f64, x| top.max(self.curve.at(x)));
        }
        let mut left = BUDGET;
        for piece in self.pieces() {
            walk(piece, &mut left, |part| {
                let look = self.look(part.x);
                if !(look.grade.upper() > top * (1.0 + 0.25 * SLACK)) {
                    return false;
                }
                top = top.max(self.at_least(part.middle()));
                if look.slope.is_some_and(|slope| !slope.contains(0.0)) {
                    let [from, to] = part.x.map(|x| self.at_least(x));
                    top = top.max(from).max(to);
                    return false;
                }
                look.grade.width() > 0.5 * SLACK * top && part.halvings < HALVINGS
            });
        }
        top
    }

    fn is_flat(&self, part: &Part) -> bool {
        self.curve.is_flat(Interval::between(part.x[0], part.x[1]))
    }

    /// True if halving a part does not tell its slope any better.
    fn is_stuck(&self, part: &Part, slope: Interval) -> bool {
        let known = |half: &Part| {
            let own = self.look(half.x).slope;
            own.is_some_and(|own| own.contains(0.0) && own.magnitude() >= STUCK * slope.magnitude())
        };
        part.halves().iter().all(known)
    }
}

/// What lies before a part.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Before {
    /// The end of a piece.
    End,
    Rising,
    /// Points that are kept, or that are lower.
    Other,
}

/// A search under way.
struct Search<'a> {
    ground: Ground<'a>,
    /// The highest grade, from below.
    top: f64,
    runs: Runs,
    run: Option<Run>,
    before: Before,
}

impl Search<'_> {
    fn close(&mut self) {
        if let Some(run) = self.run.take() {
            self.runs.add(&run);
        }
    }

    /// True if the part has to be halved.
    fn visit(&mut self, part: &Part) -> bool {
        let Look { grade, slope } = self.ground.look(part.x);
        let enough = self.top * (1.0 - SLACK);
        if grade.upper() < enough {
            self.close();
            self.before = Before::Other;
            return false;
        }
        if let Some(slope) = slope
            && !slope.contains(0.0)
        {
            self.pass(part, slope.lower() > 0.0);
            return false;
        }
        // A range this narrow will not become narrower than rounding lets it.
        let level = grade.lower() >= enough || grade.width() <= self.top * SLACK;
        let same = slope.is_some_and(|slope| slope.magnitude() <= 0.0);
        let flat = level && !part.is_place() && (same || self.ground.is_flat(part));
        let stuck = |slope| self.ground.is_stuck(part, slope);
        let done = flat || part.is_place() || (level && slope.is_none_or(stuck));
        if !done && part.halvings < HALVINGS {
            return true;
        }
        self.keep(part.x, grade, [level, flat]);
        let near = slope.is_some() && grade.lower() >= self.top * (1.0 - PEAK);
        if near
            && self.ground.corners_in(part.x).next().is_none()
            && let Some(run) = &mut self.run
        {
            run.certify(part.middle());
        }
        false
    }

    /// Leaves out a part that only rises or only falls, but for its higher end: the one of a part
    /// that rises is the lower one of what follows, if it is a maximum or not.
    fn pass(&mut self, part: &Part, rises: bool) {
        if !rises && self.before != Before::Other {
            self.keep_place(part.x[0]);
        }
        self.close();
        self.before = if rises { Before::Rising } else { Before::Other };
    }

    fn keep_place(&mut self, x: f64) {
        let grade = self.ground.look([x; 2]).grade;
        let enough = self.top * (1.0 - SLACK);
        if grade.upper() >= enough {
            let level = grade.lower() >= enough || grade.width() <= self.top * SLACK;
            self.keep([x; 2], grade, [level, false]);
        }
    }

    fn keep(&mut self, x: [f64; 2], grade: Interval, [level, flat]: [bool; 2]) {
        self.before = Before::Other;
        let run = self.run.get_or_insert(Run::begin(x));
        run.extend(x, grade.upper() / self.top);
        if flat {
            run.flatten(x);
        }
        // Of a part that is not level some places may be as high as any.
        let enough = self.top * (1.0 - SLACK);
        let places = x.into_iter().chain(self.ground.corners_in(x));
        for place in places.filter(|&x| level || self.ground.at_least(x) >= enough) {
            run.certify(place);
        }
    }
}

/// Visits parts of `x` from left to right, halving those of which `visit` says so.
fn walk(x: [f64; 2], left: &mut u32, mut visit: impl FnMut(&Part) -> bool) {
    let whole = Part { x, halvings: 0 };
    let mut waiting = [whole; HALVINGS as usize + 2];
    let mut count = 1_usize;
    while let Some(part) = count.checked_sub(1).and_then(|last| waiting.get(last)).copied() {
        count -= 1;
        *left = left.saturating_sub(1);
        let part = if *left == 0 { Part { halvings: HALVINGS, ..part } } else { part };
        if visit(&part) && !part.is_place() {
            let [first, second] = part.halves();
            for (place, half) in waiting.iter_mut().skip(count).zip([second, first]) {
                *place = half;
                count += 1;
            }
        }
    }
}
