//! Products of interval matrices hold every exact product.

use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_proof::check::IntervalMatrix;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn repeatable() -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2026),
        cases: 300,
        ..ProptestConfig::default()
    }
}

/// Rows by inner size by columns.
type Sizes = (usize, usize, usize);

fn sizes() -> impl Strategy<Value = Sizes> {
    (1_usize..6, 1_usize..13, 1_usize..6)
}

/// Whole numbers of up to 53 bits, many of them short, some zero.
fn whole(count: usize) -> impl Strategy<Value = Vec<i64>> {
    let number = (-(1_i64 << 53)..=1 << 53, 0_u32..56).prop_map(|(value, cut)| value >> cut);
    prop::collection::vec(number, count)
}

#[allow(clippy::cast_precision_loss, reason = "at most 53 bits")]
fn float(value: i64) -> f64 {
    value as f64
}

fn intervals(columns: usize, entries: &[Interval]) -> IntervalMatrix {
    let rows: Vec<&[Interval]> = entries.chunks(columns).collect();
    IntervalMatrix::from_rows(&rows).expect("rows of one length")
}

fn points(columns: usize, entries: &[i64]) -> IntervalMatrix {
    let entries: Vec<Interval> =
        entries.iter().map(|&value| Interval::point(float(value))).collect();
    intervals(columns, &entries)
}

/// The exact product of whole numbers.
fn exact((rows, inner, columns): Sizes, left: &[i64], right: &[i64]) -> Vec<i128> {
    let entry = |place: usize| {
        let (i, j) = (place / columns, place % columns);
        (0..inner)
            .map(|k| i128::from(left[i * inner + k]) * i128::from(right[k * columns + j]))
            .sum()
    };
    (0..rows * columns).map(entry).collect()
}

/// Whether a whole number lies inside; bounds beyond 2^53 are whole numbers themselves.
#[allow(clippy::cast_possible_truncation, reason = "rounded towards the inside before the cast")]
fn holds(entry: Interval, value: i128) -> bool {
    entry.lower().ceil() as i128 <= value && entry.upper().floor() as i128 >= value
}

