//! Transfer functions: a numerator over a denominator, as plants are printed in books.

use crate::complex::{Complex, modulus, quotient, reciprocal};
use crate::doubled::Doubled;
use crate::error::LtiError;
use crate::matrix::Matrix;
use crate::polynomial::Polynomial;
use crate::state_space::StateSpace;

/// A proper rational transfer function with real coefficients.
///
/// $$ G(s) = \frac{b_0 s^m + \dots + b_m}{a_0 s^n + \dots + a_n}, \quad m \le n $$
///
/// Coefficients stay as given: nothing is normalised and common factors are not cancelled.
#[derive(Debug, Clone, PartialEq)]
pub struct TransferFunction {
    numerator: Polynomial,
    denominator: Polynomial,
}

impl TransferFunction {
    /// Transfer function with these coefficients, highest power first.
    ///
    /// # Errors
    /// A numerator or denominator that [`Polynomial::new`] would refuse; a numerator of the higher degree;
    /// coefficients so far apart that the state-space form would overflow.
    pub fn new(numerator: &[f64], denominator: &[f64]) -> Result<Self, LtiError> {
        let numerator = Polynomial::named("numerator", numerator.to_vec())?;
        let denominator = Polynomial::named("denominator", denominator.to_vec())?;
        Self::from_polynomials(numerator, denominator)
    }

    /// Transfer function of two polynomials.
    ///
    /// # Errors
    /// As [`TransferFunction::new`].
    pub fn from_polynomials(
        numerator: Polynomial,
        denominator: Polynomial,
    ) -> Result<Self, LtiError> {
        let (numerator_degree, denominator_degree) = (numerator.degree(), denominator.degree());
        if numerator_degree > denominator_degree {
            return Err(LtiError::Improper { numerator_degree, denominator_degree });
        }
        let system = Self { numerator, denominator };
        LtiError::unless_finite("monic denominator", &system.monic_denominator())?;
        LtiError::unless_finite(
            "Markov parameters",
            &system.markov_parameters(denominator_degree + 1),
        )?;
        Ok(system)
    }

    /// Numerator, highest power first.
    #[must_use]
    pub fn numerator(&self) -> &Polynomial {
        &self.numerator
    }

    /// Denominator, highest power first.
    #[must_use]
    pub fn denominator(&self) -> &Polynomial {
        &self.denominator
    }

    /// Degree of the denominator less that of the numerator.
    #[must_use]
    pub fn relative_degree(&self) -> usize {
        self.denominator.degree() - self.numerator.degree()
    }

    /// Value at a complex frequency in rad/s; infinite or NaN at a pole.
    ///
    /// Far from the origin both polynomials are evaluated in 1/s, so that no power overflows.
    #[must_use]
    pub fn at(&self, s: Complex) -> Complex {
        if modulus(s) <= 1.0 {
            return quotient(self.numerator.at_complex(s), self.denominator.at_complex(s));
        }
        let w = reciprocal(s);
        let ratio = quotient(reversed_at(&self.numerator, w), reversed_at(&self.denominator, w));
        (0..self.relative_degree()).fold(ratio, |value, _| value * w)
    }

    /// Poles in rad/s: the roots of the denominator, without cancellation.
    ///
    /// # Errors
    /// As [`Polynomial::roots`].
    pub fn poles(&self) -> Result<Vec<Complex>, LtiError> {
        self.denominator.roots()
    }

    /// Zeros in rad/s: the roots of the numerator, without cancellation.
    ///
    /// # Errors
    /// As [`Polynomial::roots`].
    pub fn zeros(&self) -> Result<Vec<Complex>, LtiError> {
        self.numerator.roots()
    }

    /// Gain at rest: the limit of G(s) for s to 0.
    ///
    /// Roots at the origin that numerator and denominator share cancel in the limit.
    ///
    /// # Errors
    /// More poles than zeros at the origin, a ratio that overflows.
    pub fn dc_gain(&self) -> Result<f64, LtiError> {
        let (zeros, poles) = (self.numerator.roots_at_origin(), self.denominator.roots_at_origin());
        if poles > zeros {
            return Err(LtiError::InfiniteDcGain { integrators: poles - zeros });
        }
        if zeros > poles {
            return Ok(0.0);
        }
        let gain = lowest_term(&self.numerator) / lowest_term(&self.denominator);
        if gain.is_finite() { Ok(gain) } else { Err(LtiError::OutOfRange { what: "gain at rest" }) }
    }

