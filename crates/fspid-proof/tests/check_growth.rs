//! What is said to grow does, and a stable loop is never said to.

use fspid_lti::{Matrix, spectral_radius};
use fspid_numeric::scalar::Interval;
use fspid_proof::check::{IntervalMatrix, NotProved, prove_growth, prove_unstable};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn repeatable() -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2026),
        cases: 500,
        ..ProptestConfig::default()
    }
}

fn matrix(size: usize, entries: &[f64]) -> Matrix {
    let rows: Vec<&[f64]> = entries.chunks(size).collect();
    Matrix::from_rows(&rows).expect("a test matrix is well formed")
}

fn point(matrix: &Matrix) -> IntervalMatrix {
    IntervalMatrix::from(matrix)
}

/// The solution of $M^T P M - P = I$, as one system of equations.
fn stein(m: &Matrix) -> Option<Matrix> {
    let size = m.rows();
    let at = |i: usize, j: usize| m.get(i, j).unwrap_or(0.0);
    let unknowns = size * size;
    let entry = |equation: usize, unknown: usize| {
        let (i, j, k, l) = (equation / size, equation % size, unknown / size, unknown % size);
        at(k, i) * at(l, j) - if equation == unknown { 1.0 } else { 0.0 }
    };
    let equations: Vec<Vec<f64>> =
        (0..unknowns).map(|row| (0..unknowns).map(|column| entry(row, column)).collect()).collect();
    let right: Vec<[f64; 1]> =
        (0..unknowns).map(|place| [if place % (size + 1) == 0 { 1.0 } else { 0.0 }]).collect();
    let p = Matrix::from_rows(&equations).ok()?.solve(&Matrix::from_rows(&right).ok()?).ok()?;
    let p = matrix(size, p.data());
    p.sum(&p.transpose()).ok().map(|twice| twice.scaled(0.5))
}

fn square(most: f64) -> impl Strategy<Value = Matrix> {
    (1_usize..5).prop_flat_map(move |size| {
        prop::collection::vec(-most..most, size * size)
            .prop_map(move |entries| matrix(size, &entries))
    })
}

fn with_form() -> impl Strategy<Value = (Matrix, Matrix, Vec<f64>)> {
    square(1.0).prop_flat_map(|m| {
        let size = m.rows();
        let numbers = || prop::collection::vec(-1.0..1.0_f64, size * size);
        (Just(m), numbers(), numbers()).prop_map(move |(m, p, x)| {
            let p = matrix(size, &p);
            (m, p.sum(&p.transpose()).expect("one shape"), x[..size].to_vec())
        })
    })
}

proptest! {
    #![proptest_config(repeatable())]

    #[test]
    fn a_loop_with_a_pole_well_outside_is_proved_unstable(m in square(1.5)) {
        let radius = spectral_radius(&m).expect("found");
        prop_assume!(radius > 1.001);
        let Some(p) = stein(&m) else { return Ok(()) };
        // Products of two poles near 1 make P huge and say nothing.
        prop_assume!(p.norm_one() < 1e8);
        let found = prove_unstable(&point(&m), &p);
        prop_assert!(found.is_ok(), "{found:?} {radius}");
        prop_assert_eq!(prove_growth(&point(&m), &p, &found.expect("proved")), Ok(()));
    }

    #[test]
    fn no_form_shows_a_stable_loop_to_grow((m, p, x) in with_form()) {
        let radius = spectral_radius(&m).expect("found");
        let proved = prove_growth(&point(&m), &p, &x).is_ok() || prove_unstable(&point(&m), &p).is_ok();
        prop_assert!(!proved || radius > 1.0 - 1e-9, "{radius}");
        // On the unit circle at the most, in steps of rounding.
        let slowed = m.scaled((1.0 - 1e-9) / radius.max(1e-3));
        prop_assert!(prove_growth(&point(&slowed), &p, &x).is_err());
        if let Some(own) = stein(&slowed) {
            prop_assert!(prove_unstable(&point(&slowed), &own).is_err());
        }
    }

    /// Rotations and reflections by whole numbers keep every length: exactly on the edge.
    #[test]
    fn a_loop_that_keeps_lengths_is_never_said_to_grow(
        (_, p, x) in with_form(), order in 0_usize..24, signs in 0_usize..16
    ) {
        let size = p.rows();
        let mut places: Vec<usize> = (0..size).collect();
        places.rotate_left(order % size);
        if order % 2 == 0 {
            places.reverse();
        }
        let entry = |place: usize| match (place / size, place % size) {
            (i, j) if places[i] == j => if signs >> i & 1 == 1 { -1.0 } else { 1.0 },
            _ => 0.0,
        };
        let kept = point(&matrix(size, &(0..size * size).map(entry).collect::<Vec<f64>>()));
        prop_assert!(prove_growth(&kept, &p, &x).is_err() && prove_unstable(&kept, &p).is_err());
    }
}

