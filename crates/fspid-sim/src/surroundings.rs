//! The environment of a flight beyond plant and actuator: wind, gusts and turbulence, and sensor models.

use crate::actuated::Held;
use crate::air::{AirMotion, AirPlace, GRID_S, Grid, Shaping, Turbulence, Wind, sum_at};
use crate::error::{SimError, finite, positive};
use crate::math::sin_cos;
use crate::sensor::Sensor;
use crate::timing::Timing;

/// Moving air and sensors; by default none of them, so that the plant flies in calm air and the controller sees pitch
/// and pitch rate as they are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surroundings {
    /// Air that moves. The plant must say how it acts ([`LinearPlant::with_gusts`]).
    ///
    /// [`LinearPlant::with_gusts`]: crate::LinearPlant::with_gusts
    pub weather: Option<Weather>,
    /// What measures the pitch angle.
    pub pitch_sensor: Option<Sensor>,
    /// What measures the pitch rate.
    pub rate_sensor: Option<Sensor>,
}

impl Surroundings {
    /// True where the air is turbulent, or a sensor shows noise or drift.
    pub(crate) fn is_noisy(&self) -> bool {
        let is_turbulent = self.weather.as_ref().is_some_and(|it| it.turbulence.is_some());
        let sensors = self.pitch_sensor.iter().chain(&self.rate_sensor);
        let mut models = sensors.map(Sensor::model);
        is_turbulent || models.any(|it| it.noise_density > 0.0 || it.drift > 0.0)
    }

    /// The same with sensors that show neither noise nor drift from some time on, their bias and scale stay, and with turbulence
    /// that dies away from then on.
    pub(crate) fn silent_from(&self, at_s: f64) -> Self {
        let mut own = self.clone();
        let sensors = own.pitch_sensor.iter_mut().chain(&mut own.rate_sensor);
        sensors.for_each(|sensor| *sensor = sensor.silent_from(at_s));
        if let Some(turbulence) = own.weather.as_mut().and_then(|it| it.turbulence.as_mut()) {
            turbulence.driven_until_s = at_s;
        }
        own
    }
}

/// The path that a linear plant is taken to fly: straight, at constant airspeed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    /// True airspeed, m/s.
    pub airspeed_m_s: f64,
    /// Height above the ground at the start, m.
    pub height_m: f64,
    /// Angle of the path over the horizon, climbing positive, rad.
    pub climb_rad: f64,
    /// Angle over the horizon of the axes that a linear plant has its gusts along, nose up positive, rad: the path's of stability
    /// axes, and the pitch at the trim of axes of the body.
    pub axes_rad: f64,
    /// Heading, clockwise from north, rad.
    pub heading_rad: f64,
    /// Start, m north and m east of the origin.
    pub start_m: [f64; 2],
}

/// The air along a course.
#[derive(Clone, Debug, PartialEq)]
pub struct Weather {
    /// Where the aircraft flies.
    pub course: Course,
    /// Winds and gusts, which add.
    pub winds: Vec<Wind>,
    /// Turbulence.
    pub turbulence: Option<Turbulence>,
}

/// A velocity over ground, north, east and down, along the axes of who flies level on a heading: ahead, to the right, down. That of
/// the opposite heading is its inverse.
pub(crate) fn seen([north, east, down]: [f64; 3], heading_rad: f64) -> [f64; 3] {
    let (sine, cosine) = sin_cos(heading_rad);
    [north * cosine + east * sine, east * cosine - north * sine, down]
}

impl Course {
    /// Where the aircraft is at a time. It drifts with no wind: a linear model has small gusts.
    #[must_use]
    pub fn place(&self, time_s: f64) -> AirPlace {
        let distance_m = self.airspeed_m_s * time_s;
        let (sine, cosine) = sin_cos(self.heading_rad);
        let (up, along) = sin_cos(self.climb_rad);
        let ground_m = distance_m * along;
        let [north_m, east_m] = self.start_m;
        AirPlace {
            time_s,
            distance_m,
            north_m: north_m + ground_m * cosine,
            east_m: east_m + ground_m * sine,
            height_m: self.height_m + distance_m * up,
        }
    }

