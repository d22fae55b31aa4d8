//! Controllers without equations in this crate: external programs that are asked for a command at each sample.
//!
//! What is known of one is its file. Whoever starts it is not here either: a process is no business of a simulation, and
//! a program that can start some says so once with [`set_host`].

use std::fmt;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use fspid_core::{Sample, Step};

use crate::aircraft::AircraftSample;
use crate::control_law::SharedLaw;
use crate::error::SimError;
use crate::flight_stack::{FlightStack, Unfit};
use crate::seen::Seen;

/// A controller that runs as an external program.
#[derive(Clone, Debug, PartialEq)]
pub struct External {
    /// What is loaded.
    pub source: ExternalSource,
    /// What was in that file when it was read, and what flies therefore; None flies what is there.
    pub contents: Option<Contents>,
    /// The longest time for an answer, s.
    pub answer_limit_s: f64,
    /// Time from sample to sample of the scenario, s.
    pub dt_s: f64,
    /// Variables of an FMU that have other names than those of exports.
    pub renamed: Vec<Renamed>,
}

/// A variable of an FMU in the place of one that exports have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Renamed {
    /// Its place.
    pub place: Place,
    /// True if it is in degrees, or degrees per second.
    pub in_degrees: bool,
    /// Its name in the FMU; a minus in front of it turns its sign.
    pub name: String,
}

/// A signal exchanged with an external controller or plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The commanded pitch.
    Setpoint,
    /// The measured pitch.
    Measurement,
    /// The measured pitch rate.
    Rate,
    /// The command, nose up positive.
    Command,
    /// Of a plant: its elevator, trailing edge down positive.
    Elevator,
    /// Of a plant: its pitch angle.
    Pitch,
    /// Of a plant: its pitch rate.
    PitchRate,
}

impl Place {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Setpoint,
        Self::Measurement,
        Self::Rate,
        Self::Command,
        Self::Elevator,
        Self::Pitch,
        Self::PitchRate,
    ];

    /// How exports call it, with its unit.
    #[must_use]
    pub const fn key(self, in_degrees: bool) -> &'static str {
        match (self, in_degrees) {
            (Self::Setpoint, false) => "setpoint_rad",
            (Self::Setpoint, true) => "setpoint_deg",
            (Self::Measurement, false) => "measurement_rad",
            (Self::Measurement, true) => "measurement_deg",
            (Self::Rate, false) => "rate_rad_s",
            (Self::Rate, true) => "rate_deg_s",
            (Self::Command, false) => "command_rad",
            (Self::Command, true) => "command_deg",
            (Self::Elevator, false) => "elevator_rad",
            (Self::Elevator, true) => "elevator_deg",
            (Self::Pitch, false) => "theta_rad",
            (Self::Pitch, true) => "theta_deg",
            (Self::PitchRate, false) => "q_rad_s",
            (Self::PitchRate, true) => "q_deg_s",
        }
    }

    /// The place of that name, and whether it is in degrees.
    #[must_use]
    pub fn of_key(key: &str) -> Option<(Self, bool)> {
        let all = Self::ALL.into_iter().flat_map(|place| [(place, false), (place, true)]);
        all.into_iter().find(|(place, in_degrees)| place.key(*in_degrees) == key)
    }
}

/// The bytes of a file.
#[derive(Clone, PartialEq, Eq)]
pub struct Contents(pub Arc<[u8]>);

impl fmt::Debug for Contents {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} bytes", self.0.len())
    }
}

/// Kind and location of an external controller.
#[derive(Clone, Debug, PartialEq)]
pub enum ExternalSource {
    /// A shared library with the functions of `fspid_external.h`.
    Library(PathBuf),
    /// An FMU for co-simulation, FMI 2.0 or 3.0.
    Fmu(PathBuf),
    /// The same, and it flies: its command is its pitch angle, and the first of its gains its pitch rate.
    FmuPlant(PathBuf),
    /// A control law in a file, which is computed here and needs no host.
    Law(SharedLaw),
    /// ArduPilot or PX4, which is no file and comes by itself.
    FlightStack(Box<FlightStack>),
}

impl ExternalSource {
    /// Its path, if it is a file.
    #[must_use]
    pub fn path(&self) -> Option<&std::path::Path> {
        match self {
            Self::Library(path) | Self::Fmu(path) | Self::FmuPlant(path) => Some(path),
            Self::Law(law) => Some(&law.path),
            Self::FlightStack(_) => None,
        }
    }

