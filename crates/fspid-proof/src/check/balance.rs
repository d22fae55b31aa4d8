//! Units of states by powers of two, after which rows and columns are of similar size.

use fspid_numeric::matrix::{balance as sweep, is_worthwhile};

/// Sweeps after which the matrix is taken as it is; two or three are usual.
const SWEEPS: usize = 60;
/// No unit moves further than this, so that nothing leaves the range of floats.
const FURTHEST: i32 = 300;

/// Exponents e, so that entries times $2^{e_j - e_i}$ make a matrix of small norm.
///
/// `magnitudes` are the absolute values of a square matrix, row after row. Whatever is answered, the
/// change of units is exact; only the width of what follows depends on it.
///
/// # Source
/// As [`fspid_numeric::matrix::balance`], with sums for norms: intervals ask for no more.
#[must_use]
pub fn balance(mut magnitudes: Vec<f64>, size: usize) -> Vec<i32> {
    let mut exponents: Vec<i32> = vec![0; size];
    sweep(size, SWEEPS, |i| {
        let change = worthwhile(&magnitudes, size, i);
        let changes = change != 0 && (exponents[i] + change).abs() <= FURTHEST;
        if changes {
            rescale(&mut magnitudes, size, i, change);
            exponents[i] += change;
        }
        changes
    });
    exponents
}

/// Exponent of the power of two nearest to the root of row over column, or 0 when it gains little.
fn worthwhile(magnitudes: &[f64], size: usize, i: usize) -> i32 {
    let others = || (0..size).filter(|&other| other != i);
    let column: f64 = others().map(|row| magnitudes[row * size + i]).sum();
    let row: f64 = others().map(|column| magnitudes[i * size + column]).sum();
    let ratio = row / column;
    if !(ratio > 0.0 && ratio.is_finite()) {
        return 0;
    }
    let change = libm::frexp(ratio).1 / 2;
    if is_worthwhile(row, column, change) { change } else { 0 }
}

fn rescale(magnitudes: &mut [f64], size: usize, i: usize, change: i32) {
    for other in (0..size).filter(|&other| other != i) {
        let (down, across) = (other * size + i, i * size + other);
        magnitudes[down] = libm::scalbn(magnitudes[down], change);
        magnitudes[across] = libm::scalbn(magnitudes[across], -change);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_in_units_far_apart_are_brought_together() {
        let exponents = balance(vec![1.0, 1e6, 1e-6, 2.0], 2);
        let change = exponents[1] - exponents[0];
        let [above, below] = [libm::scalbn(1e6, change), libm::scalbn(1e-6, -change)];
        assert!(above < 4.0 && below < 4.0 && above + below > 0.5, "{above} {below}");
    }

    #[test]
    fn a_state_takes_the_root_of_what_its_row_is_over_its_column() {
        // 10¹² is nearly 2⁴⁰: the first state alone moves, by 2²⁰.
        assert_eq!(balance(vec![1.0, 1e6, 1e-6, 2.0], 2), [20, 0]);
    }

    #[test]
    fn no_unit_moves_so_far_that_entries_leave_the_range_of_floats() {
        assert_eq!(balance(vec![1.0, 1e150, 1e-150, 1.0], 2), [0, 0]);
        // In two steps the second state would go further than in one.
        let [one, other] = [-320, 160].map(|exponent| libm::scalbn(1.0, exponent));
        let exponents = balance(vec![0.0, 0.0, 1.0, 0.0, 0.0, one, 0.0, other, 0.0], 3);
        assert_eq!(exponents, [0, -298, -69]);
    }

    #[test]
    fn rows_of_zeros_and_matrices_without_bounds_are_left_alone() {
        assert_eq!(balance(vec![1.0, 1e9, 0.0, 0.0], 2), [0, 0]);
        assert_eq!(balance(vec![1.0, f64::INFINITY, 1.0, f64::NAN], 2), [0, 0]);
        assert!(balance(Vec::new(), 0).is_empty());
    }
}
