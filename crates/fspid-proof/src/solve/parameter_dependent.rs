//! A quadratic form that moves with the gains, for gains that move no faster than a bound.
//!
//! Gains are counted in half widths of their box, $\kappa_j \in [-1, 1]$; the loop and the form are affine
//! in them:
//!
//! $$ M(\kappa) = M_0 + \sum_j \kappa_j M_j, \quad P(\kappa) = P_0 + \sum_j \kappa_j P_j $$
//!
//! # What a re-check must verify
//! 1. $P(\kappa) \succ 0$ at the corners of the box; between them it is a mean.
//! 2. For every $\kappa$ of the box and each extreme motion, which takes $\kappa_j$ to $\kappa_j \pm d_j$, or to
//!    $\pm 1$ when $d_j \ge 1$,
//!
//!    $$ F(\kappa, \kappa^+) = \rho^2 P(\kappa) - M(\kappa)^T P(\kappa^+) M(\kappa) \succ 0 $$
//!
//! F is affine in $\kappa^+$ for given $\kappa$, so that extreme motions cover all slower ones, but cubic in
//! $\kappa$: the corners of the box say nothing about its inside. What is enough is a partition of the box
//! into cells in each of which all Bernstein coefficients of F are positive definite: $4^g$ matrices per
//! cell and motion. The search ends with such a partition in rounded arithmetic and says how many cells it took.
//! Then $V = x^T P(\kappa) x$ decreases by the factor $\rho^2$ at least in every sample. The gains one sample later may lie
//! outside the box by $d_j$ in this condition; that asks for a little more than needed.
//!
//! A slack matrix G makes the condition affine in the gains (M. C. de Oliveira, J. Bernussou and J. C. Geromel,
//! Systems & Control Letters 37 (1999) 261) and the corners enough, but costs $(G - P) P^{-1} (G - P)^T$ of the
//! difference. In fast sampled loops the difference is 10⁻⁴ of the form, so that with one G the form can
//! hardly move. Measured with a version that is not kept, on the paper's loops at 100 Hz, gains within 60 %
//! and $d = 0.01$: G misses by a margin of 4.8e-4 (747) and 6.2e-4 (Navion), the condition above misses by 1.8e-4
//! and holds by 4.7e-4.

use fspid_lti::Matrix;

use super::Effort;
use super::cells::{Motion, Part, survey};
use super::centres::{Chart, Goal, descend};
use super::dense::Dense;
use super::gain_family::{GainFamily, combination, corner_gains};
use super::inequality::{Inequality, Measure, System, Weights};
use super::lyapunov::closest_form;
use super::symmetric::{Spectrum, pack, packed_len, unpack};

/// Smallest margin that counts: below it rounding in the differences decides.
const MARGIN_MIN: f64 = 1e-12;
/// Times that conditions are added where the form was seen not to decrease.
const ROUNDS_MAX: usize = 10;
/// The same for the form that falls fastest, and the part of its decay that gains which were not looked at may lack.
const FASTEST_ROUNDS: usize = 4;
const FASTEST_LEFT: f64 = 0.3;

/// A moving form that was found. Nothing here is proved: the numbers are rounded.
#[derive(Debug, Clone, PartialEq)]
pub struct MovingForm {
    /// $P_0$, then $P_j$ for each gain; symmetric bit for bit, with 1 as the largest diagonal entry of $P_0$.
    pub forms: Vec<Matrix>,
    /// Smallest eigenvalue of the differences at the gains looked at, in coordinates in which $P(\kappa)$ is
    /// the identity.
    pub margin: f64,
    /// Cells of the box of gains that were enough to see the form decrease in all of it.
    pub cells: usize,
    /// Newton steps taken.
    pub steps: usize,
}

/// Whether a moving form was found.
#[derive(Debug, Clone, PartialEq)]
pub enum MovingVerdict {
    /// The form decreases in the whole box, as far as rounded arithmetic can tell.
    Found(MovingForm),
    /// The search ended without one, which proves nothing.
    NotFound {
        /// Largest margin that any form reached at the gains looked at, not above zero or too small for the
        /// gains between; minus infinity where the numbers of gains and of changes differ.
        best_margin: f64,
    },
}

