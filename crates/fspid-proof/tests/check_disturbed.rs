//! What a disturbance may do to a loop, against closed forms of one and two states.

use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_proof::check::{Driven, Ellipsoid, IntervalMatrix, NotProved, grows_no_faster};

fn matrix<const N: usize>(rows: &[[f64; N]]) -> Matrix {
    Matrix::from_rows(rows).expect("a test matrix is well formed")
}

fn points<const N: usize>(rows: &[[f64; N]]) -> IntervalMatrix {
    IntervalMatrix::from(&matrix(rows))
}

/// Of $z^+ = m z + e u$, seen by c, with the form p.
fn bounded([p, m, e, c]: [f64; 4], decay: f64, gain: f64) -> Result<(), NotProved> {
    let seen = [Interval::point(c)];
    let scalar = |value: f64| Matrix::identity(1).scaled(value);
    let [m, e] = [m, e].map(|value| IntervalMatrix::from(&scalar(value)));
    let driven = Driven { matrix: &m, entry: &e, seen: Some(&seen) };
    grows_no_faster(&scalar(p), [decay, gain], driven)
}

#[test]
fn a_scalar_loop_has_the_gain_of_its_frequency_response_at_zero_and_no_less() {
    // e / (1 - m) is 2 e, and 2 the form that shows it: (p - m² p - c²) (β - e² p) > (m p e)².
    for e in [0.25, 1.0, 2.0] {
        let loop_of = [2.0, 0.5, e, 1.0];
        assert_eq!(bounded(loop_of, 1.0, 4.01 * e * e), Ok(()));
        assert!(bounded(loop_of, 1.0, 3.99 * e * e).is_err());
    }
    // Twice as much is seen: four times the form and the gain.
    assert_eq!(bounded([8.0, 0.5, 1.0, 2.0], 1.0, 16.01), Ok(()));
    assert!(bounded([8.0, 0.5, 1.0, 2.0], 1.0, 15.99).is_err());
}

#[test]
fn a_form_that_decays_asks_for_more_gain() {
    // (α - m²) (β - 1) > m² with p = e = 1, c = 0: β > 2 for α = 1/2, 4/3 for 1.
    let loop_of = [1.0, 0.5, 1.0, 0.0];
    for (decay, gain) in [(0.5, 2.0), (1.0, 4.0 / 3.0)] {
        assert_eq!(bounded(loop_of, decay, gain + 0.01), Ok(()));
        assert!(bounded(loop_of, decay, gain - 0.01).is_err());
    }
    assert!(bounded(loop_of, 0.24, 1e6).is_err(), "it keeps a quarter by itself");
}

#[test]
fn every_state_and_every_input_counts() {
    // Two states, the second driven by 2: (2 - 2/16) (β - 8) > 1; the first is seen and not driven.
    let (p, m) = (matrix(&[[2.0, 0.0], [0.0, 2.0]]), points(&[[0.5, 0.0], [0.0, 0.25]]));
    let (e, seen) = (points(&[[0.0], [2.0]]), [1.0, 0.0].map(Interval::point));
    let driven = Driven { matrix: &m, entry: &e, seen: Some(&seen) };
    let least = 8.0 + 1.0 / 1.875;
    assert_eq!(grows_no_faster(&p, [1.0, 1.001 * least], driven), Ok(()));
    assert!(grows_no_faster(&p, [1.0, 0.999 * least], driven).is_err());
    // Seen with 1.3 the first state falls by too little: 2 - 1/2 - 1.69.
    let more = [1.3, 0.0].map(Interval::point);
    assert!(grows_no_faster(&p, [1.0, 1e6], Driven { seen: Some(&more), ..driven }).is_err());
    assert_eq!(grows_no_faster(&p, [1.0, 1.001 * least], Driven { seen: None, ..driven }), Ok(()));
    // A matrix, an entry or a row that may be larger.
    let wide = |most: f64| Interval::between(0.0, most);
    let zero = Interval::ZERO;
    let m = IntervalMatrix::from_rows(&[[wide(0.8), zero], [zero, wide(0.25)]]).expect("square");
    assert!(grows_no_faster(&p, [1.0, 1e6], Driven { matrix: &m, ..driven }).is_err(), "1.28");
    let e = IntervalMatrix::from_rows(&[[zero], [wide(2.1)]]).expect("a column");
    assert!(grows_no_faster(&p, [1.0, 1.001 * least], Driven { entry: &e, ..driven }).is_err());
}

