//! Many closed-loop flights side by side, each with the bits of [`fly`](crate::fly).
//!
//! `W` flights are a group: every number of theirs stands in an array of `W` lanes, and each sample
//! is computed for all lanes at once, with the vectors of the machine. Which instructions a machine
//! has is found out while the program runs; the bits depend neither on them nor on `W`, since no
//! lane sees another.
//!
//! What is rare is done lane by lane, by the very functions that a single flight uses: the first
//! sample, a sample that a controller refuses, numbers near overflow, a sample in which a rate limit
//! acts. A flight that diverges is parked: its lane computes zeros from then on.
//!
//! Flights of a group may differ in all numbers: plant, servo, gains, factors, limits, signals. They
//! share what [`Refusal`] lists. What has no lanes (linear plants behind actuators that are no first-order servo, in gusts or
//! seen through sensors) is refused, and flies by [`fly`](crate::fly).
//!
//! Nonlinear aircraft from derivatives have lanes of their own, [`fly_aircraft`]: their continuous part flies in lanes, with any
//! actuator, sensors, air and autopilot around it.
//!
//! Threads are the caller's business: groups know nothing of each other.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane is a place in many arrays at once, and such loops become vectors"
)]

mod airframes;
mod formation;
mod gains;
mod group;
mod lane;
mod memory;
mod pid_lanes;
mod plant;
mod queue;
mod refusal;
mod row;
mod samples;
mod squadron;
#[cfg(test)]
mod tests;

pub use formation::Formation;
pub use fspid_numeric::InstructionSet;
pub use refusal::Refusal;
pub use row::BatchRow;
pub use squadron::{fly_aircraft, fly_aircraft_by};

use core::ops::ControlFlow;

use fearless_simd::dispatch;

use crate::controller::Controller;
use crate::error::SimError;
use crate::instant::Instant;
use crate::scenario::Prepared;
use crate::trace::Outcome;
use group::Group;

/// Lanes of a group where nothing else is asked for.
pub const LANES: usize = 8;

/// One flight of a batch: what [`fly`](crate::fly) takes.
#[derive(Clone, Copy, Debug)]
pub struct Entrant<'a> {
    /// Signals and plant.
    pub prepared: &'a Prepared,
    /// Who answers.
    pub controller: &'a Controller,
}

/// Flies up to `W` flights side by side and shows every sample of all of them to `observer`. Answers
/// how each ended, in their order: what [`fly`](crate::fly) answers for it. After the start nothing is
/// allocated, but for samples that a rate limit cuts.
///
/// # Errors
/// [`Refusal`] for flights that cannot fly side by side; none has flown then.
pub fn fly_group<const W: usize>(
    flights: &[Entrant<'_>],
    observer: impl FnMut(&BatchRow<'_, W>),
) -> Result<Vec<Result<Outcome, SimError>>, Refusal> {
    fly_group_by::<W>(InstructionSet::best(), flights, observer)
}

/// [`fly_group`] for as long as `observer` goes on; flights that fly then count as completed.
///
/// # Errors
/// As [`fly_group`].
pub fn fly_group_while<const W: usize>(
    flights: &[Entrant<'_>],
    mut observer: impl FnMut(&BatchRow<'_, W>) -> ControlFlow<()>,
) -> Result<Vec<Result<Outcome, SimError>>, Refusal> {
    flown::<W>(InstructionSet::best(), flights, &mut observer)
}

/// [`fly_group`] by instructions of choice, for tests and measurements: the bits are the same.
///
/// # Errors
/// As [`fly_group`].
pub fn fly_group_by<const W: usize>(
    instructions: InstructionSet,
    flights: &[Entrant<'_>],
    mut observer: impl FnMut(&BatchRow<'_, W>),
) -> Result<Vec<Result<Outcome, SimError>>, Refusal> {
    flown::<W>(instructions, flights, &mut |row: &BatchRow<'_, W>| {
        observer(row);
        ControlFlow::Continue(())
    })
}

// Built once for all who watch.
fn flown<const W: usize>(
    instructions: InstructionSet,
    flights: &[Entrant<'_>],
    observer: &mut dyn FnMut(&BatchRow<'_, W>) -> ControlFlow<()>,
) -> Result<Vec<Result<Outcome, SimError>>, Refusal> {
    let mut group = Group::<W>::new(flights, instructions)?;
    dispatch!(instructions.level(), _simd => group.fly(observer));
    Ok(group.into_outcomes())
}

/// Flies any number of flights, `W` at a time, and shows every sample of each to `observer` with the
/// place of the flight in `flights`.
///
/// # Errors
/// [`Refusal`] for a group that cannot fly side by side; its `flight` counts from the first of all.
/// The groups before it have flown.
pub fn fly_many<const W: usize>(
    flights: &[Entrant<'_>],
    mut observer: impl FnMut(usize, &Instant),
) -> Result<Vec<Result<Outcome, SimError>>, Refusal> {
    let mut outcomes = Vec::with_capacity(flights.len());
    for group in flights.chunks(W.max(1)) {
        let first = outcomes.len();
        let flown = fly_group::<W>(group, |row: &BatchRow<'_, W>| {
            for lane in 0..W {
                if let Some(instant) = row.instant(lane) {
                    observer(first + lane, &instant);
                }
            }
        });
        outcomes.extend(flown.map_err(|refusal| refusal.counted_from(first))?);
    }
    Ok(outcomes)
}
