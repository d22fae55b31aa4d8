//! What can be wrong with a scenario before it flies.

use std::fmt;

use fspid_aircraft::TrimFailure;
use fspid_core::ConfigError;
use fspid_core::fuzzy::FuzzyError;
use fspid_lti::{InWords, LtiError};

use crate::autopilot::AutopilotError;
use crate::flight_stack::Unfit;
use crate::names::JSBSIM;

/// Why a part of a scenario could not be built.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SimError {
    /// A number that is not allowed.
    Number {
        /// Name of the setting, with its unit.
        what: &'static str,
        /// What was given.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// More samples than fit into memory.
    TooManySamples {
        /// Samples asked for.
        found: f64,
        /// Most allowed.
        most: usize,
    },
    /// A pitch angle that would jump with the elevator.
    NotStrictlyProper,
    /// A changed plant of another order.
    OrderChanges {
        /// Order before.
        before: usize,
        /// Order after.
        after: usize,
    },
    /// A ramp between two plants that the elevator moves in opposite senses.
    RampWithoutEffect {
        /// When nothing is left of the elevator's effect, s.
        at_s: f64,
    },
    /// A table of set-points that is empty, ragged or not in order of time.
    Table {
        /// What is wrong.
        problem: &'static str,
        /// Row in question, from 1.
        row: usize,
    },
    /// Another number of parameters than the kind has.
    ParameterCount {
        /// Name of the kind.
        kind: &'static str,
        /// Parameters given.
        found: usize,
        /// Parameters it has.
        allowed: usize,
    },
    /// Air that moves around a plant which does not say how a gust acts on it.
    NoGustEntry,
    /// A gust that would move the pitch rate at once.
    GustMovesRate {
        /// Coefficients of the gust's numerator.
        found: usize,
        /// Most allowed: two less than the denominator has.
        most: usize,
    },
    /// A flight that the aircraft cannot be trimmed for.
    Trim(Box<TrimFailure>),
    /// A change of a linear plant's coefficients, of an aircraft that has none.
    AircraftChanges,
    /// An autopilot around a plant that shows nothing but pitch.
    AutopilotNeedsAircraft,
    /// An autopilot that makes no sense.
    Autopilot(Box<AutopilotError>),
    /// A question about a linear loop, of an aircraft that is none.
    NotLinear,
    /// A question about one loop, where a sensor with a clock of its own makes it another at every sample.
    ChangingAges,
    /// An aircraft that does not stay about its trim for the few samples from which small motions are taken.
    LeavesTrim {
        /// Number of the autopilot's mode that was engaged, from 0.
        mode: usize,
        /// When, s.
        at_s: f64,
        /// How: diverged, or hit the ground.
        how: &'static str,
    },
    /// A self-tuner of another structure than small signals along a flight are written for.
    Structure,
    /// A gain with which the sampled loop leaves the range of numbers.
    TooLarge {
        /// Its key in the scenario.
        key: String,
        /// The gain.
        found: f64,
    },
    /// So many samples on their way around a loop that it is not asked as one matrix.
    LongWay {
        /// How many.
        samples: usize,
        /// Most allowed.
        most: usize,
    },
    /// An external controller in a program that starts none.
    NoHost,
    /// An external controller that cannot fly.
    NotStarted {
        /// Its file.
        file: String,
        /// What is wrong.
        reason: String,
        /// What would be right.
        allowed: String,
    },
    /// An external controller that could not be asked, for a reason that is not its own.
    Host {
        /// Its file.
        file: String,
        /// What is wrong with the machine, or with the file since it was read.
        reason: String,
    },
    /// A flight stack that cannot fly this plant, or not so.
    FlightStack {
        /// The flight stack.
        name: &'static str,
        /// Why.
        reason: Unfit,
    },
    /// A question about equations, of an aircraft that another simulator flies.
    OtherSimulator {
        /// The simulator.
        name: &'static str,
    },
    /// A change in flight of an aircraft that another simulator flies.
    OtherSimulatorChanges,
    /// An aircraft of another simulator in a program that starts none.
    NoPlantHost,
    /// An aircraft of another simulator that cannot fly.
    PlantNotStarted {
        /// The simulator and the aircraft.
        name: String,
        /// What is wrong.
        reason: String,
        /// What would be right.
        allowed: String,
    },
    /// Another simulator that could not be asked, for a reason that is not its aircraft's.
    PlantHost {
        /// The simulator.
        name: String,
        /// What is wrong with the machine.
        reason: String,
    },
    /// The linear model is refused.
    Linear(LtiError),
    /// The controller is refused.
    Controller(ConfigError),
    /// The supervisor is refused.
    Supervisor(FuzzyError),
}

