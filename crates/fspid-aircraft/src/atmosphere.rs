//! The standard atmosphere, and the air an aircraft is flown in.
//!
//! Altitudes are geopotential: over a flat Earth of constant gravity there is no other. [`geopotential_altitude_m`]
//! converts what a radar would measure. Not for days hotter than standard, humidity, or above 84.852 km.

use fspid_numeric::straight;
pub use fspid_numeric::units::STANDARD_GRAVITY_M_S2;

use crate::error::AircraftError;

/// Gas constant of dry air in J/(kg K), as ISO 2533 has it: it makes the density at sea level 1.225 kg/m³.
///
/// The quotient 8314.32/28.9644 of the U.S. standard differs from it in the seventh digit.
pub const GAS_CONSTANT_J_KG_K: f64 = 287.05287;

/// Ratio of the specific heats of air.
pub const HEAT_CAPACITY_RATIO: f64 = 1.4;

/// Lowest geopotential altitude of the standard.
pub const ALTITUDE_MIN_M: f64 = -5_000.0;

/// Highest geopotential altitude of the standard with constant molecular weight.
pub const ALTITUDE_MAX_M: f64 = 84_852.0;

/// Radius in m that the standard uses between geometric and geopotential altitude.
const EARTH_RADIUS_M: f64 = 6_356_766.0;

/// Pressure at sea level in Pa.
pub const SEA_LEVEL_PRESSURE_PA: f64 = 101_325.0;

/// Density of the standard atmosphere at sea level, kg/m³.
pub const SEA_LEVEL_DENSITY_KG_M3: f64 = 1.225;

/// $g_0 / R$, K/m.
pub(crate) const SCALE_K_M: f64 = STANDARD_GRAVITY_M_S2 / GAS_CONSTANT_J_KG_K;

/// Temperature at sea level in K.
const SEA_LEVEL_TEMPERATURE_K: f64 = 288.15;

/// State of the air at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air {
    /// Temperature.
    pub temperature_k: f64,
    /// Static pressure.
    pub pressure_pa: f64,
    /// Density.
    pub density_kg_m3: f64,
    /// Speed of sound.
    pub speed_of_sound_m_s: f64,
}

/// A layer in which temperature changes evenly with altitude.
struct Layer {
    base_m: f64,
    lapse_k_m: f64,
}

/// Layers of the standard from the ground up.
///
/// # Source
/// U.S. Standard Atmosphere 1976, NOAA-S/T 76-1562, table 4.
const LAYERS: [Layer; 7] = [
    Layer { base_m: 0.0, lapse_k_m: -0.0065 },
    Layer { base_m: 11_000.0, lapse_k_m: 0.0 },
    Layer { base_m: 20_000.0, lapse_k_m: 0.001 },
    Layer { base_m: 32_000.0, lapse_k_m: 0.0028 },
    Layer { base_m: 47_000.0, lapse_k_m: 0.0 },
    Layer { base_m: 51_000.0, lapse_k_m: -0.0028 },
    Layer { base_m: 71_000.0, lapse_k_m: -0.002 },
];

impl Air {
    /// Air of temperature and pressure, as an ideal gas.
    ///
    /// $$ \rho = \frac{p}{R T}, \quad a = \sqrt{\gamma R T} $$
    #[must_use]
    pub fn of(temperature_k: f64, pressure_pa: f64) -> Self {
        Self {
            temperature_k,
            pressure_pa,
            density_kg_m3: pressure_pa / (GAS_CONSTANT_J_KG_K * temperature_k),
            speed_of_sound_m_s: (HEAT_CAPACITY_RATIO * GAS_CONSTANT_J_KG_K * temperature_k).sqrt(),
        }
    }

    /// Air of density and speed of sound, as an ideal gas.
    #[must_use]
    pub fn with_density(density_kg_m3: f64, speed_of_sound_m_s: f64) -> Self {
        let square = speed_of_sound_m_s * speed_of_sound_m_s;
        Self {
            temperature_k: square / (HEAT_CAPACITY_RATIO * GAS_CONSTANT_J_KG_K),
            pressure_pa: density_kg_m3 * square / HEAT_CAPACITY_RATIO,
            density_kg_m3,
            speed_of_sound_m_s,
        }
    }

