//! Real polynomials in $w = \tan^2(\omega T / 2)$ that are proved.

use crate::ball::Ball;
use crate::complex::Complex;
use crate::wide::WideBall;

/// $R(w) + j t\, I(w)$, $w = t^2$: a polynomial in $s = j t$.
///
/// With 256 bits: where all modes are fast, as those of a long dead time, the coefficients are far larger than what they
/// sum up to.
#[derive(Debug, Clone)]
pub(super) struct Real {
    even: Vec<WideBall>,
    odd: Vec<WideBall>,
}

impl Real {
    /// From coefficients over s, lowest power first, of at most this degree.
    pub(super) fn of_s(coefficients: &[WideBall], degree: usize) -> Self {
        let every_second = |first: usize| {
            let places = (first..=degree).step_by(2).enumerate();
            let signed = places.map(|(index, power)| {
                let value = coefficients.get(power).copied().unwrap_or(WideBall::ZERO);
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
            let part = |part: &[WideBall]| rounded_value(part.iter().rev(), place);
            return Complex::new(part(&self.even), tangent * part(&self.odd));
        }
        let part = |part: &[WideBall]| rounded_value(part.iter(), 1.0 / place);
        // An even degree is that of the even part alone.
        let factor = if self.even.len() > self.odd.len() { 1.0 / tangent } else { tangent };
        Complex::new(part(&self.even), factor * part(&self.odd))
    }

    /// The sum with another, with factors on both.
    pub(super) fn combined(&self, factor: f64, other: &Self, others: f64) -> Self {
        let (own_factor, other_factor) = (WideBall::from(factor), WideBall::from(others));
        let sum = |own: &[WideBall], other: &[WideBall]| {
            let terms = own.iter().zip(other);
            terms
                .map(|(own, other)| own_factor.times(own).plus(&other_factor.times(other)))
                .collect()
        };
        Self { even: sum(&self.even, &other.even), odd: sum(&self.odd, &other.odd) }
    }

    /// $|R + j t I|^2 = R^2 + w I^2$.
    pub(super) fn squared(&self) -> Vec<Ball> {
        let mut sum = vec![WideBall::ZERO; self.even.len() + self.odd.len()];
        add_product(&mut sum, &self.even, &self.even);
        add_product(&mut sum[1..], &self.odd, &self.odd);
        sum.iter().map(WideBall::ball).collect()
    }

    /// Imaginary part of the product with the conjugate of another, over t.
    pub(super) fn across(&self, other: &Self) -> Vec<Ball> {
        let count = (self.even.len() + self.odd.len()).saturating_sub(1).max(1);
        let mut sum = vec![WideBall::ZERO; count];
        add_product(&mut sum, &self.odd, &other.even);
        let negative: Vec<WideBall> = self.even.iter().map(|value| value.negative()).collect();
        add_product(&mut sum, &negative, &other.odd);
        sum.iter().map(WideBall::ball).collect()
    }
}

fn add_product(sum: &mut [WideBall], left: &[WideBall], right: &[WideBall]) {
    for (i, left) in left.iter().enumerate() {
        for (sum, right) in sum[i..].iter_mut().zip(right) {
            *sum = sum.plus(&left.times(right));
        }
    }
}

fn rounded_value<'a>(coefficients: impl Iterator<Item = &'a WideBall>, place: f64) -> f64 {
    let place = WideBall::from(place);
    let sum = |sum: WideBall, coefficient: &WideBall| sum.times(&place).plus(coefficient);
    coefficients.fold(WideBall::ZERO, sum).rounded()
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
