//! Mass properties from a model.

use fspid_aircraft::{MassProperties, Vector3};

use crate::flight::error::FlightError;
use crate::flight::port;
use crate::model::Model;

/// A body and where its centre of mass is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Mass and moments of inertia.
    pub mass: MassProperties,
    /// Position of the centre of mass from the moment reference centre: forward, right, down.
    pub centre_of_mass_m: Vector3,
}

const NAMES: [&str; 8] = [
    "totalMass",
    "bodyMomentOfInertia_Roll",
    "bodyMomentOfInertia_Pitch",
    "bodyMomentOfInertia_Yaw",
    "bodyProductOfInertia_ZX",
    "bodyPositionOfCmWrtMrc_X",
    "bodyPositionOfCmWrtMrc_Y",
    "bodyPositionOfCmWrtMrc_Z",
];

impl Body {
    /// Body of a model of mass properties, at inputs in the order and units of the model.
    ///
    /// # Errors
    /// Outputs that are missing, units that are not known, products of inertia with the right axis, mass properties that
    /// no body has.
    pub fn of(model: &Model, inputs: &[f64], engine_kg_m2_s: f64) -> Result<Self, FlightError> {
        symmetric(model, inputs)?;
        let [mass_kg, ix_kg_m2, iy_kg_m2, iz_kg_m2, ixz_kg_m2, x, y, z] =
            port::outputs_at(model, &NAMES, inputs)?;
        let mass =
            MassProperties { mass_kg, ix_kg_m2, iy_kg_m2, iz_kg_m2, ixz_kg_m2, engine_kg_m2_s };
        mass.validate()?;
        Ok(Self { mass, centre_of_mass_m: Vector3::new(x, y, z) })
    }
}

/// Refuses products of inertia with the right axis that are not 0; a model may leave them out.
fn symmetric(model: &Model, inputs: &[f64]) -> Result<(), FlightError> {
    for name in ["bodyProductOfInertia_XY", "bodyProductOfInertia_YZ"] {
        let [value] = match port::outputs_at(model, &[name], inputs) {
            Err(FlightError::Output { .. }) => [0.0],
            answer => answer?,
        };
        if !(value.abs() <= 0.0) {
            return Err(FlightError::Lopsided { name, value_kg_m2: value });
        }
    }
    Ok(())
}
