//! One controller of each study, in lanes as far as they go.

use fspid_scenario::file::Study;
use fspid_sim::batch::{BatchRow, Entrant, LANES, fly_aircraft, fly_group};
use fspid_sim::{Flyer, Prepared, SimError, Trace};

use super::memory::Memory;
use super::single;

/// A flight, with its place among the studies.
#[derive(Clone, Copy)]
struct Ready<'a> {
    place: usize,
    prepared: &'a Prepared,
    flyer: Flyer<'a>,
}

/// Flies the controller at `place` of each study; `None` where there is no flight.
pub(super) fn fly(
    memory: &mut Memory,
    studies: &[Study],
    prepared: &[Result<Prepared, SimError>],
    place: usize,
) -> Vec<Option<Result<Trace, SimError>>> {
    let ready = studies.iter().zip(prepared).enumerate().filter_map(|(at, (study, prepared))| {
        let flyer = study.scenario.flyers().nth(place)?;
        Some(Ready { place: at, prepared: prepared.as_ref().ok()?, flyer })
    });
    let ready: Vec<Ready<'_>> = ready.collect();
    let mut traces: Vec<Option<Result<Trace, SimError>>> = vec![None; studies.len()];
    for group in ready.chunks(LANES) {
        for (flight, trace) in group.iter().zip(fly_together(memory, group)) {
            traces[flight.place] = Some(trace);
        }
    }
    traces
}

/// Up to as many flights as there are lanes; one by one where they cannot fly side by side.
fn fly_together(memory: &mut Memory, group: &[Ready<'_>]) -> Vec<Result<Trace, SimError>> {
    let together = match entrants(group) {
        Some(entrants) if group.iter().all(|flight| flight.prepared.is_aircraft()) => {
            aircraft_in_lanes(memory, &entrants)
        }
        Some(entrants) => in_lanes(memory, group, &entrants),
        None => None,
    };
    together.unwrap_or_else(|| {
        let alone = |flight: &Ready<'_>| {
            let trace = memory.empty_trace(flight.prepared.timing().rows());
            single::record(trace, flight.prepared, flight.flyer)
        };
        group.iter().map(alone).collect()
    })
}

/// What flies side by side, if all have equations.
fn entrants<'a>(group: &[Ready<'a>]) -> Option<Vec<Entrant<'a>>> {
    let entrant = |flight: &Ready<'a>| {
        let controller = flight.flyer.controller()?;
        Some(Entrant { prepared: flight.prepared, controller })
    };
    group.iter().map(entrant).collect()
}

/// Aircraft, recorded as single flights are.
fn aircraft_in_lanes(
    memory: &mut Memory,
    entrants: &[Entrant<'_>],
) -> Option<Vec<Result<Trace, SimError>>> {
    let empty = |entrant: &Entrant<'_>| {
        let trace = memory.empty_trace(entrant.prepared.timing().rows());
        single::with_columns(trace, entrant.prepared)
    };
    let mut traces: Vec<Trace> = entrants.iter().map(empty).collect();
    let outcomes = fly_aircraft(entrants, |place, instant| {
        if let (Some(trace), Some(entrant)) = (traces.get_mut(place), entrants.get(place)) {
            single::take_in(trace, entrant.prepared, instant);
        }
    });
    let outcomes = outcomes.ok()?;
    let traces = traces.into_iter().zip(outcomes).map(|(mut trace, outcome)| {
        trace.outcome = outcome?;
        Ok(trace)
    });
    Some(traces.collect())
}

fn in_lanes(
    memory: &mut Memory,
    group: &[Ready<'_>],
    entrants: &[Entrant<'_>],
) -> Option<Vec<Result<Trace, SimError>>> {
    let recorder = &mut memory.recorder;
    let rows = group.first()?.prepared.timing().rows();
    recorder.begin(rows);
    let outcomes =
        fly_group::<LANES>(entrants, |row: &BatchRow<'_, LANES>| recorder.push(row)).ok()?;
    let mut traces: Vec<Trace> = group.iter().map(|_| memory.empty_trace(rows)).collect();
    let prepared: Vec<&Prepared> = group.iter().map(|flight| flight.prepared).collect();
    memory.recorder.fill(&mut traces, &prepared);
    let traces = traces.into_iter().zip(outcomes).map(|(mut trace, outcome)| {
        trace.outcome = outcome?;
        Ok(trace)
    });
    Some(traces.collect())
}
