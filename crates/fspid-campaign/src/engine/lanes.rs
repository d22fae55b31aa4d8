//! One controller of each study, in lanes as far as they go.

use fspid_scenario::file::Study;
use fspid_sim::batch::{BatchRow, Entrant, LANES, fly_group};
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
    in_lanes(memory, group).unwrap_or_else(|| {
        let alone = |flight: &Ready<'_>| {
            let trace = memory.empty_trace(flight.prepared.timing().rows());
            single::record(trace, flight.prepared, flight.flyer)
        };
        group.iter().map(alone).collect()
    })
}

fn in_lanes(memory: &mut Memory, group: &[Ready<'_>]) -> Option<Vec<Result<Trace, SimError>>> {
    let entrants: Vec<Entrant<'_>> = group
        .iter()
        .map(|flight| {
            let controller = flight.flyer.controller()?;
            Some(Entrant { prepared: flight.prepared, controller })
        })
        .collect::<Option<_>>()?;
    let recorder = &mut memory.recorder;
    let rows = group.first()?.prepared.timing().rows();
    recorder.begin(rows);
    let outcomes =
        fly_group::<LANES>(&entrants, |row: &BatchRow<'_, LANES>| recorder.push(row)).ok()?;
    let mut traces: Vec<Trace> = group.iter().map(|_| memory.empty_trace(rows)).collect();
    let prepared: Vec<&Prepared> = group.iter().map(|flight| flight.prepared).collect();
    memory.recorder.fill(&mut traces, &prepared);
    let traces = traces.into_iter().zip(outcomes).map(|(mut trace, outcome)| {
        trace.outcome = outcome?;
        Ok(trace)
    });
    Some(traces.collect())
}
