//! Pictures of a flight by others: its poses, sent by UDP to FlightGear and X-Plane at the pace of the flight.
//!
//! Nothing is sent but to the addresses that are named, and nothing is received.

use std::io;
use std::net::{SocketAddr, UdpSocket};
use std::time::{Duration, Instant};

use fspid_numeric::units::{FOOT_M, KNOT_M_S};

mod live;
mod poses;

pub use live::Live;
pub use poses::{Pose, Start, TraceError, poses};

/// Who shows the flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Viewer {
    /// FlightGear, by its generic protocol with the file of [`flightgear_protocol`].
    FlightGear,
    /// X-Plane 11 or 12, by its message VEHX.
    XPlane,
}

type OfPose = fn(&Pose) -> f64;

/// What FlightGear reads of a line, in its order: a property, and the number of a pose.
const FLIGHTGEAR: [(&str, OfPose); 10] = [
    ("/position/latitude-deg", |pose| pose.latitude_deg),
    ("/position/longitude-deg", |pose| pose.longitude_deg),
    ("/position/altitude-ft", |pose| pose.altitude_m / FOOT_M),
    ("/orientation/heading-deg", |pose| pose.heading_deg),
    ("/orientation/pitch-deg", |pose| pose.pitch_deg),
    ("/orientation/roll-deg", |pose| pose.bank_deg),
    ("/velocities/airspeed-kt", |pose| pose.airspeed_m_s / KNOT_M_S),
    ("/surface-positions/elevator-pos-norm", |pose| pose.elevator_deg / FULL_DEG),
    ("/surface-positions/left-aileron-pos-norm", |pose| pose.aileron_deg / FULL_DEG),
    ("/surface-positions/right-aileron-pos-norm", |pose| -pose.aileron_deg / FULL_DEG),
];

/// What is drawn as a full deflection, since a trace does not say how far a surface goes, deg.
const FULL_DEG: f64 = 20.0;

/// The file that tells FlightGear what a line means: `Protocol/fspid.xml` under its data.
#[must_use]
pub fn flightgear_protocol() -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<!-- Lines of `fspid show`: copy to Protocol/fspid.xml in FlightGear's data; its options are\n     fdm=null and generic=socket,in,60,,5505,udp,fspid -->\n<PropertyList>\n  <generic>\n    <input>\n      <line_separator>newline</line_separator>\n      <var_separator>,</var_separator>\n",
    );
    for (node, _) in FLIGHTGEAR {
        text += &format!(
            "      <chunk><name>{}</name><type>double</type><node>{node}</node></chunk>\n",
            node.rsplit('/').next().unwrap_or(node)
        );
    }
    text + "    </input>\n  </generic>\n</PropertyList>\n"
}

impl Viewer {
    /// The packet of a pose.
    #[must_use]
    pub fn packet(self, pose: &Pose) -> Vec<u8> {
        match self {
            Self::FlightGear => {
                let numbers = FLIGHTGEAR.map(|(_, of)| format!("{:.9}", of(pose)));
                (numbers.join(",") + "\n").into_bytes()
            }
            Self::XPlane => vehx(pose),
        }
    }
}

/// Poses the first aircraft: a name of five bytes, its number, latitude, longitude and elevation, heading, pitch and roll.
fn vehx(pose: &Pose) -> Vec<u8> {
    let mut bytes = b"VEHX\0".to_vec();
    bytes.extend(0_i32.to_le_bytes());
    for number in [pose.latitude_deg, pose.longitude_deg, pose.altitude_m] {
        bytes.extend(number.to_le_bytes());
    }
    for number in [pose.heading_deg, pose.pitch_deg, pose.bank_deg] {
        #[allow(clippy::cast_possible_truncation, reason = "the message has 32 bits of an angle")]
        bytes.extend((number as f32).to_le_bytes());
    }
    bytes
}

/// How a flight was shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shown {
    /// Poses that were sent to each viewer.
    pub sent: usize,
    /// Of these, how many were sent later than [`LATE`] behind their time.
    pub late: usize,
    /// The longest that one was late, s.
    pub latest_s: f64,
    /// Length of the flight, s of its own time.
    pub flight_s: f64,
}

/// A pose that is sent later than this counts as late: a sixtieth of a second, a picture.
pub const LATE: Duration = Duration::from_micros(16_667);

/// Sends the poses, `speed` times as fast as they were flown and at most `most_hz` of them a second.
///
/// # Errors
/// A socket that cannot be made or an address to which the system sends nothing.
pub fn show(
    poses: &[Pose],
    viewers: &[(Viewer, SocketAddr)],
    speed: f64,
    most_hz: f64,
) -> io::Result<Shown> {
    let sockets: Vec<(Viewer, SocketAddr, UdpSocket)> = viewers
        .iter()
        .map(|(viewer, address)| Ok((*viewer, *address, socket_for(address)?)))
        .collect::<io::Result<_>>()?;
    let first_s = poses.first().map_or(0.0, |pose| pose.time_s);
    let begun = Instant::now();
    let mut shown = Shown::default();
    let mut next_s = 0.0;
    for (index, pose) in poses.iter().enumerate() {
        shown.flight_s = pose.time_s - first_s;
        let at_s = shown.flight_s / speed;
        // The last one is always shown.
        if at_s < next_s && index + 1 < poses.len() {
            continue;
        }
        next_s = (at_s + 1.0 / most_hz).max(next_s);
        let at = Duration::from_secs_f64(at_s);
        std::thread::sleep(at.saturating_sub(begun.elapsed()));
        let late = begun.elapsed().saturating_sub(at);
        for (viewer, address, socket) in &sockets {
            sent(socket.send_to(&viewer.packet(pose), address))?;
        }
        shown.sent += 1;
        shown.late += usize::from(late > LATE);
        shown.latest_s = shown.latest_s.max(late.as_secs_f64());
    }
    Ok(shown)
}

/// Nobody who listens is no error: a viewer may begin later.
fn sent(result: io::Result<usize>) -> io::Result<()> {
    match result {
        Err(error) if error.kind() != io::ErrorKind::ConnectionRefused => Err(error),
        _ => Ok(()),
    }
}

fn socket_for(address: &SocketAddr) -> io::Result<UdpSocket> {
    let any = if address.is_ipv4() { "0.0.0.0:0" } else { "[::]:0" };
    let of_loop = if address.is_ipv4() { "127.0.0.1:0" } else { "[::1]:0" };
    UdpSocket::bind(if address.ip().is_loopback() { of_loop } else { any })
}

#[cfg(test)]
mod tests;
