//! The air as an aircraft meets it.

use crate::atmosphere::{Air, SEA_LEVEL_DENSITY_KG_M3};
use crate::vector::Vector3;

/// Motion of the air over the ground and across the aircraft.
///
/// The wind moves the aircraft with it. Gusts in body axes are what turbulence filters and gust shapes deliver; gust
/// rates are the rotation of the air across the aircraft.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct AirMotion {
    /// Velocity of the air over the ground: towards north, east, down.
    pub wind_ned_m_s: Vector3,
    /// Velocity of the gust in body axes: towards forward, right, down.
    pub gust_body_m_s: Vector3,
    /// Rotation of the gust in body axes, with the signs of p, q, r.
    pub gust_rates_rad_s: Vector3,
}

impl AirMotion {
    /// Air at rest.
    pub const STILL: Self = Self {
        wind_ned_m_s: Vector3::ZERO,
        gust_body_m_s: Vector3::ZERO,
        gust_rates_rad_s: Vector3::ZERO,
    };

    /// A steady wind without gusts.
    #[must_use]
    pub const fn wind(wind_ned_m_s: Vector3) -> Self {
        Self { wind_ned_m_s, ..Self::STILL }
    }
}

/// Everything of the air that forces depend on, relative to the aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flow {
    /// Velocity of the aircraft through the air in body axes.
    pub velocity_body_m_s: Vector3,
    /// Rates of the aircraft through the air: body rates less gust rates.
    pub rates_rad_s: Vector3,
    /// True airspeed.
    pub airspeed_m_s: f64,
    /// Angle of attack, air from below positive.
    pub alpha_rad: f64,
    /// Sine and cosine of the angle of attack.
    pub alpha_sin_cos: (f64, f64),
    /// Sideslip, air from the right positive.
    pub beta_rad: f64,
    /// Geopotential altitude.
    pub altitude_m: f64,
    /// The air itself.
    pub air: Air,
}

impl Flow {
    /// Flow at a velocity and rates through the air.
    ///
    /// $$ V = |v|, \quad \alpha = \operatorname{atan2}(w, u), \quad \beta = \operatorname{atan2}(v, \sqrt{u^2 + w^2}) $$
    ///
    /// All angles are 0 at rest.
    #[must_use]
    pub fn new(
        velocity_body_m_s: Vector3,
        rates_rad_s: Vector3,
        altitude_m: f64,
        air: Air,
    ) -> Self {
        let Vector3 { x: u, y: v, z: w } = velocity_body_m_s;
        let alpha_rad = libm::atan2(w, u);
        Self {
            velocity_body_m_s,
            rates_rad_s,
            airspeed_m_s: velocity_body_m_s.norm(),
            alpha_rad,
            alpha_sin_cos: libm::sincos(alpha_rad),
            beta_rad: libm::atan2(v, ahead_m_s(velocity_body_m_s)),
            altitude_m,
            air,
        }
    }

    /// Dynamic pressure.
    ///
    /// $$ \bar q = \tfrac{1}{2} \rho V^2 $$
    #[inline(always)]
    #[must_use]
    pub fn dynamic_pressure_pa(&self) -> f64 {
        0.5 * self.air.density_kg_m3 * self.airspeed_m_s * self.airspeed_m_s
    }

    /// Equivalent airspeed, m/s: that of the same dynamic pressure in the standard's air at sea level.
    ///
    /// $$ V_e = V \sqrt{\rho / \rho_0}, \quad \rho_0 = 1.225\ \mathrm{kg/m^3} $$
    #[must_use]
    pub fn equivalent_airspeed_m_s(&self) -> f64 {
        self.airspeed_m_s * (self.air.density_kg_m3 / SEA_LEVEL_DENSITY_KG_M3).sqrt()
    }

    /// Mach number.
    #[must_use]
    pub fn mach(&self) -> f64 {
        self.airspeed_m_s / self.air.speed_of_sound_m_s
    }

    /// Rate of the angle of attack in rad/s when the velocity through the air changes like this; 0 at rest.
    ///
    /// $$ \dot\alpha = \frac{u \dot w - w \dot u}{u^2 + w^2} $$
    #[inline(always)]
    #[must_use]
    pub fn alpha_rate_rad_s(&self, velocity_rate_body_m_s2: Vector3) -> f64 {
        let Vector3 { x: u, z: w, .. } = self.velocity_body_m_s;
        let square = u * u + w * w;
        let turning = u * velocity_rate_body_m_s2.z - w * velocity_rate_body_m_s2.x;
        if square == 0.0 { 0.0 } else { turning / square }
    }
}

/// Speed in the plane of symmetry, $\sqrt{u^2 + w^2}$.
#[inline(always)]
pub(crate) fn ahead_m_s(velocity_body_m_s: Vector3) -> f64 {
    let Vector3 { x: u, z: w, .. } = velocity_body_m_s;
    (u * u + w * w).sqrt()
}
