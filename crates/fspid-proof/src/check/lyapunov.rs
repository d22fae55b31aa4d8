//! Conditions on Lyapunov functions $V(z) = z^T P z$ of a sampled loop $z_{k+1} = M z_k$.

use fspid_lti::{LtiError, Matrix};
use fspid_numeric::Scalar;
use fspid_numeric::rounding::sum_up;
use fspid_numeric::scalar::Interval;

use super::definite::{basis, dominant, form, prove_named, symmetric};
use super::error::{NotProved, positive};
use super::exponential::require_bounded;
use super::matrix::IntervalMatrix;

/// Proves that P is positive definite.
///
/// # Errors
/// [`NotProved`] where it is not square, finite and symmetric, or could not be shown to be.
pub fn is_positive(p: &Matrix) -> Result<(), NotProved> {
    prove_named("Lyapunov matrix", &symmetric("Lyapunov matrix", p)?)
}

/// What the S-procedure takes off: τ Q, so that only states with $z^T Q z \ge 0$ are asked about.
#[derive(Clone, Copy, Debug)]
pub struct Relaxation<'a> {
    /// τ, 0 or above.
    pub weight: f64,
    /// Q, symmetric.
    pub matrix: &'a IntervalMatrix,
}

/// Proves that V decreases by the factor `rate`² at least with every step, for every M inside `matrix`:
///
/// $$ \rho^2 P - M^T P M - \tau Q \succ 0 $$
///
/// With a relaxation (τ, Q), τ ≥ 0, only for states with $z^T Q z \ge 0$ (the S-procedure); without
/// one for all states but zero. The rate lies between 0 and 1.
///
/// That P is positive definite is proved as well. `matrix` is meant to be narrow (rounding, the enclosure
/// of a plant): the bounds for wide ones are not the closest. A set of gains is given by its corners,
/// as $M^T P M$ is convex in M.
///
/// # Errors
/// [`NotProved`] where shapes do not fit, an entry is not finite, P or Q is not symmetric, rate or τ
/// is not allowed, or the difference could not be shown to be positive definite.
pub fn decreases(
    p: &Matrix,
    rate: f64,
    matrix: &IntervalMatrix,
    relaxation: Option<Relaxation<'_>>,
) -> Result<(), NotProved> {
    let own = symmetric("Lyapunov matrix", p)?;
    prove_decrease([&own, &own], rate, matrix, relaxation)
}

/// Proves that $z^T P_{\text{next}} z$ after a step is below `rate`² times $z^T P_{\text{now}} z$ before it:
///
/// $$ \rho^2 P_{\text{now}} - M^T P_{\text{next}} M - \tau Q \succ 0 $$
///
/// for every M inside `matrix`; for Lyapunov functions that change with what changes in the loop. All
/// else is as in [`decreases`]; of the two matrices only the first is proved to be positive definite.
///
/// # Errors
/// As [`decreases`].
pub fn decreases_between(
    p_now: &Matrix,
    p_next: &Matrix,
    rate: f64,
    matrix: &IntervalMatrix,
    relaxation: Option<Relaxation<'_>>,
) -> Result<(), NotProved> {
    let now = symmetric("Lyapunov matrix", p_now)?;
    let next = symmetric("next Lyapunov matrix", p_next)?;
    prove_decrease([&now, &next], rate, matrix, relaxation)
}

/// All is computed in the basis X in which the present form is about the identity, with M X before
/// anything else: what is uncertain in M is then weighed with the root of the condition number of P,
/// and not with the number itself.
fn prove_decrease(
    [now, next]: [&IntervalMatrix; 2],
    rate: f64,
    matrix: &IntervalMatrix,
    relaxation: Option<Relaxation<'_>>,
) -> Result<(), NotProved> {
    const WHAT: &str = "fall of the Lyapunov function";
    let size = now.rows();
    next.require_shape("next Lyapunov matrix", size, size)?;
    matrix.require_shape("matrix of the loop", size, size)?;
    require_bounded("matrix of the loop", matrix)?;
    if !(0.0..=1.0).contains(&rate) {
        return Err(NotProved::Number { what: "rate", found: rate, allowed: "0 to 1" });
    }
    let basis = basis("Lyapunov matrix", &now.middle, size)?;
    let (rate, present) = (Interval::point(rate), form(now, &basis)?);
    dominant("Lyapunov matrix", &present)?;
    let before = present.scaled(rate * rate);
    let after = form(next, &matrix.product(&basis)?)?;
    let mut decrease = before.difference(&after)?;
    if let Some(relaxation) = relaxation {
        let q = weighed(relaxation, size)?;
        decrease = decrease.difference(&form(&q, &basis)?)?;
    }
    prove_named(WHAT, &decrease)
}

/// $\tau Q$ with τ ≥ 0 and a Q whose bounds are symmetric; of the matrices inside it the symmetric ones
/// are meant.
fn weighed(relaxation: Relaxation<'_>, size: usize) -> Result<IntervalMatrix, NotProved> {
    let Relaxation { weight: tau, matrix: q } = relaxation;
    if !(tau >= 0.0 && tau.is_finite()) {
        let allowed = "a finite number, 0 or above";
        return Err(NotProved::Number { what: "weight of the relaxation", found: tau, allowed });
    }
    require_bounded("matrix of the relaxation", q)?;
    q.require_shape("matrix of the relaxation", size, size)?;
    let places = (0..size).flat_map(|row| (0..row).map(move |column| (row, column)));
    for (row, column) in places {
        if q.get(row, column) != q.get(column, row) {
            let what = "matrix of the relaxation";
            return Err(NotProved::NotSymmetric { what, row, column });
        }
    }
    Ok(q.scaled(Interval::point(tau)))
}

