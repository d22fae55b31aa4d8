//! The normal distribution with mean 0 and standard deviation 1.

use std::f64::consts::FRAC_1_SQRT_2;

/// Probability of a number below z.
///
/// $$ \Phi(z) = \tfrac12 \operatorname{erfc}(-z / \sqrt 2) $$
///
/// The relative error is about $10^{-16} (1 + z^2)$: the second part is that of the rounded
/// argument.
#[must_use]
pub fn below(z: f64) -> f64 {
    0.5 * libm::erfc(-z * FRAC_1_SQRT_2)
}

/// Probability of a number above z, accurate where it is small.
#[must_use]
pub fn above(z: f64) -> f64 {
    below(-z)
}

/// The number below which a probability lies: the inverse of [`below`].
///
/// Minus infinity at 0 and below it, infinity at 1 and above, NaN for NaN. Rational functions of
/// $\frac12 - p$ near the middle and of $\sqrt{-\ln \min(p, 1 - p)}$ beyond; the relative error is
/// below 1e-15. For a probability near 1 ask for the other side with the other sign.
///
/// # Source
/// M. J. Wichura, "Algorithm AS 241: The percentage points of the normal distribution", Applied
/// Statistics 37 (1988), PPND16.
#[must_use]
pub fn quantile(probability: f64) -> f64 {
    let off_middle = probability - 0.5;
    if off_middle.abs() <= MIDDLE {
        let r = MIDDLE * MIDDLE - off_middle * off_middle;
        return off_middle * ratio(&MIDDLE_OVER, &MIDDLE_UNDER, r);
    }
    let tail = if off_middle < 0.0 { probability } else { 1.0 - probability };
    if tail <= 0.0 {
        return f64::INFINITY.copysign(off_middle);
    }
    let r = libm::sqrt(-libm::log(tail));
    let z = if r <= 5.0 {
        ratio(&TAIL_OVER, &TAIL_UNDER, r - 1.6)
    } else {
        ratio(&FAR_OVER, &FAR_UNDER, r - 5.0)
    };
    z.copysign(off_middle)
}

/// Half the width of the middle part.
const MIDDLE: f64 = 0.425;

/// Quotient of two polynomials, lowest power first, by Horner's rule.
fn ratio(over: &[f64; 8], under: &[f64; 8], r: f64) -> f64 {
    let sum = |coefficients: &[f64; 8]| coefficients.iter().rev().fold(0.0, |sum, c| sum * r + c);
    sum(over) / sum(under)
}

// The coefficients of the source, rounded to 64-bit numbers.
const MIDDLE_OVER: [f64; 8] = [
    3.3871328727963665,
    133.14166789178438,
    1971.5909503065513,
    13731.69376550946,
    45921.95393154987,
    67265.7709270087,
    33430.57558358813,
    2509.0809287301227,
];
const MIDDLE_UNDER: [f64; 8] = [
    1.0,
    42.31333070160091,
    687.1870074920579,
    5394.196021424751,
    21213.794301586597,
    39307.89580009271,
    28729.085735721943,
    5226.495278852854,
];
const TAIL_OVER: [f64; 8] = [
    1.4234371107496835,
    4.630337846156546,
    5.769497221460691,
    3.6478483247632045,
    1.2704582524523684,
    0.2417807251774506,
    0.022723844989269184,
    0.0007745450142783414,
];
const TAIL_UNDER: [f64; 8] = [
    1.0,
    2.053191626637759,
    1.6763848301838038,
    0.6897673349851,
    0.14810397642748008,
    0.015198666563616457,
    0.0005475938084995345,
    1.0507500716444169e-09,
];
const FAR_OVER: [f64; 8] = [
    6.657904643501103,
    5.463784911164114,
    1.7848265399172913,
    0.29656057182850487,
    0.026532189526576124,
    0.0012426609473880784,
    2.7115555687434876e-05,
    2.0103343992922881e-07,
];
const FAR_UNDER: [f64; 8] = [
    1.0,
    0.599832206555888,
    0.1369298809227358,
    0.014875361290850615,
    0.0007868691311456133,
    1.8463183175100548e-05,
    1.421511758316446e-07,
    2.0442631033899397e-15,
];

/// Share of a distribution that must lie between its limits. Below it numbers lose their digits.
pub(super) const LEAST_INSIDE: f64 = 1e-300;

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(table: &'static str) -> impl Iterator<Item = Vec<f64>> {
        let rows = table.lines().skip(1);
        rows.map(|row| row.split(',').map(|field| field.parse().unwrap()).collect())
    }

    #[test]
    fn quantiles_agree_with_sixty_digits_from_one_end_to_the_other() {
        let mut compared = 0;
        for row in rows(include_str!("../../tests/data/normal_quantile.csv")) {
            let (found, expected) = (quantile(row[0]), row[1]);
            // Six roundings; the worst is 6.7e-16.
            assert!((found - expected).abs() <= 1e-15 * expected.abs(), "{}: {found}", row[0]);
            compared += 1;
        }
        assert_eq!(compared, 89);
    }

    #[test]
    fn probabilities_agree_with_sixty_digits_in_both_tails() {
        for row in rows(include_str!("../../tests/data/normal_cdf.csv")) {
            let z = row[0];
            for (found, expected) in [(below(z), row[1]), (above(z), row[2])] {
                assert!((found / expected - 1.0).abs() <= 3e-16 * (1.0 + z * z), "{z}: {found:e}");
            }
        }
    }

    #[test]
    fn quantiles_are_mirrored_and_grow_with_the_probability() {
        let mut before = f64::NEG_INFINITY;
        for k in 1..40_000 {
            let p = f64::from(k) / 40_000.0;
            assert!(quantile(p) > before, "{p}");
            before = quantile(p);
            // Where both are exact.
            let q = f64::from(k) / 65_536.0;
            assert_eq!(quantile(q), -quantile(1.0 - q));
        }
        assert!(quantile(0.075) < quantile(0.075 + 1e-15));
        assert!(quantile(1.388e-11) < quantile(1.389e-11));
    }

    #[test]
    fn quantiles_and_probabilities_undo_each_other() {
        for k in -370..=80 {
            let z = f64::from(k) / 10.0;
            let p = if z < 0.0 { quantile(below(z)) } else { -quantile(above(z)) };
            assert!((p - z).abs() <= 1e-15 * (1.0 + z.abs()), "{z}: {p}");
        }
    }

    #[test]
    fn probabilities_that_are_none_have_no_finite_quantile() {
        for p in [0.0, -0.0, -1.0, f64::NEG_INFINITY] {
            assert_eq!(quantile(p), f64::NEG_INFINITY);
        }
        for p in [1.0, 2.0, f64::INFINITY] {
            assert_eq!(quantile(p), f64::INFINITY);
        }
        assert!(quantile(f64::NAN).is_nan());
        assert!(quantile(f64::from_bits(1)).is_finite());
    }
}