#[test]
fn what_is_no_bound_is_refused_by_name() {
    let good = [2.0, 0.5, 1.0, 1.0];
    for decay in [0.0, -0.5, 1.0_f64.next_up(), 2.0, f64::NAN, f64::INFINITY] {
        let found = bounded(good, decay, 5.0);
        assert!(matches!(found, Err(NotProved::Number { what: "decay", .. })), "{decay} {found:?}");
    }
    for gain in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let found = bounded(good, 1.0, gain);
        assert!(matches!(found, Err(NotProved::Number { .. })), "{gain} {found:?}");
    }
    for place in 0..4 {
        for bad in [f64::NAN, f64::INFINITY] {
            let mut parts = good;
            parts[place] = bad;
            let found = bounded(parts, 1.0, 5.0);
            assert!(matches!(found, Err(NotProved::Unbounded { .. })), "{place} {found:?}");
        }
    }
    assert!(bounded([-2.0, 0.5, 1.0, 0.0], 1.0, 5.0).is_err(), "a form that is not positive");
    let (m, e) = (points(&[[0.5]]), points(&[[1.0]]));
    let two = [Interval::ONE; 2];
    let driven = Driven { matrix: &m, entry: &e, seen: Some(&two) };
    let found = grows_no_faster(&matrix(&[[2.0]]), [1.0, 5.0], driven);
    assert!(matches!(found, Err(NotProved::Shape(_))), "{found:?}");
}

#[test]
fn an_ellipsoid_reaches_as_far_as_the_inverse_of_its_form_says() {
    // The inverse is a third of [2 -1; -1 2].
    let ellipsoid = Ellipsoid::of(&matrix(&[[2.0, 1.0], [1.0, 2.0]])).expect("positive definite");
    for (row, square) in
        [([1.0, 0.0], 2.0 / 3.0), ([1.0, 1.0], 2.0 / 3.0), ([1.0, -1.0], 2.0), ([0.0, 3.0], 6.0)]
    {
        let found = ellipsoid.reach(&row.map(Interval::point)).expect("a row").upper();
        assert!(found * found >= square && found < 1.0001 * square.sqrt(), "{found} {square}");
    }
    let found = ellipsoid.reach(&[Interval::ZERO; 2]).expect("a row");
    assert_eq!(found, Interval::ZERO);
    // A row between bounds: the largest of them counts.
    let wide = [Interval::between(-3.0, 1.0), Interval::ZERO];
    assert!(ellipsoid.reach(&wide).expect("a row").upper() >= 6.0_f64.sqrt());
}

#[test]
fn of_many_forms_the_least_reaches_farthest() {
    let form = IntervalMatrix::from_rows(&[[Interval::between(0.75, 1.25)]]).expect("square");
    let found = Ellipsoid::of_all(&form).expect("positive").reach(&[Interval::ONE]).expect("a row");
    assert!(found.upper() >= 0.75_f64.sqrt().recip() && found.upper() < 1.1548, "{found:?}");
    let form = IntervalMatrix::from_rows(&[[Interval::between(-0.1, 1.0)]]).expect("square");
    assert!(Ellipsoid::of_all(&form).is_err());
}

#[test]
fn rows_that_do_not_fit_or_reach_beyond_all_numbers_are_refused() {
    let ellipsoid = Ellipsoid::of(&matrix(&[[1.0, 0.0], [0.0, 1.0]])).expect("positive definite");
    assert!(matches!(ellipsoid.reach(&[Interval::ONE]), Err(NotProved::Shape(_))));
    assert!(matches!(ellipsoid.reach(&[Interval::ONE; 3]), Err(NotProved::Shape(_))));
    let far = [Interval::point(1e200), Interval::ONE];
    assert!(matches!(ellipsoid.reach(&far), Err(NotProved::Number { .. })));
    assert!(matches!(ellipsoid.reach(&[Interval::ENTIRE; 2]), Err(NotProved::Unbounded { .. })));
    assert!(Ellipsoid::of(&matrix(&[[1.0, 2.0], [2.0, 1.0]])).is_err(), "its determinant is -3");
    assert!(Ellipsoid::of(&matrix(&[[1.0, 0.5], [0.4, 1.0]])).is_err(), "not symmetric");
}
