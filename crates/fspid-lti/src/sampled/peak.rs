//! The highest points of closed-loop responses, by level sets.

use core::f64::consts::PI;

use super::bracket::{Bracket, Proof};
use super::level_set::Mapped;
use super::{DiskMargin, SampledLoop, poles, scan, zeta};
use crate::complex::{Complex, modulus};
use crate::error::LtiError;

/// How far above a peak, relative to it, no other point may lie.
const ABOVE: f64 = 1e-9;
/// Climbs to higher peaks; each finds one that is higher than all before, and two are rare.
const CLIMBS_MAX: usize = 50;
/// Steps of a search for the top of one peak.
const STEPS_MAX: usize = 80;

/// The largest value of a gain, and where it is reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// The gain.
    pub value: f64,
    /// Its frequency; the lowest, if there are several.
    pub omega_rad_s: f64,
}

impl SampledLoop {
    /// Largest sensitivity $M_s = \max |S|$, $S = 1 / (1 + L)$.
    ///
    /// Found by level sets: from the best of some frequencies to the top of its peak, then to a frequency at which the
    /// gain is higher by $10^{-9}$ of it, until eigenvalues of a Hamiltonian matrix leave no place for one. What comes
    /// of it is then proved or mended: by evaluation from below, and from above by a polynomial that is positive at
    /// every frequency. Where the two do not meet, the answer is the upper end.
    ///
    /// # Source
    /// S. Boyd, V. Balakrishnan, P. Kabamba, A bisection method for computing the H∞ norm of a transfer matrix, Math.
    /// Control Signals Systems 2 (1989) 207; N. A. Bruinsma, M. Steinbuch, A fast algorithm to compute the H∞ norm of a
    /// transfer function matrix, Systems & Control Letters 14 (1990) 287.
    ///
    /// # Errors
    /// A closed loop that is not stable, or of which rounding hides whether it is; eigenvalues that do not converge; a
    /// loop of so many states, of a long dead time for example, that nothing is proved.
    pub fn peak_sensitivity(&self) -> Result<Peak, LtiError> {
        self.search()?.peak(1.0).map(|(peak, _)| peak)
    }

    /// Largest complementary sensitivity $M_t = \max |T|$, $T = L / (1 + L)$, as [`SampledLoop::peak_sensitivity`].
    ///
    /// # Errors
    /// As [`SampledLoop::peak_sensitivity`].
    pub fn peak_complementary(&self) -> Result<Peak, LtiError> {
        self.search()?.peak(0.0).map(|(peak, _)| peak)
    }

    /// Disk margin of a skew.
    ///
    /// # Errors
    /// A skew that is not finite; as [`SampledLoop::peak_sensitivity`].
    pub fn disk_margin(&self, skew: f64) -> Result<DiskMargin, LtiError> {
        LtiError::unless_finite("skew of the disk", &[skew])?;
        self.search()?.disk(skew).map(|(disk, _)| disk)
    }

    /// What a search for peaks needs, for a loop that is stable.
    fn search(&self) -> Result<Search<'_>, LtiError> {
        match self.verdict()? {
            (poles, _, true) => self.search_with(&poles, self.proof()),
            (_, spectral_radius, false) => Err(LtiError::UnstableLoop { spectral_radius }),
        }
    }

    /// The same with the closed poles and the proof that are known already.
    pub(super) fn search_with(
        &self,
        poles: &[Complex],
        proof: Option<Proof>,
    ) -> Result<Search<'_>, LtiError> {
        let maps = Mapped::both(&self.reduced)?;
        Ok(Search { open: self, angles: poles::angles_rad(poles), maps, proof })
    }
}

/// A stable loop whose peaks are looked for.
pub(super) struct Search<'a> {
    open: &'a SampledLoop,
    /// Angles of the closed poles.
    angles: Vec<f64>,
    maps: Vec<Mapped>,
    proof: Option<Proof>,
}

