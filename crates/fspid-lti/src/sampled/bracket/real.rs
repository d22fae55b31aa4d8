//! Real polynomials in $w = \tan^2(\omega T / 2)$ that are proved.

use crate::ball::Ball;
use crate::complex::Complex;
use crate::wide::WideBall;

/// $R(w) + j t\, I(w)$, $w = t^2$: a polynomial in $s = j t$.
#[derive(Debug, Clone)]
pub(super) struct Real {
    pub(super) even: Vec<Ball>,
    pub(super) odd: Vec<Ball>,
}

impl Real {
    /// From coefficients over s, lowest power first, of at most this degree.
    pub(super) fn of_s(coefficients: &[WideBall], degree: usize) -> Self {
        let every_second = |first: usize| {
            let places = (first..=degree).step_by(2).enumerate();
            let signed = places.map(|(index, power)| {
                let value = coefficients.get(power).map_or(Ball::ZERO, WideBall::ball);
                if index % 2 == 0 { value } else { value.negative() }
            });
            signed.collect()
        };
        Self { even: every_second(0), odd: every_second(1) }
    }

    /// Value at an angle, up to a factor that all of one degree have in common.
    pub(super) fn at(&self, angle_rad: f64) -> Complex {
        let (sin, cos) = libm::sincos(0.5 * angle_rad);
        let tangent = sin / cos;
        let place = tangent * tangent;
        if place <= 1.0 {
            let part = |part: &[Ball]| value(part.iter().rev(), place).rounded();
            return Complex::new(part(&self.even), tangent * part(&self.odd));
        }
        let part = |part: &[Ball]| value(part.iter(), 1.0 / place).rounded();
        // An even degree is that of the even part alone.
        let factor = if self.even.len() > self.odd.len() { 1.0 / tangent } else { tangent };
        Complex::new(part(&self.even), factor * part(&self.odd))
    }

    /// The sum with a multiple of another.
    pub(super) fn plus(&self, other: &Self, factor: Ball) -> Self {
        let sum = |own: &[Ball], others: &[Ball]| {
            own.iter().zip(others).map(|(own, other)| own.plus(factor.times(*other))).collect()
        };
        Self { even: sum(&self.even, &other.even), odd: sum(&self.odd, &other.odd) }
    }

    /// $|R + j t I|^2 = R^2 + w I^2$.
    pub(super) fn squared(&self) -> Vec<Ball> {
        let mut sum = vec![Ball::ZERO; self.even.len() + self.odd.len()];
        add_product(&mut sum, &self.even, &self.even);
        add_product(&mut sum[1..], &self.odd, &self.odd);
        sum
    }

    /// Imaginary part of the product with the conjugate of another, over t.
    pub(super) fn across(&self, other: &Self) -> Vec<Ball> {
        let mut sum = vec![Ball::ZERO; (self.even.len() + self.odd.len()).saturating_sub(1).max(1)];
        add_product(&mut sum, &self.odd, &other.even);
        let negative: Vec<Ball> = self.even.iter().map(|value| value.negative()).collect();
        add_product(&mut sum, &negative, &other.odd);
        sum
    }
}

fn add_product(sum: &mut [Ball], left: &[Ball], right: &[Ball]) {
    for (i, &left) in left.iter().enumerate() {
        for (sum, &right) in sum[i..].iter_mut().zip(right) {
            *sum = sum.plus(left.times(right));
        }
    }
}

/// A multiple of one polynomial less another of the same length.
pub(super) fn difference(factor: Ball, left: &[Ball], right: &[Ball]) -> Vec<Ball> {
    left.iter().zip(right).map(|(left, right)| factor.times(*left).minus(*right)).collect()
}

/// Sum of coefficients, the last power first, times powers of a place.
pub(super) fn value<'a>(coefficients: impl Iterator<Item = &'a Ball>, place: f64) -> Ball {
    let place = Ball::from(place);
    coefficients.fold(Ball::ZERO, |sum, &coefficient| sum.times(place).plus(coefficient))
}
