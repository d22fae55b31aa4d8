//! Conditions on what a disturbance may do to a sampled loop $z_{k+1} = M z_k + E u_k$.

use fspid_lti::{LtiError, Matrix};
use fspid_numeric::Scalar;
use fspid_numeric::scalar::Interval;

use super::definite::{basis, dominant, form, prove_named, symmetric};
use super::error::{NotProved, positive};
use super::exponential::require_bounded;
use super::lyapunov::least_eigenvalue;
use super::matrix::IntervalMatrix;

/// A loop with a disturbance, both between bounds, and what is seen of its state: a row, which for an energy is asked to
/// be small over all samples.
#[derive(Clone, Copy, Debug)]
pub struct Driven<'a> {
    /// M.
    pub matrix: &'a IntervalMatrix,
    /// E.
    pub entry: &'a IntervalMatrix,
    /// c, times the root of the sample period; none where nothing is asked at every sample.
    pub seen: Option<&'a [Interval]>,
}

/// Proves that, for every M, E and c inside and whatever u is,
///
/// $$ V(M z + E u) \le \alpha V(z) + \beta |u|^2 - (c z)^2, \qquad V(z) = z^T P z, \quad P \succ 0 $$
///
/// for all z and u, as
///
/// $$ \begin{pmatrix} \alpha P & 0 \cr 0 & \beta I \end{pmatrix} - \begin{pmatrix} M & E \end{pmatrix}^T P
///    \begin{pmatrix} M & E \end{pmatrix} - \begin{pmatrix} c^T c & 0 \cr 0 & 0 \end{pmatrix} \succ 0 $$
///
/// What is taken off is convex in M, E and c, so that of a set of gains in which all three are affine the corners are
/// enough. Everything is computed in the basis in which P is about the identity, with E divided by $\sqrt \beta$.
///
/// # Errors
/// [`NotProved`] where shapes do not fit, a number is not allowed, P is not symmetric, or the inequality could not be
/// shown.
pub fn grows_no_faster(
    p: &Matrix,
    [decay, gain]: [f64; 2],
    driven: Driven<'_>,
) -> Result<(), NotProved> {
    let Driven { matrix, entry, seen } = driven;
    let own = symmetric("Lyapunov matrix", p)?;
    let (size, inputs) = (own.rows(), entry.columns());
    matrix.require_shape("matrix of the loop", size, size)?;
    entry.require_shape("entry of the disturbance", size, inputs)?;
    require_bounded("matrix of the loop", matrix)?;
    require_bounded("entry of the disturbance", entry)?;
    if !(decay > 0.0 && decay <= 1.0) {
        return Err(NotProved::Number { what: "decay", found: decay, allowed: "above 0, up to 1" });
    }
    let root = Interval::point(positive("gain of the disturbance", gain)?).sqrt();
    let basis = basis("Lyapunov matrix", &own.middle, size)?;
    let present = form(&own, &basis)?;
    dominant("Lyapunov matrix", &present)?;
    let turned = matrix.product(&basis)?;
    let after = form(&own, &beside(&turned, &entry.scaled(Interval::ONE / root)))?;
    let own_part = present.scaled(Interval::point(decay));
    let mut left = corner(&own_part, size + inputs).difference(&after)?;
    if let Some(row) = seen {
        let row = row_of(row, size)?.product(&basis)?;
        let square = row.transpose().product(&row)?;
        left =
            left.difference(&of_places(size + inputs, |i, j| square.get(i, j), Interval::ZERO))?;
    }
    prove_named("bound of what a disturbance adds", &left)
}

/// An ellipsoid $z^T P z \le c$, of which many rows are asked how far they reach.
#[derive(Clone, Debug)]
pub struct Ellipsoid {
    basis: IntervalMatrix,
    /// Below every eigenvalue of P in that basis.
    least: Interval,
}

impl Ellipsoid {
    /// That of a form.
    ///
    /// # Errors
    /// [`NotProved`] where it is not finite, symmetric and positive definite.
    pub fn of(p: &Matrix) -> Result<Self, NotProved> {
        Self::of_all(&symmetric("Lyapunov matrix", p)?)
    }

    /// One that holds those of all symmetric forms inside a matrix.
    ///
    /// # Errors
    /// As [`of`](Self::of).
    pub fn of_all(own: &IntervalMatrix) -> Result<Self, NotProved> {
        own.require_shape("Lyapunov matrix", own.rows(), own.rows())?;
        require_bounded("Lyapunov matrix", own)?;
        let basis = basis("Lyapunov matrix", &own.middle, own.rows())?;
        let turned = form(own, &basis)?;
        dominant("Lyapunov matrix", &turned)?;
        Ok(Self { basis, least: Interval::point(least_eigenvalue(&turned)) })
    }

    /// A bound of $|r z|$ for every row r inside, where $z^T P z \le 1$: $\sqrt{r P^{-1} r^T}$.
    ///
    /// # Errors
    /// [`NotProved`] for a row of another length.
    pub fn reach(&self, row: &[Interval]) -> Result<Interval, NotProved> {
        let turned = row_of(row, self.basis.rows())?.product(&self.basis)?;
        let squares = turned.entries().fold(Interval::ZERO, |sum, entry| sum + entry * entry);
        let reach = (squares / self.least).sqrt().upper();
        // Written so that NaN is refused.
        if reach >= 0.0 && reach.is_finite() {
            return Ok(Interval::point(reach));
        }
        let what = "reach of a row on the ellipsoid";
        Err(NotProved::Number { what, found: reach, allowed: "finite" })
    }
}

fn row_of(row: &[Interval], size: usize) -> Result<IntervalMatrix, NotProved> {
    if row.len() != size {
        let (found, allowed) = ((1, row.len()), (1, size));
        return Err(LtiError::Shape { what: "row", found, allowed }.into());
    }
    let row = IntervalMatrix::from_rows(&[row])?;
    require_bounded("row", &row)?;
    Ok(row)
}

/// A square matrix with a matrix in its first corner, ones on the diagonal behind it.
fn corner(matrix: &IntervalMatrix, size: usize) -> IntervalMatrix {
    corner_and(matrix, size, Interval::ONE)
}

/// The same with another number on the diagonal.
pub(super) fn corner_and(
    matrix: &IntervalMatrix,
    size: usize,
    diagonal: Interval,
) -> IntervalMatrix {
    of_places(size, |i, j| matrix.get(i, j), diagonal)
}

fn of_places(
    size: usize,
    first: impl Fn(usize, usize) -> Option<Interval>,
    diagonal: Interval,
) -> IntervalMatrix {
    let places = (0..size).flat_map(|i| (0..size).map(move |j| (i, j)));
    let entries: Vec<Interval> = places
        .map(|(i, j)| {
            let beyond = if i == j { diagonal } else { Interval::ZERO };
            first(i, j).unwrap_or(beyond)
        })
        .collect();
    IntervalMatrix::from_entries(size, size, entries)
}

pub(super) fn beside(left: &IntervalMatrix, right: &IntervalMatrix) -> IntervalMatrix {
    let columns = left.columns() + right.columns();
    let places = (0..left.rows()).flat_map(|i| (0..columns).map(move |j| (i, j)));
    let entry = |(i, j): (usize, usize)| {
        let entry = match j.checked_sub(left.columns()) {
            None => left.get(i, j),
            Some(j) => right.get(i, j),
        };
        entry.unwrap_or(Interval::ENTIRE)
    };
    let entries: Vec<Interval> = places.map(entry).collect();
    IntervalMatrix::from_entries(left.rows(), columns, entries)
}
