//! Newton's method for a trim, within ranges of the unknowns or without.

use fspid_lti::Matrix;

use super::{TrimPoint, TrimResidual, TrimTarget};
use crate::aerodynamics::ForceModel;
use crate::aircraft::Aircraft;
use crate::validity::Range;

/// Iterations after which a search gives up; from any start that works it takes fewer than ten.
const ITERATIONS_MAX: usize = 60;

/// Smallest part of a Newton step that is tried.
const DAMPING_MIN: f64 = 1e-6;

/// Where a search is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Search {
    /// What was asked; of a glide with the path that was found.
    pub(super) target: TrimTarget,
    pub(super) point: TrimPoint,
    pub(super) residual: TrimResidual,
    pub(super) iterations: usize,
}

impl<M: ForceModel> Aircraft<M> {
    /// Newton's method within ranges of the unknowns, from the middle of them.
    pub(super) fn search(&self, target: TrimTarget, limits: [Range; 3]) -> Search {
        let throttle = Range { min: limits[2].min.max(0.0), max: limits[2].max.min(2.0) };
        let third = if self.model().has_engine() {
            0.5 * (throttle.min + throttle.max)
        } else {
            target.flight_path_rad
        };
        let start = [0.0, 0.0, third];
        let mut found = self.found(target, clamped(start, &limits), 0);
        while !found.residual.accepted() && found.iterations < ITERATIONS_MAX {
            let Some(next) = self.newton_step(target, &found, &limits) else { break };
            found = next;
        }
        found
    }

    fn found(&self, target: TrimTarget, unknowns: [f64; 3], iterations: usize) -> Search {
        let (target, point) = self.meant(target, unknowns);
        Search { target, point, residual: self.trim_residual(target, point), iterations }
    }

    /// What the unknowns mean: the third is the throttle, without an engine the flight path.
    fn meant(&self, target: TrimTarget, unknowns: [f64; 3]) -> (TrimTarget, TrimPoint) {
        if self.model().has_engine() {
            return (target, TrimPoint::from_array(unknowns));
        }
        let [alpha_rad, elevator_rad, flight_path_rad] = unknowns;
        let point = TrimPoint { alpha_rad, elevator_rad, throttle: 0.0 };
        (TrimTarget { flight_path_rad, ..target }, point)
    }

    /// The unknowns of a search.
    fn unknowns(&self, search: &Search) -> [f64; 3] {
        let [alpha, elevator, throttle] = search.point.to_array();
        let path = search.target.flight_path_rad;
        [alpha, elevator, if self.model().has_engine() { throttle } else { path }]
    }

    /// The next point, if there is a step that helps.
    fn newton_step(
        &self,
        target: TrimTarget,
        from: &Search,
        limits: &[Range; 3],
    ) -> Option<Search> {
        let step = self.newton_direction(target, from)?;
        let mut part = 1.0;
        while part >= DAMPING_MIN {
            let mut point = self.unknowns(from);
            for (value, step) in point.iter_mut().zip(&step) {
                *value += part * step;
            }
            let next = self.found(target, clamped(point, limits), from.iterations + 1);
            if next.residual.size() < (1.0 - 1e-4 * part) * from.residual.size() {
                return Some(next);
            }
            part *= 0.5;
        }
        None
    }

    fn newton_direction(&self, target: TrimTarget, from: &Search) -> Option<[f64; 3]> {
        let mut jacobian = Matrix::zeros(3, 3);
        for column in 0..3 {
            let (ahead, behind) =
                (self.beside(target, from, column, 1.0), self.beside(target, from, column, -1.0));
            let span = 2.0 * step_size(self.unknowns(from)[column]);
            for row in 0..3 {
                jacobian.set(row, column, (ahead[row] - behind[row]) / span).ok()?;
            }
        }
        let rest = from.residual.to_array().map(|value| [-value]);
        let step = jacobian.solve(&Matrix::from_rows(&rest).ok()?).ok()?;
        step.data().try_into().ok()
    }

    /// Residual a small step beside a point in one unknown.
    fn beside(&self, target: TrimTarget, from: &Search, column: usize, sign: f64) -> [f64; 3] {
        let mut unknowns = self.unknowns(from);
        unknowns[column] += sign * step_size(unknowns[column]);
        let (target, point) = self.meant(target, unknowns);
        self.trim_residual(target, point).to_array()
    }
}

pub(super) fn step_size(value: f64) -> f64 {
    1e-5 * value.abs().max(1.0)
}

fn clamped(point: [f64; 3], limits: &[Range; 3]) -> [f64; 3] {
    let [alpha, elevator, throttle] = point;
    [limits[0].clamp(alpha), limits[1].clamp(elevator), limits[2].clamp(throttle)]
}