/// Proves that $|r z| \le$ `limit` wherever $z^T P z \le$ `level`, for every row r inside `row`:
///
/// $$ \begin{pmatrix} P & r^T \cr r & \text{limit}^2 / \text{level} \end{pmatrix} \succ 0 $$
///
/// This holds exactly where P is positive definite and $r P^{-1} r^T <$ limit²/level, the largest value
/// of $(r z)^2$ over the ellipsoid being level times the left side.
///
/// # Errors
/// [`NotProved`] where shapes do not fit, a number is not allowed, P is not symmetric, or the limit could
/// not be shown to hold.
pub fn inside_limit(p: &Matrix, level: f64, row: &[Interval], limit: f64) -> Result<(), NotProved> {
    let (level, limit) = (positive("level", level)?, positive("limit", limit)?);
    let own = symmetric("Lyapunov matrix", p)?;
    if row.len() != own.rows() {
        let (found, allowed) = ((1, row.len()), (1, own.rows()));
        return Err(LtiError::Shape { what: "row", found, allowed }.into());
    }
    let row = IntervalMatrix::from_rows(&[row])?;
    require_bounded("row", &row)?;
    let basis = basis("Lyapunov matrix", &own.middle, own.rows())?;
    let limit = Interval::point(limit);
    let corner = limit * limit / Interval::point(level);
    let bordered = bordered(&form(&own, &basis)?, &row.product(&basis)?, corner);
    prove_named("limit on the ellipsoid", &bordered)
}

/// A bound of $|r z|$ over the ellipsoid $z^T P z \le$ `level`, for every row r inside `row`:
/// $\sqrt{c r P^{-1} r^T}$, as in [`inside_limits`].
///
/// # Errors
/// [`NotProved`] where shapes do not fit, a number is not allowed, or P is not symmetric and positive definite.
pub fn reach(p: &Matrix, level: f64, row: &[Interval]) -> Result<f64, NotProved> {
    if level == 0.0 {
        return Ok(0.0);
    }
    let level = Interval::point(positive("level", level)?);
    let own = symmetric("Lyapunov matrix", p)?;
    let size = own.rows();
    if row.len() != size {
        return Err(
            LtiError::Shape { what: "row", found: (1, row.len()), allowed: (1, size) }.into()
        );
    }
    let basis = basis("Lyapunov matrix", &own.middle, size)?;
    let turned_form = form(&own, &basis)?;
    dominant("Lyapunov matrix", &turned_form)?;
    let least = Interval::point(least_eigenvalue(&turned_form));
    let turned = IntervalMatrix::from_rows(&[row])?.product(&basis)?;
    let squares = turned.entries().fold(Interval::ZERO, |sum, entry| sum + entry * entry);
    Ok((squares * level / least).sqrt().upper())
}

/// As [`inside_limit`] for many rows, each with its limit, and for every symmetric P inside a matrix.
///
/// In the basis X in which the middle of P is about the identity, with $\lambda$ below all eigenvalues of
/// $X^T P X$ (Gershgorin), $r P^{-1} r^T \le |r X|^2 / \lambda$.
///
/// # Errors
/// As [`inside_limit`]; the first limit that could not be shown is named.
pub fn inside_limits(
    p: &IntervalMatrix,
    level: f64,
    rows: &[(Vec<Interval>, f64)],
) -> Result<(), NotProved> {
    let level = Interval::point(positive("level", level)?);
    let size = p.rows();
    p.require_shape("Lyapunov matrix", size, size)?;
    require_bounded("Lyapunov matrix", p)?;
    let basis = basis("Lyapunov matrix", &p.middle, size)?;
    let own = form(p, &basis)?;
    dominant("Lyapunov matrix", &own)?;
    let least = Interval::point(least_eigenvalue(&own));
    for (number, (row, limit)) in rows.iter().enumerate() {
        if row.len() != size {
            let (found, allowed) = ((1, row.len()), (1, size));
            return Err(LtiError::Shape { what: "row", found, allowed }.into());
        }
        let turned = IntervalMatrix::from_rows(&[row])?.product(&basis)?;
        let squares = turned.entries().fold(Interval::ZERO, |sum, entry| sum + entry * entry);
        let found = (squares * level / least).sqrt().upper();
        if !(found <= positive("limit", *limit)?) {
            return Err(NotProved::BeyondLimit { row: number, found, limit: *limit });
        }
    }
    Ok(())
}

/// A number that no eigenvalue of a dominant symmetric matrix is below.
pub(super) fn least_eigenvalue(matrix: &IntervalMatrix) -> f64 {
    let size = matrix.columns.max(1);
    let magnitudes = matrix.magnitudes();
    let rows = magnitudes.chunks(size).enumerate().map(|(row, sizes)| {
        let diagonal = matrix.get(row, row).unwrap_or(Interval::ENTIRE);
        let beside = sizes.iter().enumerate().filter(|&(column, _)| column != row);
        (diagonal - Interval::point(beside.fold(0.0, |sum, (_, &size)| sum_up(sum, size)))).lower()
    });
    rows.fold(f64::INFINITY, f64::min)
}

/// A symmetric matrix with a row below, the same as a column beside, and a corner.
fn bordered(matrix: &IntervalMatrix, row: &IntervalMatrix, corner: Interval) -> IntervalMatrix {
    let size = matrix.rows();
    let entry = |place: usize| match (place / (size + 1), place % (size + 1)) {
        (i, j) if i < size && j < size => matrix.get(i, j),
        (i, j) if i < size || j < size => row.get(0, i.min(j)),
        _ => Some(corner),
    };
    let places = 0..(size + 1) * (size + 1);
    let entries = places.map(|place| entry(place).unwrap_or(Interval::ENTIRE));
    IntervalMatrix::from_entries(size + 1, size + 1, entries)
}
