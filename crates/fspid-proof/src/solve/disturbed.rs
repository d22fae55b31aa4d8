//! One quadratic form for the least bound of what a disturbance does, in ordinary arithmetic.
//!
//! With $z^+ = M_i z + E_i u$ at each corner i of a set of gains, and $\tau$ for the size of the form,
//!
//! $$ \begin{pmatrix} \alpha P & 0 \cr 0 & \lambda \tau I \end{pmatrix} - \begin{pmatrix} M_i & E_i \end{pmatrix}^T
//!    P \begin{pmatrix} M_i & E_i \end{pmatrix} - \tau \begin{pmatrix} c_i^T c_i & 0 \cr 0 & 0 \end{pmatrix} \succ 0,
//!    \qquad P - \tau r_j^T r_j \succ 0 $$
//!
//! is linear in P and $\tau$, and $\lambda$ is the level that the method of centres lowers: the square of the gain from
//! energy to energy (rows $c_i$, $\alpha = 1$), or of that from the largest u to the largest $r_j z$, but for
//! $1 / (1 - \alpha)$ (rows $r_j$).
//!
//! A form may move with gains κ, $P(\kappa) = P_0 + \sum_j \kappa_j P_j$: then P stands for $P(\kappa_i)$ of the gains
//! of a place, and between the brackets for $P(\kappa_i^+)$ one sample later.
//!
//! # Source
//! S. Boyd, L. El Ghaoui, E. Feron and V. Balakrishnan, *Linear Matrix Inequalities in System and Control Theory*,
//! SIAM 1994, sections 6.1 to 6.3.

use fspid_lti::Matrix;

use super::Effort;
use super::centres::{Chart, Goal, descend};
use super::dense::Dense;
use super::gain_family::combination;
use super::inequality::{Factor, Form, Inequality, Measure, System};
use super::lyapunov::positive_multiplier;
use super::parameter_dependent::weights;
use super::symmetric::{Spectrum, pack, packed_len, unpack};

/// Of what the form at the start leaves for what is seen, so much is taken at first.
const START: f64 = 0.5;

/// The loop at one corner.
#[derive(Clone, Debug)]
pub struct DrivenCorner {
    /// M.
    pub matrix: Matrix,
    /// E.
    pub entry: Matrix,
    /// c, times the root of the sample period; none where nothing is asked at every sample.
    pub seen: Option<Vec<f64>>,
    /// The gains that the form moves with, now and a sample later, in half widths; none of a form that does not.
    pub gains: [Vec<f64>; 2],
}

/// A row whose largest values count, at the gains that the form moves with.
#[derive(Clone, Debug, PartialEq)]
pub struct CountedRow {
    /// r.
    pub row: Vec<f64>,
    /// In half widths; none of a form that does not move.
    pub gains: Vec<f64>,
}

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub struct DrivenProblem<'a> {
    /// The loop at the corners.
    pub corners: &'a [DrivenCorner],
    /// Rows r whose largest values count.
    pub rows: &'a [CountedRow],
    /// α, above 0, at most 1.
    pub decay: f64,
}

/// A form, with $\tau = 1$, for which the level is about the least; from one that decreases by more than α at every
/// corner: $P_0$, then what each gain that it moves with adds. The search ends where the level can hardly fall by more
/// than `reach` times itself, which is pessimistic. `None` where it does not, or shapes do not fit, or the search was
/// stopped.
#[must_use]
pub fn driven_form(
    problem: &DrivenProblem<'_>,
    start: &[Matrix],
    effort: &Effort,
    reach: f64,
) -> Option<Vec<Matrix>> {
    let mut search = Search::start(problem, start)?;
    descend(&mut search, Goal::Smallest { reach }, effort)?;
    let back = |form: &Dense| form.congruence(&search.inverse).scaled(1.0 / search.size);
    search.forms.iter().map(|form| back(form).to_matrix()).collect()
}

/// The least β for which the inequality holds at a corner with a form and $\tau = 1$; `None` where no β is enough.
///
/// $$ \beta = \lambda_{\max} \left( E^T P^+ E + E^T P^+ M S^{-1} M^T P^+ E \right), \qquad
///    S = \alpha P - M^T P^+ M - c^T c $$
#[must_use]
pub fn least_gain(forms: &[Matrix], decay: f64, corner: &DrivenCorner) -> Option<f64> {
    let (turned, after) = at_place(forms, corner)?;
    gain_at(&turned, &after, &Dense::identity(after.rows), (decay, 1.0))
}

/// How much the slowest corner leaves of a form in a sample: $\lambda_{\max}(P^{-1} M^T P^+ M)$, the least α; `None` where
/// the form is not positive.
#[must_use]
pub fn kept_of(forms: &[Matrix], corners: &[DrivenCorner]) -> Option<f64> {
    let kept = corners.iter().map(|corner| {
        let (Turned { matrix, .. }, after) = at_place(forms, corner)?;
        Some(Spectrum::of(&matrix.transpose_times(&after.times(&matrix))).largest())
    });
    kept.collect::<Option<Vec<f64>>>().map(|kept| kept.into_iter().fold(0.0, f64::max))
}

