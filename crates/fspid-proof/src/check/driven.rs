//! Effect of an arbitrary disturbance on a sampled plant within one sample, bounded by its energy (controllability Gramian).
//!
//! For every disturbance w whose square can be integrated over the sample, by Cauchy and Schwarz,
//!
//! $$ v = \int_0^T e^{A (T - s)} b w(s) \ ds = W^{1/2} u, \qquad |u|^2 \le \int_0^T w^2 \ ds, \qquad
//!    W = \int_0^T e^{A s} b b^T e^{A^T s} \ ds $$
//!
//! so that a matrix E with $E E^T \succeq W$ holds every v as $E u$ with such a u: the sampled loop is driven by a
//! vector whose square adds up, over the samples, to no more than the energy of w.
//!
//! # Source
//! For W by one exponential, C. F. Van Loan, IEEE Trans. Automatic Control 23 (1978) 395; for what an energy reaches,
//! S. Boyd, L. El Ghaoui, E. Feron and V. Balakrishnan, *Linear Matrix Inequalities in System and Control Theory*,
//! SIAM 1994, section 6.1.

use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;

use super::definite::prove_named;
use super::error::NotProved;
use super::exponential::{exponential, require_bounded};
use super::factor::cholesky;
use super::matrix::IntervalMatrix;

/// W is taken larger by this share of its diagonal, so that its enclosure, and what rounding leaves of a factor of a
/// matrix that is nearly of rank one, lie below. It is a share of the energy.
const INFLATED: f64 = 1e-9;
/// A state that is driven by less than this share of the others, in their own units, is taken to be driven by so much.
const LEAST: f64 = 1e-30;

/// A matrix E with $E E^T \succeq W$, proved, for every A and b inside and every time inside `time_s`.
///
/// # Errors
/// [`NotProved`] for shapes that do not fit, entries or a time without bounds, a column of zeros, and where the
/// inequality could not be shown.
pub fn driven(
    a: &IntervalMatrix,
    b: &IntervalMatrix,
    time_s: Interval,
) -> Result<Matrix, NotProved> {
    const WHAT: &str = "what a disturbance adds in a sample";
    let states = a.rows();
    a.require_shape("state matrix", states, states)?;
    b.require_shape("input matrix", states, 1)?;
    let gramian = gramian(a, b, time_s)?;
    require_bounded(WHAT, &gramian)?;
    let factor = above(&gramian)?;
    let exact = IntervalMatrix::from(&factor);
    let more = exact.product(&exact.transpose())?.difference(&gramian)?;
    prove_named(WHAT, &more)?;
    Ok(factor)
}

/// W, enclosed:
///
/// $$ \exp \begin{pmatrix} -A t & b b^T t \cr 0 & A^T t \end{pmatrix} =
///    \begin{pmatrix} \cdot & G \cr 0 & F \end{pmatrix}, \qquad W = F^T G $$
fn gramian(
    a: &IntervalMatrix,
    b: &IntervalMatrix,
    time_s: Interval,
) -> Result<IntervalMatrix, NotProved> {
    let states = a.rows();
    let square = b.product(&b.transpose())?.scaled(time_s);
    let a = a.scaled(time_s);
    let entry = |matrix: &IntervalMatrix, row: usize, column: usize| {
        matrix.get(row, column).unwrap_or(Interval::ENTIRE)
    };
    let whole = |row: usize, column: usize| match (row < states, column < states) {
        (true, true) => -entry(&a, row, column),
        (true, false) => entry(&square, row, column - states),
        (false, true) => Interval::ZERO,
        (false, false) => entry(&a, column - states, row - states),
    };
    let moved = exponential(&of_entries(2 * states, whole))?;
    let corner = |row: usize, column: usize| entry(&moved, row, column + states);
    let over = of_entries(states, corner);
    let after = of_entries(states, |row, column| corner(row + states, column));
    Ok(after.transpose().product(&over)?)
}

fn of_entries(size: usize, entry: impl Fn(usize, usize) -> Interval) -> IntervalMatrix {
    let places = (0..size).flat_map(|row| (0..size).map(move |column| (row, column)));
    let entries = places.map(|(row, column)| entry(row, column));
    IntervalMatrix::from_entries(size, size, entries.collect::<Vec<_>>())
}

/// A factor of a little more than the middle, in ordinary arithmetic: in units in which the diagonal is 1.
fn above(gramian: &IntervalMatrix) -> Result<Matrix, NotProved> {
    let size = gramian.rows();
    let at = |row: usize, column: usize| gramian.middle[row * size + column];
    let most = (0..size).map(|place| at(place, place)).fold(0.0, f64::max);
    if !(most > 0.0 && most.is_finite()) {
        let what = "what a disturbance adds in a sample";
        return Err(NotProved::Number { what, found: most, allowed: "a finite number above 0" });
    }
    let unit: Vec<f64> = (0..size).map(|place| at(place, place).max(LEAST * most).sqrt()).collect();
    let share = |place: usize| {
        let (row, column) = (place / size, place % size);
        let share = at(row.min(column), row.max(column)) / (unit[row] * unit[column]);
        if row == column { share + INFLATED } else { share }
    };
    let shares: Vec<f64> = (0..size * size).map(share).collect();
    let factor = cholesky(&shares, size).map_err(|stopped| NotProved::NoFactor {
        what: "what a disturbance adds in a sample",
        row: stopped.row,
        pivot: stopped.pivot,
    })?;
    // R'R is the share, so that E = D R'.
    let row = |row: usize| -> Vec<f64> {
        (0..size).map(|column| unit[row] * factor[column * size + row]).collect()
    };
    Ok(Matrix::from_rows(&(0..size).map(row).collect::<Vec<_>>())?)
}
