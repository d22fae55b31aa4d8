//! The air that an aircraft meets on its own way.

use fspid_aircraft::{AirMotion, Vector3};

use super::corner::{Corner, Corners};
use crate::air::{self, AirPlace, Shaping, Wind};
use crate::error::{SimError, finite};
use crate::surroundings::Weather;

/// Winds and gusts by place, and turbulence by its own grid of time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Atmosphere {
    winds: Vec<Wind>,
    /// Distances and heights at which winds are not smooth.
    corners: Corners,
    turbulence: Option<Shaping>,
    start_m: [f64; 2],
    heading_rad: f64,
    ground_altitude_m: f64,
}

impl Atmosphere {
    /// The weather around an aircraft that starts at an altitude; calm air, heading north, without.
    pub(crate) fn new(weather: Option<&Weather>, altitude_m: f64) -> Result<Self, SimError> {
        let Some(weather) = weather else {
            return Ok(Self::default());
        };
        let course = weather.course;
        let [north_m, east_m] = course.start_m;
        for value in [course.height_m, course.heading_rad, north_m, east_m] {
            finite("course", value)?;
        }
        Ok(Self {
            winds: weather.winds.clone(),
            corners: Corners::of(&weather.winds),
            turbulence: weather.turbulence.as_ref().map(Shaping::start).transpose()?,
            start_m: course.start_m,
            heading_rad: course.heading_rad,
            ground_altitude_m: altitude_m - course.height_m,
        })
    }

    /// The same with corners of the aircraft's own: times, s, and an altitude, m.
    pub(super) fn with_corners(mut self, times_s: Vec<f64>, altitude_m: Option<f64>) -> Self {
        let height_m = altitude_m.map(|altitude_m| altitude_m - self.ground_altitude_m);
        self.corners = self.corners.with(times_s, height_m);
        self
    }

    /// Start, m north and m east of the origin, and heading, rad.
    pub(super) fn start(&self) -> ([f64; 2], f64) {
        (self.start_m, self.heading_rad)
    }

    pub(super) fn ground_altitude_m(&self) -> f64 {
        self.ground_altitude_m
    }

    /// Winds and gusts at a place.
    pub(crate) fn wind(&self, place: &AirPlace) -> AirMotion {
        motion(self.winds_at(place))
    }

    /// True for air that changes along the way or in time.
    pub(crate) fn moves(&self) -> bool {
        !self.winds.is_empty() || self.turbulence.is_some()
    }

    /// True for air that depends on the place.
    pub(super) fn has_winds(&self) -> bool {
        !self.winds.is_empty()
    }

    /// Winds and gusts at a place with turbulence.
    pub(crate) fn at(&self, place: &AirPlace, turbulence: air::AirMotion) -> AirMotion {
        motion(self.winds_at(place) + turbulence)
    }

    /// The turbulence at the start.
    pub(crate) fn start_turbulence(&self) -> Option<Shaping> {
        self.turbulence.clone()
    }

    /// The first corner of the winds between two places, not counting those at the first.
    pub(super) fn corner(&self, from: &AirPlace, to: &AirPlace) -> Option<Corner> {
        self.corners.first_between(from, to)
    }

    fn winds_at(&self, place: &AirPlace) -> air::AirMotion {
        let motions = self.winds.iter().map(|wind| wind.at(place));
        motions.fold(air::AirMotion::default(), |sum, motion| sum + motion)
    }
}

fn motion(motion: air::AirMotion) -> AirMotion {
    let vector = |[x, y, z]: [f64; 3]| Vector3::new(x, y, z);
    AirMotion {
        wind_ned_m_s: vector(motion.earth_m_s),
        gust_body_m_s: vector(motion.body_m_s),
        gust_rates_rad_s: vector(motion.body_rad_s),
    }
}