/// The form at some gains.
#[must_use]
pub fn form_at(forms: &[Matrix], gains: &[f64]) -> Option<Matrix> {
    let forms: Vec<Dense> = forms.iter().map(Dense::from).collect();
    if forms.is_empty() { None } else { combination(&forms, gains).to_matrix() }
}

/// A corner in coordinates in which the form there is the identity, and the form a sample later.
fn at_place(forms: &[Matrix], corner: &DrivenCorner) -> Option<(Turned, Dense)> {
    let forms: Vec<Dense> = forms.iter().map(Dense::from).collect();
    let [now, next] = &corner.gains;
    let lower = combination(&forms, now).cholesky()?;
    let (inverse, upper) = (lower.lower_inverse().transpose(), lower.transpose());
    let turned = Turned::of(corner, &inverse, &upper);
    let after = if now == next {
        Dense::identity(lower.rows)
    } else {
        combination(&forms, next).congruence(&inverse)
    };
    Some((turned, after))
}

/// A corner in some coordinates.
struct Turned {
    matrix: Dense,
    entry: Dense,
    seen: Option<Dense>,
    gains: [Vec<f64>; 2],
}

impl Turned {
    fn of(corner: &DrivenCorner, transform: &Dense, inverse: &Dense) -> Self {
        Self {
            matrix: inverse.times(&Dense::from(&corner.matrix)).times(transform),
            entry: inverse.times(&Dense::from(&corner.entry)),
            seen: corner.seen.as_ref().map(|row| row_of(row).times(transform)),
            gains: corner.gains.clone(),
        }
    }
}

fn row_of(row: &[f64]) -> Dense {
    Dense { rows: 1, columns: row.len(), data: row.to_vec() }
}

/// [`least_gain`] with the forms at the place and after it, where what is seen counts τ times.
fn gain_at(
    Turned { matrix, entry, seen, .. }: &Turned,
    after: &Dense,
    now: &Dense,
    (decay, tau): (f64, f64),
) -> Option<f64> {
    let of_entry = after.times(entry);
    let mut left = now.scaled(decay);
    left.add(-1.0, &matrix.transpose_times(&after.times(matrix)));
    if let Some(row) = seen {
        left.add(-tau, &row.transpose_times(row));
    }
    let through = left.cholesky()?.lower_inverse().times(&matrix.transpose_times(&of_entry));
    let whole = entry.transpose_times(&of_entry).plus(1.0, &through.transpose_times(&through));
    Some(Spectrum::of(&whole).largest())
}

/// The problem in coordinates z with x = T z, in which the present form at the centre is the identity.
struct Search {
    corners: Vec<Turned>,
    rows: Vec<(Dense, Vec<f64>)>,
    decay: f64,
    transform: Dense,
    inverse: Dense,
    forms: Vec<Dense>,
    /// τ.
    size: f64,
}

impl Search {
    fn start(problem: &DrivenProblem<'_>, start: &[Matrix]) -> Option<Self> {
        let states = start.first()?.rows();
        let moving = start.len() - 1;
        let fits = |corner: &DrivenCorner| {
            let square = [corner.matrix.rows(), corner.matrix.columns(), corner.entry.rows()];
            let gains = corner.gains.iter().all(|gains| gains.len() == moving);
            let seen = corner.seen.as_ref().is_none_or(|row| row.len() == states);
            square == [states; 3] && seen && gains
        };
        let row_fits = |it: &CountedRow| it.row.len() == states && it.gains.len() == moving;
        let rows = problem.rows.iter().all(row_fits);
        if problem.corners.is_empty() || !rows || !problem.corners.iter().all(fits) {
            return None;
        }
        let start: Vec<Dense> = start.iter().map(Dense::from).collect();
        let lower = start[0].cholesky()?;
        let (transform, inverse) = (lower.lower_inverse().transpose(), lower.transpose());
        let moved = start[1..].iter().map(|form| form.congruence(&transform));
        let forms: Vec<Dense> = core::iter::once(Dense::identity(states)).chain(moved).collect();
        let same = Dense::identity(states);
        let corners = problem.corners.iter().map(|corner| Turned::of(corner, &same, &same));
        let rows = problem.rows.iter().map(|it| (row_of(&it.row), it.gains.clone()));
        let mut search = Self {
            corners: corners.collect(),
            rows: rows.collect(),
            decay: problem.decay,
            transform,
            inverse,
            forms,
            size: 1.0,
        };
        search.size = search.starting_size(problem)?;
        // In these units of u the level at the start is about 1.
        let unit = (search.starting_gain(problem)? / search.size).sqrt();
        if !(unit > 0.0 && unit.is_finite()) {
            return None;
        }
        let own = search.corners.iter_mut();
        own.for_each(|corner| corner.entry = corner.entry.scaled(1.0 / unit));
        Some(search)
    }

