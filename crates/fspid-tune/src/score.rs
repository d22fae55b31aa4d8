//! Scalar cost of a candidate: how the costs of its flights are combined.

use fspid_campaign::engine::FlightResult;
use fspid_scenario::requirement::Requirement;
use fspid_scenario::tuning::{Over, Tuning};
use fspid_sim::load::{ConstantLoad, HALF_GONE};
use fspid_study::judgement::Judgement;
use fspid_study::metrics::Verdict;
use serde::{Deserialize, Serialize};

use crate::bits;

/// Cost above which candidates break a requirement or cannot be flown; what is allowed costs no more, however
/// bad it is.
pub const FORBIDDEN: f64 = 1e12;
/// Violation of a flight that is lost at its end; one that is lost at once counts twice.
const LOST: f64 = 1e3;
/// Violation of a candidate that is no scenario.
const REFUSED: f64 = 1e4;
/// Least violation of a constant load that is not half gone: any that is above 0, as little may be left for good.
const LEAST_OF_LOAD: f64 = 1e-3;
/// Violation of a requirement that has no value, and the most of any.
pub(crate) const UNKNOWN: f64 = 10.0;

/// What one flight is worth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct FlightScore {
    /// How far requirements are broken, 0 where they are met.
    #[serde(with = "bits")]
    pub(crate) violation: f64,
    /// Values of the measures of objectives and limits, in their order; nothing for a flight that is lost.
    #[serde(with = "bits")]
    pub(crate) values: Vec<f64>,
    /// Why there is no value, or which requirements are broken.
    pub(crate) reasons: Vec<String>,
}

impl FlightScore {
    /// Numbers that make no scenario.
    pub(crate) fn refused(reason: String) -> Self {
        Self { violation: REFUSED, values: Vec::new(), reasons: vec![reason] }
    }

    /// Of a flight, with the judgements of what is asked of it and of what is measured for objectives and limits.
    pub(crate) fn of(
        flight: &FlightResult,
        (asked, measured): (&[Judgement], &[Judgement]),
        duration_s: f64,
    ) -> Self {
        if flight.metrics.verdict.is_failure() {
            let late = match flight.metrics.verdict {
                Verdict::EndedEarly(end) => (end.at_s / duration_s).clamp(0.0, 1.0),
                _ => 1.0,
            };
            let mut reasons = flight.ending().failures();
            reasons.extend(flight.metrics.wrong_way.then(|| flight.at_rest.wrong_way_in_words()));
            return Self { violation: LOST * (2.0 - late), values: Vec::new(), reasons };
        }
        let values: Option<Vec<f64>> = measured.iter().map(value).collect();
        let missing = measured.iter().filter(|judgement| value(judgement).is_none());
        let missing = missing.map(|judgement| {
            let name = judgement.requirement.measure.name();
            format!("no {name}: {}", judgement.value_in_words())
        });
        let broken = asked.iter().filter(|judgement| !judgement.met).map(|judgement| {
            let Requirement { id, .. } = &judgement.requirement;
            format!(
                "{id} {}, {}",
                judgement.value_in_words(),
                judgement.requirement.limits_in_words()
            )
        });
        let left = flight.ending().failing_exit();
        let own = flight.ending().failures().into_iter();
        let reasons = own.chain(missing).chain(broken).collect();
        let violation: f64 = asked.iter().map(violation).sum::<f64>()
            + left.map_or(0.0, |exit| 1.0 + (exit.outside_s / duration_s).clamp(0.0, 1.0));
        match values {
            Some(values) => Self { violation, values, reasons },
            None => Self { violation: violation + LOST, values: Vec::new(), reasons },
        }
    }

    /// The same where a constant load must not stay.
    pub(crate) fn with_load(mut self, flight: &FlightResult, duration_s: f64) -> Self {
        if let Some(load) = flight.at_rest.load.filter(|load| !load.is_half_gone()) {
            self.violation += load_left(&load);
            self.reasons.extend(flight.at_rest.load_in_words(duration_s));
        }
        self
    }
}

