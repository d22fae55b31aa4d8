//! Aircraft that have no equations here: another simulator flies them, and is asked at each sample.
//!
//! What is known of one is what it is asked to fly. Whoever starts it is not here, as with [external
//! controllers](crate::external): a program that can start simulators says so once with [`set_plant_host`].

use std::fmt;
use std::path::PathBuf;
use std::sync::OnceLock;

use crate::error::SimError;
use crate::external::{Contents, ControllerLoss, Renamed, SIGNALS};
use crate::names::JSBSIM;

mod air;
mod flight;

pub(crate) use flight::{Around, ExternalFlight, ExternalMotion};

/// An aircraft that another simulator flies.
#[derive(Clone, Debug, PartialEq)]
pub struct ExternalPlant {
    /// Which one, and what it is asked to fly.
    pub simulator: Simulator,
    /// The longest time for the answer to a sample, s.
    pub answer_limit_s: f64,
}

/// A simulator and what it is asked to fly.
#[derive(Clone, Debug, PartialEq)]
pub enum Simulator {
    /// JSBSim, through its Python package.
    Jsbsim(Jsbsim),
    /// An FMU for co-simulation.
    Fmu(FmuPlant),
}

impl Simulator {
    /// What it is called.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Jsbsim(_) => JSBSIM,
            Self::Fmu(_) => "an FMU",
        }
    }

    /// What of it flies.
    #[must_use]
    pub fn model(&self) -> String {
        match self {
            Self::Jsbsim(jsbsim) => jsbsim.aircraft.clone(),
            Self::Fmu(fmu) => fmu.file.display().to_string(),
        }
    }

    /// True where a sample says more than pitch.
    pub(crate) fn shows_aircraft(&self) -> bool {
        matches!(self, Self::Jsbsim(_))
    }
}

/// A flight of JSBSim: which aircraft, and the condition at which JSBSim trims it.
#[derive(Clone, Debug, PartialEq)]
pub struct Jsbsim {
    /// Name of the aircraft, which is that of its folder.
    pub aircraft: String,
    /// Folder with `aircraft`, and `engine` and `systems` if it has them; None for those of the package.
    pub folder: Option<PathBuf>,
    /// The version that has to be there.
    pub version: String,
    /// How fast it flies.
    pub speed: JsbsimSpeed,
    /// Altitude, m.
    pub altitude_m: f64,
    /// Angle of the path over the horizon, climbing positive, rad.
    pub climb_rad: f64,
    /// Heading, clockwise from north, rad.
    pub heading_rad: f64,
    /// Whether the wheels are out.
    pub gear_is_down: bool,
    /// Whether the bridge levels the wings.
    pub levels_wings: bool,
    /// What its random numbers begin with.
    pub seed: u32,
    /// Properties that are set once it is trimmed, in this order.
    pub properties: Vec<(String, f64)>,
}

/// An aircraft in an FMU: elevator in, pitch and pitch rate out.
#[derive(Clone, Debug, PartialEq)]
pub struct FmuPlant {
    /// The FMU.
    pub file: PathBuf,
    /// What was in that file when it was read.
    pub contents: Contents,
    /// Variables that have other names than ours.
    pub renamed: Vec<Renamed>,
    /// Elevator at the trim in which the FMU starts, trailing edge down positive, rad.
    pub trim_elevator_rad: f64,
}

/// A speed in one of the ways in which it is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JsbsimSpeed {
    /// True airspeed, m/s.
    True(f64),
    /// Calibrated airspeed, m/s.
    Calibrated(f64),
    /// Mach number.
    Mach(f64),
}

/// State of an external simulator's aircraft at one sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlantSample {
    /// Pitch angle, rad.
    pub theta_rad: f64,
    /// Pitch rate of the body, rad/s.
    pub q_rad_s: f64,
    /// Bank, rad.
    pub bank_rad: f64,
    /// True airspeed, m/s.
    pub airspeed_m_s: f64,
    /// Altitude above mean sea level, m.
    pub altitude_m: f64,
    /// Height above the ground, m.
    pub height_m: f64,
    /// Angle of attack, rad.
    pub alpha_rad: f64,
    /// Elevator as it stands, trailing edge down positive, rad.
    pub elevator_rad: f64,
    /// Aileron as it stands, rad.
    pub aileron_rad: f64,
    /// Velocity of the air along forward, right, down of the body, m/s.
    pub air_m_s: [f64; 3],
    /// Forces but for gravity along forward, right, down of the body, in weights.
    pub felt: [f64; 3],
    /// True where a wheel, or anything else of it, touches the ground.
    pub is_on_ground: bool,
    /// Heading, clockwise from north, rad.
    pub heading_rad: f64,
    /// Angle of sideslip, rad.
    pub sideslip_rad: f64,
    /// Body rates of roll and yaw, rad/s.
    pub roll_yaw_rad_s: [f64; 2],
    /// Throttle of the first engine, 0 to 1; 0 without one.
    pub throttle: f64,
    /// Rate of the altitude, m/s.
    pub climb_m_s: f64,
    /// Speed over the ground to the north and to the east, m/s.
    pub over_ground_m_s: [f64; 2],
    /// Way over the ground since the start, m north and m east.
    pub position_m: [f64; 2],
    /// Rate of the speed along the path over the ground, m/s².
    pub path_acceleration_m_s2: f64,
    /// The throttle that the first engine is asked for, 0 to 1; 0 without one.
    pub throttle_command: f64,
}

