//! Optimal feedback with integral action, against independent solutions of its equation of Riccati.

use fspid_lti::{
    DampedIntegrator, IntegralRegulator, IntegralWeights, LtiError, Matrix, eigenvalues,
    integral_regulator, regulator,
};
use proptest::prelude::*;

/// Damping, power, and the weights of integral, position and rate.
type Case = [f64; 5];

fn solve([damping, power, integral, position, rate]: Case) -> Result<[f64; 3], LtiError> {
    let model = DampedIntegrator { damping_per_s: damping, power_per_s2: power };
    let weights = IntegralWeights { integral_per_s2: integral, position, rate_s2: rate };
    integral_regulator(model, weights).map(
        |IntegralRegulator { integral_per_s, position, rate_s }| [integral_per_s, position, rate_s],
    )
}

/// The chain integral, position, rate.
fn chain(damping: f64, power: f64) -> Result<(Matrix, Matrix), LtiError> {
    let a = Matrix::from_rows(&[[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -damping]])?;
    let b = Matrix::from_rows(&[[0.0], [0.0], [power]])?;
    Ok((a, b))
}

fn furthest(found: [f64; 3], expected: [f64; 3]) -> f64 {
    found.iter().zip(expected).map(|(found, right)| (found / right - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn the_gains_are_those_of_scipy_and_of_sixty_digits() {
    let mut rows = include_str!("data/integral_regulator.csv").lines();
    assert!(rows.next().is_some_and(|head| head.starts_with("damping_per_s,power_per_s2")));
    let mut count = 0;
    for row in rows {
        let numbers: Vec<f64> =
            row.split(',').map(|number| number.parse().expect("a number")).collect();
        let [case @ .., i, x, v, scipy_i, scipy_x, scipy_v] = numbers.as_slice() else {
            panic!("{row}");
        };
        let found = solve(case.try_into().expect("five numbers")).expect("it is solvable");
        // Some roundings of a dozen operations; SciPy's own error was at most 1.0e-13.
        let off = furthest(found, [*i, *x, *v]);
        assert!(off < 2e-15, "{row}: {found:?} is off by {off:e}");
        assert!(furthest(found, [*scipy_i, *scipy_x, *scipy_v]) < 1.1e-13, "{row}");
        count += 1;
    }
    assert_eq!(count, 40);
}

#[test]
fn a_triple_integrator_with_equal_weights_has_the_known_gains() {
    // k² = 1 + 2 c and c² = 1 + 2 k have the common root 1 + √2.
    let expected = 1.0 + 2.0_f64.sqrt();
    let found = solve([0.0, 1.0, 1.0, 1.0, 1.0]).expect("it is solvable");
    assert!(furthest(found, [1.0, expected, expected]) < 1e-15, "{found:?}");
}

#[test]
fn weights_and_power_that_are_not_above_zero_are_refused_by_name() {
    let good: Case = [1.0, 2.0, 3.0, 4.0, 5.0];
    let names = [
        "power, 1/s²",
        "weight of the integral, 1/s²",
        "weight of the position",
        "weight of the rate, s²",
    ];
    for (index, name) in names.into_iter().enumerate() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let mut case = good;
            case[index + 1] = bad;
            let refused = solve(case);
            assert!(
                matches!(refused, Err(LtiError::NotPositive { what, .. }) if what == name),
                "{case:?}: {refused:?}"
            );
        }
    }
    let refused = solve([f64::NAN, 2.0, 3.0, 4.0, 5.0]);
    assert!(matches!(refused, Err(LtiError::NotFinite { what: "damping, 1/s", .. })));
    let refused = solve([1.0, 1e-300, 1e300, 1.0, 1.0]);
    assert_eq!(refused, Err(LtiError::OutOfRange { what: "gain of the regulator" }));
}

/// A number of any size between two powers of ten.
fn sized(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(libm::exp10)
}

proptest! {
    #[test]
    fn the_design_model_is_stable_under_any_positive_weights(
        damping in -20.0..20.0_f64,
        power in sized(-2.0, 2.0),
        weights in (sized(-3.0, 3.0), sized(-3.0, 3.0), sized(-3.0, 3.0)),
    ) {
        let case = [damping, power, weights.0, weights.1, weights.2];
        let [integral, position, rate] = solve(case)?;
        let closed = Matrix::from_rows(&[
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [-power * integral, -power * position, -damping - power * rate],
        ])?;
        for pole in eigenvalues(&closed)? {
            prop_assert!(pole.re < 0.0, "{case:?}: {pole}");
        }
    }

    #[test]
    fn the_closed_form_is_what_the_sign_function_finds(
        damping in -3.0..3.0_f64,
        power in sized(-1.0, 1.0),
        weights in (sized(-1.0, 1.0), sized(-1.0, 1.0), sized(-1.0, 1.0)),
    ) {
        let (a, b) = chain(damping, power)?;
        let mut q = Matrix::zeros(3, 3);
        for (index, weight) in [weights.0, weights.1, weights.2].into_iter().enumerate() {
            q.set(index, index, weight)?;
        }
        let general = regulator(&a, &b, &q, &Matrix::identity(1))?;
        let found = solve([damping, power, weights.0, weights.1, weights.2])?;
        let general = general.gain.data().try_into().expect("a row of three");
        // The sign function is the less exact of the two.
        prop_assert!(furthest(found, general) < 1e-8, "{found:?} and {general:?}");
    }

    #[test]
    fn numbers_of_any_size_give_gains_or_a_reason(
        damping in any::<f64>(),
        others in prop::array::uniform4(any::<f64>()),
    ) {
        if let Ok(gains) = solve([damping, others[0], others[1], others[2], others[3]]) {
            prop_assert!(gains.iter().all(|gain| gain.is_finite() && *gain > 0.0), "{gains:?}");
        }
    }
}
