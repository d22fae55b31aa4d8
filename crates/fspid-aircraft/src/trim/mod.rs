//! Straight flight at constant speed: which angle of attack, elevator and throttle hold it, or what stands in the way.
//!
//! Wings level, no sideslip, aileron and rudder at rest: for an aircraft that is balanced sideways so; any other is refused. Not for
//! turns.

mod held;
mod search;

use std::fmt;

use thiserror::Error;

use crate::aerodynamics::ForceModel;
use crate::aircraft::Aircraft;
use crate::controls::Controls;
use crate::flow::AirMotion;
use crate::quaternion::{EulerAngles, Quaternion};
use crate::rigid_body::RigidState;
use crate::validity::{Departure, Range, Travel};
use crate::vector::Vector3;
use search::Search;

pub use held::{Held, Path, Power};

/// Largest acceleration left in a trim: 10⁻⁹ ft/s².
pub const ACCELERATION_LEFT_M_S2: f64 = 3.048e-10;

/// Steepest glide that is looked for, rad.
const STEEPEST: Range = Range { min: -1.5, max: 1.5 };

/// Largest angular acceleration left in a trim.
pub const ANGULAR_ACCELERATION_LEFT_RAD_S2: f64 = 1e-9;

/// Largest acceleration to the side of an aircraft that is balanced so (assumption A39): what a bank of 0.006 deg does.
pub const SIDE_ACCELERATION_LEFT_M_S2: f64 = 1e-3;

/// Largest angular acceleration in roll and yaw of such an aircraft: what 0.006 deg do of a control whose effectiveness is 1 rad/s² per
/// radian.
pub const SIDE_ANGULAR_ACCELERATION_LEFT_RAD_S2: f64 = 1e-4;

/// Flight that a trim is to hold, in still air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrimTarget {
    /// True airspeed.
    pub airspeed_m_s: f64,
    /// Geopotential altitude.
    pub altitude_m: f64,
    /// Angle of the flight path over the horizon, climbing positive.
    pub flight_path_rad: f64,
}

/// The three unknowns of a trim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrimPoint {
    /// Angle of attack.
    pub alpha_rad: f64,
    /// Elevator.
    pub elevator_rad: f64,
    /// Throttle, in the measure of the model.
    pub throttle: f64,
}

/// What keeps a point from being an equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrimResidual {
    /// Rate of u.
    pub forward_m_s2: f64,
    /// Rate of w.
    pub downward_m_s2: f64,
    /// Rate of q.
    pub pitch_rad_s2: f64,
    /// Rate of v, which no unknown of a trim changes.
    pub side_m_s2: f64,
    /// Rate of p, the same.
    pub roll_rad_s2: f64,
    /// Rate of r, the same.
    pub yaw_rad_s2: f64,
}

/// An equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trim {
    /// What was asked.
    pub target: TrimTarget,
    /// What holds it.
    pub point: TrimPoint,
    /// Thrust at it.
    pub thrust_n: f64,
    /// The state to start a flight from, heading north over the origin.
    pub state: RigidState,
    /// The controls to start with.
    pub controls: Controls,
    /// What is left of the accelerations.
    pub residual: TrimResidual,
    /// Newton steps taken.
    pub iterations: usize,
}

/// Why there is no trim.
#[derive(Debug, Clone, PartialEq, Error)]
pub struct TrimFailure {
    /// What was asked.
    pub target: TrimTarget,
    /// What stood in the way.
    pub reason: TrimObstacle,
    /// Limits that are left or met at the point; none where the forces alone have no equilibrium.
    pub limits: Vec<Departure>,
    /// How far the search came.
    pub point: TrimPoint,
    /// What is left of the accelerations there; apart, for a failure is moved about often.
    pub residual: Box<TrimResidual>,
    /// Newton steps taken.
    pub iterations: usize,
}

/// Kind of obstacle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrimObstacle {
    /// The point is an equilibrium, but beyond limits of the model or stops of the controls.
    BeyondLimits,
    /// No equilibrium was found, within limits or beyond.
    NoEquilibrium,
    /// Speed, height and pitch are held, and the aircraft is not balanced sideways with wings level, without sideslip and with aileron
    /// and rudder at rest.
    Sideways,
}

