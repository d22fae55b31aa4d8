//! What is called positive definite is, and what is, by more than rounding, is called so.

use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_proof::check::{IntervalMatrix, NotProved, prove_positive_definite};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn repeatable() -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2026),
        cases: 2000,
        ..ProptestConfig::default()
    }
}

fn point(size: usize, entries: &[f64]) -> IntervalMatrix {
    let rows: Vec<&[f64]> = entries.chunks(size).collect();
    IntervalMatrix::from(&Matrix::from_rows(&rows).expect("a test matrix is well formed"))
}

/// A symmetric matrix from its lower half.
fn symmetric<T: Copy>(size: usize, half: &[T]) -> Vec<T> {
    let at = |i: usize, j: usize| half[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)];
    (0..size * size).map(|place| at(place / size, place % size)).collect()
}

/// Whether all leading minors of a matrix of whole numbers are above zero, by elimination without
/// fractions (Bareiss 1968), in which each pivot is such a minor.
fn exactly_definite(size: usize, entries: &[i128]) -> bool {
    let mut rest = entries.to_vec();
    let mut previous = 1;
    for k in 0..size {
        let pivot = rest[k * size + k];
        if pivot <= 0 {
            return false;
        }
        for i in k + 1..size {
            for j in k + 1..size {
                let minor = rest[i * size + j] * pivot - rest[i * size + k] * rest[k * size + j];
                rest[i * size + j] = minor / previous;
            }
        }
        previous = pivot;
    }
    true
}

#[allow(clippy::cast_precision_loss, reason = "far below 53 bits")]
fn float(value: i128) -> f64 {
    value as f64
}

fn whole(most: i128) -> impl Strategy<Value = (usize, Vec<i128>)> {
    (1_usize..6).prop_flat_map(move |size| {
        (Just(size), prop::collection::vec(-most..=most, size * (size + 1) / 2))
    })
}

/// $A^T A + d I$ less nothing or a little: definite about half the time, and often only just.
fn near_singular() -> impl Strategy<Value = (usize, Vec<i128>)> {
    (whole(9), prop::collection::vec(-9_i128..=9, 25), -2_i128..=2, any::<bool>()).prop_map(
        |((size, half), extra, shift, plain)| {
            let own = symmetric(size, &half);
            if plain {
                return (size, own);
            }
            let factor = |i: usize, j: usize| own[i * size + j] + extra[i * 5 + j];
            let entry = |place: usize| -> i128 {
                let (i, j) = (place / size, place % size);
                let product: i128 = (0..size).map(|k| factor(k, i) * factor(k, j)).sum();
                product + if i == j { shift } else { 0 }
            };
            (size, (0..size * size).map(entry).collect())
        },
    )
}

proptest! {
    #![proptest_config(repeatable())]

    /// A definite matrix of whole numbers has a determinant of 1 or more, which is far from singular.
    #[test]
    fn matrices_of_whole_numbers_are_told_apart_exactly((size, entries) in near_singular()) {
        let floats: Vec<f64> = entries.iter().map(|&value| float(value)).collect();
        let found = prove_positive_definite(&point(size, &floats));
        prop_assert_eq!(found.is_ok(), exactly_definite(size, &entries), "{:?} {:?}", entries, found);
    }

    /// A symmetric interval matrix is definite if and only if $A_m - Z A_r Z$ is for every diagonal Z of
    /// signs: J. Rohn, *Positive definiteness and stability of interval matrices*, SIAM J. Matrix Anal.
    /// Appl. 15 (1994) 175.
    #[test]
    fn no_matrix_inside_one_that_is_proved_is_indefinite(
        (size, entries) in near_singular(), spread in prop::collection::vec(0_i128..40, 15)
    ) {
        let spread = symmetric(size, &spread);
        let wide: Vec<Interval> = entries.iter().zip(&spread)
            .map(|(value, spread)| Interval::between(float(16 * value - spread), float(16 * value + spread)))
            .collect();
        let rows: Vec<&[Interval]> = wide.chunks(size).collect();
        let found = prove_positive_definite(&IntervalMatrix::from_rows(&rows).expect("square"));
        let vertex = |signs: usize| -> Vec<i128> {
            let sign = |i: usize| if signs >> i & 1 == 1 { -1 } else { 1 };
            let places = 0..size * size;
            places.map(|place| 16 * entries[place] - sign(place / size) * sign(place % size) * spread[place]).collect()
        };
        let all = (0..1 << size).all(|signs| exactly_definite(size, &vertex(signs)));
        prop_assert!(found.is_err() || all, "{entries:?} {spread:?}");
    }

    #[test]
    fn units_of_states_do_not_matter((size, entries) in near_singular(), powers in prop::collection::vec(-90_i32..90, 5)) {
        let scaled: Vec<f64> = entries.iter().enumerate()
            .map(|(place, &value)| libm::scalbn(float(value), powers[place / size] + powers[place % size]))
            .collect();
        let plain: Vec<f64> = entries.iter().map(|&value| float(value)).collect();
        let (scaled, plain) = (prove_positive_definite(&point(size, &scaled)), prove_positive_definite(&point(size, &plain)));
        prop_assert_eq!(scaled.is_ok(), plain.is_ok());
    }
}

