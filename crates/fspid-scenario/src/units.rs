//! Degrees, feet and pounds for files and people; inside everything is SI and radians.

/// Metres in a foot, by definition.
pub const FOOT_M: f64 = 0.3048;

/// Metres a second in a knot: a nautical mile of 1852 m an hour.
pub const KNOT_M_S: f64 = 1852.0 / 3600.0;

/// Newtons in a pound of force: 0.45359237 kg under 9.80665 m/s².
pub const POUND_FORCE_N: f64 = 4.448_221_615_260_5;

/// Kilograms in a pound, by definition.
pub const POUND_KG: f64 = 0.453_592_37;

/// Kilograms in a slug: what a pound of force accelerates by a foot per second squared.
pub const SLUG_KG: f64 = POUND_FORCE_N / FOOT_M;

/// Radians as degrees.
#[must_use]
pub fn degrees(radians: f64) -> f64 {
    radians * (180.0 / std::f64::consts::PI)
}

/// Degrees as radians.
#[must_use]
pub fn radians(degrees: f64) -> f64 {
    degrees * (std::f64::consts::PI / 180.0)
}
