//! One quadratic form that decreases under every matrix of a set.

use fspid_lti::{Matrix, spectral_radius};
use fspid_numeric::matrix::balance;

use super::Effort;
use super::centres::{Chart, Descent, Goal, descend};
use super::dense::Dense;
use super::inequality::{Inequality, Measure, System};
use super::stein::stable_sum;
use super::symmetric::{Spectrum, pack, packed_len, unpack};

/// Smallest margin that counts: below it rounding in the differences decides.
const MARGIN_MIN: f64 = 1e-12;
/// The form to start from looks this far past the decay of the central matrix.
const START_LOSS: f64 = 1.01;
/// First multiplier of a cone, beside the form.
const START_MULTIPLIER: f64 = 0.01;

/// A matrix under which the form must decrease, everywhere or inside a cone.
#[derive(Debug, Clone, Copy)]
pub struct Condition<'a> {
    /// One sample of the loop: $x_{k+1} = M x_k$.
    pub matrix: &'a Matrix,
    /// Number of the cone in which the decrease is asked for; `None` for everywhere.
    pub cone: Option<usize>,
}

/// What is asked for: P and $\tau$ with
///
/// $$ P \succ 0, \quad \tau_g > 0, \quad \rho^2 P - M_i^T P M_i - \tau_{g(i)} Q_{g(i)} \succ 0 $$
///
/// A cone is the set of x with $x^T Q_g x \ge 0$; there the form decreases by $\rho^2$ at least. All conditions
/// of one cone share its multiplier.
#[derive(Debug, Clone, Copy)]
pub struct LyapunovProblem<'a> {
    /// Matrices, each with its cone.
    pub conditions: &'a [Condition<'a>],
    /// Symmetric matrices $Q_g$ of the cones.
    pub cones: &'a [Matrix],
    /// Largest factor $\rho$ of the root of the form in one sample; 1 for mere stability.
    pub rate: f64,
}

/// A form that was found. Nothing here is proved: the numbers are rounded.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// P, symmetric bit for bit, with 1 as its largest diagonal entry.
    pub p: Matrix,
    /// Multipliers $\tau_g$ of the cones, in their order.
    pub multipliers: Vec<f64>,
    /// Smallest eigenvalue of all differences in coordinates in which P is the identity.
    pub margin: f64,
    /// Newton steps taken.
    pub steps: usize,
}

/// Whether a form was found.
#[derive(Debug, Clone, PartialEq)]
pub enum Verdict {
    /// All differences are positive definite, as far as rounded arithmetic can tell.
    Found(Solution),
    /// The search ended without one, which proves nothing.
    NotFound {
        /// Largest margin that any form reached, not above zero or within rounding of it; minus infinity
        /// where the problem is empty, or its matrices do not fit each other or are not finite.
        best_margin: f64,
    },
}

/// Smallest factor per sample for which a form was found.
#[derive(Debug, Clone, PartialEq)]
pub struct BestRate {
    /// Factor $\rho$ of the root of the form in one sample, a little above the smallest.
    pub rate: f64,
    /// The form, with its margin at that rate.
    pub solution: Solution,
}

/// Looks for a form that decreases under all conditions at the problem's rate.
///
/// The form returned lies inside the set of all such forms, near its analytic centre and not on its edge.
#[must_use]
pub fn common_lyapunov(problem: &LyapunovProblem, effort: &Effort) -> Verdict {
    let missing = Verdict::NotFound { best_margin: f64::NEG_INFINITY };
    let level = problem.rate * problem.rate;
    let Some(mut search) = Search::start(problem) else { return missing };
    let goal = Goal::Below(level);
    let Some(descent) = descend(&mut search, goal, effort) else { return missing };
    match search.solution(problem, level, descent.steps) {
        Some(solution) if solution.margin > MARGIN_MIN => Verdict::Found(solution),
        _ => Verdict::NotFound { best_margin: level - descent.bound },
    }
}

/// One form that decreases under every matrix at a rate, if one is found.
#[must_use]
pub fn common_form(matrices: &[Matrix], rate: f64, effort: &Effort) -> Option<Matrix> {
    let conditions: Vec<Condition<'_>> =
        matrices.iter().map(|matrix| Condition { matrix, cone: None }).collect();
    let problem = LyapunovProblem { conditions: &conditions, cones: &[], rate };
    match common_lyapunov(&problem, effort) {
        Verdict::Found(solution) => Some(solution.p),
        Verdict::NotFound { .. } => None,
    }
}

