//! Why a question about an aircraft has no answer.

use std::fmt;
use std::path::Path;

use fspid_aircraft::trim::{TrimObstacle, TrimResidual};
use fspid_aircraft::{AircraftError, Departure, Quantity, TrimFailure};

use super::number::{short, significant};
use super::units::{Kind, Units};
use crate::refused::Refused;
use fspid_diagnostics::{Problems, nearest};

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq)]
pub enum AircraftFailure {
    /// No aircraft of that name.
    Unknown {
        /// What was given.
        name: String,
        /// What was probably meant.
        meant: Option<&'static str>,
        /// What is known.
        known: Vec<&'static str>,
    },
    /// The file could not be read.
    Unreadable {
        /// Its path.
        path: String,
        /// The reason.
        reason: String,
    },
    /// The file is wrong.
    Problems(Problems),
    /// An option is wrong.
    Refused(Refused),
    /// The aircraft cannot answer.
    Aircraft(AircraftError),
    /// The flight cannot be held.
    Trim {
        /// Why.
        failure: Box<TrimFailure>,
        /// In which units to say it.
        units: Units,
    },
}

impl AircraftFailure {
    /// No aircraft of that name; the one that was probably meant, and those that are known.
    #[must_use]
    pub fn unknown(name: &str, known: &[&'static str]) -> Self {
        Self::Unknown { name: name.to_owned(), meant: nearest(name, known), known: known.to_vec() }
    }

    /// A file that could not be read.
    #[must_use]
    pub fn unreadable(path: &Path, reason: String) -> Self {
        Self::Unreadable { path: path.display().to_string(), reason }
    }
}

impl From<AircraftError> for AircraftFailure {
    fn from(error: AircraftError) -> Self {
        Self::Aircraft(error)
    }
}

impl From<fspid_lti::LtiError> for AircraftFailure {
    fn from(error: fspid_lti::LtiError) -> Self {
        Self::Aircraft(error.into())
    }
}

impl fmt::Display for AircraftFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown { name, meant, known } => {
                write!(f, "there is no aircraft `{name}`")?;
                match meant {
                    Some(meant) => write!(f, "; did you mean `{meant}`? Known are ")?,
                    None => f.write_str("; known are ")?,
                }
                write!(f, "{}, and files that end in .toml", known.join(", "))
            }
            Self::Unreadable { path, reason } => write!(f, "{path}: cannot be read: {reason}"),
            Self::Problems(problems) => problems.fmt(f),
            Self::Refused(refused) => refused.fmt(f),
            Self::Aircraft(error) => error.fmt(f),
            Self::Trim { failure, units } => trim_failure(f, failure, *units),
        }
    }
}

impl std::error::Error for AircraftFailure {}

/// What was asked, what stands in the way, and how far the search came.
fn trim_failure(f: &mut fmt::Formatter<'_>, failure: &TrimFailure, units: Units) -> fmt::Result {
    let told = |kind, si| quantity(units, kind, si);
    let target = &failure.target;
    let (speed, altitude) =
        (told(Kind::Speed, target.airspeed_m_s), told(Kind::Length, target.altitude_m));
    let climb = match target.flight_path_rad == 0.0 {
        true => String::new(),
        false => format!(", climbing {}", told(Kind::Angle, target.flight_path_rad)),
    };
    writeln!(f, "no trim at {speed}, {altitude}{climb}: {}", obstacle(failure))?;
    for limit in &failure.limits {
        writeln!(f, "  {}", departure(limit, units))?;
    }
    let point = &failure.point;
    let angles = [point.alpha_rad, point.elevator_rad].map(|angle| told(Kind::Angle, angle));
    let ([alpha, elevator], throttle) = (angles, significant(point.throttle, 4));
    let reached = match failure.reason {
        TrimObstacle::BeyondLimits => "it would take",
        TrimObstacle::NoEquilibrium => "the nearest point found has",
        TrimObstacle::Sideways => "speed, height and pitch are held with",
    };
    write!(f, "{reached} angle of attack {alpha}, elevator {elevator}, throttle {throttle}")?;
    match failure.reason {
        TrimObstacle::BeyondLimits => write!(f, " ({} steps)", failure.iterations),
        TrimObstacle::NoEquilibrium => left_over(f, &failure.residual, failure.iterations, units),
        TrimObstacle::Sideways => left_sideways(f, &failure.residual, units),
    }
}

const fn obstacle(failure: &TrimFailure) -> &'static str {
    match (failure.reason, failure.limits.is_empty()) {
        (TrimObstacle::BeyondLimits, _) => "the balance lies beyond these limits",
        (TrimObstacle::Sideways, _) => {
            "with wings level, without sideslip and with aileron and rudder at rest the aircraft is not balanced sideways"
        }
        (_, false) => "no balance of forces was found; these limits are in the way",
        (_, true) => "no balance of forces was found, within limits or beyond",
    }
}

fn left_over(
    f: &mut fmt::Formatter<'_>,
    residual: &TrimResidual,
    iterations: usize,
    units: Units,
) -> fmt::Result {
    let told = |kind, si| quantity(units, kind, si);
    let forward = told(Kind::Acceleration, residual.forward_m_s2);
    let downward = told(Kind::Acceleration, residual.downward_m_s2);
    let pitch = told(Kind::AngularAcceleration, residual.pitch_rad_s2);
    write!(
        f,
        ";\nafter {iterations} steps {forward} forward, {downward} down and {pitch} in pitch are left over"
    )
}

fn left_sideways(f: &mut fmt::Formatter<'_>, residual: &TrimResidual, units: Units) -> fmt::Result {
    let told = |kind, si| quantity(units, kind, si);
    let side = told(Kind::Acceleration, residual.side_m_s2);
    let [roll, yaw] = [residual.roll_rad_s2, residual.yaw_rad_s2]
        .map(|rate| told(Kind::AngularAcceleration, rate));
    write!(
        f,
        ";\n{side} to the right, {roll} in roll and {yaw} in yaw are left over; such an aircraft is not trimmed here: side force, rolling and yawing moment of its data have to be zero without sideslip, rates and deflections"
    )
}

/// A limit in the units of the answer: `angle of attack 12.4 deg; allowed is -8 to 10 deg`.
pub fn departure(limit: &Departure, units: Units) -> String {
    let kind = match limit.quantity {
        Quantity::Table(_) => return of_a_table(limit),
        Quantity::Airspeed => Kind::Speed,
        Quantity::Altitude => Kind::Length,
        Quantity::Mach | Quantity::Throttle => Kind::Plain,
        Quantity::Fuel => Kind::Mass,
        _ => Kind::Angle,
    };
    let (name, value) = (limit.quantity.name(), quantity(units, kind, limit.value));
    let min = short(units.told(kind, limit.allowed.min), 6);
    let max = quantity(units, kind, limit.allowed.max);
    format!("{name} {value}; allowed is {min} to {max}")
}

/// A limit of a table, in the unit of its file.
fn of_a_table(limit: &Departure) -> String {
    let [value, min, max] =
        [limit.value, limit.allowed.min, limit.allowed.max].map(|value| short(value, 6));
    let (name, unit) = (limit.quantity.name(), limit.quantity.unit());
    let space = if unit.is_empty() { "" } else { " " };
    format!("{name} {value}{space}{unit}; allowed is {min} to {max}{space}{unit}")
}

/// A value in SI with its unit.
pub fn quantity(units: Units, kind: Kind, si: f64) -> String {
    let symbol = units.of(kind).symbol;
    format!("{} {symbol}", short(units.told(kind, si), 6)).trim_end().to_owned()
}
