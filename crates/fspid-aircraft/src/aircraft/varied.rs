//! Aircraft whose forces and body do not stay, at an instant of a flight.

use crate::aerodynamics::ForceModel;
use crate::aerodynamics::varied::{VariedModel, VariedNow};
use crate::aircraft::Aircraft;
use crate::fuel::FuelledBody;
use crate::mass::MassProperties;

impl VariedModel {
    /// An aircraft of this model at another instant: with other shares of the [configurations](Self::deployed), in their
    /// order, and, where it burns fuel, with what is left of it, kg.
    pub fn at<M: ForceModel>(
        &self,
        aircraft: &Aircraft<M>,
        shares: impl Iterator<Item = f64>,
        fuel: Option<(&FuelledBody, f64)>,
    ) -> Aircraft<VariedNow<'_>> {
        let (mass, moved_aft_m) = body(aircraft, fuel);
        aircraft.with_parts(mass, self.now_with(shares, moved_aft_m))
    }

    /// The same as the start of another flight: the [aircraft of an instant](Self::at) as a model and a body of their own.
    pub fn starting_at<M: ForceModel>(
        &self,
        aircraft: &Aircraft<M>,
        shares: impl Iterator<Item = f64>,
        fuel: Option<(&FuelledBody, f64)>,
    ) -> Aircraft<Self> {
        let (mass, moved_aft_m) = body(aircraft, fuel);
        aircraft.with_parts(mass, self.started_with(shares, moved_aft_m))
    }
}

/// Mass properties, and how far fuel that is gone has moved the centre of gravity aft, m.
fn body<M: ForceModel>(
    aircraft: &Aircraft<M>,
    fuel: Option<(&FuelledBody, f64)>,
) -> (MassProperties, f64) {
    match fuel {
        Some((body, fuel_kg)) => (body.with(fuel_kg), body.cg_aft_m(fuel_kg)),
        None => (*aircraft.mass(), 0.0),
    }
}
