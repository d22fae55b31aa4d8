//! Taylor polynomials: a function of one variable by its first `K` Taylor coefficients.
//!
//! $$ c_k = \frac{f^{(k)}(x)}{k!}, \quad k = 0, \dots, K - 1 $$
//!
//! Each operation is a recurrence on the coefficients, exact to rounding. Over
//! [`Interval`](crate::scalar::Interval) they enclose $f^{(k)}(\xi) / k!$ for every $\xi$ inside,
//! which is what the remainder of a quadrature rule asks for.
//!
//! Where an interval leaves open which case of `min`, `max`, `abs`, `if_less` or `floor` holds, the
//! function need not be smooth: $c_0$ is then the hull of the cases and the other coefficients are
//! [`ENTIRE`](crate::scalar::Interval::ENTIRE), which no later operation makes finite again. Over
//! floats the case of the value counts.
//!
//! # Source
//! Griewank and Walther, *Evaluating Derivatives*, SIAM 2008, tables 13.1 and 13.2; W. Tucker,
//! *Validated Numerics*, Princeton 2011, chapter 4.

mod functions;

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::scalar::Base;

/// The first `K` Taylor coefficients of a function; `K` is at least 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<S, const K: usize> {
    coefficients: [S; K],
    /// Coefficients beyond this are exactly zero. Polynomials of low degree are frequent and cheap.
    degree: usize,
}

/// The sum of products $\sum_{j=from}^{to} a_j b_{k-j}$.
#[inline]
fn convolution<S: Base>(left: &[S], right: &[S], k: usize, from: usize, to: usize) -> S {
    let terms = (from..=to).map(|j| left[j] * right[k - j]);
    terms.reduce(|sum, term| sum + term).unwrap_or(S::zero())
}

/// A small whole number.
#[allow(clippy::cast_precision_loss, reason = "as small as the number of coefficients")]
fn number<S: Base>(whole: usize) -> S {
    S::constant(whole as f64)
}

impl<S: Base, const K: usize> Jet<S, K> {
    const LAST: usize = K - 1;

    /// The number itself, at a point or anywhere in an interval.
    #[must_use]
    pub fn variable(at: S) -> Self {
        Self::from_recurrence(at, 1, |_, _| S::one())
    }

    /// A number that does not depend on the variable.
    #[must_use]
    pub fn fixed(value: S) -> Self {
        Self::from_recurrence(value, 0, |_, _| S::zero())
    }

    /// The Taylor coefficients.
    #[must_use]
    pub fn coefficients(&self) -> &[S; K] {
        &self.coefficients
    }

    /// The value, which is the first coefficient.
    #[must_use]
    pub fn value(&self) -> S {
        self.coefficients[0]
    }

    /// The same function where its value is known better than by the recurrences.
    #[must_use]
    pub(crate) fn with_value(mut self, value: S) -> Self {
        self.coefficients[0] = value;
        self
    }

    /// `first`, then each coefficient from those before it.
    #[inline]
    fn from_recurrence(first: S, degree: usize, mut next: impl FnMut(usize, &[S; K]) -> S) -> Self {
        let mut coefficients = [S::zero(); K];
        coefficients[0] = first;
        let degree = degree.min(Self::LAST);
        for k in 1..=degree {
            coefficients[k] = next(k, &coefficients);
        }
        Self { coefficients, degree }
    }

    /// A function of this one: as many coefficients as there are, or a constant of a constant.
    #[inline]
    fn function(self, first: S, next: impl FnMut(usize, &[S; K]) -> S) -> Self {
        Self::from_recurrence(first, if self.degree == 0 { 0 } else { Self::LAST }, next)
    }

    /// One of two cases, or `value` and nothing known of the slopes if it is open which.
    pub(crate) fn select(less: Option<bool>, value: S, then: Self, otherwise: Self) -> Self {
        match less {
            Some(true) => then,
            Some(false) => otherwise,
            None => Self::from_recurrence(value, K, |_, _| S::unknown()),
        }
    }

    /// Whether this is below `bound` or, at most equal, may be taken for it.
    fn is_smaller(&self, bound: &Self) -> Option<bool> {
        let (left, right) = (self.value(), bound.value());
        left.is_less(right).or_else(|| right.is_less(left).map(|above| !above))
    }
}

impl<S: Base, const K: usize> Neg for Jet<S, K> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::from_recurrence(-self.value(), self.degree, |k, _| -self.coefficients[k])
    }
}

impl<S: Base, const K: usize> Add for Jet<S, K> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (a, b) = (&self.coefficients, &other.coefficients);
        Self::from_recurrence(a[0] + b[0], self.degree.max(other.degree), |k, _| a[k] + b[k])
    }
}

impl<S: Base, const K: usize> Sub for Jet<S, K> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        let (a, b) = (&self.coefficients, &other.coefficients);
        Self::from_recurrence(a[0] - b[0], self.degree.max(other.degree), |k, _| a[k] - b[k])
    }
}

impl<S: Base, const K: usize> Mul for Jet<S, K> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (a, b) = (&self.coefficients, &other.coefficients);
        Self::from_recurrence(a[0] * b[0], self.degree + other.degree, |k, _| {
            convolution(a, b, k, k.saturating_sub(other.degree), k.min(self.degree))
        })
    }
}

impl<S: Base, const K: usize> Div for Jet<S, K> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let (a, b) = (&self.coefficients, &other.coefficients);
        let degree = if other.degree == 0 { self.degree } else { Self::LAST };
        Self::from_recurrence(a[0] / b[0], degree, |k, quotient| {
            (a[k] - convolution(b, quotient, k, 1, k.min(other.degree))) / b[0]
        })
    }
}
