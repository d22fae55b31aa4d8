//! How far a sampled loop is from its limit of stability.

use core::f64::consts::{PI, TAU};

use super::bracket::{Bracket, Proof};
use super::crossings::unit_gain_angles;
use super::squares::Squares;
use super::{DiskMargin, GainLimit, Peak, SampledLoop, phase_rad, poles};
use crate::complex::{Complex, modulus};
use crate::error::LtiError;

/// A frequency at which the gain of a sampled loop is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampledCrossover {
    /// Frequency.
    pub omega_rad_s: f64,
    /// Distance of the phase from ±π in rad, between −π and π; positive if lag is missing to an oscillation.
    pub phase_margin_rad: f64,
    /// Dead time in s that would bring the phase to −π here, as a lag $\omega \tau$ ahead of the sampler.
    pub delay_s: f64,
}

/// Stability of a sampled loop, as far as it is known.
#[derive(Debug, Clone, PartialEq)]
pub enum Stability {
    /// All closed-loop poles lie within the unit circle.
    Stable(Box<SampledMargins>),
    /// Some do not: there are no margins.
    Unstable {
        /// Closed-loop poles with a modulus of $1 - 10^{-9}$ or more.
        poles: Vec<Complex>,
        /// Largest modulus of a closed-loop pole.
        spectral_radius: f64,
    },
}

/// Margins of a stable sampled loop with negative feedback.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledMargins {
    /// The factor below 1 at which the loop becomes unstable; `None` if none down to 10⁻⁶ does.
    pub gain_low: Option<GainLimit>,
    /// The factor above 1 at which the loop becomes unstable; `None` if none up to 10⁶ does.
    pub gain_high: Option<GainLimit>,
    /// Where the gain is 1, by rising frequency.
    pub crossovers: Vec<SampledCrossover>,
    /// The crossover nearest to an oscillation; `None` if the gain is nowhere 1.
    pub phase_margin: Option<SampledCrossover>,
    /// Smallest dead time that makes the loop unstable; `None` if the gain is nowhere 1, and below 1 at Nyquist's frequency.
    ///
    /// $$ \tau = \min \frac{\varphi_m \bmod 2 \pi}{\omega} $$
    ///
    /// A dead time τ ahead of the sampler is taken for the factor $e^{-j \omega \tau}$ on L. Where the gain at Nyquist's
    /// frequency is below 1 that is exact for whole samples, and between them as good as the signal is free of frequencies
    /// beyond Nyquist's. A sample of delay turns the sign of L there: with a gain of 1 or more the loop is unstable with it,
    /// and this is at most the part of a sample that it bears, with what is late taken on a straight line between two samples.
    pub delay_margin_s: Option<f64>,
    /// Largest sensitivity $M_s$.
    pub sensitivity_peak: Peak,
    /// Largest complementary sensitivity $M_t$.
    pub complementary_peak: Peak,
    /// Smallest distance of L from −1, $1 / M_s$.
    pub modulus_margin: f64,
    /// Disk margin of skew 0.
    pub disk: DiskMargin,
    /// What is proved of the two peaks and the disk. Where an upper and a lower end do not meet, the answers above are
    /// the worse ones.
    pub proved: Proved,
    /// Largest modulus of a closed-loop pole.
    pub spectral_radius: f64,
}

/// Proved bounds on the peaks of a stable loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proved {
    /// Of the largest sensitivity.
    pub sensitivity: Bracket,
    /// Of the largest complementary sensitivity.
    pub complementary: Bracket,
    /// Of the size of the disk of skew 0.
    pub disk: Bracket,
}

impl Proved {
    pub(super) fn nothing() -> Self {
        let unknown = Bracket::unknown();
        Self { sensitivity: unknown, complementary: unknown, disk: unknown }
    }

    /// Whether each bracket is tight.
    #[must_use]
    pub fn is_tight(&self) -> bool {
        [self.sensitivity, self.complementary, self.disk].iter().all(Bracket::is_tight)
    }
}

