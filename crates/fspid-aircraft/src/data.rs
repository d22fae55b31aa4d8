//! An aircraft as its source describes it, in SI units, before anything is made of it.

mod doubtful;
mod linear;
mod loading;
mod variations;

use std::fmt;
use std::sync::Arc;

use crate::aerodynamics::ForceModel;
use crate::aerodynamics::derivatives::{
    DerivativeModel, DragLaw, Geometry, Lateral, Longitudinal, ThrustLaw,
};
use crate::aircraft::Aircraft;
use crate::atmosphere::{Air, AirModel, Environment};
use crate::error::AircraftError;
use crate::mass::MassProperties;
use crate::validity::{Range, TableInput, Travel, Validity};
pub use linear::{LinearCondition, LinearData, LinearElevator, LinearState};
pub use loading::{Loading, Moment};
pub use variations::{GroundData, Variations};

/// What is known about an aircraft, and from where.
#[derive(Debug, Clone, PartialEq)]
pub struct AircraftData {
    /// Name in scenarios.
    pub name: String,
    /// What it is, in a line.
    pub title: String,
    /// Where the numbers come from.
    pub source: String,
    /// What else should be known.
    pub notes: String,
    /// The numbers.
    pub model: ModelData,
    /// What is added to them in flight; nothing where the numbers are no derivatives.
    pub variations: Variations,
}

/// How much of an aircraft its source tells.
#[derive(Debug, Clone, PartialEq)]
pub enum ModelData {
    /// Stability derivatives: it can be trimmed and flown around its reference.
    Derivatives(Box<DerivativeData>),
    /// A linear model at one condition, and nothing else.
    Linear(LinearData),
    /// Forces by any other model, such as tables: it can be trimmed and flown where they are valid.
    Forces(Box<ForceData>),
}

/// An aircraft described by a model of its forces.
#[derive(Clone)]
pub struct ForceData {
    /// Mass properties in the axes of the forces.
    pub mass: MassProperties,
    /// Lengths to which its source refers coefficients.
    pub geometry: Geometry,
    /// Gravity with which the source flies.
    pub gravity_m_s2: f64,
    /// Air of the source, the same everywhere, if it has one.
    pub air: Option<Air>,
    /// Forces; they say where they are valid and how far the controls go.
    pub forces: Arc<dyn ForceModel + Send + Sync>,
    /// What enters tables beside speed, Mach number, angles of the flow and altitude, and where it has data.
    pub table_inputs: Vec<(TableInput, Range)>,
    /// Sentences about what a flight leaves as the files have it.
    pub held: Vec<String>,
}

/// Forces are equal by being the same object.
impl PartialEq for ForceData {
    fn eq(&self, other: &Self) -> bool {
        let numbers = |data: &Self| (data.mass, data.geometry, data.gravity_m_s2, data.air);
        numbers(self) == numbers(other) && Arc::ptr_eq(&self.forces, &other.forces)
    }
}

impl fmt::Debug for ForceData {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mass, geometry, gravity_m_s2, air, .. } = self;
        let mut shown = formatter.debug_struct("ForceData");
        shown.field("mass", mass).field("geometry", geometry).field("gravity_m_s2", gravity_m_s2);
        shown.field("air", air);
        shown.finish_non_exhaustive()
    }
}

/// Flight condition to which derivatives belong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// True airspeed.
    pub airspeed_m_s: f64,
    /// Geopotential altitude.
    pub altitude_m: f64,
    /// Density of the air there.
    pub density_kg_m3: f64,
    /// Dynamic pressure as the source prints it; it may differ from that of density and airspeed in the last digit.
    pub dynamic_pressure_pa: f64,
    /// Mach number as the source prints it.
    pub mach: f64,
    /// Gravity with which the source makes masses of weights.
    pub gravity_m_s2: f64,
    /// Angle of attack of the fuselage there: between the axes of the inertia and those of the derivatives.
    pub alpha_rad: f64,
    /// Centre of gravity to which the moments belong, behind the leading edge of the mean chord as a share of it, if it is
    /// known.
    pub cg_mac: Option<f64>,
}

