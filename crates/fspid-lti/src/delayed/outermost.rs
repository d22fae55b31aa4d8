//! The outermost pole of a loop that grows.

use super::characteristic::Characteristic;
use crate::complex::{Complex, modulus};

/// Steps of Newton's method; where it comes near at all it takes a few.
const STEPS: usize = 40;
/// A growth that is known to this share is known.
const SAME: f64 = 1e-9;
/// How near to a pole circles on both sides of it are asked, over its growth.
const BESIDE: f64 = 1e-6;
/// Circles that are asked.
const MOST_CIRCLES: usize = 200;
/// By so much the next larger circle is larger, over the growth.
const WIDER: f64 = 16.0;

impl Characteristic {
    /// Spectral radius, of which it is known that it is beyond `1 + growth`: what is told is confirmed by a count on both
    /// sides of it, or a radius beyond which there are poles for certain.
    pub(super) fn outermost(&self, growth: f64) -> f64 {
        let (mut low, mut high, mut near_rad) = (growth, f64::INFINITY, 0.0);
        for _ in 0..MOST_CIRCLES {
            let middle = match high.is_finite() {
                true => (low * high).sqrt(),
                false => low * WIDER,
            };
            let Ok(turns) = self.turns(1.0 + middle) else { break };
            match turns.outside {
                0 => high = middle,
                _ => (low, near_rad) = (middle, turns.nearest_rad),
            }
            if high <= low * (1.0 + SAME) {
                break;
            }
            if high <= 2.0 * low
                && let Some(found) = self.pole_near(low, near_rad)
                && low <= found
                && found <= high
            {
                match self.beyond(found * (1.0 + BESIDE)) {
                    Some(false) if self.beyond(found * (1.0 - BESIDE)) == Some(true) => {
                        return 1.0 + found;
                    }
                    Some(true) => low = found,
                    _ => {}
                }
            }
        }
        1.0 + low
    }

    /// Whether there are poles beyond a growth; none where that is hidden.
    fn beyond(&self, growth: f64) -> Option<bool> {
        self.turns(1.0 + growth).ok().map(|turns| turns.outside > 0)
    }

    /// Growth of a pole that is found from a place.
    fn pole_near(&self, growth: f64, angle_rad: f64) -> Option<f64> {
        let (sin, cos) = libm::sincos(angle_rad);
        let mut z = Complex::new(cos, sin) * (1.0 + growth);
        for _ in 0..STEPS {
            let next = self.nearer(z);
            let moved = modulus(next - z);
            z = next;
            if moved <= f64::EPSILON * modulus(z) {
                break;
            }
        }
        let found = modulus(z) - 1.0;
        found.is_finite().then_some(found)
    }
}
