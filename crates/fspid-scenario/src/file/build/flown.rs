//! What is flown, and how.

use fspid_aircraft::data::{DerivativeData, Laws};
use fspid_aircraft::{Environment, TrimTarget};
use fspid_sim::{Course, Plant};

/// A plant and what the air around it depends on.
pub(super) struct Flown {
    pub(super) plant: Plant,
    /// Where it flies, and its span; for an aircraft.
    pub(super) way: Option<Way>,
    /// What an aircraft of derivatives is made of, where nothing is added to them.
    pub(super) derivatives: Option<FlownDerivatives>,
}

/// A straight flight of an aircraft of derivatives: what its plant is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct FlownDerivatives {
    /// The aircraft, as it is loaded.
    pub data: DerivativeData,
    /// Drag and thrust away from the reference.
    pub laws: Laws,
    /// Gravity and air.
    pub environment: Environment,
    /// Speed, altitude and climb.
    pub target: TrimTarget,
}

/// The way of an aircraft.
#[derive(Clone, Copy)]
pub(super) struct Way {
    pub(super) course: Course,
    /// `None` where the aircraft's file has none.
    pub(super) span_m: Option<f64>,
    pub(super) gravity_m_s2: f64,
    /// Of the trim, above sea level.
    pub(super) altitude_m: f64,
    /// At the trim, before any wind.
    pub(super) dynamic_pressure_pa: f64,
    /// Whether airspeed and altitude are the scenario's alone, since the aircraft's file has no condition.
    pub(super) assumed: bool,
}
