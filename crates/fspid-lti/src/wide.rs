//! Numbers of 256 bits and more with a bound of their error, for what cancels beyond twice the working precision.
//!
//! The coefficients of a loop whose modes lie over many decades are small differences: three modes at a millionth of
//! Nyquist's frequency leave 18 digits less than the matrix has.

use crate::ball::Ball;
use crate::doubled::Doubled;

/// Errors are computed in plain numbers.
const UP: f64 = 1.0 + 16.0 * f64::EPSILON;
/// Errors below this one are not kept.
const LEAST: f64 = f64::MIN_POSITIVE;

/// $\pm 0.m \cdot 2^e$ with the first bit of m set, or 0; words of 64 bits, the most significant first.
#[derive(Debug, Clone, Copy)]
struct Wide<const W: usize> {
    negative: bool,
    exponent: i32,
    words: [u64; W],
}

impl<const W: usize> Wide<W> {
    const ZERO: Self = Self { negative: false, exponent: 0, words: [0; W] };

    fn is_zero(&self) -> bool {
        self.words[0] == 0
    }

    /// Size, rounded.
    fn size(&self) -> f64 {
        // 2^-64 first: the words are a fraction.
        power_of_two(self.exponent - 64) * self.words[0] as f64
    }

    fn value(&self) -> f64 {
        if self.negative { -self.size() } else { self.size() }
    }

    fn plus(&self, other: &Self) -> Self {
        if self.is_zero() {
            return *other;
        }
        if other.is_zero() {
            return *self;
        }
        let first = (self.exponent, self.words) >= (other.exponent, other.words);
        let (large, small) = if first { (self, other) } else { (other, self) };
        let shifted = shifted_right(small.words, large.exponent.abs_diff(small.exponent));
        if large.negative == small.negative {
            let (mut words, mut carry) = ([0; W], false);
            for place in (0..W).rev() {
                let (sum, over) = large.words[place].overflowing_add(shifted[place]);
                let (sum, more) = sum.overflowing_add(u64::from(carry));
                (words[place], carry) = (sum, over || more);
            }
            if carry {
                words = shifted_right(words, 1);
                words[0] |= 1 << 63;
            }
            let exponent = large.exponent + i32::from(carry);
            return Self { negative: large.negative, exponent, words };
        }
        let (mut words, mut borrow) = ([0; W], false);
        for place in (0..W).rev() {
            let (rest, under) = large.words[place].overflowing_sub(shifted[place]);
            let (rest, more) = rest.overflowing_sub(u64::from(borrow));
            (words[place], borrow) = (rest, under || more);
        }
        Self { negative: large.negative, exponent: large.exponent, words }.normal()
    }

    fn times(&self, other: &Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self::ZERO;
        }
        // Twice the words, of which the lower half is only there for its carries.
        let mut product = [[0_u64; W]; 2];
        for (i, &own) in self.words.iter().enumerate().rev() {
            let mut carry = 0_u128;
            for (j, &word) in other.words.iter().enumerate().rev() {
                let place = &mut product[(i + j + 1) / W][(i + j + 1) % W];
                let sum = u128::from(own) * u128::from(word) + u128::from(*place) + carry;
                *place = low_word(sum);
                carry = sum >> 64;
            }
            product[i / W][i % W] = low_word(carry);
        }
        let [mut words, rest] = product;
        let mut exponent = self.exponent + other.exponent;
        if words[0] >> 63 == 0 {
            words = shifted_left_once(words, rest[0]);
            exponent -= 1;
        }
        Self { negative: self.negative != other.negative, exponent, words }
    }

    /// The same number with its first bit set.
    fn normal(self) -> Self {
        let Some(first) = self.words.iter().position(|&word| word != 0) else {
            return Self::ZERO;
        };
        let mut words = [0; W];
        words[..W - first].copy_from_slice(&self.words[first..]);
        let bits = words[0].leading_zeros();
        if bits > 0 {
            for place in 0..W {
                let next = words.get(place + 1).copied().unwrap_or(0);
                words[place] = words[place] << bits | next >> (64 - bits);
            }
        }
        let moved = 64 * i32::try_from(first).unwrap_or(0) + bits.cast_signed();
        Self { exponent: self.exponent - moved, words, ..self }
    }

    /// The nearest sum of two plain numbers; what is left out is below $2^{e - 106}$.
    fn doubled(&self) -> Doubled {
        let high = power_of_two(self.exponent - 53) * (self.words[0] >> 11) as f64;
        let rest = (self.words[0] & 0x7ff) << 42 | self.words[1] >> 22;
        let low = power_of_two(self.exponent - 106) * rest as f64;
        let sign = if self.negative { -1.0 } else { 1.0 };
        Doubled::exact_sum(sign * high, sign * low)
    }
}

