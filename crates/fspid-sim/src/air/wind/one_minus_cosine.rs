//! The shape that discrete gusts are made of.

use super::AirMotion;

/// A cosine edge that rises from 0 to 1 over `length_m`, and its slope, 1/m.
///
/// $$ f(x) = \frac12 \left( 1 - \cos \frac{\pi x}{d} \right), \qquad
/// f'(x) = \frac{\pi}{2 d} \sin \frac{\pi x}{d} $$
pub(super) fn one_minus_cosine(into_m: f64, length_m: f64) -> (f64, f64) {
    let per_m = std::f64::consts::PI / length_m;
    let (sine, cosine) = crate::math::sin_cos(per_m * into_m);
    (0.5 * (1.0 - cosine), 0.5 * per_m * sine)
}

/// The motion of a gust along body axes, frozen while the aircraft flies into it.
pub(super) fn frozen(amplitude_m_s: [f64; 3], (share, per_m): (f64, f64)) -> AirMotion {
    let [_, right, down] = amplitude_m_s;
    AirMotion {
        body_m_s: amplitude_m_s.map(|amplitude| amplitude * share),
        body_rad_s: [0.0, -down * per_m, right * per_m],
        ..AirMotion::default()
    }
}
