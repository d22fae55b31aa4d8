//! Exact sampling of a linear system whose input is held constant between samples.

use crate::error::LtiError;
use crate::exponential::{exponential, exponential_change};
use crate::fine::FineMatrix;
use crate::matrix::Matrix;

/// Binary exponent that the input columns are scaled to, far below the states.
///
/// The result is linear in each column, so the scaling is exact; without it, large input coefficients would force
/// needless halvings of the whole matrix and spoil the balance of the states.
const INPUT_EXPONENT: i32 = -64;

/// State and input matrices of the sampled system, for an input held over `dt_s` seconds.
///
/// $$ A_d = e^{A T}, \quad B_d = \int_0^T e^{A \tau} B \ d\tau, \quad
/// \exp \begin{pmatrix} A T & B T \cr 0 & 0 \end{pmatrix} = \begin{pmatrix} A_d & B_d \cr 0 & I \end{pmatrix} $$
///
/// # Source
/// C. F. Van Loan, Computing integrals involving the matrix exponential, IEEE Trans. Automatic Control 23 (1978) 395.
///
/// # Errors
/// A state matrix that is not square, an input matrix with another number of rows, an entry that is not finite, a
/// sample period that is not above zero and finite, a result that overflows.
pub fn zero_order_hold(a: &Matrix, b: &Matrix, dt_s: f64) -> Result<(Matrix, Matrix), LtiError> {
    a.require_square_and_finite("state matrix")?;
    b.require_shape("input matrix", a.rows(), b.columns())?;
    LtiError::unless_finite("input matrix", b.data())?;
    if !(dt_s > 0.0 && dt_s.is_finite()) {
        return Err(LtiError::NotPositive { what: "sample period in seconds", value: dt_s });
    }
    let (states, inputs) = (a.rows(), b.columns());
    let b_dt = b.scaled(dt_s);
    let shifts: Vec<i32> =
        (0..inputs).map(|input| INPUT_EXPONENT - libm::frexp(b_dt.column_norm(input)).1).collect();
    let augmented = Matrix::from_function(states + inputs, states + inputs, |row, column| {
        match column.checked_sub(states) {
            _ if row >= states => 0.0,
            Some(input) => libm::scalbn(b_dt.at(row, input), shifts[input]),
            None => a.at(row, column) * dt_s,
        }
    });
    let sampled = exponential(&augmented)?;
    let a_sampled = Matrix::from_function(states, states, |row, column| sampled.at(row, column));
    let b_sampled = Matrix::from_function(states, inputs, |row, input| {
        libm::scalbn(sampled.at(row, states + input), -shifts[input])
    });
    LtiError::unless_finite("sampled input matrix", b_sampled.data())?;
    Ok((a_sampled, b_sampled))
}

/// What a sample changes: $A_d - I$ and $B_d$ of [`zero_order_hold`], with twice the working precision.
///
/// # Errors
/// As [`zero_order_hold`].
pub fn held_change(
    a: &FineMatrix,
    b: &FineMatrix,
    dt_s: f64,
) -> Result<(FineMatrix, FineMatrix), LtiError> {
    a.high().require_square_and_finite("state matrix")?;
    let (states, inputs) = (a.high().rows(), b.high().columns());
    b.high().require_shape("input matrix", states, inputs)?;
    // Inputs of the size of 1, so that they force no halvings.
    let shifts: Vec<i32> =
        (0..inputs).map(|input| -libm::frexp(b.high().column_norm(input) * dt_s).1).collect();
    let size = states + inputs;
    let augmented =
        FineMatrix::from_function((size, size), |row, column| match column.checked_sub(states) {
            _ if row >= states => [0.0; 2],
            Some(input) => b.at(row, input).map(|value| libm::scalbn(value, shifts[input])),
            None => a.at(row, column),
        });
    let change = exponential_change(&augmented, dt_s)?;
    let state = FineMatrix::from_function((states, states), |row, column| change.at(row, column));
    let input = FineMatrix::from_function((states, inputs), |row, input| {
        change.at(row, states + input).map(|value| libm::scalbn(value, -shifts[input]))
    });
    Ok((state, input))
}
