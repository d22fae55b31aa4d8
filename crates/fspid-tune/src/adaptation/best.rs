//! The frozen gains that are best for one plant: what somebody could set who knows it.

use fspid_campaign::engine::{FlightResult, Memory};
use fspid_core::Gains;
use fspid_optimise::{Kind, Parameter, Plan, Scale, Space, Start, minimise};
use fspid_scenario::file::Study;
use fspid_sim::batch::LANES;
use rayon::prelude::*;

use super::flown::{Value, Watch, frozen, judged, tuner};
use crate::error::TuneError;
use crate::score::{FORBIDDEN, violation};

/// How far a gain without limits may move from the nominal one, as a factor.
const REACH: f64 = 4.0;
/// How wide the first candidates lie about the mean gains, as a share of the box.
const SPREAD: f64 = 0.2;
/// Cost of a candidate that loses a flight.
const LOST: f64 = 1e3;

/// A flight of the plant: its study, and how it is flown as it is.
pub(super) struct Asked {
    pub(super) study: Study,
    pub(super) as_it_is: FlightResult,
}

/// What was found for a plant.
#[derive(Clone, Debug)]
pub(super) struct Best {
    pub(super) gains: Gains<f64>,
    /// Its flights, in the order of those that were asked.
    pub(super) values: Vec<Value>,
}

/// How far gains may go: their limits, or [`REACH`] times nominal either way where there is none; a gain that is zero stays zero.
fn space(study: &Study) -> Option<(Space, [Option<f64>; 3])> {
    let tuner = tuner(study)?.tuner();
    let (nominal, limits) = (tuner.nominal(), tuner.settings().gain_limits);
    let limited = limits.map(|it| [it.kp, it.ki, it.kd].map(|it| [it.lower(), it.upper()]));
    let (mut parameters, mut fixed) = (Vec::new(), [None; 3]);
    let names = ["kp", "ki", "kd"];
    for (place, nominal) in [nominal.kp, nominal.ki, nominal.kd].into_iter().enumerate() {
        let far = [nominal / REACH, nominal * REACH];
        let far = [far[0].min(far[1]), far[0].max(far[1])];
        // A limit of one side alone leaves the other without one.
        let ends = limited.map_or(far, |it| [0, 1].map(|end| ended(it[place][end], far[end])));
        match ends {
            [lower, upper] if lower < upper => {
                let scale = if lower > 0.0 { Scale::Logarithmic } else { Scale::Linear };
                parameters.push(Parameter { name: names[place], lower, upper, scale });
            }
            _ => fixed[place] = Some(nominal),
        }
    }
    (!parameters.is_empty()).then(|| (Space::new(parameters), fixed))
}

/// A limit that is one, or another.
fn ended(limit: f64, otherwise: f64) -> f64 {
    if limit.is_finite() { limit } else { otherwise }
}

/// The gains of a point.
fn gains(point: &[f64], fixed: [Option<f64>; 3]) -> Gains<f64> {
    let mut rest = point.iter().copied();
    let [kp, ki, kd] = fixed.map(|it| it.or_else(|| rest.next()).unwrap_or(0.0));
    Gains { kp, ki, kd }
}

/// Looks for the gains with the least mean of the IAE beside that of the flights as they are, on all flights of a plant
/// together, with no more travel on average than these took, and without breaking a requirement that they keep. `None`
/// where nothing is free, or no candidate keeps all that.
pub(super) fn best(
    asked: &[Asked],
    start: Gains<f64>,
    (budget, seed): (usize, u64),
    watch: Watch<'_>,
) -> Result<Option<Best>, TuneError> {
    let Some((space, fixed)) = asked.first().and_then(|it| space(&it.study)) else {
        return Ok(None);
    };
    let start = [start.kp, start.ki, start.kd];
    let start: Vec<f64> = start
        .into_iter()
        .zip(fixed)
        .filter_map(|(it, fixed)| fixed.is_none().then_some(it))
        .collect();
    let from = space.unit(&start);
    let dimension = space.dimension();
    let population = LANES.min(budget.max(4));
    let plan = Plan { dimension, population, budget, seed };
    let mut optimiser = Kind::CmaEs.start(plan, Start::About(&from, SPREAD));
    let mut failed = None;
    minimise(optimiser.as_mut(), budget, f64::NEG_INFINITY, |points| {
        let candidates: Vec<Gains<f64>> =
            points.iter().map(|unit| gains(&space.point(unit), fixed)).collect();
        match costs(asked, &candidates, watch) {
            Ok(costs) => costs,
            Err(error) => {
                failed = Some(error);
                vec![f64::INFINITY; points.len()]
            }
        }
    });
    if let Some(error) = failed {
        return Err(error);
    }
    let (unit, cost) = optimiser.best();
    if !(cost < FORBIDDEN) {
        return Ok(None);
    }
    let gains = gains(&space.point(unit), fixed);
    let flown = flights(asked, std::slice::from_ref(&gains), watch)?;
    let values: Option<Vec<Value>> =
        flown.iter().map(|one| Some(Value::of(one.first()?.as_ref()?))).collect();
    Ok(values.map(|values| Best { gains, values }))
}

/// Flights of candidates, a list for each flight of the plant.
type Flown = Vec<Vec<Option<FlightResult>>>;

fn flights(
    asked: &[Asked],
    candidates: &[Gains<f64>],
    watch: Watch<'_>,
) -> Result<Flown, TuneError> {
    let fly = |memory: &mut Memory, asked: &Asked| {
        let studies = candidates.iter().map(|gains| frozen(&asked.study, *gains));
        match studies.collect::<Option<Vec<Study>>>() {
            Some(studies) => judged(memory, &studies, watch),
            None => Ok(vec![None; candidates.len()]),
        }
    };
    asked.par_iter().map_init(Memory::default, fly).collect()
}

fn costs(
    asked: &[Asked],
    candidates: &[Gains<f64>],
    watch: Watch<'_>,
) -> Result<Vec<f64>, TuneError> {
    let flown = flights(asked, candidates, watch)?;
    let cost = |place: usize| {
        let (mut ratio, mut travel, mut limit, mut broken) = (0.0, 0.0, 0.0, 0.0);
        for (asked, flown) in asked.iter().zip(&flown) {
            let flight = flown.get(place).and_then(Option::as_ref);
            let Some((flight, value)) =
                flight.map(|it| (it, Value::of(it))).filter(|(_, value)| !value.lost)
            else {
                broken += LOST;
                continue;
            };
            let before = Value::of(&asked.as_it_is);
            ratio += value.iae_deg_s / before.iae_deg_s;
            travel += value.travel_deg;
            limit += before.travel_deg;
            let judgements = flight.judgements.iter().zip(&asked.as_it_is.judgements);
            broken +=
                judgements.filter(|(_, kept)| kept.met).map(|(it, _)| violation(it)).sum::<f64>();
        }
        broken += if travel > limit { travel / limit - 1.0 } else { 0.0 };
        let count = asked.len().max(1) as f64;
        if broken > 0.0 { FORBIDDEN * (1.0 + broken) } else { ratio / count }
    };
    Ok((0..candidates.len()).map(cost).collect())
}
