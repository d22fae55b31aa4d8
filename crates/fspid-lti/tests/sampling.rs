//! Matrix exponential and zero-order hold: against closed forms, 200-digit arithmetic and SciPy.

use crate::support;

use fspid_lti::{
    LtiError, Matrix, TransferFunction, exponential, spectral_radius, zero_order_hold,
};
use proptest::prelude::*;
use support::{matrix, numbers, repeatable, rows};

type Outcome = Result<(), LtiError>;

/// Largest entry error, as a part of the largest entry expected.
fn norm_error(found: &[f64], expected: &[f64]) -> f64 {
    let largest = expected.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    found
        .iter()
        .zip(expected)
        .fold(0.0, |worst: f64, (found, expected)| worst.max((found - expected).abs() / largest))
}

/// Largest relative entry error; entries that are zero must be zero.
fn entry_error(found: &[f64], expected: &[f64]) -> f64 {
    let error = |found: f64, expected: f64| {
        if expected == 0.0 { found.abs() } else { ((found - expected) / expected).abs() }
    };
    found
        .iter()
        .zip(expected)
        .fold(0.0, |worst, (&found, &expected)| f64::max(worst, error(found, expected)))
}

#[test]
fn the_exponential_of_zero_is_the_identity_to_the_bit() -> Outcome {
    assert_eq!(exponential(&Matrix::zeros(4, 4))?, Matrix::identity(4));
    assert_eq!(exponential(&Matrix::zeros(0, 0))?, Matrix::zeros(0, 0));
    Ok(())
}

#[test]
fn the_exponential_of_a_nilpotent_matrix_is_its_short_series() -> Outcome {
    let nilpotent = matrix(4, &[0., 6., 0., 0., 0., 0., 6., 0., 0., 0., 0., 6., 0., 0., 0., 0.]);
    let expected = [1., 6., 18., 36., 0., 1., 6., 18., 0., 0., 1., 6., 0., 0., 0., 1.];
    assert!(entry_error(exponential(&nilpotent)?.data(), &expected) < 1e-15);
    Ok(())
}

#[test]
fn the_exponential_of_a_rotation_rate_is_a_rotation() -> Outcome {
    for angle in [1e-8, 0.3, 3.0, 40.0] {
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        let found = exponential(&matrix(2, &[0.0, -angle, angle, 0.0]))?;
        // Squaring doubles the relative error each time: about angle * 1e-16.
        assert!(norm_error(found.data(), &[c, -s, s, c]) < 1e-15 * (1.0 + angle), "{angle}");
    }
    Ok(())
}

#[test]
fn the_exponential_agrees_with_the_decomposition_into_eigenvectors() -> Outcome {
    // Moler and Van Loan, Nineteen dubious ways, section 3: eigenvalues -1 and -17, vectors (1, 2) and (3, 4).
    let found = exponential(&matrix(2, &[-49.0, 24.0, -64.0, 31.0]))?;
    let (slow, fast) = (libm::exp(-1.0), libm::exp(-17.0));
    let expected = [
        -2.0 * slow + 3.0 * fast,
        1.5 * (slow - fast),
        -4.0 * (slow - fast),
        3.0 * slow - 2.0 * fast,
    ];
    assert!(norm_error(found.data(), &expected) < 1e-13, "{found:?}");
    Ok(())
}

#[test]
fn units_that_lie_twelve_decades_apart_cost_no_digits() -> Outcome {
    let even = exponential(&matrix(2, &[-1.0, 1.0, -1.0, -2.0]))?;
    let uneven =
        exponential(&matrix(2, &[-1.0, 4096.0 * 1048576.0, -1.0 / (4096.0 * 1048576.0), -2.0]))?;
    let expected = [
        even.data()[0],
        even.data()[1] * 4294967296.0,
        even.data()[2] / 4294967296.0,
        even.data()[3],
    ];
    assert!(entry_error(uneven.data(), &expected) < 1e-15);
    Ok(())
}

#[test]
fn what_has_no_exponential_is_refused() -> Outcome {
    assert!(matches!(exponential(&Matrix::zeros(2, 3)), Err(LtiError::Shape { .. })));
    for value in [f64::NAN, f64::INFINITY] {
        let mut broken = Matrix::identity(2);
        broken.set(1, 0, value)?;
        assert!(matches!(exponential(&broken), Err(LtiError::NotFinite { .. })));
    }
    assert!(matches!(
        exponential(&Matrix::identity(2).scaled(1e3)),
        Err(LtiError::NotFinite { .. })
    ));
    assert!(exponential(&matrix(2, &[1e308, 1e308, 1e308, 1e308])).is_err());
    assert_eq!(exponential(&Matrix::identity(2).scaled(-1e300))?, Matrix::zeros(2, 2));
    Ok(())
}

