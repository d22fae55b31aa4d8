//! Gradients of the cost and of every constraint with respect to the search coordinates.

use fspid_scenario::requirement::Requirement;
use fspid_sim::Prepared;
use fspid_sim::gradient::{Flown, Slopes};
use fspid_study::judgement::{SlopeOf, Sloped, add_slopes};
use rayon::prelude::*;

use super::merit::excess;
use super::{
    Built, Counted, Differentiable, Job, LOOP_STEP, LoopMeasure, Weights, add_columns, is_of,
};
use crate::score::FlightScore;

/// A limit of a flight counts from so far within it, as a share of the limit; its slope costs no more for it.
const NEAR: f64 = 0.7;
/// A limit of a linear loop, whose slope takes an analysis for each coordinate.
const NEAR_OF_LOOP: f64 = 0.1;

/// The cost and the limits that are near, at a point.
#[derive(Clone, Debug, Default)]
pub(super) struct Rows {
    /// Slope of the cost.
    pub(super) cost: Vec<f64>,
    pub(super) limits: Vec<Row>,
    /// Ways back that were flown, each through all flights, and linear loops that were analysed.
    pub(super) ways_back: usize,
    pub(super) analyses: usize,
}

/// One limit.
#[derive(Clone, Debug)]
pub(super) struct Row {
    /// Which one, the same at every point.
    pub(super) of: Which,
    /// How far beyond, as a share of the limit; negative within.
    pub(super) excess: f64,
    pub(super) slope: Vec<f64>,
    /// What of its violation counts in the merit's.
    pub(super) share: f64,
}

/// A limit by its place: of a mean, or of a flight and its place there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(super) enum Which {
    Mean(usize),
    Flight(usize, usize),
    Loop(usize, usize),
}

