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
//! # Source
//! S. Boyd, L. El Ghaoui, E. Feron and V. Balakrishnan, *Linear Matrix Inequalities in System and Control Theory*,
//! SIAM 1994, sections 6.1 to 6.3.

use fspid_lti::Matrix;

use super::Effort;
use super::centres::{Chart, Goal, descend};
use super::dense::Dense;
use super::inequality::{Factor, Form, Inequality, Measure, System};
use super::lyapunov::positive_multiplier;
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
}

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub struct DrivenProblem<'a> {
    /// The loop at the corners.
    pub corners: &'a [DrivenCorner],
    /// Rows r whose largest values count.
    pub rows: &'a [Vec<f64>],
    /// α, above 0, at most 1.
    pub decay: f64,
}

/// A form P, with $\tau = 1$, for which the level is about the least; from a form that decreases by more than α at every
/// corner. The search ends where the level can hardly fall by more than `reach` times itself, which is pessimistic. `None` where it does not, or shapes do not fit, or the search was stopped.
#[must_use]
pub fn driven_form(
    problem: &DrivenProblem<'_>,
    start: &Matrix,
    effort: &Effort,
    reach: f64,
) -> Option<Matrix> {
    let mut search = Search::start(problem, &Dense::from(start))?;
    descend(&mut search, Goal::Smallest { reach }, effort)?;
    let form = Dense::identity(search.inverse.rows).congruence(&search.inverse);
    form.scaled(1.0 / search.size).to_matrix()
}

/// The least β for which the inequality holds at a corner with a form and $\tau = 1$; `None` where no β is enough.
///
/// $$ \beta = \lambda_{\max} \left( E^T P E + E^T P M S^{-1} M^T P E \right), \qquad S = \alpha P - M^T P M - c^T c $$
#[must_use]
pub fn least_gain(form: &Matrix, decay: f64, corner: &DrivenCorner) -> Option<f64> {
    let lower = Dense::from(form).cholesky()?;
    let (inverse, upper) = (lower.lower_inverse().transpose(), lower.transpose());
    let Turned { matrix, entry, seen } = Turned::of(corner, &inverse, &upper);
    gain_at(&matrix, &entry, seen.as_ref(), (decay, 1.0))
}

/// How much the slowest corner leaves of a form in a sample: $\lambda_{\max}(P^{-1} M^T P M)$, the least α.
#[must_use]
pub fn kept_of(form: &Matrix, corners: &[DrivenCorner]) -> Option<f64> {
    let lower = Dense::from(form).cholesky()?;
    let (inverse, upper) = (lower.lower_inverse().transpose(), lower.transpose());
    let kept = corners.iter().map(|corner| {
        let matrix = upper.times(&Dense::from(&corner.matrix)).times(&inverse);
        Spectrum::of(&matrix.transpose_times(&matrix)).largest()
    });
    Some(kept.fold(0.0, f64::max))
}

/// A corner in coordinates in which the form is the identity.
struct Turned {
    matrix: Dense,
    entry: Dense,
    seen: Option<Dense>,
}

impl Turned {
    fn of(corner: &DrivenCorner, transform: &Dense, inverse: &Dense) -> Self {
        Self {
            matrix: inverse.times(&Dense::from(&corner.matrix)).times(transform),
            entry: inverse.times(&Dense::from(&corner.entry)),
            seen: corner.seen.as_ref().map(|row| row_of(row).times(transform)),
        }
    }
}

fn row_of(row: &[f64]) -> Dense {
    Dense { rows: 1, columns: row.len(), data: row.to_vec() }
}

/// [`least_gain`] where P is the identity and what is seen counts τ times.
fn gain_at(
    matrix: &Dense,
    entry: &Dense,
    seen: Option<&Dense>,
    (decay, tau): (f64, f64),
) -> Option<f64> {
    let mut left = Dense::identity(matrix.rows).scaled(decay);
    left.add(-1.0, &matrix.transpose_times(matrix));
    if let Some(row) = seen {
        left.add(-tau, &row.transpose_times(row));
    }
    let through = left.cholesky()?.lower_inverse().times(&matrix.transpose_times(entry));
    let whole = entry.transpose_times(entry).plus(1.0, &through.transpose_times(&through));
    Some(Spectrum::of(&whole).largest())
}

/// The problem in coordinates z with x = T z, in which the present form is the identity.
struct Search {
    corners: Vec<Turned>,
    rows: Vec<Dense>,
    decay: f64,
    transform: Dense,
    inverse: Dense,
    /// τ.
    size: f64,
}

