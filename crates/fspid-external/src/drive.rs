//! A live autopilot as what is flown: its attitudes come by MAVLink over UDP, and commands or attitude targets go back.
//!
//! Nothing is sent but to the address that is named, or, where none is, to one of this machine from which attitudes came.
//! Who tells the first attitude is flown to the end, and nobody else is heard. Where attitudes stay out the last command is
//! held, and then given back: a flight is not left to a command that nobody computes. What ends a flight of ours, an error
//! or a wish to stop, ends in the same way.

use std::fmt::Write as _;
use std::io::{self, ErrorKind};
use std::net::{SocketAddr, UdpSocket};
use std::time::{Duration, Instant};

use fspid_aircraft::{EulerAngles, Quaternion};
use fspid_mavlink::{Encoder, Line, Listener, Outgoing, Sender};
use fspid_sim::core::Sample;

use crate::pace::LATE;

/// We are a computer beside a ground station: component 191, MAV_COMP_ID_ONBOARD_COMPUTER, of system 255, from which ArduPilot
/// takes overrides unless its SYSID_MYGCS says otherwise.
const OWN: Sender = Sender { system: 255, component: 191 };
/// Time from heartbeat to heartbeat, which is MAVLink's, and from wish to wish for attitudes.
const HEARTBEAT: Duration = Duration::from_secs(1);
/// How often what was taken is given back: a packet may be lost.
const GIVEN_BACK: usize = 3;
/// How long it is waited for a packet at most before it is looked whether to stop.
const LOOK: Duration = Duration::from_millis(50);
/// So many packets at most are taken that wait already: whoever floods a socket holds up no sample.
const MOST_WAITING: usize = 10_000;
/// The middle of a channel and half its way, µs.
const MIDDLE_US: f64 = 1500.0;
const HALF_US: f64 = 500.0;
/// The whole way of an axis of MANUAL_CONTROL.
const AXIS: f64 = 1000.0;

/// What is sent at a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// The set-point as an attitude, which the autopilot's own loops fly; the controller runs beside it and moves nothing.
    AttitudeTarget {
        /// Thrust, 0 to 1; None leaves it to the autopilot.
        thrust: Option<f64>,
    },
    /// The command on a channel of the remote control.
    Override {
        /// The channel, from 0 to 7.
        channel: usize,
        /// Command at 2000 µs, rad; negative for a channel that is reversed.
        full_rad: f64,
    },
    /// The command on the axis of pitch of a joystick, whose stick forward is nose down.
    Manual {
        /// Command at the stick's whole way back, rad; negative for one that is reversed.
        full_rad: f64,
    },
}

/// A flight of a live autopilot.
#[derive(Clone, Debug)]
pub struct Drive<'a> {
    /// Where commands go; None for where attitudes come from, if that is this machine.
    pub to: Option<SocketAddr>,
    /// What is sent.
    pub way: Way,
    /// Time from sample to sample, s.
    pub period_s: f64,
    /// Set-point of each sample, rad from the trim.
    pub setpoint_rad: &'a [f64],
    /// Pitch that counts as the trim, rad.
    pub trim_rad: f64,
    /// The longest time until the first attitude comes, s.
    pub connect_limit_s: f64,
    /// Age of an attitude from which on the last command is held, s, and from which on the flight ends; so late a sample
    /// holds and ends as well.
    pub stale_s: [f64; 2],
}

/// How a flight ended before its time.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// No attitude came in time.
    NotHeard {
        /// The longest time, s.
        limit_s: f64,
    },
    /// The attitude came from elsewhere, and nobody said that commands may go there.
    Elsewhere {
        /// From where.
        from: SocketAddr,
    },
    /// Attitudes stayed out in flight.
    Stale {
        /// Time of the flight, s.
        at_s: f64,
        /// The longest time, s.
        limit_s: f64,
    },
    /// Our own samples were late.
    Late {
        /// Time of the flight, s.
        at_s: f64,
        /// By how much, s.
        late_s: f64,
        /// The most, s.
        limit_s: f64,
    },
    /// The controller was lost, in words.
    Lost {
        /// Time of the flight, s.
        at_s: f64,
        /// How.
        words: String,
    },
    /// Somebody wished to stop.
    Stopped {
        /// Time of the flight, s.
        at_s: f64,
    },
}

