//! The quantities that an outer loop can control: altitude, vertical speed, flight path angle, glide slope, airspeed,
//! heading.

use crate::aircraft::AircraftSample;

/// What an autopilot sees of a flight at a sample, without errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Observed {
    pub(crate) altitude_m: f64,
    /// Climbing positive.
    pub(crate) vertical_speed_m_s: f64,
    /// Over the ground.
    pub(crate) ground_speed_m_s: f64,
    /// Angle of the path over the horizon, climbing positive.
    pub(crate) path_rad: f64,
    /// True.
    pub(crate) airspeed_m_s: f64,
    /// Acceleration along the path over the ground, m/s².
    pub(crate) path_acceleration_m_s2: f64,
    pub(crate) north_m: f64,
    pub(crate) east_m: f64,
    /// Clockwise from north, in (−π, π].
    pub(crate) heading_rad: f64,
}

impl From<&AircraftSample> for Observed {
    fn from(sample: &AircraftSample) -> Self {
        let [north_m, east_m] = sample.position_m;
        Self {
            altitude_m: sample.altitude_m,
            vertical_speed_m_s: sample.climb_m_s,
            ground_speed_m_s: sample.ground_speed_m_s,
            path_rad: sample.flight_path_rad,
            airspeed_m_s: sample.airspeed_m_s,
            path_acceleration_m_s2: sample.path_acceleration_m_s2,
            north_m,
            east_m,
            heading_rad: sample.heading_rad,
        }
    }
}

/// A quantity of the flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Altitude, m.
    Altitude,
    /// Vertical speed, climbing positive, m/s.
    VerticalSpeed,
    /// Angle of the path over the ground, climbing positive, rad.
    FlightPath,
    /// True airspeed, m/s.
    Airspeed,
    /// Height above the beam of the glide slope, m.
    GlideSlope,
    /// Heading, clockwise from north, rad.
    Heading,
}

impl Quantity {
    /// All of them, in the order of the columns of a trace.
    pub const ALL: [Self; 6] = [
        Self::Altitude,
        Self::VerticalSpeed,
        Self::FlightPath,
        Self::Airspeed,
        Self::GlideSlope,
        Self::Heading,
    ];

    /// Its name in words.
    #[must_use]
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Altitude => "altitude",
            Self::VerticalSpeed => "vertical speed",
            Self::FlightPath => "flight path",
            Self::Airspeed => "airspeed",
            Self::GlideSlope => "glide slope",
            Self::Heading => "heading",
        }
    }

    /// Its place in [`ALL`](Self::ALL).
    #[must_use]
    pub fn place(self) -> usize {
        self as usize
    }

    /// Its value; `above_beam_m` is what the receiver shows.
    pub(crate) fn value(self, observed: &Observed, above_beam_m: f64) -> f64 {
        match self {
            Self::Altitude => observed.altitude_m,
            Self::VerticalSpeed => observed.vertical_speed_m_s,
            Self::FlightPath => observed.path_rad,
            Self::Airspeed => observed.airspeed_m_s,
            Self::GlideSlope => above_beam_m,
            Self::Heading => observed.heading_rad,
        }
    }

    /// Its rate of change, where the flight shows one; 0 else. `beam_tangent` is that of the angle of the beam.
    pub(crate) fn rate(self, observed: &Observed, beam_tangent: f64) -> f64 {
        match self {
            Self::Altitude => observed.vertical_speed_m_s,
            Self::GlideSlope => {
                observed.vertical_speed_m_s + observed.ground_speed_m_s * beam_tangent
            }
            Self::Airspeed => observed.path_acceleration_m_s2,
            Self::VerticalSpeed | Self::FlightPath | Self::Heading => 0.0,
        }
    }
}
