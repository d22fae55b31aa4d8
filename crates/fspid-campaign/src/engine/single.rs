//! Flights that no lane can fly: aircraft whose forces are no derivatives, linear plants behind actuators that are no
//! first-order servo, in gusts or seen through sensors, external controllers, other simulators.

use std::ops::ControlFlow;

use fspid_sim::{
    ControllerLoss, EndCause, Exit, Flyer, Instant, Outcome, Perturbation, PlantLoss, Prepared,
    SimError, Trace,
};

/// One flight, recorded in an empty trace as far as measures need it. An external controller that cannot be started is
/// lost: whoever flies beside it has nothing to do with that.
pub(super) fn record(
    trace: Trace,
    prepared: &Prepared,
    flyer: Flyer<'_>,
) -> Result<Trace, SimError> {
    let mut trace = with_columns(trace, prepared);
    let outcome = flyer.respondent().fly(prepared, &Perturbation::NONE, |instant| {
        take_in(&mut trace, prepared, &instant);
        ControlFlow::Continue(())
    });
    trace.outcome = match outcome {
        Err(SimError::NotStarted { .. }) => {
            Outcome::ended_early(0.0, EndCause::ControllerLost(ControllerLoss::NotStarted))
        }
        // Which conditions can be trimmed is a result.
        Err(SimError::PlantNotStarted { .. }) => {
            Outcome::ended_early(0.0, EndCause::PlantLost(PlantLoss::NotStarted))
        }
        outcome => outcome?,
    };
    Ok(trace)
}

/// A trace with the columns that requirements ask an aircraft for beyond its pitch.
pub(super) fn with_columns(mut trace: Trace, prepared: &Prepared) -> Trace {
    if prepared.is_aircraft() {
        trace.columns = Trace::empty_columns(prepared);
    }
    trace
}

/// Adds a sample, as far as measures need it.
pub(super) fn take_in(trace: &mut Trace, prepared: &Prepared, instant: &Instant) {
    let timing = prepared.timing();
    trace.time_s.push(timing.time_s(instant.k));
    trace.setpoint_rad.push(instant.setpoint_rad);
    trace.theta_rad.push(instant.theta_rad);
    trace.command_rad.push(instant.step.command_rad);
    trace.elevator_rad.push(instant.elevator_rad);
    trace.saturated_samples += usize::from(instant.step.saturated);
    trace.faults = instant.step.faults;
    trace.push_columns(prepared, instant);
    let departure = instant.aircraft.and_then(|aircraft| aircraft.departure);
    Exit::take_in(&mut trace.exit, departure, instant.k, timing);
}
