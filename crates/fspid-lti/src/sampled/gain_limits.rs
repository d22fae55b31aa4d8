//! The factors on the gain between which a stable loop stays stable.

use core::f64::consts::PI;

use super::bracket::Proof;
use super::quick::quick_eigenvalues;
use super::squares::Squares;
use super::{SampledLoop, poles};
use crate::complex::{Complex, modulus, quotient};
use crate::error::LtiError;

/// Factors are looked for up to this one, 120 dB, and down to its inverse.
const FACTOR_MAX: f64 = 1e6;
/// Factors that differ by less than this share are one: where poles touch the unit circle and turn back, they come in
/// pairs, and nobody lives between them.
const SAME_FACTOR: f64 = 1e-9;
/// Share of the way from a limit to the next factors at which the loop must be stable, and unstable.
const BESIDE: f64 = 1e-6;
/// Halvings of a ratio of factors; from twelve decades fewer are needed.
const HALVINGS: usize = 60;

/// A factor on the gain at which a stable loop becomes unstable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GainLimit {
    /// The factor.
    pub factor: f64,
    /// Frequency of the undamped oscillation there, the lowest if there are several; 0 for a pole at 1, Nyquist's for
    /// one at −1.
    pub omega_rad_s: f64,
}

impl SampledLoop {
    /// The nearest limits below and above 1, for a loop that is stable.
    pub(super) fn gain_limits(
        &self,
        squares: &Squares<'_>,
        proof: Option<&Proof>,
    ) -> Result<[Option<GainLimit>; 2], LtiError> {
        let mut candidates = self.gain_candidates(squares, proof)?;
        let above = candidates.iter().copied().filter(|limit| limit.factor > 1.0).collect();
        candidates.retain(|limit| limit.factor < 1.0);
        candidates.reverse();
        Ok([
            self.limit_towards(1.0 / FACTOR_MAX, candidates, proof)?,
            self.limit_towards(FACTOR_MAX, above, proof)?,
        ])
    }

    /// Positive factors that bring a pole to the unit circle, $-1/L$ where L is real, rising.
    fn gain_candidates(
        &self,
        squares: &Squares<'_>,
        proof: Option<&Proof>,
    ) -> Result<Vec<GainLimit>, LtiError> {
        let limit = |angle_rad: f64| {
            let response = self.proved_response(angle_rad, proof);
            let factor = -quotient(response.under, response.over).re;
            GainLimit { factor, omega_rad_s: angle_rad / self.dt_s() }
        };
        let mut limits: Vec<GainLimit> =
            self.real_angles(squares, proof)?.into_iter().map(limit).collect();
        limits.retain(|limit| limit.factor > 1.0 / FACTOR_MAX && limit.factor < FACTOR_MAX);
        limits.sort_by(|left, right| left.factor.total_cmp(&right.factor));
        Ok(limits)
    }

    /// The first candidate beyond which the loop is unstable; candidates come in the order of their distance from 1.
    ///
    /// Between two candidates the number of unstable poles does not change, so one factor between them tells it. Should
    /// the poles beside a limit and at the end of the search not agree with the candidates, the poles are believed; but
    /// a crossing of the real axis that is proved needs no poles, which are known to less than a millionth of the gain
    /// where they crowd at 1.
    fn limit_towards(
        &self,
        end: f64,
        candidates: Vec<GainLimit>,
        proof: Option<&Proof>,
    ) -> Result<Option<GainLimit>, LtiError> {
        let (mut stable, mut rest) = (1.0, candidates.as_slice());
        while let Some(&limit) = rest.first() {
            let one = |other: &&GainLimit| {
                (other.factor - limit.factor).abs() <= SAME_FACTOR * limit.factor
            };
            let (group, others) = rest.split_at(rest.iter().take_while(one).count());
            let next = others.first().map_or(end, |other| other.factor);
            let beyond = (limit.factor * next).sqrt();
            let crosses = |proof: &Proof| {
                proof.crosses_at(limit.omega_rad_s * self.dt_s()) && group.len() == 1
            };
            if proof.is_some_and(crosses) {
                return Ok(Some(limit));
            }
            if !self.stable_with(beyond)? {
                let beside = |other: f64| limit.factor + BESIDE * (other - limit.factor);
                let (before, after) = (beside(stable), beside(beyond));
                return if !self.stable_with(before)? {
                    self.limit_between(stable, before).map(Some)
                } else if self.stable_with(after)? {
                    self.limit_between(after, beyond).map(Some)
                } else {
                    Ok(group.iter().min_by(|a, b| a.omega_rad_s.total_cmp(&b.omega_rad_s)).copied())
                };
            }
            (stable, rest) = (beyond, others);
        }
        if self.stable_with(end)? { Ok(None) } else { self.limit_between(stable, end).map(Some) }
    }

    /// The last factor that is stable between one that is and one that is not, by halving.
    fn limit_between(&self, mut stable: f64, mut unstable: f64) -> Result<GainLimit, LtiError> {
        for _ in 0..HALVINGS {
            let middle = (stable * unstable).sqrt();
            if self.stable_with(middle)? { stable = middle } else { unstable = middle }
        }
        let poles = self.closed_poles_at(unstable)?;
        let edge = poles::radius(&poles) * (1.0 - SAME_FACTOR);
        let outer: Vec<Complex> = poles.into_iter().filter(|&pole| modulus(pole) >= edge).collect();
        let angle_rad = poles::angles_rad(&outer).into_iter().fold(PI, f64::min);
        Ok(GainLimit { factor: stable, omega_rad_s: angle_rad / self.dt_s() })
    }