    /// What it is called in messages.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Library(path) | Self::Fmu(path) | Self::FmuPlant(path) => {
                path.display().to_string()
            }
            Self::Law(law) => law.path.display().to_string(),
            Self::FlightStack(stack) => format!("{} at {}", stack.protocol.name(), stack.address),
        }
    }

    /// `Ok` for what flies as often as it is asked.
    ///
    /// # Errors
    /// [`SimError::FlightStack`] for a flight stack, which flies once for each start of its own.
    pub fn require_many_flights(&self) -> Result<(), SimError> {
        self.flight_stack().map_or(Ok(()), |stack| {
            let (name, reason) = (stack.protocol.name(), Unfit::ManyFlights);
            Err(SimError::FlightStack { name, reason })
        })
    }

    /// The flight stack, if it is one.
    #[must_use]
    pub fn flight_stack(&self) -> Option<&FlightStack> {
        match self {
            Self::FlightStack(stack) => Some(stack),
            Self::Library(_) | Self::Fmu(_) | Self::FmuPlant(_) | Self::Law(_) => None,
        }
    }
}

/// An external controller and what it is called.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedExternal {
    /// Name in traces and reports; unique in its scenario.
    pub name: String,
    /// The controller.
    pub external: External,
}

/// How an external controller was lost in flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ControllerLoss {
    /// Its process was ended by a signal.
    Crashed {
        /// Number of the signal.
        signal: i32,
    },
    /// It ended its process.
    Ended {
        /// The code that it ended with.
        code: i32,
    },
    /// It did not answer in time.
    Silent {
        /// The longest time for an answer, s.
        limit_s: f64,
    },
    /// It said that it cannot: an FMU with a status of its standard beyond a warning.
    Refused {
        /// The status.
        status: i32,
    },
    /// It wrote behind the memory that it asked for.
    Overran,
    /// It answered a command that is NaN or infinite.
    NotFinite,
    /// What came was no answer.
    NoAnswer,
    /// Its process is gone, and the system keeps it to itself how: signals of children are ignored.
    Gone,
    /// It could not be started, though it could before.
    NotStarted,
    /// A flight stack did not come in time.
    NotConnected {
        /// The longest time until it comes, s.
        limit_s: f64,
    },
    /// A flight stack closed its connection.
    Closed,
    /// A flight stack sent what is not of its protocol.
    Foreign(Foreign),
}

/// Received data that does not follow a flight stack's protocol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Foreign {
    /// A packet that begins with another number.
    Magic {
        /// The number.
        found: u16,
    },
    /// A packet of another length.
    Length {
        /// Its bytes.
        found: usize,
        /// The bytes that it should have.
        expected: usize,
    },
    /// A frame that is damaged, or none.
    Frame,
    /// A packet of a count far behind that of the one before: it began anew.
    Restarted,
    /// Controls that say that nobody waits for anybody.
    NoLockstep,
    /// A channel that it does not have.
    NoChannel {
        /// Its number, from 1.
        number: usize,
        /// How many it has.
        channels: usize,
    },
}

impl fmt::Display for Foreign {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Magic { found } => {
                write!(f, "sent a packet that begins with {found}; allowed are 18458 and 29569")
            }
            Self::Length { found, expected } => {
                write!(f, "sent a packet of {found} bytes; allowed are {expected}")
            }
            Self::Frame => f.write_str("sent what is no whole frame of MAVLink"),
            Self::Restarted => f.write_str("began anew in flight"),
            Self::NoLockstep => f.write_str(
                "does not fly in lockstep, so that its controls belong to no sample; allowed is a build with it",
            ),
            Self::NoChannel { number, channels } => {
                write!(f, "sent {channels} channels, and the elevator's or the throttle's is number {number}")
            }
        }
    }
}

impl ControllerLoss {
    /// One word or two for programs.
    #[must_use]
    pub fn kind(self) -> &'static str {
        match self {
            Self::Crashed { .. } => "crashed",
            Self::Ended { .. } => "ended",
            Self::Silent { .. } => "silent",
            Self::Refused { .. } => "refused",
            Self::Overran => "overran",
            Self::NotFinite => "not finite",
            Self::NoAnswer => "no answer",
            Self::Gone => "gone",
            Self::NotStarted => "not started",
            Self::NotConnected { .. } => "not connected",
            Self::Closed => "closed",
            Self::Foreign(_) => "foreign",
        }
    }
}

/// Signals that programs crash with; all but one have the same number on every system.
pub(crate) const SIGNALS: [(i32, &str); 10] = [
    (1, "SIGHUP"),
    (2, "SIGINT"),
    (4, "SIGILL"),
    (5, "SIGTRAP"),
    (6, "SIGABRT"),
    (if cfg!(target_os = "linux") { 7 } else { 10 }, "SIGBUS"),
    (8, "SIGFPE"),
    (9, "SIGKILL"),
    (11, "SIGSEGV"),
    (15, "SIGTERM"),
];

