//! Sampled loops that differ in their gains alone: margins of many of them in a short time.
//!
//! What does not depend on the gains is found once: a Hessenberg form, and the response of every gain on a grid of
//! frequencies. A loop of the family then costs its closed-loop eigenvalues and a few responses around each crossing
//! and peak. The grid is no proof, as the eigenvalues of [`SampledLoop::margins`] are: for maps of many gains, whose
//! worst is asked again in full.

pub(super) mod bowl;
mod chain;
mod control;
mod grid;
mod member;
mod peaks;
mod place;

use core::f64::consts::{PI, TAU};

use super::late::is_below_one;
use super::{DiskMargin, GainLimit, Peak, Proved, SampledCrossover, SampledLoop, SampledMargins};
use crate::complex::{Complex, modulus, quotient};
use crate::error::LtiError;
use crate::matrix::Matrix;
use chain::Chain;
use grid::Grid;
use member::{Member, Sample};

pub use control::SeriesControl;

/// Sampled loops of one plant with a controller that is linear in some gains, to be closed with negative feedback.
///
/// $$ L(z) = \left( c_0 + C(z; k) c \right) (z I - A)^{-1} b $$
#[derive(Debug, Clone, PartialEq)]
pub struct LoopFamily {
    chain: Chain,
    control: SeriesControl,
    grid: Grid,
    dt_s: f64,
}

/// From this bound of the spectral radius on the quick way leaves the verdict to the careful one. The bound rests on
/// values of the characteristic polynomial whose rounding is some $10^{-15}$ of their terms.
const SURELY_STABLE: f64 = 1.0 - 1e-7;
/// Loops with a closed-loop pole nearer to z = 1, in rad per sample, are left to the careful way, which knows them to more
/// digits.
const SLOW: f64 = 1e-6;
/// Disk margins below this one are left to the careful way.
const SMALL_DISK: f64 = 0.1;
/// Factors that differ by less than this share may be one, or a gap in which the loop is unstable.
const SAME_FACTOR: f64 = 1e-7;
/// As in the careful way.
const FACTOR_MAX: f64 = 1e6;

impl LoopFamily {
    /// Loops of a plant with one input and a sample period: of its outputs the fixed one $c_0$ comes back as it is,
    /// the measured one $c$ through the controller.
    ///
    /// # Errors
    /// As [`SampledLoop::new`]; poles of the plant that are not found.
    pub fn new(
        a: &Matrix,
        b: &[f64],
        [fixed, measured]: [&[f64]; 2],
        control: SeriesControl,
        dt_s: f64,
    ) -> Result<Self, LtiError> {
        for output in [fixed, measured] {
            SampledLoop::require(a, b, output, dt_s)?;
        }
        let chain = Chain::new(a, b, [fixed, measured])?;
        let grid = Grid::new(&chain, &control)?;
        Ok(Self { chain, control, grid, dt_s })
    }