    /// Whether all poles lie within the unit circle with a factor on the gain.
    fn stable_with(&self, factor: f64) -> Result<bool, LtiError> {
        let inside = |zeta: &Complex| modulus(zeta + 1.0) < 1.0;
        Ok(quick_eigenvalues(&self.reduced.closed(factor))?.iter().all(inside))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matrix::Matrix;

    /// $L = k / (z^2 - 1/2)$: the poles ±√(1/2 − k) leave the unit circle at k = 3/2, where z² = −1, and at −1/2.
    fn two_poles(k: f64) -> SampledLoop {
        let a = Matrix::from_rows(&[[0.0, 1.0], [0.5, 0.0]]).expect("a matrix");
        SampledLoop::new(a, vec![0.0, 1.0], vec![k, 0.0], 1.0).expect("a loop")
    }

    fn candidate(factor: f64) -> GainLimit {
        GainLimit { factor, omega_rad_s: 0.25 }
    }

    #[test]
    fn a_limit_is_where_the_poles_leave_the_circle() {
        let open = two_poles(0.5);
        let [low, high] = open
            .gain_limits(&Squares::new(&open.reduced).expect("poles"), None)
            .expect("eigenvalues converge");
        let high = high.expect("a limit");
        assert_eq!(low, None);
        assert!((high.factor - 3.0).abs() < 1e-14, "{high:?}");
        assert!((high.omega_rad_s - core::f64::consts::FRAC_PI_2).abs() < 1e-14, "{high:?}");
    }

    #[test]
    fn candidates_beyond_which_the_loop_is_stable_are_no_limits() {
        // As when poles touch the circle and turn back: once alone, once as two crossings a billionth apart.
        let candidates = [1.5, 2.0, 2.0 * (1.0 + 1e-12), 3.0, 8.0].map(candidate).to_vec();
        let found = two_poles(0.5).limit_towards(FACTOR_MAX, candidates, None).expect("converges");
        assert_eq!(found, Some(candidate(3.0)));
    }

    #[test]
    fn of_candidates_at_one_factor_the_lowest_frequency_is_told() {
        let at = |factor: f64, omega_rad_s: f64| GainLimit { factor, omega_rad_s };
        let open = two_poles(0.5);
        // Nearer to each other than a billionth of the factor: one crossing of two pairs of poles.
        let together = vec![at(3.0, 0.5), at(3.0 * (1.0 + 8e-10), 0.25)];
        let found = open.limit_towards(FACTOR_MAX, together.clone(), None).expect("converges");
        assert_eq!(found, Some(together[1]));
        // Three and four are two.
        let found = open.limit_towards(FACTOR_MAX, vec![at(3.0, 0.5), at(4.0, 0.25)], None);
        assert_eq!(found, Ok(Some(at(3.0, 0.5))));
    }

    #[test]
    fn a_candidate_a_little_beside_the_limit_is_not_the_limit() {
        let open = two_poles(0.5);
        for factor in [3.0 - 1e-4, 3.0 + 1e-4] {
            // With another one behind, so that beside is near.
            let candidates = vec![candidate(factor), candidate(3.2)];
            let found = open.limit_towards(FACTOR_MAX, candidates, None);
            let found = found.expect("converges").expect("a limit");
            assert!((found.factor - 3.0).abs() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn frequencies_of_limits_found_by_halving_are_those_of_their_period() {
        let a = Matrix::from_rows(&[[0.0, 1.0], [0.5, 0.0]]).expect("a matrix");
        let open = SampledLoop::new(a, vec![0.0, 1.0], vec![0.5, 0.0], 0.25).expect("a loop");
        let found = open.limit_towards(FACTOR_MAX, vec![], None).expect("converges");
        let omega_rad_s = found.expect("a limit").omega_rad_s;
        assert!((omega_rad_s - 4.0 * core::f64::consts::FRAC_PI_2).abs() < 1e-6, "{omega_rad_s}");
    }

    #[test]
    fn a_limit_that_no_candidate_names_is_found_by_halving() {
        let open = two_poles(0.5);
        for candidates in [vec![], vec![candidate(7.0)], vec![candidate(1.5), candidate(1e3)]] {
            let found = open.limit_towards(FACTOR_MAX, candidates, None).expect("converges");
            let found = found.expect("a limit");
            assert!((found.factor - 3.0).abs() < 1e-12, "{found:?}");
            assert!((found.omega_rad_s - core::f64::consts::FRAC_PI_2).abs() < 1e-6, "{found:?}");
        }
        // The negative of the loop is stable down to −1/2 only: nothing below 1 is a limit, 1 − … above is.
        let open = two_poles(-0.25);
        let found =
            open.limit_towards(FACTOR_MAX, vec![], None).expect("converges").expect("a limit");
        assert!((found.factor - 2.0).abs() < 1e-12 && found.omega_rad_s.abs() < 1e-6, "{found:?}");
        assert_eq!(open.limit_towards(1.0 / FACTOR_MAX, vec![], None), Ok(None));
    }
}
