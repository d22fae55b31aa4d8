//! One loop around the pitch loop.

use super::quantity::Quantity;
use crate::controller::Controller;
use crate::sensor::Sensor;

/// The variable that an outer loop manipulates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moves {
    /// The pitch set-point, rad, counted from the trim.
    Pitch,
    /// The throttle, counted from the trim.
    Throttle,
    /// The bank, rad.
    Bank,
    /// The target of another outer loop, by its number.
    Loop(usize),
}

/// What a controller sees and answers for one SI unit: 1 each for a controller that was made in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Of what is held.
    pub held: f64,
    /// Of what is moved.
    pub moved: f64,
}

impl Units {
    /// Those of SI.
    pub const SI: Self = Self { held: 1.0, moved: 1.0 };
}

/// A loop around the pitch loop.
///
/// Its controller answers in SI units of what it moves for SI units of what it holds. A positive command climbs,
/// pushes or banks right; where airspeed is held by pitch or by another loop of the path, the command is turned, since an aircraft
/// that is too slow has to go down.
#[derive(Clone, Debug, PartialEq)]
pub struct OuterLoop {
    /// Name, by which modes engage it.
    pub name: String,
    /// What it holds.
    pub holds: Quantity,
    /// What it moves.
    pub moves: Moves,
    /// How it answers.
    pub controller: Controller,
    /// How the controller counts.
    pub units: Units,
    /// What measures what it holds; without one it is seen as it is.
    pub sensor: Option<Sensor>,
}

impl OuterLoop {
    /// −1 where more of what is moved makes less of what is held.
    pub(crate) fn sign(&self) -> f64 {
        match (self.holds, self.moves) {
            (Quantity::Airspeed, Moves::Pitch | Moves::Loop(_)) => -1.0,
            _ => 1.0,
        }
    }
}