/// How many numbers a sample is made of.
pub const PLANT_SAMPLE_NUMBERS: usize = 28;

impl PlantSample {
    /// The sample of numbers in the order of the fields; nothing where one of them is not finite.
    #[must_use]
    pub fn of(numbers: &[f64; PLANT_SAMPLE_NUMBERS]) -> Option<Self> {
        let [theta_rad, q_rad_s, bank_rad, airspeed_m_s, altitude_m, height_m, rest @ ..] =
            *numbers;
        let [alpha_rad, elevator_rad, aileron_rad, air_x, air_y, air_z, rest @ ..] = rest;
        let [felt_x, felt_y, felt_z, touches, rest @ ..] = rest;
        let [heading_rad, sideslip_rad, roll_rad_s, yaw_rad_s, throttle, climb_m_s, rest @ ..] =
            rest;
        let [north_m_s, east_m_s, north_m, east_m, path_acceleration_m_s2, throttle_command] = rest;
        numbers.iter().all(|number| number.is_finite()).then_some(Self {
            theta_rad,
            q_rad_s,
            bank_rad,
            airspeed_m_s,
            altitude_m,
            height_m,
            alpha_rad,
            elevator_rad,
            aileron_rad,
            air_m_s: [air_x, air_y, air_z],
            felt: [felt_x, felt_y, felt_z],
            is_on_ground: touches != 0.0,
            heading_rad,
            sideslip_rad,
            roll_yaw_rad_s: [roll_rad_s, yaw_rad_s],
            throttle,
            climb_m_s,
            over_ground_m_s: [north_m_s, east_m_s],
            position_m: [north_m, east_m],
            path_acceleration_m_s2,
            throttle_command,
        })
    }
}

/// How a simulator was lost in flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlantLoss {
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
    /// It said that it cannot go on.
    Refused,
    /// It answered with a number that is NaN or infinite.
    NotFinite,
    /// What came was no answer.
    NoAnswer,
    /// Its process is gone, and the system keeps it to itself how.
    Gone,
    /// It could not be started for this flight.
    NotStarted,
    /// The flight was copied, which a process cannot be.
    Copied,
}

impl PlantLoss {
    /// One word or two for programs.
    #[must_use]
    pub fn kind(self) -> &'static str {
        match self {
            Self::Crashed { .. } => "crashed",
            Self::Ended { .. } => "ended",
            Self::Silent { .. } => "silent",
            Self::Refused => "refused",
            Self::NotFinite => "not finite",
            Self::NoAnswer => "no answer",
            Self::Gone => "gone",
            Self::NotStarted => "not started",
            Self::Copied => "copied",
        }
    }
}

impl From<ControllerLoss> for PlantLoss {
    /// What can happen to any process.
    fn from(loss: ControllerLoss) -> Self {
        match loss {
            ControllerLoss::Crashed { signal } => Self::Crashed { signal },
            ControllerLoss::Ended { code } => Self::Ended { code },
            ControllerLoss::Silent { limit_s } => Self::Silent { limit_s },
            ControllerLoss::Refused { .. } => Self::Refused,
            ControllerLoss::NotFinite => Self::NotFinite,
            ControllerLoss::Overran | ControllerLoss::NoAnswer | ControllerLoss::Foreign(_) => {
                Self::NoAnswer
            }
            ControllerLoss::Gone | ControllerLoss::Closed => Self::Gone,
            ControllerLoss::NotStarted | ControllerLoss::NotConnected { .. } => Self::NotStarted,
        }
    }
}