impl<const W: usize> From<f64> for Wide<W> {
    fn from(value: f64) -> Self {
        if value == 0.0 || !value.is_finite() {
            return Self::ZERO;
        }
        let (fraction, exponent) = libm::frexp(value.abs());
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a fraction below 1 times 2^64, of 53 bits"
        )]
        let word = (fraction * 18_446_744_073_709_551_616.0) as u64;
        let mut words = [0; W];
        words[0] = word;
        Self { negative: value < 0.0, exponent, words }
    }
}

/// The lower half of a product.
fn low_word(value: u128) -> u64 {
    u64::try_from(value & u128::from(u64::MAX)).unwrap_or(0)
}

fn shifted_right<const W: usize>(words: [u64; W], bits: u32) -> [u64; W] {
    let mut shifted = [0; W];
    let (whole, bits) = ((bits / 64) as usize, bits % 64);
    for (from, shifted) in shifted.iter_mut().skip(whole).enumerate() {
        *shifted = words[from] >> bits;
        if bits > 0 && from > 0 {
            *shifted |= words[from - 1] << (64 - bits);
        }
    }
    shifted
}

fn shifted_left_once<const W: usize>(words: [u64; W], next: u64) -> [u64; W] {
    let mut shifted = [0; W];
    for place in 0..W {
        let after = words.get(place + 1).copied().unwrap_or(next);
        shifted[place] = words[place] << 1 | after >> 63;
    }
    shifted
}

/// A power of two, within the range of normal numbers.
pub(crate) const fn power_of_two(exponent: i32) -> f64 {
    let exponent = if exponent < -1022 {
        -1022
    } else if exponent > 1023 {
        1023
    } else {
        exponent
    };
    f64::from_bits(((exponent + 1023).unsigned_abs() as u64) << 52)
}

/// A real number that lies within `error` of `value`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WideBall<const W: usize> {
    value: Wide<W>,
    error: f64,
}

impl<const W: usize> WideBall<W> {
    /// Relative error of one sum or product: what is cut off, with room.
    const CUT: f64 = power_of_two(6 - 64 * W as i32);

    pub(crate) const ZERO: Self = Self { value: Wide::ZERO, error: 0.0 };

    /// Exact sum of two numbers.
    pub(crate) fn sum([high, low]: [f64; 2]) -> Self {
        Self { value: Wide::from(high).plus(&Wide::from(low)), error: 0.0 }
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.value.is_zero() && self.error == 0.0
    }

    /// Nearest plain number, or nearly so.
    pub(crate) fn rounded(&self) -> f64 {
        self.value.value()
    }

    /// How far [`WideBall::rounded`] may be from the number.
    pub(crate) fn radius(&self) -> f64 {
        if self.is_zero() { 0.0 } else { (self.value.size() * f64::EPSILON + self.error) * UP }
    }

    pub(crate) fn negative(self) -> Self {
        let negative = !self.value.negative;
        Self { value: Wide { negative, ..self.value }, error: self.error }
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        let size = self.value.size() + other.value.size();
        let rounding =
            if self.value.is_zero() || other.value.is_zero() { 0.0 } else { Self::CUT * size };
        let error = (self.error + other.error + rounding) * UP;
        Self { value: self.value.plus(&other.value), error }
    }

