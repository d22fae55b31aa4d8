//! Flight stacks in the place of a controller.

use std::net::SocketAddr;

use fspid_sim::flight_stack::{
    ElevatorChannel, FlightStack, LevelFlight, Place, Protocol, SetpointChannel,
};
use fspid_sim::{External, ExternalSource, NamedExternal, Plant};

use super::rad;
use crate::file::files::Files;
use crate::file::spec::controller::{ANSWER_LIMIT_S, NAME};
use crate::file::spec::flight_stack as keys;
use crate::keyed::{Key, KeyName, Section};
use fspid_diagnostics::Report;

/// Which one, with the keys that differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Which {
    ArduPilot,
    Px4,
}

impl Which {
    /// Where it is waited for if nothing is said: the port that it looks for.
    const fn address(self) -> &'static str {
        match self {
            Self::ArduPilot => "127.0.0.1:9002",
            Self::Px4 => "127.0.0.1:4560",
        }
    }

    const fn channels(self) -> [Key<i64>; 2] {
        match self {
            Self::ArduPilot => [keys::ARDUPILOT_ELEVATOR, keys::ARDUPILOT_THROTTLE],
            Self::Px4 => [keys::PX4_ELEVATOR, keys::PX4_THROTTLE],
        }
    }
}

/// The flight stack of a sound section, around a plant with an autopilot of ours or without.
pub(super) fn flight_stack(
    report: &mut Report,
    files: &mut Files<'_>,
    (section, which): (&Section, Which),
    (dt_s, plant, has_autopilot): (f64, Option<&Plant>, bool),
) -> Option<NamedExternal> {
    let [elevator, throttle] = which.channels();
    let (address, setpoint, level) =
        (address(report, files, section, which), setpoint(report, section), level(report, section));
    let protocol = match which {
        Which::ArduPilot => {
            let (lower_us, upper_us) = section.get(keys::PULSES_US).unwrap_or((1000.0, 2000.0));
            Protocol::ArduPilot { pulses_us: [lower_us, upper_us] }
        }
        Which::Px4 => Protocol::Px4,
    };
    let stack = FlightStack {
        protocol,
        address: address?,
        connect_limit_s: section.get(keys::CONNECT_LIMIT_S)?,
        lead_in_s: section.get(keys::LEAD_IN_S)?,
        elevator: ElevatorChannel {
            number: from_zero(section.get(elevator)?)?,
            command_rad: ends_rad(section.get(keys::ELEVATOR_DEG)?),
            is_reversed: section.get(keys::ELEVATOR_REVERSED)?,
        },
        throttle: section.get(throttle).and_then(from_zero),
        setpoint: setpoint?,
        place: place(section, which)?,
        level: level?,
    };
    if let Some(Err(unfit)) = plant.map(|plant| stack.check(plant, has_autopilot)) {
        section.problem(report, NAME, unfit.problem(), unfit.allowed());
        return None;
    }
    let source = ExternalSource::FlightStack(Box::new(stack));
    let answer_limit_s = section.get(ANSWER_LIMIT_S)?;
    let external = External { source, contents: None, answer_limit_s, dt_s, renamed: Vec::new() };
    Some(NamedExternal { name: section.get(NAME)?.to_owned(), external })
}

/// Where it is waited for. No name is looked up: that of a machine may stand for another one the next time.
fn address(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    which: Which,
) -> Option<SocketAddr> {
    let given = section.get(keys::LISTEN);
    if given.is_none() {
        files.fill(section.path(keys::LISTEN), which.address());
    }
    let address = given.unwrap_or(which.address()).parse().ok();
    if address.is_none() {
        let allowed =
            format!("an address of this machine with a port, such as {}", which.address());
        section.wrong(report, keys::LISTEN, "no address", allowed);
    }
    address
}

/// How the set-point is told; the inner `None` where it is not, the outer one for a problem.
#[allow(clippy::option_option, reason = "left out and refused are two things")]
fn setpoint(report: &mut Report, section: &Section) -> Option<Option<SetpointChannel>> {
    match (section.get(keys::SETPOINT_CHANNEL), section.get(keys::SETPOINT_DEG)) {
        (None, None) => Some(None),
        (Some(number), Some(ends_deg)) => {
            let setpoint_rad = ends_rad(ends_deg);
            Some(Some(SetpointChannel { number: from_zero(number)?, setpoint_rad }))
        }
        (Some(_), None) => missing(report, section, keys::SETPOINT_CHANNEL.name, "setpoint_deg"),
        (None, Some(_)) => missing(report, section, keys::SETPOINT_DEG.name, "setpoint_channel"),
    }
}

/// How a plant flies that shows nothing but pitch; as above.
#[allow(clippy::option_option, reason = "left out and refused are two things")]
fn level(report: &mut Report, section: &Section) -> Option<Option<LevelFlight>> {
    match (section.get(keys::AIRSPEED_M_S), section.get(keys::ALTITUDE_M)) {
        (None, None) => Some(None),
        (Some(airspeed_m_s), Some(altitude_m)) => {
            Some(Some(LevelFlight { airspeed_m_s, altitude_m }))
        }
        (Some(_), None) => missing(report, section, keys::AIRSPEED_M_S.name, "altitude_m"),
        (None, Some(_)) => missing(report, section, keys::ALTITUDE_M.name, "airspeed_m_s"),
    }
}

fn missing<T>(report: &mut Report, section: &Section, key: KeyName, other: &str) -> Option<T> {
    section.problem(report, key, format!("{other} is missing"), "both, or none");
    None
}

/// Where the flight is. ArduPilot is told ways from its own home, and has its own field.
fn place(section: &Section, which: Which) -> Option<Place> {
    let of = |key: Key<f64>| match which {
        Which::ArduPilot => Some(0.0),
        Which::Px4 => section.get(key).map(rad),
    };
    Some(Place {
        latitude_rad: of(keys::LATITUDE_DEG)?,
        longitude_rad: of(keys::LONGITUDE_DEG)?,
        declination_rad: of(keys::DECLINATION_DEG)?,
    })
}

fn ends_rad((lower_deg, upper_deg): (f64, f64)) -> [f64; 2] {
    [lower_deg, upper_deg].map(rad)
}

/// A channel's number as programs count.
fn from_zero(number: i64) -> Option<usize> {
    usize::try_from(number - 1).ok()
}
