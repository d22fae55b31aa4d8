//! The beam that an approach follows.

use super::quantity::Observed;
use crate::error::{SimError, finite, positive};
use crate::math::sin_cos;
use crate::sensor::Sensor;

/// The glide slope of an instrument landing system: a plane that rises from its antenna against the runway's direction.
///
/// The receiver shows the angle by which the aircraft is above it, seen from the antenna; with the range, that is a height:
///
/// $$ \varepsilon = \arctan\frac{h}{d} - \gamma, \qquad \Delta h = R \sin\varepsilon, \quad R = \sqrt{d^2 + h^2} $$
///
/// with the height h above the antenna and the distance d from it along the runway. Behind the antenna there is no beam,
/// and the last height that was shown stays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlideSlope {
    /// Angle of the beam over the horizon, rad.
    pub angle_rad: f64,
    /// The antenna, m north and m east of the origin.
    pub antenna_m: [f64; 2],
    /// Its altitude, m.
    pub altitude_m: f64,
    /// The direction of the landing, clockwise from north, rad.
    pub course_rad: f64,
    /// Errors of the shown angle, rad.
    pub angle_sensor: Option<Sensor>,
    /// Errors of the range, m.
    pub range_sensor: Option<Sensor>,
}

impl GlideSlope {
    /// The same, if its numbers make a beam.
    ///
    /// # Errors
    /// [`SimError::Number`] for an angle that is not above 0 and at most 30 degrees, and for places that are not finite.
    pub fn checked(self) -> Result<Self, SimError> {
        positive("glide slope, rad", self.angle_rad)?;
        if !(self.angle_rad <= MOST_ANGLE_RAD) {
            let (what, allowed) = ("glide slope, rad", "at most 30 deg");
            return Err(SimError::Number { what, found: self.angle_rad, allowed });
        }
        let [north_m, east_m] = self.antenna_m;
        for value in [north_m, east_m, self.altitude_m, self.course_rad] {
            finite("antenna of the glide slope", value)?;
        }
        Ok(self)
    }

    /// Angle above the beam, rad, and range, m, without errors; none behind the antenna.
    pub(crate) fn shown(&self, bearing: &Bearing, observed: &Observed) -> Option<[f64; 2]> {
        let [north_m, east_m] = self.antenna_m;
        let (sine, cosine) = bearing.course_sin_cos;
        let distance_m = (north_m - observed.north_m) * cosine + (east_m - observed.east_m) * sine;
        let height_m = observed.altitude_m - self.altitude_m;
        (distance_m > 0.0).then(|| {
            let angle_rad = libm::atan2(height_m, distance_m) - self.angle_rad;
            [angle_rad, (distance_m * distance_m + height_m * height_m).sqrt()]
        })
    }
}

/// What is asked of a beam at every sample and never changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Bearing {
    course_sin_cos: (f64, f64),
    /// Of its angle.
    pub(crate) tangent: f64,
}

impl Bearing {
    /// Of a beam; nothing without one.
    pub(crate) fn of(beam: Option<&GlideSlope>) -> Self {
        beam.map_or_else(Self::default, |beam| Self {
            course_sin_cos: sin_cos(beam.course_rad),
            tangent: libm::tan(beam.angle_rad),
        })
    }
}

/// Steeper is no approach.
const MOST_ANGLE_RAD: f64 = 30.0 * std::f64::consts::PI / 180.0;

#[cfg(test)]
mod tests {
    use super::*;

    fn beam() -> GlideSlope {
        GlideSlope {
            angle_rad: 3.0_f64.to_radians(),
            antenna_m: [10_000.0, 0.0],
            altitude_m: 100.0,
            course_rad: 0.0,
            angle_sensor: None,
            range_sensor: None,
        }
    }

    fn at(north_m: f64, altitude_m: f64) -> Observed {
        Observed {
            altitude_m,
            vertical_speed_m_s: 0.0,
            ground_speed_m_s: 70.0,
            path_rad: 0.0,
            airspeed_m_s: 70.0,
            path_acceleration_m_s2: 0.0,
            north_m,
            east_m: 0.0,
            heading_rad: 0.0,
        }
    }

    fn shown(observed: &Observed) -> Option<[f64; 2]> {
        beam().shown(&Bearing::of(Some(&beam())), observed)
    }

    /// tan 3 deg · 10 km = 524.08 m above the antenna.
    #[test]
    fn on_the_beam_the_receiver_shows_nothing() {
        let [angle_rad, range_m] = shown(&at(0.0, 624.077_792_8)).expect("before the antenna");
        assert!(angle_rad.abs() < 1e-11, "{angle_rad}");
        assert!((range_m - 10_000.0 / libm::cos(3.0_f64.to_radians())).abs() < 1e-6, "{range_m}");
    }

    #[test]
    fn above_it_is_positive_and_behind_the_antenna_there_is_none() {
        assert!(shown(&at(0.0, 700.0)).is_some_and(|[angle_rad, _]| angle_rad > 0.0));
        assert_eq!(shown(&at(10_000.0, 100.0)), None);
    }

    #[test]
    fn a_beam_that_falls_is_refused() {
        assert!(GlideSlope { angle_rad: -0.05, ..beam() }.checked().is_err());
        assert!(GlideSlope { angle_rad: f64::NAN, ..beam() }.checked().is_err());
        assert!(GlideSlope { antenna_m: [f64::INFINITY, 0.0], ..beam() }.checked().is_err());
    }
}
