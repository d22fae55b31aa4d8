//! The air that an aircraft meets on its own way.

use fspid_aircraft::{AirMotion, Vector3};

use crate::air::{self, Dryden, Place, Wind};
use crate::error::{SimError, finite};
use crate::surroundings::Weather;
use crate::timing::Timing;

/// Winds and gusts by place, and turbulence by sample.
#[derive(Clone, Debug, Default)]
pub(super) struct Atmosphere {
    winds: Vec<Wind>,
    /// One a sample; empty without turbulence.
    turbulence: Vec<air::AirMotion>,
    start_m: [f64; 2],
    heading_rad: f64,
    ground_altitude_m: f64,
}

impl Atmosphere {
    /// The weather around an aircraft that starts at an altitude; calm air, heading north, without.
    pub(super) fn new(
        weather: Option<&Weather>,
        altitude_m: f64,
        timing: Timing,
    ) -> Result<Self, SimError> {
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
            turbulence: turbulence(weather, timing)?,
            start_m: course.start_m,
            heading_rad: course.heading_rad,
            ground_altitude_m: altitude_m - course.height_m,
        })
    }

    /// Start, m north and m east of the origin, and heading, rad.
    pub(super) fn start(&self) -> ([f64; 2], f64) {
        (self.start_m, self.heading_rad)
    }

    pub(super) fn ground_altitude_m(&self) -> f64 {
        self.ground_altitude_m
    }

    /// Winds and gusts at a place.
    pub(super) fn wind(&self, place: &Place) -> AirMotion {
        motion(self.winds_at(place))
    }

    /// Winds and gusts at a place with the turbulence of sample `k`.
    pub(super) fn at(&self, place: &Place, k: usize) -> AirMotion {
        let turbulence = self.turbulence.get(k).copied().unwrap_or_default();
        motion(self.winds_at(place) + turbulence)
    }

    fn winds_at(&self, place: &Place) -> air::AirMotion {
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

/// The same for every controller, so that all of them meet the same gusts.
fn turbulence(weather: &Weather, timing: Timing) -> Result<Vec<air::AirMotion>, SimError> {
    let Some(turbulence) = &weather.turbulence else {
        return Ok(Vec::new());
    };
    let dryden = Dryden::new(turbulence, timing.dt_s())?;
    let mut state = dryden.start();
    let sample = |k: usize| {
        if k > 0 {
            dryden.advance(&mut state, k);
        }
        dryden.motion(&state)
    };
    Ok((0..timing.rows()).map(sample).collect())
}
