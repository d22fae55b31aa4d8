//! Flight code of others in the place of a controller: ArduPilot or PX4, in the loop with an aircraft of ours.
//!
//! What is known of one is who it is, where it is waited for, and which of its channels moves what. Whoever speaks its
//! protocol is not here, as with all [external controllers](crate::external).
//!
//! # What it is told
//! Of an aircraft in six degrees of freedom everything. Of a plant that shows nothing but pitch ([`LevelFlight`] says the
//! rest): it flies straight to the north at its speed and height, wings level, and only its pitch moves, so that what its
//! accelerometers feel is gravity alone. In both, pitch and pitch rate are as controllers see them, through the sensors
//! and disturbances of the scenario; all else is true.

use std::fmt;
use std::net::SocketAddr;

use fspid_aircraft::ForceModel as _;
use fspid_aircraft::atmosphere::STANDARD_GRAVITY_M_S2;
use fspid_core::Sample;

use crate::aircraft::AircraftSample;
use crate::math::sin_cos;
use crate::plant::Plant;
use crate::seen::Seen;

/// Flight code in the loop.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightStack {
    /// What it speaks.
    pub protocol: Protocol,
    /// Where it is waited for.
    pub address: SocketAddr,
    /// The longest time until it comes, s.
    pub connect_limit_s: f64,
    /// Straight flight before the first sample, in which its commands move nothing, s.
    pub lead_in_s: f64,
    /// What moves the elevator.
    pub elevator: ElevatorChannel,
    /// Its channel for the throttle, from 0; without one the throttle stays where it is.
    pub throttle: Option<usize>,
    /// The channel of a remote control on which it is told the set-point; without one it is not told.
    pub setpoint: Option<SetpointChannel>,
    /// Where on Earth the flight is.
    pub place: Place,
    /// What a plant does not show that shows nothing but pitch.
    pub level: Option<LevelFlight>,
}

/// A flight stack and the protocol of its software in the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Protocol {
    /// ArduPilot's backend JSON over UDP.
    ArduPilot {
        /// Pulses at both ends of a channel, µs, the lower one first.
        pulses_us: [f64; 2],
    },
    /// The simulator's side of PX4: MAVLink over TCP, in lockstep.
    Px4,
}

impl Protocol {
    /// What it is called.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::ArduPilot { .. } => "ArduPilot",
            Self::Px4 => "PX4",
        }
    }

    /// How far a channel is along its way: 0 at its lower end, 1 at its upper. None for one that drives nothing: a
    /// pulse of 0, or what is no number.
    #[must_use]
    pub fn fraction(self, value: f64) -> Option<f64> {
        match self {
            Self::ArduPilot { .. } if value == 0.0 => None,
            Self::ArduPilot { pulses_us: [lower, upper] } => {
                Some((value - lower) / (upper - lower))
            }
            Self::Px4 => Some((value + 1.0) / 2.0).filter(|fraction| fraction.is_finite()),
        }
    }

    /// The same of a throttle, which PX4 has from 0 to 1.
    #[must_use]
    pub fn throttle(self, value: f64) -> Option<f64> {
        match self {
            Self::ArduPilot { .. } => self.fraction(value),
            Self::Px4 => Some(value).filter(|fraction| fraction.is_finite()),
        }
    }
}

/// How far a channel turns the elevator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElevatorChannel {
    /// Its number, from 0.
    pub number: usize,
    /// Commands at its lower and at its upper end, nose up positive, from the trim, rad.
    pub command_rad: [f64; 2],
    /// True where its upper end turns the nose down.
    pub is_reversed: bool,
}

impl ElevatorChannel {
    /// The command, rad, at a fraction of the channel's way, and whether the channel is at an end.
    #[must_use]
    pub fn command_rad(&self, fraction: f64) -> (f64, bool) {
        let turned = if self.is_reversed { 1.0 - fraction } else { fraction };
        let [lower_rad, upper_rad] = self.command_rad;
        let is_inside = turned > 0.0 && turned < 1.0;
        (lower_rad + (upper_rad - lower_rad) * turned.clamp(0.0, 1.0), !is_inside)
    }
}

/// How the set-point is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetpointChannel {
    /// Its number, from 0.
    pub number: usize,
    /// Set-points at [`RC_PULSES_US`], rad.
    pub setpoint_rad: [f64; 2],
}

/// Ends of a remote control's channel, µs: 0 % and 100 % of the "standard PPM modulation" that MAVLink's message
/// RC_CHANNELS_OVERRIDE names.
pub const RC_PULSES_US: [f64; 2] = [1000.0, 2000.0];
/// The middle, where all channels stand that nobody moves.
pub const RC_MIDDLE_US: u16 = 1500;

