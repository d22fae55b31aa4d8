//! What a trace says of an aircraft beyond pitch.

use fspid_aircraft::Departure;

use super::changing::Shown;

/// What is observable of an aircraft at a sample, beyond what every plant shows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AircraftSample {
    /// True airspeed, m/s.
    pub airspeed_m_s: f64,
    /// Equivalent airspeed, m/s: that of the same dynamic pressure at sea level.
    pub equivalent_airspeed_m_s: f64,
    /// Mach number.
    pub mach: f64,
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
    /// Forces but for gravity along forward, right, down of the body, in weights: the load factor is the last, turned.
    pub load_factors: [f64; 3],
    /// Velocity of the air along forward, right, down of the body, m/s: wind, gusts, turbulence.
    pub air_m_s: [f64; 3],
    /// Way over ground, m north and m east of the origin of the air.
    pub position_m: [f64; 2],
    /// Heading, rad, clockwise from north within ±π.
    pub heading_rad: f64,
    /// Pitch of the body above the horizon, rad; what the loop sees is its change from the trim.
    pub attitude_rad: f64,
    /// Angle of sideslip, rad, air from the right positive.
    pub sideslip_rad: f64,
    /// Body rates of roll to the right and of yaw to the right, rad/s; that of pitch every plant shows.
    pub roll_yaw_rad_s: [f64; 2],
    /// Throttle, in the measure of the aircraft's data: fraction of full thrust, or multiple of a reference thrust.
    pub throttle: f64,
    /// Angle of the velocity over ground above the horizon, rad: the climb.
    pub flight_path_rad: f64,
    /// Rate of the altitude, m/s.
    pub climb_m_s: f64,
    /// Speed over the ground, along it, m/s.
    pub ground_speed_m_s: f64,
    /// The same to the north and to the east, m/s.
    pub over_ground_m_s: [f64; 2],
    /// Rate of the speed along the path over the ground, m/s².
    pub path_acceleration_m_s2: f64,
    /// Rates of the air about forward, right, down of the body, rad/s: those of gusts and turbulence.
    pub air_rad_s: [f64; 3],
    /// Energy height, m.
    ///
    /// $$ h_e = h + \frac{V^2}{2 g} $$
    ///
    /// with the true airspeed $V$, so that it falls in air which takes airspeed away; over ground the
    /// aircraft has the same with its speed over ground.
    pub energy_height_m: f64,
    /// Angle between the true vertical and that of a pendulum on board, rad: what gyros erect to.
    pub apparent_vertical_rad: f64,
    /// First limit of the model's validity that is left at this sample.
    pub departure: Option<Departure>,
    /// What it shows of its configurations, its fuel and the ground, where any of them varies.
    pub shown: Option<Shown>,
}

/// Names of [`AircraftSample::values`], in order.
pub const AIRCRAFT_COLUMNS: [&str; 23] = [
    "airspeed_m_s",
    "altitude_m",
    "alpha_rad",
    "bank_rad",
    "aileron_rad",
    "load_factor",
    "air_forward_m_s",
    "air_right_m_s",
    "air_down_m_s",
    "north_m",
    "east_m",
    "heading_rad",
    "attitude_rad",
    "sideslip_rad",
    "p_rad_s",
    "r_rad_s",
    "throttle",
    "flight_path_rad",
    "climb_m_s",
    "air_roll_rad_s",
    "air_pitch_rad_s",
    "air_yaw_rad_s",
    "energy_height_m",
];

impl AircraftSample {
    /// False where a number of its columns is none: loads can leave all numbers a sample before the motion does.
    pub(crate) fn is_finite(&self) -> bool {
        self.values().iter().all(|value| value.is_finite())
    }

    /// The numbers in the order of [`AIRCRAFT_COLUMNS`].
    #[must_use]
    pub fn values(&self) -> [f64; AIRCRAFT_COLUMNS.len()] {
        let [forward, right, down] = self.air_m_s;
        let [north_m, east_m] = self.position_m;
        let [p_rad_s, r_rad_s] = self.roll_yaw_rad_s;
        let [air_roll_rad_s, air_pitch_rad_s, air_yaw_rad_s] = self.air_rad_s;
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
            north_m,
            east_m,
            self.heading_rad,
            self.attitude_rad,
            self.sideslip_rad,
            p_rad_s,
            r_rad_s,
            self.throttle,
            self.flight_path_rad,
            self.climb_m_s,
            air_roll_rad_s,
            air_pitch_rad_s,
            air_yaw_rad_s,
            self.energy_height_m,
        ]
    }
}
