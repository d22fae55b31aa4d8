//! Messages that are sent, as frames of MAVLink 2.

use mavlink::dialects::common::{
    AttitudeTargetTypemask, COMMAND_LONG_DATA, HEARTBEAT_DATA, HIL_GPS_DATA,
    HIL_RC_INPUTS_RAW_DATA, HIL_SENSOR_DATA, HIL_STATE_QUATERNION_DATA, HilSensorUpdatedFlags,
    MANUAL_CONTROL_DATA, MavAutopilot, MavCmd, MavMessage, MavModeFlag, MavState, MavType,
    RC_CHANNELS_OVERRIDE_DATA, SET_ATTITUDE_TARGET_DATA,
};
use mavlink::{MAV_STX_V2, MavlinkVersion, Message as _, calculate_crc};

use crate::listener::Sender;

/// Longest payload.
const MOST_PAYLOAD: usize = 255;
/// Number of the message ATTITUDE.
const ATTITUDE: f32 = 30.0;
/// What nobody knows, of a strength of signal and of an axis.
const UNKNOWN: u8 = u8::MAX;
const NO_AXIS: i16 = i16::MAX;
/// A channel of a remote control that is not to be looked at.
const IGNORED: u16 = u16::MAX;

/// Sensors of a simulated aircraft.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HilSensor {
    /// Time, µs.
    pub time_us: u64,
    /// What accelerometers feel along forward, right, down, m/s².
    pub felt_m_s2: [f64; 3],
    /// Body rates, rad/s.
    pub rates_rad_s: [f64; 3],
    /// Magnetic field along forward, right, down, gauss.
    pub field_gauss: [f64; 3],
    /// Pressure of the air, Pa.
    pub pressure_pa: f64,
    /// Dynamic pressure, Pa.
    pub dynamic_pressure_pa: f64,
    /// Altitude of that pressure in the standard atmosphere, m.
    pub pressure_altitude_m: f64,
    /// Temperature of the air, K.
    pub temperature_k: f64,
}

/// Where a simulated aircraft is and how it moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HilPlace {
    /// Time, µs.
    pub time_us: u64,
    /// Latitude, deg.
    pub latitude_deg: f64,
    /// Longitude, deg.
    pub longitude_deg: f64,
    /// Altitude above mean sea level, m.
    pub altitude_m: f64,
    /// Velocity over ground to the north, the east and down, m/s.
    pub velocity_m_s: [f64; 3],
}

/// How a simulated aircraft lies, beside its place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HilAttitude {
    /// Rotation from north, east, down to the body: w, x, y, z.
    pub quaternion: [f64; 4],
    /// Body rates, rad/s.
    pub rates_rad_s: [f64; 3],
    /// True airspeed, m/s.
    pub airspeed_m_s: f64,
    /// The same as a pitot shows it that is set for mean sea level, m/s.
    pub indicated_m_s: f64,
    /// What accelerometers feel along forward, right, down, in standard gravities.
    pub felt_g: [f64; 3],
}

/// What is sent.
#[derive(Clone, Debug, PartialEq)]
pub enum Outgoing {
    /// We are there: a program on board of nothing.
    Heartbeat,
    /// HIL_SENSOR.
    Sensors(HilSensor),
    /// HIL_GPS, with a fix in three dimensions.
    Gps(HilPlace),
    /// HIL_STATE_QUATERNION, which is the truth.
    State(HilPlace, HilAttitude),
    /// HIL_RC_INPUTS_RAW: the twelve channels of a remote control, µs.
    RemoteControl {
        /// Time, µs.
        time_us: u64,
        /// Its channels.
        pulses_us: [u16; 12],
    },
    /// SET_ATTITUDE_TARGET of an attitude; rates are ignored.
    AttitudeTarget {
        /// To whom.
        to: Sender,
        /// Time since our start, ms.
        time_ms: u32,
        /// Rotation from north, east, down to the body: w, x, y, z.
        quaternion: [f64; 4],
        /// Thrust, 0 to 1; None leaves it to the receiver.
        thrust: Option<f64>,
    },
    /// RC_CHANNELS_OVERRIDE of one of the first eight channels; the others are ignored.
    Override {
        /// To whom.
        to: Sender,
        /// Number of the channel, from 0.
        channel: usize,
        /// The pulse, µs; 0 gives the channel back.
        pulse_us: u16,
    },
    /// MANUAL_CONTROL of the axis of pitch; the others are invalid.
    Manual {
        /// To whom.
        to: Sender,
        /// Stick, -1000 to 1000, forward positive.
        forward: i16,
    },
    /// COMMAND_LONG that asks for ATTITUDE at an interval, µs.
    AskAttitude {
        /// To whom.
        to: Sender,
        /// Time from message to message, µs.
        interval_us: f64,
    },
}

