//! Downhill with each limit by itself: sequential quadratic programmes within a region of trust, as plain data.
//!
//! The merit of a descent has a corner at each limit that binds. Here the slope of each limit is known, so that a step goes
//! along all of them at once ([`programme`](super::programme)); it is taken if the merit
//! falls by a part of what was predicted, and the region grows or shrinks by how well that was. Curvature is learned of the
//! cost with what its limits hold back (Broyden, Fletcher, Goldfarb, Shanno, damped by Powell).
//!
//! # Source
//! J. Nocedal, S. J. Wright, *Numerical Optimization*, 2nd ed., Springer 2006: sections 18.3 (damped update, 18.14 to 18.16)
//! and 18.5 (an exact penalty with elastic limits, and a region of trust).

use fspid_optimise::Bfgs;
use serde::{Deserialize, Serialize};

use super::programme::{Question, dot};
use super::rows::{Rows, Which};
use super::{Counted, Differentiable, Merit};
use crate::score::FlightScore;

/// What breaking a limit by all of itself costs, as a multiple of the start's cost.
const PENALTY: f64 = 30.0;
/// The region of trust: at first, at most, and where a descent is over; of the cube.
const FIRST: f64 = 0.03;
const LARGEST: f64 = 0.2;
const SMALLEST: f64 = 2e-5;
/// A step is taken from this part of what was predicted on; the region shrinks below the second and grows above the third.
const TAKEN: f64 = 0.05;
const POOR: f64 = 0.25;
const GOOD: f64 = 0.7;
/// A descent is over when so many steps in a row save less than this share of the merit.
const PATIENCE: u32 = 5;
const SAVES: f64 = 1e-5;
/// How far from the best candidate a later descent begins, as a share of the cube: each of them in turn.
const SPREADS: [f64; 3] = [0.02, 0.05, 0.1];
/// How far from the best candidate the last ones lie, for which slopes would cost more than is left.
const LAST_SPREAD: f64 = 1e-3;

/// Where a descent stands.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Here {
    point: Vec<f64>,
    merit: f64,
    flights: Vec<FlightScore>,
    /// Found anew by whoever goes on with a saved search, to the same bits.
    #[serde(skip)]
    rows: Option<Rows>,
    /// Whether they were counted.
    is_counted: bool,
}

/// A step that was taken, from which curvature is learned once the slopes behind it are known.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Taken {
    by: Vec<f64>,
    cost: Vec<f64>,
    /// Limits that held it back, how much, and their slopes.
    held: Vec<(Which, f64, Vec<f64>)>,
}

/// A candidate on its way.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Asked {
    point: Vec<f64>,
    predicted: f64,
    taken: Taken,
}

/// A search by sequential quadratic programmes.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Sequential {
    here: Option<Here>,
    /// Where the next descent begins, until its first candidate is told.
    first: Vec<f64>,
    asked: Option<Asked>,
    taken: Option<Taken>,
    radius: f64,
    penalty: Option<f64>,
    curvature: Vec<f64>,
    is_learned: bool,
    idle: u32,
    seed: u64,
    anywhere: bool,
    counted: Counted,
}

impl Sequential {
    pub(crate) fn new(start: &[f64], seed: u64, anywhere: bool) -> Self {
        let first = if anywhere { Bfgs::anywhere(start.len(), seed, 0) } else { start.to_vec() };
        Self {
            here: None,
            first,
            asked: None,
            taken: None,
            radius: FIRST,
            penalty: None,
            curvature: vec![0.0; start.len() * start.len()],
            is_learned: false,
            idle: 0,
            seed,
            anywhere,
            counted: Counted { descents: 1, ..Counted::default() },
        }
    }

    pub(crate) fn counted(&self) -> Counted {
        self.counted
    }

