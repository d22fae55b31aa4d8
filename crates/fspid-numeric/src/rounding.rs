//! What rounding takes away, and sums, products, quotients and roots rounded down or up, in a processor that rounds to
//! nearest.
//!
//! A result that is not exact moves one float outward. Whether a sum is exact tells the error-free
//! transformation of Knuth and Møller; whether a product is, the number of its factors' digits.
//! Up is down of the negative.
//!
//! # Source
//! D. E. Knuth, *The Art of Computer Programming*, volume 2, section 4.2.2, theorem B; that its
//! error term is exact wherever the sum does not overflow: Boldo, Graillat and Muller, *On the
//! robustness of the 2Sum and Fast2Sum algorithms*, ACM Trans. Math. Softw. 44 (2017) 4. Products:
//! T. J. Dekker, *A floating-point technique for extending the available precision*, Numer. Math. 18
//! (1971) 224.

/// The place below the last digit of the mantissa.
const BELOW_MANTISSA: u64 = 1 << 52;
/// The bits of positive infinity.
const INFINITY_BITS: u64 = f64::INFINITY.to_bits();

/// Trailing zeros of the 53 digits; 52 for a power of two, for zero and for infinity.
#[inline]
const fn trailing_zeros(value: f64) -> u32 {
    (value.to_bits() | BELOW_MANTISSA).trailing_zeros()
}

/// True if the product has at most 53 digits.
#[inline]
fn product_fits(left: f64, right: f64) -> bool {
    let (left, right) = (trailing_zeros(left), trailing_zeros(right));
    left + right >= 53 || left == 52 || right == 52
}

/// True if neither overflow nor the loss of digits near zero can have touched `value`.
#[inline]
fn ordinary(value: f64) -> bool {
    value.abs() > f64::MIN_POSITIVE && value.abs() < f64::INFINITY
}

/// The exact sum of two numbers as `(sum, error)`; the error is NaN after an overflow.
#[inline]
#[must_use]
pub fn exact_sum(left: f64, right: f64) -> (f64, f64) {
    let sum = left + right;
    let part = sum - left;
    (sum, (left - (sum - part)) + (right - part))
}

/// 2^27 + 1: multiplying by it splits 53 bits into 26 and 26.
const SPLITTER: f64 = 134_217_729.0;

/// The upper and the lower half of the digits of a number below 2^996.
#[inline]
#[must_use]
pub fn halves(value: f64) -> (f64, f64) {
    let scaled = SPLITTER * value;
    let high = scaled - (scaled - value);
    (high, value - high)
}

/// The exact product of two numbers as `(product, error)`, where neither is above 2^996 and no part of it below the normal
/// numbers.
#[inline]
#[must_use]
pub fn exact_product(left: f64, right: f64) -> (f64, f64) {
    let product = left * right;
    (product, product_error(product, halves(left), halves(right)))
}

/// What rounding took from a product of two numbers, given by their [`halves`].
#[inline]
#[must_use]
pub fn product_error(product: f64, left: (f64, f64), right: (f64, f64)) -> f64 {
    let ((a, b), (c, d)) = (left, right);
    ((a * c - product) + a * d + b * c) + b * d
}

/// The sum, rounded down.
#[inline]
#[must_use]
pub fn sum_down(left: f64, right: f64) -> f64 {
    let (sum, error) = exact_sum(left, right);
    // After an overflow the error is NaN, and a step is right: from infinity to the largest number.
    if error >= 0.0 { sum } else { sum.next_down() }
}

/// The sum, rounded up.
#[inline]
#[must_use]
pub fn sum_up(left: f64, right: f64) -> f64 {
    -sum_down(-left, -right)
}

/// The product, rounded down; nothing times infinity is nothing.
#[inline]
pub(crate) fn product_down(left: f64, right: f64) -> f64 {
    let product = left * right;
    if !ordinary(product) {
        return extreme_down(left == 0.0 || right == 0.0, product);
    }
    if product_fits(left, right) { product } else { product.next_down() }
}

