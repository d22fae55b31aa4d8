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
struct Derivatives {
    gradient: Vec<f64>,
    hessian: Dense,
}

/// Derivatives at unknowns where all inequalities hold; `None` elsewhere.
fn derivatives(system: &System, level: f64, x: &[f64], linear: &[f64]) -> Option<Derivatives> {
    let count = system.len();
    let mut sum = Derivatives { gradient: linear.to_vec(), hessian: Dense::zeros(count, count) };
    for inequality in &system.inequalities {
        let inverse = system.value(inequality, x, level).cholesky()?.lower_inverse();
        let inverse = inverse.transpose_times(&inverse);
        Part::new(system, inequality, level, inverse).add_to(&mut sum);
    }
    Some(sum)
}

/// What one inequality adds; Z is its inverse.
struct Part<'a> {
    system: &'a System,
    inequality: &'a Inequality,
    level: f64,
    inverse: Dense,
    /// $U_f^T Z U_g$ for all factors.
    table: Vec<Vec<Dense>>,
}

impl<'a> Part<'a> {
    fn new(system: &'a System, inequality: &'a Inequality, level: f64, inverse: Dense) -> Self {
        let after: Vec<Dense> =
            inequality.factors.iter().map(|factor| factor.after(&inverse)).collect();
        let table = inequality
            .factors
            .iter()
            .map(|factor| after.iter().map(|after| factor.before(after)).collect())
            .collect();
        Self { system, inequality, level, inverse, table }
    }

    fn scale(&self, form: &Form) -> f64 {
        if form.rated { self.level } else { 1.0 }
    }

    fn add_to(&self, sum: &mut Derivatives) {
        for form in &self.inequality.forms {
            self.add_slope_of_form(form, &mut sum.gradient);
            for other in &self.inequality.forms {
                self.add_forms(form, other, &mut sum.hessian);
            }
            self.add_form_and_cross(form, &mut sum.hessian);
        }
        self.add_cross(sum);
        self.add_scalars(sum);
    }

    fn add_slope_of_form(&self, form: &Form, gradient: &mut [f64]) {
        let slope = pack(&self.table[form.factor][form.factor]);
        for &(unknown, weight) in &form.weights {
            let place = self.system.place(unknown);
            add_scaled(&mut gradient[place], -self.scale(form) * weight, &slope);
        }
    }

    /// $\operatorname{tr}(X B Y B^T)$ with $B = U^T Z W$ for two forms in X and Y.
    fn add_forms(&self, form: &Form, other: &Form, hessian: &mut Dense) {
        let b = &self.table[form.factor][other.factor];
        let scale = self.scale(form) * self.scale(other);
        let mut line = Vec::new();
        let mut number = 0;
        for p in 0..b.rows {
            for q in p..b.rows {
                kronecker_row(b, p, q, &mut line);
                for &(unknown, weight) in &form.weights {
                    let row = self.system.place(unknown).start + number;
                    for &(next, next_weight) in other.weights.iter().filter(|to| to.0 >= unknown) {
                        let at = row * hessian.columns + self.system.place(next).start;
                        let target = &mut hessian.data[at..at + line.len()];
                        add_scaled(target, scale * weight * next_weight, &line);
                    }
                }
                number += 1;
            }
        }
    }

    /// The unknown of the cross comes after those of the forms.
    fn add_form_and_cross(&self, form: &Form, hessian: &mut Dense) {
        let Some(cross) = &self.inequality.cross else { return };
        let a = &self.table[form.factor][cross.right];
        let c = &self.table[form.factor][cross.left];
        let scale = self.scale(form);
        let mut line = vec![0.0; c.columns * a.columns];
        let mut number = 0;
        for p in 0..a.rows {
            for q in p..a.rows {
                cross_row(a, c, (p, q), &mut line);
                for &(unknown, weight) in &form.weights {
                    let row = self.system.place(unknown).start + number;
                    let at = row * hessian.columns + self.system.place(cross.unknown).start;
                    add_scaled(&mut hessian.data[at..at + line.len()], scale * weight, &line);
                }
                number += 1;
            }
        }
    }

    fn add_cross(&self, sum: &mut Derivatives) {
        let Some(cross) = &self.inequality.cross else { return };
        let start = self.system.place(cross.unknown).start;
        let d = &self.table[cross.left][cross.right];
        let (uu, vv) = (&self.table[cross.left][cross.left], &self.table[cross.right][cross.right]);
        let size = d.columns;
        for p in 0..d.rows {
            for q in 0..size {
                let row = start + p * size + q;
                sum.gradient[row] -= 2.0 * d[(p, q)];
                for r in 0..d.rows {
                    for s in 0..size {
                        let value = d[(p, s)] * d[(r, q)] + uu[(r, p)] * vv[(q, s)];
                        sum.hessian[(row, start + r * size + s)] += 2.0 * value;
                    }
                }
            }
        }
    }

