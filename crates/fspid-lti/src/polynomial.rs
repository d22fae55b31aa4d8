//! Real polynomials in one variable, coefficients from the highest power down.

use crate::complex::Complex;
use crate::error::LtiError;
use crate::roots;

/// Highest degree of a [`Polynomial`].
///
/// Far above any loop met in practice; it bounds the work of one call and the growth of rounding errors.
pub const DEGREE_LIMIT: usize = 100;

/// A real polynomial that is not zero everywhere.
///
/// $$ p(x) = c_0 x^n + c_1 x^{n-1} + \dots + c_n, \quad c_0 \neq 0 $$
#[derive(Debug, Clone, PartialEq)]
pub struct Polynomial {
    coefficients: Vec<f64>,
}

impl Polynomial {
    /// Polynomial with these coefficients, highest power first.
    ///
    /// # Errors
    /// No coefficient, one that is not finite, only zeros, a zero in front, a degree above [`DEGREE_LIMIT`].
    pub fn new(coefficients: &[f64]) -> Result<Self, LtiError> {
        Self::named("polynomial", coefficients.to_vec())
    }

    /// As [`Polynomial::new`], with the name that errors are to use.
    pub(crate) fn named(what: &'static str, coefficients: Vec<f64>) -> Result<Self, LtiError> {
        if coefficients.is_empty() {
            return Err(LtiError::Empty { what });
        }
        LtiError::unless_finite(what, &coefficients)?;
        match leading_zeros(&coefficients) {
            0 => {}
            zeros if zeros == coefficients.len() => return Err(LtiError::ZeroPolynomial { what }),
            zeros => return Err(LtiError::LeadingZero { what, zeros }),
        }
        let degree = coefficients.len() - 1;
        if degree > DEGREE_LIMIT {
            return Err(LtiError::DegreeTooHigh { what, degree, limit: DEGREE_LIMIT });
        }
        Ok(Self { coefficients })
    }

    /// As [`Polynomial::named`], after dropping zeros in front: for sums whose highest powers cancel.
    fn trimmed(what: &'static str, mut coefficients: Vec<f64>) -> Result<Self, LtiError> {
        LtiError::unless_finite(what, &coefficients)?;
        let zeros = leading_zeros(&coefficients);
        if zeros == coefficients.len() {
            return Err(LtiError::ZeroPolynomial { what });
        }
        coefficients.drain(..zeros);
        Self::named(what, coefficients)
    }

    /// Coefficients, highest power first; the first differs from zero.
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Highest power.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.coefficients.len() - 1
    }

    /// Coefficient of the highest power.
    #[must_use]
    pub fn leading(&self) -> f64 {
        self.coefficients[0]
    }

    /// How many roots lie exactly at the origin: the zeros at the end of the coefficients.
    #[must_use]
    pub fn roots_at_origin(&self) -> usize {
        self.coefficients.iter().rev().take_while(|&&value| value == 0.0).count()
    }

    /// Value at a real point, by Horner's rule; infinite or NaN where the powers overflow.
    #[must_use]
    pub fn at(&self, x: f64) -> f64 {
        self.coefficients.iter().fold(0.0, |value, coefficient| value * x + coefficient)
    }

    /// Value at a complex point, by Horner's rule; infinite or NaN where the powers overflow.
    #[must_use]
    pub fn at_complex(&self, z: Complex) -> Complex {
        self.coefficients
            .iter()
            .fold(Complex::new(0.0, 0.0), |value, coefficient| value * z + coefficient)
    }

    /// All roots with their multiplicity, sorted by real part, then imaginary part.
    ///
    /// Roots at the origin are exactly zero, complex ones come in exactly conjugate pairs. The roots are those of the
    /// coefficients as given: residuals are computed with twice the working precision, so a simple root is good to
    /// a few units in its last place unless its condition number approaches $10^{16}$. An m-fold root scatters by
    /// about $10^{-30/m}$ of its size where the coefficients hold it exactly, and by $10^{-16/m}$ otherwise.
    ///
    /// # Source
    /// O. Aberth, Iteration methods for finding all zeros of a polynomial simultaneously, Math. Comp. 27 (1973) 339;
    /// starting points of D. A. Bini, Numerical computation of polynomial zeros by means of Aberth's method,
    /// Numer. Algorithms 13 (1996) 179.
    ///
    /// # Errors
    /// A root too large or too small for a 64-bit number; no convergence within the limit.
    pub fn roots(&self) -> Result<Vec<Complex>, LtiError> {
        roots::roots(&self.coefficients)
    }

    /// Product of two polynomials.
    ///
    /// # Errors
    /// A degree above [`DEGREE_LIMIT`], a coefficient that overflows, a leading one that vanishes by underflow.
    pub fn product(&self, other: &Self) -> Result<Self, LtiError> {
        let mut coefficients = vec![0.0; self.degree() + other.degree() + 1];
        for (i, left) in self.coefficients.iter().enumerate() {
            for (j, right) in other.coefficients.iter().enumerate() {
                coefficients[i + j] += left * right;
            }
        }
        Self::named("product of polynomials", coefficients)
    }

    /// Sum of two polynomials; highest powers that cancel exactly are dropped.
    ///
    /// # Errors
    /// A sum that is zero everywhere, a coefficient that overflows.
    pub fn sum(&self, other: &Self) -> Result<Self, LtiError> {
        let (long, short) =
            if self.degree() >= other.degree() { (self, other) } else { (other, self) };
        let mut coefficients = long.coefficients.clone();
        let offset = long.degree() - short.degree();
        for (value, term) in coefficients[offset..].iter_mut().zip(&short.coefficients) {
            *value += term;
        }
        Self::trimmed("sum of polynomials", coefficients)
    }

    /// Every coefficient times a factor.
    ///
    /// # Errors
    /// A factor that is zero or not finite, a coefficient that overflows, a leading one that underflows.
    pub fn scaled(&self, factor: f64) -> Result<Self, LtiError> {
        Self::named(
            "scaled polynomial",
            self.coefficients.iter().map(|value| factor * value).collect(),
        )
    }

    /// Polynomial with the opposite sign.
    #[must_use]
    pub fn negated(&self) -> Self {
        Self { coefficients: self.coefficients.iter().map(|value| -value).collect() }
    }

    /// Derivative with respect to the variable.
    ///
    /// # Errors
    /// A constant, whose derivative is zero everywhere; a coefficient that overflows.
    pub fn derivative(&self) -> Result<Self, LtiError> {
        let degree = self.degree();
        let terms = self.coefficients[..degree].iter().enumerate();
        Self::trimmed("derivative", terms.map(|(i, value)| value * (degree - i) as f64).collect())
    }
}