#[test]
fn growth_depends_on_where_it_starts() {
    let (m, p) = (point(&matrix(2, &[2.0, 0.0, 0.0, 0.5])), matrix(2, &[1.0, 0.0, 0.0, -1.0]));
    assert_eq!(prove_growth(&m, &p, &[1.0, 0.0]), Ok(()));
    assert_eq!(prove_growth(&m, &p, &[1.0, 0.999]), Ok(()));
    for x in [[0.0, 1.0], [1.0, 1.0], [0.0, 0.0]] {
        assert!(matches!(prove_growth(&m, &p, &x), Err(NotProved::NoDirection { .. })), "{x:?}");
    }
    assert!(prove_unstable(&m, &p.scaled(-1.0)).is_err());
}

/// Each of two loops is stable, and one after the other they grow: z1 is thrown into z2 and back.
#[test]
fn two_stable_loops_that_take_turns_can_grow() {
    let (one, other) = (matrix(2, &[0.5, 2.0, 0.0, 0.5]), matrix(2, &[0.5, 0.0, 2.0, 0.5]));
    for alone in [&one, &other] {
        assert!(spectral_radius(alone).expect("found") < 1.0);
        assert!(stein(alone).is_none_or(|p| prove_unstable(&point(alone), &p).is_err()));
    }
    let product = point(&other).product(&point(&one)).expect("square");
    let p = stein(&product.midpoint()).expect("regular");
    let x = prove_unstable(&product, &p).expect("the sequence grows");
    assert_eq!(prove_growth(&product, &p, &x), Ok(()));
    // Flown: by the growth that the largest pole of the product tells, about 19 in two steps.
    let mut z = [x[0], x[1]];
    let mut next = [0.0; 2];
    for _ in 0..20 {
        for step in [&one, &other] {
            step.apply(&z, &mut next).expect("square");
            z = next;
        }
    }
    assert!(libm::hypot(z[0], z[1]) > 1e10 * libm::hypot(x[0], x[1]));
}

#[test]
fn every_matrix_inside_must_grow() {
    let wide =
        |lower: f64| IntervalMatrix::from_rows(&[[Interval::between(lower, 1.3)]]).expect("square");
    let p = Matrix::identity(1);
    assert_eq!(prove_growth(&wide(1.1), &p, &[1.0]), Ok(()));
    for lower in [1.0, 0.9, -1.5] {
        assert!(prove_growth(&wide(lower), &p, &[1.0]).is_err(), "{lower}");
    }
}

#[test]
fn what_is_not_finite_not_symmetric_or_does_not_fit_is_refused() {
    let (m, p, x) = (Matrix::identity(2).scaled(2.0), Matrix::identity(2), [1.0, 0.0]);
    assert_eq!(prove_growth(&point(&m), &p, &x), Ok(()));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for place in 0..4 {
            let broken = |from: &Matrix| {
                let mut broken = from.clone();
                broken.set(place / 2, place % 2, bad).expect("the entry exists");
                broken
            };
            assert!(prove_growth(&point(&broken(&m)), &p, &x).is_err());
            assert!(prove_growth(&point(&m), &broken(&p), &x).is_err());
            assert!(prove_unstable(&point(&broken(&m)), &p).is_err());
            assert!(prove_unstable(&point(&m), &broken(&p)).is_err());
        }
        assert!(prove_growth(&point(&m), &p, &[bad, 0.0]).is_err());
        assert!(prove_growth(&point(&m), &p, &[1.0, bad]).is_err());
    }
    assert!(prove_growth(&point(&m), &p, &[1.0]).is_err());
    assert!(prove_growth(&point(&m), &Matrix::identity(3), &[1.0; 3]).is_err());
    assert!(prove_unstable(&point(&m), &Matrix::zeros(2, 3)).is_err());
    assert!(prove_unstable(&point(&m), &matrix(2, &[1.0, 0.5, 0.0, 1.0])).is_err());
}
