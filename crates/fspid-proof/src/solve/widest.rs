//! The form whose ellipsoid reaches furthest along some directions, within limits.
//!
//! $$ \min_P \sum_k z_k^T P z_k \quad \text{where} \quad \rho^2 P - M_i^T P M_i \succ 0, \quad P - r_j^T r_j \succ 0 $$
//!
//! so that $z^T P z \le 1$ is kept by every $M_i$ and lies within $|r_j z| \le 1$. Newton's way along the central path, in
//! coordinates in which the present form is the identity.
//!
//! # Source
//! S. Boyd, L. El Ghaoui, E. Feron and V. Balakrishnan, *Linear Matrix Inequalities in System and Control Theory*, SIAM
//! 1994, section 5.1.

use fspid_lti::Matrix;

use super::Effort;
use super::barrier::{Derivatives, Part, barrier, newton_step};
use super::dense::{Dense, add_scaled, dot};
use super::inequality::{Inequality, System};
use super::symmetric::{pack, unpack};

/// Factor of the weight of the objective from one centre to the next.
const HEAVIER: f64 = 6.0;
/// The way ends where the objective can fall by no more than this share of it.
const GAP: f64 = 0.08;
/// Newton steps for one centre.
const STEPS_PER_CENTRE: usize = 12;
/// Centres at most.
const MOST_CENTRES: usize = 40;
/// Newton's decrement at which a point counts as the centre.
const DECREMENT_MIN: f64 = 0.3;
/// Trial steps along a direction, each shorter by [`BACKTRACK`].
const TRIALS: usize = 30;
const BACKTRACK: f64 = 0.6;

/// What is asked for.
pub struct WidestProblem<'a> {
    /// Loops under each of which the form falls.
    pub matrices: &'a [Matrix],
    /// Rows $r_j$, each over its limit.
    pub rows: &'a [Vec<f64>],
    /// $z_k$.
    pub directions: &'a [Vec<f64>],
    /// ρ: how fast the form falls at least.
    pub rate: f64,
}

/// A form that falls, to begin with, becomes the widest; how much of the limits it leaves is up to it. `None` where the
/// form does not fall.
#[must_use]
pub fn widest(problem: &WidestProblem<'_>, form: &Matrix, effort: &Effort) -> Option<Matrix> {
    let mut chart = Chart::of(problem, form)?;
    let degree = chart.degree();
    let mut weight = 1.0 / chart.cost();
    for _ in 0..MOST_CENTRES {
        if (effort.stops)() {
            return None;
        }
        chart.centred(weight)?;
        if degree / weight < GAP * chart.cost() {
            break;
        }
        weight *= HEAVIER;
    }
    chart.form().to_matrix()
}

/// The problem in coordinates y with $x = T y$.
struct Chart {
    matrices: Vec<Dense>,
    rows: Vec<Vec<f64>>,
    directions: Vec<Vec<f64>>,
    /// $\rho^2$.
    level: f64,
    /// $T^{-1}$.
    inverse: Dense,
}

impl Chart {
    fn of(problem: &WidestProblem<'_>, form: &Matrix) -> Option<Self> {
        let form = Dense::from(form);
        let size = form.rows;
        let mut chart = Self {
            matrices: problem.matrices.iter().map(Dense::from).collect(),
            rows: problem.rows.to_vec(),
            directions: problem.directions.to_vec(),
            level: problem.rate * problem.rate,
            inverse: Dense::identity(size),
        };
        chart.accept(&form)?;
        // As large as the rows ask for, and some room.
        let most = chart.rows.iter().map(|row| dot(row, row)).fold(0.0, f64::max);
        chart.accept(&Dense::identity(size).scaled(2.0 * most))?;
        Some(chart)
    }

    /// Changes to coordinates in which a form is the identity.
    fn accept(&mut self, form: &Dense) -> Option<()> {
        let lower = form.cholesky()?;
        let (upper, back) = (lower.transpose(), lower.lower_inverse().transpose());
        for matrix in &mut self.matrices {
            *matrix = upper.times(matrix).times(&back);
        }
        for row in &mut self.rows {
            *row = back.transpose().times_vector(row);
        }
        for direction in &mut self.directions {
            *direction = upper.times_vector(direction);
        }
        self.inverse = upper.times(&self.inverse);
        Some(())
    }

    fn form(&self) -> Dense {
        self.inverse.transpose_times(&self.inverse)
    }

    /// $\sum_k z_k^T P z_k$ at the present form.
    fn cost(&self) -> f64 {
        self.directions.iter().map(|it| dot(it, it)).sum()
    }