    /// True for a state that a search over so many coordinates can have been in.
    pub(crate) fn is_sound(&self, dimension: usize) -> bool {
        let in_cube = |point: &[f64]| {
            point.len() == dimension && point.iter().all(|x| (0.0..=1.0).contains(x))
        };
        let finite = |it: &[f64]| it.len() == dimension && it.iter().all(|x| x.is_finite());
        let taken = |it: &Taken| {
            finite(&it.by)
                && finite(&it.cost)
                && it.held.iter().all(|(_, by, slope)| by.is_finite() && finite(slope))
        };
        in_cube(&self.first)
            && self.here.as_ref().is_none_or(|it| in_cube(&it.point) && it.merit.is_finite())
            && self.asked.as_ref().is_none_or(|it| in_cube(&it.point) && taken(&it.taken))
            && self.taken.as_ref().is_none_or(taken)
            && self.radius.is_finite()
            && self.radius > 0.0
            && self.penalty.is_none_or(|it| it.is_finite() && it > 0.0)
            && self.curvature.len() == dimension * dimension
            && self.curvature.iter().all(|it| it.is_finite())
            && self.counted.is_sound()
    }

    /// What breaking a limit by all of itself costs; by the cost of the first candidate if none was flown.
    pub(crate) fn penalty(&self, cost: f64) -> f64 {
        let size = if cost.is_finite() { cost.abs().max(1e-9) } else { 1.0 };
        self.penalty.unwrap_or(PENALTY * size)
    }

    /// True where the slopes of all limits have to be paid for before the next candidate is known. Those that a saved
    /// search finds anew were.
    pub(crate) fn wants_slopes(&self) -> bool {
        self.asked.is_none() && self.here.as_ref().is_some_and(|it| !it.is_counted)
    }

    /// A candidate near the best one, for what is left of a budget that holds no more slopes.
    pub(crate) fn without_slopes(&self, best: &[f64], number: u64) -> Vec<f64> {
        Bfgs::near(best, LAST_SPREAD, self.seed, number)
    }

    /// The next candidate, the same until it is told; `best` is the best one so far.
    pub(crate) fn ask(&mut self, slopes: &Differentiable<'_>, best: &[f64]) -> Vec<f64> {
        loop {
            if let Some(asked) = &self.asked {
                return asked.point.clone();
            }
            if self.here.is_none() {
                return self.first.clone();
            }
            if self.find_rows(slopes).is_none() || !self.aim() {
                self.begin_again(best);
            }
        }
    }

    /// Takes what the candidate that was asked for is worth.
    pub(crate) fn tell(
        &mut self,
        merit: &Merit,
        penalty: f64,
        flights: &[FlightScore],
        best: &[f64],
    ) {
        if merit.value.is_finite() {
            self.penalty.get_or_insert(penalty);
        }
        let place = |point: Vec<f64>| Here {
            point,
            merit: merit.value,
            flights: flights.to_vec(),
            rows: None,
            is_counted: false,
        };
        let (Some(here), Some(asked)) = (&self.here, self.asked.take()) else {
            match merit.value.is_finite() {
                true => self.here = Some(place(self.first.clone())),
                false => self.begin_again(best),
            }
            return;
        };
        let saved = here.merit - merit.value;
        let share = saved / asked.predicted;
        let length = asked.taken.by.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
        self.idle = if saved > SAVES * here.merit.abs() { 0 } else { self.idle + 1 };
        if share > TAKEN {
            self.here = Some(place(asked.point));
            self.taken = Some(asked.taken);
        }
        // Written so that a candidate that is lost is a poor one.
        if !(share >= POOR) {
            self.radius = 0.4 * length;
        } else if share > GOOD && length > 0.9 * self.radius {
            self.radius = LARGEST.min(2.0 * self.radius);
        }
        if self.idle >= PATIENCE && share > TAKEN || !(self.radius > SMALLEST) {
            self.begin_again(best);
        }
    }

    /// The slopes where it stands, and the curvature that they tell.
    fn find_rows(&mut self, slopes: &Differentiable<'_>) -> Option<()> {
        let here = self.here.as_mut()?;
        if here.rows.is_some() {
            return Some(());
        }
        let weights = slopes.merit(&here.flights, 0.0).weights;
        let rows = slopes.rows(&here.point, &here.flights, &weights)?;
        if !here.is_counted {
            self.counted.slopes += rows.ways_back;
            self.counted.analyses += rows.analyses;
            here.is_counted = true;
        }
        let taken = self.taken.take();
        let learned = taken.map(|taken| (change_of_slope(&taken, &rows), taken.by));
        here.rows = Some(rows);
        if let Some((change, by)) = learned {
            self.learn(&by, &change);
        }
        Some(())
    }

