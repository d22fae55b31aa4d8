//! Models of tables as an aircraft that flies: the names of the standard tied to the forces of `fspid-aircraft`.
//!
//! Aerodynamic coefficients, an engine and mass properties come as models with variables named by S-119; units are read
//! from the variables. Everything is turned into SI here, once.

mod body;
mod engine;
mod error;
mod port;
mod quantity;

use fspid_aircraft::aerodynamics::derivatives::Geometry;
use fspid_aircraft::{
    Controls, Flow, ForceModel, Loads, Quantity as Limit, Range, Travel, Validity, Vector3,
};

pub use body::Body;
pub use engine::{Gearing, power_rate_per_s};
pub use error::FlightError;

use crate::model::Model;
use port::{Answers, Wiring};
use quantity::{Quantities, Quantity};

/// Forces and moments from tables.
#[derive(Clone, Debug)]
pub struct TableForces {
    aerodynamics: Wired<6>,
    engine: Option<Wired<6>>,
    reference: Geometry,
    setting: Setting,
    validity: Validity,
}

/// What models of tables do not say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Position of the centre of mass from the moment reference centre: forward, right, down.
    pub centre_of_mass_m: Vector3,
    /// What the throttle does to the engine's power.
    pub gearing: Gearing,
    /// Stops of the controls.
    pub travel: Travel,
}

/// A model with its inputs tied to a flight and some of its outputs in SI.
#[derive(Clone, Debug)]
struct Wired<const N: usize> {
    model: Model,
    inputs: Wiring,
    answers: Answers<N>,
}

const COEFFICIENTS: [&str; 6] = [
    "aeroBodyForceCoefficient_X",
    "aeroBodyForceCoefficient_Y",
    "aeroBodyForceCoefficient_Z",
    "aeroBodyMomentCoefficient_Roll",
    "aeroBodyMomentCoefficient_Pitch",
    "aeroBodyMomentCoefficient_Yaw",
];

const REFERENCE: [&str; 3] = ["referenceWingArea", "referenceWingSpan", "referenceWingChord"];

const THRUST: [&str; 6] = [
    "thrustBodyForce_X",
    "thrustBodyForce_Y",
    "thrustBodyForce_Z",
    "thrustBodyMoment_Roll",
    "thrustBodyMoment_Pitch",
    "thrustBodyMoment_Yaw",
];

impl TableForces {
    /// Forces of an aerodynamic model, which also says the reference area, span and chord, and of an engine.
    ///
    /// Inputs with names that a flight does not have keep the initial value of their file.
    ///
    /// # Errors
    /// An input that a flight does not have and that has no initial value; an output that is missing; units that are not
    /// known; too many inputs or outputs.
    pub fn new(
        aerodynamics: Model,
        engine: Option<Model>,
        setting: Setting,
    ) -> Result<Self, FlightError> {
        let [area_m2, span_m, chord_m] = port::constants(&aerodynamics, &REFERENCE)?;
        let mut validity = Validity::EVERYWHERE;
        for model in core::iter::once(&aerodynamics).chain(&engine) {
            narrow(&mut validity, model)?;
        }
        Ok(Self {
            aerodynamics: Wired::new(aerodynamics, &COEFFICIENTS)?,
            engine: engine.map(|engine| Wired::new(engine, &THRUST)).transpose()?,
            reference: Geometry { area_m2, span_m, chord_m },
            setting,
            validity,
        })
    }

    /// Area, span and chord that make forces and moments of coefficients.
    #[must_use]
    pub fn geometry(&self) -> Geometry {
        self.reference
    }

    /// Loads of the air about the moment reference centre.
    ///
    /// $$ F = \bar q S\, C_F, \quad M = \bar q S\,(b\, C_l,\ \bar c\, C_m,\ b\, C_n) $$
    fn air(&self, quantities: &Quantities, dynamic_pressure_pa: f64) -> Loads {
        let [x, y, z, roll, pitch, yaw] = self.aerodynamics.answer(quantities);
        let Geometry { area_m2, span_m, chord_m } = self.reference;
        let scale_n = dynamic_pressure_pa * area_m2;
        Loads {
            force_n: scale_n * Vector3::new(x, y, z),
            moment_n_m: scale_n * Vector3::new(span_m * roll, chord_m * pitch, span_m * yaw),
        }
    }

    fn thrust(&self, quantities: &Quantities) -> Loads {
        let answer = self.engine.as_ref().map(|engine| engine.answer(quantities));
        let [x, y, z, roll, pitch, yaw] = answer.unwrap_or_default();
        Loads { force_n: Vector3::new(x, y, z), moment_n_m: Vector3::new(roll, pitch, yaw) }
    }

    fn quantities(&self, flow: &Flow, controls: &Controls) -> Quantities {
        Quantities::of(flow, controls, self.setting.gearing.power(controls.throttle))
    }
}

impl<const N: usize> Wired<N> {
    fn new(model: Model, outputs: &[&'static str; N]) -> Result<Self, FlightError> {
        let inputs = Wiring::of(&model)?;
        let answers = Answers::of(&model, outputs)?;
        Ok(Self { model, inputs, answers })
    }

    fn answer(&self, quantities: &Quantities) -> [f64; N] {
        self.answers.read(&self.model, &self.inputs, quantities)
    }
}

impl ForceModel for TableForces {
    /// Loads about the centre of mass, which is at $d$ from the moment reference centre.
    ///
    /// $$ M_{cm} = M - d \times F $$
    fn loads(&self, flow: &Flow, controls: &Controls) -> Loads {
        let quantities = self.quantities(flow, controls);
        let air = self.air(&quantities, flow.dynamic_pressure_pa());
        let Loads { force_n, moment_n_m } = air.plus(self.thrust(&quantities));
        let moment_n_m = moment_n_m - self.setting.centre_of_mass_m.cross(force_n);
        Loads { force_n, moment_n_m }
    }

    fn thrust_n(&self, flow: &Flow, controls: &Controls) -> f64 {
        self.thrust(&self.quantities(flow, controls)).force_n.x
    }

    fn validity(&self) -> &Validity {
        &self.validity
    }

    fn travel(&self) -> &Travel {
        &self.setting.travel
    }
}

/// Narrows the box of a flight to the tables of a model.
fn narrow(validity: &mut Validity, model: &Model) -> Result<(), FlightError> {
    for bounds in model.bounds() {
        let port = model.variables().get(bounds.variable);
        let Some((port, quantity)) =
            port.and_then(|port| Some((port, Quantity::named(&port.name)?)))
        else {
            continue;
        };
        let factor = quantity.factor(port)?;
        let range = match quantity.limit() {
            Some(Limit::Airspeed) => &mut validity.airspeed_m_s,
            Some(Limit::Mach) => &mut validity.mach,
            Some(Limit::Alpha) => &mut validity.alpha_rad,
            Some(Limit::Beta) => &mut validity.beta_rad,
            Some(Limit::Altitude) => &mut validity.altitude_m,
            _ => continue,
        };
        *range = Range {
            min: range.min.max(bounds.min * factor),
            max: range.max.min(bounds.max * factor),
        };
    }
    Ok(())
}
