//! Why models of tables do not make an aircraft.

use core::fmt;

use fspid_aircraft::AircraftError;

/// Why models of tables do not make an aircraft.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum FlightError {
    /// An input that a flight does not have.
    Input {
        /// Its name.
        name: String,
        /// Names that a flight has, with commas.
        known: String,
    },
    /// An input that is to be set and is not there.
    NoInput {
        /// Its name.
        name: &'static str,
    },
    /// An output that is not there.
    Output {
        /// Its name.
        name: &'static str,
    },
    /// Units that are not known for a variable.
    Units {
        /// Name of the variable.
        name: String,
        /// Its units.
        found: String,
        /// Units that are known for it, with commas.
        known: String,
    },
    /// More inputs or outputs than are wired.
    TooMany {
        /// How many.
        found: usize,
        /// How many are allowed.
        allowed: usize,
    },
    /// A product of inertia of an aircraft that is not symmetric.
    Lopsided {
        /// Name of the output.
        name: &'static str,
        /// What was found.
        value_kg_m2: f64,
    },
    /// Mass properties that no body has.
    Body(AircraftError),
}

impl fmt::Display for FlightError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input { name, known } => write!(
                f,
                "a flight has no `{name}`, and the file gives it no initial value; known are {known}"
            ),
            Self::NoInput { name } => {
                write!(f, "there is no input `{name}`; leave out what it is to be set to")
            }
            Self::Output { name } => write!(
                f,
                "the output `{name}` is missing; mark a variable of that name with <isOutput/>"
            ),
            Self::Units { name, found, known } => {
                write!(f, "`{name}` is in `{found}`; known units for it are {known}")
            }
            Self::TooMany { found, allowed } => {
                write!(f, "{found} inputs or outputs; allowed are {allowed}")
            }
            Self::Lopsided { name, value_kg_m2 } => {
                write!(f, "`{name}` is {value_kg_m2} kg m²; only 0 can be flown")
            }
            Self::Body(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for FlightError {}

impl From<AircraftError> for FlightError {
    fn from(error: AircraftError) -> Self {
        Self::Body(error)
    }
}
