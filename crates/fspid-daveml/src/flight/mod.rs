//! Models of tables as an aircraft that flies: the names of the standard bound to the forces of `fspid-aircraft`.
//!
//! Aerodynamic coefficients, an engine and mass properties come as models with variables named by S-119; units are read
//! from the variables. Everything is turned into SI here, once.

mod body;
mod error;
mod law;
mod port;
mod quantity;
mod rate;
mod sign;
mod watch;

use fspid_aircraft::aerodynamics::derivatives::Geometry;
use fspid_aircraft::{
    Controls, Departure, Flow, ForceModel, Gearing, Loads, Quantity as Limit, Range, TableInput,
    Travel, Validity, Vector3,
};

pub use body::Body;
pub use error::FlightError;
pub use law::{Control, ControlLaw, Heard, Wanted};

use crate::model::Model;
use port::{Answers, Wiring};
use quantity::{Quantities, Quantity};
use watch::Watch;

/// Forces and moments from tables.
#[derive(Clone, Debug)]
pub struct TableForces {
    aerodynamics: Wired<6>,
    /// True where the loads of the air depend on the rate of the angle of attack.
    by_alpha_rate: bool,
    axes: ForceAxes,
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

/// A model with its inputs bound to a flight and some of its outputs in SI.
#[derive(Clone, Debug)]
struct Wired<const N: usize> {
    model: Model,
    inputs: Wiring,
    answers: Answers<N>,
    /// What enters its tables and is not in the box of a flight.
    watched: Watch,
}

/// Along which axes a model has the coefficients of force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ForceAxes {
    /// Forward, right and down of the body.
    Body,
    /// Drag against the flow, side force to the right of the body, lift across the flow in the plane of symmetry.
    Wind,
}

const WIND_COEFFICIENTS: [&str; 6] = [
    "totalCoefficientOfDrag",
    "aeroBodyForceCoefficient_Y",
    "totalCoefficientOfLift",
    "aeroBodyMomentCoefficient_Roll",
    "aeroBodyMomentCoefficient_Pitch",
    "aeroBodyMomentCoefficient_Yaw",
];

const COEFFICIENTS: [&str; 6] = [
    "aeroBodyForceCoefficient_X",
    "aeroBodyForceCoefficient_Y",
    "aeroBodyForceCoefficient_Z",
    "aeroBodyMomentCoefficient_Roll",
    "aeroBodyMomentCoefficient_Pitch",
    "aeroBodyMomentCoefficient_Yaw",
];

