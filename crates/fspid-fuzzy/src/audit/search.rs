//! Proving extremes by branch and bound.
//!
//! The domain is cut into boxes. Over each box an [`Objective`] answers an enclosure of its values,
//! and of its slopes if it has any. The box with the largest upper bound is halved next; the largest
//! value proved at a point is a lower bound of the maximum, the largest upper bound left an upper
//! one. Where slopes are known,
//!
//! $$ f(X) \subseteq f(m) + \sum_i f'_i(X) (X_i - m_i) $$
//!
//! closes the gap quadratically, and where a slope has one sign throughout a box only the face at
//! which $f$ is larger is looked at. Work is counted in boxes, not in time, so that an answer is the
//! same everywhere.
//!
//! # Source
//! Moore, Kearfott and Cloud, *Introduction to Interval Analysis*, SIAM 2009, chapters 6 and 11.

use alloc::collections::{BinaryHeap, VecDeque};
use alloc::vec;
use alloc::vec::Vec;
use core::cmp::Ordering;

use fspid_numeric::scalar::{Interval, Scalar};

/// Sides below this fraction of the domain's are not halved any more.
const NARROWEST: f64 = 1e-13;
/// Where there are no slopes, a point is tried in one of so many boxes.
const BOXES_PER_POINT: u64 = 4;

/// A function of boxes.
pub(super) trait Objective {
    /// All values over a box; all slopes along each input, if there is room for them.
    fn enclose(&mut self, cell: &[Interval], slopes: Option<&mut [Interval]>) -> Interval;

    /// Whether slopes are known at all.
    fn has_slopes(&self) -> bool {
        true
    }
}

/// How hard to try.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Effort {
    /// A gap that is close enough.
    pub(super) tolerance: f64,
    /// Most boxes that are looked at.
    pub(super) boxes: u64,
}

/// A maximum or minimum over a domain, between bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// The extreme lies between these. Both are proved.
    pub bounds: [f64; 2],
    /// A point whose value lies between the bounds too.
    pub at: Vec<f64>,
    /// Boxes that were looked at.
    pub boxes: u64,
    /// The bounds are as near to each other as was asked for.
    pub settled: bool,
}

/// A box and the largest value that may be in it.
struct Node {
    upper: f64,
    cell: Vec<Interval>,
}

impl PartialEq for Node {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Node {}

impl PartialOrd for Node {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Node {
    fn cmp(&self, other: &Self) -> Ordering {
        self.upper.total_cmp(&other.upper)
    }
}

struct Search<'a> {
    objective: &'a mut dyn Objective,
    domain: &'a [Interval],
    open: BinaryHeap<Node>,
    best: f64,
    at: Vec<f64>,
    boxes: u64,
    slopes: Vec<Interval>,
}

/// The largest value of an objective over a domain.
pub(super) fn maximum(
    objective: &mut dyn Objective,
    domain: &[Interval],
    effort: Effort,
) -> Extreme {
    let mut search = Search {
        objective,
        domain,
        open: BinaryHeap::new(),
        best: f64::NEG_INFINITY,
        at: middle(domain),
        boxes: 0,
        slopes: vec![Interval::ENTIRE; domain.len()],
    };
    search.look(domain.to_vec());
    let upper = search.run(effort);
    let bounds = [search.best, upper.max(search.best)];
    let settled = bounds[1] - bounds[0] <= effort.tolerance;
    Extreme { bounds, at: search.at, boxes: search.boxes, settled }
}

/// The smallest value of an objective over a domain.
pub(super) fn minimum(
    objective: &mut dyn Objective,
    domain: &[Interval],
    effort: Effort,
) -> Extreme {
    let mut negative = Negative(objective);
    let extreme = maximum(&mut negative, domain, effort);
    let [lower, upper] = extreme.bounds;
    Extreme { bounds: [-upper, -lower], ..extreme }
}

/// An objective with its sign changed.
struct Negative<'a>(&'a mut dyn Objective);

impl Objective for Negative<'_> {
    fn enclose(&mut self, cell: &[Interval], mut slopes: Option<&mut [Interval]>) -> Interval {
        let value = self.0.enclose(cell, slopes.as_deref_mut());
        slopes.into_iter().flatten().for_each(|slope| *slope = -*slope);
        -value
    }

    fn has_slopes(&self) -> bool {
        self.0.has_slopes()
    }
}

/// The middle of a box.
pub(super) fn middle(cell: &[Interval]) -> Vec<f64> {
    cell.iter().map(|side| side.midpoint()).collect()
}

fn points(point: &[f64]) -> Vec<Interval> {
    point.iter().copied().map(Interval::point).collect()
}

/// The two halves of a box, across its widest side as measured by the domain; nothing if it is a
/// point.
pub(super) fn halves(cell: &[Interval], domain: &[Interval]) -> Option<[Vec<Interval>; 2]> {
    let share = |(side, whole): (&Interval, &Interval)| {
        if whole.is_point() { 0.0 } else { side.width() / whole.width() }
    };
    let shares = cell.iter().zip(domain).map(share).enumerate();
    let (widest, share) = shares.max_by(|one, other| one.1.total_cmp(&other.1))?;
    let side = cell.get(widest).filter(|_| share > NARROWEST)?;
    let middle = side.midpoint();
    let halves = [(side.lower(), middle), (middle, side.upper())];
    Some(halves.map(|(lower, upper)| {
        let mut half = cell.to_vec();
        if let Some(place) = half.get_mut(widest) {
            *place = Interval::between(lower, upper);
        }
        half
    }))
}

