//! The discrete gust of CS 25.341 and 14 CFR 25.341.

use fspid_fuzzy::membership::Param;

use super::one_minus_cosine::{frozen, one_minus_cosine};
use super::{AirMotion, AirPlace, Corners, WindField, first, number, size};
use crate::error::{SimError, finite, positive};
use fspid_numeric::units::FOOT_M;

/// A gust that rises over its gradient distance and falls back over another.
///
/// $$ U(s) = \frac{U_{ds}}{2} \left( 1 - \cos \frac{\pi s}{H} \right) \quad (0 \le s \le 2 H) $$
///
/// and 0 elsewhere, with $s$ the distance flown into the gust. The certification case has H from 30
/// to 350 ft and the velocity of [`design_gust_m_s`], up and down.
///
/// # Source
/// CS 25.341(a), 14 CFR 25.341(a).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FullCycle {
    /// True velocity at the peak along forward, right, down of the body, m/s.
    pub amplitude_m_s: [f64; 3],
    /// Gradient distance H, m: half the length of the gust.
    pub gradient_m: f64,
    /// Distance flown before it begins, m.
    pub start_m: f64,
}

impl WindField for FullCycle {
    const NAME: &'static str = "full-cycle";
    const PARAMS: &'static [Param] = &[
        number("forward", "m/s"),
        number("right", "m/s"),
        number("down", "m/s"),
        size("gradient", "m"),
        number("start", "m"),
    ];
    const EXAMPLE: &'static [f64] = &[0.0, 0.0, -10.0, 60.0, 100.0];

    fn from_checked(params: &[f64]) -> Self {
        let [forward, right, down, gradient_m, start_m] = first(params);
        Self { amplitude_m_s: [forward, right, down], gradient_m, start_m }
    }

    fn at(&self, place: &AirPlace) -> AirMotion {
        let into_m = place.distance_m - self.start_m;
        let inside = (0.0..=2.0 * self.gradient_m).contains(&into_m);
        let shape = if inside { one_minus_cosine(into_m, self.gradient_m) } else { (0.0, 0.0) };
        frozen(self.amplitude_m_s, shape)
    }

    fn corners(&self) -> Corners {
        Corners::along(self.start_m, 2.0 * self.gradient_m)
    }
}

/// Heights, ft, and reference gust velocities, ft/s.
const REFERENCE: [(f64, f64); 3] = [(0.0, 56.0), (15_000.0, 44.0), (60_000.0, 20.86)];

/// Reference gust velocity $U_{ref}$ at a height, m/s of equivalent airspeed: 56 ft/s at sea level,
/// 44 at 15 000 ft, 20.86 at 60 000 ft, in straight lines between and constant outside.
///
/// # Source
/// CS 25.341(a)(5)(i).
#[must_use]
pub fn reference_gust_m_s(height_m: f64) -> f64 {
    FOOT_M * super::super::dryden::interpolated(&REFERENCE, height_m / FOOT_M)
}

/// Design gust velocity $U_{ds}$, m/s of equivalent airspeed.
///
/// $$ U_{ds} = U_{ref} F_g \left( \frac{H}{350 \text{ ft}} \right)^{1/6} $$
///
/// with the flight profile alleviation factor $F_g$. The true velocity that [`FullCycle`] takes is
/// this over the square root of the density ratio.
///
/// # Source
/// CS 25.341(a)(4).
///
/// # Errors
/// [`SimError::Number`] for a height or factor that is not finite, a gradient distance that is not
/// positive.
pub fn design_gust_m_s(height_m: f64, gradient_m: f64, alleviation: f64) -> Result<f64, SimError> {
    let height_m = finite("height, m", height_m)?;
    let share = positive("gradient distance, m", gradient_m)? / (350.0 * FOOT_M);
    let alleviation = finite("flight profile alleviation factor", alleviation)?;
    Ok(reference_gust_m_s(height_m) * alleviation * libm::pow(share, 1.0 / 6.0))
}