/// The product, rounded up.
#[inline]
pub(crate) fn product_up(left: f64, right: f64) -> f64 {
    -product_down(-left, right)
}

/// The quotient by a divisor that is not zero, rounded down.
#[inline]
pub(crate) fn quotient_down(left: f64, right: f64) -> f64 {
    let quotient = left / right;
    if !ordinary(quotient) {
        return extreme_down(left == 0.0, quotient);
    }
    let exact = product_fits(quotient, right) && is_product(left, quotient, right);
    if exact { quotient } else { quotient.next_down() }
}

/// The quotient, rounded up.
#[inline]
pub(crate) fn quotient_up(left: f64, right: f64) -> f64 {
    -quotient_down(-left, right)
}

/// The square root, rounded down. `libm::sqrt` rounds to nearest.
pub(crate) fn root_down(value: f64) -> f64 {
    let root = libm::sqrt(value);
    if root_is_exact(value, root) { root } else { root.next_down() }
}

/// The square root, rounded up.
pub(crate) fn root_up(value: f64) -> f64 {
    let root = libm::sqrt(value);
    if root_is_exact(value, root) { root } else { root.next_up() }
}

fn root_is_exact(value: f64, root: f64) -> bool {
    value == 0.0 || (product_fits(root, root) && is_product(value, root, root))
}

/// True if the exact product of `left` and `right`, which fits, is `value`.
#[inline]
fn is_product(value: f64, left: f64, right: f64) -> bool {
    ordinary(value) && value.to_bits() == (left * right).to_bits()
}

/// Rounds down a product or quotient at the ends of the number range; `zero` if it is exactly that.
#[cold]
fn extreme_down(zero: bool, rounded: f64) -> f64 {
    let above_zero = rounded == 0.0 && rounded.is_sign_positive();
    if zero || above_zero { 0.0 } else { rounded.next_down() }
}

/// `steps` floats below a value that is not negative, but not below zero.
#[inline]
pub(crate) const fn positive_down(value: f64, steps: u64) -> f64 {
    f64::from_bits(value.to_bits().saturating_sub(steps))
}

/// `steps` floats above a value that is not negative, at most infinity.
#[inline]
pub(crate) const fn positive_up(value: f64, steps: u64) -> f64 {
    let bits = value.to_bits() + steps;
    f64::from_bits(if bits < INFINITY_BITS { bits } else { INFINITY_BITS })
}

/// `steps` floats below; zero stays.
pub(crate) fn steps_down(value: f64, steps: u64) -> f64 {
    if value >= 0.0 { positive_down(value.abs(), steps) } else { -positive_up(-value, steps) }
}

/// `steps` floats above; zero stays.
pub(crate) fn steps_up(value: f64, steps: u64) -> f64 {
    -steps_down(-value, steps)
}

