//! Flying studies that differ in numbers: side by side where lanes can, one by one where not.
//!
//! Every flight has the bits of [`simulate`](fspid_sim::simulate): it is the same loop, measured and
//! judged by the same functions as a single study. No trace outlives its measures.

mod lanes;
mod memory;
mod recorder;
mod single;

use fspid_core::Faults;
use fspid_sim::stability::{Unstable, instability};
use fspid_sim::{Exit, Prepared, SimError, Trace};
use fspid_study::file::Study;
use fspid_study::metrics::{CommandEffort, FlightMetrics, largest_error_rad};
use fspid_study::requirement::{Judgement, judge};
use fspid_study::simulation::ControllerResult;

pub use memory::Memory;

/// What one controller's flight comes to, without its trace.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightResult {
    /// Name of the controller.
    pub controller: String,
    /// Measures and verdict.
    pub metrics: FlightMetrics,
    /// Largest error, rad.
    pub largest_error_rad: f64,
    /// Effort of the elevator over the whole flight.
    pub elevator: CommandEffort,
    /// Samples whose command was cut by the controller's own limits, as a share of those flown.
    pub saturated_share: f64,
    /// Faults latched by the controller.
    pub faults: Faults,
    /// When an aircraft first left the range of its model, if it did.
    pub exit: Option<Exit>,
    /// What the linear analysis says of an unstable loop; none for a stable loop and for one that it cannot tell of.
    pub unstable: Option<Unstable>,
    /// The requirements that concern it, in the order of the study; those of the aircraft alone concern
    /// every controller.
    pub judgements: Vec<Judgement>,
}

/// What is done with a loop whose linear analysis says that it is unstable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// It is lost, whatever its flight looks like.
    Analysed,
    /// It is measured as it flew. Self-tuning gains and limits of a controller are out of reach of the analysis, so that
    /// a comparison of loops with and without them is fair only like this.
    AsFlown,
}

/// Most memory for traces that are being measured, in numbers: 16 MiB a thread.
const MOST_NUMBERS: usize = 2 << 20;

/// How many studies are best flown at once: as many as there are lanes, fewer where flights are long.
#[must_use]
pub fn at_once(study: &Study) -> usize {
    let scenario = &study.scenario;
    let numbers = scenario.timing.rows() * scenario.controllers.len() * recorder::COLUMNS;
    (MOST_NUMBERS / numbers.max(1)).clamp(1, fspid_sim::batch::LANES)
}

/// Flies each study with each of its controllers. The studies come from one scenario, so that all have
/// the same controllers in the same order; in every number they may differ.
#[must_use]
pub fn fly(studies: &[Study]) -> Vec<Result<Vec<FlightResult>, SimError>> {
    fly_with(&mut Memory::default(), studies)
}

/// The same with the memory of flights before, which does not show in the answer.
#[must_use]
pub fn fly_with(
    memory: &mut Memory,
    studies: &[Study],
) -> Vec<Result<Vec<FlightResult>, SimError>> {
    fly_judging(memory, studies, Stability::Analysed)
}

/// The same, with a choice of what is done with unstable loops.
#[must_use]
pub fn fly_judging(
    memory: &mut Memory,
    studies: &[Study],
    stability: Stability,
) -> Vec<Result<Vec<FlightResult>, SimError>> {
    let prepared: Vec<_> = studies.iter().map(|study| study.scenario.prepare()).collect();
    let mut traces: Vec<Result<Vec<Trace>, SimError>> = prepared
        .iter()
        .map(|found| found.as_ref().map(|_| Vec::new()).map_err(Clone::clone))
        .collect();
    let controllers = studies.iter().map(|study| study.scenario.controllers.len()).max();
    for place in 0..controllers.unwrap_or(0) {
        let flown = lanes::fly(memory, studies, &prepared, place);
        for (traces, flown) in traces.iter_mut().zip(flown) {
            keep(traces, flown);
        }
    }
    let measured = studies.iter().zip(&prepared).zip(traces);
    let judged = |((study, prepared), traces): ((&Study, _), Result<_, _>)| {
        measure(memory, (study, stability), prepared, traces?)
    };
    measured.map(judged).collect()
}

