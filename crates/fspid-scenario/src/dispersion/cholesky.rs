//! A correlation matrix as the square of a triangle.

use fspid_numeric::matrix::{Entry, cholesky};

use super::error::DispersionError;

/// How far a correlation may be from its mirror image, from 1 on the diagonal, and beyond what the
/// others allow: rounding of whoever computed the matrix.
const TOLERANCE: f64 = 1e-12;

/// A diagonal entry of the triangle below which the row adds nothing of its own: what rounding
/// leaves of 0, the square root of some 1e-16. It can cost correlations an error of this size.
const NOTHING: f64 = 1e-7;

/// The lower triangle L with $L L^T = C$, row after row, each up to its diagonal.
///
/// By the method of Cholesky, which goes through a positive semidefinite matrix as well: where the
/// diagonal of L is 0, the rest of its column is 0. At each entry the rows above and the columns
/// before leave an interval for the correlation; one outside is a contradiction.
///
/// # Errors
/// [`DispersionError`] for a matrix that is not square with `entries` rows, symmetric, 1 on its
/// diagonal, between -1 and 1 elsewhere, and positive semidefinite.
pub(super) fn triangle(
    entries: usize,
    correlation: &[Vec<f64>],
) -> Result<Vec<Vec<f64>>, DispersionError> {
    check(entries, correlation)?;
    let mut triangle = vec![0.0; entries * entries];
    // Variance that the columns so far do not explain: summed up as each row grows, so that it is never below 0.
    let mut left: f64 = 1.0;
    let matrix = |row: usize, column: usize| correlation[row][column];
    cholesky(&mut triangle, entries, matrix, |entry| {
        if entry.column == 0 {
            left = 1.0;
        }
        let Some(diagonal) = entry.diagonal else { return Ok(libm::sqrt(left)) };
        let value = next_entry(entry, diagonal, libm::sqrt(left))?;
        left = (left - value * value).max(0.0);
        Ok(value)
    })?;
    Ok((0..entries).map(|row| triangle[row * entries..][..=row].to_vec()).collect())
}

/// An entry below the diagonal, where at most `most` is left for it.
fn next_entry(entry: Entry, diagonal: f64, most: f64) -> Result<f64, DispersionError> {
    let Entry { row, column, value, known, .. } = entry;
    let diagonal = if diagonal > NOTHING { diagonal } else { 0.0 };
    let reach = most * diagonal;
    let rest = entry.rest();
    if !(rest.abs() <= reach + TOLERANCE) {
        let (lowest, highest) = (known - reach, known + reach);
        return Err(DispersionError::Contradiction { row, column, value, lowest, highest });
    }
    Ok(if diagonal > 0.0 { (rest / diagonal).clamp(-most, most) } else { 0.0 })
}

/// Refuses what is no correlation matrix at first sight.
fn check(entries: usize, correlation: &[Vec<f64>]) -> Result<(), DispersionError> {
    if correlation.len() != entries {
        return Err(DispersionError::Rows { found: correlation.len(), allowed: entries });
    }
    for (row, correlations) in correlation.iter().enumerate() {
        if correlations.len() != entries {
            let found = correlations.len();
            return Err(DispersionError::Columns { row, found, allowed: entries });
        }
    }
    for (row, correlations) in correlation.iter().enumerate() {
        let diagonal = correlations[row];
        if !((diagonal - 1.0).abs() <= TOLERANCE) {
            return Err(DispersionError::Diagonal { row, value: diagonal });
        }
        for (column, &value) in correlations.iter().enumerate().take(row) {
            let mirrored = correlation[column][row];
            for (row, column, value) in [(row, column, value), (column, row, mirrored)] {
                if !((-1.0..=1.0).contains(&value)) {
                    return Err(DispersionError::Correlation { row, column, value });
                }
            }
            if !((value - mirrored).abs() <= TOLERANCE) {
                return Err(DispersionError::NotSymmetric { row, column, value, mirrored });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest difference between the square of the triangle and the matrix.
    fn residual(matrix: &[Vec<f64>]) -> f64 {
        let triangle = triangle(matrix.len(), matrix).unwrap();
        let mut worst: f64 = 0.0;
        for (row, a) in triangle.iter().enumerate() {
            for (column, b) in triangle.iter().enumerate() {
                let sum: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
                worst = worst.max((sum - matrix[row][column]).abs());
            }
        }
        worst
    }

    #[test]
    fn the_square_of_the_triangle_is_the_matrix() {
        let regular = [vec![1.0, 0.5, -0.3], vec![0.5, 1.0, 0.2], vec![-0.3, 0.2, 1.0]];
        assert!(residual(&regular) < 1e-15);
        let t = triangle(3, &regular).unwrap();
        assert_eq!((t[1][0], t[2][0]), (0.5, -0.3));
        assert_eq!(t[1][1], libm::sqrt(0.75));
        assert_eq!(triangle(0, &[]), Ok(Vec::new()));
    }

    #[test]
    fn a_matrix_whose_entries_determine_each_other_is_taken() {
        // The second repeats the first, the third mirrors it.
        let same = [vec![1.0, 1.0, -1.0], vec![1.0, 1.0, -1.0], vec![-1.0, -1.0, 1.0]];
        assert!(residual(&same) < 1e-15);
        // 0.6² + 0.8² = 1: the last is determined by the first two, in any order.
        for order in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let matrix = [[1.0, 0.0, 0.6], [0.0, 1.0, 0.8], [0.6, 0.8, 1.0]];
            let turned: Vec<Vec<f64>> =
                order.map(|row| order.map(|column| matrix[row][column]).to_vec()).to_vec();
            assert!(residual(&turned) < 1e-12, "{order:?}: {:e}", residual(&turned));
        }
        // After a row that adds nothing of its own.
        let twice = [
            vec![1.0, 1.0, 0.4, 0.1],
            vec![1.0, 1.0, 0.4, 0.1],
            vec![0.4, 0.4, 1.0, 0.2],
            vec![0.1, 0.1, 0.2, 1.0],
        ];
        assert!(residual(&twice) < 1e-15);
    }

    #[test]
    fn a_contradiction_is_named_with_what_would_be_allowed() {
        let all = [vec![1.0, 0.9, -0.9], vec![0.9, 1.0, 0.9], vec![-0.9, 0.9, 1.0]];
        let Err(DispersionError::Contradiction { row, column, value, lowest, highest }) =
            triangle(3, &all)
        else {
            panic!("taken")
        };
        assert_eq!((row, column, value), (2, 1, 0.9));
        // -0.81 ± (1 - 0.81).
        assert!((lowest + 1.0).abs() < 1e-15 && (highest + 0.62).abs() < 1e-15);
        let equal = [vec![1.0, 1.0, 0.3], vec![1.0, 1.0, 0.2], vec![0.3, 0.2, 1.0]];
        let error = triangle(3, &equal).unwrap_err();
        assert!(matches!(error, DispersionError::Contradiction { row: 2, column: 1, .. }));
    }
}
