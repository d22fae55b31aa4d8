//! Costs of candidates with their slopes, for searches that go downhill.
//!
//! ```text
//! point ─building the controller─▶ numbers ─flights─▶ measures ─weights─▶ merit
//! point ◀─differences, no flight─ numbers ◀─the way back─ measures ◀─weights─ merit
//! ```
//!
//! A flight's measures are followed back to every number of its controller ([`fspid_sim::gradient`]); what a coordinate
//! of the point does to those numbers is found by differences of the controller's construction, which flies nothing.
//! Measures of the linear loop and what a constant load leaves are followed by their own differences, and only where they
//! count: for an objective, or beyond a limit.

mod descents;
mod merit;
mod numbers;
mod programme;
mod rows;
mod sequential;
#[cfg(test)]
mod tests;

use std::ops::Range;
use std::sync::Arc;

use fspid_numeric::InstructionSet;
use fspid_optimise::Scale;
use fspid_scenario::file::Study;
use fspid_scenario::measure::Measure;
use fspid_scenario::requirement::Requirement;
use fspid_scenario::tuning::Free;
use fspid_sim::Prepared;
use fspid_sim::batch::{Entrant, Refusal};
use fspid_sim::gradient::{Flown, Kind, NUMBERS, Slopes, differentiate_prices};
use fspid_study::analysis::AtRest;
use fspid_study::judgement::{SlopeOf, Sloped, add_slopes, is_of_this_air, of_loop};
use rayon::prelude::*;

use crate::error::TuneError;
use crate::flights::FlownCase;
use crate::problem::TuningProblem;
use crate::score::{FlightScore, load_left};

pub use descents::Counted;
pub(crate) use descents::Descents;
pub(crate) use merit::{Merit, Weights};
use merit::{Weight, beyond};
use numbers::{Built, Construction};
pub(crate) use sequential::Sequential;

/// Flights side by side.
const LANES: usize = 8;
/// Width of differences of the linear loop, of the cube.
const LOOP_STEP: f64 = 1e-3;
/// Flights whose signals are kept; those of more are computed each time.
const MOST_KEPT: usize = 256;

/// What a tuning needs to know the slopes of its candidates.
#[derive(Debug)]
pub(crate) struct Differentiable<'a> {
    problem: &'a TuningProblem,
    construction: Construction,
    jobs: Vec<Job<'a>>,
}

/// A flight of every candidate.
#[derive(Debug)]
struct Job<'a> {
    case: &'a FlownCase,
    run: usize,
    /// What is asked of it beside what is measured.
    asked: Vec<Requirement>,
    /// Flights of one kind fly side by side.
    kind: Kind,
    prepared: Option<Arc<Prepared>>,
}

/// What a little more of each sample of a flight adds to what is made of it, and that itself where it is asked for.
type Price<'a> = dyn Fn(usize, &Flown, &Prepared) -> (Slopes, Option<f64>) + Sync + 'a;

/// A flight with what a little more of each number of its controller adds to what was made of it, and that itself where
/// it was asked for.
struct Priced {
    job: usize,
    gradient: Vec<f64>,
    value: Option<f64>,
}

/// The slope of a candidate's merit, and how many linear loops were analysed for it.
pub(crate) struct Found {
    pub(crate) slope: Vec<f64>,
    pub(crate) analyses: usize,
}