impl SampledLoop {
    /// Margins of the loop closed with negative feedback, or the poles for which there are none.
    ///
    /// A spectral radius of $1 - 10^{-9}$ or more counts as unstable, and so does one that is NaN. Limits of the gain
    /// are the factors $-1/L$ at frequencies where L is real; each is confirmed by the eigenvalues of the closed loop
    /// beside it, so that poles which touch the unit circle and turn back make no limit.
    ///
    /// # Errors
    /// Poles that rounding may carry across the unit circle, as in states that are nearly dependent; eigenvalues that
    /// do not converge; peaks that nothing bounds, as in loops of many hundred states.
    pub fn margins(&self) -> Result<Stability, LtiError> {
        let (poles, spectral_radius, stable) = self.verdict()?;
        if !stable {
            let outside = |pole: &Complex| !(modulus(*pole) < poles::STABLE_BELOW);
            let poles = poles.into_iter().filter(outside).collect();
            return Ok(Stability::Unstable { poles, spectral_radius });
        }
        let (squares, proof) = (Squares::new(&self.reduced)?, self.proof());
        let [gain_low, gain_high] = self.gain_limits(&squares, proof.as_ref())?;
        let crossovers = self.crossovers(&squares, proof.as_ref())?;
        let delay_margin_s = self.delay_limit_s(&crossovers, proof.as_ref())?;
        let search = self.search_with(&poles, proof)?;
        let (sensitivity_peak, sensitivity) = search.peak(1.0)?;
        let (complementary_peak, complementary) = search.peak(0.0)?;
        let (disk, disk_proved) = search.disk(0.0)?;
        Ok(Stability::Stable(Box::new(SampledMargins {
            gain_low,
            gain_high,
            phase_margin: nearest(&crossovers),
            delay_margin_s,
            crossovers,
            sensitivity_peak,
            complementary_peak,
            modulus_margin: 1.0 / sensitivity_peak.value,
            disk,
            proved: Proved { sensitivity, complementary, disk: disk_proved },
            spectral_radius,
        })))
    }

    fn crossovers(
        &self,
        squares: &Squares<'_>,
        proof: Option<&Proof>,
    ) -> Result<Vec<SampledCrossover>, LtiError> {
        let crossover = |omega_rad_s: f64| {
            let value = self.proved_response(omega_rad_s * self.dt_s(), proof).open();
            let margin = libm::remainder(phase_rad(value) + PI, TAU);
            let lag = if margin < 0.0 { margin + TAU } else { margin };
            SampledCrossover { omega_rad_s, phase_margin_rad: margin, delay_s: lag / omega_rad_s }
        };
        let angles = unit_gain_angles(&self.reduced, squares, proof)?;
        Ok(self.frequencies(angles).into_iter().map(crossover).collect())
    }

    /// Bandwidth in rad/s: where $|T|$ first falls 3 dB below its value at rest; `None` if it does not, if it is 0 at
    /// rest, or if the closed loop is not stable.
    ///
    /// 3 dB is the factor $10^{-3/20}$, 0.70795.
    #[must_use]
    pub fn bandwidth_rad_s(&self) -> Option<f64> {
        let (_, _, stable) = self.verdict().ok()?;
        if !stable {
            return None;
        }
        let at_rest = modulus(self.response(0.0).closed());
        let level = at_rest * libm::pow(10.0, -3.0 / 20.0);
        let closed =
            Self::new(self.closed_matrix(), self.b.clone(), self.c.clone(), self.dt_s).ok()?;
        closed.gain_crossings(level).ok()?.first().copied()
    }
}

/// The crossover with the smallest phase margin to either side.
pub(super) fn nearest(crossovers: &[SampledCrossover]) -> Option<SampledCrossover> {
    let size = |at: &SampledCrossover| at.phase_margin_rad.abs();
    crossovers.iter().copied().min_by(|left, right| size(left).total_cmp(&size(right)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_nothing_is_known_of_is_not_tight() {
        let tight = Bracket { at_least: 2.0, at_most: 2.0 };
        let all = Proved { sensitivity: tight, complementary: tight, disk: tight };
        assert!(all.is_tight() && !Proved::nothing().is_tight());
        let unknown = Bracket::unknown();
        for one in [
            Proved { sensitivity: unknown, ..all },
            Proved { complementary: unknown, ..all },
            Proved { disk: unknown, ..all },
        ] {
            assert!(!one.is_tight());
        }
    }
}
