//! Error-free sums, sums of bounds rounded up and exact scalings, where a processor rounds to nearest.

/// The exact sum of two numbers as `(sum, error)`.
///
/// # Source
/// D. E. Knuth, *The Art of Computer Programming*, volume 2, section 4.2.2, theorem B.
#[inline]
pub(super) fn exact_sum(left: f64, right: f64) -> (f64, f64) {
    let sum = left + right;
    let part = sum - left;
    (sum, (left - (sum - part)) + (right - part))
}

/// The sum of two numbers that are not negative, rounded up.
#[inline]
pub(super) fn sum_up(left: f64, right: f64) -> f64 {
    let (sum, error) = exact_sum(left, right);
    // After an overflow the error is NaN and the sum stays infinite.
    if error > 0.0 { sum.next_up() } else { sum }
}

/// `value` times a power of two, and by how much it can be off: 0 wherever the result is in range.
pub(super) fn times_power(value: f64, exponent: i32) -> (f64, f64) {
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
    fn sums_of_bounds_never_fall_short() {
        assert_eq!(sum_up(1.0, 1e-30).to_bits(), 1.0_f64.next_up().to_bits());
        assert_eq!(sum_up(1.5, 0.25).to_bits(), 1.75_f64.to_bits());
        assert!(sum_up(f64::MAX, f64::MAX).is_infinite());
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