impl<'a> Differentiable<'a> {
    /// Of a problem whose every part has a slope.
    ///
    /// # Errors
    /// [`TuneError::NoSlope`] names the first part that has none.
    pub(crate) fn new(problem: &'a TuningProblem, name: &'static str) -> Result<Self, TuneError> {
        let no = |what: String| TuneError::NoSlope { optimiser: name, what };
        check_what_is_free(problem).map_err(no)?;
        check_measures(problem).map_err(no)?;
        let start = problem.space().start();
        let flights = problem.its_flights();
        let all: Vec<(&FlownCase, usize)> = flights.jobs().collect();
        let keeps = all.len() <= MOST_KEPT;
        let job = |&(case, run): &(&'a FlownCase, usize)| {
            let which = |why: String| no(format!("case \"{}\": {why}", case.name));
            let study = flights.study(&start, case, run).map_err(which)?;
            Job::new((case, run), &study, problem, keeps).map_err(which)
        };
        // Of several that have none the first is named, whoever looks first.
        let jobs: Vec<Result<Job<'a>, TuneError>> = all.par_iter().map(job).collect();
        let jobs: Vec<Job<'a>> = jobs.into_iter().collect::<Result<_, _>>()?;
        let construction = Construction::new(flights, &all).map_err(no)?;
        Ok(Self { problem, construction, jobs })
    }

    /// The merit of a candidate from what its flights are worth.
    pub(crate) fn merit(&self, flights: &[FlightScore], weight: f64) -> Merit {
        let cases: Vec<f64> = self.jobs.iter().map(|job| job.case.weight).collect();
        Merit::of(flights, &cases, self.problem.tuning(), weight)
    }

    /// The slope of that merit; none where a flight has none.
    pub(crate) fn slope(&self, point: &[f64], weights: &Weights) -> Option<Found> {
        self.slope_of(&self.built(point)?, point, weights)
    }

    fn built(&self, point: &[f64]) -> Option<Built> {
        self.construction.built(self.problem.its_flights(), point)
    }

    /// The slope, of the controllers at that point.
    fn slope_of(&self, built: &Built, point: &[f64], weights: &Weights) -> Option<Found> {
        let price = |job: usize, flown: &Flown, prepared: &Prepared| {
            (self.price(job, flown, prepared, weights), None)
        };
        let all: Vec<usize> = (0..self.jobs.len()).collect();
        let mut of_class = vec![vec![0.0; NUMBERS]; built.controllers.len()];
        for Priced { job, gradient, .. } in self.priced(built, &all, point, &price)? {
            let sum = of_class[built.class[job]].iter_mut().zip(&gradient);
            sum.for_each(|(sum, more)| *sum += more);
        }
        let mut slope = vec![0.0; point.len()];
        for (class, gradient) in of_class.iter().enumerate() {
            add_columns(built, class, gradient, &mut slope);
        }
        let analyses = self.add_loops(point, weights, &mut slope)?;
        Some(Found { slope, analyses })
    }

    /// What the numbers of the controllers of some flights add to what `price` makes of each, in the order of the
    /// flights; none where one is lost.
    fn priced(
        &self,
        built: &Built,
        jobs: &[usize],
        point: &[f64],
        price: &Price<'_>,
    ) -> Option<Vec<Priced>> {
        let groups = self.groups(jobs);
        let flown: Vec<Option<Vec<Priced>>> =
            groups.par_iter().map(|group| self.fly(group, built, point, price)).collect();
        let mut priced: Vec<Priced> =
            flown.into_iter().collect::<Option<Vec<_>>>()?.into_iter().flatten().collect();
        priced.sort_by_key(|it| it.job);
        Some(priced)
    }

    /// The most linear loops that such a slope asks for.
    pub(crate) fn most_analyses(&self, weights: &Weights) -> usize {
        let tuning = self.problem.tuning();
        let counts = |job: &usize| {
            let mut measured = weights.measured(*job, tuning);
            weights.by_violation(*job) != 0.0
                || measured.any(|it| it.by_value != 0.0 && is_of(it.requirement, SlopeOf::Loop))
        };
        let jobs = if weights.is_none() { 0 } else { (0..self.jobs.len()).filter(counts).count() };
        jobs * (self.problem.space().dimension() + 1)
    }

    /// Flights of one kind together, at most as many as there are lanes.
    fn groups(&self, jobs: &[usize]) -> Vec<Vec<usize>> {
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for &job in jobs {
            let kind = &self.jobs[job].kind;
            let fits = |group: &&mut Vec<usize>| {
                group.len() < LANES
                    && group.first().is_some_and(|first| self.jobs[*first].kind == *kind)
            };
            match groups.iter_mut().rev().find(fits) {
                Some(group) => group.push(job),
                None => groups.push(vec![job]),
            }
        }
        groups
    }

