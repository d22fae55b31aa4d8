//! Eigenvalues: against SciPy, 60-digit arithmetic and the classic matrices that make an iteration stall.

use crate::support;

use fspid_lti::{Complex, LtiError, Matrix, Polynomial, eigenvalues, modulus, spectral_radius};
use proptest::prelude::*;
use support::{complex_numbers, matrix, numbers, repeatable, rows, worst_relative};

type Outcome = Result<(), LtiError>;

/// Backward error in units of rounding that the iteration may leave, for a matrix of some ten rows.
const BACKWARD_TOL: f64 = 20.0 * f64::EPSILON;

fn companion(coefficients: &[f64]) -> Matrix {
    let size = coefficients.len() - 1;
    let mut matrix = Matrix::zeros(size, size);
    for k in 0..size {
        matrix.set(0, k, -coefficients[k + 1] / coefficients[0]).expect("the entry exists");
        if k + 1 < size {
            matrix.set(k + 1, k, 1.0).expect("the entry exists");
        }
    }
    matrix
}

#[test]
fn eigenvalues_are_as_good_as_their_condition_allows_and_agree_with_scipy() -> Outcome {
    for row in rows(include_str!("data/eigenvalues.csv")) {
        let found = eigenvalues(&matrix(row[1].parse().expect("a number"), &numbers(row[2])))?;
        let condition = numbers(row[5])[0];
        let (scipy, exact) = (complex_numbers(row[3]), complex_numbers(row[4]));
        let ours = worst_relative(&found, &exact);
        assert!(ours < BACKWARD_TOL * condition, "{}: {ours:e}, condition {condition:e}", row[0]);
        assert!(worst_relative(&found, &scipy) < BACKWARD_TOL * condition, "{}", row[0]);
    }
    Ok(())
}

#[test]
fn the_companion_matrix_of_the_sixth_roots_of_one_does_not_stall() -> Outcome {
    let found = eigenvalues(&companion(&[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]))?;
    let expected = Polynomial::new(&[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0])?.roots()?;
    assert!(worst_relative(&found, &expected) < 1e-14, "{found:?}");
    for size in 3..40 {
        let mut coefficients = vec![0.0; size + 1];
        (coefficients[0], coefficients[size]) = (1.0, -1.0);
        assert!((spectral_radius(&companion(&coefficients))? - 1.0).abs() < 1e-13, "{size}");
    }
    Ok(())
}

#[test]
fn a_triangular_matrix_has_its_diagonal_as_eigenvalues_to_the_bit() -> Outcome {
    let found = eigenvalues(&matrix(3, &[3.0, 5.0, 7.0, 0.0, -1.0, 9.0, 0.0, 0.0, 2.0]))?;
    assert_eq!(found, [-1.0, 2.0, 3.0].map(|re| Complex::new(re, 0.0)));
    Ok(())
}

#[test]
fn jordan_blocks_and_zeros_are_within_reach() -> Outcome {
    let jordan = Matrix::from_rows(&[[2.0, 1.0, 0.0], [0.0, 2.0, 1.0], [0.0, 0.0, 2.0]])?;
    assert_eq!(eigenvalues(&jordan)?, [Complex::new(2.0, 0.0); 3]);
    assert_eq!(eigenvalues(&Matrix::zeros(5, 5))?, [Complex::new(0.0, 0.0); 5]);
    assert_eq!(eigenvalues(&Matrix::zeros(0, 0))?, []);
    assert_eq!(spectral_radius(&Matrix::zeros(0, 0)), Ok(0.0));
    Ok(())
}

#[test]
fn equal_eigenvalues_in_different_blocks_do_not_stall_the_iteration() -> Outcome {
    // Used to run into the limit of steps: two blocks with eigenvalues 0 and 1 whose coupling never quite vanished.
    let rows = ["0001100", "0110000", "0000000", "0111000", "1100000", "0000000", "1010010"];
    let entries: Vec<f64> = rows.concat().bytes().map(|byte| f64::from(byte - b'0')).collect();
    let found = eigenvalues(&matrix(7, &entries))?;
    // Zero and one are multiple, hence the root of the rounding error.
    for (value, expected) in found.iter().zip([-1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0]) {
        assert!(modulus(value - Complex::new(expected, 0.0)) < 1e-5, "{found:?}");
    }
    Ok(())
}

