//! What can be wrong with an aircraft, as one enum whose variants hold the values found and allowed.

use fspid_lti::{InWords, LtiError};
use thiserror::Error;

/// Why an aircraft could not be built or a question about it not be answered.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum AircraftError {
    /// A quantity that must be above zero and finite.
    #[error("the {what} is {}; it must be above zero and finite", InWords(*value))]
    NotPositive {
        /// Which quantity, with its unit.
        what: &'static str,
        /// What was found.
        value: f64,
    },
    /// A quantity that is NaN or infinite.
    #[error("the {what} is {}; it must be a finite number", InWords(*value))]
    NotFinite {
        /// Which quantity, with its unit.
        what: &'static str,
        /// What was found.
        value: f64,
    },
    /// A range whose ends are the wrong way round or not numbers.
    #[error("the range of {what} goes from {min} to {max}; the first must be below the second")]
    EmptyRange {
        /// Which quantity, with its unit.
        what: &'static str,
        /// Lower end found.
        min: f64,
        /// Upper end found.
        max: f64,
    },
    /// A value outside of what is known.
    #[error("the {what} is {value}; it must be between {min} and {max}")]
    Outside {
        /// Which quantity, with its unit.
        what: &'static str,
        /// What was found.
        value: f64,
        /// Lowest value allowed.
        min: f64,
        /// Highest value allowed.
        max: f64,
    },
    /// Moments of inertia that no body has.
    #[error(
        "Ix {ix_kg_m2}, Iz {iz_kg_m2} and Ixz {ixz_kg_m2} kg m² belong to no body: Ix Iz must exceed Ixz²"
    )]
    ImpossibleInertia {
        /// About the forward axis.
        ix_kg_m2: f64,
        /// About the downward axis.
        iz_kg_m2: f64,
        /// Product of inertia.
        ixz_kg_m2: f64,
    },
    /// An aircraft known only by a linear model.
    #[error(
        "{name} is known only by its linear model at one flight condition; it has no forces to trim or to fly elsewhere"
    )]
    LinearOnly {
        /// Which aircraft.
        name: String,
    },
    /// An aircraft of which the forces are known, and no derivatives.
    #[error("{name} is known by tables; it has no stability derivatives")]
    NoDerivatives {
        /// Which aircraft.
        name: String,
    },
    /// An aircraft whose source has no air of its own.
    #[error(
        "{name} is known by tables, and its file says no air of its own; fly it in the standard atmosphere"
    )]
    NoAir {
        /// Which aircraft.
        name: String,
    },
    /// A loading for an aircraft of which only a linear model is known.
    #[error(
        "{name} is known only by its linear model, which holds at the loading of its source; mass, centre of gravity and inertia cannot be changed"
    )]
    FixedLoading {
        /// Which aircraft.
        name: String,
    },
    /// A centre of gravity for derivatives that do not say about which one they are.
    #[error(
        "the aircraft's file does not say to which centre of gravity its derivatives belong; its [reference] needs cg_mac"
    )]
    NoReferenceCg,
    /// Rows over Mach number that do not rise.
    #[error("the Mach number {} comes after {before}; rows must rise", InWords(*found))]
    MachRows {
        /// That of the row before, 0 before the first.
        before: f64,
        /// What was found.
        found: f64,
    },
    /// A table over Mach number without anything between rows.
    #[error("rows over Mach number must be at least two")]
    FewMachRows,
    /// A linear model in which nothing is the pitch angle.
    #[error("none of the states of the linear model is the pitch angle")]
    NoPitch,
    /// A linear system that could not be made or solved.
    #[error(transparent)]
    Linear(#[from] LtiError),
}

impl AircraftError {
    /// `Ok` when the value is above zero and finite.
    pub(crate) fn unless_positive(what: &'static str, value: f64) -> Result<(), Self> {
        if value > 0.0 && value.is_finite() {
            Ok(())
        } else {
            Err(Self::NotPositive { what, value })
        }
    }

    /// `Ok` when the value is finite.
    pub(crate) fn unless_finite(what: &'static str, value: f64) -> Result<(), Self> {
        if value.is_finite() { Ok(()) } else { Err(Self::NotFinite { what, value }) }
    }
}
