//! Elementary functions of Taylor polynomials.
//!
//! Most rest on one recurrence: for $y = F(a(t))$ with $F' = g$,
//! $y_k = \frac1k \sum_{j=1}^{k} j a_j g_{k-j}$.

use super::{Jet, convolution, number};
use crate::scalar::{Base, Scalar};

/// Larger whole powers go by the recurrence of all powers.
const MAX_WHOLE_POWER: i32 = 64;

impl<S: Base, const K: usize> Jet<S, K> {
    /// $j a_j$: the derivative, times the distance from the centre.
    fn weighted(&self) -> [S; K] {
        let weighted = |k: usize, _: &[S; K]| number::<S>(k) * self.coefficients[k];
        Self::from_recurrence(S::zero(), self.degree, weighted).coefficients
    }

    /// $\frac1k \sum_{j=1}^{k} j a_j g_{k-j}$
    #[inline]
    fn chained(&self, weighted: &[S; K], slope: &[S; K], k: usize) -> S {
        convolution(weighted, slope, k, 1, k.min(self.degree)) / number(k)
    }

    /// A function of this one that has that value and that slope.
    fn chain(self, value: S, slope: Self) -> Self {
        let weighted = self.weighted();
        self.function(value, |k, _| self.chained(&weighted, &slope.coefficients, k))
    }

    /// Sine and cosine (`sign` is -1) or hyperbolic sine and cosine (1).
    fn waves(self, sine: S, cosine: S, sign: S) -> [Self; 2] {
        let weighted = self.weighted();
        let mut cosines = [S::zero(); K];
        cosines[0] = cosine;
        let sines = self.function(sine, |k, sines| {
            cosines[k] = sign * self.chained(&weighted, sines, k);
            self.chained(&weighted, &cosines, k)
        });
        [sines, Self { coefficients: cosines, ..sines }]
    }

    /// The tangent (`sign` is 1) or the hyperbolic tangent (-1): $t' = 1 \pm t^2$.
    fn tangent(self, value: S, sign: S) -> Self {
        let weighted = self.weighted();
        let mut squares = [S::zero(); K];
        self.function(value, |k, tangent| {
            squares[k - 1] = convolution(tangent, tangent, k - 1, 0, k - 1);
            self.coefficients[k] + sign * self.chained(&weighted, &squares, k)
        })
    }

    /// A power by squaring; the exponent is not negative.
    fn whole_power(self, power: i32) -> Self {
        match power {
            0 => Self::one(),
            1 => self,
            _ if power % 2 == 0 => self.square().whole_power(power / 2),
            _ => self * self.whole_power(power - 1),
        }
    }

    /// A power with a constant exponent, where the base is not zero:
    /// $a y' = p a' y$, so $y_k = \frac1{k a_0} \sum_{j=1}^k (p j - k + j) a_j y_{k-j}$.
    fn constant_power(self, power: S) -> Self {
        let (base, a) = (self.value(), &self.coefficients);
        self.function(base.pow(power), |k, y| {
            let term = |j: usize| (power * number(j) - number(k - j)) * a[j] * y[k - j];
            let sum = (1..=k.min(self.degree)).map(term).reduce(|sum, term| sum + term);
            sum.unwrap_or(S::zero()) / (number::<S>(k) * base)
        })
    }
}

impl<S: Base, const K: usize> Scalar for Jet<S, K> {
    fn constant(value: f64) -> Self {
        Self::fixed(S::constant(value))
    }

    fn smaller(self, other: Self) -> Self {
        let value = self.value().smaller(other.value());
        Self::select(self.is_smaller(&other), value, self, other)
    }

    fn larger(self, other: Self) -> Self {
        let value = self.value().larger(other.value());
        Self::select(other.is_smaller(&self), value, self, other)
    }

    fn abs(self) -> Self {
        let negative = self.is_smaller(&Self::zero());
        Self::select(negative, self.value().abs(), -self, self)
    }

    fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        let (left, right) = (self.value(), bound.value());
        let value = left.if_less(right, then.value(), otherwise.value());
        Self::select(left.is_less(right), value, then, otherwise)
    }

    fn square(self) -> Self {
        let a = &self.coefficients;
        Self::from_recurrence(a[0].square(), 2 * self.degree, |k, _| {
            // Each pair once; the middle one, if any, is a square.
            let pairs = convolution(a, a, k, k.saturating_sub(self.degree), (k - 1) / 2);
            let middle = if k.is_multiple_of(2) { a[k / 2].square() } else { S::zero() };
            pairs + pairs + middle
        })
    }

    fn exp(self) -> Self {
        let weighted = self.weighted();
        self.function(self.value().exp(), |k, exp| self.chained(&weighted, exp, k))
    }

    fn ln(self) -> Self {
        self.chain(self.value().ln(), Self::one() / self)
    }

    fn sqrt(self) -> Self {
        let twice = self.value().sqrt() + self.value().sqrt();
        self.function(self.value().sqrt(), |k, root| {
            (self.coefficients[k] - convolution(root, root, k, 1, k - 1)) / twice
        })
    }

    fn pow(self, power: Self) -> Self {
        if power.degree > 0 {
            return (power * self.ln()).exp().with_value(self.value().pow(power.value()));
        }
        match power.value().whole() {
            Some(whole @ 0..=MAX_WHOLE_POWER) => self.whole_power(whole),
            _ => self.constant_power(power.value()),
        }
        .with_value(self.value().pow(power.value()))
    }

    fn sin(self) -> Self {
        let [sine, _] = self.waves(self.value().sin(), self.value().cos(), -S::one());
        sine
    }

    fn cos(self) -> Self {
        let [_, cosine] = self.waves(self.value().sin(), self.value().cos(), -S::one());
        cosine
    }

    fn tan(self) -> Self {
        self.tangent(self.value().tan(), S::one())
    }

    fn asin(self) -> Self {
        self.chain(self.value().asin(), Self::one() / (Self::one() - self.square()).sqrt())
    }

    fn acos(self) -> Self {
        self.chain(self.value().acos(), -(Self::one() / (Self::one() - self.square()).sqrt()))
    }

    fn atan(self) -> Self {
        self.chain(self.value().atan(), Self::one() / (Self::one() + self.square()))
    }

    fn sinh(self) -> Self {
        let [sine, _] = self.waves(self.value().sinh(), self.value().cosh(), S::one());
        sine
    }

    fn cosh(self) -> Self {
        let [_, cosine] = self.waves(self.value().sinh(), self.value().cosh(), S::one());
        cosine
    }

    fn tanh(self) -> Self {
        self.tangent(self.value().tanh(), -S::one())
    }

    fn floor(self) -> Self {
        let floor = Self::fixed(self.value().floor());
        // A whole number with width is a jump.
        let flat = floor.value().is_less(floor.value());
        Self::select(flat, floor.value(), floor, floor)
    }
}
