//! The triangle of a symmetric matrix, by the method of Cholesky.

/// An entry of the triangle that is about to be computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Its row.
    pub row: usize,
    /// Its column, at most the row.
    pub column: usize,
    /// The entry of the matrix there.
    pub value: f64,
    /// What the columns before account for.
    pub known: f64,
    /// The diagonal of the triangle above it; none on the diagonal itself.
    pub diagonal: Option<f64>,
}

impl Entry {
    /// What is left of the matrix's entry.
    #[inline]
    #[must_use]
    pub fn rest(&self) -> f64 {
        self.value - self.known
    }
}

/// A matrix that is not positive definite: its row, and what should be above zero there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stopped {
    /// Row at which the factorisation ended.
    pub row: usize,
    /// The pivot.
    pub pivot: f64,
}

/// Fills the lower triangle L with $L L^T = A$, row after row; the rest of `lower` is left alone. `entry` decides what
/// becomes of a rest: [`definite`] where A must be positive definite.
///
/// # Source
/// G. H. Golub and C. F. Van Loan, *Matrix Computations*, 4th edition, algorithm 4.2.1.
///
/// # Errors
/// Those of `entry`; the rows above are then computed. A slice that is too short ends the work.
#[inline]
pub fn cholesky<E>(
    lower: &mut [f64],
    size: usize,
    matrix: impl Fn(usize, usize) -> f64,
    mut entry: impl FnMut(Entry) -> Result<f64, E>,
) -> Result<(), E> {
    for row in 0..size {
        let Some((above, own)) = lower.split_at_mut_checked(row * size) else { break };
        for column in 0..=row {
            let before = above.get(column * size..).unwrap_or_default();
            let known = dot(own, if column < row { before } else { own }, column);
            let diagonal = if column < row { before.get(column).copied() } else { None };
            let value = entry(Entry { row, column, value: matrix(row, column), known, diagonal })?;
            if let Some(place) = own.get_mut(column) {
                *place = value;
            }
        }
    }
    Ok(())
}

/// The entry of a positive definite matrix.
///
/// # Errors
/// [`Stopped`] unless every pivot is above zero and finite.
#[inline]
pub fn definite(entry: Entry) -> Result<f64, Stopped> {
    let rest = entry.rest();
    match entry.diagonal {
        Some(diagonal) => Ok(rest / diagonal),
        None if rest > 0.0 && rest.is_finite() => Ok(libm::sqrt(rest)),
        None => Err(Stopped { row: entry.row, pivot: rest }),
    }
}

/// Sum of as many products.
#[inline]
fn dot(left: &[f64], right: &[f64], count: usize) -> f64 {
    let (Some(left), Some(right)) = (left.get(..count), right.get(..count)) else { return 0.0 };
    left.iter().zip(right).map(|(left, right)| left * right).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MATRIX: [f64; 9] = [4.0, 2.0, -2.0, 2.0, 10.0, 2.0, -2.0, 2.0, 6.0];

    #[test]
    fn the_triangle_of_a_definite_matrix_is_its_root() {
        let mut lower = [0.0; 9];
        let done = cholesky(&mut lower, 3, |row, column| MATRIX[3 * row + column], definite);
        assert_eq!(done, Ok(()));
        assert_eq!(lower, [2.0, 0.0, 0.0, 1.0, 3.0, 0.0, -1.0, 1.0, 2.0]);
    }

    #[test]
    fn an_indefinite_matrix_and_one_that_is_no_number_are_stopped() {
        let mut lower = [0.0; 4];
        let indefinite = [1.0, 2.0, 2.0, 1.0];
        let done = cholesky(&mut lower, 2, |row, column| indefinite[2 * row + column], definite);
        assert_eq!(done, Err(Stopped { row: 1, pivot: -3.0 }));
        let done = cholesky(&mut lower, 1, |_, _| f64::NAN, definite);
        assert!(done.is_err_and(|it| it.row == 0 && it.pivot.is_nan()));
        assert_eq!(cholesky(&mut [], 2, |_, _| 1.0, definite), Ok(()));
    }
}