#[test]
fn a_lag_and_a_double_integrator_are_sampled_as_in_the_textbook() -> Outcome {
    let dt_s = 0.02;
    let (a, b) = zero_order_hold(&matrix(1, &[-10.0]), &matrix(1, &[10.0]), dt_s)?;
    assert!(entry_error(a.data(), &[libm::exp(-0.2)]) < 1e-15);
    assert!(entry_error(b.data(), &[-libm::expm1(-0.2)]) < 1e-15);
    let (a, b) = zero_order_hold(&matrix(2, &[0.0, 1.0, 0.0, 0.0]), &matrix(2, &[0.0, 1.0]), dt_s)?;
    assert!(entry_error(a.data(), &[1.0, dt_s, 0.0, 1.0]) < 1e-15);
    assert!(entry_error(b.data(), &[0.5 * dt_s * dt_s, dt_s]) < 1e-15);
    Ok(())
}

#[test]
fn an_oscillator_is_sampled_as_in_the_textbook() -> Outcome {
    let (rate, dt_s) = (3.0, 0.1);
    let (s, c) = (libm::sin(rate * dt_s), libm::cos(rate * dt_s));
    let (a, b) =
        zero_order_hold(&matrix(2, &[0.0, 1.0, -rate * rate, 0.0]), &matrix(2, &[0.0, 1.0]), dt_s)?;
    assert!(entry_error(a.data(), &[c, s / rate, -rate * s, c]) < 2e-15);
    assert!(entry_error(b.data(), &[(1.0 - c) / (rate * rate), s / rate]) < 2e-15);
    Ok(())
}

/// A row of the table: what is sampled here, with 200 digits, and by SciPy; state entries first, then input entries.
struct Sampled {
    name: String,
    dt_s: f64,
    found: [Vec<f64>; 2],
    exact: [Vec<f64>; 2],
    scipy: [Vec<f64>; 2],
}

fn sampled_table() -> Result<Vec<Sampled>, LtiError> {
    let read = |row: Vec<&str>| {
        let states = row[1].parse().expect("the table holds numbers");
        let dt_s = numbers(row[2])[0];
        let [a, b] = [3, 4].map(|field| matrix(states, &numbers(row[field])));
        let (a, b) = zero_order_hold(&a, &b, dt_s)?;
        let pair = |first: usize| [numbers(row[first]), numbers(row[first + 1])];
        let found = [a.data().to_vec(), b.data().to_vec()];
        Ok(Sampled { name: row[0].to_owned(), dt_s, found, exact: pair(5), scipy: pair(7) })
    };
    rows(include_str!("data/sampled.csv")).map(read).collect()
}

/// Asked of each entry at the sample periods of controllers, and of SciPy's distance from us.
const SAMPLED_TOL: f64 = 1e-14;
/// Asked at every sample period, as a part of the largest entry. Over a whole second some entries nearly cancel.
const NORM_TOL: f64 = 2e-15;

#[test]
fn the_zero_order_hold_is_exact_to_fourteen_digits() -> Outcome {
    for row in sampled_table()? {
        for (found, exact) in row.found.iter().zip(&row.exact) {
            let (entries, norm) = (entry_error(found, exact), norm_error(found, exact));
            assert!(norm < NORM_TOL, "{}: {norm:e}", row.name);
            assert!(entries < SAMPLED_TOL || row.dt_s >= 1.0, "{}: {entries:e}", row.name);
        }
    }
    Ok(())
}

#[test]
fn the_zero_order_hold_agrees_with_scipy() -> Outcome {
    for row in sampled_table()? {
        for (found, scipy) in row.found.iter().zip(&row.scipy) {
            let error = norm_error(found, scipy);
            assert!(error < SAMPLED_TOL, "{}: {error:e}", row.name);
        }
    }
    Ok(())
}

#[test]
fn a_sampled_system_responds_as_the_continuous_one() -> Outcome {
    // Open loop, unit step into the servo: the table of the handbook, seven decimals.
    let plant = TransferFunction::new(
        &[-1.69144, -0.84341, -0.0099096],
        &[1.0, 1.17103, 1.55405, 0.012538, 0.0072771],
    )?;
    let model = TransferFunction::new(&[10.0], &[1.0, 10.0])?.series(&plant)?.to_state_space();
    let (a, b) = zero_order_hold(model.a(), model.b(), 0.01)?;
    let (mut x, mut next) = (vec![0.0; 5], vec![0.0; 5]);
    let expected = [
        (50, -0.1282436),
        (100, -0.5289794),
        (500, -3.3165718),
        (2000, -8.6039336),
        (10_000, -4.3028260),
    ];
    for k in 1..=10_000 {
        a.apply(&x, &mut next)?;
        x = next.iter().zip(b.data()).map(|(next, b)| next + b).collect();
        if let Some((_, theta)) = expected.iter().find(|(at, _)| *at == k) {
            assert!((x[0] - theta).abs() < 6e-8, "{k} {} {theta}", x[0]);
        }
    }
    Ok(())
}

