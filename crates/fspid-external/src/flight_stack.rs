//! ArduPilot and PX4 in the place of a controller: their software in the loop with an aircraft of ours.
//!
//! Each comes by itself, and is told sample by sample what there is to be felt on board; the flight goes on when its
//! channels came. Nothing is sent but to who came.

use std::fmt;
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::{Duration, Instant};

use fspid_sim::core::{Faults, Gains, Sample, Step};
use fspid_sim::external::{Answers, Asked, Foreign, Lost};
use fspid_sim::flight_stack::{Aboard, FlightStack, LevelFlight, Protocol};
use fspid_sim::{AircraftSample, ControllerLoss, External, Seen, SimError};

use crate::pace::Pace;

mod ardupilot;
mod px4;
mod sensors;

/// Who is told what happened on the way.
pub(crate) type Tell = Arc<dyn Fn(String) + Send + Sync>;

/// What is told at a sample.
struct Told {
    /// Time that the flight stack goes by, s: one period at the first of them, since 0 is no time for a clock.
    clock_s: f64,
    aboard: Aboard,
    setpoint_rad: f64,
}

/// Channels as they came, µs or -1 to 1.
struct Channels(Vec<f64>);

impl Channels {
    fn at(&self, number: usize) -> Result<f64, ControllerLoss> {
        let foreign = || Foreign::NoChannel { number: number + 1, channels: self.0.len() };
        self.0.get(number).copied().ok_or_else(|| ControllerLoss::Foreign(foreign()))
    }
}

/// A conversation with a flight stack.
trait Link: fmt::Debug + Send {
    /// Tells a sample and waits for the channels that answer it.
    fn exchange(&mut self, told: &Told) -> Result<Channels, ControllerLoss>;

    /// True once it answers each sample. One that is still starting is told samples until then.
    fn is_awake(&self) -> bool {
        true
    }

    /// Tells a sample to one that is still starting, and waits no longer than a time for what it answers.
    fn wake(&mut self, _: &Told, _: Duration) -> Result<(), ControllerLoss> {
        Ok(())
    }

    /// What happened on the way, in words.
    fn words(&self) -> String;
}

/// How packets came that are not the next.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    repeated: u64,
    missing: u64,
    late: u64,
    others: u64,
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { repeated, missing, late, others } = self;
        write!(f, "packets repeated {repeated}, missing {missing}, late {late}, of others {others}")
    }
}

/// A flight with a flight stack in it.
struct Flight {
    stack: FlightStack,
    dt_s: f64,
    link: Box<dyn Link>,
    /// When it has to be awake.
    awake_until: Instant,
    /// Samples that were told, and those of the flight among them.
    ticks: u64,
    samples: u64,
    /// Samples of straight flight before the first of the flight, and the way in them, m.
    lead: u64,
    way_m: [f64; 3],
    throttle: Option<f64>,
    /// Samples at which the elevator's channel drove nothing.
    idle: u64,
    pace: Option<Pace>,
    tell: Tell,
}

impl fmt::Debug for Flight {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Flight").field("stack", &self.stack).finish_non_exhaustive()
    }
}

/// Waits for a flight stack. One that does not come, or as something else, answers with that loss.
pub(crate) fn start(
    external: &External,
    stack: &FlightStack,
    real_time: Option<fn(&str)>,
    tell: Tell,
) -> Result<Box<dyn Answers>, SimError> {
    let file = external.source.name();
    let limit = Duration::from_secs_f64(stack.connect_limit_s);
    let awake_until = Instant::now() + limit;
    let waits = (limit, Duration::from_secs_f64(external.answer_limit_s));
    let waiting = |address: SocketAddr| {
        let name = stack.protocol.name();
        tell(format!(
            "note: waiting for {name} at {address}, {:?} s at most",
            stack.connect_limit_s
        ));
    };
    let host = |error: io::Error| SimError::Host { file: file.clone(), reason: in_words(&error) };
    let link: Result<Box<dyn Link>, _> = match stack.protocol {
        Protocol::ArduPilot { .. } => ardupilot::connect(stack, waits, waiting)
            .map_err(host)?
            .map(|link| Box::new(link.sampled_every(external.dt_s)) as Box<dyn Link>),
        Protocol::Px4 => px4::connect(stack, waits, waiting)
            .map_err(host)?
            .map(|link| Box::new(link) as Box<dyn Link>),
    };
    let link = match link {
        Ok(link) => link,
        Err(loss) => return Ok(Box::new(Lost(loss))),
    };
    Ok(Box::new(Flight {
        stack: stack.clone(),
        dt_s: external.dt_s,
        link,
        awake_until,
        ticks: 0,
        samples: 0,
        lead: 0,
        way_m: [0.0; 3],
        throttle: None,
        idle: 0,
        pace: real_time.map(|tell| Pace::new(external.dt_s, tell)),
        tell,
    }))
}

