//! Degrees, feet and pounds for files and people; inside everything is SI and radians.

use core::f64::consts::PI;

/// Metres in a foot, by definition.
pub const FOOT_M: f64 = 0.3048;

/// Metres a second in a knot: a nautical mile of 1852 m an hour.
pub const KNOT_M_S: f64 = 1852.0 / 3600.0;

/// Kilograms in a pound, by definition.
pub const POUND_KG: f64 = 0.453_592_37;

/// Standard gravity, m/s², by definition.
pub const STANDARD_GRAVITY_M_S2: f64 = 9.806_65;

/// Newtons in a pound of force: a pound under standard gravity.
pub const POUND_FORCE_N: f64 = 4.448_221_615_260_5;

/// Kilograms in a slug: what a pound of force accelerates by a foot per second squared.
pub const SLUG_KG: f64 = POUND_FORCE_N / FOOT_M;

/// Radians in a degree.
pub const DEGREE_RAD: f64 = PI / 180.0;

/// Degrees in a radian.
pub const RADIAN_DEG: f64 = 180.0 / PI;

/// Radians as degrees.
#[must_use]
pub const fn degrees(radians: f64) -> f64 {
    radians * RADIAN_DEG
}

/// Degrees as radians.
#[must_use]
pub const fn radians(degrees: f64) -> f64 {
    degrees * DEGREE_RAD
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pound_of_force_is_a_pound_under_standard_gravity() {
        assert!((POUND_KG * STANDARD_GRAVITY_M_S2 / POUND_FORCE_N - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_slug_is_32_174_pounds() {
        assert!((SLUG_KG / POUND_KG - 32.174).abs() < 1e-4);
    }
}