impl fmt::Display for TrimFailure {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let TrimTarget { airspeed_m_s, altitude_m, flight_path_rad } = self.target;
        write!(
            formatter,
            "no trim at {airspeed_m_s} m/s, {altitude_m} m, flight path {flight_path_rad} rad: "
        )?;
        match self.reason {
            TrimObstacle::BeyondLimits => write!(formatter, "it would take")?,
            TrimObstacle::Sideways => {
                let TrimResidual { side_m_s2, roll_rad_s2, yaw_rad_s2, .. } = *self.residual;
                write!(
                    formatter,
                    "not balanced sideways with aileron and rudder at rest: {side_m_s2:.3e} m/s² to the right, {roll_rad_s2:.3e} rad/s² in roll, {yaw_rad_s2:.3e} rad/s² in yaw at"
                )?;
            }
            TrimObstacle::NoEquilibrium => {
                let TrimResidual { forward_m_s2, downward_m_s2, pitch_rad_s2, .. } = *self.residual;
                write!(
                    formatter,
                    "no equilibrium; nearest has {forward_m_s2:.3e} m/s² forward, {downward_m_s2:.3e} m/s² down, {pitch_rad_s2:.3e} rad/s² in pitch at"
                )?;
            }
        }
        self.limits.iter().enumerate().try_for_each(|(index, limit)| {
            let separator = if index == 0 { "" } else { ";" };
            write!(formatter, "{separator} {limit}")
        })?;
        if self.limits.is_empty() {
            write!(formatter, " angle of attack {} rad", self.point.alpha_rad)
        } else {
            Ok(())
        }
    }
}

impl TrimTarget {
    /// State of a flight at the target with an angle of attack.
    ///
    /// $$ \theta = \alpha + \gamma $$
    #[must_use]
    pub fn state(&self, alpha_rad: f64) -> RigidState {
        let theta_rad = alpha_rad + self.flight_path_rad;
        let (sin, cos) = libm::sincos(alpha_rad);
        RigidState {
            position_ned_m: Vector3::new(0.0, 0.0, -self.altitude_m),
            velocity_body_m_s: self.airspeed_m_s * Vector3::new(cos, 0.0, sin),
            attitude: Quaternion::from_euler(EulerAngles { theta_rad, ..EulerAngles::default() }),
            rates_rad_s: Vector3::ZERO,
        }
    }
}

impl TrimPoint {
    fn controls(&self) -> Controls {
        let Self { elevator_rad, throttle, .. } = *self;
        Controls { elevator_rad, throttle, ..Controls::default() }
    }

    fn from_array([alpha_rad, elevator_rad, throttle]: [f64; 3]) -> Self {
        Self { alpha_rad, elevator_rad, throttle }
    }

    fn to_array(self) -> [f64; 3] {
        [self.alpha_rad, self.elevator_rad, self.throttle]
    }
}

impl TrimResidual {
    /// Size in multiples of what is accepted; a NaN counts as infinite.
    fn size(&self) -> f64 {
        let Self { forward_m_s2, downward_m_s2, pitch_rad_s2, .. } = self;
        let along = forward_m_s2.abs().max(downward_m_s2.abs()) / ACCELERATION_LEFT_M_S2;
        let size = along.max(pitch_rad_s2.abs() / ANGULAR_ACCELERATION_LEFT_RAD_S2);
        let sum = forward_m_s2 + downward_m_s2 + pitch_rad_s2;
        if sum.is_nan() { f64::INFINITY } else { size }
    }

    fn accepted(&self) -> bool {
        self.size() <= 1.0
    }

    /// True where nothing is left sideways; written so that NaN is not.
    fn is_balanced_sideways(&self) -> bool {
        let Self { side_m_s2, roll_rad_s2, yaw_rad_s2, .. } = self;
        side_m_s2.abs() <= SIDE_ACCELERATION_LEFT_M_S2
            && [roll_rad_s2, yaw_rad_s2]
                .iter()
                .all(|rate| rate.abs() <= SIDE_ANGULAR_ACCELERATION_LEFT_RAD_S2)
    }

    fn to_array(self) -> [f64; 3] {
        [self.forward_m_s2, self.downward_m_s2, self.pitch_rad_s2]
    }
}