fn leading_zeros(coefficients: &[f64]) -> usize {
    coefficients.iter().take_while(|&&value| value == 0.0).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polynomial(coefficients: &[f64]) -> Polynomial {
        Polynomial::new(coefficients).expect("a test polynomial is well formed")
    }

    #[test]
    fn malformed_coefficients_are_refused_with_what_was_found() {
        let what = "polynomial";
        assert_eq!(Polynomial::new(&[]), Err(LtiError::Empty { what }));
        assert_eq!(Polynomial::new(&[0.0, -0.0]), Err(LtiError::ZeroPolynomial { what }));
        assert_eq!(
            Polynomial::new(&[0.0, 0.0, 1.0]),
            Err(LtiError::LeadingZero { what, zeros: 2 })
        );
        assert!(matches!(
            Polynomial::new(&[1.0, f64::NAN]),
            Err(LtiError::NotFinite { index: 1, .. })
        ));
        assert!(matches!(
            Polynomial::new(&[f64::INFINITY]),
            Err(LtiError::NotFinite { index: 0, .. })
        ));
    }

    #[test]
    fn the_degree_limit_itself_is_allowed_and_one_more_is_not() {
        assert_eq!(polynomial(&[1.0; DEGREE_LIMIT + 1]).degree(), DEGREE_LIMIT);
        let beyond = Polynomial::new(&[1.0; DEGREE_LIMIT + 2]);
        assert_eq!(
            beyond,
            Err(LtiError::DegreeTooHigh { what: "polynomial", degree: 101, limit: 100 })
        );
        let square = polynomial(&[1.0; 52]).product(&polynomial(&[1.0; 52]));
        assert!(matches!(square, Err(LtiError::DegreeTooHigh { degree: 102, .. })));
    }

    #[test]
    fn arithmetic_agrees_with_hand_calculation() {
        let (left, right) = (polynomial(&[1.0, 2.0, 3.0]), polynomial(&[4.0, 5.0]));
        assert_eq!(left.product(&right), Polynomial::new(&[4.0, 13.0, 22.0, 15.0]));
        assert_eq!(left.sum(&right), Polynomial::new(&[1.0, 6.0, 8.0]));
        assert_eq!(right.sum(&left), left.sum(&right));
        assert_eq!(left.scaled(-2.0), Polynomial::new(&[-2.0, -4.0, -6.0]));
        assert_eq!(left.negated(), polynomial(&[-1.0, -2.0, -3.0]));
        assert_eq!(left.derivative(), Polynomial::new(&[2.0, 2.0]));
        assert_eq!(left.at(2.0).to_bits(), 11.0_f64.to_bits());
        assert_eq!(left.at_complex(Complex::new(0.0, 1.0)), Complex::new(2.0, 2.0));
    }

    #[test]
    fn powers_that_cancel_in_a_sum_are_dropped() {
        let sum = polynomial(&[1.0, 2.0, 3.0]).sum(&polynomial(&[-1.0, -2.0, 4.0]));
        assert_eq!(sum, Polynomial::new(&[7.0]));
    }

    #[test]
    fn results_that_vanish_or_overflow_are_refused() {
        let line = polynomial(&[1.0, 2.0]);
        assert!(matches!(
            line.sum(&polynomial(&[-1.0, -2.0])),
            Err(LtiError::ZeroPolynomial { .. })
        ));
        assert!(matches!(polynomial(&[3.0]).derivative(), Err(LtiError::ZeroPolynomial { .. })));
        assert!(matches!(line.scaled(0.0), Err(LtiError::ZeroPolynomial { .. })));
        assert!(matches!(line.scaled(f64::NAN), Err(LtiError::NotFinite { .. })));
        assert!(matches!(line.scaled(f64::MAX), Err(LtiError::NotFinite { .. })));
        let huge = polynomial(&[1e200, 1.0]);
        assert!(matches!(huge.product(&huge), Err(LtiError::NotFinite { .. })));
    }
}