impl fmt::Display for PlantLoss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Crashed { signal } => match SIGNALS.iter().find(|(number, _)| number == signal) {
                Some((_, name)) => write!(f, "crashed with {name}"),
                None => write!(f, "crashed with signal {signal}"),
            },
            Self::Ended { code } => write!(f, "ended its process with code {code}"),
            Self::Silent { limit_s } => write!(f, "gave no answer within {limit_s:?} s"),
            Self::Refused => f.write_str("said that it cannot go on"),
            Self::NotFinite => f.write_str("answered with a number that is not finite"),
            Self::NoAnswer => f.write_str("wrote something else than an answer"),
            Self::Gone => f.write_str("ended, and the system does not tell how"),
            Self::NotStarted => f.write_str("could not be started for this flight"),
            Self::Copied => f.write_str("flies in a process, which cannot be copied in flight"),
        }
    }
}

/// Initial conditions given to a simulator before a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beginning {
    /// Length of its steps, s.
    pub step_s: f64,
    /// How many of them a sample has.
    pub steps: u32,
    /// The wind to the north and to the east at the start, with which the aircraft moves, m/s; none in still air, where
    /// nothing of the air is told in flight either.
    pub wind_m_s: Option<[f64; 2]>,
    /// Whether the throttle is moved, which an aircraft without an engine has not.
    pub moves_throttle: bool,
}

/// Inputs of one simulator step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepInput {
    /// Elevator in its middle, trailing edge down positive, rad.
    pub elevator_rad: f64,
    /// Velocity of the air to the north, to the east and down, m/s, less that of the start, where the aircraft comes to.
    pub air_m_s: [f64; 3],
}

/// Inputs that are held constant over a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SampleInput {
    /// The throttle that is asked for, 0 to 1; nobody hears of it where nothing moves it.
    pub throttle: f64,
}

/// One flight of another simulator, at its trim first.
pub trait Simulates: fmt::Debug + Send {
    /// Where the flight begins.
    fn start(&self) -> PlantSample;

    /// The next sample, behind one step for each input.
    ///
    /// # Errors
    /// [`PlantLoss`] where there is none; the flight is over then.
    fn advance(
        &mut self,
        held: &SampleInput,
        steps: &[StepInput],
    ) -> Result<PlantSample, PlantLoss>;
}

/// Launcher of external simulators, provided by the host program.
pub trait PlantHost: Send + Sync {
    /// Starts a flight.
    ///
    /// # Errors
    /// [`SimError::PlantNotStarted`] says what is wrong with the flight and what would be right,
    /// [`SimError::PlantHost`] what is wrong with the machine.
    fn start(
        &self,
        plant: &ExternalPlant,
        beginning: &Beginning,
    ) -> Result<Box<dyn Simulates>, SimError>;

    /// The linear model around its trim.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    fn linear_model(&self, plant: &ExternalPlant) -> Result<JsbsimLinear, SimError>;
}

/// A longitudinal motion around a trim: rates of change of its states by each of them, and by the elevator, trailing edge
/// down positive, in rad.
#[derive(Clone, Debug, PartialEq)]
pub struct LongitudinalRates {
    /// A row for each state.
    pub by_states: [[f64; 4]; 4],
    /// One number a state.
    pub by_elevator: [f64; 4],
}

/// The linear model of an aircraft of JSBSim around its trim, found twice.
#[derive(Clone, Debug, PartialEq)]
pub struct JsbsimLinear {
    /// Of u, w, m/s, q, rad/s, and pitch, rad, by central differences.
    pub by_differences: LongitudinalRates,
    /// Of airspeed, m/s, angle of attack, rad, q, rad/s, and pitch, rad, by JSBSim's own linearisation.
    pub own: LongitudinalRates,
    /// True airspeed, m/s.
    pub airspeed_m_s: f64,
    /// Angle of attack, rad.
    pub alpha_rad: f64,
    /// Elevator, trailing edge down positive, rad.
    pub elevator_rad: f64,
    /// Pitch, rad.
    pub theta_rad: f64,
    /// Mach number.
    pub mach: f64,
    /// Wing span, m.
    pub span_m: f64,
}

static HOST: OnceLock<Box<dyn PlantHost>> = OnceLock::new();

/// Says what starts other simulators in this program; the first that says so stays.
pub fn set_plant_host(host: impl PlantHost + 'static) {
    let _ = HOST.set(Box::new(host));
}

impl ExternalPlant {
    /// Starts it for one flight.
    ///
    /// # Errors
    /// [`SimError::NoPlantHost`] in a program that starts none, and what the host says.
    pub fn start(&self, beginning: &Beginning) -> Result<Box<dyn Simulates>, SimError> {
        HOST.get().ok_or(SimError::NoPlantHost)?.start(self, beginning)
    }

    /// Its linear model around the trim, which the simulator is asked for.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    pub fn linear_model(&self) -> Result<JsbsimLinear, SimError> {
        HOST.get().ok_or(SimError::NoPlantHost)?.linear_model(self)
    }
}

#[cfg(test)]
mod tests;