/// What is asked for: a form that moves with the gains and whose root decreases by the factor `rate` in every
/// sample.
#[derive(Clone, Copy)]
pub struct MovingProblem<'a> {
    /// The loop.
    pub family: &'a GainFamily,
    /// Largest changes $d_j$ of the gains in one sample, in half widths of the box; 1 or more stands for a
    /// gain that jumps at will.
    pub changes: &'a [f64],
    /// Largest factor $\rho$ of the root of the form in one sample; 1 for mere stability.
    pub rate: f64,
    /// Gains to begin with; those that span all that are asked for.
    pub points: &'a [Vec<f64>],
    /// What of a cell is asked for.
    pub part: &'a Part<'a>,
}

/// Looks for a form that moves with the gains, for all gains of the box.
#[must_use]
pub fn moving_form(
    family: &GainFamily,
    changes: &[f64],
    rate: f64,
    effort: &Effort,
) -> MovingVerdict {
    let gains = family.gains();
    let points: Vec<Vec<f64>> = (0..1 << gains).map(|number| corner_gains(number, gains)).collect();
    let part = |cell: &Vec<[f64; 2]>| Some(cell.clone());
    let problem = MovingProblem { family, changes, rate, points: &points, part: &part };
    moving_form_over(&problem, effort)
}

/// Looks for a form that moves with the gains, for those that are asked for.
#[must_use]
pub fn moving_form_over(problem: &MovingProblem<'_>, effort: &Effort) -> MovingVerdict {
    let missing = MovingVerdict::NotFound { best_margin: f64::NEG_INFINITY };
    let level = problem.rate * problem.rate;
    let Some(mut search) = Search::start(problem, effort) else { return missing };
    let mut steps = 0;
    let mut best_margin = f64::NEG_INFINITY;
    for _ in 0..ROUNDS_MAX {
        let left = Effort { newton_steps: effort.newton_steps.saturating_sub(steps), ..*effort };
        let Some(descent) = descend(&mut search, Goal::Below(level), &left) else { break };
        steps += descent.steps;
        best_margin = level - descent.bound;
        if !(best_margin > MARGIN_MIN) {
            break;
        }
        let turned = search.turned();
        let survey = survey(&turned, &search.forms, &search.motions, level, problem.part);
        if survey.failures.is_empty() {
            let form = search.solution(level, survey.cells, steps);
            return form.map_or(missing, MovingVerdict::Found);
        }
        search.places.extend(survey.failures);
    }
    MovingVerdict::NotFound { best_margin }
}

/// A form that moves with the gains and falls about as fast as any, at all gains that were looked at: $P_0$, then $P_j$
/// for each gain. It is no answer about all of them, but a start for searches that ask for more.
#[must_use]
pub fn fastest_moving_form(problem: &MovingProblem<'_>, effort: &Effort) -> Option<Vec<Matrix>> {
    let mut search = Search::start(problem, effort)?;
    for round in 1..=FASTEST_ROUNDS {
        let descent = descend(&mut search, Goal::Lowest, effort)?;
        if !(descent.bound < 1.0) {
            return None;
        }
        let level = descent.bound + FASTEST_LEFT * (1.0 - descent.bound);
        let turned = search.turned();
        let failures =
            survey(&turned, &search.forms, &search.motions, level, problem.part).failures;
        if failures.is_empty() || round == FASTEST_ROUNDS {
            break;
        }
        search.places.extend(failures);
    }
    let back = |form: &Dense| form.congruence(&search.inverse).to_matrix();
    search.forms.iter().map(back).collect()
}

/// Where gains may be a sample later, at most: in half widths, for changes in a sample as of a [`MovingProblem`].
#[must_use]
pub fn motions_from(gains: &[f64], changes: &[f64]) -> Vec<Vec<f64>> {
    Motion::extremes(changes).iter().map(|motion| motion.next(gains)).collect()
}

/// The problem in coordinates z with x = T z, in which $P_0$ is the identity.
struct Search {
    family: GainFamily,
    motions: Vec<Motion>,
    /// Gains and motions at which the form must decrease.
    places: Vec<(Vec<f64>, Motion)>,
    transform: Dense,
    inverse: Dense,
    forms: Vec<Dense>,
}

