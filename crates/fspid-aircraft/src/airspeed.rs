//! The airspeeds of a cockpit: Mach number, equivalent and calibrated airspeed, and the way back.

use crate::atmosphere::{Air, SEA_LEVEL_PRESSURE_PA};
use crate::error::AircraftError;

/// Impact pressure over static pressure at Mach 1.
const SONIC_RATIO: f64 = 0.892_929_158_737_854_1;

/// Highest Mach number that calibrated airspeed is inverted to.
const MACH_MAX: f64 = 10.0;

/// Mach number of a true airspeed in m/s.
#[must_use]
pub fn mach(true_m_s: f64, air: &Air) -> f64 {
    true_m_s / air.speed_of_sound_m_s
}

/// Equivalent airspeed in m/s: what would give the same dynamic pressure at sea level.
///
/// $$ V_E = V \sqrt{\rho / \rho_0} $$
#[must_use]
pub fn equivalent_m_s(true_m_s: f64, air: &Air) -> f64 {
    true_m_s * (air.density_kg_m3 / sea_level().density_kg_m3).sqrt()
}

/// True airspeed in m/s of an equivalent airspeed: the inverse of [`equivalent_m_s`].
#[must_use]
pub fn true_of_equivalent_m_s(equivalent_m_s: f64, air: &Air) -> f64 {
    equivalent_m_s * (sea_level().density_kg_m3 / air.density_kg_m3).sqrt()
}

/// Calibrated airspeed in m/s: what would give the same impact pressure at sea level.
///
/// $$ q_c = p_0 \left[ f(V_C / a_0) \right] = p \left[ f(M) \right] $$
/// with f as [`impact_ratio`].
///
/// # Errors
/// A Mach number below 0 or above 10, or air that is not known.
pub fn calibrated_m_s(true_m_s: f64, air: &Air) -> Result<f64, AircraftError> {
    let impact_pa = air.pressure_pa * impact_ratio(mach(true_m_s, air));
    Ok(sea_level().speed_of_sound_m_s * mach_of_ratio(impact_pa / SEA_LEVEL_PRESSURE_PA)?)
}

/// True airspeed in m/s of a calibrated airspeed: the inverse of [`calibrated_m_s`].
///
/// # Errors
/// As [`calibrated_m_s`].
pub fn true_of_calibrated_m_s(calibrated_m_s: f64, air: &Air) -> Result<f64, AircraftError> {
    let ground = sea_level();
    let impact_pa =
        SEA_LEVEL_PRESSURE_PA * impact_ratio(calibrated_m_s / ground.speed_of_sound_m_s);
    Ok(air.speed_of_sound_m_s * mach_of_ratio(impact_pa / air.pressure_pa)?)
}

/// Impact pressure over static pressure at a Mach number.
///
/// $$ f(M) = \left(1 + \tfrac{1}{5} M^2\right)^{7/2} - 1 \ (M \le 1), \quad
///    f(M) = \frac{(6 M^2 / 5)^{7/2}}{\left((7 M^2 - 1)/6\right)^{5/2}} - 1 \ (M > 1) $$
///
/// # Source
/// NACA Report 1135, equations 44 and 100, for a ratio of specific heats of 1.4.
#[must_use]
pub fn impact_ratio(mach: f64) -> f64 {
    let square = mach * mach;
    if mach <= 1.0 {
        libm::expm1(3.5 * libm::log1p(0.2 * square))
    } else {
        libm::pow(1.2 * square, 3.5) / libm::pow((7.0 * square - 1.0) / 6.0, 2.5) - 1.0
    }
}

/// Mach number of a ratio of impact to static pressure.
fn mach_of_ratio(ratio: f64) -> Result<f64, AircraftError> {
    let max = impact_ratio(MACH_MAX);
    if !(0.0 <= ratio && ratio <= max) {
        let what = "ratio of impact to static pressure";
        return Err(AircraftError::Outside { what, value: ratio, min: 0.0, max });
    }
    Ok(if ratio <= SONIC_RATIO { subsonic_mach(ratio) } else { supersonic_mach(ratio) })
}