#[test]
fn sampling_refuses_periods_and_shapes_that_mean_nothing() {
    let (a, b) = (Matrix::identity(2), Matrix::zeros(2, 1));
    for dt_s in [0.0, -0.02, f64::NAN, f64::INFINITY] {
        assert!(
            matches!(zero_order_hold(&a, &b, dt_s), Err(LtiError::NotPositive { .. })),
            "{dt_s}"
        );
    }
    assert!(matches!(
        zero_order_hold(&b, &b, 0.02),
        Err(LtiError::Shape { what: "state matrix", .. })
    ));
    assert!(matches!(
        zero_order_hold(&a, &Matrix::zeros(3, 1), 0.02),
        Err(LtiError::Shape { what: "input matrix", .. })
    ));
}

#[test]
fn a_gain_and_a_system_without_inputs_can_be_sampled() -> Outcome {
    assert_eq!(
        zero_order_hold(&Matrix::zeros(0, 0), &Matrix::zeros(0, 1), 0.02)?,
        (Matrix::zeros(0, 0), Matrix::zeros(0, 1))
    );
    let (a, b) = zero_order_hold(&matrix(1, &[-1.0]), &Matrix::zeros(1, 0), 1.0)?;
    assert!(entry_error(a.data(), &[libm::exp(-1.0)]) < 1e-15);
    assert_eq!(b, Matrix::zeros(1, 0));
    Ok(())
}

fn small_matrix() -> impl Strategy<Value = Matrix> {
    prop::collection::vec(-3.0..3.0_f64, 16).prop_map(|entries| matrix(4, &entries))
}

proptest! {
    #![proptest_config(repeatable())]

    #[test]
    fn two_intervals_in_a_row_are_one_long_interval(a in small_matrix(), first in 0.01..1.0_f64, second in 0.01..1.0_f64) {
        let (left, right) = (exponential(&a.scaled(first))?, exponential(&a.scaled(second))?);
        let (product, whole) = (left.product(&right)?, exponential(&a.scaled(first + second))?);
        // Errors relative to the factors, which can be larger than their product.
        let size = left.norm_one() * right.norm_one();
        let error = product.sum(&whole.scaled(-1.0))?.norm_one();
        prop_assert!(error < 1e-13 * size, "{error:e} {size:e}");
    }

    #[test]
    fn the_exponential_of_the_negative_is_the_inverse(a in small_matrix()) {
        let (forward, back) = (exponential(&a)?, exponential(&a.scaled(-1.0))?);
        let error = forward.product(&back)?.sum(&Matrix::identity(4).scaled(-1.0))?.norm_one();
        prop_assert!(error < 1e-13 * forward.norm_one() * back.norm_one(), "{error:e}");
    }

    #[test]
    fn the_exponential_of_the_transpose_is_the_transpose(a in small_matrix()) {
        let (left, right) = (exponential(&a.transpose())?, exponential(&a)?.transpose());
        prop_assert!(left.sum(&right.scaled(-1.0))?.norm_one() < 1e-13 * right.norm_one());
    }

    #[test]
    fn a_stable_system_stays_stable_when_sampled(a in small_matrix(), dt_s in 0.001..1.0_f64) {
        // Shifted left by more than its norm, so that every eigenvalue has a negative real part.
        let shifted = a.sum(&Matrix::identity(4).scaled(-12.5))?;
        let (sampled, _) = zero_order_hold(&shifted, &Matrix::zeros(4, 1), dt_s)?;
        prop_assert!(spectral_radius(&sampled)? < 1.0);
    }

    #[test]
    fn each_input_column_is_sampled_as_if_it_were_alone(a in small_matrix(), b in prop::collection::vec(-1e3..1e3_f64, 8)) {
        let (_, both) = zero_order_hold(&a, &matrix(4, &b), 0.1)?;
        let first: Vec<f64> = b.chunks(2).map(|row| row[0]).collect();
        let (_, alone) = zero_order_hold(&a, &matrix(4, &first), 0.1)?;
        let first_of_both: Vec<f64> = both.data().chunks(2).map(|row| row[0]).collect();
        prop_assert!(norm_error(&first_of_both, alone.data()) < 1e-14);
    }
}