    fn add_scalars(&self, sum: &mut Derivatives) {
        for (unknown, matrix) in &self.inequality.scalars {
            let column = self.system.place(*unknown).start;
            sum.gradient[column] -= self.inverse.inner(matrix);
            let turned = matrix.congruence(&self.inverse);
            for form in &self.inequality.forms {
                let factor = &self.inequality.factors[form.factor];
                let slope = pack(&factor.before(&factor.after(&turned)));
                for &(form_unknown, weight) in &form.weights {
                    let start = self.system.place(form_unknown).start;
                    for (number, value) in slope.iter().enumerate() {
                        sum.hessian[(start + number, column)] += self.scale(form) * weight * value;
                    }
                }
            }
            for (other, other_matrix) in &self.inequality.scalars {
                let other = self.system.place(*other).start;
                sum.hessian[(column, other)] += turned.inner(other_matrix);
            }
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

/// One row of twice tr(A' X C Y): that of the entry (p, q) of the symmetric X, for all entries of Y.
fn cross_row(a: &Dense, c: &Dense, (p, q): (usize, usize), line: &mut [f64]) {
    for r in 0..c.columns {
        for s in 0..a.columns {
            line[r * a.columns + s] = if p == q {
                2.0 * a[(p, s)] * c[(p, r)]
            } else {
                SQRT_2 * (a[(p, s)] * c[(q, r)] + a[(q, s)] * c[(p, r)])
            };
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
            add_scaled(&mut linear[system.place(unknown)], measure.multiplicity * weight, &slope);
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
        let Some(step) = newton_step(derivatives(system, level, &centre.x, &linear)?) else { break };
        centre.steps += 1;
        let Some(length) = step_length(system, level, &centre.x, &linear, &step) else { break };
        add_scaled(&mut centre.x, length, &step.direction);
        if step.decrement < DECREMENT_MIN {
            break;
        }
    }
    Some(centre)
}

struct Step {
    direction: Vec<f64>,
    /// Square root of the first derivative along the direction.
    decrement: f64,
}

fn newton_step(mut at: Derivatives) -> Option<Step> {
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
fn step_length(
    system: &System,
    level: f64,
    x: &[f64],
    linear: &[f64],
    step: &Step,
) -> Option<f64> {
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
fn barrier(values: &[Dense]) -> Option<f64> {
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
    use crate::solve::inequality::{Cross, Factor, Measure, Unknown};

    /// Every kind of term, twice over, at unknowns where the inequality holds.
    fn example() -> (System, Vec<f64>) {
        let wide = |seed: usize| {
            Factor::Matrix(Dense::from_function(4, 2, |i, j| ((i * 7 + j * 5 + seed) % 11) as f64 * 0.1))
        };
        let unit = Factor::Unit { start: 2, size: 2 };
        let forms = vec![
            Form { factor: 0, rated: true, weights: vec![(0, 1.0), (1, 0.5)] },
            Form { factor: 1, rated: false, weights: vec![(0, -0.05), (1, 0.2)] },
            Form { factor: 2, rated: false, weights: vec![(1, 3.0)] },
        ];
        let cross = Inequality {
            size: 4,
            factors: vec![Factor::Unit { start: 0, size: 2 }, wide(1), unit.clone()],
            forms: forms.clone(),
            cross: Some(Cross { unknown: 3, left: 2, right: 1 }),
            scalars: vec![],
        };
        let scalar = Inequality {
            cross: None,
            scalars: vec![(2, Dense::from_function(4, 4, |i, j| if i == j { 1.0 } else { 0.1 }))],
            factors: vec![Factor::Unit { start: 0, size: 2 }, wide(3), unit],
            forms,
            size: 4,
        };
        let unknowns = vec![
            Unknown::Symmetric(2),
            Unknown::Symmetric(2),
            Unknown::Scalar,
            Unknown::General(2),
        ];
        let measures = vec![Measure { weights: vec![(0, 1.0)], multiplicity: 8.0 }];
        let system = System { unknowns, inequalities: vec![cross, scalar], measures };
        (system, vec![3.0, 0.1, 2.5, 1.0, -0.2, 1.5, 4.0, 0.4, 0.3, -0.2, 0.5])
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
