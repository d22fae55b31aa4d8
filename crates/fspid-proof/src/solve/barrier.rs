//! The logarithmic barrier of a system of inequalities and Newton's way to its minimum.
//!
//! $$ f(x) = -\sum_i \log \det F_i(x) + c^T x $$
//!
//! is finite only where all inequalities hold, and its minimum lies well inside. Newton's method does not
//! feel the units of the unknowns or of the inequalities: that is why slow loops, whose differences are
//! 10⁻⁵ of the form itself, need no scaling of their own.
//!
//! # Source
//! S. Boyd and L. Vandenberghe, Convex Optimization, Cambridge University Press 2004, sections 9.5, 9.6
//! and 11.6; Yu. Nesterov and A. Nemirovskii, Interior-Point Polynomial Algorithms, SIAM 1994.

use core::f64::consts::SQRT_2;

use super::dense::{Dense, add_scaled, dot};
use super::inequality::{Form, Inequality, System};
use super::symmetric::{pack, solve_definite};

/// Newton's decrement at which a point counts as the centre: within it the full step squares the error.
const DECREMENT_MIN: f64 = 0.2;
/// Part of the slope that a step must bring down.
const SLOPE_PART: f64 = 1e-4;
/// Factor from one trial step to the next.
const BACKTRACK: f64 = 0.6;
/// Trial steps before the direction is given up as rounding noise.
const TRIALS_MAX: usize = 30;
/// Additions to the diagonal, relative to it, when rounding has spoilt the second derivatives.
const REPAIRS: [f64; 4] = [0.0, 1e-14, 1e-11, 1e-8];

/// First and second derivatives; of the second only the upper triangle.
pub(super) struct Derivatives {
    gradient: Vec<f64>,
    hessian: Dense,
}

impl Derivatives {
    /// Those of a linear function.
    pub(super) fn linear(slope: &[f64]) -> Self {
        let count = slope.len();
        Self { gradient: slope.to_vec(), hessian: Dense::zeros(count, count) }
    }
}

/// Derivatives at unknowns where all inequalities hold; `None` elsewhere.
fn derivatives(system: &System, level: f64, x: &[f64], linear: &[f64]) -> Option<Derivatives> {
    let mut sum = Derivatives::linear(linear);
    for inequality in &system.inequalities {
        let inverse = system.value(inequality, x, level).cholesky()?.lower_inverse();
        let inverse = inverse.transpose_times(&inverse);
        Part { system, inequality, level, inverse }.add_to(&mut sum);
    }
    Some(sum)
}

/// What one inequality adds; Z is its inverse.
pub(super) struct Part<'a> {
    pub(super) system: &'a System,
    pub(super) inequality: &'a Inequality,
    pub(super) level: f64,
    pub(super) inverse: Dense,
}

impl Part<'_> {
    fn scale(&self, form: &Form) -> f64 {
        if form.rated { self.level } else { 1.0 }
    }

    pub(super) fn add_to(&self, sum: &mut Derivatives) {
        for form in &self.inequality.forms {
            let after = form.factor.after(&self.inverse);
            self.add_slope(form, &form.factor.before(&after), &mut sum.gradient);
            for other in &self.inequality.forms {
                // From this term's unknown to the other's: B' = W' Z U.
                let b = other.factor.before(&after).transpose();
                self.add_curvature(form, other, &b, &mut sum.hessian);
            }
        }
        let multiplied = self.multiplied();
        for (number, matrix) in &multiplied {
            self.add_multiplier(*number, matrix, &multiplied, sum);
        }
    }

    /// Numbers of multipliers, each with the matrix that it multiplies at this level.
    fn multiplied(&self) -> Vec<(usize, Dense)> {
        let plain = self.inequality.multipliers.iter().cloned();
        let rated = self.inequality.rated_multipliers.iter();
        plain.chain(rated.map(|(number, matrix)| (*number, matrix.scaled(self.level)))).collect()
    }

    /// $-s w_j \operatorname{tr}(U^T Z U X_j)$.
    fn add_slope(&self, form: &Form, turned: &Dense, gradient: &mut [f64]) {
        let slope = pack(turned);
        for &(number, weight) in &form.weights {
            let place = self.system.matrix_place(number);
            add_scaled(&mut gradient[place], -self.scale(form) * weight, &slope);
        }
    }

    /// $\operatorname{tr}(X B Y B^T)$ with $B = U^T Z W$ for two terms in X and Y.
    fn add_curvature(&self, form: &Form, other: &Form, b: &Dense, hessian: &mut Dense) {
        let scale = self.scale(form) * self.scale(other);
        let mut line = Vec::new();
        let mut entry = 0;
        for p in 0..b.rows {
            for q in p..b.rows {
                kronecker_row(b, p, q, &mut line);
                for &(number, weight) in &form.weights {
                    let row = self.system.matrix_place(number).start + entry;
                    // Only the upper triangle is read.
                    for &(next, more) in other.weights.iter().filter(|to| to.0 >= number) {
                        let place = self.system.matrix_place(next);
                        let target = &mut hessian.row_mut(row)[place];
                        add_scaled(target, scale * weight * more, &line);
                    }
                }
                entry += 1;
            }
        }
    }

    fn add_multiplier(
        &self,
        number: usize,
        matrix: &Dense,
        multiplied: &[(usize, Dense)],
        sum: &mut Derivatives,
    ) {
        let column = self.system.multiplier_place(number);
        sum.gradient[column] -= self.inverse.inner(matrix);
        let turned = matrix.congruence(&self.inverse);
        for form in &self.inequality.forms {
            let slope = pack(&form.factor.before(&form.factor.after(&turned)));
            for &(number, weight) in &form.weights {
                let start = self.system.matrix_place(number).start;
                for (entry, value) in slope.iter().enumerate() {
                    sum.hessian[(start + entry, column)] += self.scale(form) * weight * value;
                }
            }
        }
        for (number, other) in multiplied {
            sum.hessian[(column, self.system.multiplier_place(*number))] += turned.inner(other);
        }
    }
}

