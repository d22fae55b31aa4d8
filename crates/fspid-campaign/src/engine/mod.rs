//! Flying studies that differ in numbers: side by side where lanes can, one by one where not.
//!
//! Every flight has the bits of [`simulate`](fspid_sim::simulate): it is the same loop, measured and
//! judged by the same functions as a single study. No trace outlives its measures.

mod lanes;
mod memory;
mod recorder;
mod single;

use fspid_core::Faults;
use fspid_scenario::file::{RangeRule, Study};
use fspid_scenario::measure::Family;
use fspid_sim::aircraft::{AIRCRAFT_COLUMNS, Forces};
use fspid_sim::autopilot::AUTOPILOT_COLUMNS;
use fspid_sim::stability::doubts_of_flights;
use fspid_sim::{EarlyEnd, EndCause, Exit, Flyer, Plant, Prepared, SimError, Trace};
use fspid_study::analysis::AtRest;
use fspid_study::judgement::{Judgement, judge};
use fspid_study::metrics::{FlightMetrics, Verdict};
use fspid_study::simulation::{ControllerResult, Ending, flies_on};

pub use memory::Memory;

/// What one controller's flight comes to, without its trace.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightResult {
    /// Name of the controller.
    pub controller: String,
    /// Measures and verdict.
    pub metrics: FlightMetrics,
    /// Faults latched by the controller.
    pub faults: Faults,
    /// When an aircraft first left the range of its model, if it did.
    pub exit: Option<Exit>,
    /// What is made of leaving that range.
    pub range_rule: RangeRule,
    /// The loop at the gains that it has at rest: whether it is stable there, and, where it was asked, what it makes of
    /// a constant load.
    pub at_rest: AtRest,
    /// The requirements that concern it, in the order of the study; those of the aircraft alone concern
    /// every controller.
    pub judgements: Vec<Judgement>,
}

/// What is done with a loop that is unstable at rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// It is lost, whatever its flight looks like.
    Analysed,
    /// It is measured as it flew: limits of a controller may bound what the loop at rest does not.
    AsFlown,
}

/// How flights are judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Judging {
    /// What is done with a loop that is unstable at rest.
    pub stability: Stability,
    /// Whether each loop is asked what a constant load does to it.
    pub loads: bool,
}

/// Columns that an aircraft with sensors and an autopilot has beyond those of every trace.
const MOST_COLUMNS_BEYOND: usize = 2 + AIRCRAFT_COLUMNS.len() + AUTOPILOT_COLUMNS.len();

/// Most memory for traces that are being measured, in numbers: 16 MiB a thread.
const MOST_NUMBERS: usize = 2 << 20;

/// How many studies are best flown at once: as many as there are lanes, fewer where flights are long, one where they fly
/// one by one in any case, so that who asks them to stop waits for one.
#[must_use]
pub fn at_once(study: &Study) -> usize {
    let scenario = &study.scenario;
    let columns = match &scenario.plant {
        Plant::Linear(_) => recorder::COLUMNS,
        Plant::Aircraft(plant) if matches!(plant.aircraft().model(), Forces::Derivatives(_)) => {
            recorder::COLUMNS + MOST_COLUMNS_BEYOND
        }
        Plant::Aircraft(_) | Plant::External(_) => return 1,
    };
    if !scenario.externals.is_empty() {
        return 1;
    }
    let numbers = scenario.timing.rows() * scenario.flyers().count() * columns;
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
    fly_judging(memory, studies, Judging { stability: Stability::Analysed, loads: false })
}

/// The same, with a choice of how they are judged.
#[must_use]
pub fn fly_judging(
    memory: &mut Memory,
    studies: &[Study],
    judging: Judging,
) -> Vec<Result<Vec<FlightResult>, SimError>> {
    let prepared: Vec<_> = studies.iter().map(|study| study.scenario.prepare()).collect();
    let mut traces: Vec<Result<Vec<Trace>, SimError>> = prepared
        .iter()
        .map(|found| found.as_ref().map(|_| Vec::new()).map_err(Clone::clone))
        .collect();
    let controllers = studies.iter().map(|study| study.scenario.flyers().count()).max();
    for place in 0..controllers.unwrap_or(0) {
        let flown = lanes::fly(memory, studies, &prepared, place);
        for (traces, flown) in traces.iter_mut().zip(flown) {
            keep(traces, flown);
        }
    }
    let asked = studies.iter().zip(traces).map(|(study, traces)| {
        let loops = study.scenario.flyers().zip(traces?);
        Ok(loops.map(|(flyer, trace)| Flown::of(study, flyer, trace, judging)).collect())
    });
    let mut flown: Vec<Result<Vec<Flown>, SimError>> = asked.collect();
    ask_as_they_go_on(studies, &mut flown);
    let measured = studies.iter().zip(&prepared).zip(flown);
    let judged = |((study, prepared), flown): ((&Study, _), Result<_, _>)| {
        measure(memory, study, judging, prepared, flown?)
    };
    measured.map(judged).collect()
}

/// A flight, and what is known of its loop at rest.
struct Flown {
    trace: Trace,
    at_rest: AtRest,
}

