//! ArduPilot's backend JSON: pulses of its servos come as packets of UDP, and each new one is answered by a line of JSON.
//!
//! Written after its description (ArduPilot, `libraries/SITL/examples/JSON/readme.md`): a count in each packet says which
//! are lost or come twice. One that comes twice was not answered as far as ArduPilot knows, and is answered again.

use std::fmt::Write as _;
use std::io::{self, ErrorKind};
use std::net::{SocketAddr, UdpSocket};
use std::time::{Duration, Instant};

use fspid_sim::ControllerLoss;
use fspid_sim::external::Foreign;
use fspid_sim::flight_stack::{Aboard, FlightStack, RC_MIDDLE_US, SetpointChannel};

use super::{Channels, Counts, Link, Told};

/// What packets of 16 and of 32 channels begin with, and their channels.
const MAGICS: [(u16, usize); 2] = [(18_458, 16), (29_569, 32)];
/// Bytes before the pulses: the magic, the rate of frames, Hz, and their count.
const HEAD: usize = 8;
/// A packet is this far behind at most: beyond, ArduPilot began anew, since it counts from the beginning then.
const MOST_BEHIND: i32 = 1000;
/// Channels of a remote control that are told.
const REMOTE: usize = 8;

/// A packet of pulses.
#[derive(Clone, Debug, PartialEq)]
struct Pulses {
    rate_hz: u16,
    count: u32,
    pulses_us: Vec<f64>,
}

impl Pulses {
    fn read(packet: &[u8]) -> Result<Self, Foreign> {
        let short = || Foreign::Length { found: packet.len(), expected: HEAD + 2 * MAGICS[0].1 };
        let (head, pulses) = packet.split_first_chunk::<HEAD>().ok_or_else(short)?;
        let [m0, m1, r0, r1, c0, c1, c2, c3] = *head;
        let found = u16::from_le_bytes([m0, m1]);
        let (_, channels) = MAGICS
            .into_iter()
            .find(|(magic, _)| *magic == found)
            .ok_or(Foreign::Magic { found })?;
        if pulses.len() != 2 * channels {
            return Err(Foreign::Length { found: packet.len(), expected: HEAD + 2 * channels });
        }
        let (pairs, _) = pulses.as_chunks::<2>();
        Ok(Self {
            rate_hz: u16::from_le_bytes([r0, r1]),
            count: u32::from_le_bytes([c0, c1, c2, c3]),
            pulses_us: pairs.iter().map(|pair| f64::from(u16::from_le_bytes(*pair))).collect(),
        })
    }
}

/// A conversation.
#[derive(Debug)]
pub(super) struct ArduPilot {
    socket: UdpSocket,
    peer: SocketAddr,
    limit: Duration,
    setpoint: Option<SetpointChannel>,
    /// Count of the packet that was answered, and the answer.
    answered: u32,
    line: String,
    counts: Counts,
    rate_hz: u16,
    loop_hz: f64,
}

/// Waits for the first packet, at most for the first of the times; the second is for each answer.
/// Who comes late may have knocked often: what came beside the first packet is not answered.
pub(super) fn connect(
    stack: &FlightStack,
    (connecting, limit): (Duration, Duration),
    waiting: impl FnOnce(SocketAddr),
) -> io::Result<Result<ArduPilot, ControllerLoss>> {
    let socket = UdpSocket::bind(stack.address)?;
    waiting(socket.local_addr()?);
    let until = Instant::now() + connecting;
    let (first, peer) = match received(&socket, until)? {
        Some((packet, peer)) => match Pulses::read(&packet) {
            Ok(first) => (first, peer),
            Err(foreign) => return Ok(Err(ControllerLoss::Foreign(foreign))),
        },
        None => {
            return Ok(Err(ControllerLoss::NotConnected { limit_s: connecting.as_secs_f64() }));
        }
    };
    let (first, peer) = newest(&socket, first, peer)?;
    Ok(Ok(ArduPilot {
        socket,
        peer,
        limit,
        setpoint: stack.setpoint,
        answered: first.count,
        line: String::new(),
        counts: Counts::default(),
        rate_hz: first.rate_hz,
        loop_hz: 0.0,
    }))
}

/// The last of the packets of a peer that are there already.
fn newest(
    socket: &UdpSocket,
    mut first: Pulses,
    peer: SocketAddr,
) -> io::Result<(Pulses, SocketAddr)> {
    let mut bytes = [0; 2048];
    socket.set_nonblocking(true)?;
    while let Ok((length, from)) = socket.recv_from(&mut bytes) {
        if let (true, Ok(next)) =
            (from == peer, Pulses::read(bytes.get(..length).unwrap_or_default()))
        {
            first = next;
        }
    }
    socket.set_nonblocking(false)?;
    Ok((first, peer))
}

