//! The two ways from one sample to the next: behind the servo of the paper, or behind an actuator.

use crate::actuated::{Actuated, ActuatedState, Held};
use crate::error::SimError;
use crate::propagator::{LinearStep, PlantState, Propagator};

/// A plant and what moves its elevator, discretised.
#[derive(Clone, Debug)]
pub(crate) enum Propagation {
    /// With the first-order servo, without gusts: the bits of stored results.
    Servo(Propagator),
    /// With an actuator and gusts.
    Actuated(Actuated),
}

/// Where plant and elevator are.
#[derive(Clone, Debug)]
pub(crate) enum Motion {
    Servo(PlantState),
    Actuated(ActuatedState),
}

impl Motion {
    pub(crate) fn theta_rad(&self) -> f64 {
        match self {
            Self::Servo(state) => state.theta_rad(),
            Self::Actuated(state) => state.theta_rad(),
        }
    }
}

/// Calls one function with the state that belongs to it. All stages of a flight are of one kind, so
/// that the other arm is never taken.
macro_rules! both {
    ($self:ident, $motion:ident, $propagation:ident, $state:ident => $call:expr, $other:expr) => {
        match ($self, $motion) {
            (Propagation::Servo($propagation), Motion::Servo($state)) => $call,
            (Propagation::Actuated($propagation), Motion::Actuated($state)) => $call,
            _ => $other,
        }
    };
}

impl Propagation {
    pub(crate) fn at_rest(&self) -> Motion {
        match self {
            Self::Servo(propagator) => Motion::Servo(PlantState::at_rest(propagator.order())),
            Self::Actuated(actuated) => Motion::Actuated(actuated.at_rest()),
        }
    }

    /// Pitch rate just before a sample, rad/s.
    pub(crate) fn rate_rad_s(&self, motion: &Motion, disturbance_rad: f64) -> f64 {
        both!(self, motion, it, state => it.rate_rad_s(state, disturbance_rad), 0.0)
    }

    /// Elevator in the plant's own sign, disturbance included, rad.
    pub(crate) fn elevator_rad(&self, motion: &Motion, disturbance_rad: f64) -> f64 {
        both!(self, motion, it, state => it.elevator_rad(state, disturbance_rad), 0.0)
    }

    /// Moves what has no lag to its command at once.
    pub(crate) fn settle(&self, motion: &mut Motion, command_rad: f64) {
        match (self, motion) {
            (Self::Servo(it), Motion::Servo(state)) => it.settle_ideal_servo(state, command_rad),
            (Self::Actuated(it), Motion::Actuated(state)) => it.settle(state, command_rad),
            _ => {}
        }
    }

    /// One sample period with everything held.
    pub(crate) fn advance(
        &self,
        motion: &mut Motion,
        command_rad: f64,
        held: &Held,
    ) -> Result<(), SimError> {
        match (self, motion) {
            (Self::Servo(it), Motion::Servo(state)) => {
                it.advance(state, command_rad, held.elevator_rad)?;
            }
            (Self::Actuated(it), Motion::Actuated(state)) => it.advance(state, command_rad, held),
            _ => {}
        }
        Ok(())
    }

    pub(crate) fn linear_step(&self) -> LinearStep {
        match self {
            Self::Servo(it) => it.linear_step(),
            Self::Actuated(it) => it.linear_step(),
        }
    }
}
