//! Flight stacks in the place of a controller: ArduPilot and PX4.

use super::controller::ANSWER_LIMIT_S;
use super::{ANGLE_LIMIT_DEG, angle};
use crate::keyed::{
    BOOLEAN, Key, KeyRow, Range, TEXT, Table, defaulted, interval, number, optional, plain,
    positive, required, whole,
};

pub(crate) const LISTEN: Key<str> = optional(
    "listen",
    TEXT,
    "Where it is waited for, an address of this machine with a port; without it 127.0.0.1:9002 for ArduPilot and 127.0.0.1:4560 for PX4.",
);
pub(crate) const CONNECT_LIMIT_S: Key<f64> = defaulted(
    "connect_limit_s",
    number("s", Range::Between(0.001, 3600.0)),
    30.0,
    "The longest time until it comes, by the clock.",
);
pub(crate) const LEAD_IN_S: Key<f64> = defaulted(
    "lead_in_s",
    number("s", Range::Between(0.0, 3600.0)),
    0.0,
    "Straight flight before the first sample, in which its commands move nothing, for its estimates to settle.",
);

const fn channel(name: &'static str, most: i64, doc: &'static str) -> Key<i64> {
    optional(name, whole(1, most), doc)
}

const ELEVATOR: &str = "The channel that moves the elevator, from 1.";
/// Of 16 channels, or of 32 with SERVO_32_ENABLE.
pub(crate) const ARDUPILOT_ELEVATOR: Key<i64> =
    required("elevator_channel", whole(1, 32), ELEVATOR);
/// Of HIL_ACTUATOR_CONTROLS.
pub(crate) const PX4_ELEVATOR: Key<i64> = required("elevator_channel", whole(1, 16), ELEVATOR);
pub(crate) const ELEVATOR_DEG: Key<(f64, f64)> = required(
    "elevator_deg",
    interval("deg", Range::Between(-ANGLE_LIMIT_DEG, ANGLE_LIMIT_DEG)),
    "Commands at the lower and the upper end of that channel, nose up positive, from the trim.",
);
pub(crate) const ELEVATOR_REVERSED: Key<bool> = defaulted(
    "elevator_reversed",
    BOOLEAN,
    false,
    "True where the upper end of that channel turns the nose down.",
);
pub(crate) const PULSES_US: Key<(f64, f64)> = optional(
    "pulses_us",
    interval("us", Range::Between(500.0, 2500.0)),
    "Pulses at both ends of a channel; 1000 and 2000 if left out.",
);
const THROTTLE: &str = "The channel that moves the throttle of a nonlinear aircraft, from 1; without it the throttle stays where the trim has it.";
pub(crate) const ARDUPILOT_THROTTLE: Key<i64> = channel("throttle_channel", 32, THROTTLE);
pub(crate) const PX4_THROTTLE: Key<i64> = channel("throttle_channel", 16, THROTTLE);
pub(crate) const SETPOINT_CHANNEL: Key<i64> = channel(
    "setpoint_channel",
    12,
    "The channel of its remote control on which it is told the set-point, from 1; without it the set-point is not told.",
);
pub(crate) const SETPOINT_DEG: Key<(f64, f64)> = optional(
    "setpoint_deg",
    interval("deg", Range::Between(-ANGLE_LIMIT_DEG, ANGLE_LIMIT_DEG)),
    "Set-points at 1000 and at 2000 microseconds of that channel.",
);
pub(crate) const AIRSPEED_M_S: Key<f64> = optional(
    "airspeed_m_s",
    positive("m/s"),
    "True airspeed of a plant that shows nothing but pitch.",
);
pub(crate) const ALTITUDE_M: Key<f64> = optional(
    "altitude_m",
    number("m", Range::Between(-5000.0, 80000.0)),
    "Altitude of such a plant above mean sea level.",
);
pub(crate) const LATITUDE_DEG: Key<f64> = defaulted(
    "latitude_deg",
    number("deg", Range::Between(-90.0, 90.0)),
    37.6189,
    "Where the flight begins.",
);
pub(crate) const LONGITUDE_DEG: Key<f64> = defaulted(
    "longitude_deg",
    number("deg", Range::Between(-180.0, 180.0)),
    -122.375,
    "Where the flight begins.",
);
pub(crate) const DECLINATION_DEG: Key<f64> = defaulted(
    "declination_deg",
    angle(),
    0.0,
    "From true to magnetic north, to the east positive; the field is that of a dipole along the axis of the Earth.",
);

/// What both have.
const BOTH: &[KeyRow] = &[
    &LISTEN,
    &CONNECT_LIMIT_S,
    &ANSWER_LIMIT_S,
    &LEAD_IN_S,
    &ELEVATOR_DEG,
    &ELEVATOR_REVERSED,
    &SETPOINT_CHANNEL,
    &SETPOINT_DEG,
    &AIRSPEED_M_S,
    &ALTITUDE_M,
];

pub(super) const ARDUPILOT_TABLE: Table = plain(
    "ArduPilot's software in the loop, by its backend JSON: fspid is its simulator. It is not started.",
    &[&[&ARDUPILOT_ELEVATOR, &PULSES_US, &ARDUPILOT_THROTTLE], BOTH],
);
pub(super) const PX4_TABLE: Table = plain(
    "PX4's software in the loop, by its simulator's MAVLink in lockstep: fspid is its simulator. It is not started.",
    &[&[&PX4_ELEVATOR, &PX4_THROTTLE, &LATITUDE_DEG, &LONGITUDE_DEG, &DECLINATION_DEG], BOTH],
);
