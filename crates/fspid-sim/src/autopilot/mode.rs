//! Modes: what is engaged, and from when.

use super::quantity::Quantity;
use super::{Autopilot, Moves};

/// Target of an engaged loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// What there was when it became engaged; over modes in which it stays engaged the same.
    Hold,
    /// This value, in SI units.
    Value(f64),
}

/// A quantity and its target in a mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Engagement {
    /// Which.
    pub quantity: Quantity,
    /// Its target, in SI units.
    pub target: f64,
}

/// On which side of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// At or above it.
    Above,
    /// At or below it.
    Below,
}

/// Engagement condition of a mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// Which quantity.
    pub quantity: Quantity,
    /// On which side.
    pub side: Side,
    /// Of what, in SI units.
    pub value: f64,
}

impl Condition {
    /// True where the quantity has that value.
    pub(crate) fn is_met(&self, found: f64) -> bool {
        match self.side {
            Side::Above => found >= self.value,
            Side::Below => found <= self.value,
        }
    }
}

/// When a mode begins: not before a time, and when all conditions are met. The first mode begins with the flight.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Entry {
    /// Not before this time of the flight, s.
    pub at_s: f64,
    /// What has to be so.
    pub conditions: Vec<Condition>,
}

/// A mode of the autopilot.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Name, unique among the modes.
    pub name: String,
    /// When it begins, at the earliest one sample after the mode before it.
    pub entry: Entry,
    /// Numbers of the loops that are engaged.
    pub engaged: Vec<usize>,
    /// True if the loop for altitude and airspeed together is engaged.
    pub total_energy: bool,
    /// What is held; an engaged quantity without an entry is held as it is.
    pub targets: Vec<Engagement>,
    /// The bank that is flown while no loop moves it, rad.
    pub bank_rad: f64,
}

impl Mode {
    /// True for a loop whose target an engaged loop moves.
    pub(crate) fn moves_target(&self, autopilot: &Autopilot, number: usize) -> bool {
        let mut movers = self.engaged.iter().filter_map(|&other| autopilot.loops.get(other));
        movers.any(|other| other.moves == Moves::Loop(number))
    }

    /// The target of a quantity.
    pub(crate) fn target(&self, quantity: Quantity) -> Target {
        let found = self.targets.iter().find(|engagement| engagement.quantity == quantity);
        found.map_or(Target::Hold, |engagement| Target::Value(engagement.target))
    }
}