/// A form that decreases under every matrix, in the middle of those that decrease half as fast as any can, if one is found.
#[must_use]
pub fn fast_form(matrices: &[Matrix], effort: &Effort) -> Option<Matrix> {
    let conditions: Vec<Condition<'_>> =
        matrices.iter().map(|matrix| Condition { matrix, cone: None }).collect();
    let problem = LyapunovProblem { conditions: &conditions, cones: &[], rate: 1.0 };
    let best = best_rate(&problem, effort).filter(|best| best.rate < 1.0)?;
    common_form(matrices, 0.5 * (1.0 + best.rate), effort).or(Some(best.solution.p))
}

/// Looks for the fastest decrease that one form can show, whatever rate the problem names.
///
/// The rate may come out above 1: then no form was found that decreases at all. `None` for a problem that is
/// empty, or whose matrices do not fit each other or are not finite.
#[must_use]
pub fn best_rate(problem: &LyapunovProblem, effort: &Effort) -> Option<BestRate> {
    let mut search = Search::start(problem)?;
    let descent = descend(&mut search, Goal::Lowest, effort)?;
    let level = settled_level(descent);
    let solution = search.solution(problem, level, descent.steps)?;
    (solution.margin > 0.0).then(|| BestRate { rate: level.sqrt(), solution })
}

/// A level so far above the bound that the differences stand clear of rounding.
fn settled_level(descent: Descent) -> f64 {
    let decay = (1.0 - descent.bound).abs();
    descent.bound + (0.05 * decay).max(1e3 * MARGIN_MIN)
}

/// The form the search ended with, whether it decreases or not; for the search for growth.
pub(super) fn closest_form(matrices: &[Matrix], effort: &Effort) -> Option<Dense> {
    let conditions: Vec<Condition> =
        matrices.iter().map(|matrix| Condition { matrix, cone: None }).collect();
    let problem = LyapunovProblem { conditions: &conditions, cones: &[], rate: 1.0 };
    let mut search = Search::start(&problem)?;
    descend(&mut search, Goal::Below(1.0), effort)?;
    Some(search.form())
}

/// The problem in coordinates z with x = T z, in which the present form is the identity.
struct Search {
    matrices: Vec<Dense>,
    groups: Vec<Option<usize>>,
    cones: Vec<Dense>,
    transform: Dense,
    inverse: Dense,
    multipliers: Vec<f64>,
}

impl Search {
    /// `None` when the problem is empty or does not fit together.
    fn start(problem: &LyapunovProblem) -> Option<Self> {
        let matrices: Vec<Dense> =
            problem.conditions.iter().map(|condition| Dense::from(condition.matrix)).collect();
        let cones: Vec<Dense> =
            problem.cones.iter().map(|cone| Dense::from(cone).symmetric()).collect();
        let size = matrices.first()?.rows;
        let fits =
            |matrix: &Dense| matrix.rows == size && matrix.columns == size && matrix.is_finite();
        let groups: Vec<Option<usize>> =
            problem.conditions.iter().map(|condition| condition.cone).collect();
        let known = groups.iter().flatten().all(|&group| group < cones.len());
        if size == 0 || !known || !matrices.iter().chain(&cones).all(fits) {
            return None;
        }
        let (transform, inverse) = starting_coordinates(&matrices)?;
        let mut search = Self { matrices, groups, cones, transform, inverse, multipliers: vec![] };
        search.multipliers = search
            .cones
            .iter()
            .map(|cone| {
                START_MULTIPLIER / cone.congruence(&search.transform).norm().max(f64::MIN_POSITIVE)
            })
            .collect();
        Some(search)
    }

    /// P in the coordinates of the problem, with 1 as its largest diagonal entry; and what it was divided by.
    fn scaled_form(&self) -> (Dense, f64) {
        let form = Dense::identity(self.inverse.rows).congruence(&self.inverse);
        let size = form.diagonal_max();
        (form.scaled(1.0 / size), size)
    }

    fn form(&self) -> Dense {
        self.scaled_form().0
    }

    fn solution(&self, problem: &LyapunovProblem, level: f64, steps: usize) -> Option<Solution> {
        let (p, size) = self.scaled_form();
        let multipliers: Vec<f64> = self.multipliers.iter().map(|value| value / size).collect();
        let margin = margin(&p, &multipliers, problem, level)?;
        Some(Solution { p: p.to_matrix()?, multipliers, margin, steps })
    }
}

