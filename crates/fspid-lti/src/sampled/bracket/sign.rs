//! Where a polynomial is positive, proved: by its coefficients in Bernstein's basis, which hold it between them.
//!
//! The half line $w \geq 0$ falls into $[0, 1]$ and, with the coefficients reversed, $1/w \in [0, 1]$. Towards 0 each
//! is cut at powers of 1/16, so that every slow mode has a stretch of its own size, until the rest shows its sign.
//! Stretches are tried in plain numbers with a bound of their rounding, then with twice the precision, then halved.
//!
//! # Source
//! R. T. Farouki, V. T. Rajan, On the numerical condition of polynomials in Bernstein form, Computer Aided Geometric
//! Design 4 (1987) 191; the rule of signs on an interval: A. Eigenwillig, Real root isolation for exact and
//! approximate polynomials using Descartes' rule of signs, Saarbrücken (2008), section 2.

use super::number::Number;
use crate::wide::power_of_two;

/// Stretches end at powers of this, by its exponent of 2.
const STRETCH: i32 = 4;
/// Below 16 to this power nothing is told apart.
const STRETCHES: i32 = 32;
/// Halvings of a stretch.
const HALVINGS: u32 = 48;
/// Rounding of one plain operation.
const UNIT: f64 = 0.5 * f64::EPSILON;
/// The part of a stretch that is left to the next.
const FIRST: f64 = 1.0 / (1 << STRETCH) as f64;

/// What is proved of a polynomial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Sign {
    /// It is positive for all $w \geq 0$ and at infinity.
    Positive,
    /// It is negative at this place.
    Negative(f64),
    /// Its sign at this place, or next to it, is hidden by rounding.
    Hidden(f64),
}

/// Places between which lies one zero, or may lie some that rounding does not tell apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Between {
    pub(super) low: f64,
    pub(super) high: f64,
}

/// The sign of a polynomial over $w \geq 0$.
pub(super) fn sign<T: Number>(polynomial: &[T]) -> Sign {
    let mut found = Sign::Positive;
    stretches(polynomial, Plain::is_positive, &mut |stretch| {
        found = stretch.sign(0);
        found == Sign::Positive
    });
    found
}

/// Where a polynomial has its zeros, for $w > 0$.
pub(super) fn zeros<T: Number>(polynomial: &[T]) -> Vec<Between> {
    let mut found = Vec::new();
    stretches(polynomial, Plain::has_one_sign, &mut |stretch| {
        stretch.zeros(0, &mut found);
        true
    });
    found.sort_by(|one, other| one.low.total_cmp(&other.low));
    found
}

/// Hands over the stretches that plain numbers leave open, until told to stop.
fn stretches<T: Number>(
    polynomial: &[T],
    closed: impl Fn(&Plain) -> bool,
    look: &mut impl FnMut(Stretch<T>) -> bool,
) {
    let reversed: Vec<T> = polynomial.iter().rev().copied().collect();
    let shares: Vec<T> = shares(polynomial.len());
    for (coefficients, inverse) in [(polynomial, false), (&reversed, true)] {
        for index in 0..=STRETCHES {
            let exponent = -STRETCH * index;
            let plain = Plain::new(coefficients, &shares, exponent);
            if closed(&plain) {
                break;
            }
            if index < STRETCHES && closed(&plain.after_first()) {
                continue;
            }
            let mut stretch = Stretch::new(coefficients, &shares, exponent, inverse);
            if index < STRETCHES {
                stretch.leave_first();
            }
            if !look(stretch) {
                return;
            }
        }
    }
}

/// One over each binomial coefficient of a degree, which is one less than their number.
fn shares<T: Number>(count: usize) -> Vec<T> {
    let mut share = T::from(1.0);
    let mut shares = Vec::with_capacity(count);
    for power in 1..=count {
        shares.push(share);
        let factor = T::from(power as f64).quotient(T::from((count - power) as f64));
        share = factor.map_or(T::ZERO, |factor| share.product(factor));
    }
    shares
}

/// Coefficients of Bernstein's basis in plain numbers, and a bound of the error of each.
struct Plain {
    beta: Vec<f64>,
    error: f64,
}