    /// Air of the standard atmosphere at a geopotential altitude.
    ///
    /// $$ T = T_b + L (h - h_b), \quad p = p_b \left(\frac{T_b}{T}\right)^{g_0 / (R L)}
    ///    \ \text{or}\ p_b e^{-g_0 (h - h_b) / (R T_b)} \ \text{where}\ L = 0 $$
    ///
    /// # Source
    /// U.S. Standard Atmosphere 1976, equations 23, 33a and 33b; up to 32 km it is the ISA of ISO 2533.
    ///
    /// # Errors
    /// An altitude below [`ALTITUDE_MIN_M`] or above [`ALTITUDE_MAX_M`].
    pub fn standard(altitude_m: f64) -> Result<Self, AircraftError> {
        let (min, max) = (ALTITUDE_MIN_M, ALTITUDE_MAX_M);
        if min <= altitude_m && altitude_m <= max {
            Ok(Self::in_layers(altitude_m))
        } else {
            Err(AircraftError::Outside { what: "altitude in m", value: altitude_m, min, max })
        }
    }

    fn in_layers(altitude_m: f64) -> Self {
        let mut base =
            Base { temperature_k: SEA_LEVEL_TEMPERATURE_K, pressure_pa: SEA_LEVEL_PRESSURE_PA };
        for (index, layer) in LAYERS.iter().enumerate() {
            match LAYERS.get(index + 1) {
                Some(next) if altitude_m > next.base_m => base = layer.above(base, next.base_m),
                _ => {
                    base = layer.above(base, altitude_m);
                    break;
                }
            }
        }
        Self::of(base.temperature_k, base.pressure_pa)
    }

    /// The air of the lowest layer, by the straight power: the bits of [`standard`](Self::standard) where the answer is true.
    #[inline(always)]
    pub(crate) fn in_lowest_layer(altitude_m: f64) -> (Self, bool) {
        let [lowest, next, ..] = &LAYERS;
        let base =
            Base { temperature_k: SEA_LEVEL_TEMPERATURE_K, pressure_pa: SEA_LEVEL_PRESSURE_PA };
        let (share, power) = lowest.power(base, altitude_m);
        let ratio = straight::pow(share, power);
        let Base { temperature_k, pressure_pa } = lowest.with_ratio(base, altitude_m, ratio);
        let is_here = (altitude_m >= ALTITUDE_MIN_M) & (altitude_m <= next.base_m);
        (Self::of(temperature_k, pressure_pa), is_here & straight::is_straight_pow(share))
    }

    /// Air in which nothing can be computed: every number is NaN.
    pub(crate) const fn unknown() -> Self {
        Self {
            temperature_k: f64::NAN,
            pressure_pa: f64::NAN,
            density_kg_m3: f64::NAN,
            speed_of_sound_m_s: f64::NAN,
        }
    }
}

/// The air at the base of a layer.
#[derive(Clone, Copy)]
struct Base {
    temperature_k: f64,
    pressure_pa: f64,
}

impl Layer {
    /// The air at an altitude, from that at the layer's base.
    fn above(&self, base: Base, altitude_m: f64) -> Base {
        let ratio = if self.lapse_k_m == 0.0 {
            let above_m = altitude_m - self.base_m;
            libm::exp(-SCALE_K_M * above_m / base.temperature_k)
        } else {
            let (share, power) = self.power(base, altitude_m);
            libm::pow(share, power)
        };
        self.with_ratio(base, altitude_m, ratio)
    }

    /// The power that the ratio of the pressures is, where temperature changes.
    #[inline(always)]
    fn power(&self, base: Base, altitude_m: f64) -> (f64, f64) {
        let change_k = self.lapse_k_m * (altitude_m - self.base_m);
        (1.0 + change_k / base.temperature_k, -SCALE_K_M / self.lapse_k_m)
    }

    /// The air at an altitude with this ratio of its pressure to that of the base.
    #[inline(always)]
    fn with_ratio(&self, base: Base, altitude_m: f64, ratio: f64) -> Base {
        let Base { temperature_k, pressure_pa } = base;
        let change_k = self.lapse_k_m * (altitude_m - self.base_m);
        Base { temperature_k: temperature_k + change_k, pressure_pa: pressure_pa * ratio }
    }
}

/// A layer with the air at its base.
pub(crate) struct Stratum {
    pub(crate) base_m: f64,
    pub(crate) lapse_k_m: f64,
    pub(crate) air: Air,
}

impl Stratum {
    /// The layer in which all altitudes between two lie; none where they lie in several, or beyond the standard.
    pub(crate) fn over(lowest_m: f64, highest_m: f64) -> Option<Self> {
        let tops = LAYERS.iter().skip(1).map(|next| next.base_m).chain([ALTITUDE_MAX_M]);
        let mut layers = LAYERS.iter().zip(tops).enumerate();
        let holds = |(index, (layer, top_m)): &(usize, (&Layer, f64))| {
            let bottom_m = if *index == 0 { ALTITUDE_MIN_M } else { layer.base_m };
            bottom_m <= lowest_m && highest_m <= *top_m
        };
        let (_, (layer, _)) = layers.find(holds)?;
        let Layer { base_m, lapse_k_m } = *layer;
        Some(Self { base_m, lapse_k_m, air: Air::in_layers(base_m) })
    }
}

