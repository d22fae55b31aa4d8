//! Time histories of a flight: its columns, one value a sample, and how it ended.

use fspid_aircraft::Departure;
use fspid_core::{Faults, Gains};

use crate::aircraft::AIRCRAFT_COLUMNS;
use crate::autopilot::AUTOPILOT_COLUMNS;
use crate::external::ControllerLoss;
use crate::external_plant::PlantLoss;
use crate::instant::Instant;
use crate::scenario::Prepared;
use crate::timing::Timing;

/// How a flight ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// All samples were flown.
    Completed,
    /// The flight, and its trace, ended before its last sample.
    EndedEarly(EarlyEnd),
    /// All samples were flown, and the autopilot still waits for a mode to begin.
    ModeNeverBegan {
        /// Its number, from 0.
        mode: usize,
    },
}

impl Outcome {
    /// Of a flight that ended before the sample at this time.
    #[must_use]
    pub const fn ended_early(at_s: f64, cause: EndCause) -> Self {
        Self::EndedEarly(EarlyEnd { at_s, cause })
    }
}

/// When and why a flight ended before its last sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EarlyEnd {
    /// Time of the first sample that was not flown, s.
    pub at_s: f64,
    /// Why it was not.
    pub cause: EndCause,
}

/// Why a flight ended before its last sample, in the words of every answer.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum EndCause {
    /// The pitch angle left ± 10⁶ degrees, a number was not finite, or a nonlinear aircraft lay on its back.
    #[error("diverged")]
    Diverged,
    /// A nonlinear aircraft came down to the ground.
    #[error("hit the ground")]
    HitGround,
    /// An external controller gave no answer.
    #[error("the controller {0}")]
    ControllerLost(ControllerLoss),
    /// Another simulator, which flies the aircraft, gave no answer.
    #[error("the simulator {0}")]
    PlantLost(PlantLoss),
}

impl EndCause {
    /// Its kind in a word or two, for programs.
    #[must_use]
    pub const fn kind(self) -> &'static str {
        match self {
            Self::Diverged => "diverged",
            Self::HitGround => "hit the ground",
            Self::ControllerLost(_) => "controller lost",
            Self::PlantLost(_) => "plant lost",
        }
    }

    /// How a controller or simulator was lost, in a word for programs; none where neither was.
    #[must_use]
    pub fn loss_kind(self) -> Option<&'static str> {
        match self {
            Self::Diverged | Self::HitGround => None,
            Self::ControllerLost(loss) => Some(loss.kind()),
            Self::PlantLost(loss) => Some(loss.kind()),
        }
    }
}

/// A flight that left the range in which its model is known to be worth something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exit {
    /// Time of the first such sample, s.
    pub at_s: f64,
    /// The limit that was left.
    pub departure: Departure,
    /// Samples outside of any limit, not only of this one and not only in one go.
    pub samples: usize,
    /// How long that is, s.
    pub outside_s: f64,
}

impl Exit {
    /// Takes in the next sample of a flight: the limit that is left there, if one is.
    pub fn take_in(
        exit: &mut Option<Self>,
        departure: Option<Departure>,
        k: usize,
        timing: Timing,
    ) {
        let Some(departure) = departure else {
            return;
        };
        let first = Self { at_s: timing.time_s(k), departure, samples: 0, outside_s: 0.0 };
        let exit = exit.get_or_insert(first);
        exit.samples += 1;
        exit.outside_s = exit.samples as f64 * timing.dt_s();
    }
}

/// A column that only some flights have.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name, whose last part is the unit.
    pub name: &'static str,
    /// One value a sample.
    pub values: Vec<f64>,
}

/// The columns of one controller's flight, one entry a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Commanded pitch, rad.
    pub setpoint_rad: Vec<f64>,
    /// Pitch angle, rad (the true one, without disturbance of the measurement).
    pub theta_rad: Vec<f64>,
    /// Pitch rate, rad/s.
    pub q_rad_s: Vec<f64>,
    /// Command of the controller, nose up positive, rad.
    pub command_rad: Vec<f64>,
    /// Elevator in the plant's own sign, rad.
    pub elevator_rad: Vec<f64>,
    /// Gains used.
    pub gains: Vec<Gains<f64>>,
    /// Whether an autopilot was at a limit of its own, at each sample; empty without one.
    pub autopilot_limited: Vec<bool>,
    /// What else this flight has: what sensors showed, gusts, what an aircraft shows beyond pitch.
    pub columns: Vec<Column>,
    /// When an aircraft first left the range of its model, if it did.
    pub exit: Option<Exit>,
    /// How the flight ended.
    pub outcome: Outcome,
    /// Samples whose command was cut by the controller's own limits.
    pub saturated_samples: usize,
    /// Faults latched by the controller.
    pub faults: Faults,
}

