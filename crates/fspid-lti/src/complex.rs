//! Complex numbers: the type, and the two operations that plain arithmetic would get wrong at the ends of the range.

use core::cmp::Ordering;

/// A complex number of two 64-bit parts.
///
/// Use its arithmetic only. For the modulus and for quotients of numbers far from 1 take [`modulus`] and
/// [`quotient`]: they neither overflow early nor depend on the platform's mathematics library.
pub type Complex = num_complex::Complex<f64>;

/// Distance from the origin, in the unit of the number.
///
/// $$ |z| = \sqrt{x^2 + y^2} $$
#[must_use]
pub fn modulus(z: Complex) -> f64 {
    libm::hypot(z.re, z.im)
}

/// Ratio of two complex numbers without the overflow of squaring the divisor.
///
/// A divisor of zero gives parts that are infinite or NaN.
///
/// # Source
/// R. L. Smith, Algorithm 116: Complex division, Communications of the ACM 5 (1962) 435.
#[must_use]
pub fn quotient(dividend: Complex, divisor: Complex) -> Complex {
    if divisor.re.abs() >= divisor.im.abs() {
        let ratio = divisor.im / divisor.re;
        let scale = divisor.re + divisor.im * ratio;
        Complex::new(
            (dividend.re + dividend.im * ratio) / scale,
            (dividend.im - dividend.re * ratio) / scale,
        )
    } else {
        let ratio = divisor.re / divisor.im;
        let scale = divisor.re * ratio + divisor.im;
        Complex::new(
            (dividend.re * ratio + dividend.im) / scale,
            (dividend.im * ratio - dividend.re) / scale,
        )
    }
}

/// One over a complex number, by [`quotient`].
pub(crate) fn reciprocal(z: Complex) -> Complex {
    quotient(Complex::new(1.0, 0.0), z)
}

/// Sorts by real part, then by imaginary part; zeros lose their sign first so that they compare equal.
pub(crate) fn sort(values: &mut [Complex]) {
    for value in values.iter_mut() {
        *value = Complex::new(value.re + 0.0, value.im + 0.0);
    }
    values.sort_by(order);
}

fn order(left: &Complex, right: &Complex) -> Ordering {
    left.re.total_cmp(&right.re).then(left.im.total_cmp(&right.im))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quotient_survives_where_the_square_of_the_divisor_overflows() {
        let ratio = quotient(Complex::new(3e200, 4e200), Complex::new(0.0, 2e200));
        assert!(modulus(ratio - Complex::new(2.0, -1.5)) < 1e-15);
        let ratio = quotient(Complex::new(3e-200, 4e-200), Complex::new(2e-200, 0.0));
        assert!(modulus(ratio - Complex::new(1.5, 2.0)) < 1e-15);
    }

    #[test]
    fn sorting_puts_conjugates_side_by_side_with_the_lower_one_first() {
        let mut values =
            [Complex::new(0.0, 2.0), Complex::new(-0.0, -2.0), Complex::new(-1.0, 5.0)];
        sort(&mut values);
        assert_eq!(
            values,
            [Complex::new(-1.0, 5.0), Complex::new(0.0, -2.0), Complex::new(0.0, 2.0)]
        );
        assert!(values[1].re.is_sign_positive());
    }
}
