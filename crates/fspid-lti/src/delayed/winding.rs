//! Winding number of the characteristic function about 0 along a circle.

use core::f64::consts::PI;

use super::characteristic::Characteristic;
use crate::complex::{Complex, modulus};
use crate::error::LtiError;

/// Most arcs that are looked at; a loop with a dead time of 10 000 samples takes some ten thousand.
const MOST_ARCS: usize = 4_000_000;
/// An arc whose values stay within this share of that in its middle has none that is 0, and two that touch turn by less
/// than a right angle from middle to middle.
const NEAR: f64 = 0.5;
/// Rounding of the places of arcs, rad.
const PLACE: f64 = 8.0 * f64::EPSILON;

/// What was counted along a circle.
pub(super) struct Turns {
    /// Zeros of F outside.
    pub(super) outside: usize,
    /// Arcs that were looked at.
    #[cfg_attr(not(test), expect(dead_code, reason = "work is counted by tests"))]
    pub(super) arcs: usize,
    /// Where the arcs were shortest, rad: a zero is near.
    pub(super) nearest_rad: f64,
}

impl Characteristic {
    /// Counts along the upper half of a circle, which the lower half mirrors.
    ///
    /// F is $z^m$ far away and has no pole outside, so that as many of its m turns are missing on the circle as it has
    /// zeros outside (the argument principle). Arcs are halved until F stays nearer to its value in the middle than
    /// half of that: then it cannot have turned unseen, and the sum of all turns is a whole number of half circles.
    ///
    /// # Errors
    /// As [`DelayedLoop::poles_outside`](super::DelayedLoop::poles_outside).
    pub(super) fn turns(&self, radius: f64) -> Result<Turns, LtiError> {
        let mut left = vec![(0.5 * PI, 0.5 * PI)];
        let (mut shifted, mut last, mut first) = (Vec::new(), None, None);
        let (mut turned_rad, mut arcs, mut nearest) = (0.0, 0, (f64::INFINITY, 0.0));
        while let Some((middle_rad, half_rad)) = left.pop() {
            arcs += 1;
            if arcs > MOST_ARCS {
                let what = "count of poles outside a circle";
                return Err(LtiError::NotConverged { what, iterations: MOST_ARCS });
            }
            let at = self.on_arc((radius, middle_rad), half_rad + PLACE, &mut shifted);
            let size = modulus(at.value);
            if !(at.spread <= NEAR * size && size.is_finite()) {
                if half_rad < PLACE {
                    return Err(hidden(radius, at.spread / size));
                }
                let half_rad = 0.5 * half_rad;
                left.push((middle_rad + half_rad, half_rad));
                left.push((middle_rad - half_rad, half_rad));
                continue;
            }
            if half_rad < nearest.0 {
                nearest = (half_rad, middle_rad);
            }
            let direction = at.value / size;
            turned_rad += last.map_or(0.0, |last| turn_rad(last, direction));
            first.get_or_insert(direction);
            last = Some(direction);
        }
        let ends =
            first.zip(last).map_or(0.0, |(first, last)| to_the_axis(last) - to_the_axis(first));
        let half_circles = libm::round((turned_rad + ends) / PI);
        let outside = self.order() as f64 - half_circles;
        // Each arc is proved, so that anything else is a mistake of this program.
        if !(outside >= 0.0 && outside <= (self.order() + self.samples()) as f64) {
            return Err(hidden(radius, f64::INFINITY));
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number that was found to be in range"
        )]
        let outside = outside as usize;
        Ok(Turns { outside, arcs, nearest_rad: nearest.1 })
    }
}

/// A circle on which rounding hides where a pole is.
fn hidden(radius: f64, share: f64) -> LtiError {
    LtiError::Blurred { spectral_radius: radius, share, allowed: NEAR }
}

/// From one direction to another by the shorter way.
fn turn_rad(from: Complex, to: Complex) -> f64 {
    let turn = to * from.conj();
    libm::atan2(turn.im, turn.re)
}

/// From a direction to the nearer end of the real axis, where F is at angles of 0 and π.
fn to_the_axis(direction: Complex) -> f64 {
    turn_rad(direction, Complex::new(if direction.re < 0.0 { -1.0 } else { 1.0 }, 0.0))
}