    fn degree(&self) -> f64 {
        (self.inverse.rows * (self.matrices.len() + self.rows.len())) as f64
    }

    fn system(&self) -> System {
        let size = self.inverse.rows;
        let only = || vec![(0, 1.0)];
        let falls = self.matrices.iter().map(|it| Inequality::decrease(it, only(), &only()));
        let covers = self.rows.iter().map(|_| Inequality::positive(size, only()));
        let inequalities = falls.chain(covers).collect();
        System { size, matrices: 1, multipliers: 0, inequalities, measures: Vec::new() }
    }

    /// What each inequality comes to at unknowns.
    fn values(&self, system: &System, x: &[f64]) -> Vec<Dense> {
        let mut values: Vec<Dense> =
            system.inequalities.iter().map(|it| system.value(it, x, self.level)).collect();
        for (value, row) in values[self.matrices.len()..].iter_mut().zip(&self.rows) {
            let outer = Dense::from_function(row.len(), row.len(), |i, j| row[i] * row[j]);
            value.add(-1.0, &outer);
        }
        values
    }

    /// Goes to the centre for a weight of the objective.
    fn centred(&mut self, weight: f64) -> Option<()> {
        for _ in 0..STEPS_PER_CENTRE {
            let system = self.system();
            let size = self.inverse.rows;
            let slope = Dense::from_function(size, size, |i, j| {
                self.directions.iter().map(|z| z[i] * z[j]).sum::<f64>()
            });
            let linear: Vec<f64> = pack(&slope).iter().map(|it| weight * it).collect();
            let x = pack(&Dense::identity(size));
            let values = self.values(&system, &x);
            let mut sum = Derivatives::linear(&linear);
            for (inequality, value) in system.inequalities.iter().zip(&values) {
                let inverse = value.cholesky()?.lower_inverse();
                let inverse = inverse.transpose_times(&inverse);
                Part { system: &system, inequality, level: self.level, inverse }.add_to(&mut sum);
            }
            let Some(step) = newton_step(sum) else { return Some(()) };
            let start = barrier(&values)? + dot(&linear, &x);
            let Some(next) = self.moved(&system, &linear, start, &step.direction) else {
                return Some(());
            };
            self.accept(&unpack(&next, self.inverse.rows))?;
            if step.decrement < DECREMENT_MIN {
                break;
            }
        }
        Some(())
    }

    /// The first trial step after which everything holds and the sum has fallen.
    fn moved(&self, system: &System, linear: &[f64], start: f64, by: &[f64]) -> Option<Vec<f64>> {
        let mut length = 1.0;
        for _ in 0..TRIALS {
            let mut x = pack(&Dense::identity(self.inverse.rows));
            add_scaled(&mut x, length, by);
            let sum = barrier(&self.values(system, &x)).map(|it| it + dot(linear, &x));
            if sum.is_some_and(|sum| sum < start) {
                return Some(x);
            }
            length *= BACKTRACK;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of one state that may come to a half either way the widest form is 4, whatever is asked of its decay; of two that
    /// are turned and shrunk, the direction that is not asked for costs nothing.
    #[test]
    fn the_widest_ellipsoid_is_that_of_the_limit() {
        let matrices = [Matrix::from_rows(&[[0.5]]).expect("finite")];
        let (rows, directions) = ([vec![2.0]], [vec![1.0]]);
        let problem =
            WidestProblem { matrices: &matrices, rows: &rows, directions: &directions, rate: 1.0 };
        let start = Matrix::identity(1);
        let found = widest(&problem, &start, &Effort::default()).expect("it falls");
        let form = found.get(0, 0).expect("there");
        assert!(form > 4.0 && form < 4.0 * (1.0 + 2.0 * GAP), "{form}");

        let turned = [Matrix::from_rows(&[[0.6, 0.6], [-0.6, 0.6]]).expect("finite")];
        let (rows, directions) = ([vec![1.0, 0.0]], [vec![1.0, 0.0]]);
        let problem =
            WidestProblem { matrices: &turned, rows: &rows, directions: &directions, rate: 1.0 };
        let found = widest(&problem, &Matrix::identity(2), &Effort::default()).expect("it falls");
        let form = found.get(0, 0).expect("there");
        assert!(form > 1.0 && form < 1.0 + 2.0 * GAP, "{form}");
        // Where the form does not fall there is nothing to begin with.
        let grows = [Matrix::from_rows(&[[1.1, 0.0], [0.0, 0.5]]).expect("finite")];
        let problem = WidestProblem { matrices: &grows, ..problem };
        assert!(widest(&problem, &Matrix::identity(2), &Effort::default()).is_none());
    }
}