/// Makes frames, numbered one after the other.
#[derive(Clone, Debug)]
pub struct Encoder {
    own: Sender,
    sequence: u8,
}

impl Encoder {
    /// Of a sender, from frame 0.
    #[must_use]
    pub fn new(own: Sender) -> Self {
        Self { own, sequence: 0 }
    }

    /// The frame of a message. Zeros at the end of a payload are left out, as MAVLink 2 has it.
    pub fn frame(&mut self, message: &Outgoing) -> Vec<u8> {
        let message = message.to_mavlink();
        let mut payload = [0; MOST_PAYLOAD];
        let length = message.ser(MavlinkVersion::V2, &mut payload);
        let id = message.message_id();
        let [low, middle, high, _] = id.to_le_bytes();
        #[allow(clippy::cast_possible_truncation, reason = "at most MOST_PAYLOAD")]
        let count = length as u8;
        let Sender { system, component } = self.own;
        let head = [MAV_STX_V2, count, 0, 0, self.sequence, system, component, low, middle, high];
        let mut frame = head.to_vec();
        frame.extend(payload.iter().take(length));
        let sum = calculate_crc(frame.get(1..).unwrap_or_default(), MavMessage::extra_crc(id));
        frame.extend(sum.to_le_bytes());
        self.sequence = self.sequence.wrapping_add(1);
        frame
    }
}

impl Outgoing {
    fn to_mavlink(&self) -> MavMessage {
        match self {
            Self::Heartbeat => MavMessage::HEARTBEAT(heartbeat()),
            Self::Sensors(sensor) => MavMessage::HIL_SENSOR(sensors(sensor)),
            Self::Gps(place) => MavMessage::HIL_GPS(gps(place)),
            Self::State(place, attitude) => {
                MavMessage::HIL_STATE_QUATERNION(state(place, attitude))
            }
            Self::RemoteControl { time_us, pulses_us } => {
                MavMessage::HIL_RC_INPUTS_RAW(remote_control(*time_us, pulses_us))
            }
            Self::AttitudeTarget { to, time_ms, quaternion, thrust } => {
                MavMessage::SET_ATTITUDE_TARGET(target(*to, *time_ms, quaternion, *thrust))
            }
            Self::Override { to, channel, pulse_us } => {
                MavMessage::RC_CHANNELS_OVERRIDE(overridden(*to, *channel, *pulse_us))
            }
            Self::Manual { to, forward } => MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA {
                x: *forward,
                y: NO_AXIS,
                z: NO_AXIS,
                r: NO_AXIS,
                buttons: 0,
                target: to.system,
            }),
            Self::AskAttitude { to, interval_us } => MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
                command: MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL,
                target_system: to.system,
                target_component: to.component,
                param1: ATTITUDE,
                param2: single(*interval_us),
                ..COMMAND_LONG_DATA::default()
            }),
        }
    }
}

fn heartbeat() -> HEARTBEAT_DATA {
    HEARTBEAT_DATA {
        custom_mode: 0,
        mavtype: MavType::MAV_TYPE_ONBOARD_CONTROLLER,
        autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
        base_mode: MavModeFlag::empty(),
        system_status: MavState::MAV_STATE_ACTIVE,
        mavlink_version: 3,
    }
}

fn sensors(sensor: &HilSensor) -> HIL_SENSOR_DATA {
    let [xacc, yacc, zacc] = sensor.felt_m_s2.map(single);
    let [xgyro, ygyro, zgyro] = sensor.rates_rad_s.map(single);
    let [xmag, ymag, zmag] = sensor.field_gauss.map(single);
    HIL_SENSOR_DATA {
        time_usec: sensor.time_us,
        xacc,
        yacc,
        zacc,
        xgyro,
        ygyro,
        zgyro,
        xmag,
        ymag,
        zmag,
        // Hectopascals.
        abs_pressure: single(sensor.pressure_pa / 100.0),
        diff_pressure: single(sensor.dynamic_pressure_pa / 100.0),
        pressure_alt: single(sensor.pressure_altitude_m),
        temperature: single(sensor.temperature_k - 273.15),
        // All but that all was set anew.
        fields_updated: HilSensorUpdatedFlags::all()
            .difference(HilSensorUpdatedFlags::HIL_SENSOR_UPDATED_RESET),
    }
}

/// A fix in three dimensions, and a receiver that says nothing of how good it is: both numbers of dilution 1, ten
/// satellites.
fn gps(place: &HilPlace) -> HIL_GPS_DATA {
    let [north_m_s, east_m_s, _] = place.velocity_m_s;
    let [vn, ve, vd] = place.velocity_m_s.map(centimetres_s);
    let course_deg = libm::atan2(east_m_s, north_m_s).to_degrees();
    let [lat, lon, alt] = where_it_is(place);
    HIL_GPS_DATA {
        time_usec: place.time_us,
        lat,
        lon,
        alt,
        eph: 100,
        epv: 100,
        vel: unsigned(libm::hypot(north_m_s, east_m_s) * 100.0),
        vn,
        ve,
        vd,
        cog: unsigned(if course_deg < 0.0 { course_deg + 360.0 } else { course_deg } * 100.0),
        fix_type: 3,
        satellites_visible: 10,
    }
}

