//! What a message says of a pitch loop, in the units of lines.

use mavlink::dialects::common::{
    ATTITUDE_DATA, ATTITUDE_TARGET_DATA, AttitudeTargetTypemask, MavMessage,
    NAV_CONTROLLER_OUTPUT_DATA, SERVO_OUTPUT_RAW_DATA, VFR_HUD_DATA,
};
use mavlink::{Message as _, MessageData as _};

use crate::frame::{Damage, Frame};

/// Values with their names; what is not known any more has none.
pub(crate) type Values = Vec<(&'static str, Option<f64>)>;

/// Name of the set-point in lines.
pub(crate) const SETPOINT: &str = "setpoint_deg";

/// Pulses of servos that drive nothing.
const NO_PULSE: [u16; 2] = [0, u16::MAX];

/// What a message is here.
#[derive(Debug)]
pub(crate) enum Told {
    /// An attitude at a time, in milliseconds since the autopilot's start.
    Attitude { time_ms: u32, yaw_rad: f64, values: Values },
    /// Something that stands for a while.
    Held(Values),
    /// A set-point for the attitude.
    Target(Option<f64>),
    /// A set-point of those that tell no target.
    Desired(f64),
    /// Nothing of a pitch loop, or not known at all.
    Unused,
}

/// What a frame tells.
pub(crate) fn told(frame: &Frame<'_>) -> Result<Told, Damage> {
    if !USED.contains(&frame.id) {
        return Ok(Told::Unused);
    }
    let id = frame.id;
    let message = MavMessage::parse(frame.version, id, frame.payload)
        .map_err(|reason| Damage::Unreadable { id, reason: reason.to_string() })?;
    match message {
        MavMessage::ATTITUDE(data) => attitude(&data),
        MavMessage::ATTITUDE_TARGET(data) => target(&data),
        MavMessage::NAV_CONTROLLER_OUTPUT(data) => desired(&data),
        MavMessage::VFR_HUD(data) => flight(&data),
        MavMessage::SERVO_OUTPUT_RAW(data) => Ok(servos(&data)),
        _ => Ok(Told::Unused),
    }
}

/// Numbers of the messages that are read; all others are not even taken apart.
const USED: [u32; 5] = [
    ATTITUDE_DATA::ID,
    SERVO_OUTPUT_RAW_DATA::ID,
    NAV_CONTROLLER_OUTPUT_DATA::ID,
    VFR_HUD_DATA::ID,
    ATTITUDE_TARGET_DATA::ID,
];

fn attitude(data: &ATTITUDE_DATA) -> Result<Told, Damage> {
    let values = finite(
        "ATTITUDE",
        &[
            ("measurement_deg", degrees(data.pitch)),
            ("rate_deg_s", degrees(data.pitchspeed)),
            ("roll_deg", degrees(data.roll)),
        ],
    )?;
    let yaw_rad = f64::from(data.yaw);
    Ok(Told::Attitude { time_ms: data.time_boot_ms, yaw_rad, values })
}

fn target(data: &ATTITUDE_TARGET_DATA) -> Result<Told, Damage> {
    let ignored = AttitudeTargetTypemask::ATTITUDE_TARGET_TYPEMASK_ATTITUDE_IGNORE;
    if data.type_mask.contains(ignored) {
        return Ok(Told::Target(None));
    }
    let q = data.q.map(f64::from);
    let square = q.iter().map(|part| part * part).sum();
    if !(0.99..=1.01).contains(&square) {
        return Err(Damage::NoRotation { square });
    }
    // A rotation by yaw, pitch and roll in that order, of the frame north, east, down: w, x, y, z.
    let [w, x, y, z] = q;
    let sine = 2.0 * (w * y - z * x) / square;
    Ok(Told::Target(Some(libm::asin(sine.clamp(-1.0, 1.0)).to_degrees())))
}

fn desired(data: &NAV_CONTROLLER_OUTPUT_DATA) -> Result<Told, Damage> {
    let pitch_deg = f64::from(data.nav_pitch);
    finite("NAV_CONTROLLER_OUTPUT", &[(SETPOINT, pitch_deg)])?;
    Ok(Told::Desired(pitch_deg))
}

fn flight(data: &VFR_HUD_DATA) -> Result<Told, Damage> {
    let values = [
        ("airspeed_m_s", f64::from(data.airspeed)),
        ("altitude_m", f64::from(data.alt)),
        ("climb_m_s", f64::from(data.climb)),
        ("throttle_pct", f64::from(data.throttle)),
    ];
    finite("VFR_HUD", &values).map(Told::Held)
}

/// Of the first port alone: channels of others have the same numbers.
fn servos(data: &SERVO_OUTPUT_RAW_DATA) -> Told {
    if data.port != 0 {
        return Told::Unused;
    }
    let pulse = |us: u16| (!NO_PULSE.contains(&us)).then_some(f64::from(us));
    Told::Held(vec![
        ("servo_1_us", pulse(data.servo1_raw)),
        ("servo_2_us", pulse(data.servo2_raw)),
        ("servo_3_us", pulse(data.servo3_raw)),
        ("servo_4_us", pulse(data.servo4_raw)),
        ("servo_5_us", pulse(data.servo5_raw)),
        ("servo_6_us", pulse(data.servo6_raw)),
        ("servo_7_us", pulse(data.servo7_raw)),
        ("servo_8_us", pulse(data.servo8_raw)),
    ])
}

fn degrees(rad: f32) -> f64 {
    f64::from(rad).to_degrees()
}

/// The values, if each is a finite number.
fn finite(message: &'static str, values: &[(&'static str, f64)]) -> Result<Values, Damage> {
    match values.iter().find(|(_, value)| !value.is_finite()) {
        Some((name, _)) => Err(Damage::NotFinite { message, name }),
        None => Ok(values.iter().map(|(name, value)| (*name, Some(*value))).collect()),
    }
}