    /// Series connection: the product of two transfer functions, without cancellation.
    ///
    /// # Errors
    /// A degree above the limit, coefficients that overflow.
    pub fn series(&self, other: &Self) -> Result<Self, LtiError> {
        let numerator = self.numerator.product(&other.numerator)?;
        Self::from_polynomials(numerator, self.denominator.product(&other.denominator)?)
    }

    /// Transfer function with the opposite sign; the denominator stays.
    #[must_use]
    pub fn negated(&self) -> Self {
        Self { numerator: self.numerator.negated(), denominator: self.denominator.clone() }
    }

    /// The first Markov parameters $h_0, h_1, \dots$: the feedthrough, then the impulse response and its derivatives
    /// just after time 0.
    ///
    /// $$ G(s) = h_0 + h_1 s^{-1} + h_2 s^{-2} + \dots, \quad h_k = \beta_k - \sum_{i=1}^{\min(k, n)} \alpha_i h_{k-i} $$
    ///
    /// with $\beta$ and $\alpha$ the coefficients over $a_0$, the numerator filled with zeros in front. Entries beyond
    /// the number of states can overflow when the poles are large; they are then infinite or NaN.
    #[must_use]
    pub fn markov_parameters(&self, count: usize) -> Vec<f64> {
        let alpha = self.monic_denominator();
        let offset = self.relative_degree();
        let mut markov = Vec::with_capacity(count);
        for k in 0..count {
            let given = k.checked_sub(offset).and_then(|i| self.numerator.coefficients().get(i));
            let beta = given.map_or(0.0, |value| value / self.denominator.leading());
            let past = alpha
                .iter()
                .zip(markov.iter().rev())
                .fold(0.0, |sum, (alpha, h): (&f64, &f64)| sum + alpha * h);
            markov.push(beta - past);
        }
        markov
    }

    /// Equations of state in the observability canonical form.
    ///
    /// $$ A = \begin{pmatrix} 0 & 1 & & \cr & & \ddots & \cr & & & 1 \cr -a_0 & -a_1 & \dots & -a_{n-1} \end{pmatrix}, \quad
    /// B = \begin{pmatrix} h_1 \cr \vdots \cr h_n \end{pmatrix}, \quad C = (1, 0, \dots, 0), \quad D = h_0 $$
    ///
    /// with the monic denominator $s^n + a_{n-1} s^{n-1} + \dots + a_0$ and the Markov parameters $h_k$. The states are
    /// the output and its derivatives, freed of the derivatives of the input:
    ///
    /// $$ x_1 = y - h_0 u, \quad x_{k+1} = \dot x_k - h_k u $$
    ///
    /// # Why this form
    /// An aeroplane's coefficients change in flight. When they do, the state vector stays and its meaning should too:
    /// here the first state *is* the pitch angle (for any strictly proper plant), and for a relative degree of 2 or more
    /// the second *is* the pitch rate, so neither jumps at the change. In the controllable form the output would be a
    /// sum weighted by the new numerator, and would jump.
    ///
    /// # Source
    /// T. Kailath, Linear Systems, Prentice-Hall 1980, section 2.3.
    #[must_use]
    pub fn to_state_space(&self) -> StateSpace {
        let states = self.denominator.degree();
        StateSpace::observability_form(
            &self.monic_denominator(),
            &self.markov_parameters(states + 1),
        )
    }