    pub(crate) fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negative())
    }

    pub(crate) fn times(&self, other: &Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self::ZERO;
        }
        let (own, others) = (self.value.size(), other.value.size());
        let spread = own * other.error + others * self.error + self.error * other.error;
        let error = (spread + Self::CUT * own * others) * UP + LEAST;
        Self { value: self.value.times(&other.value), error }
    }

    /// Times a power of two, given by its exponent.
    pub(crate) fn scaled(&self, exponent: i32) -> Self {
        let mut value = self.value;
        if !value.is_zero() {
            value.exponent += exponent;
        }
        let error =
            if self.error == 0.0 { 0.0 } else { self.error * power_of_two(exponent) + LEAST };
        Self { value, error }
    }

    /// Quotient by a number that is not 0; `None` if it may be.
    pub(crate) fn over(&self, divisor: &Self) -> Option<Self> {
        let least = (divisor.value.size() / UP - divisor.error) / UP;
        if !(least > 0.0) {
            return None;
        }
        let rest =
            |quotient: Wide<W>| self.minus(&Self { value: quotient, error: 0.0 }.times(divisor));
        let mut quotient = Wide::from(self.value.value() / divisor.value.value());
        // Each step adds some 50 bits.
        for _ in 0..=W * 64 / 50 {
            let correction = rest(quotient).value.value() / divisor.value.value();
            quotient = quotient.plus(&Wide::from(correction));
        }
        let rest = rest(quotient);
        let error = (rest.value.size() * UP + rest.error) / least * UP + LEAST;
        Some(Self { value: quotient, error })
    }

    /// The same number with twice the working precision.
    pub(crate) fn ball(&self) -> Ball {
        let cut = if self.value.is_zero() { 0.0 } else { power_of_two(self.value.exponent - 105) };
        let error = if self.is_zero() { 0.0 } else { (self.error + cut) * UP + LEAST };
        Ball::new(self.value.doubled(), error)
    }
}

impl<const W: usize> From<f64> for WideBall<W> {
    fn from(value: f64) -> Self {
        Self { value: value.into(), error: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wide(value: f64) -> WideBall<4> {
        value.into()
    }

    #[test]
    fn sums_and_products_of_plain_numbers_are_exact() {
        for (one, other) in [(0.1, 0.2), (1.0, -1e-60), (3.5, -3.5), (-7.0, 1e20), (0.0, 4.0)] {
            let back = wide(one).plus(&wide(other)).minus(&wide(one)).minus(&wide(other));
            assert!(back.value.is_zero(), "{one} {other}: {back:?}");
            let square = wide(one).plus(&wide(other)).times(&wide(one).plus(&wide(other)));
            let twice = wide(one).times(&wide(other)).scaled(1);
            let parts =
                wide(one).times(&wide(one)).plus(&twice).plus(&wide(other).times(&wide(other)));
            let left = square.minus(&parts);
            assert!(left.value.size() <= left.error, "{one} {other}: {left:?}");
            assert!(left.error <= 1e-70 * (1.0 + one * one + other * other), "{left:?}");
        }
    }

    #[test]
    fn a_quotient_times_its_divisor_holds_the_dividend() {
        for (one, other) in [(1.0, 3.0), (-1e-20, 7e10), (2.0_f64.sqrt(), 0.3)] {
            let back = wide(one).over(&wide(other)).expect("not 0").times(&wide(other));
            let left = back.minus(&wide(one));
            assert!(left.value.size() <= left.error, "{left:?}");
            assert!(left.error < 1e-70 * one.abs(), "{left:?}");
        }
        assert!(wide(1.0).over(&WideBall::ZERO).is_none());
    }

    #[test]
    fn a_number_survives_as_one_of_twice_the_working_precision() {
        let third = wide(1.0).over(&wide(3.0)).expect("not 0").negative();
        let left = third.ball().times(Ball::from(3.0)).plus(Ball::from(1.0));
        assert!(left.rounded().abs() <= left.radius() && left.at_most() < 1e-29, "{left:?}");
    }
}
