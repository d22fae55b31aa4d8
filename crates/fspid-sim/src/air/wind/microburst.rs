//! A downburst: air that falls and spreads over the ground.

use fspid_fuzzy::membership::Param;

use super::{AirMotion, AirPlace, Corners, WindField, first, number, size};
use crate::math::exp;

/// An axisymmetric microburst that obeys continuity.
///
/// $$ u_r = \frac{\lambda R^2}{2 r} \left( 1 - e^{-(r/R)^2} \right)
/// \left( e^{-z/z^\ast} - e^{-z/\varepsilon} \right) $$
/// $$ w_{up} = -\lambda e^{-(r/R)^2} \left( \varepsilon ( e^{-z/\varepsilon} - 1 ) -
/// z^\ast ( e^{-z/z^\ast} - 1 ) \right) $$
///
/// with $r$ from the axis and $z$ above the ground. With $z^\ast = 12.5 \varepsilon$ the largest
/// outflow is $0.2357 \lambda R$, at $r = 1.121 R$ and $z = 0.2196 z^\ast$; from it and its height
/// $\lambda$ and $z^\ast$ follow. Gradients over the aircraft's own size are neglected: no rates.
///
/// # Source
/// R. M. Oseguera and R. L. Bowles, A simple, analytic 3-dimensional downburst model based on
/// boundary layer stagnation flow, NASA TM-100632 (1988). Constants re-derived in the tests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microburst {
    /// Largest outflow, m/s.
    pub outflow_m_s: f64,
    /// Radius R of the downdraught, m.
    pub radius_m: f64,
    /// Height of the largest outflow, m.
    pub peak_height_m: f64,
    /// Axis, m north and m east of the origin.
    pub axis_m: [f64; 2],
}

/// $z^\ast / \varepsilon$.
const DEPTH_RATIO: f64 = 12.5;
/// Largest $(1 - e^{-x^2}) / 2x$, at $x$ = 1.120 906 423.
const RADIAL_PEAK: f64 = 0.319_086_343_169_475_74;
/// Height of the largest $e^{-\zeta} - e^{-12.5 \zeta}$: $\zeta = \ln 12.5 / 11.5$.
pub(super) const PEAK_HEIGHT: f64 = 0.219_628_577_765_935_26;
/// Its value there.
const VERTICAL_PEAK: f64 = 0.738_591_572_517_706_4;

impl Microburst {
    /// $\lambda$, 1/s.
    pub(super) fn scale_1_s(&self) -> f64 {
        self.outflow_m_s / (RADIAL_PEAK * VERTICAL_PEAK * self.radius_m)
    }

    /// Outflow away from the axis and updraught, m/s, at a distance from the axis and a height.
    #[must_use]
    pub fn outflow_and_updraught_m_s(&self, distance_m: f64, height_m: f64) -> (f64, f64) {
        let deep_m = self.peak_height_m / PEAK_HEIGHT;
        let shallow_m = deep_m / DEPTH_RATIO;
        let height_m = height_m.max(0.0);
        let (deep, shallow) = (exp(-height_m / deep_m), exp(-height_m / shallow_m));
        let squared = (distance_m / self.radius_m) * (distance_m / self.radius_m);
        let core = exp(-squared);
        // (1 - e^-x²)/2x, which is x/2 on the axis.
        let radial = if squared > 0.0 {
            -libm::expm1(-squared) / (2.0 * distance_m / self.radius_m)
        } else {
            0.0
        };
        let outflow = self.scale_1_s() * self.radius_m * radial * (deep - shallow);
        let depth_m = shallow_m * (shallow - 1.0) - deep_m * (deep - 1.0);
        (outflow, -self.scale_1_s() * core * depth_m)
    }
}

impl WindField for Microburst {
    const NAME: &'static str = "microburst";
    const PARAMS: &'static [Param] = &[
        size("outflow", "m/s"),
        size("radius", "m"),
        size("peak-height", "m"),
        number("axis-north", "m"),
        number("axis-east", "m"),
    ];
    const EXAMPLE: &'static [f64] = &[15.0, 900.0, 40.0, 2000.0, 0.0];

    fn from_checked(params: &[f64]) -> Self {
        let [outflow_m_s, radius_m, peak_height_m, north_m, east_m] = first(params);
        Self { outflow_m_s, radius_m, peak_height_m, axis_m: [north_m, east_m] }
    }

    fn at(&self, place: &AirPlace) -> AirMotion {
        let [axis_north_m, axis_east_m] = self.axis_m;
        let (north_m, east_m) = (place.north_m - axis_north_m, place.east_m - axis_east_m);
        let distance_m = libm::hypot(north_m, east_m);
        let (outflow, updraught) = self.outflow_and_updraught_m_s(distance_m, place.height_m);
        let along =
            |part_m: f64| if distance_m > 0.0 { outflow * part_m / distance_m } else { 0.0 };
        AirMotion { earth_m_s: [along(north_m), along(east_m), -updraught], ..AirMotion::default() }
    }

    fn corners(&self) -> Corners {
        Corners { height_m: vec![0.0], ..Corners::default() }
    }
}
