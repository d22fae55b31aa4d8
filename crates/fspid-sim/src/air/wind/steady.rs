//! Wind that is the same everywhere and always.

use fspid_fuzzy::membership::Param;

use super::{AirMotion, AirPlace, WindField, first, number};

/// A steady wind with its vertical part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steady {
    /// Velocity of the air along north, east, down, m/s.
    pub earth_m_s: [f64; 3],
}

impl WindField for Steady {
    const NAME: &'static str = "steady";
    const PARAMS: &'static [Param] =
        &[number("north", "m/s"), number("east", "m/s"), number("down", "m/s")];
    const EXAMPLE: &'static [f64] = &[-8.0, 3.0, 0.0];

    fn from_checked(params: &[f64]) -> Self {
        Self { earth_m_s: first(params) }
    }

    fn at(&self, _: &AirPlace) -> AirMotion {
        AirMotion { earth_m_s: self.earth_m_s, ..AirMotion::default() }
    }
}