impl SetpointChannel {
    /// The pulse of a set-point, µs, cut at the ends.
    #[must_use]
    pub fn pulse_us(&self, setpoint_rad: f64) -> u16 {
        let [lower_rad, upper_rad] = self.setpoint_rad;
        let [lower_us, upper_us] = RC_PULSES_US;
        let fraction = ((setpoint_rad - lower_rad) / (upper_rad - lower_rad)).clamp(0.0, 1.0);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between the pulses, and the cast of NaN is 0"
        )]
        let pulse_us = (lower_us + (upper_us - lower_us) * fraction).round() as u16;
        pulse_us
    }
}

/// A place on Earth, from which ways over ground are counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Latitude, rad.
    pub latitude_rad: f64,
    /// Longitude, rad.
    pub longitude_rad: f64,
    /// Angle from true to magnetic north, to the east positive, rad.
    pub declination_rad: f64,
}

/// Straight flight of a plant that shows nothing but pitch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelFlight {
    /// True airspeed, m/s, which is also that over ground.
    pub airspeed_m_s: f64,
    /// Altitude above mean sea level, m.
    pub altitude_m: f64,
}

/// What there is to be felt on board at a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aboard {
    /// Bank, pitch and heading, rad.
    pub attitude_rad: [f64; 3],
    /// Body rates of roll, pitch and yaw, rad/s.
    pub rates_rad_s: [f64; 3],
    /// What accelerometers feel along forward, right, down, m/s²: forces but for gravity, over mass.
    pub felt_m_s2: [f64; 3],
    /// North and east of the place, and down from mean sea level, m.
    pub position_m: [f64; 3],
    /// Velocity over ground to the north, the east and down, m/s.
    pub velocity_m_s: [f64; 3],
    /// True airspeed, m/s.
    pub airspeed_m_s: f64,
}

impl Aboard {
    /// Of an aircraft.
    ///
    /// Load factors are turned into accelerations by the standard gravity, whatever that of the aircraft's data is: at
    /// rest a flight stack has to feel what it takes gravity for.
    #[must_use]
    pub fn of(aircraft: &AircraftSample, seen: &Seen) -> Self {
        let [measured_rad, measured_rad_s] = seen.measured;
        let [roll_rad_s, yaw_rad_s] = aircraft.roll_yaw_rad_s;
        let [north_m, east_m] = aircraft.position_m;
        let [north_m_s, east_m_s] = aircraft.over_ground_m_s;
        let pitch_rad = aircraft.attitude_rad + (measured_rad - seen.theta_rad);
        Self {
            attitude_rad: [aircraft.bank_rad, pitch_rad, aircraft.heading_rad],
            rates_rad_s: [roll_rad_s, measured_rad_s, yaw_rad_s],
            felt_m_s2: aircraft.load_factors.map(|felt| felt * STANDARD_GRAVITY_M_S2),
            position_m: [north_m, east_m, -aircraft.altitude_m],
            velocity_m_s: [north_m_s, east_m_s, -aircraft.climb_m_s],
            airspeed_m_s: aircraft.airspeed_m_s,
        }
    }

    /// Of a plant that shows nothing but pitch, as seen by a controller, at a time since the first sample.
    #[must_use]
    pub fn level(level: LevelFlight, sample: &Sample<f64>, time_s: f64) -> Self {
        let (sine, cosine) = sin_cos(sample.measurement_rad);
        let gravity_m_s2 = STANDARD_GRAVITY_M_S2;
        Self {
            attitude_rad: [0.0, sample.measurement_rad, 0.0],
            rates_rad_s: [0.0, sample.rate_rad_s, 0.0],
            felt_m_s2: [gravity_m_s2 * sine, 0.0, -gravity_m_s2 * cosine],
            position_m: [level.airspeed_m_s * time_s, 0.0, -level.altitude_m],
            velocity_m_s: [level.airspeed_m_s, 0.0, 0.0],
            airspeed_m_s: level.airspeed_m_s,
        }
    }

    /// The same so much later in straight flight.
    #[must_use]
    pub fn later(&self, time_s: f64) -> Self {
        let way = |axis: usize| self.position_m[axis] + self.velocity_m_s[axis] * time_s;
        Self { position_m: [way(0), way(1), way(2)], ..*self }
    }
}

impl FlightStack {
    /// `Ok` where it can fly a plant, beside an autopilot of ours if there is one.
    ///
    /// # Errors
    /// [`Unfit`] for a plant that shows nothing but pitch where nothing says how it flies, for one that
    /// says itself what [`LevelFlight`] would, and for a throttle that is not there or that somebody else moves.
    pub fn check(&self, plant: &Plant, has_autopilot: bool) -> Result<(), Unfit> {
        let shows_aircraft = match plant {
            Plant::Linear(_) => false,
            Plant::Aircraft(_) => true,
            Plant::External(plant) => plant.simulator.shows_aircraft(),
        };
        match (shows_aircraft, self.level) {
            (false, None) => return Err(Unfit::NoSpeed),
            (true, Some(_)) => return Err(Unfit::TwoSpeeds),
            (true, None) | (false, Some(_)) => {}
        }
        let travel = plant.aircraft().map(|plant| plant.aircraft().model().travel().throttle);
        let has_throttle = travel.is_some_and(|it| it.min.is_finite() && it.max.is_finite());
        match self.throttle {
            Some(_) if !has_throttle => Err(Unfit::NoThrottle),
            Some(_) if has_autopilot => Err(Unfit::ThrottleIsMoved),
            Some(_) | None => Ok(()),
        }
    }
}