impl Search {
    fn start(problem: &DrivenProblem<'_>, form: &Dense) -> Option<Self> {
        let states = form.rows;
        let fits = |corner: &DrivenCorner| {
            let square = [corner.matrix.rows(), corner.matrix.columns(), corner.entry.rows()];
            square == [states; 3] && corner.seen.as_ref().is_none_or(|row| row.len() == states)
        };
        let rows = problem.rows.iter().all(|row| row.len() == states);
        if problem.corners.is_empty() || !rows || !problem.corners.iter().all(fits) {
            return None;
        }
        let lower = form.cholesky()?;
        let (transform, inverse) = (lower.lower_inverse().transpose(), lower.transpose());
        let decay = problem.decay;
        let turned =
            |corner| Turned::of(corner, &Dense::identity(states), &Dense::identity(states));
        let mut corners: Vec<Turned> = problem.corners.iter().map(turned).collect();
        let rows: Vec<Dense> = problem.rows.iter().map(|row| row_of(row)).collect();
        let at = |corner| Turned::of(corner, &transform, &inverse);
        let first: Vec<Turned> = problem.corners.iter().map(at).collect();
        let size = starting_size(&first, &rows, (decay, &transform))?;
        let gains = first.iter().map(|corner| {
            gain_at(&corner.matrix, &corner.entry, corner.seen.as_ref(), (decay, size))
        });
        let gain = gains.collect::<Option<Vec<f64>>>()?.into_iter().fold(0.0, f64::max);
        // In these units of u the level at the start is about 1.
        let unit = (gain / size).sqrt();
        if !(unit > 0.0 && unit.is_finite()) {
            return None;
        }
        corners.iter_mut().for_each(|corner| corner.entry = corner.entry.scaled(1.0 / unit));
        Some(Self { corners, rows, decay, transform, inverse, size })
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
        let form = |factor: Dense, weight: f64| Form {
            factor: Factor::Matrix(factor),
            rated: false,
            weights: vec![(0, weight)],
        };
        let of_input = |i: usize, j: usize| f64::from(u8::from(i == j && i >= states));
        let seen = corner.seen.as_ref().map(|row| {
            let row = row.times(&self.transform);
            let at = |place: usize| if place < states { row[(0, place)] } else { 0.0 };
            (0, Dense::from_function(size, size, |i, j| -(at(i) * at(j))))
        });
        Inequality {
            size,
            forms: vec![form(first, self.decay), form(after, -1.0)],
            multipliers: seen.into_iter().collect(),
            rated_multipliers: vec![(0, Dense::from_function(size, size, of_input))],
        }
    }
}

/// τ at which every inequality has room, with the identity as form.
fn starting_size(
    corners: &[Turned],
    rows: &[Dense],
    (decay, transform): (f64, &Dense),
) -> Option<f64> {
    let mut size = f64::INFINITY;
    for corner in corners {
        let mut left = Dense::identity(corner.matrix.rows).scaled(decay);
        left.add(-1.0, &corner.matrix.transpose_times(&corner.matrix));
        let room = Spectrum::of(&left).smallest();
        if !(room > 0.0) {
            return None;
        }
        if let Some(row) = &corner.seen {
            size = size.min(START * room / row.inner(row));
        }
    }
    for row in rows {
        let row = row.times(transform);
        size = size.min(START / row.inner(&row));
    }
    (size > 0.0 && size.is_finite()).then_some(size)
}

impl Chart for Search {
    fn system(&self) -> System {
        let states = self.transform.rows;
        let only = || vec![(0, 1.0)];
        let mut inequalities = vec![Inequality::positive(states, only()), positive_multiplier(0)];
        inequalities.extend(self.corners.iter().map(|corner| self.driven(corner)));
        for row in &self.rows {
            let row = row.times(&self.transform);
            let mut inside = Inequality::positive(states, only());
            inside.multipliers = vec![(0, row.transpose_times(&row).scaled(-1.0))];
            inequalities.push(inside);
        }
        let multiplicity = (self.corners.len() + self.rows.len()) as f64;
        let measures = vec![Measure { weights: only(), multiplicity }];
        System { size: states, matrices: 1, multipliers: 1, inequalities, measures }
    }

    fn point(&self) -> Vec<f64> {
        let mut x = pack(&Dense::identity(self.transform.rows));
        x.push(self.size);
        x
    }

    fn accept(&mut self, x: &[f64]) {
        let states = self.transform.rows;
        let (form, size) = x.split_at(packed_len(states));
        if let (Some(lower), [size]) = (unpack(form, states).cholesky(), size) {
            self.transform = self.transform.times(&lower.lower_inverse().transpose());
            self.inverse = lower.transpose().times(&self.inverse);
            self.size = *size;
        }
    }
}