/// How much more of a constant load is left than is allowed, as a share of its largest effect.
pub(crate) fn load_left(load: &ConstantLoad) -> f64 {
    let beyond = load.share_left() - HALF_GONE;
    // Written so that NaN is all of it.
    if beyond <= 1.0 { beyond.max(LEAST_OF_LOAD) } else { 1.0 }
}

fn value(judgement: &Judgement) -> Option<f64> {
    let value = judgement.found.as_ref().ok()?.value;
    let value = judgement.requirement.measure.compared(value);
    value.is_finite().then_some(value)
}

/// How far a requirement is broken, as a share of its limit.
pub(crate) fn violation(judgement: &Judgement) -> f64 {
    if judgement.met {
        return 0.0;
    }
    let found = judgement.found.as_ref().ok();
    found.map_or(UNKNOWN, |case| share_beyond(&judgement.requirement, case.value))
}

/// How far a value is beyond a limit that it does not meet, as a share of the limit.
fn share_beyond(requirement: &Requirement, value: f64) -> f64 {
    let limit = requirement.most.or(requirement.least).unwrap_or(1.0).abs();
    let scale = if limit > 0.0 { limit } else { 1.0 };
    let slack = requirement.slack(value);
    // A little more than nothing, so that a limit that is missed by a rounding is missed.
    if slack.is_finite() { (-slack / scale).clamp(1e-12, UNKNOWN) } else { UNKNOWN }
}

/// What a candidate is worth over all its flights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// What the search makes small.
    pub cost: f64,
    /// Cost of each objective alone, its weight in it; [`FORBIDDEN`] and more where requirements are broken.
    pub objectives: Vec<f64>,
    /// Values of the objectives' measures, brought together as the costs are; nothing where a flight is lost.
    pub values: Vec<f64>,
    /// Means of what is limited on average; nothing where a flight is lost.
    #[serde(default)]
    pub limited: Vec<f64>,
    /// How far requirements are broken on average, and limits of means; 0 where all are met.
    pub violation: f64,
}

impl Score {
    /// True where every flight came back and met its requirements.
    #[must_use]
    pub fn is_allowed(&self) -> bool {
        self.violation == 0.0
    }

    /// Of the flights of a candidate with the weights of their cases.
    pub(crate) fn over(flights: &[FlightScore], weights: &[f64], tuning: &Tuning) -> Self {
        let whole = weights.iter().sum::<f64>();
        let measured = tuning.objectives.len() + tuning.limits.len();
        let broken = weighted(flights.iter().map(|flight| flight.violation), weights) / whole;
        if flights.iter().any(|flight| flight.values.len() != measured) {
            return Self::forbidden(broken, tuning, (Vec::new(), Vec::new()));
        }
        let column = |index: usize| -> Vec<f64> {
            flights.iter().filter_map(|flight| flight.values.get(index).copied()).collect()
        };
        let limited = (tuning.objectives.len()..measured)
            .map(|index| weighted(column(index).into_iter(), weights) / whole);
        let limited: Vec<f64> = limited.collect();
        let values: Vec<f64> = tuning
            .objectives
            .iter()
            .enumerate()
            .map(|(index, objective)| {
                let sign = objective.weight.signum();
                let signed: Vec<f64> = column(index).iter().map(|value| sign * value).collect();
                sign * brought_together(&signed, weights, tuning.over)
            })
            .collect();
        let beyond = tuning.limits.iter().zip(&limited);
        let violation =
            broken + beyond.map(|(limit, mean)| beyond_limit(limit, *mean)).sum::<f64>();
        if violation > 0.0 {
            return Self::forbidden(violation, tuning, (values, limited));
        }
        let cost_of = |flight: &FlightScore| -> f64 {
            let parts = tuning.objectives.iter().zip(&flight.values);
            parts.map(|(objective, value)| objective.weight * value).sum()
        };
        let costs: Vec<f64> = flights.iter().map(cost_of).collect();
        let allowed = |cost: f64| if cost.is_nan() { f64::INFINITY } else { cost.min(FORBIDDEN) };
        let parts = tuning.objectives.iter().zip(&values);
        Self {
            cost: allowed(brought_together(&costs, weights, tuning.over)),
            objectives: parts.map(|(it, value)| (it.weight * value).min(FORBIDDEN)).collect(),
            values,
            limited,
            violation,
        }
    }

