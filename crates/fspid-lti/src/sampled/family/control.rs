//! Controllers whose gains are factors.

use crate::complex::Complex;
use crate::error::LtiError;

/// A sampled controller that is linear in its gains, as a series of real poles.
///
/// $$ C(z) = \sum_i k_i \left( a_{i0} + \frac{a_{i1}}{\zeta - \rho_1} +
/// \frac{a_{i2}}{(\zeta - \rho_1)(\zeta - \rho_2)} + \dots \right), \quad \zeta = z - 1 $$
///
/// # Example
/// PID control with the period T, $k_p + k_i T z/(z - 1) + k_d (z - 1)/(T z)$. The pole of the derivative comes first:
/// behind the integral's the small difference would be one of large numbers.
/// ```
/// use fspid_lti::SeriesControl;
///
/// let (t, pole) = (0.01, -1.0);
/// let by_gain = vec![vec![1.0], vec![t, t, -pole * t], vec![1.0 / t, pole / t]];
/// assert!(SeriesControl::new(vec![pole, 0.0], by_gain).is_ok());
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SeriesControl {
    poles: Vec<f64>,
    by_gain: Vec<Vec<f64>>,
}

impl SeriesControl {
    /// A controller of the places ρ of its poles less 1, and for each gain its coefficients; those left away are 0.
    ///
    /// # Errors
    /// A number that is not finite; more coefficients than poles and one.
    pub fn new(poles: Vec<f64>, mut by_gain: Vec<Vec<f64>>) -> Result<Self, LtiError> {
        const WHAT: &str = "coefficients of a gain";
        LtiError::unless_finite("poles of the controller", &poles)?;
        let count = poles.len() + 1;
        for coefficients in &mut by_gain {
            LtiError::unless_finite(WHAT, coefficients)?;
            if coefficients.len() > count {
                let (found, allowed) = ((coefficients.len(), 1), (count, 1));
                return Err(LtiError::Shape { what: WHAT, found, allowed });
            }
            coefficients.resize(count, 0.0);
        }
        Ok(Self { poles, by_gain })
    }

    pub(super) fn poles(&self) -> &[f64] {
        &self.poles
    }

    pub(super) fn gains(&self) -> usize {
        self.by_gain.len()
    }

    /// The coefficients of one gain alone.
    pub(super) fn of_gain(&self, gain: usize) -> &[f64] {
        &self.by_gain[gain]
    }

    /// The coefficients with these gains.
    pub(super) fn coefficients(&self, gains: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.poles.len() + 1];
        for (gain, own) in gains.iter().zip(&self.by_gain) {
            for (sum, value) in sum.iter_mut().zip(own) {
                *sum += gain * value;
            }
        }
        sum
    }

    /// Product of the distances from the poles.
    pub(super) fn denominator(&self, zeta: Complex) -> Complex {
        self.poles.iter().fold(Complex::new(1.0, 0.0), |product, pole| product * (zeta - pole))
    }

    /// Numerator with some coefficients, and denominator.
    pub(super) fn at(&self, coefficients: &[f64], zeta: Complex) -> (Complex, Complex) {
        let mut over = Complex::new(coefficients[0], 0.0);
        let mut under = Complex::new(1.0, 0.0);
        for (pole, coefficient) in self.poles.iter().zip(&coefficients[1..]) {
            let distance = zeta - pole;
            over = over * distance + coefficient;
            under *= distance;
        }
        (over, under)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::complex::modulus;

    #[test]
    fn a_series_of_poles_is_the_controller_that_it_was_made_from() {
        let (t, filter) = (0.02, 0.05);
        let pole = -t / (t + filter);
        // The derivative's gain 1/(Tf + T) is −ρ/T.
        let by_gain = vec![vec![1.0], vec![t, t, -pole * t], vec![-pole / t, -pole * pole / t]];
        let control = SeriesControl::new(vec![pole, 0.0], by_gain).expect("a controller");
        let gains = [0.8, 0.3, 0.1];
        for zeta in [Complex::new(-1e-6, 2e-3), Complex::new(-1.2, 0.7)] {
            let z = zeta + 1.0;
            let expected =
                gains[0] + gains[1] * t * z / zeta + gains[2] * zeta / (z * (t + filter) - filter);
            let (over, under) = control.at(&control.coefficients(&gains), zeta);
            assert!(modulus(over / under - expected) < 1e-13 * modulus(expected), "{zeta}");
        }
    }

    #[test]
    fn coefficients_without_a_pole_and_numbers_without_end_are_refused() {
        assert!(SeriesControl::new(vec![0.0], vec![vec![1.0, 2.0, 3.0]]).is_err());
        assert!(SeriesControl::new(vec![f64::NAN], vec![]).is_err());
        assert!(SeriesControl::new(vec![0.0], vec![vec![f64::INFINITY]]).is_err());
    }
}