impl<M: ForceModel> Aircraft<M> {
    /// Trim for straight flight; without an engine a steady glide at the target's speed, whose path is found and stands in
    /// [`Trim::target`].
    ///
    /// Newton's method with central differences on $\dot u, \dot w, \dot q$ as functions of angle of attack, elevator
    /// and throttle; steps are shortened until they help. It is tried within all limits first. If that fails, it is
    /// tried without limits, to say what the flight would take.
    ///
    /// # Errors
    /// A flight that cannot be held, with the limits in its way and the nearest point found.
    pub fn trim(&self, target: TrimTarget) -> Result<Trim, TrimFailure> {
        let within = self.search(target, self.trim_limits());
        let departures = |found: &Search| self.trim_departures(found.target, &found.point);
        if within.residual.accepted() && departures(&within).is_empty() {
            return self.balanced(within);
        }
        let beyond = self.search(target, [Range::ALL; 3]);
        let limits = departures(&beyond);
        match (beyond.residual.accepted(), limits.is_empty()) {
            (true, true) => self.balanced(beyond),
            (true, false) => Err(failure(TrimObstacle::BeyondLimits, limits, beyond)),
            (false, _) => {
                let limits = self.trim_stops(within.target, &within.point);
                Err(failure(TrimObstacle::NoEquilibrium, limits, within))
            }
        }
    }

    /// The trim at an equilibrium of speed, height and pitch that is one of the whole aircraft.
    fn balanced(&self, found: Search) -> Result<Trim, TrimFailure> {
        match found.residual.is_balanced_sideways() {
            true => Ok(self.trim_at(found)),
            false => Err(failure(TrimObstacle::Sideways, Vec::new(), found)),
        }
    }

    /// What is left of the accelerations at a point.
    #[must_use]
    pub fn trim_residual(&self, target: TrimTarget, point: TrimPoint) -> TrimResidual {
        let state = target.state(point.alpha_rad);
        let instant = self.instant(&state, &point.controls(), &AirMotion::STILL);
        let (along, angular) =
            (instant.accelerations.velocity_rate_body_m_s2, instant.accelerations.angular_rad_s2);
        TrimResidual {
            forward_m_s2: along.x,
            downward_m_s2: along.z,
            pitch_rad_s2: angular.y,
            side_m_s2: along.y,
            roll_rad_s2: angular.x,
            yaw_rad_s2: angular.z,
        }
    }

    fn trim_limits(&self) -> [Range; 3] {
        let Travel { elevator_rad, throttle, .. } = *self.model().travel();
        let third = if self.model().has_engine() { throttle } else { STEEPEST };
        [self.model().validity().alpha_rad, elevator_rad, third]
    }

    /// Limits of flow, controls and data that a point is beyond.
    fn trim_departures(&self, target: TrimTarget, point: &TrimPoint) -> Vec<Departure> {
        let flow = self.flow(&target.state(point.alpha_rad), &AirMotion::STILL);
        let (model, controls) = (self.model(), point.controls());
        let stops = model.travel().departures(&controls);
        let data = model.beyond_data(&flow, &controls);
        model.validity().departures(&flow).chain(stops).chain(data).collect()
    }

    /// Limits that a point within them rests on, after those that it is beyond.
    fn trim_stops(&self, target: TrimTarget, point: &TrimPoint) -> Vec<Departure> {
        use crate::validity::Quantity::{Alpha, Elevator, Throttle};
        let mut limits = self.trim_departures(target, point);
        let values = [Alpha, Elevator, Throttle].into_iter().zip(point.to_array());
        let unknowns = if self.model().has_engine() { 3 } else { 2 };
        for ((quantity, value), allowed) in values.zip(self.trim_limits()).take(unknowns) {
            let stopped = value <= allowed.min || value >= allowed.max;
            if stopped && limits.iter().all(|limit| limit.quantity != quantity) {
                limits.push(Departure { quantity, value, allowed });
            }
        }
        limits
    }

    fn trim_at(&self, found: Search) -> Trim {
        let target = found.target;
        let state = target.state(found.point.alpha_rad);
        let controls = found.point.controls();
        let flow = self.flow(&state, &AirMotion::STILL);
        Trim {
            target,
            point: found.point,
            thrust_n: self.model().thrust_n(&flow, &controls),
            state,
            controls,
            residual: found.residual,
            iterations: found.iterations,
        }
    }
}

fn failure(reason: TrimObstacle, limits: Vec<Departure>, found: Search) -> TrimFailure {
    let Search { target, point, residual, iterations } = found;
    let residual = Box::new(residual);
    TrimFailure { target, reason, limits, point, residual, iterations }
}