    /// When it is at a height above the ground, before or after the start; never on a level course.
    pub(crate) fn time_at_height_s(&self, height_m: f64) -> Option<f64> {
        let (up, _) = sin_cos(self.climb_rad);
        let climb_m_s = self.airspeed_m_s * up;
        (climb_m_s != 0.0).then(|| (height_m - self.height_m) / climb_m_s)
    }

    /// The air's velocity along the plant's axes, forward and down, and its pitch rate.
    fn longitudinal(&self, motion: &AirMotion) -> [f64; 3] {
        let ([north, east, earth_down], [forward, _, down]) = (motion.earth_m_s, motion.body_m_s);
        let (sine, cosine) = sin_cos(self.heading_rad);
        let [_, q_rad_s, _] = motion.body_rad_s;
        let (up, along) = sin_cos(self.axes_rad);
        let ahead = north * cosine + east * sine;
        [ahead * along - earth_down * up + forward, ahead * up + earth_down * along + down, q_rad_s]
    }
}

impl Weather {
    /// $u_g, w_g$, m/s, and $q_g$, rad/s, at each sample.
    ///
    /// Winds count from the start: the aircraft is trimmed in the wind that it starts in, and only
    /// what changes along the way disturbs it. Turbulence is there from the start.
    ///
    /// # Errors
    /// [`SimError::Number`] for a course or turbulence out of its range.
    pub fn gusts(&self, timing: Timing) -> Result<Vec<[f64; 3]>, SimError> {
        positive("airspeed, m/s", self.course.airspeed_m_s)?;
        let [north_m, east_m] = self.course.start_m;
        let course = &self.course;
        let angles = [course.climb_rad, course.axes_rad, course.heading_rad];
        for value in angles.into_iter().chain([course.height_m, north_m, east_m]) {
            finite("course", value)?;
        }
        let wind = |k: usize| self.wind_change(timing.time_s(k));
        let mut gusts: Vec<[f64; 3]> = (0..timing.rows()).map(wind).collect();
        if let Some(mut walk) = self.walk()? {
            let grid = Grid::new(timing.dt_s());
            for (k, gust) in gusts.iter_mut().enumerate() {
                let turbulent = walk.at(grid.tick(k));
                gust.iter_mut().zip(turbulent).for_each(|(part, more)| *part += more);
            }
        }
        Ok(gusts)
    }

    /// What the winds have changed since the start.
    pub(crate) fn wind_change(&self, time_s: f64) -> [f64; 3] {
        let (here, at_start) = (self.wind(time_s), self.wind(0.0));
        std::array::from_fn(|part| here[part] - at_start[part])
    }

    /// The turbulence from the start on.
    pub(crate) fn walk(&self) -> Result<Option<TurbulenceWalk>, SimError> {
        let Some(turbulence) = &self.turbulence else {
            return Ok(None);
        };
        Ok(Some(TurbulenceWalk { course: self.course, shaping: Shaping::start(turbulence)? }))
    }

    fn wind(&self, time_s: f64) -> [f64; 3] {
        self.course.longitudinal(&sum_at(&self.winds, &self.course.place(time_s)))
    }
}

/// Turbulence along a course, tick by tick of its grid.
#[derive(Clone, Debug)]
pub(crate) struct TurbulenceWalk {
    course: Course,
    shaping: Shaping,
}

impl TurbulenceWalk {
    /// At a time of the grid that is not before the last one asked for.
    pub(crate) fn at(&mut self, tick: usize) -> [f64; 3] {
        while self.shaping.tick() < tick {
            let time_s = (self.shaping.tick() + 1) as f64 * GRID_S;
            let height_m = self.course.place(time_s).height_m;
            self.shaping.advance(height_m, || self.course.airspeed_m_s);
        }
        self.course.longitudinal(&self.shaping.motion())
    }
}

/// Gusts of every sample, and what the air that changes within each adds to the plant.
type OfAir<'a> = (Option<&'a [[f64; 3]]>, Option<&'a [Vec<f64>]>);

/// What enters the plant at a sample.
pub(crate) fn held<'a>(elevator_rad: f64, (gusts, responses): OfAir<'a>, k: usize) -> Held<'a> {
    let gust = gusts.and_then(|gusts| gusts.get(k)).copied().unwrap_or_default();
    let added = responses.and_then(|responses| responses.get(k)).map(Vec::as_slice);
    Held { elevator_rad, gust, added: added.unwrap_or_default(), ..Held::default() }
}