impl std::fmt::Display for Ending {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotHeard { limit_s } => {
                write!(
                    f,
                    "no ATTITUDE came within {limit_s:?} s; allowed is an autopilot that sends it to --listen"
                )
            }
            Self::Elsewhere { from } => write!(
                f,
                "ATTITUDE came from {from}, which is another machine; allowed is --to {from}, if commands may go there"
            ),
            Self::Stale { at_s, limit_s } => write!(
                f,
                "at t = {at_s:.3} s no ATTITUDE had come for {limit_s:?} s; the command was held and given back"
            ),
            Self::Late { at_s, late_s, limit_s } => write!(
                f,
                "the sample of t = {at_s:.3} s was late by {late_s:.3} s, and allowed are {limit_s:?} s; the command was given back"
            ),
            Self::Lost { at_s, words } => {
                write!(f, "at t = {at_s:.3} s the controller {words}; the command was given back")
            }
            Self::Stopped { at_s } => {
                write!(f, "stopped at t = {at_s:.3} s; the command was given back")
            }
        }
    }
}

/// A sample of such a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Time, s.
    pub time_s: f64,
    /// What the controller was asked with.
    pub sample: Sample<f64>,
    /// Its command, rad.
    pub command_rad: f64,
    /// True where the attitude was too old, so that the last command was held.
    pub is_held: bool,
}

/// What happened.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Driven {
    /// Each sample.
    pub rows: Vec<Row>,
    /// Samples that were late by more than a thousandth of a second, and the longest by which one was, s.
    pub late: usize,
    /// See `late`.
    pub latest_s: f64,
    /// Attitudes that came.
    pub heard: usize,
    /// Packets that were damaged.
    pub damaged: usize,
    /// How it ended, if before its time.
    pub ending: Option<Ending>,
}

impl Driven {
    /// Samples at which the last command was held.
    #[must_use]
    pub fn held(&self) -> usize {
        self.rows.iter().filter(|row| row.is_held).count()
    }

    /// A line for each sample, in the units of traces.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::from("time_s,setpoint_deg,theta_deg,q_deg_s,command_deg,held\n");
        for Row { time_s, sample, command_rad, is_held } in &self.rows {
            let numbers =
                [sample.setpoint_rad, sample.measurement_rad, sample.rate_rad_s, *command_rad];
            let [setpoint_deg, theta_deg, q_deg_s, command_deg] = numbers.map(f64::to_degrees);
            let _ = writeln!(
                text,
                "{time_s:?},{setpoint_deg:?},{theta_deg:?},{q_deg_s:?},{command_deg:?},{}",
                u8::from(*is_held)
            );
        }
        text
    }
}

/// What was heard last.
#[derive(Clone, Copy, Debug)]
struct Attitude {
    pitch_rad: f64,
    rate_rad_s: f64,
    yaw_rad: f64,
    /// Time of the sender's clock, ms.
    time_ms: u32,
    at: Instant,
}

impl Attitude {
    /// True for a time of the sender that is after this one. Its clock begins anew after 49 days; one that goes back is that
    /// of a packet that was overtaken, or of a computer that begins anew, which nobody goes on to fly.
    fn is_before(&self, time_ms: u32) -> bool {
        (1..=u32::MAX / 2).contains(&time_ms.wrapping_sub(self.time_ms))
    }
}

/// Both ends.
struct Link {
    socket: UdpSocket,
    listener: Listener,
    encoder: Encoder,
    to: Option<SocketAddr>,
    /// From where the first attitude came, and of whom it is.
    from: Option<SocketAddr>,
    peer: Option<Sender>,
    attitude: Option<Attitude>,
    beaten: Option<Instant>,
    interval_us: f64,
    begun: Instant,
    heard: usize,
    damaged: usize,
}

fn value(line: &Line, name: &str) -> Option<f64> {
    line.iter().find(|(it, _)| *it == name).map(|&(_, value)| value)
}

/// The sender's clock in a line, ms.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "made of a u32 by the listener"
)]
fn time_ms(line: &Line) -> Option<u32> {
    value(line, "time_s").map(|time_s| (time_s * 1000.0).round() as u32)
}

impl Link {
    fn new(socket: UdpSocket, drive: &Drive<'_>) -> Self {
        Self {
            socket,
            listener: Listener::default(),
            encoder: Encoder::new(OWN),
            to: drive.to,
            from: None,
            peer: None,
            attitude: None,
            beaten: None,
            interval_us: drive.period_s * 1e6,
            begun: Instant::now(),
            heard: 0,
            damaged: 0,
        }
    }

    /// Whom commands are for.
    fn peer(&self) -> Sender {
        self.peer.unwrap_or(Sender { system: 1, component: 1 })
    }

    /// To whom it may be sent, once that is known.
    fn target(&self) -> Option<SocketAddr> {
        self.to.or(self.from.filter(|from| from.ip().is_loopback()))
    }