/// A packet; nothing once the time is over.
fn received(socket: &UdpSocket, until: Instant) -> io::Result<Option<(Vec<u8>, SocketAddr)>> {
    let mut bytes = [0; 2048];
    loop {
        // A limit of zero would be none.
        let left = until.checked_duration_since(Instant::now()).filter(|left| !left.is_zero());
        let Some(left) = left else { return Ok(None) };
        socket.set_read_timeout(Some(left))?;
        match socket.recv_from(&mut bytes) {
            Ok((length, peer)) => {
                return Ok(Some((bytes.get(..length).unwrap_or_default().to_vec(), peer)));
            }
            Err(error) => match error.kind() {
                // Elsewhere a socket tells so that nobody took what it sent before.
                ErrorKind::WouldBlock
                | ErrorKind::TimedOut
                | ErrorKind::Interrupted
                | ErrorKind::ConnectionReset => {}
                _ => return Err(error),
            },
        }
    }
}

impl ArduPilot {
    pub(super) fn sampled_every(self, dt_s: f64) -> Self {
        Self { loop_hz: 1.0 / dt_s, ..self }
    }

    fn send(&self) -> Result<(), ControllerLoss> {
        match self.socket.send_to(self.line.as_bytes(), self.peer) {
            Ok(_) => Ok(()),
            // Nobody is there now; whether somebody comes is seen by the time limit.
            Err(error) if error.kind() == ErrorKind::ConnectionRefused => Ok(()),
            Err(_) => Err(ControllerLoss::Gone),
        }
    }

    /// Takes a packet: its channels, if it is a new one.
    fn take(&mut self, packet: &[u8]) -> Result<Option<Channels>, ControllerLoss> {
        let pulses = Pulses::read(packet).map_err(ControllerLoss::Foreign)?;
        // How far it is ahead; counts begin anew behind the largest.
        let ahead = pulses.count.wrapping_sub(self.answered).cast_signed();
        match ahead {
            0 => {
                self.counts.repeated += 1;
                self.send()?;
                Ok(None)
            }
            ..0 if ahead < -MOST_BEHIND => Err(ControllerLoss::Foreign(Foreign::Restarted)),
            ..0 => {
                self.counts.late += 1;
                Ok(None)
            }
            1.. => {
                self.counts.missing += u64::from(ahead.unsigned_abs()) - 1;
                self.answered = pulses.count;
                self.rate_hz = pulses.rate_hz;
                Ok(Some(Channels(pulses.pulses_us)))
            }
        }
    }
}

impl Link for ArduPilot {
    fn exchange(&mut self, told: &Told) -> Result<Channels, ControllerLoss> {
        self.line = line(told, self.setpoint);
        self.send()?;
        let until = Instant::now() + self.limit;
        loop {
            let silent = ControllerLoss::Silent { limit_s: self.limit.as_secs_f64() };
            let found = received(&self.socket, until).map_err(|_| ControllerLoss::Gone)?;
            let (packet, from) = found.ok_or(silent)?;
            if from != self.peer {
                self.counts.others += 1;
                continue;
            }
            if let Some(channels) = self.take(&packet)? {
                return Ok(channels);
            }
        }
    }

    fn words(&self) -> String {
        let rate = match (f64::from(self.rate_hz) - self.loop_hz).abs() <= 0.5 {
            true => String::new(),
            false => format!(
                "; it asks for {} frames a second and the loop has {:.0}, so that its clock runs by those",
                self.rate_hz, self.loop_hz
            ),
        };
        format!("{}{rate}", self.counts)
    }
}

/// What it is told: a line between two ends of lines, each number with all its digits.
fn line(told: &Told, setpoint: Option<SetpointChannel>) -> String {
    let Aboard { attitude_rad, rates_rad_s, felt_m_s2, position_m, velocity_m_s, airspeed_m_s } =
        told.aboard;
    let mut line = format!(
        "\n{{\"timestamp\":{:?},\"imu\":{{\"gyro\":{rates_rad_s:?},\"accel_body\":{felt_m_s2:?}}},\"position\":{position_m:?},\"attitude\":{attitude_rad:?},\"velocity\":{velocity_m_s:?},\"airspeed\":{airspeed_m_s:?}",
        told.clock_s
    );
    if let Some(channel) = setpoint {
        let pulse_us = channel.pulse_us(told.setpoint_rad);
        let at = |place: usize| if place == channel.number { pulse_us } else { RC_MIDDLE_US };
        let count = REMOTE.max(channel.number + 1);
        line += ",\"rc\":{";
        for place in 0..count {
            let comma = if place == 0 { "" } else { "," };
            let _ = write!(line, "{comma}\"rc_{}\":{}", place + 1, at(place));
        }
        line += "}";
    }
    line + "}\n"
}
