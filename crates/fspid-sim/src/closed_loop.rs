//! The simulation loop of one flight: measure, compute the command, advance the plant by one sample.

use crate::aircraft::AircraftSample;
use crate::instant::Instant;
use std::ops::ControlFlow;

use fspid_core::{Faults, Gains, Sample, State, Step};

use crate::actuated::Held;
use crate::controller::Controller;
use crate::error::SimError;
use crate::external::{Asked, ControllerLoss};
use crate::flown::Perturbation;
use crate::in_flight::Course;
use crate::propagation::{Motion, Propagation};
use crate::scenario::{Flyer, Prepared, Respondent, Scenario};
use crate::seen::Seen;
use crate::trace::{EndCause, Outcome, Trace};

/// A scenario's flights: the trace of each controller, in the scenario's order.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// The steps in the command.
    pub edges: Vec<crate::signal::Edge>,
    /// One trace a controller.
    pub traces: Vec<Trace>,
}

/// Flies every controller of the scenario.
///
/// # Errors
/// [`SimError`] where the scenario's plants cannot be discretised or an external controller cannot be started; an
/// unstable loop is no error but a trace that ends with [`EndCause::Diverged`], and the ground one that ends with
/// [`EndCause::HitGround`].
pub fn simulate(scenario: &Scenario) -> Result<Flight, SimError> {
    let prepared = scenario.prepare()?;
    let traces = scenario.flyers().map(|flyer| record(&prepared, flyer));
    Ok(Flight { traces: traces.collect::<Result<_, _>>()?, edges: prepared.edges })
}

fn record(prepared: &Prepared, flyer: Flyer<'_>) -> Result<Trace, SimError> {
    let mut trace = Trace::with_room(prepared);
    let outcome = flyer.respondent().fly(prepared, &Perturbation::NONE, |instant| {
        trace.push(prepared, &instant);
        ControlFlow::Continue(())
    })?;
    trace.outcome = outcome;
    Ok(trace)
}

/// Flies one controller and shows every sample to `observer`, which may end the flight early.
/// Nothing is recorded and, after the start, nothing is allocated.
///
/// # Errors
/// [`SimError`] where a rate-limited sample cannot be computed (coefficients near overflow).
pub fn fly(
    prepared: &Prepared,
    controller: &Controller,
    observer: impl FnMut(Instant) -> ControlFlow<()>,
) -> Result<Outcome, SimError> {
    fly_perturbed(prepared, controller, &Perturbation::NONE, observer)
}

/// As [`fly`], with something put between controller and servo.
///
/// # Errors
/// As [`fly`]; [`SimError::Number`] for a perturbation that makes no sense.
pub fn fly_perturbed(
    prepared: &Prepared,
    controller: &Controller,
    perturbation: &Perturbation,
    mut observer: impl FnMut(Instant) -> ControlFlow<()>,
) -> Result<Outcome, SimError> {
    watch(prepared, controller, perturbation, |instant, _| observer(*instant))
}

impl Respondent<'_> {
    /// Flies it, with equations as [`fly_perturbed`] does.
    ///
    /// # Errors
    /// As [`fly_perturbed`]; where an external controller cannot be started.
    pub fn fly(
        self,
        prepared: &Prepared,
        perturbation: &Perturbation,
        mut observer: impl FnMut(Instant) -> ControlFlow<()>,
    ) -> Result<Outcome, SimError> {
        match self {
            Self::Equations(controller) => {
                fly_perturbed(prepared, controller, perturbation, observer)
            }
            Self::External(external) => {
                let mut started = external.start()?;
                let mut answer = |seen: &Seen, aircraft: Option<&AircraftSample>| {
                    let step = started.answer_aboard(seen, aircraft)?;
                    Ok((step, started.asked()))
                };
                watch_answers(prepared, &mut answer, perturbation, &mut |instant, _| {
                    observer(*instant)
                })
            }
        }
    }
}

/// As [`fly`], with a function of what is seen in the controller's place: it answers commands in rad, nose up
/// positive. For experiments such as a relay's.
///
/// # Errors
/// As [`fly`].
pub fn fly_commanded(
    prepared: &Prepared,
    mut command_rad: impl FnMut(Sample<f64>) -> f64,
    mut observer: impl FnMut(Instant) -> ControlFlow<()>,
) -> Result<Outcome, SimError> {
    let mut answer = |seen: &Seen, _: Option<&AircraftSample>| {
        let command_rad = command_rad(seen.sample());
        let (gains, saturated, faults) = (Gains::ZERO, false, Faults::NONE);
        Ok((Step { command_rad, gains, saturated, faults }, Asked::default()))
    };
    watch_answers(prepared, &mut answer, &Perturbation::NONE, &mut |instant, _| observer(*instant))
}

/// What is about to happen between a sample and the next.
pub(crate) struct Coming<'a> {
    pub(crate) propagation: &'a Propagation,
    pub(crate) motion: &'a Motion,
    /// The command that has arrived.
    pub(crate) command_rad: f64,
    pub(crate) held: &'a Held<'a>,
}

/// The flight itself; the observer sees each sample and what is about to happen.
pub(crate) fn watch(
    prepared: &Prepared,
    controller: &Controller,
    perturbation: &Perturbation,
    mut observer: impl FnMut(&Instant, &Coming<'_>) -> ControlFlow<()>,
) -> Result<Outcome, SimError> {
    let mut memory = State::new();
    let mut answer = |seen: &Seen, _: Option<&AircraftSample>| {
        Ok((controller.step(&mut memory, seen.sample()), Asked::default()))
    };
    watch_answers(prepared, &mut answer, perturbation, &mut observer)
}

/// An answer, and what it asks for beside the command.
pub(crate) type Answered = (Step<f64>, Asked);

/// Who answers a sample.
type Answer<'a> =
    dyn FnMut(&Seen, Option<&AircraftSample>) -> Result<Answered, ControllerLoss> + 'a;

// Built once, and not anew for everybody who answers or watches.
pub(crate) fn watch_answers(
    prepared: &Prepared,
    answer: &mut Answer<'_>,
    perturbation: &Perturbation,
    observer: &mut dyn FnMut(&Instant, &Coming<'_>) -> ControlFlow<()>,
) -> Result<Outcome, SimError> {
    let mut course = Course::start(prepared, perturbation)?;
    loop {
        let seen = match course.look() {
            Ok(seen) => seen,
            Err(outcome) => return Ok(outcome),
        };
        let step = match answer(&seen, course.observed()) {
            Ok((step, asked)) => {
                course.ask(asked);
                step
            }
            Err(loss) => {
                let at_s = prepared.timing.time_s(seen.k);
                return Ok(Outcome::ended_early(at_s, EndCause::ControllerLost(loss)));
            }
        };
        let (instant, command_rad) = course.take(seen, step);
        let held = course.held();
        let (propagation, motion) = (course.propagation(), course.plant());
        let coming = Coming { propagation, motion, command_rad, held: &held };
        if observer(&instant, &coming).is_break() {
            return Ok(Outcome::Completed);
        }
        course.advance(command_rad)?;
    }
}