#[test]
fn a_shift_register_has_only_eigenvalues_at_zero() -> Outcome {
    // Computation delay in a sampled loop: nilpotent, and already in Hessenberg form.
    let mut delay = Matrix::zeros(6, 6);
    for k in 1..6 {
        delay.set(k, k - 1, 1.0)?;
    }
    assert!(spectral_radius(&delay)? < 1e-2);
    Ok(())
}

#[test]
fn entries_at_the_ends_of_the_range_are_no_obstacle() -> Outcome {
    let plain = matrix(3, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0]);
    let expected = eigenvalues(&plain)?;
    for scale in [libm::exp2(-1000.0), libm::exp2(1000.0)] {
        let scaled: Vec<Complex> = expected.iter().map(|value| value * scale).collect();
        assert_eq!(eigenvalues(&plain.scaled(scale))?, scaled);
    }
    Ok(())
}

#[test]
fn what_has_no_eigenvalues_is_refused() -> Outcome {
    assert!(matches!(
        eigenvalues(&Matrix::zeros(2, 3)),
        Err(LtiError::Shape { found: (2, 3), allowed: (2, 2), .. })
    ));
    let mut broken = Matrix::identity(2);
    broken.set(0, 1, f64::NAN)?;
    assert!(matches!(eigenvalues(&broken), Err(LtiError::NotFinite { index: 1, .. })));
    assert!(spectral_radius(&broken).is_err());
    Ok(())
}

proptest! {
    #![proptest_config(repeatable())]

    #[test]
    fn eigenvalues_are_ordered_in_conjugate_pairs_and_sum_to_the_trace(entries in prop::collection::vec(-5.0..5.0_f64, 49)) {
        let matrix = matrix(7, &entries);
        let found = eigenvalues(&matrix)?;
        prop_assert!(found.windows(2).all(|pair| (pair[0].re, pair[0].im) <= (pair[1].re, pair[1].im)));
        for root in &found {
            prop_assert!(found.contains(&root.conj()));
        }
        let trace: f64 = (0..7).filter_map(|k| matrix.get(k, k)).sum();
        let sum = found.iter().fold(Complex::new(0.0, 0.0), |sum, value| sum + value);
        prop_assert!(modulus(sum - Complex::new(trace, 0.0)) < 1e-12, "{sum} {trace}");
    }

    #[test]
    fn a_change_of_units_does_not_change_the_eigenvalues(
        entries in prop::collection::vec(-5.0..5.0_f64, 25), units in prop::collection::vec(-12..12_i32, 5)
    ) {
        let plain = matrix(5, &entries);
        let mut other = plain.clone();
        for (row, &from) in units.iter().enumerate() {
            for (column, &to) in units.iter().enumerate() {
                other.set(row, column, libm::scalbn(entries[5 * row + column], from - to))?;
            }
        }
        // Each set is exact for a matrix within rounding of the balanced one; a nearly double eigenvalue feels its root.
        let (left, right) = (eigenvalues(&plain)?, eigenvalues(&other)?);
        prop_assert!(worst_relative(&left, &right) < 1e-6, "{left:?} {right:?}");
    }

    #[test]
    fn the_spectral_radius_is_within_every_norm(entries in prop::collection::vec(-5.0..5.0_f64, 36)) {
        let matrix = matrix(6, &entries);
        let radius = spectral_radius(&matrix)?;
        prop_assert!(radius <= matrix.norm_one() * (1.0 + 1e-14));
        prop_assert!(radius <= matrix.transpose().norm_one() * (1.0 + 1e-14));
    }
}