/// An aircraft described by derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DerivativeData {
    /// Flight condition.
    pub reference: Reference,
    /// Lengths.
    pub geometry: Geometry,
    /// Weight of the flight condition: what the lift of the reference carries, whatever flies.
    pub weight_n: f64,
    /// Moments of inertia of the flight condition, in fuselage axes.
    pub inertia: Inertia,
    /// How it is loaded where it flies otherwise than there.
    pub loading: Loading,
    /// Lift, drag, pitching moment; $C_{L_1}$ as the source prints it.
    pub longitudinal: Longitudinal,
    /// Side force, roll, yaw, if the source has them.
    pub lateral: Option<Lateral>,
    /// Where the derivatives are worth something.
    pub validity: Validity,
    /// Stops of the controls.
    pub travel: Travel,
}

/// Moments of inertia about the centre of gravity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia {
    /// About the forward axis.
    pub ix_kg_m2: f64,
    /// About the right axis.
    pub iy_kg_m2: f64,
    /// About the downward axis.
    pub iz_kg_m2: f64,
    /// Product of inertia.
    pub ixz_kg_m2: f64,
}

/// How an aircraft is to behave away from the flight condition of its data.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Laws {
    /// Drag by lift.
    pub drag: DragLaw,
    /// Thrust by speed.
    pub thrust: ThrustLaw,
}

impl AircraftData {
    /// The derivatives.
    ///
    /// # Errors
    /// An aircraft of which only a linear model is known, or forces by another model.
    pub fn derivatives(&self) -> Result<&DerivativeData, AircraftError> {
        match &self.model {
            ModelData::Derivatives(data) => Ok(data),
            ModelData::Linear(_) => Err(AircraftError::LinearOnly { name: self.name.clone() }),
            ModelData::Forces(_) => Err(AircraftError::NoDerivatives { name: self.name.clone() }),
        }
    }

    /// The aircraft with another loading. The centre of gravity of forces that are no derivatives is not moved here: it
    /// is where the forces were made for.
    ///
    /// # Errors
    /// [`AircraftError::FixedLoading`] for an aircraft of which only a linear model is known; as
    /// [`DerivativeData::loaded`]; mass properties that no body has.
    pub fn loaded(mut self, loading: Loading) -> Result<Self, AircraftError> {
        if loading.is_none() {
            return Ok(self);
        }
        let mass = match &mut self.model {
            ModelData::Linear(_) => return Err(AircraftError::FixedLoading { name: self.name }),
            ModelData::Derivatives(data) => {
                **data = data.loaded(loading)?;
                data.mass_properties()
            }
            ModelData::Forces(data) => {
                data.mass = loading.applied(data.mass);
                data.mass
            }
        };
        mass.validate()?;
        Ok(self)
    }

    /// Whether its motion to the side is known.
    #[must_use]
    pub fn has_lateral(&self) -> bool {
        match &self.model {
            ModelData::Derivatives(data) => data.lateral.is_some(),
            ModelData::Linear(_) => false,
            ModelData::Forces(_) => true,
        }
    }

    /// The standard atmosphere, with the gravity of the source where forces are known, else with standard gravity.
    #[must_use]
    pub fn standard_environment(&self) -> Environment {
        match &self.model {
            ModelData::Forces(data) => {
                Environment { gravity_m_s2: data.gravity_m_s2, air: AirModel::Standard }
            }
            _ => Environment::STANDARD,
        }
    }

    /// Density and gravity of the source, everywhere.
    ///
    /// # Errors
    /// An aircraft whose source has no such air.
    pub fn reference_environment(&self) -> Result<Environment, AircraftError> {
        match &self.model {
            ModelData::Forces(data) => {
                let air =
                    data.air.ok_or_else(|| AircraftError::NoAir { name: self.name.clone() })?;
                Ok(Environment { gravity_m_s2: data.gravity_m_s2, air: AirModel::Uniform(air) })
            }
            _ => Ok(self.derivatives()?.reference_environment()),
        }
    }

    /// An aircraft that can be trimmed and flown.
    ///
    /// # Errors
    /// As [`Self::derivatives`]; numbers that no aircraft has.
    pub fn aircraft(
        &self,
        laws: Laws,
        environment: Environment,
    ) -> Result<Aircraft<DerivativeModel>, AircraftError> {
        self.derivatives()?.aircraft(laws, environment)
    }
}