    /// What the rounding of [`to_state_space`](Self::to_state_space) left out of its A and B.
    ///
    /// The Markov parameters are large where modes are fast, and what they make at rest is a small difference: for
    /// slow modes their last digits count.
    #[must_use]
    pub fn state_space_rest(&self) -> StateSpace {
        let (model, leading) = (self.to_state_space(), self.denominator.leading());
        let alpha: Vec<Doubled> = self.denominator.coefficients()[1..]
            .iter()
            .map(|&value| Doubled::from(value).divided(leading))
            .collect();
        let (states, offset) = (alpha.len(), self.relative_degree());
        let mut markov: Vec<Doubled> = Vec::with_capacity(states + 1);
        for k in 0..=states {
            let given = k.checked_sub(offset).and_then(|i| self.numerator.coefficients().get(i));
            let beta = given.map_or(Doubled::ZERO, |&value| Doubled::from(value).divided(leading));
            let terms = alpha.iter().zip(markov.iter().rev());
            let value = terms.fold(beta, |sum, (alpha, h)| sum.plus(alpha.product(h.times(-1.0))));
            markov.push(value);
        }
        let rest = |fine: Doubled, plain: f64| fine.plus(Doubled::from(-plain)).high;
        let plain = self.monic_denominator();
        let alpha: Vec<f64> =
            alpha.iter().zip(plain).map(|(&fine, plain)| rest(fine, plain)).collect();
        let plain = core::iter::once(model.d()).chain([model.b()]).flat_map(Matrix::data);
        let markov: Vec<f64> =
            markov.iter().zip(plain).map(|(&fine, &plain)| rest(fine, plain)).collect();
        StateSpace::observability_rest(&alpha, &markov)
    }

    /// Denominator over its leading coefficient, without the leading 1.
    fn monic_denominator(&self) -> Vec<f64> {
        let leading = self.denominator.leading();
        self.denominator.coefficients()[1..].iter().map(|value| value / leading).collect()
    }
}

/// Polynomial with its coefficients in reverse order, at w.
fn reversed_at(polynomial: &Polynomial, w: Complex) -> Complex {
    polynomial
        .coefficients()
        .iter()
        .rev()
        .fold(Complex::new(0.0, 0.0), |value, coefficient| value * w + coefficient)
}

