//! Roots of polynomials: against 60-digit arithmetic, against closed forms, and in bulk.

use crate::support;

use core::f64::consts::TAU;

use fspid_lti::{Complex, LtiError, Polynomial, modulus};
use proptest::prelude::*;
use support::{Random, complex_numbers, numbers, repeatable, rows, worst_relative};

type Outcome = Result<(), LtiError>;

fn roots(coefficients: &[f64]) -> Result<Vec<Complex>, LtiError> {
    Polynomial::new(coefficients)?.roots()
}

/// Everything that is promised of the order and the symmetry of roots.
fn is_tidy(roots: &[Complex]) -> bool {
    let ordered = roots.windows(2).all(|pair| (pair[0].re, pair[0].im) <= (pair[1].re, pair[1].im));
    let paired = roots.iter().all(|root| {
        let count = |wanted: Complex| roots.iter().filter(|&&other| other == wanted).count();
        count(*root) == count(root.conj())
    });
    ordered && paired
}

/// Simple roots come out within a few units in the last place, however ill-conditioned they are.
const SIMPLE_TOL: f64 = 1e-15;

#[test]
fn roots_are_those_of_the_given_coefficients_to_the_last_digits() -> Outcome {
    for row in rows(include_str!("data/roots.csv")) {
        let found = roots(&numbers(row[1]))?;
        let error = worst_relative(&found, &complex_numbers(row[2]));
        assert!(error < SIMPLE_TOL, "{}: {error:e}", row[0]);
        assert!(is_tidy(&found), "{}", row[0]);
    }
    Ok(())
}

#[test]
fn the_sixth_roots_of_one_are_found() -> Outcome {
    let found = roots(&[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0])?;
    let expected: Vec<Complex> = (0..6)
        .map(|k| TAU * f64::from(k) / 6.0)
        .map(|angle| Complex::new(libm::cos(angle), libm::sin(angle)))
        .collect();
    assert!(worst_relative(&found, &expected) < SIMPLE_TOL, "{found:?}");
    assert!(is_tidy(&found));
    assert_eq!(found[0], Complex::new(-1.0, 0.0));
    Ok(())
}

#[test]
fn roots_at_the_origin_are_exactly_zero() -> Outcome {
    let found = roots(&[1.0, 4.9676, 12.941, 0.0, 0.0])?;
    assert_eq!(found[2..], [Complex::new(0.0, 0.0); 2]);
    assert_eq!(roots(&[3.0, 0.0])?, [Complex::new(0.0, 0.0)]);
    assert_eq!(roots(&[3.0])?, []);
    Ok(())
}

#[test]
fn a_line_and_a_parabola_have_the_roots_of_the_school_book() -> Outcome {
    assert_eq!(roots(&[2.0, -3.0])?, [Complex::new(1.5, 0.0)]);
    assert_eq!(roots(&[1.0, 2.0, 5.0])?, [Complex::new(-1.0, -2.0), Complex::new(-1.0, 2.0)]);
    // The textbook formula loses the small root altogether.
    let found = roots(&[1.0, 1e12, 1.0])?;
    assert!(
        worst_relative(&found, &[Complex::new(-1e12, 0.0), Complex::new(-1e-12, 0.0)]) < SIMPLE_TOL
    );
    Ok(())
}

#[test]
fn multiple_roots_scatter_no_more_than_promised() -> Outcome {
    // (x + 1)^2 (x + 3)^3, coefficients exact.
    let found = roots(&[1.0, 11.0, 46.0, 90.0, 81.0, 27.0])?;
    let expected = [-3.0, -3.0, -3.0, -1.0, -1.0].map(|re| Complex::new(re, 0.0));
    let error = worst_relative(&found, &expected);
    assert!(error < 1e-9, "{error:e}");
    assert!(is_tidy(&found));
    Ok(())
}

#[test]
fn coefficients_at_the_ends_of_the_range_are_no_obstacle() -> Outcome {
    let expected = [-3.0, -1.0].map(|re| Complex::new(re, 0.0));
    for scale in [1e-300, 1e300] {
        let found = roots(&[scale, 4.0 * scale, 3.0 * scale])?;
        assert!(worst_relative(&found, &expected) < SIMPLE_TOL, "{found:?}");
    }
    let found = roots(&[1e-150, 1.0, 1e-150])?;
    assert!(
        worst_relative(&found, &[-1e150, -1e-150].map(|re| Complex::new(re, 0.0))) < SIMPLE_TOL,
        "{found:?}"
    );
    let mut coefficients = [0.0; 11];
    (coefficients[0], coefficients[10]) = (1e-250, -1e250);
    let found = roots(&coefficients)?;
    assert!(found.iter().all(|&root| (modulus(root) / 1e50 - 1.0).abs() < 1e-14), "{found:?}");
    assert_eq!(
        roots(&[1e-300, 1e300]),
        Err(LtiError::OutOfRange { what: "root of the polynomial" })
    );
    assert_eq!(
        roots(&[1e300, 1e-300]),
        Err(LtiError::OutOfRange { what: "root of the polynomial" })
    );
    Ok(())
}

