//! The discrete gust of MIL-F-8785C.

use fspid_fuzzy::membership::Param;

use super::one_minus_cosine::{frozen, one_minus_cosine};
use super::{AirMotion, AirPlace, Corners, WindField, first, number, size};

/// A gust that rises over a length and then stays.
///
/// $$ V(x) = 0 \ (x < 0), \quad \frac{V_m}{2} \left( 1 - \cos \frac{\pi x}{d_m} \right)
/// \ (0 \le x \le d_m), \quad V_m \ (x > d_m) $$
///
/// with $x$ the distance flown into the gust. The length $d_m$ is tuned to excite the short period:
/// half its period times the airspeed.
///
/// # Source
/// MIL-F-8785C, 3.7.1.3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RampHold {
    /// Velocity $V_m$ along forward, right, down of the body, m/s.
    pub amplitude_m_s: [f64; 3],
    /// Length $d_m$, m.
    pub length_m: f64,
    /// Distance flown before it begins, m.
    pub start_m: f64,
}

impl WindField for RampHold {
    const NAME: &'static str = "ramp-hold";
    const PARAMS: &'static [Param] = &[
        number("forward", "m/s"),
        number("right", "m/s"),
        number("down", "m/s"),
        size("length", "m"),
        number("start", "m"),
    ];
    const EXAMPLE: &'static [f64] = &[0.0, 0.0, -3.0, 45.0, 100.0];

    fn from_checked(params: &[f64]) -> Self {
        let [forward, right, down, length_m, start_m] = first(params);
        Self { amplitude_m_s: [forward, right, down], length_m, start_m }
    }

    fn at(&self, place: &AirPlace) -> AirMotion {
        let into_m = place.distance_m - self.start_m;
        let shape = if into_m > self.length_m {
            (1.0, 0.0)
        } else {
            one_minus_cosine(into_m.max(0.0), self.length_m)
        };
        frozen(self.amplitude_m_s, shape)
    }

    fn corners(&self) -> Corners {
        Corners::along(self.start_m, self.length_m)
    }
}