fn subsonic_mach(ratio: f64) -> f64 {
    (5.0 * libm::expm1(libm::log1p(ratio) / 3.5)).sqrt()
}

/// By bisection down to neighbouring numbers: the ratio rises strictly with the Mach number.
fn supersonic_mach(ratio: f64) -> f64 {
    let (mut low, mut high) = (1.0, MACH_MAX);
    loop {
        let middle = 0.5 * (low + high);
        if !(low < middle && middle < high) {
            return middle;
        }
        if impact_ratio(middle) < ratio { low = middle } else { high = middle }
    }
}

fn sea_level() -> Air {
    Air::of(288.15, SEA_LEVEL_PRESSURE_PA)
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOT_M_S: f64 = 1852.0 / 3600.0;

    fn air(altitude_m: f64) -> Air {
        Air::standard(altitude_m).expect("an altitude of the standard")
    }

    #[test]
    fn at_sea_level_all_airspeeds_are_the_same() {
        let air = air(0.0);
        for true_m_s in [0.0, 1e-3, 50.0, 340.0, 400.0, 900.0] {
            let calibrated_m_s = calibrated_m_s(true_m_s, &air).expect("a flyable speed");
            assert!((calibrated_m_s - true_m_s).abs() <= 1e-12 * true_m_s, "{calibrated_m_s}");
            assert!((equivalent_m_s(true_m_s, &air) - true_m_s).abs() <= 1e-12 * true_m_s);
        }
    }

    /// Worked by hand: f = 0.10360 at 250/661.48, over 0.68770 of the pressure is 0.15065, so Mach 0.4523 at 638.30 kt.
    #[test]
    fn calibrated_250_knots_at_10_000_feet_are_288_7_true() {
        let air = air(3048.0);
        let true_m_s = true_of_calibrated_m_s(250.0 * KNOT_M_S, &air).expect("a flyable speed");
        assert!((true_m_s / KNOT_M_S - 288.7).abs() < 0.05, "{}", true_m_s / KNOT_M_S);
        assert!((mach(true_m_s, &air) - 0.4523).abs() < 1e-4);
    }

    #[test]
    fn going_to_calibrated_and_back_returns_the_true_airspeed() {
        for altitude_m in [0.0, 6_000.0, 12_000.0, 25_000.0] {
            for true_m_s in [10.0, 120.0, 290.0, 500.0, 900.0] {
                let air = air(altitude_m);
                let calibrated_m_s = calibrated_m_s(true_m_s, &air).expect("a flyable speed");
                let back = true_of_calibrated_m_s(calibrated_m_s, &air).expect("a flyable speed");
                assert!((back / true_m_s - 1.0).abs() < 1e-11, "{altitude_m} {true_m_s} {back}");
                let equivalent_m_s = equivalent_m_s(true_m_s, &air);
                let back = true_of_equivalent_m_s(equivalent_m_s, &air);
                assert!((back / true_m_s - 1.0).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn the_two_branches_meet_at_mach_one() {
        assert!((impact_ratio(1.0) - SONIC_RATIO).abs() < 1e-15);
        assert!((impact_ratio(1.0 + 1e-12) - SONIC_RATIO).abs() < 1e-11);
    }

    /// NACA Report 1135, table II: total behind the shock over static pressure 5.640 at Mach 2, 12.06 at Mach 3.
    #[test]
    fn beyond_mach_one_the_shock_is_in_the_impact_pressure() {
        assert!((impact_ratio(2.0) - 4.640).abs() < 5.01e-4, "{}", impact_ratio(2.0));
        assert!((impact_ratio(3.0) - 11.06).abs() < 5.01e-3, "{}", impact_ratio(3.0));
    }

    #[test]
    fn speeds_without_a_calibrated_airspeed_are_refused() {
        assert!(calibrated_m_s(f64::NAN, &air(0.0)).is_err());
        assert!(calibrated_m_s(1e9, &air(0.0)).is_err());
    }
}
