//! PX4's simulator: MAVLink over a connection of TCP that PX4 begins, in lockstep.
//!
//! Written after PX4's guide ("Simulation", "Simulator MAVLink API") and MAVLink's `common.xml`. PX4's clock is that of
//! HIL_SENSOR, and HIL_ACTUATOR_CONTROLS that belong to a sample have its time or a later one. Until the first of them
//! PX4 is starting and is told samples of straight flight, since its clock would stand still else.

use std::io::{self, ErrorKind, Read as _, Write as _};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::time::{Duration, Instant};

use fspid_mavlink::{ActuatorControls, Encoder, Outgoing, Sender, Stream};
use fspid_sim::ControllerLoss;
use fspid_sim::external::Foreign;
use fspid_sim::flight_stack::{FlightStack, Place, RC_MIDDLE_US, SetpointChannel};

use super::sensors::{Sensed, sensed};
use super::{Channels, Counts, Link, Told};

/// How often it is looked whether it has come.
const LOOK: Duration = Duration::from_millis(2);
/// We are a system of our own, its component a simulator's, which has no number of its own.
const OWN: Sender = Sender { system: 42, component: 1 };
/// Time from fix to fix of a receiver of GPS, s, an assumption: five a second.
const GPS_S: f64 = 0.2;
/// Time from heartbeat to heartbeat, s: MAVLink's.
const HEARTBEAT_S: f64 = 1.0;

/// A conversation.
#[derive(Debug)]
pub(super) struct Px4 {
    stream: TcpStream,
    inlet: Stream,
    encoder: Encoder,
    limit: Duration,
    place: Place,
    setpoint: Option<SetpointChannel>,
    /// Time of the last controls that were taken, µs; none while it is starting.
    taken_us: Option<u64>,
    /// Time of the last sample that was told while it was starting, µs.
    woken_us: u64,
    /// When the next fix and the next heartbeat are due, s.
    gps_s: f64,
    heartbeat_s: f64,
    unarmed: u64,
    counts: Counts,
}

/// Waits for the connection, at most for the first of the times; the second is for each answer.
pub(super) fn connect(
    stack: &FlightStack,
    (connecting, limit): (Duration, Duration),
    waiting: impl FnOnce(SocketAddr),
) -> io::Result<Result<Px4, ControllerLoss>> {
    let listener = TcpListener::bind(stack.address)?;
    waiting(listener.local_addr()?);
    listener.set_nonblocking(true)?;
    let until = Instant::now() + connecting;
    let stream = loop {
        match listener.accept() {
            Ok((stream, _)) => break stream,
            Err(error) if error.kind() == ErrorKind::WouldBlock => {}
            Err(error) => return Err(error),
        }
        if Instant::now() >= until {
            let limit_s = connecting.as_secs_f64();
            return Ok(Err(ControllerLoss::NotConnected { limit_s }));
        }
        std::thread::sleep(LOOK);
    };
    stream.set_nonblocking(false)?;
    stream.set_nodelay(true)?;
    stream.set_write_timeout(Some(limit))?;
    Ok(Ok(Px4 {
        stream,
        inlet: Stream::default(),
        encoder: Encoder::new(OWN),
        limit,
        place: stack.place,
        setpoint: stack.setpoint,
        taken_us: None,
        woken_us: 0,
        gps_s: 0.0,
        heartbeat_s: 0.0,
        unarmed: 0,
        counts: Counts::default(),
    }))
}

/// A time in the unit of messages.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "not negative, and the cast saturates"
)]
fn microseconds(time_s: f64) -> u64 {
    (time_s * 1e6).round() as u64
}

