//! Some runs flown again for their curves: a few columns at a few hundred instants.

use std::ops::ControlFlow;
use std::path::Path;

use fspid_scenario::file::Study;
use fspid_scenario::units::degrees;
use fspid_sim::Perturbation;
use rayon::prelude::*;

use super::Source;
use crate::campaign::Campaign;
use crate::folder::Folder;
use crate::merge::PLAN_KEY;
use crate::plan::{Plan, SHARD_RUNS};
use crate::summary::Files;

/// Most runs that are flown again: 5 and 95 % then have 20 flights beyond them.
const MOST_RUNS: u64 = 400;
/// Instants that curves have at most; more than pixels nobody sees.
const MOST_INSTANTS: usize = 1000;
/// Samples that are flown at most, all controllers together: some seconds for linear plants, and for aircraft, which
/// take a hundred times as long.
const MOST_SAMPLES: usize = 12_000_000;
const MOST_AIRCRAFT_SAMPLES: usize = 1_500_000;

/// Curves of one flight at the common instants; shorter where it ended early.
#[derive(Clone, Debug, Default)]
pub(super) struct Curves {
    pub(super) pitch_deg: Vec<f64>,
    pub(super) elevator_deg: Vec<f64>,
}

/// Flights of one controller.
#[derive(Debug)]
pub(super) struct Flights {
    pub(super) nominal: Curves,
    /// Of the first runs that could be flown.
    pub(super) first: Vec<Curves>,
    /// The worst ones with their numbers.
    pub(super) worst: Vec<(u64, Curves)>,
}

/// All that is flown again.
#[derive(Debug)]
pub(super) struct Reflown {
    pub(super) time_s: Vec<f64>,
    pub(super) setpoint_deg: Vec<f64>,
    /// One a controller.
    pub(super) controllers: Vec<Flights>,
    /// How many of the first runs were looked at.
    pub(super) runs: u64,
    /// How many of them have no curves: refused, or with another sample period.
    pub(super) left_out: u64,
}

/// Flies the first runs again, so many at most, and some worst ones of each controller.
///
/// # Errors
/// Why that cannot be, in a sentence.
pub(super) fn reflown(
    source: &Source<'_>,
    worst: &[Vec<u64>],
    most: u64,
) -> Result<Reflown, String> {
    let campaign = campaign(source)?;
    compare(&campaign, source.files)?;
    let nominal = campaign.template().study();
    let grid = Grid::of(nominal)?;
    let runs = how_many(nominal, campaign.plan().runs.min(most));
    let first: Vec<Option<Vec<Curves>>> =
        (0..runs).into_par_iter().map(|run| curves_of(&campaign, run, &grid)).collect();
    let left_out = first.iter().filter(|flight| flight.is_none()).count() as u64;
    let own = of_study(nominal, &grid).ok_or("the nominal scenario cannot be flown")?;
    let mut controllers: Vec<Flights> = own
        .into_iter()
        .map(|nominal| Flights { nominal, first: Vec::new(), worst: Vec::new() })
        .collect();
    for flight in first.into_iter().flatten() {
        for (controller, curves) in controllers.iter_mut().zip(flight) {
            controller.first.push(curves);
        }
    }
    for (place, (controller, worst)) in controllers.iter_mut().zip(worst).enumerate() {
        let flown = worst.iter().filter_map(|run| {
            let mut flight = curves_of(&campaign, *run, &grid)?;
            (place < flight.len()).then(|| (*run, flight.swap_remove(place)))
        });
        controller.worst = flown.collect();
    }
    let (time_s, setpoint_deg) = (grid.time_s, grid.setpoint_deg);
    Ok(Reflown { time_s, setpoint_deg, controllers, runs, left_out })
}