fn in_words(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::AddrInUse => {
            "another program waits at this address; allowed is one at a time".to_owned()
        }
        io::ErrorKind::AddrNotAvailable => {
            "this machine has no such address; allowed is one of its own, such as 127.0.0.1"
                .to_owned()
        }
        _ => error.to_string(),
    }
}

impl Flight {
    /// What is told next.
    fn told(&mut self, aboard: Aboard, setpoint_rad: f64) -> Told {
        if let Some(pace) = &mut self.pace {
            pace.wait(self.ticks);
        }
        self.ticks += 1;
        let clock_s = self.ticks as f64 * self.dt_s;
        Told { clock_s, aboard, setpoint_rad }
    }

    fn lead_s(&self) -> f64 {
        self.lead as f64 * self.dt_s
    }

    /// Straight flight until the flight stack answers each sample, and then for as long as the scenario says.
    fn lead_in(&mut self, first: &Aboard, setpoint_rad: f64) -> Result<(), ControllerLoss> {
        let patience = Duration::from_secs_f64(self.dt_s);
        while !self.link.is_awake() {
            if Instant::now() > self.awake_until {
                return Err(ControllerLoss::NotConnected { limit_s: self.stack.connect_limit_s });
            }
            let told = self.told(first.later(self.lead_s()), setpoint_rad);
            self.link.wake(&told, patience)?;
            self.lead += 1;
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "not negative, and the cast saturates"
        )]
        let count = (self.stack.lead_in_s / self.dt_s).round() as u64;
        for _ in 0..count {
            let told = self.told(first.later(self.lead_s()), setpoint_rad);
            self.link.exchange(&told)?;
            self.lead += 1;
        }
        self.way_m = first.velocity_m_s.map(|velocity_m_s| velocity_m_s * self.lead_s());
        Ok(())
    }

    fn step(&mut self, aboard: Aboard, setpoint_rad: f64) -> Result<Step<f64>, ControllerLoss> {
        if self.samples == 0 {
            self.lead_in(&aboard, setpoint_rad)?;
        }
        let [north_m, east_m, down_m] = aboard.position_m;
        let [ahead_m, aside_m, below_m] = self.way_m;
        let position_m = [north_m + ahead_m, east_m + aside_m, down_m + below_m];
        let told = self.told(Aboard { position_m, ..aboard }, setpoint_rad);
        let channels = self.link.exchange(&told)?;
        self.samples += 1;
        self.commanded(&channels)
    }

    fn commanded(&mut self, channels: &Channels) -> Result<Step<f64>, ControllerLoss> {
        let protocol = self.stack.protocol;
        if let Some(number) = self.stack.throttle {
            // Held where the channel drives nothing.
            let asked = protocol.throttle(channels.at(number)?);
            self.throttle = asked.or(self.throttle);
        }
        let value = channels.at(self.stack.elevator.number)?;
        let (command_rad, saturated) = match protocol.fraction(value) {
            Some(fraction) => self.stack.elevator.command_rad(fraction),
            None if value == 0.0 => {
                self.idle += 1;
                (0.0, false)
            }
            None => return Err(ControllerLoss::NotFinite),
        };
        Ok(Step { command_rad, gains: Gains::ZERO, saturated, faults: Faults::NONE })
    }
}

impl Answers for Flight {
    fn answer(&mut self, sample: Sample<f64>) -> Result<Step<f64>, ControllerLoss> {
        // Without a speed nothing but pitch is known, as of a simulator that asks line by line.
        let level = self.stack.level.unwrap_or(LevelFlight { airspeed_m_s: 0.0, altitude_m: 0.0 });
        let time_s = self.samples as f64 * self.dt_s;
        self.step(Aboard::level(level, &sample, time_s), sample.setpoint_rad)
    }

    fn answer_aboard(
        &mut self,
        seen: &Seen,
        aircraft: Option<&AircraftSample>,
    ) -> Result<Step<f64>, ControllerLoss> {
        match aircraft {
            Some(aircraft) => self.step(Aboard::of(aircraft, seen), seen.setpoint_rad),
            None => self.answer(seen.sample()),
        }
    }

    fn asked(&self) -> Asked {
        Asked { throttle: self.throttle, ..Asked::default() }
    }
}

impl Drop for Flight {
    /// Tells what happened on the way, which is part of no verdict.
    fn drop(&mut self) {
        let (name, address) = (self.stack.protocol.name(), self.stack.address);
        let idle = match self.idle {
            0 => String::new(),
            idle => format!(
                "; at {idle} of the samples the elevator's channel had no pulse, which counts as the trim"
            ),
        };
        (self.tell)(format!(
            "note: {name} at {address}: {} samples told, {} before the flight; {}{idle}",
            self.ticks,
            self.lead,
            self.link.words()
        ));
    }
}

#[cfg(test)]
mod tests;