/// Where an aircraft flies: how strong gravity is and what the air is like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Environment {
    /// Gravity, the same everywhere.
    pub gravity_m_s2: f64,
    /// How air depends on altitude.
    pub air: AirModel,
}

/// How air depends on altitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AirModel {
    /// The standard atmosphere.
    Standard,
    /// The same air everywhere, as the equations of textbooks assume.
    Uniform(Air),
}

impl Environment {
    /// Standard gravity and the standard atmosphere.
    pub const STANDARD: Self =
        Self { gravity_m_s2: STANDARD_GRAVITY_M_S2, air: AirModel::Standard };

    /// Gravity, density and speed of sound the same everywhere.
    #[must_use]
    pub fn uniform(gravity_m_s2: f64, density_kg_m3: f64, speed_of_sound_m_s: f64) -> Self {
        let air = Air::with_density(density_kg_m3, speed_of_sound_m_s);
        Self { gravity_m_s2, air: AirModel::Uniform(air) }
    }

    /// True in the standard atmosphere.
    pub(crate) fn is_standard(&self) -> bool {
        self.air == AirModel::Standard
    }

    /// Air at a geopotential altitude; all NaN outside of the standard atmosphere.
    ///
    /// For use within a flight, where an altitude outside has to end the flight and not the program.
    #[must_use]
    pub fn air_at(&self, altitude_m: f64) -> Air {
        match self.air {
            AirModel::Standard => Air::standard(altitude_m).unwrap_or(Air::unknown()),
            AirModel::Uniform(air) => air,
        }
    }
}

/// Geopotential altitude in m of a geometric altitude in m.
///
/// $$ h = \frac{r_0 z}{r_0 + z}, \quad r_0 = 6356766\ \text{m} $$
#[must_use]
pub fn geopotential_altitude_m(geometric_m: f64) -> f64 {
    EARTH_RADIUS_M * geometric_m / (EARTH_RADIUS_M + geometric_m)
}

/// Geometric altitude in m of a geopotential altitude in m: the inverse of [`geopotential_altitude_m`].
#[must_use]
pub fn geometric_altitude_m(geopotential_m: f64) -> f64 {
    EARTH_RADIUS_M * geopotential_m / (EARTH_RADIUS_M - geopotential_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bases_of_layers_have_the_temperatures_of_the_standard() {
        let expected = [
            (0.0, 288.15),
            (11_000.0, 216.65),
            (20_000.0, 216.65),
            (32_000.0, 228.65),
            (47_000.0, 270.65),
            (51_000.0, 270.65),
            (71_000.0, 214.65),
            (84_852.0, 186.946),
        ];
        for (altitude_m, temperature_k) in expected {
            let air = Air::standard(altitude_m).expect("an altitude of the standard");
            assert!((air.temperature_k - temperature_k).abs() < 1e-9, "{altitude_m} m");
        }
    }

    /// The standard prints seven digits; the gas constant moves the seventh, more the higher.
    #[test]
    fn bases_of_layers_have_the_pressures_of_the_standard() {
        let expected = [
            (11_000.0, 22_632.06),
            (20_000.0, 5_474.889),
            (32_000.0, 868.0187),
            (47_000.0, 110.9063),
            (51_000.0, 66.938_87),
            (71_000.0, 3.956_420),
        ];
        for (altitude_m, pressure_pa) in expected {
            let air = Air::standard(altitude_m).expect("an altitude of the standard");
            assert!((air.pressure_pa / pressure_pa - 1.0).abs() < 1e-5, "{}", air.pressure_pa);
        }
    }

    #[test]
    fn nothing_jumps_at_the_edge_of_a_layer() {
        for layer in &LAYERS[1..] {
            let below = Air::standard(layer.base_m - 1e-6).expect("inside");
            let above = Air::standard(layer.base_m + 1e-6).expect("inside");
            assert!((below.density_kg_m3 / above.density_kg_m3 - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn altitudes_outside_are_refused_and_unknown_in_flight() {
        for altitude_m in [-5_000.1, 84_852.1, f64::NAN] {
            assert!(matches!(Air::standard(altitude_m), Err(AircraftError::Outside { .. })));
            assert!(Environment::STANDARD.air_at(altitude_m).density_kg_m3.is_nan());
        }
    }

    #[test]
    fn geometric_and_geopotential_altitude_are_inverse() {
        assert!((geopotential_altitude_m(86_000.0) - 84_852.0).abs() < 0.5);
        for altitude_m in [-4_000.0, 0.0, 11_000.0, 80_000.0] {
            let back = geopotential_altitude_m(geometric_altitude_m(altitude_m));
            assert!((back - altitude_m).abs() < 1e-9);
        }
    }
}
