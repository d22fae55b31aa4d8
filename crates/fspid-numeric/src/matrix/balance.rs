//! Balancing: units of rows and columns by powers of two, after which both are of similar size.

/// A change of unit must shrink row plus column by this factor to be worth making.
const WORTHWHILE: f64 = 0.95;

/// Improves the unit of each row with its column in turn until none changes, at most `sweeps` times. `improve` says
/// whether it changed the one that it was given.
///
/// # Source
/// B. N. Parlett and C. Reinsch, *Balancing a matrix for calculation of eigenvalues and eigenvectors*, Numer. Math. 13
/// (1969) 293.
pub fn balance(size: usize, sweeps: usize, mut improve: impl FnMut(usize) -> bool) {
    for _ in 0..sweeps {
        let mut changed = false;
        for place in 0..size {
            changed |= improve(place);
        }
        if !changed {
            break;
        }
    }
}

/// Whether a column times $2^e$ and its row over it are together so much smaller that the change is worth making.
#[must_use]
pub fn is_worthwhile(row: f64, column: f64, exponent: i32) -> bool {
    let after = libm::scalbn(column, exponent) + libm::scalbn(row, -exponent);
    after < WORTHWHILE * (column + row)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sweeps_end_when_nothing_changes_and_at_the_latest_after_their_number() {
        let mut calls = 0;
        balance(3, 10, |place| {
            calls += 1;
            place == 1 && calls < 4
        });
        assert_eq!(calls, 6);
        let mut calls = 0;
        balance(1, 10, |_| {
            calls += 1;
            true
        });
        assert_eq!(calls, 10);
    }

    #[test]
    fn only_a_change_that_shrinks_by_a_twentieth_is_made() {
        assert!(is_worthwhile(16.0, 1.0, 2));
        assert!(!is_worthwhile(2.0, 1.0, 1) && !is_worthwhile(1.0, 1.0, 0));
        assert!(!is_worthwhile(f64::NAN, 1.0, 1));
    }
}