#[test]
fn a_polynomial_of_the_highest_degree_is_solved() -> Outcome {
    let mut coefficients = vec![0.0; fspid_lti::DEGREE_LIMIT + 1];
    (coefficients[0], coefficients[fspid_lti::DEGREE_LIMIT]) = (1.0, -1e20);
    let found = roots(&coefficients)?;
    let radius = libm::pow(10.0, 0.2);
    assert!(found.iter().all(|&root| (modulus(root) / radius - 1.0).abs() < SIMPLE_TOL));
    assert!(is_tidy(&found));
    Ok(())
}

/// Stable polynomial of real poles and pairs with sizes over four decades, and the poles it was made of.
fn stable(random: &mut Random) -> Result<(Polynomial, Vec<Complex>), LtiError> {
    let degree = random.uniform(2.0, 9.0) as usize;
    let mut poles: Vec<Complex> = Vec::new();
    let mut polynomial = Polynomial::new(&[1.0])?;
    while poles.len() < degree {
        let size = libm::pow(10.0, random.uniform(-2.0, 2.0));
        let pair = degree - poles.len() >= 2 && random.uniform(0.0, 1.0) < 0.5;
        let factor = if pair {
            let damping = random.uniform(0.02, 0.99);
            let imaginary = size * (1.0 - damping * damping).sqrt();
            poles.extend([-imaginary, imaginary].map(|im| Complex::new(-damping * size, im)));
            vec![1.0, 2.0 * damping * size, size * size]
        } else {
            poles.push(Complex::new(-size, 0.0));
            vec![1.0, size]
        };
        polynomial = polynomial.product(&Polynomial::new(&factor)?)?;
    }
    Ok((polynomial, poles))
}

/// Rounding the coefficients moves close roots by far more than the root finder does: 2.8e-11 for the worst of all.
const ROUNDED_COEFFICIENTS_TOL: f64 = 1e-10;

#[test]
fn twenty_thousand_stable_polynomials_give_back_their_poles() -> Outcome {
    let mut random = Random(2026);
    let mut worst: f64 = 0.0;
    for _ in 0..20_000 {
        let (polynomial, poles) = stable(&mut random)?;
        let found = polynomial.roots()?;
        assert!(is_tidy(&found));
        worst = worst.max(worst_relative(&found, &poles));
    }
    assert!(worst < ROUNDED_COEFFICIENTS_TOL, "{worst:e}");
    Ok(())
}

proptest! {
    #![proptest_config(repeatable())]

    #[test]
    fn roots_are_tidy_and_their_product_is_the_polynomial(
        coefficients in prop::collection::vec(-10.0..10.0_f64, 2..13).prop_filter("leading", |c| c[0].abs() > 1e-3)
    ) {
        let found = roots(&coefficients)?;
        prop_assert_eq!(found.len(), coefficients.len() - 1);
        prop_assert!(is_tidy(&found));
        let mut product = vec![Complex::new(coefficients[0], 0.0)];
        let mut size = vec![coefficients[0].abs()];
        for &root in &found {
            product.push(Complex::new(0.0, 0.0));
            size.push(0.0);
            for i in (1..product.len()).rev() {
                product[i] = product[i] - root * product[i - 1];
                size[i] += modulus(root) * size[i - 1];
            }
        }
        for ((found, expected), size) in product.iter().zip(&coefficients).zip(&size) {
            prop_assert!(modulus(found - Complex::new(*expected, 0.0)) <= 1e-13 * size, "{found} {expected}");
        }
    }

    #[test]
    fn scaling_the_variable_by_two_scales_the_roots(
        coefficients in prop::collection::vec(-10.0..10.0_f64, 3..9).prop_filter("ends", |c| c[0].abs() > 0.1 && c[c.len() - 1].abs() > 0.1)
    ) {
        let stretched: Vec<f64> = coefficients.iter().enumerate().map(|(i, c)| libm::scalbn(*c, i as i32)).collect();
        let doubled: Vec<Complex> = roots(&coefficients)?.into_iter().map(|root| 2.0 * root).collect();
        prop_assert!(worst_relative(&roots(&stretched)?, &doubled) < 1e-14);
    }
}