/// Coefficient of the lowest power that occurs.
fn lowest_term(polynomial: &Polynomial) -> f64 {
    polynomial.coefficients()[polynomial.degree() - polynomial.roots_at_origin()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matrix::Matrix;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    fn system(numerator: &[f64], denominator: &[f64]) -> TransferFunction {
        TransferFunction::new(numerator, denominator).expect("a test system is well formed")
    }

    #[test]
    fn malformed_systems_are_refused_by_name() {
        let refused = |numerator: &[f64], denominator: &[f64]| {
            TransferFunction::new(numerator, denominator).err()
        };
        assert_eq!(refused(&[], &[1.0]), Some(LtiError::Empty { what: "numerator" }));
        assert_eq!(refused(&[1.0], &[]), Some(LtiError::Empty { what: "denominator" }));
        assert_eq!(refused(&[0.0], &[1.0]), Some(LtiError::ZeroPolynomial { what: "numerator" }));
        assert_eq!(
            refused(&[1.0], &[0.0, 0.0]),
            Some(LtiError::ZeroPolynomial { what: "denominator" })
        );
        assert_eq!(
            refused(&[1.0], &[0.0, 1.0]),
            Some(LtiError::LeadingZero { what: "denominator", zeros: 1 })
        );
        let improper = LtiError::Improper { numerator_degree: 2, denominator_degree: 1 };
        assert_eq!(refused(&[1.0, 0.0, 0.0], &[1.0, 1.0]), Some(improper));
        assert!(matches!(
            refused(&[f64::NAN], &[1.0]),
            Some(LtiError::NotFinite { what: "numerator", .. })
        ));
        assert!(matches!(
            refused(&[1.0], &[1e-300, 1e300]),
            Some(LtiError::NotFinite { what: "monic denominator", .. })
        ));
        assert!(matches!(
            refused(&[1e300], &[1e-300]),
            Some(LtiError::NotFinite { what: "Markov parameters", .. })
        ));
    }

    #[test]
    fn the_gain_at_rest_is_a_limit() {
        assert_eq!(system(&[3.0, 6.0], &[1.0, 4.0]).dc_gain(), Ok(1.5));
        assert_eq!(system(&[3.0, 6.0, 0.0], &[1.0, 4.0, 0.0]).dc_gain(), Ok(1.5));
        assert_eq!(system(&[3.0, 0.0], &[1.0, 4.0]).dc_gain(), Ok(0.0));
        let doubly = system(&[3.0, 6.0], &[1.0, 4.0, 0.0, 0.0]).dc_gain();
        assert_eq!(doubly, Err(LtiError::InfiniteDcGain { integrators: 2 }));
        let huge = system(&[1.0, 1e200], &[1.0, 1e-200]).dc_gain();
        assert_eq!(huge, Err(LtiError::OutOfRange { what: "gain at rest" }));
    }

    #[test]
    fn the_response_far_from_the_origin_does_not_overflow() {
        let plant = system(&[2.0, 1.0], &[1.0, 1.0, 1.0, 1.0]);
        let value = plant.at(Complex::new(0.0, 1e120));
        assert!(modulus(value - Complex::new(-2e-240, 0.0)) < 1e-254, "{value}");
        assert!(!plant.at(Complex::new(-1.0, 0.0)).is_finite());
    }

    #[test]
    fn markov_parameters_begin_with_the_feedthrough() {
        // (2 s + 3) / (4 s + 5) = 0.5 + 0.125 / s - 0.15625 / s^2 + ...
        let system = system(&[2.0, 3.0], &[4.0, 5.0]);
        assert_eq!(system.markov_parameters(3), vec![0.5, 0.125, -0.15625]);
        assert_eq!(system.markov_parameters(0), Vec::<f64>::new());
    }

    #[test]
    fn a_gain_has_no_states() {
        let model = system(&[3.0], &[2.0]).to_state_space();
        assert_eq!((model.states(), model.d().data()), (0, &[1.5][..]));
        assert_eq!((model.b().rows(), model.c().columns()), (0, 0));
    }

    #[test]
    fn the_observability_form_is_the_one_in_the_equations() {
        let model = system(&[5.0, 6.0], &[1.0, 2.0, 3.0, 4.0]).to_state_space();
        let expected = Matrix::from_rows(&[[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-4.0, -3.0, -2.0]]);
        assert_eq!(expected, Ok(model.a().clone()));
        // h1 = 0, h2 = 5, h3 = 6 - 2 * 5.
        assert_eq!(model.b().data(), [0.0, 5.0, -4.0]);
        assert_eq!((model.c().data(), model.d().data()), (&[1.0, 0.0, 0.0][..], &[0.0][..]));
    }

    /// C (s I - A)^-1 B + D at a real frequency.
    fn response(model: &StateSpace, s: f64) -> Result<f64, LtiError> {
        let resolvent = Matrix::identity(model.states()).scaled(s).sum(&model.a().scaled(-1.0))?;
        let value = model.c().product(&resolvent.solve(model.b())?)?.sum(model.d())?;
        Ok(value.at(0, 0))
    }

    fn coefficients(count: core::ops::Range<usize>) -> impl Strategy<Value = Vec<f64>> {
        prop::collection::vec(0.1..5.0_f64, count)
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            failure_persistence: None,
            rng_seed: RngSeed::Fixed(2026),
            ..ProptestConfig::default()
        })]

        #[test]
        fn the_state_space_form_responds_as_the_transfer_function(
            numerator in coefficients(1..4), denominator in coefficients(4..7), s in 0.1..10.0_f64
        ) {
            // Positive coefficients have no positive root, so a positive s is no pole.
            let plant = system(&numerator, &denominator);
            let (expected, found) = (plant.at(Complex::new(s, 0.0)).re, response(&plant.to_state_space(), s)?);
            prop_assert!((found - expected).abs() < 1e-9 * expected, "{found} {expected}");
        }

        #[test]
        fn a_series_connection_multiplies_responses_and_collects_poles(
            first in coefficients(2..5), second in coefficients(2..5), frequency_rad_s in 0.01..100.0_f64
        ) {
            let (left, right) = (system(&[1.0], &first), system(&[2.0], &second).negated());
            let both = left.series(&right)?;
            let s = Complex::new(0.0, frequency_rad_s);
            let (found, expected) = (both.at(s), left.at(s) * right.at(s));
            prop_assert!(modulus(found - expected) < 1e-12 * modulus(expected) + 1e-15, "{found} {expected}");
            prop_assert_eq!(both.poles()?.len(), first.len() + second.len() - 2);
            prop_assert_eq!(both.relative_degree(), first.len() + second.len() - 2);
        }
    }
}
