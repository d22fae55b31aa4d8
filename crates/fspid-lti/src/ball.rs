//! Numbers with twice the working precision and a bound of their error: what is proved of them holds.

use crate::doubled::Doubled;

/// Relative error of one sum or product of two [`Doubled`] numbers, over the sizes of its terms: 2^-104 and less, with
/// room.
const ROUNDING: f64 = 1.0 / (1_u128 << 100) as f64;
/// What a product may lose where its parts leave the range of numbers: 2^-1000.
const UNDERFLOW: f64 = f64::from_bits(23 << 52);
/// Bounds are computed in plain numbers; each such computation is rounded some times.
const UP: f64 = 1.0 + 16.0 * f64::EPSILON;

/// A real number that lies within `error` of `value`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ball {
    value: Doubled,
    error: f64,
}

impl Ball {
    pub(crate) const ZERO: Self = Self { value: Doubled::ZERO, error: 0.0 };

    pub(crate) fn new(value: Doubled, error: f64) -> Self {
        Self { value, error }
    }

    pub(crate) fn is_zero(self) -> bool {
        self.value.high == 0.0 && self.error == 0.0
    }

    /// Nearest plain number.
    pub(crate) fn rounded(self) -> f64 {
        self.value.high
    }

    /// How far [`Ball::rounded`] may be from the number.
    pub(crate) fn radius(self) -> f64 {
        (self.value.low.abs() + self.error) * UP
    }

    /// Largest size.
    pub(crate) fn at_most(self) -> f64 {
        (self.value.high.abs() + self.radius()) * UP
    }

    /// Smallest size; 0 if the number may be 0.
    pub(crate) fn at_least(self) -> f64 {
        (self.value.high.abs() / UP - self.radius()).max(0.0) / UP
    }

    pub(crate) fn negative(self) -> Self {
        Self { value: self.value.times(-1.0), error: self.error }
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        let size = self.value.high.abs() + other.value.high.abs();
        Self {
            value: self.value.plus(other.value),
            error: (self.error + other.error + ROUNDING * size) * UP,
        }
    }

    pub(crate) fn minus(self, other: Self) -> Self {
        self.plus(other.negative())
    }

    pub(crate) fn times(self, other: Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self::ZERO;
        }
        let (own, others) = (self.value.high.abs(), other.value.high.abs());
        let spread = own * other.error + others * self.error + self.error * other.error;
        Self {
            value: self.value.product(other.value),
            // The sizes leave out their low parts, which UP and ROUNDING have room for.
            error: (spread * UP + ROUNDING * own * others + UNDERFLOW) * UP,
        }
    }

    /// Times a power of two, given by its exponent.
    pub(crate) fn scaled(self, exponent: i32) -> Self {
        let scale = |value: f64| libm::scalbn(value, exponent);
        let (high, low) = (scale(self.value.high), scale(self.value.low));
        let lost = if high.abs() < UNDERFLOW && self.value.high != 0.0 { UNDERFLOW } else { 0.0 };
        Self { value: Doubled { high, low }, error: scale(self.error) * UP + lost }
    }

    /// Half the sum: a point between two neighbours.
    pub(crate) fn middle(self, other: Self) -> Self {
        let sum = self.plus(other);
        let value = Doubled { high: 0.5 * sum.value.high, low: 0.5 * sum.value.low };
        let lost = if value.high.abs() < UNDERFLOW { UNDERFLOW } else { 0.0 };
        Self { value, error: 0.5 * sum.error + lost }
    }

    /// Quotient by a number that is not 0; `None` if it may be.
    pub(crate) fn over(self, divisor: Self) -> Option<Self> {
        let least = divisor.at_least();
        if !(least > 0.0) {
            return None;
        }
        let exactly = |value: Doubled| Self { value, error: 0.0 };
        let rest = |quotient: Doubled| self.minus(exactly(quotient).times(divisor));
        let mut quotient = Doubled::from(self.value.high / divisor.value.high);
        for _ in 0..2 {
            let correction = rest(quotient).value.high / divisor.value.high;
            quotient = quotient.plus(Doubled::from(correction));
        }
        Some(Self { value: quotient, error: rest(quotient).at_most() / least * UP })
    }
}

impl From<f64> for Ball {
    fn from(value: f64) -> Self {
        Self { value: value.into(), error: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn has_sign(ball: Ball) -> bool {
        ball.rounded().abs() > ball.radius()
    }

    #[test]
    fn a_quotient_times_its_divisor_holds_the_dividend() {
        let (seven, three) = (Ball::from(7.0), Ball::from(3.0));
        let back = seven.over(three).expect("not 0").times(three).minus(seven);
        assert!(!has_sign(back));
        assert!(back.at_most() < 1e-28, "{back:?}");
        assert!(seven.over(Ball::ZERO).is_none());
    }

    #[test]
    fn what_cancels_has_no_sign_and_what_does_not_keeps_it() {
        let tenth = Ball::from(0.1).times(Ball::from(10.0));
        let small = Ball::from(1e-25);
        let nothing = tenth.minus(Ball::from(0.1).times(Ball::from(10.0)));
        assert!(!has_sign(nothing));
        assert!(has_sign(tenth.plus(small).minus(tenth)));
        assert!(has_sign(tenth.minus(small).minus(tenth)));
    }

    #[test]
    fn numbers_beyond_the_range_lose_no_bound() {
        let tiny = Ball::from(1e-200);
        let product = tiny.times(tiny);
        assert!(!has_sign(product) && product.at_most() > 0.0);
        assert!(!has_sign(tiny.scaled(-600)));
    }
}