    /// The gradients of a group of flights; none where one is lost.
    fn fly(
        &self,
        group: &[usize],
        built: &Built,
        point: &[f64],
        price: &Price<'_>,
    ) -> Option<Vec<Priced>> {
        let prepared = group.iter().map(|job| self.prepared(*job, point));
        let prepared: Vec<Arc<Prepared>> = prepared.collect::<Option<_>>()?;
        let entrants: Vec<Entrant<'_>> = group
            .iter()
            .zip(&prepared)
            .map(|(job, prepared)| Entrant {
                prepared,
                controller: &built.controllers[built.class[*job]],
            })
            .collect();
        let mut values = vec![None; group.len()];
        let told = |lane: usize, flown: &Flown| {
            let (slopes, value) = price(group[lane], flown, &prepared[lane]);
            values[lane] = value;
            slopes
        };
        let found = differentiate_prices::<LANES>(InstructionSet::best(), &entrants, told).ok()?;
        let lanes = group.iter().zip(found).zip(values);
        lanes.map(|((&job, found), value)| Some(Priced { job, gradient: found?, value })).collect()
    }

    fn prepared(&self, job: usize, point: &[f64]) -> Option<Arc<Prepared>> {
        let job = &self.jobs[job];
        if let Some(prepared) = &job.prepared {
            return Some(Arc::clone(prepared));
        }
        let study = self.problem.its_flights().study(point, job.case, job.run).ok()?;
        study.scenario.prepare().ok().map(Arc::new)
    }

    /// What a little more of each sample of a flight adds to the merit.
    fn price(&self, job: usize, flown: &Flown, prepared: &Prepared, weights: &Weights) -> Slopes {
        let mut slopes = Slopes::zero(flown.theta_rad.len());
        let (edges, timing) = (prepared.edges(), prepared.timing());
        let flight = Sloped { flown, edges, timing };
        for Weight { requirement, by_value } in weights.measured(job, self.problem.tuning()) {
            if by_value != 0.0 && is_of(requirement, SlopeOf::Flight) {
                add_slopes(flight, requirement, by_value, &mut slopes);
            }
        }
        let by_violation = weights.by_violation(job);
        if by_violation == 0.0 {
            return slopes;
        }
        let asked = self.jobs[job].asked.iter();
        for requirement in asked.filter(|it| is_of(it, SlopeOf::Flight)) {
            let mut none = Slopes::zero(flown.theta_rad.len());
            let value = add_slopes(flight, requirement, 0.0, &mut none);
            let by_value = value.map_or(0.0, |value| beyond(requirement, value));
            if by_value != 0.0 {
                add_slopes(flight, requirement, by_violation * by_value, &mut slopes);
            }
        }
        slopes
    }