proptest! {
    #![proptest_config(repeatable())]

    #[test]
    fn the_product_of_points_holds_the_exact_one_and_is_off_by_one_rounding(
        (sizes, left, right) in sizes().prop_flat_map(|sizes| {
            (Just(sizes), whole(sizes.0 * sizes.1), whole(sizes.1 * sizes.2))
        })
    ) {
        let product = points(sizes.1, &left).product(&points(sizes.2, &right)).expect("shapes fit");
        for (entry, exact) in product.entries().zip(exact(sizes, &left, &right)) {
            prop_assert!(holds(entry, exact), "{entry:?} {exact}");
            #[allow(clippy::cast_precision_loss, reason = "only its size counts")]
            let size = exact.unsigned_abs() as f64;
            // What doubled precision leaves of the largest product possible here, 13 * 2^106.
            let left = 500.0 * f64::EPSILON * f64::EPSILON * libm::exp2(110.0);
            prop_assert!(entry.radius() <= f64::EPSILON * size + left, "{entry:?} {exact}");
        }
    }

    #[test]
    fn the_product_of_wide_matrices_holds_the_product_of_any_inside(
        (sizes, left, right, spread, chosen) in sizes().prop_flat_map(|sizes| {
            let (m, n) = (sizes.0 * sizes.1, sizes.1 * sizes.2);
            let spreads = prop::collection::vec((0_i64..1 << 30, 0_u32..31), m + n);
            (Just(sizes), whole(m), whole(n), spreads, prop::collection::vec(-1.0..=1.0_f64, m + n))
        })
    ) {
        // Inside an interval of whole bounds every choice is a whole number, the bounds among them.
        let spread: Vec<i64> = spread.iter().map(|&(value, cut)| value >> cut).collect();
        let (m, _) = (left.len(), right.len());
        #[allow(clippy::cast_possible_truncation, reason = "31 bits")]
        let choose = |values: &[i64], from: usize| -> Vec<i64> {
            values.iter().enumerate()
                .map(|(i, value)| {
                    // The ends as often as anything between.
                    let part = (1.5 * chosen[from + i]).clamp(-1.0, 1.0);
                    value / 2 + (part * float(spread[from + i])) as i64
                })
                .collect()
        };
        let wide = |columns: usize, values: &[i64], from: usize| {
            let entries: Vec<Interval> = values.iter().zip(&spread[from..])
                .map(|(value, spread)| Interval::between(float(value / 2 - spread), float(value / 2 + spread)))
                .collect();
            intervals(columns, &entries)
        };
        let product = wide(sizes.1, &left, 0).product(&wide(sizes.2, &right, m)).expect("shapes fit");
        let inside = exact(sizes, &choose(&left, 0), &choose(&right, m));
        for (entry, exact) in product.entries().zip(inside) {
            prop_assert!(holds(entry, exact), "{entry:?} {exact}");
        }
    }

    #[test]
    fn the_product_agrees_with_that_of_plain_intervals(
        (sizes, entries) in sizes().prop_flat_map(|sizes| {
            let count = sizes.0 * sizes.1 + sizes.1 * sizes.2;
            let entry = (-1.0..1.0_f64, -14..=14_i32, 0.0..1.0_f64, -60..=0_i32);
            (Just(sizes), prop::collection::vec(entry, count))
        })
    ) {
        let entries: Vec<Interval> = entries.iter()
            .map(|&(value, power, width, narrow)| {
                let value = libm::scalbn(value, 3 * power);
                Interval::between(value, value + value.abs() * libm::scalbn(width, narrow))
            })
            .collect();
        let (left, right) = entries.split_at(sizes.0 * sizes.1);
        let product = intervals(sizes.1, left).product(&intervals(sizes.2, right)).expect("shapes fit");
        for (place, entry) in product.entries().enumerate() {
            let (i, j) = (place / sizes.2, place % sizes.2);
            let plain = (0..sizes.1).fold(Interval::ZERO, |sum, k| {
                sum + left[i * sizes.1 + k] * right[k * sizes.2 + j]
            });
            prop_assert!(entry.intersection(plain).is_some(), "{entry:?} {plain:?}");
            // Middle and radius: up to half as wide again, in each of two factors' terms.
            prop_assert!(entry.radius() <= 1.5 * plain.radius() + 1e-30 * plain.magnitude(), "{entry:?} {plain:?}");
        }
    }

    #[test]
    fn sums_and_differences_hold_the_exact_ones(one in whole(4), other in whole(4)) {
        let (left, right) = (points(2, &one), points(2, &other));
        let (sum, difference) = (left.sum(&right).expect("one shape"), left.difference(&right).expect("one shape"));
        for (place, (a, b)) in one.iter().zip(&other).enumerate() {
            let (a, b) = (i128::from(*a), i128::from(*b));
            let at = |matrix: &IntervalMatrix| matrix.get(place / 2, place % 2).expect("exists");
            prop_assert!(holds(at(&sum), a + b) && holds(at(&difference), a - b));
        }
    }

    #[test]
    fn a_scaled_matrix_holds_every_scaled_entry(one in whole(4), factor in -1e3..1e3_f64, width in 0.0..1.0_f64) {
        let scaled = points(2, &one).scaled(Interval::between(factor, factor + width));
        for (entry, value) in scaled.entries().zip(&one) {
            for factor in [factor, factor + 0.5 * width] {
                let plain = Interval::point(float(*value)) * Interval::point(factor);
                prop_assert!(entry.intersection(plain).is_some());
            }
        }
    }
}

#[test]
fn a_matrix_of_floats_is_itself() {
    let matrix =
        Matrix::from_rows(&[[0.1, -3.0, 1e-300], [5e-324, 0.0, f64::MAX]]).expect("finite");
    let exact = IntervalMatrix::from(&matrix);
    assert_eq!(exact.midpoint(), matrix);
    assert!(exact.contains(&matrix) && exact.max_radius() <= 0.0);
    assert_eq!((exact.rows(), exact.columns()), (2, 3));
    assert_eq!(exact.transpose().transpose(), exact);
}

#[test]
fn a_matrix_encloses_what_lies_in_each_of_its_entries_and_nothing_of_another_shape() {
    let wide = |radius: f64| {
        let entry = |middle: f64| Interval::between(middle - radius, middle + radius);
        intervals(2, &[entry(1.0), entry(2.0), entry(3.0), entry(4.0)])
    };
    assert!(wide(0.25).encloses(&wide(0.125)) && wide(0.25).encloses(&wide(0.25)));
    assert!(!wide(0.125).encloses(&wide(0.25)));
    assert!((wide(0.25).max_radius() - 0.25).abs() < 1e-15);
    // One entry alone lies outside.
    for place in 0..4 {
        let mut entries = [1.0, 2.0, 3.0, 4.0];
        entries[place] += 0.5;
        let other = Matrix::from_rows(&[&entries[..2], &entries[2..]]).expect("square");
        assert!(
            !wide(0.25).encloses(&IntervalMatrix::from(&other)) && !wide(0.25).contains(&other)
        );
    }
    let row = intervals(4, &[1.0, 2.0, 3.0, 4.0].map(Interval::point));
    assert!(!wide(0.25).encloses(&row) && !row.encloses(&wide(0.0)));
    assert!(!wide(0.25).contains(&row.midpoint()));
}
