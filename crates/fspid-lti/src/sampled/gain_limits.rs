//! The factors on the gain between which a stable loop stays stable.

use super::SampledLoop;
use super::quick::quick_eigenvalues;
use super::squares::Squares;
use crate::complex::{Complex, modulus, quotient};
use crate::error::LtiError;

/// Factors are looked for up to this one, 120 dB, and down to its inverse.
const FACTOR_MAX: f64 = 1e6;
/// Factors that differ by less than this share are one: where poles touch the unit circle and turn back, they come in
/// pairs, and nobody lives between them.
const SAME_FACTOR: f64 = 1e-9;
/// Share of the way back from a limit at which the loop must still be stable.
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
    ) -> Result<[Option<GainLimit>; 2], LtiError> {
        let mut candidates = self.gain_candidates(squares)?;
        let above = candidates.iter().copied().filter(|limit| limit.factor > 1.0).collect();
        candidates.retain(|limit| limit.factor < 1.0);
        candidates.reverse();
        Ok([
            self.limit_towards(1.0 / FACTOR_MAX, candidates)?,
            self.limit_towards(FACTOR_MAX, above)?,
        ])
    }

    /// Positive factors that bring a pole to the unit circle, $-1/L$ where L is real, rising.
    fn gain_candidates(&self, squares: &Squares<'_>) -> Result<Vec<GainLimit>, LtiError> {
        let limit = |angle_rad: f64| {
            let response = self.response(angle_rad);
            let factor = -quotient(response.under, response.over).re;
            GainLimit { factor, omega_rad_s: angle_rad / self.dt_s() }
        };
        let mut limits: Vec<GainLimit> =
            self.real_angles(squares)?.into_iter().map(limit).collect();
        limits.retain(|limit| limit.factor > 1.0 / FACTOR_MAX && limit.factor < FACTOR_MAX);
        limits.sort_by(|left, right| left.factor.total_cmp(&right.factor));
        Ok(limits)
    }

    /// The first candidate beyond which the loop is unstable; candidates come in the order of their distance from 1.
    ///
    /// Between two candidates the number of unstable poles does not change, so one factor between them tells it. Should
    /// the poles beside a limit and at the end of the search not agree with the candidates, the poles are believed.
    fn limit_towards(
        &self,
        end: f64,
        candidates: Vec<GainLimit>,
    ) -> Result<Option<GainLimit>, LtiError> {
        let (mut stable, mut rest) = (1.0, candidates.as_slice());
        while let Some(&limit) = rest.first() {
            let one = |other: &&GainLimit| {
                (other.factor - limit.factor).abs() <= SAME_FACTOR * limit.factor
            };
            let (group, others) = rest.split_at(rest.iter().take_while(one).count());
            let next = others.first().map_or(end, |other| other.factor);
            let beyond = (limit.factor * next).sqrt();
            if !self.stable_with(beyond)? {
                let before = limit.factor + BESIDE * (stable - limit.factor);
                if self.stable_with(before)? {
                    let lowest =
                        |a: &&GainLimit, b: &&GainLimit| a.omega_rad_s.total_cmp(&b.omega_rad_s);
                    return Ok(group.iter().min_by(lowest).copied());
                }
                return self.limit_between(stable, before).map(Some);
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
        let outermost = |a: &&Complex, b: &&Complex| modulus(**a).total_cmp(&modulus(**b));
        let angle_rad =
            poles.iter().max_by(outermost).map_or(0.0, |pole| libm::atan2(pole.im.abs(), pole.re));
        Ok(GainLimit { factor: stable, omega_rad_s: angle_rad / self.dt_s() })
    }

    /// Whether all poles lie within the unit circle with a factor on the gain.
    fn stable_with(&self, factor: f64) -> Result<bool, LtiError> {
        let inside = |zeta: &Complex| modulus(zeta + 1.0) < 1.0;
        Ok(quick_eigenvalues(&self.reduced.closed(factor))?.iter().all(inside))
    }
}
