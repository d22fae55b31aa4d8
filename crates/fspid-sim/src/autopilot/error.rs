//! What can be wrong with an autopilot before it flies.

use std::fmt;

use super::quantity::Quantity;

/// Why loops and modes make no autopilot.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum AutopilotError {
    /// Nothing says what is engaged when.
    NoModes,
    /// Two things of one name.
    TwoOfOneName {
        /// The name.
        name: String,
    },
    /// A loop that cannot move what it is said to.
    WrongPair {
        /// Its name.
        name: String,
        /// What it holds.
        holds: Quantity,
        /// What it is said to move.
        moves: String,
        /// What it may move.
        allowed: &'static str,
    },
    /// A loop or a condition of a glide slope that is not there.
    NoBeam {
        /// Name of the loop or the mode.
        name: String,
    },
    /// A throttle to be moved, of an aircraft without an engine.
    NoEngine {
        /// The loop that moves it.
        name: String,
    },
    /// Two engaged loops move the same.
    TwoMove {
        /// The mode.
        mode: String,
        /// What they move.
        what: String,
        /// Their names.
        loops: [String; 2],
    },
    /// Two engaged loops hold the same.
    TwoHold {
        /// The mode.
        mode: String,
        /// What they hold.
        what: Quantity,
    },
    /// A loop that is engaged while the one that it moves is not.
    MovedNotEngaged {
        /// The mode.
        mode: String,
        /// The engaged loop.
        moves: String,
        /// The one that it moves.
        moved: String,
    },
    /// Loops that move each other.
    Circle {
        /// One of them.
        name: String,
    },
    /// A target that no engaged loop holds by itself.
    NobodyHolds {
        /// The mode.
        mode: String,
        /// Of what.
        quantity: Quantity,
    },
    /// The first mode waits for something.
    FirstWaits {
        /// Its name.
        mode: String,
    },
    /// A mode that could begin only after the flight.
    NeverBegins {
        /// Its name.
        mode: String,
        /// When it may begin, s.
        at_s: f64,
        /// When the flight ends, s.
        end_s: f64,
    },
    /// A target or a condition that is no number.
    NotFinite {
        /// The mode.
        mode: String,
        /// Of what.
        quantity: Quantity,
    },
}

impl fmt::Display for AutopilotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoModes => {
                f.write_str("no mode engages the outer loops; allowed is one mode or more")
            }
            Self::TwoOfOneName { name } => {
                write!(f, "the name \"{name}\" is taken; allowed is a name of its own")
            }
            Self::WrongPair { name, holds, moves, allowed } => write!(
                f,
                "\"{name}\" holds {} and cannot move {moves}; allowed is {allowed}",
                holds.in_words()
            ),
            Self::NoBeam { name } => write!(
                f,
                "\"{name}\" looks at a glide slope, and there is none; allowed with [glide_slope]"
            ),
            Self::NoEngine { name } => write!(
                f,
                "\"{name}\" moves the throttle of an aircraft without an engine; allowed are loops that move pitch"
            ),
            Self::TwoMove { mode, what, loops: [first, second] } => write!(
                f,
                "in mode \"{mode}\" both \"{first}\" and \"{second}\" move {what}; allowed is one of them"
            ),
            Self::TwoHold { mode, what } => write!(
                f,
                "in mode \"{mode}\" two loops hold {}; allowed is one of them",
                what.in_words()
            ),
            Self::MovedNotEngaged { mode, moves, moved } => write!(
                f,
                "in mode \"{mode}\" \"{moves}\" moves \"{moved}\", which is not engaged; allowed is to engage both"
            ),
            Self::Circle { name } => write!(
                f,
                "\"{name}\" moves itself through other loops; allowed is a chain that ends at pitch, throttle or bank"
            ),
            Self::NobodyHolds { mode, quantity } => write!(
                f,
                "mode \"{mode}\" has a target for {}, which no engaged loop holds by itself; allowed are targets of loops that no other moves",
                quantity.in_words()
            ),
            Self::FirstWaits { mode } => write!(
                f,
                "the first mode, \"{mode}\", waits for something; allowed is one that begins with the flight"
            ),
            Self::NeverBegins { mode, at_s, end_s } => write!(
                f,
                "mode \"{mode}\" begins at {at_s:?} s at the earliest; allowed is before the end of the flight at {end_s:?} s"
            ),
            Self::NotFinite { mode, quantity } => write!(
                f,
                "mode \"{mode}\" has no finite number for {}; allowed are finite numbers",
                quantity.in_words()
            ),
        }
    }
}

impl std::error::Error for AutopilotError {}
