//! Replays flights with other gains than the supervisor's: separates adaptation to the plant from scheduling on the
//! manoeuvre.
//!
//! Only the gains are replaced. What follows them, memory, reference model, limits, servo and sensors are those of the
//! flight, so that a flight replayed with its own gains, or its own inputs, has its own bits, and one at the nominal gains
//! those of the PID without a supervisor.

use std::ops::ControlFlow;

use fspid_core::{Fspid, Gains, State};

use crate::aircraft::AircraftSample;
use crate::closed_loop::watch_answers;
use crate::error::SimError;
use crate::external::Asked;
use crate::flown::Perturbation;
use crate::instant::Instant;
use crate::scenario::Prepared;
use crate::seen::Seen;
use crate::trace::Outcome;

/// What stands in the place of a supervisor's answer. A flight that lasts longer than what is replayed keeps its last
/// entry; with none at all it is the flight as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Replay<'a> {
    /// The gains of each sample.
    Gains(&'a [Gains<f64>]),
    /// What the supervisor sees at each sample, as [`Fspid::inputs`] answers it; it concludes for itself.
    Inputs(&'a [[f64; 2]]),
}

/// As [`fly`](crate::fly), replayed.
///
/// # Errors
/// As [`fly`](crate::fly).
pub fn fly_replayed(
    prepared: &Prepared,
    controller: &Fspid<f64>,
    replay: Replay<'_>,
    mut observer: impl FnMut(Instant) -> ControlFlow<()>,
) -> Result<Outcome, SimError> {
    let mut memory = State::new();
    let mut answer = |seen: &Seen, _: Option<&AircraftSample>| {
        let sample = seen.sample();
        let step = match replay {
            Replay::Gains(gains) => match at(gains, seen.k) {
                Some(gains) => controller.step_at(&mut memory, sample, gains),
                None => controller.step(&mut memory, sample),
            },
            Replay::Inputs(inputs) => match at(inputs, seen.k) {
                Some(inputs) => controller.step_seeing(&mut memory, sample, inputs),
                None => controller.step(&mut memory, sample),
            },
        };
        Ok((step, Asked::default()))
    };
    watch_answers(prepared, &mut answer, &Perturbation::NONE, &mut |instant, _| observer(*instant))
}

/// As [`fly`](crate::fly), with what the supervisor sees at each sample beside it; zeros where it sees nothing, at a
/// sample that is held.
///
/// # Errors
/// As [`fly`](crate::fly).
pub fn fly_watching_inputs(
    prepared: &Prepared,
    controller: &Fspid<f64>,
    mut observer: impl FnMut(Instant, [f64; 2]) -> ControlFlow<()>,
) -> Result<Outcome, SimError> {
    let mut memory = State::new();
    let inputs = std::cell::Cell::new([0.0; 2]);
    let mut answer = |seen: &Seen, _: Option<&AircraftSample>| {
        let sample = seen.sample();
        inputs.set(controller.inputs(&memory, sample).unwrap_or_default());
        Ok((controller.step(&mut memory, sample), Asked::default()))
    };
    watch_answers(prepared, &mut answer, &Perturbation::NONE, &mut |instant, _| {
        observer(*instant, inputs.get())
    })
}

fn at<T: Copy>(entries: &[T], k: usize) -> Option<T> {
    entries.get(k).or(entries.last()).copied()
}
