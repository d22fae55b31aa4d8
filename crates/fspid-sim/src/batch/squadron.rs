//! Nonlinear flights side by side: aircraft from derivatives with everything around them.

use fspid_aircraft::abreast::LANES as PLACES;
use fspid_core::State;
use fspid_numeric::InstructionSet;

use super::Entrant;
use super::refusal::Refusal;
use crate::aircraft::{AircraftAbreast, AircraftFlight, NotAbreast, Wing};
use crate::controller::Controller;
use crate::error::SimError;
use crate::flown::Perturbation;
use crate::in_flight::Course;
use crate::instant::Instant;
use crate::propagation::Propagation;
use crate::scenario::Prepared;
use crate::trace::Outcome;

/// A flight that is not over.
struct Flying<'a> {
    course: Course<&'a Prepared>,
    controller: &'a Controller,
    memory: State<f64>,
    command_rad: f64,
}

fn leave<'f>(flight: &'f mut Option<Flying<'_>>) -> Option<Wing<'f>> {
    let flight = flight.as_mut()?;
    flight.course.leave(flight.command_rad)
}

fn begin<'f>(flight: &'f mut Option<Flying<'_>>) -> Option<Wing<'f>> {
    flight.as_mut()?.course.wing(0.0)
}

/// The aircraft of a flight.
fn aircraft(flight: usize, prepared: &Prepared) -> Result<&AircraftFlight, Refusal> {
    match prepared.stages.first().map(|stage| &stage.propagation) {
        Some(Propagation::Aircraft(aircraft)) => Ok(aircraft),
        _ => Err(Refusal::Part { flight, what: "a plant that is no aircraft of its own" }),
    }
}

/// Aircraft in their lanes.
fn abreast(
    flights: &[Entrant<'_>],
    instructions: InstructionSet,
) -> Result<Option<AircraftAbreast>, Refusal> {
    let Some(entrant) = flights.first() else { return Ok(None) };
    let first = aircraft(0, entrant.prepared)?;
    let refused = |flight: usize| {
        move |why: NotAbreast| match why {
            NotAbreast::Forces => Refusal::Part { flight, what: "forces that are no derivatives" },
            NotAbreast::Laws => Refusal::Differs { flight, what: "its law of drag or thrust" },
            NotAbreast::Air => Refusal::Differs { flight, what: "whether the air moves" },
        }
    };
    let mut all = AircraftAbreast::new(instructions, first).map_err(refused(0))?;
    for (flight, other) in flights.iter().enumerate() {
        if other.prepared.timing != entrant.prepared.timing {
            return Err(Refusal::Differs { flight, what: "its timing" });
        }
        all.put(flight, aircraft(flight, other.prepared)?, first).map_err(refused(flight))?;
    }
    Ok(Some(all))
}

/// Flies aircraft side by side, as many as there are [`LANES`](super::LANES) at most, and shows every sample of each to
/// `observer` with the place of the flight in `flights`. Answers how each ended, in their order: what [`fly`](crate::fly)
/// answers for it, with its bits. After the start nothing is allocated.
///
/// # Errors
/// [`Refusal`] for flights that cannot fly so side by side; none has flown then.
pub fn fly_aircraft(
    flights: &[Entrant<'_>],
    observer: impl FnMut(usize, &Instant),
) -> Result<Vec<Result<Outcome, SimError>>, Refusal> {
    fly_aircraft_by(InstructionSet::best(), flights, observer)
}

/// [`fly_aircraft`] by instructions of choice, for tests and measurements: the bits are the same.
///
/// # Errors
/// As [`fly_aircraft`].
pub fn fly_aircraft_by(
    instructions: InstructionSet,
    flights: &[Entrant<'_>],
    mut observer: impl FnMut(usize, &Instant),
) -> Result<Vec<Result<Outcome, SimError>>, Refusal> {
    flown(instructions, flights, &mut observer)
}

// Built once for all who watch.
fn flown(
    instructions: InstructionSet,
    flights: &[Entrant<'_>],
    observer: &mut dyn FnMut(usize, &Instant),
) -> Result<Vec<Result<Outcome, SimError>>, Refusal> {
    if flights.len() > PLACES {
        return Err(Refusal::TooMany { found: flights.len(), most: PLACES });
    }
    let Some(mut aircraft) = abreast(flights, instructions)? else { return Ok(Vec::new()) };
    let mut outcomes: Vec<Result<Outcome, SimError>> = vec![Ok(Outcome::Completed); flights.len()];
    let mut flying: [Option<Flying<'_>>; PLACES] = [const { None }; PLACES];
    for (place, entrant) in flights.iter().enumerate() {
        match Course::start(entrant.prepared, &Perturbation::NONE) {
            Ok(course) => {
                let (controller, memory) = (entrant.controller, State::new());
                flying[place] = Some(Flying { course, controller, memory, command_rad: 0.0 });
            }
            Err(error) => outcomes[place] = Err(error),
        }
    }
    aircraft.look(&mut flying.each_mut().map(begin));
    while flying.iter().any(Option::is_some) {
        let samples = aircraft.samples(&flying.each_ref().map(|it| it.as_ref()?.course.aircraft()));
        for (place, sample) in samples.into_iter().enumerate() {
            let Some(flight) = &mut flying[place] else { continue };
            match flight.course.look_at(|_, _, _| sample) {
                Ok(seen) => {
                    let step = flight.controller.step(&mut flight.memory, seen.sample());
                    let (instant, command_rad) = flight.course.take(seen, step);
                    flight.command_rad = command_rad;
                    observer(place, &instant);
                }
                Err(outcome) => {
                    outcomes[place] = Ok(outcome);
                    flying[place] = None;
                }
            }
        }
        aircraft.advance(&mut flying.each_mut().map(leave));
    }
    Ok(outcomes)
}