/// The Hilbert matrix of an order, times the least common multiple of its denominators.
fn hilbert(size: usize) -> Vec<i128> {
    let greatest = |mut a: i128, mut b: i128| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let denominator = |place: usize| (place / size + place % size + 1) as i128;
    let multiple = (0..size * size)
        .map(denominator)
        .fold(1, |multiple, next| multiple / greatest(multiple, next) * next);
    (0..size * size).map(|place| multiple / denominator(place)).collect()
}

/// Condition numbers: 1.5e10 for order 8, 4.9e11 for 9, 1.6e13 for 10; after scaling to a diagonal of
/// ones they are a little smaller.
#[test]
fn hilbert_matrices_are_definite_up_to_order_nine_at_least() {
    for size in 1..10 {
        let entries: Vec<f64> = hilbert(size).into_iter().map(float).collect();
        assert_eq!(prove_positive_definite(&point(size, &entries)), Ok(()), "{size}");
    }
}

/// Less than the least eigenvalue of Hilbert's matrix of order 6, $1.08 \cdot 10^{-7}$ (Fettis and
/// Caslin 1967), may be taken from its diagonal, and not more.
#[test]
fn hilberts_matrix_bears_its_least_eigenvalue_and_not_more() {
    let less = |amount: f64| {
        let entries: Vec<f64> = hilbert(6).into_iter().map(float).collect();
        let multiple = entries[0];
        let shifted = entries
            .iter()
            .enumerate()
            .map(|(place, value)| if place % 7 == 0 { value - amount * multiple } else { *value });
        prove_positive_definite(&point(6, &shifted.collect::<Vec<f64>>()))
    };
    assert_eq!(less(1.082e-7), Ok(()));
    assert!(less(1.083e-7).is_err());
}

#[test]
fn what_is_singular_or_has_no_bounds_is_refused() {
    let refused = |entries: &[f64]| prove_positive_definite(&point(2, entries));
    assert!(matches!(refused(&[1.0, 1.0, 1.0, 1.0]), Err(NotProved::NoFactor { row: 1, .. })));
    assert!(refused(&[0.0, 0.0, 0.0, 0.0]).is_err() && refused(&[1.0, 0.0, 0.0, -1.0]).is_err());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for place in 0..4 {
            let mut matrix = Matrix::identity(2);
            matrix.set(place / 2, place % 2, bad).expect("the entry exists");
            let found = prove_positive_definite(&IntervalMatrix::from(&matrix));
            assert!(matches!(found, Err(NotProved::Unbounded { .. })), "{bad} {place}");
        }
    }
    let half_line = Interval::new(1.0, f64::INFINITY).expect("ordered");
    let found =
        prove_positive_definite(&IntervalMatrix::from_rows(&[[half_line]]).expect("square"));
    assert!(matches!(found, Err(NotProved::Unbounded { .. })));
    assert!(prove_positive_definite(&IntervalMatrix::zeros(2, 3)).is_err());
    // The middle is definite, a matrix inside is not.
    let wide = Interval::between(-0.1, 2.0);
    let found = prove_positive_definite(&IntervalMatrix::from_rows(&[[wide]]).expect("square"));
    assert!(matches!(found, Err(NotProved::NotDominant { .. })));
}