    /// β at the start.
    fn starting_gain(&self, problem: &DrivenProblem<'_>) -> Option<f64> {
        let gains = problem.corners.iter().map(|corner| {
            let turned = Turned::of(corner, &self.transform, &self.inverse);
            let [now, next] = corner.gains.each_ref().map(|gains| combination(&self.forms, gains));
            gain_at(&turned, &next, &now, (self.decay, self.size))
        });
        Some(gains.collect::<Option<Vec<f64>>>()?.into_iter().fold(0.0, f64::max))
    }

    /// τ at which every inequality has room.
    fn starting_size(&self, problem: &DrivenProblem<'_>) -> Option<f64> {
        let mut size = f64::INFINITY;
        for corner in problem.corners {
            let Turned { matrix, seen, .. } = Turned::of(corner, &self.transform, &self.inverse);
            let [now, next] = corner.gains.each_ref().map(|gains| combination(&self.forms, gains));
            let mut left = now.scaled(self.decay);
            left.add(-1.0, &matrix.transpose_times(&next.times(&matrix)));
            let room = Spectrum::of(&left).smallest();
            if !(room > 0.0) {
                return None;
            }
            if let Some(row) = &seen {
                size = size.min(START * room / row.inner(row));
            }
        }
        for (row, gains) in &self.rows {
            let row = row.times(&self.transform);
            // The identity has 1 as its smallest eigenvalue.
            let room = Spectrum::of(&combination(&self.forms, gains)).smallest();
            size = size.min(START * room / row.inner(&row));
        }
        (size > 0.0 && size.is_finite()).then_some(size)
    }

    /// The inequality of a corner: over the state, then over u.
    fn driven(&self, corner: &Turned) -> Inequality {
        let matrix = self.inverse.times(&corner.matrix).times(&self.transform);
        let entry = self.inverse.times(&corner.entry);
        let (states, inputs) = (matrix.rows, entry.columns);
        let size = states + inputs;
        let first = Dense::from_function(size, states, |i, j| f64::from(u8::from(i == j)));
        let after = Dense::from_function(size, states, |i, j| match i.checked_sub(states) {
            None => matrix[(j, i)],
            Some(input) => entry[(j, input)],
        });
        let form = |factor: Dense, weight: f64, gains: &[f64]| Form {
            factor: Factor::Matrix(factor),
            rated: false,
            weights: weights(gains).into_iter().map(|(part, own)| (part, weight * own)).collect(),
        };
        let of_input = |i: usize, j: usize| f64::from(u8::from(i == j && i >= states));
        let seen = corner.seen.as_ref().map(|row| {
            let row = row.times(&self.transform);
            let at = |place: usize| if place < states { row[(0, place)] } else { 0.0 };
            (0, Dense::from_function(size, size, |i, j| -(at(i) * at(j))))
        });
        let [now, next] = &corner.gains;
        Inequality {
            size,
            forms: vec![form(first, self.decay, now), form(after, -1.0, next)],
            multipliers: seen.into_iter().collect(),
            rated_multipliers: vec![(0, Dense::from_function(size, size, of_input))],
        }
    }
}

impl Chart for Search {
    fn system(&self) -> System {
        let states = self.transform.rows;
        let centre = vec![0.0; self.forms.len() - 1];
        let mut inequalities =
            vec![Inequality::positive(states, weights(&centre)), positive_multiplier(0)];
        let mut last: Option<&Vec<f64>> = Some(&centre);
        for corner in &self.corners {
            let [now, _] = &corner.gains;
            if last.replace(now) != Some(now) {
                inequalities.push(Inequality::positive(states, weights(now)));
            }
            inequalities.push(self.driven(corner));
        }
        for (row, gains) in &self.rows {
            let row = row.times(&self.transform);
            let mut inside = Inequality::positive(states, weights(gains));
            inside.multipliers = vec![(0, row.transpose_times(&row).scaled(-1.0))];
            inequalities.push(inside);
        }
        let multiplicity = (self.corners.len() + self.rows.len()) as f64;
        let measures = vec![Measure { weights: weights(&centre), multiplicity }];
        let matrices = self.forms.len();
        System { size: states, matrices, multipliers: 1, inequalities, measures }
    }

    fn point(&self) -> Vec<f64> {
        let mut x: Vec<f64> = self.forms.iter().flat_map(pack).collect();
        x.push(self.size);
        x
    }

    fn accept(&mut self, x: &[f64]) {
        let states = self.transform.rows;
        let (forms, size) = x.split_at(self.forms.len() * packed_len(states));
        let forms: Vec<Dense> =
            forms.chunks(packed_len(states)).map(|form| unpack(form, states)).collect();
        if let (Some(lower), [size]) = (forms[0].cholesky(), size) {
            let turn = lower.lower_inverse().transpose();
            self.transform = self.transform.times(&turn);
            self.inverse = lower.transpose().times(&self.inverse);
            let moved = forms[1..].iter().map(|form| form.congruence(&turn));
            self.forms = core::iter::once(Dense::identity(states)).chain(moved).collect();
            self.size = *size;
        }
    }
}