impl fmt::Display for SimError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number { what, found, allowed } if found.is_finite() => {
                write!(f, "{what} is {found:?}; allowed is {allowed}")
            }
            Self::Number { what, found, allowed } => {
                write!(f, "{what} is {}; allowed is {allowed}", InWords(*found))
            }
            Self::TooManySamples { found, most } => write!(
                f,
                "the flight would take {found:e} samples; allowed are at most {most}: shorten the duration or lengthen the sample period"
            ),
            Self::NotStrictlyProper => f.write_str(
                "the transfer function has a numerator as long as its denominator, so the pitch angle would jump with the elevator; allowed is a numerator of lower degree",
            ),
            Self::Table { problem, row } => write!(f, "set-point table, row {row}: {problem}"),
            Self::ParameterCount { kind, found, allowed } => {
                write!(f, "{kind} has {allowed} parameters; {found} were given")
            }
            Self::NoGustEntry => f.write_str(
                "the air moves, but the plant does not say how gusts act on it; give it gust numerators or build it from derivatives",
            ),
            Self::GustMovesRate { found, most } => write!(
                f,
                "a gust numerator has {found} coefficients, so the pitch rate would jump with the gust; allowed are at most {most}"
            ),
            Self::Trim(failure) => failure.fmt(f),
            Self::AircraftChanges => f.write_str(
                "a nonlinear aircraft cannot be changed in flight; allowed are changes of linear plants",
            ),
            Self::AutopilotNeedsAircraft => f.write_str(
                "this plant shows neither altitude nor airspeed that outer loops could hold; allowed is a nonlinear aircraft, or one of JSBSim",
            ),
            Self::Autopilot(error) => error.fmt(f),
            Self::NotLinear => {
                f.write_str("a nonlinear aircraft has no linear loop; allowed is a linear plant")
            }
            Self::ChangingAges => f.write_str(
                "a sensor has a clock of its own, so that the age of its values changes and the loop has no poles of one sample; allowed are sensors without a clock; whether the loop holds, `analyse` says",
            ),
            Self::Structure => f.write_str(
                "gains along a flight are derived for supervisors whose rules conclude labels and that see the error and its change through even sets, and for controllers of which only the gains move",
            ),
            Self::TooLarge { key, found } => write!(
                f,
                "{key} is {found:e}; with it the sampled loop leaves the range of 64-bit numbers, allowed is a smaller one"
            ),
            Self::LongWay { samples, most } => write!(
                f,
                "{samples} samples are on their way around the loop; margins and poles are asked of at most {most}, whose cost grows with their cube; whether the loop holds, `simulate` says"
            ),
            Self::Linear(error) => error.fmt(f),
            Self::Controller(error) => error.fmt(f),
            Self::Supervisor(error) => error.fmt(f),
            another => another.fmt_of_flights(f),
        }
    }
}

