//! Exact-penalty merit function of descent methods: cost of a candidate plus its weighted constraint violation.

use fspid_scenario::requirement::Requirement;
use fspid_scenario::tuning::Tuning;

use crate::score::{FlightScore, UNKNOWN, beyond_limit, brought_together, shares};

/// The merit of a candidate: its cost, and `weight` times how far requirements and limits are broken, an exact penalty.
/// What the answer tells, and which candidate is the best, are by [`Score`](crate::Score) alone.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Merit {
    /// Infinite where a flight is lost.
    pub(crate) value: f64,
    /// What is broken, 0 where all is met.
    pub(crate) violation: f64,
    pub(crate) weights: Weights,
}

/// What each measure of each flight adds to a merit.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Weights {
    /// What a unit of a flight's cost adds.
    by_cost: Vec<f64>,
    /// What a unit of the limited measures adds, for each flight whose case weighs 1.
    by_limit: Vec<f64>,
    /// Share of each flight in a mean.
    by_mean: Vec<f64>,
    /// What a unit of violation of each flight adds; 0 where all is met.
    by_violation: Vec<f64>,
}

/// A measure and what a unit of it adds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weight<'a> {
    pub(super) requirement: &'a Requirement,
    pub(super) by_value: f64,
}

impl Merit {
    pub(super) fn of(flights: &[FlightScore], cases: &[f64], tuning: &Tuning, weight: f64) -> Self {
        let measured = tuning.objectives.len() + tuning.limits.len();
        if flights.iter().any(|flight| flight.values.len() != measured) {
            let (value, violation) = (f64::INFINITY, f64::INFINITY);
            return Self { value, violation, weights: Weights::default() };
        }
        let whole: f64 = cases.iter().sum();
        let cost_of = |flight: &FlightScore| -> f64 {
            let parts = tuning.objectives.iter().zip(&flight.values);
            parts.map(|(objective, value)| objective.weight * value).sum()
        };
        let costs: Vec<f64> = flights.iter().map(cost_of).collect();
        let cost = brought_together(&costs, cases, tuning.over);
        let mean = |of: &dyn Fn(&FlightScore) -> f64| -> f64 {
            flights.iter().zip(cases).map(|(flight, case)| case * of(flight)).sum::<f64>() / whole
        };
        let mut violation = mean(&|flight| flight.violation);
        let mut by_limit = Vec::with_capacity(tuning.limits.len());
        for (index, limit) in tuning.limits.iter().enumerate() {
            let mean = mean(&|flight| flight.values[tuning.objectives.len() + index]);
            violation += beyond_limit(limit, mean);
            by_limit.push(weight * beyond(limit, mean));
        }
        let by_mean: Vec<f64> = cases.iter().map(|case| case / whole).collect();
        let broken = |(flight, share): (&FlightScore, &f64)| {
            if flight.violation > 0.0 { weight * share } else { 0.0 }
        };
        let weights = Weights {
            by_cost: shares(&costs, cases, tuning.over),
            by_limit,
            by_violation: flights.iter().zip(&by_mean).map(broken).collect(),
            by_mean,
        };
        let value = cost + weight * violation;
        let value = if value.is_finite() { value } else { f64::INFINITY };
        Self { value, violation, weights }
    }
}

impl Weights {
    /// What is measured of a flight, objectives first, with what a unit of each adds.
    pub(super) fn measured<'a>(
        &self,
        job: usize,
        tuning: &'a Tuning,
    ) -> impl Iterator<Item = Weight<'a>> {
        let (by_cost, share) = (self.by_cost[job], self.by_mean[job]);
        let objectives = tuning
            .objectives
            .iter()
            .map(move |it| Weight { requirement: &it.requirement, by_value: by_cost * it.weight });
        let by_limit = self.by_limit.clone();
        let limits = tuning
            .limits
            .iter()
            .zip(by_limit)
            .map(move |(requirement, by_limit)| Weight { requirement, by_value: share * by_limit });
        objectives.chain(limits)
    }

    /// Those of one mean that is limited, and of nothing else.
    pub(super) fn of_limit(&self, limit: usize, by: f64) -> Self {
        let mut by_limit = vec![0.0; self.by_limit.len()];
        by_limit.iter_mut().skip(limit).take(1).for_each(|it| *it = by);
        Self {
            by_cost: vec![0.0; self.by_cost.len()],
            by_limit,
            by_mean: self.by_mean.clone(),
            by_violation: vec![0.0; self.by_violation.len()],
        }
    }

    /// Share of a flight in a mean.
    pub(super) fn share(&self, job: usize) -> f64 {
        self.by_mean[job]
    }

    /// True for a candidate that is lost, which has none.
    pub(super) fn is_none(&self) -> bool {
        self.by_cost.is_empty()
    }

    /// What a unit of a flight's violation adds; 0 where all is met.
    pub(super) fn by_violation(&self, job: usize) -> f64 {
        self.by_violation[job]
    }
}

/// What a unit of a measure adds to how far a requirement is broken; 0 where it is met, and where it is broken by so much
/// that the violation counts no more.
pub(super) fn beyond(requirement: &Requirement, value: f64) -> f64 {
    if requirement.is_met_by(value) || beyond_limit(requirement, value) >= UNKNOWN {
        return 0.0;
    }
    let is_below =
        requirement.least.is_some_and(|least| requirement.measure.compared(value) < least);
    if is_below { -1.0 / scale(requirement) } else { 1.0 / scale(requirement) }
}

/// How far a value is beyond the nearer limit, as a share of the limit, negative within; and what a unit of the measure
/// adds to that.
pub(super) fn excess(requirement: &Requirement, value: f64) -> (f64, f64) {
    let (compared, scale) = (requirement.measure.compared(value), scale(requirement));
    let below = requirement.least.map_or(f64::NEG_INFINITY, |least| least - compared);
    let above = requirement.most.map_or(f64::NEG_INFINITY, |most| compared - most);
    if below > above { (below / scale, -1.0 / scale) } else { (above / scale, 1.0 / scale) }
}

/// What a violation counts as a whole.
fn scale(requirement: &Requirement) -> f64 {
    let limit = requirement.most.or(requirement.least).unwrap_or(1.0).abs();
    if limit > 0.0 { limit } else { 1.0 }
}