fn state(place: &HilPlace, attitude: &HilAttitude) -> HIL_STATE_QUATERNION_DATA {
    let [rollspeed, pitchspeed, yawspeed] = attitude.rates_rad_s.map(single);
    let [vx, vy, vz] = place.velocity_m_s.map(centimetres_s);
    let [xacc, yacc, zacc] = attitude.felt_g.map(|felt| signed(felt * 1000.0));
    let [lat, lon, alt] = where_it_is(place);
    HIL_STATE_QUATERNION_DATA {
        time_usec: place.time_us,
        attitude_quaternion: attitude.quaternion.map(single),
        rollspeed,
        pitchspeed,
        yawspeed,
        lat,
        lon,
        alt,
        vx,
        vy,
        vz,
        ind_airspeed: unsigned(attitude.indicated_m_s * 100.0),
        true_airspeed: unsigned(attitude.airspeed_m_s * 100.0),
        xacc,
        yacc,
        zacc,
    }
}

fn remote_control(time_usec: u64, pulses_us: &[u16; 12]) -> HIL_RC_INPUTS_RAW_DATA {
    let [one, two, three, four, five, six, seven, eight, nine, ten, eleven, twelve] = *pulses_us;
    HIL_RC_INPUTS_RAW_DATA {
        time_usec,
        chan1_raw: one,
        chan2_raw: two,
        chan3_raw: three,
        chan4_raw: four,
        chan5_raw: five,
        chan6_raw: six,
        chan7_raw: seven,
        chan8_raw: eight,
        chan9_raw: nine,
        chan10_raw: ten,
        chan11_raw: eleven,
        chan12_raw: twelve,
        rssi: UNKNOWN,
    }
}

fn target(to: Sender, time_ms: u32, q: &[f64; 4], thrust: Option<f64>) -> SET_ATTITUDE_TARGET_DATA {
    use AttitudeTargetTypemask as Mask;
    let ignored = match thrust {
        Some(_) => Mask::empty(),
        None => Mask::ATTITUDE_TARGET_TYPEMASK_THROTTLE_IGNORE,
    };
    SET_ATTITUDE_TARGET_DATA {
        time_boot_ms: time_ms,
        target_system: to.system,
        target_component: to.component,
        type_mask: ignored
            | Mask::ATTITUDE_TARGET_TYPEMASK_BODY_ROLL_RATE_IGNORE
            | Mask::ATTITUDE_TARGET_TYPEMASK_BODY_PITCH_RATE_IGNORE
            | Mask::ATTITUDE_TARGET_TYPEMASK_BODY_YAW_RATE_IGNORE,
        q: q.map(single),
        body_roll_rate: 0.0,
        body_pitch_rate: 0.0,
        body_yaw_rate: 0.0,
        thrust: single(thrust.unwrap_or(0.0)),
    }
}

fn overridden(to: Sender, channel: usize, pulse_us: u16) -> RC_CHANNELS_OVERRIDE_DATA {
    let at = |place: usize| if place == channel { pulse_us } else { IGNORED };
    RC_CHANNELS_OVERRIDE_DATA {
        chan1_raw: at(0),
        chan2_raw: at(1),
        chan3_raw: at(2),
        chan4_raw: at(3),
        chan5_raw: at(4),
        chan6_raw: at(5),
        chan7_raw: at(6),
        chan8_raw: at(7),
        target_system: to.system,
        target_component: to.component,
    }
}

/// Latitude and longitude, 1e-7 deg, and altitude, mm.
fn where_it_is(place: &HilPlace) -> [i32; 3] {
    [place.latitude_deg * 1e7, place.longitude_deg * 1e7, place.altitude_m * 1e3].map(whole)
}

#[allow(clippy::cast_possible_truncation, reason = "messages have 32 bits")]
fn single(value: f64) -> f32 {
    value as f32
}

#[allow(clippy::cast_possible_truncation, reason = "the cast saturates, as the message does")]
fn whole(value: f64) -> i32 {
    value.round() as i32
}

#[allow(clippy::cast_possible_truncation, reason = "the cast saturates, as the message does")]
fn signed(value: f64) -> i16 {
    value.round() as i16
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates, as the message does"
)]
fn unsigned(value: f64) -> u16 {
    value.round() as u16
}

fn centimetres_s(metres_s: f64) -> i16 {
    signed(metres_s * 100.0)
}