/// One row of the quadratic form tr(X B Y B') in packed entries: that of the entry (p, q) of X.
fn kronecker_row(b: &Dense, p: usize, q: usize, line: &mut Vec<f64>) {
    let (first, second) = (b.row(p), b.row(q));
    line.clear();
    for r in 0..b.columns {
        if p == q {
            line.push(first[r] * first[r]);
            let factor = SQRT_2 * first[r];
            line.extend(first[r + 1..].iter().map(|value| factor * value));
        } else {
            line.push(SQRT_2 * first[r] * second[r]);
            let (left, right) = (first[r], second[r]);
            let pairs = first[r + 1..].iter().zip(&second[r + 1..]);
            line.extend(pairs.map(|(first, second)| left * second + first * right));
        }
    }
}

/// Slope of the linear term that keeps the size of the unknowns: the measures at their present values.
///
/// $$ c^T x = \kappa \sum_m \operatorname{tr} \bigl( N_m(x_0)^{-1} N_m(x) \bigr) $$
///
/// with the factor for which the barrier has no slope along x itself. `None` when a measure is not
/// positive definite.
pub(super) fn linear_term(system: &System, x: &[f64]) -> Option<Vec<f64>> {
    let mut linear = vec![0.0; system.len()];
    let mut degree = 0.0;
    for measure in &system.measures {
        let inverse = system.weighted(&measure.weights, x).cholesky()?.lower_inverse();
        let slope = pack(&inverse.transpose_times(&inverse));
        degree += measure.multiplicity * inverse.rows as f64;
        for &(unknown, weight) in &measure.weights {
            add_scaled(
                &mut linear[system.matrix_place(unknown)],
                measure.multiplicity * weight,
                &slope,
            );
        }
    }
    let scale = system.degree() / degree;
    linear.iter_mut().for_each(|value| *value *= scale);
    Some(linear)
}

/// Where Newton's method ended.
pub(super) struct Centre {
    pub(super) x: Vec<f64>,
    pub(super) steps: usize,
}

/// Goes from unknowns where all inequalities hold towards the minimum of the barrier.
///
/// The size of the unknowns is kept near that of the start. `None` when they do not hold at the start.
pub(super) fn centre(system: &System, level: f64, x: &[f64], steps_max: usize) -> Option<Centre> {
    let linear = linear_term(system, x)?;
    let mut centre = Centre { x: x.to_vec(), steps: 0 };
    while centre.steps < steps_max {
        let Some(step) = newton_step(derivatives(system, level, &centre.x, &linear)?) else {
            break;
        };
        centre.steps += 1;
        let Some(length) = step_length(system, level, &centre.x, &linear, &step) else { break };
        add_scaled(&mut centre.x, length, &step.direction);
        if step.decrement < DECREMENT_MIN {
            break;
        }
    }
    Some(centre)
}

pub(super) struct Step {
    pub(super) direction: Vec<f64>,
    /// Square root of the first derivative along the direction.
    pub(super) decrement: f64,
}

pub(super) fn newton_step(mut at: Derivatives) -> Option<Step> {
    let right: Vec<f64> = at.gradient.iter().map(|value| -value).collect();
    let diagonal: Vec<f64> = (0..right.len()).map(|i| at.hessian[(i, i)]).collect();
    // Entries of very different size become comparable: ones on the diagonal.
    let scale: Vec<f64> = diagonal.iter().map(|value| 1.0 / value.sqrt()).collect();
    for row in 0..right.len() {
        for column in row..right.len() {
            at.hessian[(row, column)] *= scale[row] * scale[column];
        }
    }
    let scaled: Vec<f64> = right.iter().zip(&scale).map(|(value, scale)| value * scale).collect();
    let direction = REPAIRS.iter().find_map(|repair| {
        let mut matrix = at.hessian.clone();
        (0..right.len()).for_each(|i| matrix[(i, i)] += repair);
        solve_definite(&mut matrix, &scaled)
    })?;
    let direction: Vec<f64> =
        direction.iter().zip(&scale).map(|(value, scale)| value * scale).collect();
    let slope = dot(&direction, &right);
    (slope >= 0.0).then(|| Step { direction, decrement: slope.sqrt() })
}