const AREA: &str = "referenceWingArea";
const SPAN: &str = "referenceWingSpan";
const CHORD: &str = "referenceWingChord";

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
    /// known; too many inputs or outputs; coefficients that are not linear in the rate of the angle of attack.
    pub fn new(
        aerodynamics: Model,
        engine: Option<Model>,
        setting: Setting,
    ) -> Result<Self, FlightError> {
        let [_, _, _, roll, pitch, yaw] = COEFFICIENTS;
        let [area_m2] = port::constants(&aerodynamics, &[AREA])?;
        let span_m = length(&aerodynamics, SPAN, &[roll, yaw])?;
        let chord_m = length(&aerodynamics, CHORD, &[pitch])?;
        let axes = ForceAxes::of(&aerodynamics);
        let mut validity = Validity::EVERYWHERE;
        narrow(&mut validity, &aerodynamics)?;
        let by_alpha_rate = aerodynamics
            .inputs()
            .any(|port| Quantity::named(&port.name) == Some(Quantity::AlphaRate));
        let aerodynamics = Wired::new(aerodynamics, axes.coefficients())?;
        if by_alpha_rate {
            rate::linear(&aerodynamics, axes.coefficients(), (&validity, &setting.travel))?;
        }
        let reference = Geometry { area_m2, span_m, chord_m };
        let alone =
            Self { aerodynamics, by_alpha_rate, axes, engine: None, reference, setting, validity };
        match engine {
            Some(engine) => alone.with_engine(engine),
            None => Ok(alone),
        }
    }

    /// The same with an engine.
    ///
    /// # Errors
    /// Those of an engine in [`TableForces::new`].
    pub fn with_engine(mut self, engine: Model) -> Result<Self, FlightError> {
        narrow(&mut self.validity, &engine)?;
        self.engine = Some(Wired::new(engine, &THRUST)?);
        Ok(self)
    }

    /// Sentences about what a flight leaves as the file of the aerodynamics has it: inputs that it does not know.
    #[must_use]
    pub fn held_inputs(&self) -> Vec<String> {
        port::held(&self.aerodynamics.model, false)
    }

    /// The same of the engine's file.
    #[must_use]
    pub fn held_inputs_of_the_engine(&self) -> Vec<String> {
        self.engine.iter().flat_map(|engine| port::held(&engine.model, true)).collect()
    }

    /// Area, span and chord that make forces and moments of coefficients.
    #[must_use]
    pub fn geometry(&self) -> Geometry {
        self.reference
    }

    /// What enters tables beside the quantities of the box: controls, rates and what is calculated, each with the range in
    /// which its tables have values, in the unit of its file.
    #[must_use]
    pub fn table_inputs(&self) -> Vec<(TableInput, Range)> {
        let of_the_engine = self.engine.iter().flat_map(|engine| engine.watched.ranges());
        self.aerodynamics.watched.ranges().chain(of_the_engine).collect()
    }

    /// Loads of the air about the moment reference centre.
    ///
    /// $$ F = \bar q S C_F, \quad M = \bar q S (b C_l,\ \bar c C_m,\ b C_n) $$
    ///
    /// With lift and drag in place of X and Z, and $\hat v$ the direction of flight in body axes,
    ///
    /// $$ C_F = -C_D \hat v + C_L (\sin\alpha,\ 0,\ -\cos\alpha) + C_Y (0,\ 1,\ 0) $$
    fn air(&self, quantities: &Quantities, flow: &Flow) -> Loads {
        let [first, second, third, roll, pitch, yaw] = self.aerodynamics.answer(quantities);
        let Geometry { area_m2, span_m, chord_m } = self.reference;
        let scale_n = flow.dynamic_pressure_pa() * area_m2;
        let force = match self.axes {
            ForceAxes::Body => Vector3::new(first, second, third),
            ForceAxes::Wind => along_the_wind(flow, first, third) + Vector3::new(0.0, second, 0.0),
        };
        Loads {
            force_n: scale_n * force,
            moment_n_m: scale_n * Vector3::new(span_m * roll, chord_m * pitch, span_m * yaw),
        }
    }

    /// Loads about the centre of mass, of those about the moment reference centre.
    fn about_centre_of_mass(&self, loads: Loads) -> Loads {
        let Loads { force_n, moment_n_m } = loads;
        let moment_n_m = moment_n_m - self.setting.centre_of_mass_m.cross(force_n);
        Loads { force_n, moment_n_m }
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
        let watched = Watch::of(&model);
        Ok(Self { model, inputs, answers, watched })
    }

    fn beyond_data(&self, quantities: &Quantities) -> Option<Departure> {
        self.watched.departure(&self.model, &self.inputs, quantities)
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
        let air = self.air(&quantities, flow);
        self.about_centre_of_mass(air.plus(self.thrust(&quantities)))
    }

    /// Loads at 1 rad/s less those at rest, with the surfaces at 0: models are linear in `angleOfAttackRate`, and none of
    /// their surfaces is a factor of it, or they were refused.
    fn loads_per_alpha_rate(&self, flow: &Flow) -> Loads {
        if !self.by_alpha_rate {
            return Loads::default();
        }
        let at_rest = self.quantities(flow, &Controls::default());
        let moving = self.air(&at_rest.with_alpha_rate(1.0), flow);
        self.about_centre_of_mass(moving.plus(self.air(&at_rest, flow).scaled(-1.0)))
    }

    fn thrust_n(&self, flow: &Flow, controls: &Controls) -> f64 {
        self.thrust(&self.quantities(flow, controls)).force_n.x
    }

    fn has_engine(&self) -> bool {
        self.engine.is_some()
    }

    fn gearing(&self) -> Gearing {
        self.setting.gearing
    }

    fn validity(&self) -> &Validity {
        &self.validity
    }

    fn travel(&self) -> &Travel {
        &self.setting.travel
    }

    fn beyond_data(&self, flow: &Flow, controls: &Controls) -> Option<Departure> {
        let quantities = self.quantities(flow, controls);
        let of_the_engine =
            || self.engine.as_ref().and_then(|engine| engine.beyond_data(&quantities));
        self.aerodynamics.beyond_data(&quantities).or_else(of_the_engine)
    }
}

impl ForceAxes {
    /// The body's where a model has X and Z, lift and drag where it has these instead.
    fn of(model: &Model) -> Self {
        let has = |name: &str| model.outputs().any(|port| port.name == name);
        let [x, _, z, ..] = COEFFICIENTS;
        let [drag, _, lift, ..] = WIND_COEFFICIENTS;
        if !(has(x) || has(z)) && (has(drag) || has(lift)) { Self::Wind } else { Self::Body }
    }

    fn coefficients(self) -> &'static [&'static str; 6] {
        match self {
            Self::Body => &COEFFICIENTS,
            Self::Wind => &WIND_COEFFICIENTS,
        }
    }
}

/// Coefficients of drag and lift in body axes; none at rest.
fn along_the_wind(flow: &Flow, drag: f64, lift: f64) -> Vector3 {
    let Vector3 { x: u, z: w, .. } = flow.velocity_body_m_s;
    let in_plane_m_s = (u * u + w * w).sqrt();
    let per = |length_m_s: f64| if length_m_s > 0.0 { 1.0 / length_m_s } else { 0.0 };
    let (against, across) = (-drag * per(flow.airspeed_m_s), lift * per(in_plane_m_s));
    against * flow.velocity_body_m_s + across * Vector3::new(w, 0.0, -u)
}

/// A length of reference. It may be missing where every moment that it would make is 0 for good: it is 0 then.
fn length(model: &Model, name: &'static str, moments: &[&str]) -> Result<f64, FlightError> {
    match port::constants(model, &[name]) {
        Ok([length_m]) => Ok(length_m),
        Err(FlightError::Output { .. })
            if moments.iter().all(|moment| model.constant(moment) == Some(0.0)) =>
        {
            Ok(0.0)
        }
        Err(error) => Err(error),
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
        let [one, other] = [bounds.min, bounds.max].map(|end| end * factor);
        *range = Range { min: range.min.max(one.min(other)), max: range.max.min(one.max(other)) };
    }
    Ok(())
}