    /// Margins of the loop with these gains, if the quick way is sure of them.
    ///
    /// `None` where it is not, and [`SampledLoop::margins`] has to be asked: a loop that is unstable or nearly so, a
    /// disk margin below 0.1, a gain of 1 or more at half the sample rate, limits of the gain that nearly coincide, gains
    /// that are not finite or of another number, a plant whose numbers over- or underflow, a closed-loop pole within a
    /// millionth of z = 1.
    /// Nothing is proved of the peaks: they are reached, and no point of the grid is higher.
    ///
    /// Poles are eigenvalues, and disks around them that hold all poles lie within the unit circle. Crossings are found
    /// to the last digits between places of a grid that is close where the plant, the controller or the numerator of
    /// the loop turn; peaks also around lightly damped poles of the closed loop.
    #[must_use]
    pub fn margins(&self, gains: &[f64]) -> Option<SampledMargins> {
        let fits = gains.len() == self.control.gains();
        if !(fits && self.chain.is_sound() && gains.iter().all(|gain| gain.is_finite())) {
            return None;
        }
        let member = Member::new(self, gains);
        let poles = member.poles()?;
        let hidden = radius(self.chain.hidden());
        if !(hidden < SURELY_STABLE && member.radius_bound(&poles) < SURELY_STABLE) {
            return None;
        }
        if poles.iter().chain(self.chain.hidden()).any(|&zeta| modulus(zeta) < SLOW) {
            return None;
        }
        let samples = member.samples(&poles);
        let peak = |centre: f64| {
            let (place, value) = peaks::highest(&member, &samples, centre)?;
            Some(Peak { value, omega_rad_s: self.omega_rad_s(place) })
        };
        // A sample of delay turns the sign there, which crossovers do not tell.
        if !is_below_one(modulus(member.at(1.0).open())) {
            return None;
        }
        let disk = peak(0.5)?;
        let disk = DiskMargin::new(1.0 / disk.value, 0.0, disk.omega_rad_s);
        if !(disk.size >= SMALL_DISK) {
            return None;
        }
        let sensitivity_peak = peak(1.0)?;
        let [gain_low, gain_high] = self.gain_limits(&member, &samples)?;
        let crossovers = self.crossovers(&member, &samples);
        Some(SampledMargins {
            gain_low,
            gain_high,
            phase_margin: super::margins::nearest(&crossovers),
            delay_margin_s: crossovers.iter().map(|at| at.delay_s).min_by(f64::total_cmp),
            crossovers,
            sensitivity_peak,
            complementary_peak: peak(0.0)?,
            modulus_margin: 1.0 / sensitivity_peak.value,
            disk,
            proved: Proved::nothing(),
            spectral_radius: radius(&poles).max(hidden),
        })
    }

    /// Value of the loop with these gains at a frequency; infinite or NaN at a pole.
    #[must_use]
    pub fn at(&self, gains: &[f64], omega_rad_s: f64) -> Complex {
        Member::new(self, gains).at(place::of_angle(omega_rad_s * self.dt_s)).open()
    }

    fn omega_rad_s(&self, place: f64) -> f64 {
        place::angle_rad(place) / self.dt_s
    }

    fn crossovers(&self, member: &Member<'_>, samples: &[Sample]) -> Vec<SampledCrossover> {
        let crossover = |place: f64| {
            let omega_rad_s = self.omega_rad_s(place);
            let value = member.at(place).open();
            let margin = libm::remainder(libm::atan2(value.im, value.re) + PI, TAU);
            let lag = if margin < 0.0 { margin + TAU } else { margin };
            SampledCrossover { omega_rad_s, phase_margin_rad: margin, delay_s: lag / omega_rad_s }
        };
        member.unit_gain_places(samples).into_iter().map(crossover).collect()
    }

    /// The nearest factors below and above 1 that bring a pole to the circle.
    ///
    /// A loop that is stable at 1 has no unstable pole up to the first of them, and at it the sign of the imaginary
    /// part changes: one pole or pair crosses.
    fn gain_limits(
        &self,
        member: &Member<'_>,
        samples: &[Sample],
    ) -> Option<[Option<GainLimit>; 2]> {
        let inside = member.real_places(samples);
        let mut candidates = Vec::with_capacity(inside.len() + 2);
        for place in core::iter::once(0.0).chain(inside).chain([1.0]) {
            let response = member.at(place);
            let factor = -quotient(response.under, response.over).re;
            if factor > 1.0 / FACTOR_MAX && factor < FACTOR_MAX {
                candidates.push((factor, place));
            }
        }
        candidates.sort_by(|one, other| one.0.total_cmp(&other.0));
        if candidates.windows(2).any(|pair| pair[1].0 - pair[0].0 < SAME_FACTOR * pair[0].0) {
            return None;
        }
        let limit = |&(factor, place): &(f64, f64)| GainLimit {
            factor,
            omega_rad_s: self.omega_rad_s(place),
        };
        Some([
            candidates.iter().rev().find(|(factor, _)| *factor < 1.0).map(limit),
            candidates.iter().find(|(factor, _)| *factor > 1.0).map(limit),
        ])
    }
}

/// Largest modulus of poles of which 1 is taken away.
fn radius(poles: &[Complex]) -> f64 {
    poles.iter().fold(0.0, |largest, &zeta| f64::max(largest, modulus(zeta + 1.0)))
}
