//! A flown loop linearised along its way, with the derivatives of the gains.
//!
//! Frozen at the gains of a sample, a self-tuning loop is
//! $z_{k+1} = M(k_p, k_i, k_d) z_k$ for small changes. The gains of the sample come from the error and
//! its change, however, so that
//!
//! $$ J_k = M(k) + \frac{\partial z_{k+1}}{\partial k}
//! \left( \frac{\partial k}{\partial e} e^T + \frac{\partial k}{\partial \Delta e} \Delta e^T \right) $$
//!
//! with the rows $e^T$ and $\Delta e^T$ from the state to both, and through the integral's memory as
//! well; gains that accumulate are three states more. The slopes of the gains are exact derivatives of
//! the supervisor. Limits, dead zones, clamped inputs and held samples count as they act at the sample.
//!
//! # What this is worth
//! $J_k$ says what becomes of a small change along this one flight. Eigenvalues of single $J_k$ (as of
//! frozen $M$) tell of no stability while they change; the product of all of them, and its growth, is
//! what a small disturbance really does. It proves nothing of other flights.

mod controller;
mod gains;
mod growth;
#[cfg(test)]
mod tests;
mod walk;

use std::ops::ControlFlow;

use fspid_core::Gains;
use fspid_lti::{Matrix, spectral_radius};

use growth::Follower;
pub use growth::Growth;
use walk::walk;
pub use walk::{SmallSignal, walk_along};

use crate::controller::Controller;
use crate::error::SimError;
use crate::scenario::Scenario;
use crate::trace::Outcome;

/// A radius this close to 1 cannot be told from 1 after rounding, and a loop has states that stand
/// still: an integral whose command is cut, gains that accumulate.
const NEUTRAL: f64 = 1e-9;

/// A sample of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrajectoryPoint {
    /// Time, s.
    pub time_s: f64,
    /// Gains used.
    pub gains: Gains<f64>,
    /// Spectral radius with the gains frozen.
    pub frozen_radius: f64,
    /// Spectral radius with the derivatives of the gains.
    pub radius: f64,
    /// A limit or a held sample acts, as the radii have it.
    pub limited: bool,
}

/// The largest radius, and when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// Spectral radius.
    pub radius: f64,
    /// Time, s.
    pub time_s: f64,
}

/// A flight, linearised.
#[derive(Clone, Debug, PartialEq)]
pub struct TrajectoryLinearisation {
    /// Every so many samples.
    pub points: Vec<TrajectoryPoint>,
    /// Largest radius of frozen gains where nothing is limited; `None` where everything is.
    pub worst_frozen: Option<Worst>,
    /// Largest radius with the derivatives of the gains where nothing is limited.
    pub worst: Option<Worst>,
    /// Share of the points that are not limited and have a frozen radius above 1.
    pub frozen_above_one: f64,
    /// Share of the points that are not limited and have a radius above 1.
    pub above_one: f64,
    /// Share of the points that are limited.
    pub limited: f64,
    /// What a small disturbance does.
    pub growth: Growth,
    /// What the states are.
    pub states: Vec<String>,
    /// How the flight ended.
    pub outcome: Outcome,
}

/// Flies a controller and linearises the loop at every sample; radii are computed at every
/// `every`-th one (0 counts as 1).
///
/// # Errors
/// [`SimError`] where the scenario cannot be flown or an eigenvalue is not found.
pub fn linearise_along(
    scenario: &Scenario,
    controller: &Controller,
    every: usize,
) -> Result<TrajectoryLinearisation, SimError> {
    let every = every.max(1);
    let mut points = Vec::with_capacity(scenario.timing.rows() / every + 1);
    let timing = scenario.timing;
    let mut follower = Follower::new(timing.rows(), timing.dt_s());
    let mut found: Result<(), SimError> = Ok(());
    let (outcome, states) = walk(scenario, controller, |small, rest| {
        found = follower.add(small, rest).map_err(SimError::from).and_then(|()| {
            points.extend((small.k % every == 0).then(|| point(small)).transpose()?);
            Ok(())
        });
        if found.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    })?;
    found?;
    let share = |is: &dyn Fn(&TrajectoryPoint) -> bool| {
        points.iter().filter(|point| is(point)).count() as f64 / points.len().max(1) as f64
    };
    Ok(TrajectoryLinearisation {
        worst_frozen: worst(&points, |point| point.frozen_radius),
        worst: worst(&points, |point| point.radius),
        frozen_above_one: share(&|point| !point.limited && point.frozen_radius > 1.0 + NEUTRAL),
        above_one: share(&|point| !point.limited && point.radius > 1.0 + NEUTRAL),
        limited: share(&|point| point.limited),
        growth: follower.growth(),
        points,
        states,
        outcome,
    })
}

fn point(small: &SmallSignal) -> Result<TrajectoryPoint, SimError> {
    Ok(TrajectoryPoint {
        time_s: small.time_s,
        gains: small.gains,
        frozen_radius: spectral_radius(&Matrix::from_rows(&small.frozen)?)?,
        radius: spectral_radius(&Matrix::from_rows(&small.matrix)?)?,
        limited: small.limited,
    })
}

fn worst(points: &[TrajectoryPoint], radius: impl Fn(&TrajectoryPoint) -> f64) -> Option<Worst> {
    let free = points.iter().filter(|point| !point.limited);
    let largest = free.max_by(|a, b| radius(a).total_cmp(&radius(b)))?;
    Some(Worst { radius: radius(largest), time_s: largest.time_s })
}
