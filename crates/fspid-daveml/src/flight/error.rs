//! Why models of tables do not make an aircraft.

use fspid_aircraft::AircraftError;

/// Why models of tables do not make an aircraft.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FlightError {
    /// An input that a flight does not have.
    #[error("a flight has no `{name}`, and the file gives it no initial value; known are {known}")]
    Input {
        /// Its name.
        name: String,
        /// Names that a flight has, with commas.
        known: String,
    },
    /// An input of a control law that a flight does not have and that nobody sets.
    #[error(
        "a flight has no `{name}`, and neither its file nor an `input` says what it is; a flight has {known}"
    )]
    Unset {
        /// Its name.
        name: String,
        /// Names that a flight has, with commas.
        known: String,
    },
    /// A number that is set for an input that is not there.
    #[error("there is no input `{name}`; the file has {known}")]
    NoSuchInput {
        /// Its name.
        name: String,
        /// Names that the file has, with commas.
        known: String,
    },
    /// Something to be added to an input that is set.
    #[error(
        "`{name}` is set, and nothing of the flight is heard there to which a number could be added"
    )]
    NotHeard {
        /// Its name.
        name: String,
    },
    /// An input that leads to no trim.
    #[error(
        "no value of `{name}` brings the control to where the trim has it; the nearest is {off} off (rad, or a fraction of power)"
    )]
    NoTrim {
        /// Its name.
        name: String,
        /// What is left.
        off: f64,
    },
    /// An input that is to be set and is not there.
    #[error("there is no input `{name}`; leave out what it is to be set to")]
    NoInput {
        /// Its name.
        name: &'static str,
    },
    /// An output that is not there.
    #[error("the output `{name}` is missing; mark a variable of that name with <isOutput/>")]
    Output {
        /// Its name.
        name: &'static str,
    },
    /// Units that are not known for a variable.
    #[error("`{name}` is in `{found}`; known units for it are {known}")]
    Units {
        /// Name of the variable.
        name: String,
        /// Its units.
        found: String,
        /// Units that are known for it, with commas.
        known: String,
    },
    /// Words that do not tell which way a variable counts.
    #[error(
        "`{name}` counts by the sign `{found}`, which is not known for it: {ours} (as here), or {turned} (turned); or leave it out"
    )]
    Sign {
        /// Name of the variable.
        name: String,
        /// Its words.
        found: String,
        /// Words for the way in which it counts here, with commas.
        ours: String,
        /// Words for the other way, with commas.
        turned: String,
    },
    /// A coefficient that is no straight line over the rate of the angle of attack.
    #[error(
        "`{name}` is not linear in `angleOfAttackRate`: at {rate_rad_s} rad/s it is {found:.6}, where the straight line through rest and 1 rad/s has {expected:.6}; only a linear part can be flown"
    )]
    NotLinear {
        /// Name of the output.
        name: &'static str,
        /// At which rate.
        rate_rad_s: f64,
        /// What it is there.
        found: f64,
        /// What the line has there.
        expected: f64,
    },
    /// A coefficient whose slope over the rate of the angle of attack depends on the controls.
    #[error(
        "what `angleOfAttackRate` adds to `{name}` depends on a control surface or the throttle; it may depend on everything else that a flight has"
    )]
    RateByControl {
        /// Name of the output.
        name: &'static str,
    },
    /// More inputs or outputs than are wired.
    #[error("{found} inputs or outputs; allowed are {allowed}")]
    TooMany {
        /// How many.
        found: usize,
        /// How many are allowed.
        allowed: usize,
    },
    /// A product of inertia of an aircraft that is not symmetric.
    #[error("`{name}` is {value_kg_m2} kg m²; only 0 can be flown")]
    Lopsided {
        /// Name of the output.
        name: &'static str,
        /// What was found.
        value_kg_m2: f64,
    },
    /// Mass properties that no body has.
    #[error(transparent)]
    Body(#[from] AircraftError),
}
