//! The best step by slopes: a quadratic programme within a box about a point.
//!
//! $$ \min_{d, s \ge 0} \ g^T d + \tfrac12 d^T B d + w \sum_k p_k s_k \quad \text{with} \quad
//! c_k + J_k d \le s_k - m, \quad |d_i| \le \Delta, \quad 0 \le x_i + d_i \le 1 $$
//!
//! with the limits $c_k \le 0$ as shares of themselves, what a violation costs $w p_k$, and a margin m, so that what is
//! flown then meets its limits and does not miss them by a rounding.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

use super::rows::Rows;

/// How far within a limit a step aims, as a share of the limit.
const MARGIN: f64 = 5e-4;

/// Where a step begins and what is known there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Question<'a> {
    pub(super) point: &'a [f64],
    pub(super) rows: &'a Rows,
    /// Second derivatives, row by row.
    pub(super) curvature: &'a [f64],
    pub(super) penalty: f64,
    /// The longest step of any coordinate.
    pub(super) radius: f64,
}

/// A step.
#[derive(Clone, Debug)]
pub(super) struct Step {
    pub(super) by: Vec<f64>,
    /// By how much the merit falls if the slopes say all.
    pub(super) predicted: f64,
    /// What each limit holds back, in the order of the rows.
    pub(super) multipliers: Vec<f64>,
}