impl Px4 {
    fn send(&mut self, told: &Told) -> Result<(), ControllerLoss> {
        let time_us = microseconds(told.clock_s);
        let Sensed { sensors, place, attitude } = sensed(&told.aboard, &self.place, time_us);
        let mut messages = Vec::new();
        if told.clock_s >= self.heartbeat_s {
            self.heartbeat_s = told.clock_s + HEARTBEAT_S;
            messages.push(Outgoing::Heartbeat);
        }
        if told.clock_s >= self.gps_s {
            self.gps_s = told.clock_s + GPS_S;
            messages.push(Outgoing::Gps(place));
        }
        messages.push(Outgoing::State(place, attitude));
        if let Some(channel) = self.setpoint {
            let mut pulses_us = [RC_MIDDLE_US; 12];
            if let Some(pulse_us) = pulses_us.get_mut(channel.number) {
                *pulse_us = channel.pulse_us(told.setpoint_rad);
            }
            messages.push(Outgoing::RemoteControl { time_us, pulses_us });
        }
        // Last: it is what moves PX4's clock.
        messages.push(Outgoing::Sensors(sensors));
        let bytes: Vec<u8> =
            messages.iter().flat_map(|message| self.encoder.frame(message)).collect();
        self.stream.write_all(&bytes).map_err(|error| lost(&error, self.limit))
    }

    /// The next controls; nothing once the time is over.
    fn receive(&mut self, until: Instant) -> Result<Option<ActuatorControls>, ControllerLoss> {
        let mut bytes = [0; 4096];
        loop {
            let found = self.inlet.next_controls();
            if let Some(controls) = found.map_err(|_| ControllerLoss::Foreign(Foreign::Frame))? {
                if !controls.is_lockstep {
                    return Err(ControllerLoss::Foreign(Foreign::NoLockstep));
                }
                return Ok(Some(controls));
            }
            // A limit of zero would be none.
            let left = until.checked_duration_since(Instant::now()).filter(|it| !it.is_zero());
            let Some(left) = left else { return Ok(None) };
            let timed = self.stream.set_read_timeout(Some(left));
            match timed.and_then(|()| self.stream.read(&mut bytes)) {
                Ok(0) => return Err(ControllerLoss::Closed),
                Ok(length) => self.inlet.push(bytes.get(..length).unwrap_or_default()),
                Err(error) => match error.kind() {
                    ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted => {}
                    _ => return Err(lost(&error, self.limit)),
                },
            }
        }
    }

    /// Whether controls belong to the sample of that time; others are counted.
    fn takes(&mut self, controls: &ActuatorControls, time_us: u64) -> bool {
        let is_repeated = self.taken_us == Some(controls.time_us);
        let is_late = controls.time_us < time_us;
        match (is_repeated, is_late) {
            (true, _) => self.counts.repeated += 1,
            // What was told while it was starting may be answered now.
            (false, true) => self.counts.late += u64::from(controls.time_us > self.woken_us),
            (false, false) => self.taken_us = Some(controls.time_us),
        }
        !is_repeated && !is_late
    }
}

fn lost(error: &io::Error, limit: Duration) -> ControllerLoss {
    match error.kind() {
        ErrorKind::WouldBlock | ErrorKind::TimedOut => {
            ControllerLoss::Silent { limit_s: limit.as_secs_f64() }
        }
        _ => ControllerLoss::Closed,
    }
}

impl Link for Px4 {
    fn exchange(&mut self, told: &Told) -> Result<Channels, ControllerLoss> {
        self.send(told)?;
        let time_us = microseconds(told.clock_s);
        let until = Instant::now() + self.limit;
        loop {
            let silent = ControllerLoss::Silent { limit_s: self.limit.as_secs_f64() };
            let controls = self.receive(until)?.ok_or(silent)?;
            if self.takes(&controls, time_us) {
                self.unarmed += u64::from(!controls.is_armed);
                return Ok(Channels(controls.controls.iter().copied().map(f64::from).collect()));
            }
        }
    }

    fn is_awake(&self) -> bool {
        self.taken_us.is_some()
    }

    fn wake(&mut self, told: &Told, patience: Duration) -> Result<(), ControllerLoss> {
        self.send(told)?;
        self.woken_us = microseconds(told.clock_s);
        if let Some(controls) = self.receive(Instant::now() + patience)? {
            self.taken_us = Some(controls.time_us);
        }
        Ok(())
    }

    fn words(&self) -> String {
        let armed = match self.unarmed {
            0 => String::new(),
            unarmed => format!("; not armed at {unarmed} samples"),
        };
        format!("{}{armed}", self.counts)
    }
}
