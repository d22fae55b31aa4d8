//! How late a sampled loop may act whose gain at half the sample rate is 1 or more.

use core::f64::consts::PI;

use super::bracket::Proof;
use super::reduced::Reduced;
use super::squares::Squares;
use super::{SampledCrossover, SampledLoop};
use crate::complex::modulus;
use crate::error::LtiError;
use crate::matrix::Matrix;

/// A gain at half the sample rate that is less than this far below 1 counts as 1.
const NEAR_ONE: f64 = 1e-9;
/// Part of a sample from which on the part is looked for at which poles leave the circle.
const FROM_PART: f64 = 1e-3;

/// Whether a sample of delay changes nothing at half the sample rate but what crossovers tell.
pub(super) fn is_below_one(gain_at_nyquist: f64) -> bool {
    // Written so that NaN is not.
    gain_at_nyquist < 1.0 - NEAR_ONE
}

impl SampledLoop {
    /// Smallest dead time, s, that makes a loop that is stable unstable.
    ///
    /// Crossovers tell it where $|L(-1)| < 1$. A sample of delay turns the sign of L at −1, so that with a gain of 1 or
    /// more there a pole leaves the circle at −1 before the first sample is over, wherever the crossovers are.
    pub(super) fn delay_limit_s(
        &self,
        crossovers: &[SampledCrossover],
        proof: Option<&Proof>,
    ) -> Result<Option<f64>, LtiError> {
        let least_s = crossovers.iter().map(|at| at.delay_s).min_by(f64::total_cmp);
        if is_below_one(modulus(self.proved_response(PI, proof).open())) {
            return Ok(least_s);
        }
        let within_s = self.part_of_a_sample()? * self.dt_s();
        Ok(Some(least_s.map_or(within_s, |least_s| f64::min(least_s, within_s))))
    }

    /// The part of a sample, up to 1, by which what comes late on a straight line between two samples takes poles to the
    /// circle: the limit of the gain of a loop.
    ///
    /// $$ 1 + L (1 - f + f / z) = (1 + L) (1 + f G), \quad G = \frac{L}{1 + L} (1 / z - 1) $$
    fn part_of_a_sample(&self) -> Result<f64, LtiError> {
        let (closed, order) = (self.closed_matrix(), self.order());
        let a = Matrix::from_function(order + 1, order + 1, |row, column| match (row, column) {
            (_, column) if column == order => 0.0,
            (row, column) if row == order => self.c[column],
            (row, column) => closed.at(row, column),
        });
        let b: Vec<f64> = self.b.iter().copied().chain([0.0]).collect();
        let c: Vec<f64> = self.c.iter().map(|c| -c).chain([1.0]).map(|c| FROM_PART * c).collect();
        let reduced = Reduced::new(&a, &b, &c);
        let late = Self { a, b, c, dt_s: self.dt_s, reduced, change: None };
        let [_, high] = late.gain_limits(&Squares::new(&late.reduced)?, None)?;
        Ok(high.map_or(1.0, |limit| f64::min(FROM_PART * limit.factor, 1.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// $L = k / (z + a)$, whose closed loop has its pole at −a − k.
    fn first_order(a: f64, k: f64) -> SampledLoop {
        let a = Matrix::from_rows(&[[-a]]).expect("one entry");
        SampledLoop::new(a, vec![1.0], vec![k], 0.1).expect("a loop")
    }

    #[test]
    fn a_part_of_a_sample_is_borne_until_half_the_sample_rate_turns() {
        // z² + (a + k (1 - f)) z + k f has its pole at -1 where 1 + L(-1) (1 - 2 f) is 0, the other at k f.
        for (a, k) in [(0.5, -1.0), (0.5, -0.6), (0.5, -1.4), (1.0, -1.0), (1.1, -1.3)] {
            let open = first_order(a, k);
            let part = open.part_of_a_sample().expect("eigenvalues converge");
            let expected = 0.5 * (1.0 + (a - 1.0) / k);
            assert!((part - expected).abs() < 1e-9, "{part} {expected}");
            let told_s = open.delay_limit_s(&[], None).expect("eigenvalues converge");
            assert!((told_s.expect("a limit") - 0.1 * expected).abs() < 1e-9, "{told_s:?}");
        }
        assert_eq!(first_order(0.5, -0.49).delay_limit_s(&[], None), Ok(None));
    }
}
