//! Sums and products with twice the working precision, for residuals near a root and for repeated squaring.
//!
//! A number is the unevaluated sum of two 64-bit ones. Only plain additions and multiplications: no fused operation.

use fspid_numeric::rounding;

use crate::complex::Complex;
use crate::matrix::Matrix;

/// A real number as `high + low`, where `low` is below the last digit of `high`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Doubled {
    pub(crate) high: f64,
    pub(crate) low: f64,
}

impl Doubled {
    pub(crate) const ZERO: Self = Self { high: 0.0, low: 0.0 };

    /// Exact sum of two numbers.
    pub(crate) fn exact_sum(left: f64, right: f64) -> Self {
        let (high, low) = rounding::exact_sum(left, right);
        Self { high, low }
    }

    /// Exact product of two numbers below 2^996.
    fn exact_product(left: f64, right: f64) -> Self {
        let (high, low) = rounding::exact_product(left, right);
        Self { high, low }
    }

    /// Sum, to about 2^-104 of the larger term.
    pub(crate) fn plus(self, other: Self) -> Self {
        let sum = Self::exact_sum(self.high, other.high);
        Self::exact_sum(sum.high, sum.low + (self.low + other.low))
    }

    /// Product, to about 2^-103 of itself.
    pub(crate) fn product(self, other: Self) -> Self {
        let product = Self::exact_product(self.high, other.high);
        Self::exact_sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }

    /// Product with a plain number, to about 2^-104 of itself.
    pub(crate) fn times(self, factor: f64) -> Self {
        let product = Self::exact_product(self.high, factor);
        Self::exact_sum(product.high, product.low + self.low * factor)
    }
}

impl Doubled {
    /// Quotient by a plain number, to about 2^-102 of itself.
    pub(crate) fn divided(self, by: f64) -> Self {
        let quotient = self.high / by;
        let rest = self.plus(Self::from(by).times(-quotient));
        Self::from(quotient).plus(Self::from(rest.high / by))
    }
}

/// Square matrix of [`Doubled`] entries, row after row.
#[derive(Debug, Clone)]
pub(crate) struct DoubledMatrix {
    size: usize,
    data: Vec<Doubled>,
}

impl DoubledMatrix {
    /// Identity plus a square matrix, without rounding.
    pub(crate) fn identity_plus(matrix: &Matrix) -> Self {
        let size = matrix.rows();
        let one = |i: usize| if i.is_multiple_of(size + 1) { 1.0 } else { 0.0 };
        let data = matrix.data().iter().enumerate();
        Self { size, data: data.map(|(i, &value)| Doubled::exact_sum(one(i), value)).collect() }
    }

    /// Square matrix by a function.
    pub(crate) fn from_function(size: usize, entry: impl Fn(usize, usize) -> Doubled) -> Self {
        Self { size, data: (0..size * size).map(|i| entry(i / size, i % size)).collect() }
    }

    pub(crate) fn at(&self, row: usize, column: usize) -> Doubled {
        self.data[row * self.size + column]
    }

    /// Product with itself.
    pub(crate) fn squared(&self) -> Self {
        self.product(self)
    }

    /// Product with a matrix of the same size.
    pub(crate) fn product(&self, other: &Self) -> Self {
        let entry = |i: usize| {
            let (row, column) = (i / self.size, i % self.size);
            let terms = (0..self.size).map(|k| (row * self.size + k, k * self.size + column));
            terms.fold(Doubled::ZERO, |sum, (left, right)| {
                sum.plus(self.data[left].product(other.data[right]))
            })
        };
        Self { size: self.size, data: (0..self.data.len()).map(entry).collect() }
    }

    /// Sum with a matrix of the same size.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        let entries = self.data.iter().zip(&other.data);
        Self { size: self.size, data: entries.map(|(own, other)| own.plus(*other)).collect() }
    }

    /// Every entry divided by a plain number.
    pub(crate) fn divided(&self, by: f64) -> Self {
        Self { size: self.size, data: self.data.iter().map(|value| value.divided(by)).collect() }
    }

    /// Nearest plain matrix.
    pub(crate) fn rounded(&self) -> Matrix {
        Matrix::from_function(self.size, self.size, |row, column| {
            self.data[row * self.size + column].high
        })
    }
}

impl From<f64> for Doubled {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

/// A complex number of two [`Doubled`] parts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DoubledComplex {
    re: Doubled,
    im: Doubled,
}

impl DoubledComplex {
    pub(crate) const ZERO: Self = Self { re: Doubled::ZERO, im: Doubled::ZERO };

    /// Product with a plain complex number.
    pub(crate) fn times(self, z: Complex) -> Self {
        Self {
            re: self.re.times(z.re).plus(self.im.times(-z.im)),
            im: self.re.times(z.im).plus(self.im.times(z.re)),
        }
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self { re: self.re.plus(other.re), im: self.im.plus(other.im) }
    }

    pub(crate) fn plus_real(self, value: f64) -> Self {
        Self { re: self.re.plus(value.into()), im: self.im }
    }

    /// Nearest plain complex number.
    pub(crate) fn rounded(self) -> Complex {
        Complex::new(self.re.high, self.im.high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_keeps_the_digits_that_working_precision_drops() {
        // (1 + 2^-30)^2 = 1 + 2^-29 + 2^-60.
        let factor = 1.0 + libm::exp2(-30.0);
        let square = Doubled::from(factor).times(factor).plus((-1.0 - libm::exp2(-29.0)).into());
        assert_eq!(square.high.to_bits(), libm::exp2(-60.0).to_bits());
    }

    #[test]
    fn a_sum_keeps_a_term_seventeen_decades_below() {
        let sum = Doubled::from(1.0).plus(1e-20.into()).plus((-1.0).into());
        assert_eq!(sum.high.to_bits(), 1e-20_f64.to_bits());
    }

    #[test]
    fn a_complex_product_follows_the_rule_of_signs() {
        let product = DoubledComplex::ZERO
            .plus_real(2.0)
            .times(Complex::new(1.0, 3.0))
            .times(Complex::new(0.0, 1.0));
        assert_eq!(product.rounded(), Complex::new(-6.0, 2.0));
    }
}