    /// Asks for the best step within the region; false where there is none.
    fn aim(&mut self) -> bool {
        let Some(Here { point, rows: Some(rows), .. }) = &self.here else { return false };
        let penalty = self.penalty.unwrap_or(PENALTY);
        let (curvature, radius) = (self.curvature.as_slice(), self.radius);
        let Some(step) = Question { point, rows, curvature, penalty, radius }.solve() else {
            return false;
        };
        if !(step.predicted > 1e-9 * rows.size(penalty)) {
            return false;
        }
        let limits = rows.limits.iter().zip(&step.multipliers);
        let held = limits.filter(|(_, by)| **by > 0.0);
        let held = held.map(|(row, by)| (row.of, *by, row.slope.clone())).collect();
        let ahead = point.iter().zip(&step.by).map(|(x, by)| (x + by).clamp(0.0, 1.0));
        self.asked = Some(Asked {
            point: ahead.collect(),
            predicted: step.predicted,
            taken: Taken { by: step.by, cost: rows.cost.clone(), held },
        });
        true
    }

    /// $B \leftarrow B - B s s^T B / s^T B s + r r^T / s^T r$ with $r = \theta y + (1 - \theta) B s$, so that B stays positive.
    fn learn(&mut self, s: &[f64], y: &[f64]) {
        let n = s.len();
        let (sy, yy) = (dot(s, y), dot(y, y));
        if !self.is_learned {
            let size = yy / sy.abs();
            if !(size.is_finite() && size > 0.0) {
                return;
            }
            (0..n).for_each(|i| self.curvature[i * n + i] = size);
            self.is_learned = true;
        }
        let bs: Vec<f64> = self.curvature.chunks_exact(n).map(|row| dot(row, s)).collect();
        let sbs = dot(s, &bs);
        let theta = if sy >= 0.2 * sbs { 1.0 } else { 0.8 * sbs / (sbs - sy) };
        let r: Vec<f64> = y.iter().zip(&bs).map(|(y, bs)| theta * y + (1.0 - theta) * bs).collect();
        let sr = dot(s, &r);
        if !(sbs > 0.0 && sr > 0.0 && theta.is_finite()) {
            return;
        }
        for (i, row) in self.curvature.chunks_exact_mut(n).enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry += r[i] * r[j] / sr - bs[i] * bs[j] / sbs;
            }
        }
    }

    /// From near the best candidate so far, or from anywhere where the search began anywhere.
    fn begin_again(&mut self, best: &[f64]) {
        let number = self.counted.descents as u64;
        let spread = SPREADS[self.counted.descents % SPREADS.len()];
        let first = match self.anywhere {
            true => Bfgs::anywhere(best.len(), self.seed, number),
            false => Bfgs::near(best, spread, self.seed, number),
        };
        let mut counted = self.counted;
        counted.descents += 1;
        let penalty = self.penalty;
        *self = Self { first, penalty, counted, ..Self::new(best, self.seed, self.anywhere) };
    }
}

impl Rows {
    /// Of what size merits are here, for what counts as nothing.
    fn size(&self, penalty: f64) -> f64 {
        let slope = self.cost.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
        slope.max(penalty * 1e-3)
    }
}

/// What a step changed of the slope of the cost with what its limits hold back: of limits that are known at both ends.
fn change_of_slope(taken: &Taken, rows: &Rows) -> Vec<f64> {
    let mut change: Vec<f64> =
        rows.cost.iter().zip(&taken.cost).map(|(after, before)| after - before).collect();
    for (of, by, before) in &taken.held {
        let Some(row) = rows.limits.iter().find(|it| it.of == *of) else { continue };
        for ((change, after), before) in change.iter_mut().zip(&row.slope).zip(before) {
            *change += by * (after - before);
        }
    }
    change
}