/// Why a flight stack cannot fly a plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unfit {
    /// Nothing says how fast and how high the plant flies.
    NoSpeed,
    /// The plant says it and the flight stack's table too.
    TwoSpeeds,
    /// The plant has no throttle that can be moved.
    NoThrottle,
    /// An autopilot of ours moves it.
    ThrottleIsMoved,
    /// Many flights are asked for.
    ManyFlights,
}

impl Unfit {
    /// What is wrong.
    #[must_use]
    pub const fn problem(self) -> &'static str {
        match self {
            Self::NoSpeed => "the plant shows nothing but pitch",
            Self::TwoSpeeds => "the aircraft has an airspeed and an altitude of its own",
            Self::NoThrottle => "the plant has no throttle that moves between two ends",
            Self::ThrottleIsMoved => "the scenario's autopilot moves the throttle",
            Self::ManyFlights => "it flies once for each start of its own, and is not started here",
        }
    }

    /// What is allowed.
    #[must_use]
    pub const fn allowed(self) -> &'static str {
        match self {
            Self::NoSpeed => "such a plant with airspeed_m_s and altitude_m of the flight",
            Self::TwoSpeeds => "airspeed_m_s and altitude_m for plants that show nothing but pitch",
            Self::NoThrottle => "throttle_channel for a nonlinear aircraft of ours",
            Self::ThrottleIsMoved => "throttle_channel without loops around pitch",
            Self::ManyFlights => "commands of single flights, such as simulate",
        }
    }
}

impl fmt::Display for Unfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; allowed is {}", self.problem(), self.allowed())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_turn_into_commands_by_a_straight_line_with_ends() {
        let elevator =
            |is_reversed| ElevatorChannel { number: 1, command_rad: [-0.25, 0.5], is_reversed };
        let ardupilot = Protocol::ArduPilot { pulses_us: [1000.0, 2000.0] };
        let command = |pulse_us, is_reversed| {
            elevator(is_reversed).command_rad(ardupilot.fraction(pulse_us).expect("a pulse"))
        };
        assert_eq!(command(1500.0, false), (0.125, false));
        assert_eq!(command(1500.0, true), (0.125, false));
        assert_eq!(command(1000.0, false), (-0.25, true));
        assert_eq!(command(1000.0, true), (0.5, true));
        assert!(command(2100.0, false).1);
        assert_eq!(command(2100.0, false).0.to_bits(), 0.5_f64.to_bits());
        assert_eq!(ardupilot.fraction(0.0), None);
        assert_eq!(Protocol::Px4.fraction(-1.0), Some(0.0));
        assert_eq!(Protocol::Px4.fraction(1.0), Some(1.0));
        assert_eq!(Protocol::Px4.fraction(f64::NAN), None);
    }

    #[test]
    fn a_set_point_is_a_pulse_between_the_ends_of_its_channel() {
        let channel = SetpointChannel { number: 1, setpoint_rad: [-0.5, 0.5] };
        let pulses = [-1.0, -0.5, 0.0, 0.25, 0.5, 9.0].map(|setpoint| channel.pulse_us(setpoint));
        assert_eq!(pulses, [1000, 1000, 1500, 1750, 2000, 2000]);
    }

    /// Of a body that does not accelerate the accelerometers feel one gravity, away from the Earth.
    #[test]
    fn in_level_flight_nothing_is_felt_but_gravity_along_the_axes_of_the_pitched_body() {
        let level = LevelFlight { airspeed_m_s: 50.0, altitude_m: 300.0 };
        let pitched = Sample { setpoint_rad: 0.0, measurement_rad: 0.3, rate_rad_s: 0.1 };
        let aboard = Aboard::level(level, &pitched, 2.0);
        let norm: f64 = aboard.felt_m_s2.iter().map(|felt| felt * felt).sum();
        assert!((norm.sqrt() - STANDARD_GRAVITY_M_S2).abs() < 1e-12);
        // A nose that points up is pushed forward by its seat's back.
        assert!(aboard.felt_m_s2[0] > 2.8 && aboard.felt_m_s2[2] < -9.3);
        assert_eq!(aboard.position_m, [100.0, 0.0, -300.0]);
        assert_eq!(aboard.later(1.0).position_m, [150.0, 0.0, -300.0]);
    }
}
