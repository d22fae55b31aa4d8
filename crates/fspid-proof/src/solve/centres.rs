//! The method of centres: lowers the level at which all inequalities hold, from centre to centre.
//!
//! At a high enough level $\lambda$ any positive definite form satisfies $\lambda P - M^T P M \succ 0$. From the
//! centre of that set the level can fall to the bound where the first difference becomes singular; a
//! level a little above the bound has a centre of its own, and so on. Every point on the way satisfies
//! its inequalities strictly, so that the search may stop anywhere.
//!
//! # Source
//! S. Boyd and L. El Ghaoui, Method of centers for minimizing generalized eigenvalues, Linear Algebra
//! and its Applications 188 (1993) 63.

use super::Effort;
use super::barrier::centre;
use super::inequality::{Inequality, System};
use super::symmetric::Spectrum;

/// Part of the way from the bound back to the old level at which the new level lies.
const STEP_BACK: f64 = 0.2;
/// Newton steps for one centre on the way; a good level needs two to five.
const STEPS_PER_CENTRE: usize = 12;
/// The level can hardly fall further than this many times its distance from the bound.
///
/// At a centre the distance shrinks with the distance from the lowest level, by a factor that the number
/// of inequalities bounds above and that is far smaller in practice.
const REACH: f64 = 200.0;
/// The lowest level counts as found when it can only fall by this part of the decay.
const LOWEST_TOLERANCE: f64 = 0.02;
/// A level that is a size is given back so much of itself: half of it of the gain, whose square it is.
const SMALLEST_TOLERANCE: f64 = 0.01;
/// Decay below which no difference is made.
const DECAY_MIN: f64 = 1e-10;
/// Part of the decay that is given back, so that the form lies inside and not on the edge.
const GIVEN_BACK: f64 = 0.1;
/// Centres at the end, each with half the room that is left.
const DEEPENINGS: usize = 3;
/// Highest level tried for a start: the form at the start may be this far from falling.
const LEVEL_MAX: f64 = 1e12;

/// A problem in coordinates that follow its solution.
pub(super) trait Chart {
    /// Inequalities in the present coordinates.
    fn system(&self) -> System;
    /// Unknowns in the present coordinates.
    fn point(&self) -> Vec<f64>;
    /// Takes new unknowns and may change to coordinates in which they are near one.
    fn accept(&mut self, x: &[f64]);
}

/// How low the level should go.
#[derive(Debug, Clone, Copy)]
pub(super) enum Goal {
    /// Down to this level, and then to the centre of the set, where rounding harms least.
    Below(f64),
    /// As low as possible, then a little back up, where the inequalities hold with room for rounding.
    Lowest,
    /// As low as possible where the level is a size of its own, and nothing of it is near 1.
    Smallest {
        /// The pessimistic reach is this part of the level where it counts as found; in practice it falls by far less.
        reach: f64,
    },
}

/// Where the way down ended.
#[derive(Debug, Clone, Copy)]
pub(super) struct Descent {
    /// Lowest level at which the unknowns reached satisfy the inequalities.
    pub(super) bound: f64,
    pub(super) steps: usize,
}

/// Goes down from the chart's point. `None` when it satisfies the inequalities at no level.
pub(super) fn descend(chart: &mut impl Chart, goal: Goal, effort: &Effort) -> Option<Descent> {
    let mut bound = starting_bound(&chart.system(), &chart.point())?;
    let mut level = bound + 0.5 * bound.abs();
    let mut steps = 0;
    while steps < effort.newton_steps && !is_done(goal, level, bound) {
        if (effort.stops)() {
            return None;
        }
        let (reached, taken) = centred(chart, level, STEPS_PER_CENTRE)?;
        steps += taken;
        bound = reached;
        level = bound + STEP_BACK * (level - bound);
    }
    let target = match goal {
        Goal::Below(target) => target,
        Goal::Lowest => bound + GIVEN_BACK * (1.0 - bound).abs(),
        Goal::Smallest { .. } => bound + SMALLEST_TOLERANCE * bound.abs(),
    };
    if bound < target {
        for _ in 0..DEEPENINGS {
            if (effort.stops)() {
                return None;
            }
            let (reached, taken) = centred(chart, 0.5 * (target + bound), STEPS_PER_CENTRE)?;
            steps += taken;
            bound = reached;
        }
    }
    Some(Descent { bound, steps })
}

fn is_done(goal: Goal, level: f64, bound: f64) -> bool {
    // `level` is already the next one: the distance at the centre was larger.
    let reach = REACH * (level - bound) / STEP_BACK;
    match goal {
        Goal::Below(target) => bound < target || reach < bound - target,
        Goal::Lowest => reach < LOWEST_TOLERANCE * (1.0 - bound).abs().max(DECAY_MIN),
        Goal::Smallest { reach: enough } => reach < enough * bound.abs(),
    }
}

/// Centres at a level and changes coordinates; the bound there, and Newton's steps.
fn centred(chart: &mut impl Chart, level: f64, steps_max: usize) -> Option<(f64, usize)> {
    let system = chart.system();
    let centre = centre(&system, level, &chart.point(), steps_max)?;
    let bound = level - rated_room(&system, &centre.x, level)?;
    chart.accept(&centre.x);
    Some((bound, centre.steps))
}

/// Bound of a point whose inequalities hold at some level.
fn starting_bound(system: &System, x: &[f64]) -> Option<f64> {
    let mut level = 1.0;
    while level < LEVEL_MAX {
        if let Some(room) = rated_room(system, x, level) {
            return Some(level - room);
        }
        level *= 2.0;
    }
    None
}

/// How far the level may fall before the first inequality becomes singular; `None` when one does not hold.
pub(super) fn rated_room(system: &System, x: &[f64], level: f64) -> Option<f64> {
    let mut least = f64::INFINITY;
    for inequality in &system.inequalities {
        least = least.min(room_of(system, inequality, x, level)?);
    }
    (least > 0.0 && least.is_finite()).then_some(least)
}

fn room_of(system: &System, inequality: &Inequality, x: &[f64], level: f64) -> Option<f64> {
    let lower = system.value(inequality, x, level).cholesky()?;
    let Some(rated) = system.rated_part(inequality, x) else { return Some(f64::INFINITY) };
    let share = rated.congruence(&lower.lower_inverse().transpose());
    Some(1.0 / Spectrum::of(&share).largest())
}