    /// Adds what the linear loops' measures change of the merit; how many loops were analysed.
    fn add_loops(&self, point: &[f64], weights: &Weights, slope: &mut [f64]) -> Option<usize> {
        let loops: Vec<LoopOf<'_>> = (0..self.jobs.len())
            .into_par_iter()
            .map(|job| self.loop_of(job, point, weights))
            .collect::<Option<_>>()?;
        let counting: Vec<&LoopOf<'_>> =
            loops.iter().filter(|it| !it.measures.is_empty()).collect();
        let tasks: Vec<(&LoopOf<'_>, usize)> = counting
            .iter()
            .flat_map(|it| (0..point.len()).map(move |coordinate| (*it, coordinate)))
            .collect();
        let difference =
            |(it, coordinate): &(&LoopOf<'_>, usize)| self.loop_difference(it, point, *coordinate);
        let found: Vec<Option<f64>> = tasks.par_iter().map(difference).collect();
        for (found, (_, coordinate)) in found.iter().zip(&tasks) {
            // Where the loop next to it cannot be judged, the flights alone lead.
            slope[*coordinate] += found.unwrap_or(0.0);
        }
        Some(tasks.len() + loops.iter().filter(|it| it.is_analysed).count())
    }

    /// What of a flight's linear loop counts at a point.
    fn loop_of(&self, job: usize, point: &[f64], weights: &Weights) -> Option<LoopOf<'_>> {
        let of_loop = |it: &Requirement| is_of(it, SlopeOf::Loop);
        let measured = weights.measured(job, self.problem.tuning());
        let objectives = measured.filter(|it| it.by_value != 0.0 && of_loop(it.requirement));
        let mut measures: Vec<(LoopMeasure<'_>, f64)> =
            objectives.map(|it| (LoopMeasure::Required(it.requirement), it.by_value)).collect();
        let by_violation = weights.by_violation(job);
        let Job { case, run, asked, .. } = &self.jobs[job];
        let may_break = asked.iter().any(of_loop) || self.problem.removes_constant_load();
        if measures.is_empty() && !(by_violation != 0.0 && may_break) {
            return Some(LoopOf { job, measures, here: 0.0, is_analysed: false });
        }
        let study = self.problem.its_flights().study(point, case, *run).ok()?;
        for requirement in asked.iter().filter(|it| by_violation != 0.0 && of_loop(it)) {
            let measure = LoopMeasure::Required(requirement);
            let by_value = measure.value(&study).map_or(0.0, |value| beyond(requirement, value));
            if by_value != 0.0 {
                measures.push((measure, by_violation * by_value));
            }
        }
        if by_violation != 0.0
            && self.problem.removes_constant_load()
            && LoopMeasure::Load.value(&study).is_some_and(|left| left > 0.0)
        {
            measures.push((LoopMeasure::Load, by_violation));
        }
        let here = weighted_sum(&measures, &study)?;
        Some(LoopOf { job, measures, here, is_analysed: true })
    }

    /// What a coordinate changes of the weighted sum of what counts of a flight's loop.
    fn loop_difference(&self, it: &LoopOf<'_>, point: &[f64], coordinate: usize) -> Option<f64> {
        let mut moved = point.to_vec();
        let here = moved[coordinate];
        let up = here + LOOP_STEP <= 1.0;
        moved[coordinate] = if up { here + LOOP_STEP } else { here - LOOP_STEP };
        let Job { case, run, .. } = &self.jobs[it.job];
        let study = self.problem.its_flights().study(&moved, case, *run).ok()?;
        let change = weighted_sum(&it.measures, &study)? - it.here;
        let difference = change / (moved[coordinate] - here);
        difference.is_finite().then_some(difference)
    }
}

/// Adds what the coordinates of a point do by way of a controller's numbers.
fn add_columns(built: &Built, class: usize, gradient: &[f64], slope: &mut [f64]) {
    for (slope, column) in slope.iter_mut().zip(&built.columns[class]) {
        *slope += column.iter().zip(gradient).map(|(by, worth)| by * worth).sum::<f64>();
    }
}

/// What of a flight's linear loop counts: measures with what a unit of each adds to the merit, and their sum here.
#[derive(Debug)]
struct LoopOf<'a> {
    job: usize,
    measures: Vec<(LoopMeasure<'a>, f64)>,
    here: f64,
    /// Whether the loop was looked at to know that.
    is_analysed: bool,
}

fn weighted_sum(measures: &[(LoopMeasure<'_>, f64)], study: &Study) -> Option<f64> {
    measures.iter().map(|(measure, by)| Some(by * measure.value(study)?)).sum()
}

/// What is judged of a linear loop.
#[derive(Clone, Copy, Debug)]
enum LoopMeasure<'a> {
    Required(&'a Requirement),
    /// How much of a constant load is left beyond what may be.
    Load,
}

impl LoopMeasure<'_> {
    fn value(&self, study: &Study) -> Option<f64> {
        match self {
            Self::Required(requirement) => {
                of_loop(study, requirement).ok().filter(|value| value.is_finite())
            }
            Self::Load => {
                let named = study.scenario.controllers.first()?;
                let load = AtRest::of(&study.scenario, &named.controller).load;
                Some(load.filter(|load| !load.is_half_gone()).map_or(0.0, |load| load_left(&load)))
            }
        }
    }
}

impl<'a> Job<'a> {
    fn new(
        (case, run): (&'a FlownCase, usize),
        study: &Study,
        problem: &TuningProblem,
        keeps: bool,
    ) -> Result<Self, String> {
        let tuning = problem.tuning();
        let measured = tuning.objectives.len() + tuning.limits.len();
        let prepared = study.scenario.prepare().map_err(|error| error.to_string())?;
        let Some(named) = study.scenario.controllers.first() else {
            return Err("its controller is a program of its own".to_owned());
        };
        let entrant = Entrant { prepared: &prepared, controller: &named.controller };
        let kind = Kind::of(&entrant).map_err(|refusal| match refusal {
            Refusal::Part { what, .. } => what.to_owned(),
            other => other.to_string(),
        })?;
        let asked = &study.requirements[..study.requirements.len().saturating_sub(measured)];
        let mine = |it: &&Requirement| it.controller.as_ref().is_none_or(|it| *it == named.name);
        let mut asked: Vec<Requirement> = asked.iter().filter(mine).cloned().collect();
        asked.iter().try_for_each(|it| check_measure("requirement", it.measure))?;
        // In other air a requirement is broken by the same whatever is flown.
        asked.retain(|it| !is_of(it, SlopeOf::Flight) || is_of_this_air(study, it));
        let prepared = keeps.then(|| Arc::new(prepared));
        Ok(Self { case, run, asked, kind, prepared })
    }
}

fn is_of(requirement: &Requirement, of: SlopeOf) -> bool {
    SlopeOf::measure(requirement.measure) == Some(of)
}

fn check_measure(what: &str, measure: Measure) -> Result<(), String> {
    match SlopeOf::measure(measure) {
        Some(_) => Ok(()),
        None => Err(format!("the {what} {}, which moves in jumps", measure.name())),
    }
}

fn check_measures(problem: &TuningProblem) -> Result<(), String> {
    let tuning = problem.tuning();
    let objectives = tuning.objectives.iter().map(|it| it.requirement.measure);
    objectives.into_iter().try_for_each(|it| check_measure("objective", it))?;
    tuning.limits.iter().try_for_each(|it| check_measure("limit", it.measure))
}

/// Only numbers of the controller have slopes.
fn check_what_is_free(problem: &TuningProblem) -> Result<(), String> {
    for mark in problem.space().parameters() {
        let path = mark.path.text();
        if mark.controller().is_none() {
            return Err(format!("{path}, a free number outside of the controller"));
        }
        if matches!(mark.free, Free::Grid(_)) {
            return Err(format!("{path}, whose labels are chosen and not moved"));
        }
    }
    Ok(())
}

/// Coordinates of each mark, and whether they are numbers of the controller itself: cells of a grid, or weights of a network.
///
/// Such a coordinate moves its number in a straight line wherever the others are.
fn coordinates_of(problem_space: &crate::space::Space) -> Vec<(Range<usize>, bool)> {
    let mut from = 0;
    let parts = problem_space.parameters().iter().map(|mark| {
        let range = from..from + mark.dimensions();
        from = range.end;
        let is_straight = match &mark.free {
            Free::Numbers(_) => true,
            Free::Number(number) => number.scale == Scale::Linear && is_weight(mark.path.text()),
            Free::Grid(_) => false,
        };
        (range, is_straight)
    });
    parts.collect()
}

/// True for a place in the network of a supervisor.
fn is_weight(path: &str) -> bool {
    path.contains(".supervisor.network.")
}