/// Adds a trace to those of its study; the first error stays.
fn keep(traces: &mut Result<Vec<Trace>, SimError>, flown: Option<Result<Trace, SimError>>) {
    if let (Ok(list), Some(flown)) = (&mut *traces, flown) {
        match flown {
            Ok(trace) => list.push(trace),
            Err(error) => *traces = Err(error),
        }
    }
}

fn measure(
    memory: &mut Memory,
    (study, stability): (&Study, Stability),
    prepared: &Result<Prepared, SimError>,
    traces: Vec<Trace>,
) -> Result<Vec<FlightResult>, SimError> {
    let prepared = prepared.as_ref().map_err(Clone::clone)?;
    let scenario = &study.scenario;
    let mut unstable = Vec::with_capacity(traces.len());
    let results = scenario.controllers.iter().zip(traces).map(|(named, trace)| {
        let found = instability(scenario, &named.controller)?;
        unstable.push(found);
        let unstable = found.filter(|_| stability == Stability::Analysed);
        let metrics = FlightMetrics::of(&trace, prepared.edges(), scenario.timing, unstable);
        Ok(ControllerResult { name: named.name.clone(), trace, metrics })
    });
    let results: Vec<ControllerResult> = results.collect::<Result<_, SimError>>()?;
    let judgements = judge(study, &results);
    let flights = results.into_iter().zip(unstable).map(|(result, unstable)| {
        let concerns = |judgement: &&Judgement| {
            judgement.controller == result.name || judgement.is_of_aircraft()
        };
        let mine = judgements.iter().filter(concerns).cloned().collect();
        FlightResult { unstable, ..flight(memory, result, mine, scenario.timing.dt_s()) }
    });
    Ok(flights.collect())
}

fn flight(
    memory: &mut Memory,
    result: ControllerResult,
    judgements: Vec<Judgement>,
    dt_s: f64,
) -> FlightResult {
    let ControllerResult { name, trace, metrics } = result;
    let flight = FlightResult {
        controller: name,
        metrics,
        largest_error_rad: largest_error_rad(&trace.setpoint_rad, &trace.theta_rad),
        elevator: CommandEffort::of(&trace.elevator_rad, dt_s),
        saturated_share: trace.saturated_samples as f64 / trace.rows().max(1) as f64,
        faults: trace.faults,
        exit: trace.exit,
        unstable: None,
        judgements,
    };
    memory.take_back(trace);
    flight
}

impl FlightResult {
    /// When it diverged, if it did, s.
    #[must_use]
    pub fn diverged_at_s(&self) -> Option<f64> {
        match self.metrics.verdict {
            fspid_study::metrics::Verdict::Diverged { at_s } => Some(at_s),
            _ => None,
        }
    }

    /// True for a flight that has [`reasons`](Self::reasons) to be called failed.
    #[must_use]
    pub fn is_failed(&self) -> bool {
        self.is_lost() || self.judgements.iter().any(|judgement| !judgement.met)
    }

    /// A loop that diverged or is unstable; where nothing is required of it, also one that did not settle.
    fn is_lost(&self) -> bool {
        let verdict = self.metrics.verdict;
        if self.judgements.is_empty() { !verdict.is_good() } else { verdict.is_failure() }
    }

    /// Why the flight counts as failed: a loop that diverged or is unstable, requirements that are not
    /// met; where nothing is required of the controller, a step that it did not settle. Empty for a flight
    /// that is well.
    #[must_use]
    pub fn reasons(&self) -> Vec<String> {
        let lost = self.is_lost().then(|| self.metrics.verdict.to_string());
        let unmet = self.judgements.iter().filter(|judgement| !judgement.met).map(|judgement| {
            let requirement = &judgement.requirement;
            format!(
                "{} {}, {}",
                requirement.id,
                judgement.value_in_words(),
                requirement.limits_in_words()
            )
        });
        lost.into_iter().chain(unmet).collect()
    }
}