/// `value` times a power of two, and by how much it can be off: 0 wherever the result is in range.
#[must_use]
pub fn times_power(value: f64, exponent: i32) -> (f64, f64) {
    let scaled = libm::scalbn(value, exponent);
    if !scaled.is_finite() {
        return (0.0, f64::INFINITY);
    }
    let back = libm::scalbn(scaled, -exponent);
    // What went below the normal numbers lost less than the least of them.
    let exact = back.to_bits() == value.to_bits();
    (scaled, if exact { 0.0 } else { f64::MIN_POSITIVE })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_exact_does_not_move() {
        assert_eq!((sum_down(0.1, 0.0), sum_up(0.1, 0.0)), (0.1, 0.1));
        assert_eq!((sum_down(1.5, 2.25), sum_up(1.5, 2.25)), (3.75, 3.75));
        assert_eq!((product_down(0.1, 0.25), product_up(0.1, 0.25)), (0.025, 0.025));
        assert_eq!((product_down(-3.0, 7.0), product_up(-3.0, 7.0)), (-21.0, -21.0));
        assert_eq!((quotient_down(21.0, 7.0), quotient_up(21.0, 7.0)), (3.0, 3.0));
        assert_eq!((quotient_down(0.1, -1.0), quotient_up(0.1, -1.0)), (-0.1, -0.1));
        assert_eq!((root_down(2.25), root_up(2.25)), (1.5, 1.5));
        assert_eq!((root_down(0.0), root_up(0.0)), (0.0, 0.0));
    }

    #[test]
    fn what_is_not_exact_moves_by_one_float() {
        assert_eq!(sum_up(1.0, 1e-30), 1.0_f64.next_up());
        assert_eq!((sum_down(1.0, 1e-30), sum_down(1.0, -1e-30)), (1.0, 1.0_f64.next_down()));
        let third = 1.0 / 3.0;
        assert_eq!(quotient_down(1.0, 3.0), f64::next_down(third));
        assert_eq!(product_down(third, third), (third * third).next_down());
    }

    #[test]
    fn the_ends_of_the_number_range_stay_on_their_side() {
        let (least, most) = (5e-324, f64::MAX);
        assert_eq!((sum_down(most, most), sum_up(most, most)), (most, f64::INFINITY));
        assert_eq!((product_down(least, 0.3), product_up(least, 0.3)), (0.0, least));
        assert_eq!((product_down(least, -0.3), product_up(least, -0.3)), (-least, 0.0));
        assert_eq!((product_down(0.0, f64::INFINITY), product_up(-0.0, 1.0)), (0.0, 0.0));
        assert_eq!((product_down(most, 2.0), product_up(most, -2.0)), (most, -most));
        assert_eq!((quotient_down(least, 2.0), quotient_up(least, 2.0)), (0.0, least));
        // 53 digits that do not fit below the normal range round to a normal number.
        let factor = 1.0 - f64::EPSILON / 2.0;
        let product = product_down(f64::MIN_POSITIVE, factor);
        assert!(product < f64::MIN_POSITIVE, "{product:e}");
    }

    #[test]
    fn steps_stop_at_zero_and_at_infinity() {
        assert_eq!((positive_down(5e-324, 4), positive_up(f64::MAX, 4)), (0.0, f64::INFINITY));
        assert_eq!((steps_down(-0.0, 4), steps_up(0.0, 4)), (0.0, 0.0));
        assert_eq!(steps_down(-1.0, 1), (-1.0_f64).next_down());
        assert_eq!(steps_up(-1.0, 1), (-1.0_f64).next_up());
    }

    #[test]
    fn a_sum_and_what_rounding_takes_from_it_are_the_terms() {
        assert_eq!(exact_sum(1.0, 1e-30), (1.0, 1e-30));
        assert_eq!(exact_sum(1e-30, -1.0), (-1.0, 1e-30));
        assert!(exact_sum(f64::MAX, f64::MAX).1.is_nan());
    }

    #[test]
    fn a_product_and_what_rounding_takes_from_it_have_all_digits() {
        // (1 + 2^-30)^2 = 1 + 2^-29 + 2^-60.
        let factor = 1.0 + libm::exp2(-30.0);
        assert_eq!(exact_product(factor, factor), (1.0 + libm::exp2(-29.0), libm::exp2(-60.0)));
        let (high, low) = halves(factor);
        assert_eq!((high + low, exact_product(-3.0, 7.0)), (factor, (-21.0, 0.0)));
        assert!([high, low].iter().all(|half| trailing_zeros(*half) >= 26));
    }

    #[test]
    fn a_power_of_two_is_exact_or_says_how_far_it_is_off() {
        assert_eq!(times_power(0.1, -40), (libm::ldexp(0.1, -40), 0.0));
        assert_eq!(times_power(0.0, 40), (0.0, 0.0));
        let (value, error) = times_power(1.0 + f64::EPSILON, -1060);
        assert!(value < f64::MIN_POSITIVE && error >= f64::MIN_POSITIVE);
        let (value, error) = times_power(1e-300, -1060);
        assert!(value.abs() <= error);
        assert!(times_power(1e300, 100).1.is_infinite());
        assert!(times_power(f64::NAN, 0).1.is_infinite());
    }
}