impl Flown {
    fn of(study: &Study, flyer: Flyer<'_>, trace: Trace, judging: Judging) -> Self {
        let scenario = &study.scenario;
        let at_rest = match (flyer.controller(), judging.loads) {
            (None, _) => AtRest::unknown(),
            (Some(controller), true) => AtRest::of(scenario, controller),
            (Some(controller), false) => AtRest::stability(scenario, controller),
        };
        Self { trace, at_rest }
    }
}

/// Asks the loops at rest by their flights as they go on, those of one controller side by side.
fn ask_as_they_go_on(studies: &[Study], flown: &mut [Result<Vec<Flown>, SimError>]) {
    let controllers = flown.iter().flatten().map(Vec::len).max();
    for place in 0..controllers.unwrap_or(0) {
        let open = studies.iter().zip(flown.iter()).enumerate().filter_map(|(at, (study, all))| {
            let Flown { trace, at_rest } = all.as_ref().ok()?.get(place)?;
            let scenario = &study.scenario;
            let named = flies_on(scenario, scenario.flyers().nth(place)?.name(), at_rest)?;
            Some((at, (scenario, &named.controller, trace)))
        });
        let (places, open): (Vec<usize>, Vec<_>) = open.unzip();
        let doubts = doubts_of_flights(&open);
        for (at, doubt) in places.into_iter().zip(doubts) {
            if let Some(Flown { at_rest, .. }) =
                flown[at].as_mut().ok().and_then(|all| all.get_mut(place))
            {
                *at_rest = at_rest.clone().doubted(doubt);
            }
        }
    }
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
    study: &Study,
    judging: Judging,
    prepared: &Result<Prepared, SimError>,
    flown: Vec<Flown>,
) -> Result<Vec<FlightResult>, SimError> {
    let prepared = prepared.as_ref().map_err(Clone::clone)?;
    let flyers = study.scenario.flyers();
    let results = flyers.zip(flown).map(|(flyer, Flown { trace, at_rest })| {
        let unstable = at_rest.unstable.filter(|_| judging.stability == Stability::Analysed);
        let (flown, rest) = ((trace, prepared.edges()), (at_rest, unstable));
        ControllerResult::measured(study, flyer.name(), flown, rest)
    });
    let results: Vec<ControllerResult> = results.collect();
    let judgements = judge(study, &results);
    let flights = results.into_iter().map(|result| {
        let concerns = |judgement: &&Judgement| {
            judgement.controller == result.name || judgement.is_of_aircraft()
        };
        let mine = judgements.iter().filter(concerns).cloned().collect();
        flight(memory, result, mine)
    });
    Ok(flights.collect())
}

fn flight(
    memory: &mut Memory,
    result: ControllerResult,
    judgements: Vec<Judgement>,
) -> FlightResult {
    let ControllerResult { name, trace, metrics, at_rest, range_rule, .. } = result;
    let flight = FlightResult {
        controller: name,
        metrics,
        faults: trace.faults,
        exit: trace.exit,
        range_rule,
        at_rest,
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
            Verdict::EndedEarly(EarlyEnd { at_s, cause: EndCause::Diverged }) => Some(at_s),
            _ => None,
        }
    }

    /// When it hit the ground, if it did, s.
    #[must_use]
    pub fn hit_ground_at_s(&self) -> Option<f64> {
        match self.metrics.verdict {
            Verdict::EndedEarly(EarlyEnd { at_s, cause: EndCause::HitGround }) => Some(at_s),
            _ => None,
        }
    }

    /// How the flight ended.
    #[must_use]
    pub fn ending(&self) -> Ending {
        let (measured, exit) = (self.metrics.verdict, self.exit);
        Ending { measured, exit, range_rule: self.range_rule }
    }

    /// True for a flight that has [`reasons`](Self::reasons) to be called failed.
    #[must_use]
    pub fn is_failed(&self) -> bool {
        !self.ending().failures().is_empty()
            || self.is_unsettled()
            || self.judgements.iter().any(|judgement| !judgement.met)
    }

    /// Where nothing is required of its controller, a flight is asked to settle its steps. What is required of the aircraft
    /// alone says nothing of how it was flown.
    fn is_unsettled(&self) -> bool {
        let verdict = self.metrics.verdict;
        let is_of_aircraft = |it: &Judgement| it.requirement.measure.family() == Family::Airframe;
        let is_asked = self.judgements.iter().any(|judgement| !is_of_aircraft(judgement));
        !is_asked && !verdict.is_good() && !verdict.is_failure()
    }

    /// Why the flight counts as failed: it fails by itself, requirements are not met, or, where nothing is required of
    /// the controller, a step is not settled. Empty for a flight that is well.
    #[must_use]
    pub fn reasons(&self) -> Vec<String> {
        let unsettled = self.is_unsettled().then(|| self.metrics.verdict.to_string());
        let unmet = self.judgements.iter().filter(|judgement| !judgement.met).map(|judgement| {
            let requirement = &judgement.requirement;
            format!(
                "{} {}, {}",
                requirement.id,
                judgement.value_in_words(),
                requirement.limits_in_words()
            )
        });
        unsettled.into_iter().chain(self.ending().failures()).chain(unmet).collect()
    }
}