impl Plain {
    /// From 0 to a power of 2.
    fn new<T: Number>(coefficients: &[T], shares: &[T], exponent: i32) -> Self {
        let unit = power_of_two(exponent);
        let (mut power, mut size, mut error) = (1.0, 0.0, 0.0);
        let mut beta = Vec::with_capacity(coefficients.len());
        for (coefficient, share) in coefficients.iter().zip(shares) {
            let (value, radius) = coefficient.plain();
            let value = value * power;
            size += value.abs();
            error += radius * power + f64::MIN_POSITIVE;
            beta.push(value * share.plain().0);
            power *= unit;
        }
        accumulate(&mut beta, |one, other| one + other);
        let operations = 4.0 * beta.len() as f64 + 20.0;
        Self { beta, error: 1.01 * (error + operations * UNIT * size) }
    }

    /// Without the part from 0 to a sixteenth.
    fn after_first(mut self) -> Self {
        for end in (1..self.beta.len()).rev() {
            for index in 0..end {
                let (here, next) = (self.beta[index], self.beta[index + 1]);
                self.beta[index] = here + FIRST * (next - here);
            }
        }
        self
    }

    fn is_positive(&self) -> bool {
        self.beta.iter().all(|&value| value > self.error)
    }

    fn has_one_sign(&self) -> bool {
        self.is_positive() || self.beta.iter().all(|&value| -value > self.error)
    }
}

/// From powers over binomial coefficients to Bernstein's basis: $\beta_i = \sum_k \binom{i}{k} a_k / \binom{n}{k}$.
fn accumulate<T: Copy>(values: &mut [T], add: impl Fn(T, T) -> T) {
    for first in 1..values.len() {
        for index in (first..values.len()).rev() {
            values[index] = add(values[index], values[index - 1]);
        }
    }
}

/// A stretch of places with the polynomial on it.
struct Stretch<T> {
    /// Ends in w, or in 1/w.
    from: f64,
    to: f64,
    inverse: bool,
    beta: Vec<T>,
}

impl<T: Number> Stretch<T> {
    /// From 0 to a power of 2.
    fn new(coefficients: &[T], shares: &[T], exponent: i32, inverse: bool) -> Self {
        let terms = (0_i32..).zip(coefficients.iter().zip(shares));
        let scaled =
            terms.map(|(power, (value, share))| value.shifted(exponent * power).product(*share));
        let mut beta: Vec<T> = scaled.collect();
        accumulate(&mut beta, T::sum);
        Self { from: 0.0, to: power_of_two(exponent), inverse, beta }
    }

    /// Leaves the part from 0 to a sixteenth away.
    fn leave_first(&mut self) {
        for end in (1..self.beta.len()).rev() {
            for index in 0..end {
                let (here, next) = (self.beta[index], self.beta[index + 1]);
                self.beta[index] = here.sum(next.less(here).shifted(-STRETCH));
            }
        }
        self.from = FIRST * self.to;
    }

    fn halves(&self) -> [Self; 2] {
        let mut right = self.beta.clone();
        let mut left = Vec::with_capacity(right.len());
        for end in (0..right.len()).rev() {
            left.push(right[0]);
            for index in 0..end {
                right[index] = right[index].between(right[index + 1]);
            }
        }
        let middle = 0.5 * (self.from + self.to);
        let part = |from, to, beta| Self { from, to, inverse: self.inverse, beta };
        [part(self.from, middle, left), part(middle, self.to, right)]
    }

    /// A place in w.
    fn place(&self, at: f64) -> f64 {
        if self.inverse { 1.0 / at } else { at }
    }

    fn sign(&self, halvings: u32) -> Sign {
        if self.beta.iter().all(|value| value.positive()) {
            return Sign::Positive;
        }
        for (value, at) in [(self.beta.first(), self.from), (self.beta.last(), self.to)] {
            match value {
                Some(value) if value.positive() => {}
                Some(value) if value.negative() => return Sign::Negative(self.place(at)),
                _ => return Sign::Hidden(self.place(at)),
            }
        }
        if halvings >= HALVINGS {
            return Sign::Hidden(self.place(self.from));
        }
        let [left, right] = self.halves();
        match left.sign(halvings + 1) {
            Sign::Positive => right.sign(halvings + 1),
            other => other,
        }
    }

