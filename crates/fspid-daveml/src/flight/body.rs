//! Mass properties from a model.

use fspid_aircraft::{MassProperties, Vector3};

use crate::flight::error::FlightError;
use crate::flight::port;
use crate::flight::quantity::output_factor;
use crate::model::{Model, Port};

/// A body and where its centre of mass is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Mass and moments of inertia.
    pub mass: MassProperties,
    /// Position of the centre of mass from the moment reference centre: forward, right, down.
    pub centre_of_mass_m: Vector3,
}

/// Input that places the centre of mass along the mean chord.
const CENTRE: &str = "vrsPositionOfCM";

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
    /// Body of a model of mass properties with the centre of mass at a place in percent of the mean chord, or where the
    /// model has it; other inputs keep the initial value of their file.
    ///
    /// # Errors
    /// As [`Self::of`]; a place for a model that has no `vrsPositionOfCM`; another input without an initial value.
    pub fn placed(
        model: &Model,
        centre_of_mass_pct: Option<f64>,
        engine_kg_m2_s: f64,
    ) -> Result<Self, FlightError> {
        if centre_of_mass_pct.is_some() && !model.inputs().any(is_centre) {
            return Err(FlightError::NoInput { name: CENTRE });
        }
        let inputs = model.inputs().map(|port| input(port, centre_of_mass_pct));
        Self::of(model, &inputs.collect::<Result<Vec<_>, _>>()?, engine_kg_m2_s)
    }

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

fn is_centre(port: &Port) -> bool {
    port.name.eq_ignore_ascii_case(CENTRE)
}

fn input(port: &Port, centre_of_mass_pct: Option<f64>) -> Result<f64, FlightError> {
    match (centre_of_mass_pct.filter(|_| is_centre(port)), port.initial) {
        (Some(place_pct), _) => Ok(place_pct * (0.01 / output_factor(port)?)),
        (None, Some(value)) => Ok(value),
        (None, None) => {
            Err(FlightError::Input { name: port.name.clone(), known: CENTRE.to_owned() })
        }
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