impl Search {
    /// Starts from the form at rest that comes nearest, with conditions at the points and their mean.
    fn start(problem: &MovingProblem<'_>, effort: &Effort) -> Option<Self> {
        let MovingProblem { family, changes, points, .. } = problem;
        let gains = family.gains();
        let fits = |point: &Vec<f64>| point.len() == gains;
        if changes.len() != gains || points.is_empty() || !points.iter().all(fits) {
            return None;
        }
        let matrices: Vec<Matrix> =
            points.iter().map(|point| family.at(point).to_matrix()).collect::<Option<_>>()?;
        let size = family.size();
        let lower = closest_form(&matrices, effort)?.cholesky()?;
        let mut forms = vec![Dense::zeros(size, size); gains + 1];
        forms[0] = Dense::identity(size);
        let motions = Motion::extremes(changes);
        let places = points
            .iter()
            .chain([&mean(points)])
            .flat_map(|place| motions.iter().map(move |motion| (place.clone(), motion.clone())))
            .collect();
        Some(Self {
            family: (*family).clone(),
            motions,
            places,
            transform: lower.lower_inverse().transpose(),
            inverse: lower.transpose(),
            forms,
        })
    }

    /// The family in the present coordinates.
    fn turned(&self) -> GainFamily {
        let turned = |part: &Dense| self.inverse.times(part).times(&self.transform);
        GainFamily { parts: self.family.parts.iter().map(turned).collect() }
    }

    fn solution(&self, level: f64, cells: usize, steps: usize) -> Option<MovingForm> {
        let size = Dense::identity(self.inverse.rows).congruence(&self.inverse).diagonal_max();
        let back = |form: &Dense| form.congruence(&self.inverse).scaled(1.0 / size);
        let forms: Vec<Dense> = self.forms.iter().map(back).collect();
        let mut margin = f64::INFINITY;
        for (now, motion) in &self.places {
            margin = margin.min(margin_at(&self.family, &forms, now, motion, level)?);
        }
        let forms = forms.iter().map(Dense::to_matrix).collect::<Option<_>>()?;
        Some(MovingForm { forms, margin, cells, steps })
    }
}

fn mean(points: &[Vec<f64>]) -> Vec<f64> {
    let share = 1.0 / points.len() as f64;
    let along = |gain: usize| points.iter().fold(0.0, |sum, point| sum + share * point[gain]);
    (0..points.first().map_or(0, Vec::len)).map(along).collect()
}

/// Smallest eigenvalue of the difference relative to the form at these gains.
fn margin_at(
    family: &GainFamily,
    forms: &[Dense],
    now: &[f64],
    motion: &Motion,
    level: f64,
) -> Option<f64> {
    let lower = combination(forms, now).cholesky()?;
    let inverse = lower.lower_inverse().transpose();
    let after = combination(forms, &motion.next(now)).congruence(&family.at(now));
    let mut decrease = Dense::identity(lower.rows).scaled(level);
    decrease.add(-1.0, &after.congruence(&inverse));
    Some(Spectrum::of(&decrease).smallest())
}

/// 1 for the form at rest and the gain for each of those that move.
pub(super) fn weights(gains: &[f64]) -> Weights {
    let moving = gains.iter().enumerate().map(|(gain, value)| (gain + 1, *value));
    core::iter::once((0, 1.0)).chain(moving).collect()
}

impl Chart for Search {
    fn system(&self) -> System {
        let (family, gains, size) = (self.turned(), self.family.gains(), self.family.size());
        let mut inequalities: Vec<Inequality> = Vec::new();
        let mut measures = Vec::new();
        let mut last = None;
        for (now, motion) in &self.places {
            if last.replace(now) != Some(now) {
                inequalities.push(Inequality::positive(size, weights(now)));
            }
            let next = weights(&motion.next(now));
            inequalities.push(Inequality::decrease(&family.at(now), weights(now), &next));
            measures.push(Measure { weights: weights(now), multiplicity: 1.0 });
        }
        System { size, matrices: gains + 1, multipliers: 0, inequalities, measures }
    }

    fn point(&self) -> Vec<f64> {
        self.forms.iter().flat_map(pack).collect()
    }

    fn accept(&mut self, x: &[f64]) {
        let size = self.transform.rows;
        let forms: Vec<Dense> = x.chunks(packed_len(size)).map(|form| unpack(form, size)).collect();
        if let Some(lower) = forms[0].cholesky() {
            let turn = lower.lower_inverse().transpose();
            self.transform = self.transform.times(&turn);
            self.inverse = lower.transpose().times(&self.inverse);
            self.forms = forms.iter().map(|form| form.congruence(&turn)).collect();
        }
    }
}