impl Search<'_> {
    /// Halves boxes until the gap is closed; answers the upper bound.
    fn run(&mut self, effort: Effort) -> f64 {
        let mut stuck = f64::NEG_INFINITY;
        while let Some(node) = self.open.pop() {
            let upper = node.upper.max(stuck);
            if upper - self.best <= effort.tolerance || self.boxes >= effort.boxes {
                return upper;
            }
            match halves(&node.cell, self.domain) {
                Some(halves) => halves.into_iter().for_each(|half| self.look(half)),
                None => stuck = stuck.max(node.upper),
            }
        }
        stuck
    }

    /// Looks at a box, narrows it to a face where the slopes allow, and keeps it if its values may
    /// exceed what is proved.
    fn look(&mut self, mut cell: Vec<Interval>) {
        self.boxes += 1;
        let upper = if self.objective.has_slopes() {
            self.bound_with_slopes(&mut cell)
        } else {
            let upper = self.objective.enclose(&cell, None).upper();
            // A point costs as much as a box and rarely is the best.
            if self.boxes % BOXES_PER_POINT == 1 {
                self.try_point(&middle(&cell));
            }
            upper
        };
        // Boxes that are as good as the best are kept, lest the bound fall below it.
        if upper >= self.best {
            self.open.push(Node { upper, cell });
        }
    }

    fn bound_with_slopes(&mut self, cell: &mut [Interval]) -> f64 {
        let mut slopes = core::mem::take(&mut self.slopes);
        let value = self.objective.enclose(cell, Some(&mut slopes));
        let narrowed = narrow(cell, &slopes);
        let centre = middle(cell);
        let at_centre = self.try_point(&centre);
        let mut spread = at_centre;
        for ((side, slope), &middle) in cell.iter().zip(&slopes).zip(&centre) {
            if !side.is_point() {
                spread = spread + *slope * (*side - Interval::point(middle));
            }
        }
        self.slopes = slopes;
        let upper = value.upper().min(spread.upper());
        if narrowed && upper >= self.best {
            return upper.min(self.objective.enclose(cell, None).upper());
        }
        upper
    }

    /// Encloses the value at a point, and remembers the point if it is the best so far.
    fn try_point(&mut self, point: &[f64]) -> Interval {
        let value = self.objective.enclose(&points(point), None);
        if value.lower() > self.best {
            self.best = value.lower();
            self.at = point.to_vec();
        }
        value
    }
}

/// Leaves of each side along which the values rise or fall throughout only the better end; true if
/// anything was left out.
fn narrow(cell: &mut [Interval], slopes: &[Interval]) -> bool {
    let mut narrowed = false;
    for (side, slope) in cell.iter_mut().zip(slopes) {
        if side.is_point() {
            continue;
        }
        let end = if slope.lower() >= 0.0 {
            side.upper()
        } else if slope.upper() <= 0.0 {
            side.lower()
        } else {
            continue;
        };
        *side = Interval::point(end);
        narrowed = true;
    }
    narrowed
}

/// Shares of a domain in which an objective is surely above and surely below zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Signs {
    pub(super) above: f64,
    pub(super) below: f64,
    /// Share that is neither.
    pub(super) open: f64,
    pub(super) boxes: u64,
}

/// Divides a domain by the sign of an objective; what is left undecided after so many boxes, or
/// once it is no more than the tolerance, stays open.
pub(super) fn signs(objective: &mut dyn Objective, domain: &[Interval], effort: Effort) -> Signs {
    let mut queue = VecDeque::from([(domain.to_vec(), 1.0_f64)]);
    let mut signs = Signs { above: 0.0, below: 0.0, open: 1.0, boxes: 0 };
    while let Some((cell, share)) = queue.pop_front() {
        signs.boxes += 1;
        let value = objective.enclose(&cell, None);
        if value.lower() > 0.0 {
            signs.above += share;
            signs.open -= share;
        } else if value.upper() < 0.0 {
            signs.below += share;
            signs.open -= share;
        } else if signs.boxes < effort.boxes
            && let Some(halves) = halves(&cell, domain)
        {
            queue.extend(halves.map(|half| (half, 0.5 * share)));
        }
        if signs.open <= effort.tolerance || signs.boxes >= effort.boxes {
            break;
        }
    }
    signs
}

/// The magnitude of an objective.
pub(super) struct Magnitude<'a>(pub(super) &'a mut dyn Objective);

impl Objective for Magnitude<'_> {
    fn enclose(&mut self, cell: &[Interval], mut slopes: Option<&mut [Interval]>) -> Interval {
        let value = self.0.enclose(cell, slopes.as_deref_mut());
        for slope in slopes.into_iter().flatten() {
            if value.upper() <= 0.0 {
                *slope = -*slope;
            } else if value.lower() < 0.0 {
                *slope = slope.hull(-*slope);
            }
        }
        Scalar::abs(value)
    }

    fn has_slopes(&self) -> bool {
        self.0.has_slopes()
    }
}
