//! What a trace says of an aircraft beyond pitch.

use fspid_aircraft::Departure;

/// What is observable of an aircraft at a sample, beyond what every plant shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AircraftSample {
    /// True airspeed, m/s.
    pub airspeed_m_s: f64,
    /// Altitude, m.
    pub altitude_m: f64,
    /// Angle of attack, rad, from the reference of the aircraft's data.
    pub alpha_rad: f64,
    /// Bank, rad.
    pub bank_rad: f64,
    /// Aileron, rad, with the sign of the aircraft's data.
    pub aileron_rad: f64,
    /// Load factor along the body's upward axis: 1 in level flight.
    pub load_factor: f64,
    /// Velocity of the air along forward, right, down of the body, m/s: wind, gusts, turbulence.
    pub air_m_s: [f64; 3],
    /// Angle between the true vertical and that of a pendulum on board, rad: what gyros erect to.
    pub apparent_vertical_rad: f64,
    /// First limit of the model's validity that is left at this sample.
    pub departure: Option<Departure>,
}

/// Names of [`AircraftSample::values`], in order.
pub const AIRCRAFT_COLUMNS: [&str; 9] = [
    "airspeed_m_s",
    "altitude_m",
    "alpha_rad",
    "bank_rad",
    "aileron_rad",
    "load_factor",
    "air_forward_m_s",
    "air_right_m_s",
    "air_down_m_s",
];

impl AircraftSample {
    /// The numbers in the order of [`AIRCRAFT_COLUMNS`].
    #[must_use]
    pub fn values(&self) -> [f64; 9] {
        let [forward, right, down] = self.air_m_s;
        [
            self.airspeed_m_s,
            self.altitude_m,
            self.alpha_rad,
            self.bank_rad,
            self.aileron_rad,
            self.load_factor,
            forward,
            right,
            down,
        ]
    }
}