impl Trace {
    /// An empty trace with room for a flight.
    #[must_use]
    pub fn with_room(prepared: &Prepared) -> Self {
        let rows = prepared.timing().rows();
        let column = || Vec::with_capacity(rows);
        Self {
            time_s: column(),
            setpoint_rad: column(),
            theta_rad: column(),
            q_rad_s: column(),
            command_rad: column(),
            elevator_rad: column(),
            gains: Vec::with_capacity(rows),
            autopilot_limited: Vec::with_capacity(if prepared.has_autopilot() { rows } else { 0 }),
            columns: Self::empty_columns(prepared),
            exit: None,
            outcome: Outcome::Completed,
            saturated_samples: 0,
            faults: Faults::NONE,
        }
    }

    /// The columns that only some flights have, for a flight of what is prepared, with room for it.
    #[must_use]
    pub fn empty_columns(prepared: &Prepared) -> Vec<Column> {
        let rows = prepared.timing().rows();
        let column = |name| Column { name, values: Vec::with_capacity(rows) };
        column_names(prepared).map(column).collect()
    }

    /// Adds a sample of a flight of what is prepared.
    pub fn push(&mut self, prepared: &Prepared, instant: &Instant) {
        let time_s = prepared.timing().time_s(instant.k);
        self.time_s.push(time_s);
        self.setpoint_rad.push(instant.setpoint_rad);
        self.theta_rad.push(instant.theta_rad);
        self.q_rad_s.push(instant.q_rad_s);
        self.command_rad.push(instant.step.command_rad);
        self.elevator_rad.push(instant.elevator_rad);
        self.gains.push(instant.step.gains);
        self.autopilot_limited.extend(instant.autopilot.map(|it| it.is_limited));
        self.saturated_samples += usize::from(instant.step.saturated);
        self.faults = instant.step.faults;
        self.push_columns(prepared, instant);
        let departure = instant.aircraft.and_then(|aircraft| aircraft.departure);
        Exit::take_in(&mut self.exit, departure, instant.k, prepared.timing());
    }

    /// Adds what a sample has to [its columns](Self::empty_columns).
    pub fn push_columns(&mut self, prepared: &Prepared, instant: &Instant) {
        let measured = prepared.has_sensors().then_some(instant.measured);
        let gust = prepared.gusts().and_then(|gusts| gusts.get(instant.k));
        let aircraft = instant.aircraft.map(|sample| sample.values());
        let autopilot = instant.autopilot.map(|sample| sample.values());
        let shown = instant.aircraft.and_then(|sample| sample.shown);
        let parts: [&[f64]; 5] = [
            measured.as_ref().map_or(&[], |values| values),
            gust.map_or(&[], |values| values),
            aircraft.as_ref().map_or(&[], |values| values),
            shown.as_ref().map_or(&[], |shown| shown.values()),
            autopilot.as_ref().map_or(&[], |values| values),
        ];
        let mut columns = self.columns.as_mut_slice();
        for part in parts {
            let (these, rest) = columns.split_at_mut(part.len().min(columns.len()));
            for (column, value) in these.iter_mut().zip(part) {
                column.values.push(*value);
            }
            columns = rest;
        }
    }

    /// The column of that name, if this flight has it.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let column = self.columns.iter().find(|column| column.name == name)?;
        Some(&column.values)
    }

    /// Number of samples flown.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.time_s.len()
    }
}

/// What sensors show to the controller.
const MEASURED: [&str; 2] = ["measured_theta_rad", "measured_q_rad_s"];
/// How the air around a linear plant moves.
const GUSTS: [&str; 3] = ["gust_forward_m_s", "gust_down_m_s", "gust_pitch_rad_s"];

fn column_names(prepared: &Prepared) -> impl Iterator<Item = &'static str> {
    let measured = prepared.has_sensors().then_some(MEASURED).into_iter().flatten();
    let gusts = prepared.gusts().map(|_| GUSTS).into_iter().flatten();
    let aircraft = prepared.is_aircraft().then_some(AIRCRAFT_COLUMNS).into_iter().flatten();
    let autopilot = prepared.has_autopilot().then_some(AUTOPILOT_COLUMNS).into_iter().flatten();
    measured.chain(gusts).chain(aircraft).chain(prepared.shown_names()).chain(autopilot)
}
