//! Forces and moments on an aircraft: the place where a model of another kind is plugged in.

pub mod derivatives;

use crate::controls::Controls;
use crate::flow::Flow;
use crate::validity::{Travel, Validity};
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
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            force_n: self.force_n + other.force_n,
            moment_n_m: self.moment_n_m + other.moment_n_m,
        }
    }

    /// These loads times a factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { force_n: factor * self.force_n, moment_n_m: factor * self.moment_n_m }
    }
}

/// A model of the forces on an aircraft.
///
/// A model answers everywhere, beyond its limits too: it extrapolates or holds the last entry, and [`Validity`] says
/// that it did. It has no memory; an engine or a wake with a lag brings its state in the controls.
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

    /// Flow in which the model is worth something.
    fn validity(&self) -> &Validity;

    /// How far the controls go.
    fn travel(&self) -> &Travel;
}

impl<M: ForceModel + ?Sized> ForceModel for &M {
    fn loads(&self, flow: &Flow, controls: &Controls) -> Loads {
        (**self).loads(flow, controls)
    }

    fn loads_per_alpha_rate(&self, flow: &Flow) -> Loads {
        (**self).loads_per_alpha_rate(flow)
    }

    fn thrust_n(&self, flow: &Flow, controls: &Controls) -> f64 {
        (**self).thrust_n(flow, controls)
    }

    fn validity(&self) -> &Validity {
        (**self).validity()
    }

    fn travel(&self) -> &Travel {
        (**self).travel()
    }
}

impl<M: ForceModel + ?Sized> ForceModel for Box<M> {
    fn loads(&self, flow: &Flow, controls: &Controls) -> Loads {
        (**self).loads(flow, controls)
    }

    fn loads_per_alpha_rate(&self, flow: &Flow) -> Loads {
        (**self).loads_per_alpha_rate(flow)
    }

    fn thrust_n(&self, flow: &Flow, controls: &Controls) -> f64 {
        (**self).thrust_n(flow, controls)
    }

    fn validity(&self) -> &Validity {
        (**self).validity()
    }

    fn travel(&self) -> &Travel {
        (**self).travel()
    }
}