    /// Sends to whom it may be sent. Nobody there is no error: attitudes say who is.
    fn send(&mut self, message: &Outgoing) {
        if let Some(to) = self.target() {
            let frame = self.encoder.frame(message);
            let _ = self.socket.send_to(&frame, to);
        }
    }

    /// Says that we are there, and wishes for attitudes at our rate, once a second.
    fn beat(&mut self) {
        let is_due = self.beaten.is_none_or(|at| at.elapsed() >= HEARTBEAT);
        if is_due && self.target().is_some() {
            self.beaten = Some(Instant::now());
            self.send(&Outgoing::Heartbeat);
            if self.attitude.is_some() {
                let (to, interval_us) = (self.peer(), self.interval_us);
                self.send(&Outgoing::AskAttitude { to, interval_us });
            }
        }
    }

    /// Hears what comes until a time, and what waits there already.
    fn hear(&mut self, until: Instant) -> io::Result<()> {
        loop {
            self.beat();
            // A limit of zero would be none.
            let left = until.checked_duration_since(Instant::now()).filter(|it| !it.is_zero());
            let Some(left) = left else { break };
            self.socket.set_read_timeout(Some(left))?;
            self.receive()?;
        }
        // A sample that is late takes the newest of what has come, not the oldest.
        self.socket.set_nonblocking(true)?;
        let drained = self.drain();
        self.socket.set_nonblocking(false)?;
        drained
    }

    fn drain(&mut self) -> io::Result<()> {
        for _ in 0..MOST_WAITING {
            if !self.receive()? {
                break;
            }
        }
        Ok(())
    }

    /// Takes one packet; false where none came.
    fn receive(&mut self) -> io::Result<bool> {
        let mut bytes = [0; 2048];
        match self.socket.recv_from(&mut bytes) {
            Ok((length, from)) => self.take(bytes.get(..length).unwrap_or_default(), from),
            Err(error) => match error.kind() {
                ErrorKind::WouldBlock | ErrorKind::TimedOut => return Ok(false),
                ErrorKind::Interrupted
                | ErrorKind::ConnectionRefused
                | ErrorKind::ConnectionReset => {}
                _ => return Err(error),
            },
        }
        Ok(true)
    }

    fn take(&mut self, packet: &[u8], from: SocketAddr) {
        // Where commands go to one machine, another one's attitudes are not believed; nor are those of anybody else once
        // one is flown.
        if self.to.is_some_and(|to| to.ip() != from.ip()) || self.from.is_some_and(|it| it != from)
        {
            return;
        }
        for heard in self.listener.hear(packet) {
            match heard {
                Ok(line) => self.note(&line, from),
                Err(_) => self.damaged += 1,
            }
        }
    }

    /// Remembers an attitude of whom is flown, if it is newer than the last.
    fn note(&mut self, line: &Line, from: SocketAddr) {
        let both = value(line, "measurement_deg").zip(value(line, "rate_deg_s"));
        let sender = self.listener.counts().followed;
        let (Some((pitch_deg, rate_deg_s)), Some(time_ms)) = (both, time_ms(line)) else { return };
        if self.peer.is_some() && self.peer != sender {
            return;
        }
        (self.from, self.peer) = (Some(from), sender);
        self.heard += 1;
        if self.attitude.is_none_or(|last| last.is_before(time_ms)) {
            self.attitude = Some(Attitude {
                pitch_rad: pitch_deg.to_radians(),
                rate_rad_s: rate_deg_s.to_radians(),
                yaw_rad: self.listener.yaw_rad().unwrap_or(0.0),
                time_ms,
                at: Instant::now(),
            });
        }
    }

    fn command(&mut self, way: Way, setpoint_rad: f64, command_rad: f64) {
        let to = self.peer();
        let message = match way {
            Way::AttitudeTarget { thrust } => {
                let yaw_rad = self.attitude.map_or(0.0, |attitude| attitude.yaw_rad);
                let time_ms = u32::try_from(self.begun.elapsed().as_millis()).unwrap_or(u32::MAX);
                let angles =
                    EulerAngles { phi_rad: 0.0, theta_rad: setpoint_rad, psi_rad: yaw_rad };
                let quaternion = Quaternion::from_euler(angles).to_array();
                Outgoing::AttitudeTarget { to, time_ms, quaternion, thrust }
            }
            Way::Override { channel, full_rad } => {
                Outgoing::Override { to, channel, pulse_us: pulse_us(command_rad / full_rad) }
            }
            Way::Manual { full_rad } => {
                Outgoing::Manual { to, forward: forward(command_rad / full_rad) }
            }
        };
        self.send(&message);
    }