    fn zeros(&self, halvings: u32, found: &mut Vec<Between>) {
        let changes = self.changes();
        if changes == Some(0) {
            return;
        }
        // Between two ends whose signs are hidden rounding decides everything.
        let told = |value: Option<&T>| value.is_some_and(|it| it.positive() || it.negative());
        let hidden = !told(self.beta.first()) && !told(self.beta.last());
        if changes == Some(1) || hidden || halvings >= HALVINGS {
            let (one, other) = (self.place(self.from), self.place(self.to));
            found.push(Between { low: one.min(other), high: one.max(other) });
            return;
        }
        for half in self.halves() {
            half.zeros(halvings + 1, found);
        }
    }

    /// Changes of sign from coefficient to coefficient; `None` if there may be more than one, or if the sign at an end
    /// is hidden.
    fn changes(&self) -> Option<usize> {
        let told = |value: &T| match (value.positive(), value.negative()) {
            (true, _) => Some(1),
            (_, true) => Some(-1),
            _ => None,
        };
        let (first, last) = (told(self.beta.first()?)?, told(self.beta.last()?)?);
        if first == last {
            return self.beta.iter().all(|value| told(value) == Some(first)).then_some(0);
        }
        // Hidden signs between different ones are one change in any case.
        let mut changed = false;
        for sign in self.beta.iter().filter_map(told) {
            if changed && sign == first {
                return None;
            }
            changed |= sign != first;
        }
        Some(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ball::Ball;

    /// Product of $w - r$ and of $(w - a)^2 + b$.
    fn polynomial(roots: &[f64], pairs: &[(f64, f64)]) -> Vec<Ball> {
        let factors = roots.iter().map(|root| vec![-root, 1.0]);
        let factors = factors.chain(pairs.iter().map(|(a, b)| vec![a * a + b, -2.0 * a, 1.0]));
        let mut product = vec![Ball::from(1.0)];
        for factor in factors {
            let mut next = vec![Ball::ZERO; product.len() + factor.len() - 1];
            for (i, value) in product.iter().enumerate() {
                for (j, &own) in factor.iter().enumerate() {
                    next[i + j] = next[i + j].plus(value.times(Ball::from(own)));
                }
            }
            product = next;
        }
        product
    }

    #[test]
    fn a_polynomial_without_zeros_is_positive_however_near_it_comes() {
        for b in [1.0, 1e-3, 1e-9, 1e-14] {
            for a in [1e-18, 1e-9, 0.3, 1.0, 7.0, 1e6] {
                let near = polynomial(&[-1.0, -1e-8], &[(a, b * a * a), (2e-12, 1e-25)]);
                assert_eq!(sign(&near), Sign::Positive, "{a} {b}");
                assert_eq!(zeros(&near), vec![], "{a} {b}");
            }
        }
    }

    #[test]
    fn a_polynomial_with_two_zeros_side_by_side_is_not() {
        for a in [1e-18, 1e-9, 0.3, 1.0, 7.0, 1e6] {
            let dips = polynomial(&[-1.0, -1e-8], &[(a, -1e-16 * a * a), (2e-12, 1e-25)]);
            let Sign::Negative(place) = sign(&dips) else { panic!("{a}: {:?}", sign(&dips)) };
            assert!((place / a - 1.0).abs() < 1e-6, "{place} {a}");
            let found = zeros(&dips);
            assert_eq!(found.len(), 2, "{a} {found:?}");
            assert!(found.iter().all(|it| it.low <= a * 1.001 && it.high >= 0.999 * a));
        }
    }

    #[test]
    fn a_double_zero_is_hidden_and_held_between_places() {
        let touching = polynomial(&[-1.0], &[(0.375, 0.0)]);
        assert!(matches!(sign(&touching), Sign::Hidden(_)), "{:?}", sign(&touching));
        let found = zeros(&touching);
        assert!(found.iter().any(|it| it.low <= 0.375 && it.high >= 0.375), "{found:?}");
    }

    #[test]
    fn all_single_zeros_are_held_apart() {
        let roots = [1e-20, 3e-20, 1e-9, 1.0, 1.001, 50.0, 1e7];
        let found = zeros(&polynomial(&roots, &[(0.5, 1e-4)]));
        assert!(found.len() >= roots.len(), "{found:?}");
        for root in roots {
            assert!(found.iter().any(|it| it.low <= root && it.high >= root), "{root} {found:?}");
        }
    }
}