impl Differentiable<'_> {
    /// The cost and the near limits at a point, from what its flights are worth; none where one has no slope.
    ///
    /// `weights` are those of the cost alone.
    pub(super) fn rows(
        &self,
        point: &[f64],
        flights: &[FlightScore],
        weights: &Weights,
    ) -> Option<Rows> {
        let built = self.built(point)?;
        let found = self.slope_of(&built, point, weights)?;
        let mut rows =
            Rows { cost: found.slope, limits: Vec::new(), ways_back: 1, analyses: found.analyses };
        self.add_means((point, &built), flights, weights, &mut rows)?;
        self.add_flights((point, &built), weights, &mut rows)?;
        self.add_near_loops(point, weights, &mut rows)?;
        Some(rows)
    }

    /// The most candidates that such rows count as.
    pub(crate) fn most_of_rows(&self) -> usize {
        let flights =
            |job: &Job<'_>| job.asked.iter().filter(|it| is_of(it, SlopeOf::Flight)).count();
        let asked = self.jobs.iter().map(flights).max().unwrap_or(0);
        let tuning = self.problem.tuning();
        let of_loop = |it: &Requirement| is_of(it, SlopeOf::Loop);
        let cost = tuning.objectives.iter().any(|it| of_loop(&it.requirement));
        let means = tuning.limits.iter().filter(|it| of_loop(it)).count();
        let near = self.problem.removes_constant_load()
            || self.jobs.iter().any(|job| job.asked.iter().any(of_loop));
        let times = usize::from(cost) + means + usize::from(near);
        let analyses = self.jobs.len() * (self.problem.space().dimension() + 1) * times;
        let slopes = 1 + tuning.limits.len() + asked;
        let counted = Counted { slopes, analyses, descents: 0 };
        counted.candidates(self.problem.flights())
    }

    fn add_means(
        &self,
        (point, built): (&[f64], &Built),
        flights: &[FlightScore],
        weights: &Weights,
        rows: &mut Rows,
    ) -> Option<()> {
        let tuning = self.problem.tuning();
        for (index, limit) in tuning.limits.iter().enumerate() {
            let place = tuning.objectives.len() + index;
            let values = flights.iter().enumerate();
            let mean: f64 =
                values.map(|(job, flight)| weights.share(job) * flight.values[place]).sum();
            let (excess, by) = excess(limit, mean);
            if !(excess > -NEAR) {
                continue;
            }
            let found = self.slope_of(built, point, &weights.of_limit(index, by))?;
            rows.ways_back += 1;
            rows.analyses += found.analyses;
            let (of, slope) = (Which::Mean(index), found.slope);
            rows.limits.push(Row { of, excess, slope, share: 1.0 });
        }
        Some(())
    }

    /// Limits of flights: of each flight its first one together, then its second one, and so on.
    fn add_flights(
        &self,
        (point, built): (&[f64], &Built),
        weights: &Weights,
        rows: &mut Rows,
    ) -> Option<()> {
        let asked = |job: usize, number: usize| {
            let mut of_flight = self.jobs[job].asked.iter().filter(|it| is_of(it, SlopeOf::Flight));
            of_flight.nth(number)
        };
        for number in 0.. {
            let jobs: Vec<usize> =
                (0..self.jobs.len()).filter(|job| asked(*job, number).is_some()).collect();
            if jobs.is_empty() {
                return Some(());
            }
            let price = |job: usize, flown: &Flown, prepared: &Prepared| {
                asked(job, number).map_or((Slopes::zero(flown.theta_rad.len()), None), |it| {
                    price_of_excess(it, flown, prepared)
                })
            };
            rows.ways_back += 1;
            for priced in self.priced(built, &jobs, point, &price)? {
                let Some(excess) = priced.value else { continue };
                let mut slope = vec![0.0; point.len()];
                add_columns(built, built.class[priced.job], &priced.gradient, &mut slope);
                let of = Which::Flight(priced.job, number);
                rows.limits.push(Row { of, excess, slope, share: weights.share(priced.job) });
            }
        }
        None
    }

    fn add_near_loops(&self, point: &[f64], weights: &Weights, rows: &mut Rows) -> Option<()> {
        let near: Vec<(Vec<NearLoop<'_>>, usize)> = (0..self.jobs.len())
            .into_par_iter()
            .map(|job| self.near_loops(job, point))
            .collect::<Option<_>>()?;
        rows.analyses += near.iter().map(|(_, analyses)| analyses).sum::<usize>();
        for (job, (near, _)) in near.iter().enumerate().filter(|(_, (near, _))| !near.is_empty()) {
            let differences: Vec<Option<Vec<f64>>> = (0..point.len())
                .into_par_iter()
                .map(|coordinate| self.differences(job, near, point, coordinate))
                .collect();
            rows.analyses += point.len();
            for (place, it) in near.iter().enumerate() {
                // Where the loop next to it cannot be judged, that coordinate is told to do nothing.
                let by = |found: &Option<Vec<f64>>| found.as_ref().map_or(0.0, |it| it[place]);
                let slope = differences.iter().map(by).collect();
                let of = Which::Loop(job, it.number);
                let share = weights.share(job);
                rows.limits.push(Row { of, excess: it.excess, slope, share });
            }
        }
        Some(())
    }

    /// Limits of a flight's linear loop that are near, and how many loops were analysed to know that.
    fn near_loops(&self, job: usize, point: &[f64]) -> Option<(Vec<NearLoop<'_>>, usize)> {
        let Job { case, run, asked, .. } = &self.jobs[job];
        let of_loop: Vec<&Requirement> =
            asked.iter().filter(|it| is_of(it, SlopeOf::Loop)).collect();
        if of_loop.is_empty() && !self.problem.removes_constant_load() {
            return Some((Vec::new(), 0));
        }
        let study = self.problem.its_flights().study(point, case, *run).ok()?;
        let mut near = Vec::new();
        for (number, requirement) in of_loop.iter().enumerate() {
            let measure = LoopMeasure::Required(requirement);
            let Some(value) = measure.value(&study) else { continue };
            let (excess, by) = excess(requirement, value);
            if excess > -NEAR_OF_LOOP {
                near.push(NearLoop { measure, number, value, excess, by });
            }
        }
        let load = self.problem.removes_constant_load().then(|| LoopMeasure::Load.value(&study));
        if let Some(left) = load.flatten().filter(|left| *left > 0.0) {
            let (measure, number) = (LoopMeasure::Load, of_loop.len());
            near.push(NearLoop { measure, number, value: left, excess: left, by: 1.0 });
        }
        Some((near, 1))
    }

    /// What a coordinate changes of how far each of them is beyond.
    fn differences(
        &self,
        job: usize,
        near: &[NearLoop<'_>],
        point: &[f64],
        coordinate: usize,
    ) -> Option<Vec<f64>> {
        let mut moved = point.to_vec();
        let here = moved[coordinate];
        let up = here + LOOP_STEP <= 1.0;
        moved[coordinate] = if up { here + LOOP_STEP } else { here - LOOP_STEP };
        let by = moved[coordinate] - here;
        let Job { case, run, .. } = &self.jobs[job];
        let study = self.problem.its_flights().study(&moved, case, *run).ok()?;
        let difference = |it: &NearLoop<'_>| {
            let found = it.by * (it.measure.value(&study)? - it.value) / by;
            found.is_finite().then_some(found)
        };
        near.iter().map(difference).collect()
    }
}

/// A limit of a linear loop that is near.
#[derive(Debug)]
struct NearLoop<'a> {
    measure: LoopMeasure<'a>,
    number: usize,
    value: f64,
    excess: f64,
    /// What a unit of the measure adds to the excess.
    by: f64,
}

/// What a little more of each sample adds to how far a flight is beyond a limit, and how far that is; nothing where it is
/// far within.
fn price_of_excess(
    requirement: &Requirement,
    flown: &Flown,
    prepared: &Prepared,
) -> (Slopes, Option<f64>) {
    let flight = Sloped { flown, edges: prepared.edges(), timing: prepared.timing() };
    let mut slopes = Slopes::zero(flown.theta_rad.len());
    let Some(value) = add_slopes(flight, requirement, 0.0, &mut slopes) else {
        return (slopes, None);
    };
    let (excess, by) = excess(requirement, value);
    if !(excess > -NEAR) {
        return (slopes, None);
    }
    add_slopes(flight, requirement, by, &mut slopes);
    (slopes, Some(excess))
}