/// The campaign, from the plan in the file's metadata.
fn campaign(source: &Source<'_>) -> Result<Campaign, String> {
    let head = &source.summary.head;
    if head.program != Plan::this_program() {
        return Err(format!(
            "they were flown by {}, this is {}, whose numbers may differ",
            super::words::cut(&head.program, 60),
            Plan::this_program()
        ));
    }
    // Parts lie in a folder of their own.
    let above = if head.shards.is_some() { 2 } else { 1 };
    let home = source.files.path().ancestors().nth(above).unwrap_or(Path::new(""));
    let planned = Folder::new(home).plan().ok().filter(|plan| plan.id() == head.campaign);
    let plan = Plan {
        scenario_text: head.scenario_text.clone(),
        scenario_path: "the scenario".to_owned(),
        scenario_folder: planned.map_or_else(|| ".".into(), |plan| plan.scenario_folder),
        scenario_digest: head.scenario_digest.clone(),
        overrides: head.changes.clone(),
        sampling: head.sampling,
        runs: head.planned_runs,
        seed: head.seed,
        shard_runs: SHARD_RUNS,
        program: head.program.clone(),
    };
    if plan.id() != head.campaign {
        return Err(format!("the \"{PLAN_KEY}\" in the file is not that of the campaign it names"));
    }
    Campaign::new(plan, home).map_err(|error| {
        let text = error.to_string();
        let line = text.lines().find(|line| !line.trim().is_empty()).unwrap_or("").trim();
        format!("the scenario cannot be read again ({})", super::words::cut(line, 200))
    })
}

/// Refuses curves that are not those of the file: its first run must give the same bits.
fn compare(campaign: &Campaign, files: &Files) -> Result<(), String> {
    let run = files.run(0, campaign.rows().of_run());
    let again = campaign.fly_together(std::iter::once((run, campaign.drawn(run))));
    let again = again.map_err(|error| error.to_string())?;
    let again = campaign.rows().table(&again).map_err(|error| error.to_string())?;
    let table = files.first().tables().next().and_then(Result::ok);
    let stored = table.and_then(|table| table.slice(0..again.rows()).ok());
    if stored.as_ref() == Some(&again) {
        return Ok(());
    }
    Err(format!("run {run}, flown again, does not give the numbers in the file"))
}

/// How many runs are flown again: few enough that a page takes seconds.
fn how_many(study: &Study, runs: u64) -> u64 {
    let scenario = &study.scenario;
    let linear = scenario.plant.linear().is_some();
    let most = if linear { MOST_SAMPLES } else { MOST_AIRCRAFT_SAMPLES };
    let one = scenario.timing.rows().max(1) * scenario.flyers().count().max(1);
    runs.min(MOST_RUNS).min((most / one).max(1) as u64)
}

/// The instants at which curves have values.
struct Grid {
    dt_s: f64,
    every: usize,
    time_s: Vec<f64>,
    setpoint_deg: Vec<f64>,
}

impl Grid {
    fn of(study: &Study) -> Result<Self, String> {
        let timing = study.scenario.timing;
        let prepared = study.scenario.prepare().map_err(|error| error.to_string())?;
        let every = timing.rows().div_ceil(MOST_INSTANTS).max(1);
        // Where an autopilot commands, each flight has its own.
        let shared = if prepared.has_autopilot() { &[] } else { prepared.setpoint_rad() };
        let setpoint = shared.iter().step_by(every);
        Ok(Self {
            dt_s: timing.dt_s(),
            every,
            time_s: (0..timing.rows()).step_by(every).map(|k| timing.time_s(k)).collect(),
            setpoint_deg: setpoint.map(|rad| degrees(*rad)).collect(),
        })
    }
}

fn curves_of(campaign: &Campaign, run: u64, grid: &Grid) -> Option<Vec<Curves>> {
    let study = campaign.study(&campaign.drawn(run)).ok()?;
    of_study(&study, grid)
}

/// One curve a controller; `None` where it cannot be flown or has another sample period.
fn of_study(study: &Study, grid: &Grid) -> Option<Vec<Curves>> {
    let scenario = &study.scenario;
    if scenario.timing.dt_s().to_bits() != grid.dt_s.to_bits() {
        return None;
    }
    let prepared = scenario.prepare().ok()?;
    let mut all = Vec::new();
    for flyer in scenario.flyers() {
        let mut curves = Curves::default();
        let flown = flyer.respondent().fly(&prepared, &Perturbation::NONE, |instant| {
            if instant.k % grid.every == 0 && curves.pitch_deg.len() < grid.time_s.len() {
                curves.pitch_deg.push(degrees(instant.theta_rad));
                curves.elevator_deg.push(degrees(instant.elevator_rad));
            }
            ControlFlow::Continue(())
        });
        flown.ok()?;
        all.push(curves);
    }
    Some(all)
}