    /// Gives back what was taken. Targets and joysticks have no word for it: they end by silence.
    fn give_back(&mut self, way: Way) {
        if let Way::Override { channel, .. } = way {
            let to = self.peer();
            for _ in 0..GIVEN_BACK {
                self.send(&Outgoing::Override { to, channel, pulse_us: 0 });
            }
        }
    }
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "cut at the ends of a channel"
)]
fn pulse_us(fraction: f64) -> u16 {
    (MIDDLE_US + HALF_US * fraction.clamp(-1.0, 1.0)).round() as u16
}

#[allow(clippy::cast_possible_truncation, reason = "cut at the ends of an axis")]
fn forward(fraction: f64) -> i16 {
    (-AXIS * fraction.clamp(-1.0, 1.0)).round() as i16
}

/// Flies a live autopilot whose attitudes come to a socket, sample by sample by the clock; `answer` is the controller, and `is_over` asked whether to stop.
///
/// # Errors
/// A socket from which nothing can be read. Whatever else goes wrong is an [`Ending`].
pub fn drive(
    socket: UdpSocket,
    drive: &Drive<'_>,
    mut answer: impl FnMut(Sample<f64>) -> Result<f64, String>,
    is_over: impl Fn() -> bool,
) -> io::Result<Driven> {
    let mut link = Link::new(socket, drive);
    let mut driven = Driven::default();
    let ending = match first_attitude(&mut link, drive, &is_over)? {
        Some(ending) => Some(ending),
        None => {
            let flown = fly(&mut link, drive, &mut driven, (&mut answer, &is_over));
            // Whatever happened, an error of the socket too.
            link.give_back(drive.way);
            flown?
        }
    };
    Ok(Driven { heard: link.heard, damaged: link.damaged, ending, ..driven })
}

/// Waits for the first attitude; how it ended where none came.
fn first_attitude(
    link: &mut Link,
    drive: &Drive<'_>,
    is_over: &impl Fn() -> bool,
) -> io::Result<Option<Ending>> {
    let limit = Duration::from_secs_f64(drive.connect_limit_s);
    while link.attitude.is_none() {
        if is_over() {
            return Ok(Some(Ending::Stopped { at_s: 0.0 }));
        }
        if link.begun.elapsed() >= limit {
            return Ok(Some(Ending::NotHeard { limit_s: drive.connect_limit_s }));
        }
        link.hear(Instant::now() + LOOK.min(limit))?;
    }
    Ok(match (link.to, link.from) {
        (None, Some(from)) if !from.ip().is_loopback() => Some(Ending::Elsewhere { from }),
        _ => None,
    })
}

fn fly(
    link: &mut Link,
    drive: &Drive<'_>,
    driven: &mut Driven,
    (answer, is_over): (&mut impl FnMut(Sample<f64>) -> Result<f64, String>, &impl Fn() -> bool),
) -> io::Result<Option<Ending>> {
    let begun = Instant::now();
    let [held_s, limit_s] = drive.stale_s;
    let mut command_rad = 0.0;
    for (k, &setpoint_rad) in drive.setpoint_rad.iter().enumerate() {
        let time_s = k as f64 * drive.period_s;
        if is_over() {
            return Ok(Some(Ending::Stopped { at_s: time_s }));
        }
        let at = begun + Duration::from_secs_f64(time_s);
        link.hear(at)?;
        let late = Instant::now().saturating_duration_since(at);
        driven.late += usize::from(late > LATE);
        let late_s = late.as_secs_f64();
        driven.latest_s = driven.latest_s.max(late_s);
        if late_s > limit_s {
            return Ok(Some(Ending::Late { at_s: time_s, late_s, limit_s }));
        }
        let Some(attitude) = link.attitude else { continue };
        let age_s = attitude.at.elapsed().as_secs_f64();
        if age_s > limit_s {
            return Ok(Some(Ending::Stale { at_s: time_s, limit_s }));
        }
        let measurement_rad = attitude.pitch_rad - drive.trim_rad;
        let sample = Sample { setpoint_rad, measurement_rad, rate_rad_s: attitude.rate_rad_s };
        // While we were late nobody looked: what has come may be as old as that.
        let is_held = age_s.max(late_s) > held_s;
        if !is_held {
            match answer(sample) {
                Ok(answered_rad) => command_rad = answered_rad,
                Err(words) => return Ok(Some(Ending::Lost { at_s: time_s, words })),
            }
        }
        link.command(drive.way, setpoint_rad + drive.trim_rad, command_rad);
        driven.rows.push(Row { time_s, sample, command_rad, is_held });
    }
    Ok(None)
}

#[cfg(test)]
mod tests;