/// Largest trial step after which all inequalities hold and the barrier has fallen enough.
fn step_length(system: &System, level: f64, x: &[f64], linear: &[f64], step: &Step) -> Option<f64> {
    let values = |x: &[f64]| -> Vec<Dense> {
        system.inequalities.iter().map(|inequality| system.value(inequality, x, level)).collect()
    };
    let (at, change) = (values(x), values(&step.direction));
    let start = barrier(&at)?;
    let slope = dot(linear, &step.direction);
    let mut length = 1.0;
    for _ in 0..TRIALS_MAX {
        let trial: Vec<Dense> =
            at.iter().zip(&change).map(|(at, change)| at.plus(length, change)).collect();
        let least = SLOPE_PART * length * step.decrement * step.decrement;
        // Within rounding of the minimum the sum itself no longer tells up from down.
        let noise = 1e-12 * start.abs();
        if barrier(&trial).is_some_and(|end| end + length * slope - start <= noise - least) {
            return Some(length);
        }
        length *= BACKTRACK;
    }
    None
}

/// Minus the sum of the logarithms of the determinants; `None` unless all matrices are positive definite.
pub(super) fn barrier(values: &[Dense]) -> Option<f64> {
    let mut sum = 0.0;
    for value in values {
        let lower = value.cholesky()?;
        sum -= (0..lower.rows).fold(0.0, |sum, i| sum + 2.0 * libm::log(lower[(i, i)]));
    }
    Some(sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::inequality::{Factor, Measure};

    /// Every kind of term, twice over, at unknowns where the inequality holds.
    fn example() -> (System, Vec<f64>) {
        let factor = |seed: usize| {
            Factor::Matrix(Dense::from_function(4, 2, |i, j| {
                ((i * 7 + j * 5 + seed) % 11) as f64 * 0.1
            }))
        };
        let inequality = |seed: usize| {
            let forms = [(true, vec![(0, 1.0), (1, 0.5)]), (false, vec![(0, -0.05), (1, 0.2)])];
            let forms = forms.into_iter().enumerate().map(|(number, (rated, weights))| Form {
                factor: factor(seed + 3 * number),
                rated,
                weights,
            });
            let multiplied = |i: usize, j: usize| if i == j { 1.0 } else { 0.1 * seed as f64 };
            let multipliers = vec![
                (0, Dense::from_function(4, 4, multiplied)),
                (1, Dense::identity(4).scaled(-0.1)),
            ];
            let rated_multipliers = vec![(1, Dense::identity(4).scaled(0.02))];
            Inequality { size: 4, forms: forms.collect(), multipliers, rated_multipliers }
        };
        let mut inequalities = vec![inequality(1), inequality(2)];
        inequalities.push(Inequality::positive(2, vec![(0, 1.0), (1, 0.1)]));
        let measures = vec![Measure { weights: vec![(0, 1.0), (1, 0.1)], multiplicity: 8.0 }];
        let system = System { size: 2, matrices: 2, multipliers: 2, inequalities, measures };
        (system, vec![3.0, 0.1, 2.5, 1.0, -0.2, 1.5, 4.0, 0.7])
    }

    fn value(system: &System, x: &[f64]) -> f64 {
        let values: Vec<Dense> =
            system.inequalities.iter().map(|part| system.value(part, x, 1.3)).collect();
        barrier(&values).unwrap()
    }

    #[test]
    fn derivatives_agree_with_differences_of_the_barrier() {
        let (system, x) = example();
        let linear = vec![0.0; system.len()];
        let exact = derivatives(&system, 1.3, &x, &linear).unwrap();
        let moved = |i: usize, by: f64| {
            let mut x = x.clone();
            x[i] += by;
            x
        };
        for i in 0..x.len() {
            // Central differences: truncation and rounding are both near 1e-10 at this step.
            let slope = (value(&system, &moved(i, 1e-5)) - value(&system, &moved(i, -1e-5))) / 2e-5;
            assert!((slope - exact.gradient[i]).abs() < 1e-7, "{i}: {slope}");
            let (up, down) = (
                derivatives(&system, 1.3, &moved(i, 1e-5), &linear).unwrap(),
                derivatives(&system, 1.3, &moved(i, -1e-5), &linear).unwrap(),
            );
            for j in i..x.len() {
                let second = (up.gradient[j] - down.gradient[j]) / 2e-5;
                assert!((second - exact.hessian[(i, j)]).abs() < 1e-7, "{i} {j}: {second}");
            }
        }
    }

    #[test]
    fn the_linear_term_leaves_no_slope_along_the_unknowns_themselves() {
        let (system, x) = example();
        let linear = linear_term(&system, &x).unwrap();
        let slope = dot(&derivatives(&system, 1.3, &x, &linear).unwrap().gradient, &x);
        assert!(slope.abs() < 1e-12, "{slope}");
    }
}
