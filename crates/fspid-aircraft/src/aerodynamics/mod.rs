//! Forces and moments on an aircraft: the place where a model of another kind is plugged in.

pub mod derivatives;
pub mod ground_effect;
pub mod increment;
pub mod mach_table;
pub mod varied;

use crate::controls::Controls;
use crate::engine::Gearing;
use crate::flow::Flow;
use crate::validity::{Departure, Travel, Validity};
use crate::vector::Vector3;

/// Force and moment about the centre of gravity in body axes, of air and engine together, without weight.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Loads {
    /// Force: forward, right, down.
    pub force_n: Vector3,
    /// Moment: roll right, pitch up, yaw right.
    pub moment_n_m: Vector3,
}

impl Loads {
    /// These loads and others together.
    #[inline(always)]
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            force_n: self.force_n + other.force_n,
            moment_n_m: self.moment_n_m + other.moment_n_m,
        }
    }

    /// These loads times a factor.
    #[inline(always)]
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { force_n: factor * self.force_n, moment_n_m: factor * self.moment_n_m }
    }
}

/// A model of the forces on an aircraft.
///
/// A model answers everywhere, beyond its limits too: it extrapolates or holds the last entry, and [`Validity`] says
/// that it did. It has no memory; an engine or a wake with a lag brings its state in the controls.
///
/// # Example
/// A ball with drag, let fall for ten seconds:
/// ```
/// use fspid_aircraft::{
///     AircraftError, AirMotion, Aircraft, Controls, Environment, Flow, ForceModel, Loads, MassProperties, RigidState,
///     Travel, Validity, Vector3,
/// };
///
/// struct Ball {
///     drag_area_m2: f64,
/// }
///
/// impl ForceModel for Ball {
///     fn loads(&self, flow: &Flow, _: &Controls) -> Loads {
///         let drag_n_s_m = 0.5 * flow.air.density_kg_m3 * flow.airspeed_m_s * self.drag_area_m2;
///         Loads { force_n: -drag_n_s_m * flow.velocity_body_m_s, moment_n_m: Vector3::ZERO }
///     }
///
///     fn thrust_n(&self, _: &Flow, _: &Controls) -> f64 {
///         0.0
///     }
///
///     fn validity(&self) -> &Validity {
///         &Validity::EVERYWHERE
///     }
///
///     fn travel(&self) -> &Travel {
///         &Travel::UNLIMITED
///     }
/// }
///
/// # fn main() -> Result<(), AircraftError> {
/// let mass = MassProperties {
///     mass_kg: 7.0,
///     ix_kg_m2: 0.01,
///     iy_kg_m2: 0.01,
///     iz_kg_m2: 0.01,
///     ixz_kg_m2: 0.0,
///     engine_kg_m2_s: 0.0,
/// };
/// let ball = Aircraft::new(mass, Ball { drag_area_m2: 0.005 }, Environment::STANDARD)?;
/// let start = RigidState { position_ned_m: Vector3::new(0.0, 0.0, -1000.0), ..RigidState::AT_REST };
/// let end = (0..1000).fold(start, |state, _| {
///     ball.step(&state, &Controls::default(), &AirMotion::STILL, 0.01)
/// });
/// let fallen_m = 1000.0 - end.altitude_m();
/// assert!(fallen_m > 400.0 && fallen_m < 490.0);
/// # Ok(())
/// # }
/// ```
pub trait ForceModel {
    /// Loads in a flow with these controls, with the angle of attack at rest.
    fn loads(&self, flow: &Flow, controls: &Controls) -> Loads;

    /// What is added to the loads for each rad/s of the angle of attack's rate.
    ///
    /// The loads must be linear in that rate; so the equations of motion, which it makes implicit, are solved exactly.
    fn loads_per_alpha_rate(&self, _flow: &Flow) -> Loads {
        Loads::default()
    }

    /// Thrust in N that is part of the loads, for reports.
    fn thrust_n(&self, flow: &Flow, controls: &Controls) -> f64;

    /// Whether a throttle does anything: without an engine straight flight is a glide, whose path follows from it.
    fn has_engine(&self) -> bool {
        true
    }

    /// What its throttle does to the power of its engine.
    fn gearing(&self) -> Gearing {
        Gearing::Proportional
    }

    /// Flow in which the model is worth something.
    fn validity(&self) -> &Validity;

    /// How far the controls go.
    fn travel(&self) -> &Travel;

    /// Data that are read beyond their ends although the flow is where the model is worth something: tables that are
    /// entered by the controls, by rates or by what is calculated.
    fn beyond_data(&self, _flow: &Flow, _controls: &Controls) -> Option<Departure> {
        None
    }

    /// The first limit by which flow or data are outside.
    fn departure(&self, flow: &Flow, controls: &Controls) -> Option<Departure> {
        self.validity().departure(flow).or_else(|| self.beyond_data(flow, controls))
    }
}

/// A pointer to a model is one: everything is asked of what it points to, so that nothing falls back on a default.
macro_rules! pointer {
    ($pointer:ty) => {
        impl<M: ForceModel + ?Sized> ForceModel for $pointer {
            fn loads(&self, flow: &Flow, controls: &Controls) -> Loads {
                (**self).loads(flow, controls)
            }

            fn loads_per_alpha_rate(&self, flow: &Flow) -> Loads {
                (**self).loads_per_alpha_rate(flow)
            }

            fn thrust_n(&self, flow: &Flow, controls: &Controls) -> f64 {
                (**self).thrust_n(flow, controls)
            }

            fn has_engine(&self) -> bool {
                (**self).has_engine()
            }

            fn gearing(&self) -> Gearing {
                (**self).gearing()
            }

            fn validity(&self) -> &Validity {
                (**self).validity()
            }

            fn travel(&self) -> &Travel {
                (**self).travel()
            }

            fn beyond_data(&self, flow: &Flow, controls: &Controls) -> Option<Departure> {
                (**self).beyond_data(flow, controls)
            }
        }
    };
}

pointer!(&M);
pointer!(Box<M>);
