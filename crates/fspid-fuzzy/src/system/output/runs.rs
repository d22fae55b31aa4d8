//! The runs of points that may be the highest ones, and what is read off them: numbers and how far
//! they may be off.

use super::maximum::SLACK;

/// Parts of the universe shorter than this share of it are single points.
const POINT: f64 = 1e-5;
/// A run that is proved to be among the highest may hide a corner that is higher by this fraction.
const HIDDEN: f64 = 1e-9;

/// A run of points that may be the highest ones.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    /// From and to.
    x: [f64; 2],
    /// The outermost points of the run that are certainly within the slack.
    sure: Option<[f64; 2]>,
    /// Length of the parts that are proved to be of one height.
    flat: f64,
    /// Bound of all grades as a share of the highest one that is known.
    share: f64,
}

impl Run {
    pub(super) fn begin([from, _]: [f64; 2]) -> Self {
        Self { x: [from; 2], sure: None, flat: 0.0, share: 0.0 }
    }

    /// Appends a part whose grades are at most such a share of the highest one that is known.
    pub(super) fn extend(&mut self, [_, to]: [f64; 2], share: f64) {
        self.x[1] = to;
        self.share = self.share.max(share);
    }

    /// Takes note of a point that is within the slack.
    pub(super) fn certify(&mut self, x: f64) {
        let [from, to] = self.sure.unwrap_or([x; 2]);
        self.sure = Some([from.min(x), to.max(x)]);
    }

    /// Takes note that a part has one height.
    pub(super) fn flatten(&mut self, [from, to]: [f64; 2]) {
        self.flat += to - from;
    }

    fn length(&self) -> f64 {
        self.x[1] - self.x[0]
    }

    /// A smooth maximum, or one at a corner. A longer run that nobody proved to be of one height may
    /// be level or not: there the bound is as long as the run.
    fn is_point(&self, universe: f64) -> bool {
        self.flat <= 0.0 && self.length() <= POINT * universe
    }

    /// True if some grade of the run may be higher than all that are known.
    fn may_be_higher(&self) -> bool {
        let hidden = if self.sure.is_some() { HIDDEN } else { SLACK };
        !(self.share <= 1.0 + hidden)
    }

    /// The first or the last of the highest points, and between which it is.
    fn end(&self, side: usize, universe: f64) -> (f64, [f64; 2]) {
        let [from, to] = self.x;
        let [first, last] = self.sure.unwrap_or(self.x);
        if self.is_point(universe) {
            return (0.5 * first + 0.5 * last, self.x);
        }
        let (place, narrow) = match side {
            0 => (0.5 * from + 0.5 * first, [from, first]),
            _ => (0.5 * last + 0.5 * to, [last, to]),
        };
        (place, if self.flat > 0.0 { narrow } else { self.x })
    }
}

/// All runs of a curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Runs {
    universe: [f64; 2],
    /// From the first to the last point that may be a highest one.
    all: Option<[f64; 2]>,
    /// The first and the last run that is certainly among the highest.
    sure: Option<[Run; 2]>,
    /// Of those: length and moment; number and sum of places of the points.
    length: [f64; 2],
    points: [f64; 2],
    /// Length that is proved to be of one height, and length that may be or may not.
    flat: f64,
    loose: f64,
    /// How far the points may be off, added up.
    spread: f64,
    /// A run may be among the highest; and may even be higher than all that are.
    unsure: bool,
    higher: bool,
}

impl Runs {
    pub(super) fn new(universe: [f64; 2]) -> Self {
        Self {
            universe,
            all: None,
            sure: None,
            length: [0.0; 2],
            points: [0.0; 2],
            flat: 0.0,
            loose: 0.0,
            spread: 0.0,
            unsure: false,
            higher: false,
        }
    }

    /// Appends a run.
    pub(super) fn add(&mut self, run: &Run) {
        self.all = Some([self.all.map_or(run.x[0], |[from, _]| from), run.x[1]]);
        self.higher |= run.may_be_higher();
        self.loose += run.length() - run.flat.min(run.length());
        if run.sure.is_none() {
            self.unsure = true;
            return;
        }
        self.sure = Some([self.sure.map_or(*run, |[first, _]| first), *run]);
        let (reference, universe) = (self.universe[0], self.span());
        if run.is_point(universe) {
            let (place, between) = run.end(0, universe);
            self.points = [self.points[0] + 1.0, self.points[1] + (place - reference)];
            self.spread += farthest(place, between);
        } else {
            let [from, to] = [0, 1].map(|side| run.end(side, universe).0);
            let middle = 0.5 * (from - reference) + 0.5 * (to - reference);
            self.length = [self.length[0] + (to - from), self.length[1] + (to - from) * middle];
            self.flat += run.flat;
        }
    }

    fn span(&self) -> f64 {
        self.universe[1] - self.universe[0]
    }

    /// The smallest point and how far it may be off.
    pub(super) fn smallest(&self) -> Option<(f64, f64)> {
        self.end(0)
    }

    /// The largest point and how far it may be off.
    pub(super) fn largest(&self) -> Option<(f64, f64)> {
        self.end(1)
    }

    fn end(&self, side: usize) -> Option<(f64, f64)> {
        let all = self.all?;
        let Some(sure) = self.sure else { return Some(middle(all)) };
        let run = if side == 0 { &sure[0] } else { &sure[1] };
        let (place, [from, to]) = run.end(side, self.span());
        // A run before the first sure one may be as high, and any that is higher may be the only one.
        let between = match side {
            _ if self.higher => all,
            0 => [all[0], to],
            _ => [from, all[1]],
        };
        Some((place, farthest(place, between)))
    }

    /// The mean, by length or of single points, and how far it may be off.
    pub(super) fn mean(&self) -> Option<(f64, f64)> {
        let all = self.all?;
        let Some([first, last]) = self.sure else { return Some(middle(all)) };
        let [size, moment] = if self.length[0] > 0.0 { self.length } else { self.points };
        let mean = (self.universe[0] + moment / size).clamp(first.x[0], last.x[1]);
        let anywhere = farthest(mean, all);
        let bound = if self.higher {
            anywhere
        } else if self.flat > 0.0 {
            // What is added or taken away shifts the mean by its share of the length.
            self.loose * (all[1] - all[0]) / self.flat
        } else if self.unsure || self.length[0] > 0.0 {
            anywhere
        } else {
            self.spread / self.points[0]
        };
        Some((mean, bound.min(anywhere)))
    }
}

/// How far a place may be off that is somewhere in an interval.
fn farthest(place: f64, [from, to]: [f64; 2]) -> f64 {
    (place - from).max(to - place)
}

/// The middle of an interval and half its length.
fn middle([from, to]: [f64; 2]) -> (f64, f64) {
    (0.5 * from + 0.5 * to, 0.5 * (to - from))
}