impl fmt::Display for ControllerLoss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Crashed { signal } => match SIGNALS.iter().find(|(number, _)| number == signal) {
                Some((_, name)) => write!(f, "crashed with {name}"),
                None => write!(f, "crashed with signal {signal}"),
            },
            Self::Ended { code } => write!(f, "ended its process with code {code}"),
            Self::Silent { limit_s } => write!(f, "gave no answer within {limit_s:?} s"),
            Self::Refused { status } => write!(f, "refused with FMI status {status}"),
            Self::Overran => f.write_str("wrote behind the memory that it asked for"),
            Self::NotFinite => f.write_str("answered a command that is not finite"),
            Self::NoAnswer => f.write_str("wrote something else than an answer"),
            Self::Gone => f.write_str("ended, and the system does not tell how"),
            Self::NotStarted => f.write_str("could not be started for this flight"),
            Self::NotConnected { limit_s } => write!(f, "did not come within {limit_s:?} s"),
            Self::Closed => f.write_str("closed its connection"),
            Self::Foreign(what) => what.fmt(f),
        }
    }
}

/// One flight of an external controller, from rest.
pub trait Answers: fmt::Debug + Send {
    /// The answer to the next sample.
    ///
    /// # Errors
    /// [`ControllerLoss`] where there is none; the flight is over then.
    fn answer(&mut self, sample: Sample<f64>) -> Result<Step<f64>, ControllerLoss>;

    /// The same of one that is told more than a controller sees: what is there, and what an aircraft shows.
    ///
    /// # Errors
    /// As [`answer`](Self::answer).
    fn answer_aboard(
        &mut self,
        seen: &Seen,
        _: Option<&AircraftSample>,
    ) -> Result<Step<f64>, ControllerLoss> {
        self.answer(seen.sample())
    }

    /// What its last answer asks for beside the command; nothing by default.
    fn asked(&self) -> Asked {
        Asked::default()
    }
}

/// Requests of an external controller in addition to its command.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Asked {
    /// The throttle, as a fraction of its travel.
    pub throttle: Option<f64>,
    /// Aileron and rudder in the signs of the aircraft's data, rad, in place of what keeps the wings level.
    pub lateral_rad: Option<[f64; 2]>,
}

/// A controller that is lost before its first sample.
#[derive(Clone, Copy, Debug)]
pub struct Lost(pub ControllerLoss);

impl Answers for Lost {
    fn answer(&mut self, _: Sample<f64>) -> Result<Step<f64>, ControllerLoss> {
        Err(self.0)
    }
}

/// Launcher of external controllers, provided by the host program.
pub trait Host: Send + Sync {
    /// Starts one, at rest. One that is lost on the way answers with that loss.
    ///
    /// # Errors
    /// [`SimError::NotStarted`] says what is wrong with it and what would be right, [`SimError::Host`] what is wrong
    /// with the machine.
    fn start(&self, external: &External) -> Result<Box<dyn Answers>, SimError>;
}

static HOST: OnceLock<Box<dyn Host>> = OnceLock::new();

/// Says what starts external controllers in this program; the first that says so stays.
pub fn set_host(host: impl Host + 'static) {
    let _ = HOST.set(Box::new(host));
}

impl External {
    /// Starts it for one flight.
    ///
    /// # Errors
    /// [`SimError::NoHost`] in a program that starts none, and what the host says.
    pub fn start(&self) -> Result<Box<dyn Answers>, SimError> {
        if let ExternalSource::Law(law) = &self.source {
            return Ok(Box::new(law.start()));
        }
        HOST.get().ok_or(SimError::NoHost)?.start(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_host_an_external_controller_is_refused_and_says_why() {
        let source = ExternalSource::Library(PathBuf::from("controller.so"));
        let (contents, renamed) = (None, Vec::new());
        let external = External { source, contents, answer_limit_s: 1.0, dt_s: 0.01, renamed };
        let refused = external.start().err().map(|error| error.to_string());
        assert!(refused.is_some_and(|text| text.contains("external controllers")));
    }

    #[test]
    fn a_crash_is_told_with_the_name_of_its_signal() {
        assert_eq!(ControllerLoss::Crashed { signal: 11 }.to_string(), "crashed with SIGSEGV");
        assert_eq!(ControllerLoss::Crashed { signal: 64 }.to_string(), "crashed with signal 64");
    }
}