/// Smallest eigenvalue of all differences relative to P, from the numbers that are handed out.
fn margin(p: &Dense, multipliers: &[f64], problem: &LyapunovProblem, level: f64) -> Option<f64> {
    let lower = p.cholesky()?;
    let (inverse, upper) = (lower.lower_inverse().transpose(), lower.transpose());
    let mut least = f64::INFINITY;
    for condition in problem.conditions {
        let matrix = upper.times(&Dense::from(condition.matrix)).times(&inverse);
        let mut decrease = Dense::identity(p.rows).scaled(level);
        decrease.add(-1.0, &matrix.transpose_times(&matrix));
        if let Some(group) = condition.cone {
            let cone = Dense::from(problem.cones.get(group)?).symmetric();
            decrease.add(-*multipliers.get(group)?, &cone.congruence(&inverse));
        }
        least = least.min(Spectrum::of(&decrease).smallest());
    }
    Some(least)
}

/// Coordinates in which the form is the identity that the mean of the matrices makes decrease.
fn starting_coordinates(matrices: &[Dense]) -> Option<(Dense, Dense)> {
    let size = matrices.first()?.rows;
    let scales = balancing_scales(matrices);
    let mut mean = Dense::zeros(size, size);
    for matrix in matrices {
        mean.add(1.0 / matrices.len() as f64, matrix);
    }
    let mean = Dense::from_function(size, size, |i, j| mean[(i, j)] * scales[j] / scales[i]);
    let radius = spectral_radius(&mean.to_matrix()?).ok()?;
    // A matrix that is (nearly) nilpotent has no radius worth dividing by.
    let size_of_mean = radius.max(0.01 * mean.norm()).max(f64::MIN_POSITIVE);
    let form = stable_sum(&mean.scaled(1.0 / (START_LOSS * size_of_mean)), &Dense::identity(size))?;
    let lower = form.cholesky()?;
    let upper_inverse = lower.lower_inverse().transpose();
    let transform = Dense::from_function(size, size, |i, j| scales[i] * upper_inverse[(i, j)]);
    let inverse = Dense::from_function(size, size, |i, j| lower[(j, i)] / scales[j]);
    Some((transform, inverse))
}

/// Powers of two by which the states are to be multiplied so that rows and columns become comparable.
///
/// # Source
/// As [`fspid_numeric::matrix::balance`], to the nearest power of two however little it gains: of many matrices, only
/// the largest entries are looked at.
fn balancing_scales(matrices: &[Dense]) -> Vec<f64> {
    const SWEEPS: usize = 10;
    let size = matrices.first().map_or(0, |matrix| matrix.rows);
    let largest = Dense::from_function(size, size, |i, j| {
        matrices.iter().map(|matrix| matrix[(i, j)].abs()).fold(0.0, f64::max)
    });
    let mut scales = vec![1.0; size];
    balance(size, SWEEPS, |i| {
        let others = (0..size).filter(|&j| j != i);
        let row = others.clone().fold(0.0, |sum, j| sum + largest[(i, j)] * scales[j]) / scales[i];
        let column = others.fold(0.0, |sum, j| sum + largest[(j, i)] / scales[j]) * scales[i];
        let ratio = (row / column).sqrt();
        let steps =
            if ratio > 0.0 && ratio.is_finite() { libm::round(libm::log2(ratio)) } else { 0.0 };
        scales[i] *= libm::exp2(steps);
        steps != 0.0
    });
    scales
}

impl Chart for Search {
    fn system(&self) -> System {
        let size = self.transform.rows;
        let only = || vec![(0, 1.0)];
        let mut inequalities = vec![Inequality::positive(size, only())];
        inequalities.extend((0..self.cones.len()).map(positive_multiplier));
        for (matrix, group) in self.matrices.iter().zip(&self.groups) {
            let matrix = self.inverse.times(matrix).times(&self.transform);
            let mut decrease = Inequality::decrease(&matrix, only(), &only());
            let cone = |group: usize| self.cones[group].congruence(&self.transform).scaled(-1.0);
            decrease.multipliers = group.map(|group| (group, cone(group))).into_iter().collect();
            inequalities.push(decrease);
        }
        let multiplicity = self.matrices.len() as f64;
        System {
            size,
            matrices: 1,
            multipliers: self.cones.len(),
            inequalities,
            measures: vec![Measure { weights: only(), multiplicity }],
        }
    }

    fn point(&self) -> Vec<f64> {
        let mut x = pack(&Dense::identity(self.transform.rows));
        x.extend(&self.multipliers);
        x
    }

    fn accept(&mut self, x: &[f64]) {
        let size = self.transform.rows;
        let (form, multipliers) = x.split_at(packed_len(size));
        if let Some(lower) = unpack(form, size).cholesky() {
            self.transform = self.transform.times(&lower.lower_inverse().transpose());
            self.inverse = lower.transpose().times(&self.inverse);
            self.multipliers = multipliers.to_vec();
        }
    }
}

pub(super) fn positive_multiplier(number: usize) -> Inequality {
    Inequality { size: 1, multipliers: vec![(number, Dense::identity(1))], ..Inequality::default() }
}