impl SimError {
    /// What is wrong with an aircraft's own flight, and with controllers and aircraft that others compute; nothing for
    /// every other error.
    fn fmt_of_flights(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OrderChanges { before, after } => write!(
                f,
                "the plant changes from order {before} to order {after}; allowed is a denominator of the same length"
            ),
            Self::RampWithoutEffect { at_s } => write!(
                f,
                "the elevator moves the two plants in opposite senses, and nothing in between, at {at_s:.3} s; allowed is a ramp between plants of one sense, or a change at once"
            ),
            Self::LeavesTrim { mode, at_s, how } => write!(
                f,
                "begun at its trim in mode {} of the autopilot, in still air, the aircraft {how} at t = {at_s} s: too soon for small motions about the trim, of which the poles would be; allowed is an aircraft that its loops or a shorter sample period hold there",
                mode + 1
            ),
            Self::NoHost => f.write_str(
                "this program starts no external controllers; allowed are controllers with equations, or a program that calls `fspid_sim::external::set_host`, as `fspid` does",
            ),
            Self::NotStarted { file, reason, allowed } => {
                write!(f, "external controller {file}: {reason}; allowed is {allowed}")
            }
            Self::Host { file, reason } => write!(
                f,
                "external controller {file} could not be asked, which says nothing of it: {reason}"
            ),
            Self::FlightStack { name, reason } => write!(f, "{name} in the loop: {reason}"),
            Self::OtherSimulator { name } => {
                write!(
                    f,
                    "{name} flies the aircraft, so that there are no equations of it here; allowed are questions of flights"
                )?;
                match *name == JSBSIM {
                    true => f.write_str(
                        ", or its linear model at this condition, which `fspid aircraft import` writes",
                    ),
                    false => Ok(()),
                }
            }
            Self::OtherSimulatorChanges => f.write_str(
                "an aircraft of another simulator cannot be changed in flight; allowed are changes of linear plants",
            ),
            Self::NoPlantHost => f.write_str(
                "this program starts no other simulators; allowed are a plant or an aircraft, or a program that calls `fspid_sim::external_plant::set_plant_host`, as `fspid` does",
            ),
            Self::PlantNotStarted { name, reason, allowed } => {
                write!(f, "{name}: {reason}; allowed is {allowed}")
            }
            Self::PlantHost { name, reason } => {
                write!(f, "{name} could not be asked, which says nothing of the flight: {reason}")
            }
            _ => Ok(()),
        }
    }
}

impl std::error::Error for SimError {}

impl SimError {
    /// True where this machine or this program is what is wrong, so that there is nothing to say of any controller or aircraft.
    #[must_use]
    pub fn is_of_host(&self) -> bool {
        matches!(
            self,
            Self::NoHost | Self::Host { .. } | Self::NoPlantHost | Self::PlantHost { .. }
        )
    }
}

impl From<AutopilotError> for SimError {
    fn from(error: AutopilotError) -> Self {
        Self::Autopilot(Box::new(error))
    }
}

impl From<LtiError> for SimError {
    fn from(error: LtiError) -> Self {
        Self::Linear(error)
    }
}

impl From<FuzzyError> for SimError {
    fn from(error: FuzzyError) -> Self {
        Self::Supervisor(error)
    }
}

impl From<ConfigError> for SimError {
    fn from(error: ConfigError) -> Self {
        Self::Controller(error)
    }
}

/// `value` if it is finite and above zero.
pub(crate) fn positive(what: &'static str, value: f64) -> Result<f64, SimError> {
    if value.is_finite() && value > 0.0 {
        return Ok(value);
    }
    Err(SimError::Number { what, found: value, allowed: "a finite number above 0" })
}

/// `value` if it is finite and not below zero.
pub(crate) fn not_negative(what: &'static str, value: f64) -> Result<f64, SimError> {
    if value.is_finite() && value >= 0.0 {
        return Ok(value);
    }
    Err(SimError::Number { what, found: value, allowed: "a finite number, 0 or above" })
}

/// `value` if it is finite.
pub(crate) fn finite(what: &'static str, value: f64) -> Result<f64, SimError> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(SimError::Number { what, found: value, allowed: "a finite number" })
}
