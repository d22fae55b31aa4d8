//! Places on the upper half of the unit circle, from 0 at rest to 1 at Nyquist's frequency.
//!
//! $$ v = \frac{t}{1 + t}, \quad t = \tan \frac{\omega T}{2} $$
//!
//! A place becomes a point by a division alone, and small ones keep all their digits.

use crate::complex::Complex;

/// $z - 1$ at a place.
pub(super) fn zeta(place: f64) -> Complex {
    let rest = 1.0 - place;
    let factor = 2.0 * place / (rest * rest + place * place);
    Complex::new(-factor * place, factor * rest)
}

/// Angle $\omega T$ of a place, in rad.
pub(super) fn angle_rad(place: f64) -> f64 {
    2.0 * libm::atan2(place, 1.0 - place)
}

/// Place of an angle between 0 and π.
pub(super) fn of_angle(angle_rad: f64) -> f64 {
    let (sin, cos) = libm::sincos(0.5 * angle_rad);
    sin / (sin + cos)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::complex::modulus;
    use crate::sampled;

    #[test]
    fn a_place_is_the_point_of_its_angle() {
        for place in [0.0, 1e-12, 1e-3, 0.4, 0.5, 0.9, 1.0] {
            let angle = angle_rad(place);
            let off = modulus(zeta(place) - sampled::zeta(angle));
            assert!(off <= 4.0 * f64::EPSILON * modulus(zeta(place)), "{place}: {off:e}");
            assert!((of_angle(angle) - place).abs() <= 4.0 * f64::EPSILON * place, "{place}");
        }
    }
}