impl DerivativeData {
    /// Mass that flies: that of its loading, or that of the weight by the source's gravity.
    ///
    /// $$ m = W / g $$
    #[must_use]
    pub fn mass_kg(&self) -> f64 {
        self.loading.mass_kg.unwrap_or(self.weight_n / self.reference.gravity_m_s2)
    }

    /// Mass properties as loaded, in the stability axes of the reference.
    #[must_use]
    pub fn mass_properties(&self) -> MassProperties {
        let Inertia { ix_kg_m2, iy_kg_m2, iz_kg_m2, ixz_kg_m2 } = self.inertia;
        let mass = MassProperties {
            mass_kg: self.mass_kg(),
            ix_kg_m2,
            iy_kg_m2,
            iz_kg_m2,
            ixz_kg_m2,
            engine_kg_m2_s: 0.0,
        };
        self.loading.applied(mass).turned_nose_up(-self.reference.alpha_rad)
    }

    /// The reference as an environment: its gravity, and its density everywhere.
    ///
    /// In it the reference is an equilibrium exactly.
    #[must_use]
    pub fn reference_environment(&self) -> Environment {
        let Reference { density_kg_m3, airspeed_m_s, mach, gravity_m_s2, .. } = self.reference;
        let speed_of_sound_m_s = airspeed_m_s / mach;
        Environment::uniform(gravity_m_s2, density_kg_m3, speed_of_sound_m_s)
    }

    /// Dynamic pressure of the reference's density and airspeed.
    fn dynamic_pressure_pa(&self) -> f64 {
        let Reference { density_kg_m3, airspeed_m_s, .. } = self.reference;
        0.5 * density_kg_m3 * airspeed_m_s * airspeed_m_s
    }

    /// Forces, with the lift of the reference made equal to the weight of the reference so that this is an equilibrium.
    ///
    /// $$ C_{L_1} = \frac{W}{\bar q S}, \quad T_1 = \bar q S C_{D_1} $$
    ///
    /// A loading changes none of it, but for the moments about another centre of gravity ([`Longitudinal::moved`]).
    #[must_use]
    pub fn force_model(&self, laws: Laws) -> DerivativeModel {
        let scale_n = self.dynamic_pressure_pa() * self.geometry.area_m2;
        let mut longitudinal = self.longitudinal;
        longitudinal.lift.reference = self.weight_n / scale_n;
        let mut lateral = self.lateral.unwrap_or_default();
        let aft_chords = self.cg_aft_chords();
        if aft_chords != 0.0 {
            longitudinal = longitudinal.moved(aft_chords);
            lateral = lateral.moved(aft_chords, &self.geometry);
        }
        DerivativeModel {
            geometry: self.geometry,
            longitudinal,
            lateral,
            reference_airspeed_m_s: self.reference.airspeed_m_s,
            reference_thrust_n: scale_n * longitudinal.drag.reference,
            drag_law: laws.drag,
            thrust_law: laws.thrust,
            validity: self.validity,
            travel: self.travel,
        }
    }

    /// An aircraft that can be trimmed and flown.
    ///
    /// # Errors
    /// Numbers that no aircraft has.
    pub fn aircraft(
        &self,
        laws: Laws,
        environment: Environment,
    ) -> Result<Aircraft<DerivativeModel>, AircraftError> {
        self.validate()?;
        Aircraft::new(self.mass_properties(), self.force_model(laws), environment)
    }

    fn validate(&self) -> Result<(), AircraftError> {
        let Geometry { area_m2, span_m, chord_m } = self.geometry;
        let positive = [
            ("wing area in m²", area_m2),
            ("span in m", span_m),
            ("chord in m", chord_m),
            ("weight in N", self.weight_n),
            ("reference airspeed in m/s", self.reference.airspeed_m_s),
            ("reference density in kg/m³", self.reference.density_kg_m3),
            ("reference Mach number", self.reference.mach),
            ("reference gravity in m/s²", self.reference.gravity_m_s2),
        ];
        positive
            .into_iter()
            .try_for_each(|(what, value)| AircraftError::unless_positive(what, value))
    }
}