impl Question<'_> {
    /// The best step; none where the solver finds none.
    pub(super) fn solve(&self) -> Option<Step> {
        let (variables, limits) = (self.point.len(), self.rows.limits.len());
        let shares = self.rows.limits.iter().map(|it| self.penalty * it.share);
        let cost: Vec<f64> = self.rows.cost.iter().copied().chain(shares).collect();
        let (matrix, bounds) = self.constraints();
        let cones = [SupportedConeT::NonnegativeConeT(bounds.len())];
        let squares = self.squares(variables + limits);
        let settings = DefaultSettings {
            verbose: false,
            max_threads: 1,
            direct_solve_method: "qdldl".to_owned(),
            ..DefaultSettings::default()
        };
        let mut solver =
            DefaultSolver::new(&squares, &cost, &matrix, &bounds, &cones, settings).ok()?;
        solver.solve();
        let solution = &solver.solution;
        let is_usable = matches!(
            solution.status,
            SolverStatus::Solved | SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress
        );
        if !is_usable || !solution.x.iter().all(|it| it.is_finite()) {
            return None;
        }
        let ends = self.point.iter().zip(&solution.x);
        let by: Vec<f64> = ends
            .map(|(x, by)| (x + by.clamp(-self.radius, self.radius)).clamp(0.0, 1.0) - x)
            .collect();
        let predicted = self.predicted(&by);
        Some(Step { by, predicted, multipliers: solution.z[..limits].to_vec() })
    }

    fn squares(&self, size: usize) -> CscMatrix<f64> {
        let n = self.point.len();
        let (mut rows, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
        for column in 0..n {
            for row in 0..=column {
                rows.push(row);
                columns.push(column);
                values.push(self.curvature[row * n + column]);
            }
        }
        CscMatrix::new_from_triplets(size, size, rows, columns, values)
    }

    /// Limits, what is beyond them, and the box: $A x \le b$.
    fn constraints(&self) -> (CscMatrix<f64>, Vec<f64>) {
        let (n, limits) = (self.point.len(), &self.rows.limits);
        let (mut rows, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
        let mut bounds = Vec::new();
        let mut put = |row: usize, column: usize, value: f64| {
            rows.push(row);
            columns.push(column);
            values.push(value);
        };
        for (place, limit) in limits.iter().enumerate() {
            limit.slope.iter().enumerate().for_each(|(column, it)| put(place, column, *it));
            put(place, n + place, -1.0);
            bounds.push(-limit.excess - MARGIN);
        }
        for place in 0..limits.len() {
            put(bounds.len(), n + place, -1.0);
            bounds.push(0.0);
        }
        for (column, x) in self.point.iter().enumerate() {
            put(bounds.len(), column, 1.0);
            bounds.push(self.radius.min(1.0 - x));
            put(bounds.len(), column, -1.0);
            bounds.push(self.radius.min(*x));
        }
        let size = (bounds.len(), n + limits.len());
        (CscMatrix::new_from_triplets(size.0, size.1, rows, columns, values), bounds)
    }

    fn predicted(&self, by: &[f64]) -> f64 {
        let n = by.len();
        let curved: f64 =
            (0..n).map(|i| by[i] * dot(&self.curvature[i * n..(i + 1) * n], by)).sum();
        let limits = self.rows.limits.iter().map(|it| {
            let after = it.excess + dot(&it.slope, by);
            self.penalty * it.share * (it.excess.max(0.0) - after.max(0.0))
        });
        limits.sum::<f64>() - dot(&self.rows.cost, by) - 0.5 * curved
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slopes::rows::{Row, Which};

    fn limit(excess: f64, slope: [f64; 2]) -> Row {
        Row { of: Which::Mean(0), excess, slope: slope.to_vec(), share: 1.0 }
    }

    /// Half of (x - 1)² + (y - 1)² around the origin.
    fn bowl(limits: Vec<Row>, radius: f64) -> Step {
        let rows = Rows { cost: vec![-1.0, -1.0], limits, ways_back: 0, analyses: 0 };
        let curvature = [1.0, 0.0, 0.0, 1.0];
        let point = [0.0, 0.5];
        let question =
            Question { point: &point, rows: &rows, curvature: &curvature, penalty: 10.0, radius };
        question.solve().expect("a step")
    }

    #[test]
    fn without_limits_a_step_goes_to_the_bottom_the_side_of_the_cube_or_the_region_s_end() {
        let step = bowl(Vec::new(), 2.0);
        // A gap of 10⁻⁸ at the bottom of a bowl is a distance of 10⁻⁴.
        assert!((step.by[0] - 1.0).abs() < 2e-4 && (step.by[1] - 0.5).abs() < 2e-4, "{step:?}");
        assert!((step.predicted - (0.5 + 0.375)).abs() < 1e-5, "{step:?}");
        let short = bowl(Vec::new(), 0.1);
        assert!(short.by.iter().all(|it| (it - 0.1).abs() < 1e-6), "{short:?}");
    }

    /// On x + y ≤ 0.4 the nearest point to (1, 1) is (0.2, 0.2), which is held back by 0.8.
    #[test]
    fn a_limit_is_met_with_a_margin_and_tells_what_it_holds_back() {
        let step = bowl(vec![limit(-0.4, [1.0, 1.0])], 2.0);
        let sum = step.by[0] + step.by[1];
        assert!(sum < 0.4 - 0.9 * MARGIN && sum > 0.4 - 1.1 * MARGIN, "{step:?}");
        assert!((step.multipliers[0] - 0.8).abs() < 1e-3, "{step:?}");
    }

    /// x ≤ -1 cannot be met within 0.1, and is come nearer to because a violation costs ten times the cost's slope.
    #[test]
    fn a_limit_that_is_out_of_reach_is_come_nearer_to() {
        let rows =
            Rows { cost: vec![-1.0, 0.0], limits: vec![limit(1.0, [1.0, 0.0])], ..Rows::default() };
        let point = [0.5, 0.5];
        let curvature = [0.0; 4];
        let question = Question {
            point: &point,
            rows: &rows,
            curvature: &curvature,
            penalty: 10.0,
            radius: 0.1,
        };
        let step = question.solve().expect("a step");
        assert!((step.by[0] + 0.1).abs() < 1e-6, "{step:?}");
        assert!((step.predicted - 0.9).abs() < 1e-4, "{step:?}");
    }
}