    /// Of a candidate that breaks requirements or limits, or is lost.
    fn forbidden(violation: f64, tuning: &Tuning, (values, limited): (Vec<f64>, Vec<f64>)) -> Self {
        let cost = FORBIDDEN * (1.0 + violation);
        let cost = if cost.is_nan() { f64::INFINITY } else { cost };
        Self { cost, objectives: vec![cost; tuning.objectives.len()], values, limited, violation }
    }
}

/// How far a value is beyond its limit, as a share of the limit; 0 where it is met.
pub(crate) fn beyond_limit(limit: &Requirement, value: f64) -> f64 {
    if limit.is_met_by(value) { 0.0 } else { share_beyond(limit, value) }
}

fn weighted(values: impl Iterator<Item = f64>, weights: &[f64]) -> f64 {
    values.zip(weights).map(|(value, weight)| value * weight).sum()
}

/// One number for many: their mean, the greatest, or the mean of the greatest by weight.
pub(crate) fn brought_together(values: &[f64], weights: &[f64], over: Over) -> f64 {
    let whole = weights.iter().sum::<f64>();
    let share = match over {
        Over::Mean => return weighted(values.iter().copied(), weights) / whole,
        Over::Worst => return values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        Over::Tail { share } => share,
    };
    let taken = greatest(values, weights, share * whole);
    taken.fold(0.0, |sum, (index, taken)| sum + taken * values[index]) / (share * whole)
}

/// The greatest values until so much weight is counted: which, and the weight of each. The last may count in part.
fn greatest(values: &[f64], weights: &[f64], weight: f64) -> impl Iterator<Item = (usize, f64)> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
    let mut left = weight;
    order.into_iter().map_while(move |index| {
        let taken = weights[index].min(left);
        let counts = left > 0.0;
        left -= taken;
        counts.then_some((index, taken))
    })
}

/// What a unit of each value adds to what they are together.
pub(crate) fn shares(values: &[f64], weights: &[f64], over: Over) -> Vec<f64> {
    let whole = weights.iter().sum::<f64>();
    let mut shares = vec![0.0; values.len()];
    let share = match over {
        Over::Mean => return weights.iter().map(|weight| weight / whole).collect(),
        Over::Worst => {
            let worst = (0..values.len()).reduce(|a, b| if values[b] > values[a] { b } else { a });
            worst.into_iter().for_each(|worst| shares[worst] = 1.0);
            return shares;
        }
        Over::Tail { share } => share,
    };
    for (index, taken) in greatest(values, weights, share * whole) {
        shares[index] = taken / (share * whole);
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flights_are_brought_together_by_mean_worst_or_tail() {
        let (values, weights) = ([1.0, 4.0, 2.0, 3.0], [1.0; 4]);
        assert_eq!(brought_together(&values, &weights, Over::Mean), 2.5);
        assert_eq!(brought_together(&values, &weights, Over::Worst), 4.0);
        assert_eq!(brought_together(&values, &weights, Over::Tail { share: 0.5 }), 3.5);
        // Rockafellar and Uryasev (2000): a flight is split where the share ends in it.
        let cut = brought_together(&values, &weights, Over::Tail { share: 0.375 });
        assert!((cut - (4.0 + 0.5 * 3.0) / 1.5).abs() < 1e-15);
        assert_eq!(brought_together(&values, &[1.0, 3.0, 1.0, 1.0], Over::Mean), 3.0);
    }

    #[test]
    fn shares_are_the_slopes_of_what_flights_are_together() {
        let (values, weights) = ([1.0, 4.0, 2.0, 3.0], [1.0, 0.5, 2.0, 1.0]);
        for over in [Over::Mean, Over::Worst, Over::Tail { share: 0.4 }, Over::Tail { share: 1.0 }]
        {
            let found = shares(&values, &weights, over);
            for (index, share) in found.iter().enumerate() {
                let moved = |by: f64| {
                    let mut moved = values;
                    moved[index] += by;
                    brought_together(&moved, &weights, over)
                };
                let slope = (moved(1e-3) - moved(-1e-3)) / 2e-3;
                assert!((share - slope).abs() < 1e-9, "{over:?} {index}: {share} {slope}");
            }
        }
    }
}
