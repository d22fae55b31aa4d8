//! Wind that grows with height.

use fspid_fuzzy::membership::Param;

use super::{AirMotion, AirPlace, Corners, WindField, first, number, size};
use fspid_numeric::units::FOOT_M;

/// The logarithmic wind profile of the boundary layer.
///
/// $$ u(h) = W_{20} \frac{\ln (h / z_0)}{\ln (20 \text{ ft} / z_0)}, \quad
/// 3 \text{ ft} < h < 1000 \text{ ft} $$
///
/// and outside this layer the value at its nearer edge. The gradient over the aircraft's own size
/// is neglected: no rates.
///
/// # Source
/// MIL-F-8785C, 3.7.3.2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogShear {
    /// Wind speed $W_{20}$ at 20 ft, m/s.
    pub w20_m_s: f64,
    /// Direction that the wind comes from, clockwise from north, rad.
    pub from_rad: f64,
    /// Roughness length $z_0$, m.
    pub roughness_m: f64,
}

/// Edges of the layer, m.
const LOWEST_M: f64 = 3.0 * FOOT_M;
const HIGHEST_M: f64 = 1000.0 * FOOT_M;

impl LogShear {
    /// Roughness length for category C flight phases (take-off, approach, landing): 0.15 ft.
    pub const CATEGORY_C_ROUGHNESS_M: f64 = 0.15 * FOOT_M;
    /// Roughness length for the other flight phases: 2 ft.
    pub const OTHER_ROUGHNESS_M: f64 = 2.0 * FOOT_M;
    /// Largest roughness length that a file may ask for: 3 ft, where the layer begins. The law has no wind at its roughness
    /// length and blows backwards below, and towards 20 ft it has no bound.
    pub const MOST_ROUGHNESS_M: f64 = 0.9144;

    /// Wind speed at a height above the ground, m/s.
    #[must_use]
    pub fn speed_m_s(&self, height_m: f64) -> f64 {
        let height_m = height_m.clamp(LOWEST_M, HIGHEST_M);
        let over_roughness = |h_m: f64| libm::log(h_m / self.roughness_m);
        self.w20_m_s * over_roughness(height_m) / over_roughness(20.0 * FOOT_M)
    }
}

impl WindField for LogShear {
    const NAME: &'static str = "log-shear";
    const PARAMS: &'static [Param] =
        &[size("w20", "m/s"), number("from", "rad"), size("roughness", "m")];
    const EXAMPLE: &'static [f64] = &[8.0, 0.0, Self::CATEGORY_C_ROUGHNESS_M];

    fn from_checked(params: &[f64]) -> Self {
        let [w20_m_s, from_rad, roughness_m] = first(params);
        Self { w20_m_s, from_rad, roughness_m }
    }

    fn at(&self, place: &AirPlace) -> AirMotion {
        let speed_m_s = self.speed_m_s(place.height_m);
        let (east, north) = crate::math::sin_cos(self.from_rad);
        AirMotion {
            earth_m_s: [-speed_m_s * north, -speed_m_s * east, 0.0],
            ..AirMotion::default()
        }
    }

    fn corners(&self) -> Corners {
        Corners { height_m: vec![LOWEST_M, HIGHEST_M], ..Corners::default() }
    }
}
