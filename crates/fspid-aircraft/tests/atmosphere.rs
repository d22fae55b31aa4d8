//! The standard atmosphere against the printed table of the handbook.

use fspid_aircraft::Air;

use crate::support;

use support::{FOOT_M, SLUG_KG};

/// Altitude ft, temperature K, pressure Pa, density kg/m³ and slug/ft³, speed of sound ft/s.
const PRINTED: [(f64, f64, f64, f64, f64, f64); 7] = [
    (0.0, 288.15, 101_325.0, 1.225_000, 0.002_376_9, 1116.45),
    (5_000.0, 278.24, 84_307.3, 1.055_546, 0.002_048_1, 1097.09),
    (10_000.0, 268.34, 69_681.6, 0.904_637, 0.001_755_3, 1077.39),
    (20_000.0, 248.53, 46_563.2, 0.652_694, 0.001_266_4, 1036.85),
    (30_000.0, 228.71, 30_089.6, 0.458_312, 0.000_889_3, 994.66),
    (35_000.0, 218.81, 23_842.3, 0.379_597, 0.000_736_5, 972.89),
    (40_000.0, 216.65, 18_753.9, 0.301_558, 0.000_585_1, 968.08),
];

#[test]
fn the_standard_atmosphere_has_the_printed_digits() {
    for (altitude_ft, temperature_k, pressure_pa, density, density_slug, sound_ft_s) in PRINTED {
        let air = Air::standard(altitude_ft * FOOT_M).expect("an altitude of the standard");
        let slug_ft3 = air.density_kg_m3 * FOOT_M * FOOT_M * FOOT_M / SLUG_KG;
        // Half of the last printed digit.
        let rows = [
            (air.temperature_k, temperature_k, 5e-3),
            (air.pressure_pa, pressure_pa, 5e-2),
            (air.density_kg_m3, density, 5e-7),
            (slug_ft3, density_slug, 5e-8),
            (air.speed_of_sound_m_s / FOOT_M, sound_ft_s, 5e-3),
        ];
        for (found, printed, half_digit) in rows {
            assert!(
                (found - printed).abs() <= 1.0001 * half_digit,
                "{altitude_ft} ft: {found} is not {printed}"
            );
        }
    }
}