impl Search<'_> {
    pub(super) fn disk(&self, skew: f64) -> Result<(DiskMargin, Bracket), LtiError> {
        // S + (σ − 1)/2 = (1 + σ)/2 − T.
        let (peak, bracket) = self.peak(0.5 * (1.0 + skew))?;
        Ok((DiskMargin::new(1.0 / peak.value, skew, peak.omega_rad_s), bracket.inverse()))
    }

    /// Largest distance of T from a real value, and what is proved of it.
    pub(super) fn peak(&self, centre: f64) -> Result<(Peak, Bracket), LtiError> {
        let found = match self.found(centre) {
            Err(LtiError::NotConverged { .. }) => (0.0, 0.0),
            found => found?,
        };
        let top = self.proof.as_ref().and_then(|proof| proof.top(centre, found));
        let top = top.ok_or(LtiError::Unproved { order: self.open.order() })?;
        let omega_rad_s = top.angle_rad / self.open.dt_s;
        Ok((Peak { value: top.value, omega_rad_s }, top.bracket))
    }

    /// Largest distance of T from a real value as level sets find it, and its angle.
    fn found(&self, centre: f64) -> Result<(f64, f64), LtiError> {
        let mut angles = self.angles.clone();
        let (mut best, mut level) = ((0.0, 0.0), 0.0);
        for _ in 0..CLIMBS_MAX {
            let higher = self.open.highest(centre, &angles);
            if !(higher.1 > level) {
                return Ok((best.1, best.0));
            }
            best = higher;
            level = best.1 * (1.0 + ABOVE);
            angles = Mapped::angles_of_distance(&self.maps, centre, level)?;
        }
        Err(LtiError::NotConverged { what: "peak of a response", iterations: CLIMBS_MAX })
    }
}

impl SampledLoop {
    /// Top of the peak of the best of some angles and the places between them, and its height.
    fn highest(&self, centre: f64, angles: &[f64]) -> (f64, f64) {
        let places = scan::with_middles(angles, (0.0, PI));
        let values: Vec<f64> = places.iter().map(|&place| self.distance(centre, place)).collect();
        let mut best = 0;
        for (index, value) in values.iter().enumerate() {
            if *value > values[best] {
                best = index;
            }
        }
        let start = (places[best], values[best]);
        let (left, right) = (best.saturating_sub(1), (best + 1).min(places.len() - 1));
        let uphill = self.uphill(centre, start.0);
        let limit = if uphill > 0.0 { places[right] } else { places[left] };
        if uphill.abs() > 0.0 { self.climb(centre, start, limit) } else { start }
    }

    /// From a place towards a limit that lies lower, uphill at first: the top of a peak between them, and its height.
    fn climb(&self, centre: f64, start: (f64, f64), limit: f64) -> (f64, f64) {
        let direction = if limit > start.0 { 1.0 } else { -1.0 };
        let slope = |place: f64| direction * self.uphill(centre, place);
        let (mut rising, mut ahead) = (start, limit);
        for _ in 0..STEPS_MAX {
            if slope(ahead) < 0.0 {
                break;
            }
            let middle = 0.5 * (rising.0 + ahead);
            let value = self.distance(centre, middle);
            if value > rising.1 && slope(middle) > 0.0 {
                rising = (middle, value);
            } else {
                ahead = middle;
            }
        }
        let ends = ((rising.0, slope(rising.0)), (ahead, slope(ahead)));
        if !(ends.0.1 > 0.0 && ends.1.1 < 0.0) {
            return rising;
        }
        let (top, _) = scan::root(&slope, ends.0, ends.1);
        let value = self.distance(centre, top);
        if value > rising.1 { (top, value) } else { rising }
    }

    /// Slope of half the squared distance over the angle.
    fn uphill(&self, centre: f64, angle_rad: f64) -> f64 {
        let zeta = zeta(angle_rad);
        let slope = self.reduced.slope_at(zeta);
        // d ζ / d θ = j z.
        let turning = Complex::new(-zeta.im, 1.0 + zeta.re);
        (slope.value.closed_less(centre).conj() * slope.closed() * turning).re
    }

    fn distance(&self, centre: f64, angle_rad: f64) -> f64 {
        modulus(self.response(angle_rad).closed_less(centre))
    }
}
