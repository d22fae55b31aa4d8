//! Real polynomials in $w = \tan^2(\omega T / 2)$ that are proved.

use super::number::Number;
use crate::complex::Complex;
use crate::wide::WideBall;

/// $R(w) + j t I(w)$, $w = t^2$: a polynomial in $s = j t$.
///
/// With 256 bits and more: where all modes are fast, as those of a long dead time, the coefficients are far larger than what they
/// sum up to.
#[derive(Debug, Clone)]
pub(super) struct Real<const W: usize> {
    even: Vec<WideBall<W>>,
    odd: Vec<WideBall<W>>,
}

impl<const W: usize> Real<W> {
    /// From coefficients over s, lowest power first, of at most this degree.
    pub(super) fn of_s(coefficients: &[WideBall<W>], degree: usize) -> Self {
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
            let part = |part: &[WideBall<W>]| value(part.iter().rev(), place).rounded();
            return Complex::new(part(&self.even), tangent * part(&self.odd));
        }
        let part = |part: &[WideBall<W>]| value(part.iter(), 1.0 / place).rounded();
        // An even degree is that of the even part alone.
        let factor = if self.even.len() > self.odd.len() { 1.0 / tangent } else { tangent };
        Complex::new(part(&self.even), factor * part(&self.odd))
    }

    /// The sum with another, with factors on both.
    pub(super) fn combined(&self, factor: f64, other: &Self, others: f64) -> Self {
        let (own_factor, other_factor) = (WideBall::from(factor), WideBall::from(others));
        let sum = |own: &[WideBall<W>], other: &[WideBall<W>]| {
            let terms = own.iter().zip(other);
            terms
                .map(|(own, other)| own_factor.times(own).plus(&other_factor.times(other)))
                .collect()
        };
        Self { even: sum(&self.even, &other.even), odd: sum(&self.odd, &other.odd) }
    }

    /// $|R + j t I|^2 = R^2 + w I^2$.
    pub(super) fn squared(&self) -> Vec<WideBall<W>> {
        let mut sum = vec![WideBall::ZERO; self.even.len() + self.odd.len()];
        add_product(&mut sum, &self.even, &self.even);
        add_product(&mut sum[1..], &self.odd, &self.odd);
        sum
    }

    /// Imaginary part of the product with the conjugate of another, over t.
    pub(super) fn across(&self, other: &Self) -> Vec<WideBall<W>> {
        let count = (self.even.len() + self.odd.len()).saturating_sub(1).max(1);
        let mut sum = vec![WideBall::ZERO; count];
        add_product(&mut sum, &self.odd, &other.even);
        let negative: Vec<WideBall<W>> = self.even.iter().map(|value| value.negative()).collect();
        add_product(&mut sum, &negative, &other.odd);
        sum
    }
}

fn add_product<const W: usize>(
    sum: &mut [WideBall<W>],
    left: &[WideBall<W>],
    right: &[WideBall<W>],
) {
    for (i, left) in left.iter().enumerate() {
        for (sum, right) in sum[i..].iter_mut().zip(right) {
            *sum = sum.plus(&left.times(right));
        }
    }
}

/// A multiple of one polynomial less another of the same length.
pub(super) fn difference<T: Number>(factor: T, left: &[T], right: &[T]) -> Vec<T> {
    left.iter().zip(right).map(|(&left, &right)| factor.product(left).less(right)).collect()
}

/// Value at a place, over a power of it where it is beyond 1.
pub(super) fn value_at<T: Number>(polynomial: &[T], place: f64) -> T {
    if place <= 1.0 {
        value(polynomial.iter().rev(), place)
    } else {
        value(polynomial.iter(), 1.0 / place)
    }
}

/// Sum of coefficients, the last power first, times powers of a place.
fn value<'a, T: Number + 'a>(coefficients: impl Iterator<Item = &'a T>, place: f64) -> T {
    let place = T::from(place);
    coefficients.fold(T::ZERO, |sum, &coefficient| sum.product(place).sum(coefficient))
}
