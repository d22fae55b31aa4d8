//! What is flown, and how.

use fspid_sim::{Course, Plant};

/// A plant and what the air around it depends on.
pub(super) struct Flown {
    pub(super) plant: Plant,
    /// Where it flies, and its span; for an aircraft.
    pub(super) way: Option<Way>,
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
