//! What a source says of an aircraft beyond its one flight condition: configurations, Mach numbers, the ground.

use super::{DerivativeData, Laws, Loading};
use crate::aerodynamics::derivatives::DerivativeModel;
use crate::aerodynamics::ground_effect::GroundEffect;
use crate::aerodynamics::increment::Configuration;
use crate::aerodynamics::mach_table::MachTable;
use crate::aerodynamics::varied::{Deployed, FlowEffects, VariedModel};
use crate::error::AircraftError;

/// What can be added to derivatives.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Variations {
    /// What can be extended.
    pub configurations: Vec<Configuration>,
    /// By Mach number.
    pub mach: Option<MachTable>,
    /// Near the ground.
    pub ground: Option<GroundData>,
}

/// What the ground's effect needs to know of an aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundData {
    /// Height of the wing above the ground when the aircraft's altitude is that of the ground, m.
    pub wing_height_m: f64,
    /// $k$ of $C_D = C_{D_0} + k C_L^2$; that of the derivatives where nobody says.
    pub induced_drag_factor: Option<f64>,
}

impl DerivativeData {
    /// The forces with everything that is added to them, over a ground if there is an effect of it.
    ///
    /// # Errors
    /// As [`GroundEffect::new`] and [`VariedModel::new`].
    pub fn varied_model(
        &self,
        laws: Laws,
        deployed: Vec<Deployed>,
        (mach, ground): (Option<MachTable>, Option<(GroundData, f64)>),
    ) -> Result<VariedModel, AircraftError> {
        let about_own = Self { loading: Loading { cg_mac: None, ..self.loading }, ..*self };
        let base = about_own.force_model(laws);
        let ground = match ground {
            Some((data, altitude_m)) => Some(data.effect(&base, altitude_m)?),
            None => None,
        };
        VariedModel::new(base, self.cg_aft_chords(), deployed, FlowEffects { mach, ground })
    }
}

impl GroundData {
    /// The effect on a model over a ground at an altitude, m.
    fn effect(
        &self,
        model: &DerivativeModel,
        altitude_m: f64,
    ) -> Result<GroundEffect, AircraftError> {
        let factor = self.induced_drag_factor.unwrap_or_else(|| induced_drag_factor(model));
        GroundEffect::new(model.geometry.span_m, self.wing_height_m, altitude_m, factor)
    }
}

/// $k$ of the parabola with the tangent of the reference, $2 k C_{L_1} C_{L_\alpha} = C_{D_\alpha}$.
fn induced_drag_factor(model: &DerivativeModel) -> f64 {
    let (lift, drag) = (&model.longitudinal.lift, &model.longitudinal.drag);
    drag.alpha / (2.0 * lift.reference * lift.alpha)
}
