//! What a candidate is worth: costs of flights, and how they become one.

use fspid_campaign::engine::FlightResult;
use fspid_study::metrics::Verdict;
use fspid_study::requirement::{Judgement, Requirement};
use fspid_study::tuning::{Objective, Over};
use serde::{Deserialize, Serialize};

/// Cost above which candidates break a requirement or cannot be flown; what is allowed costs no more, however
/// bad it is.
pub const FORBIDDEN: f64 = 1e12;
/// Violation of a flight that is lost at its end; one that is lost at once counts twice.
const LOST: f64 = 1e3;
/// Violation of a candidate that is no scenario.
const REFUSED: f64 = 1e4;
/// Violation of a requirement that has no value.
const UNKNOWN: f64 = 10.0;

/// What one flight is worth.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FlightScore {
    /// How far requirements are broken, 0 where they are met.
    pub(crate) violation: f64,
    /// Values of the objectives' measures, in their order; nothing for a flight that is lost.
    pub(crate) values: Vec<f64>,
    /// Why there is no value, or which requirements are broken.
    pub(crate) reasons: Vec<String>,
}

impl FlightScore {
    /// Numbers that make no scenario.
    pub(crate) fn refused(reason: String) -> Self {
        Self { violation: REFUSED, values: Vec::new(), reasons: vec![reason] }
    }

    /// Of a flight whose judgements end with those of the objectives.
    pub(crate) fn of(flight: &FlightResult, objectives: usize, duration_s: f64) -> Self {
        let split = flight.judgements.len().saturating_sub(objectives);
        let (asked, measured) = flight.judgements.split_at(split);
        if flight.metrics.verdict.is_failure() {
            let late = match flight.metrics.verdict {
                Verdict::Diverged { at_s } => (at_s / duration_s).clamp(0.0, 1.0),
                _ => 1.0,
            };
            let reasons = vec![flight.metrics.verdict.to_string()];
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
        let reasons = missing.chain(broken).collect();
        let violation: f64 = asked.iter().map(violation).sum();
        match values {
            Some(values) => Self { violation, values, reasons },
            None => Self { violation: violation + LOST, values: Vec::new(), reasons },
        }
    }
}

fn value(judgement: &Judgement) -> Option<f64> {
    let value = judgement.found.as_ref().ok()?.value;
    let value = judgement.requirement.measure.compared(value);
    value.is_finite().then_some(value)
}

/// How far a requirement is broken, as a share of its limit.
fn violation(judgement: &Judgement) -> f64 {
    if judgement.met {
        return 0.0;
    }
    let requirement = &judgement.requirement;
    let slack = judgement.found.as_ref().ok().map(|case| requirement.slack(case.value));
    let limit = requirement.most.or(requirement.least).unwrap_or(1.0).abs();
    let scale = if limit > 0.0 { limit } else { 1.0 };
    match slack {
        // A little more than nothing, so that a limit that is missed by a rounding is missed.
        Some(slack) if slack.is_finite() => (-slack / scale).clamp(1e-12, UNKNOWN),
        _ => UNKNOWN,
    }
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
    /// How far requirements are broken on average; 0 where all are met.
    pub violation: f64,
}

impl Score {
    /// True where every flight came back and met its requirements.
    #[must_use]
    pub fn is_allowed(&self) -> bool {
        self.violation == 0.0
    }

    /// Of the flights of a candidate with the weights of their cases.
    pub(crate) fn over(
        flights: &[FlightScore],
        weights: &[f64],
        (over, objectives): (Over, &[Objective]),
    ) -> Self {
        let whole = weights.iter().sum::<f64>();
        let violation = weighted(flights.iter().map(|flight| flight.violation), weights) / whole;
        let is_lost = flights.iter().any(|flight| flight.values.len() != objectives.len());
        let of = |index: usize| -> Vec<f64> {
            flights.iter().filter_map(|flight| flight.values.get(index).copied()).collect()
        };
        let (mut values, mut costs, mut cost) = (Vec::new(), Vec::new(), 0.0);
        if !is_lost {
            let all: Vec<Vec<f64>> = (0..objectives.len()).map(of).collect();
            let costs_of = |flight: usize| -> f64 {
                all.iter().zip(objectives).map(|(values, it)| it.weight * values[flight]).sum()
            };
            cost = brought_together(
                &(0..flights.len()).map(costs_of).collect::<Vec<_>>(),
                weights,
                over,
            );
            for (column, objective) in all.iter().zip(objectives) {
                let sign = objective.weight.signum();
                let signed: Vec<f64> = column.iter().map(|value| sign * value).collect();
                let value = sign * brought_together(&signed, weights, over);
                values.push(value);
                costs.push(objective.weight * value);
            }
        }
        if violation > 0.0 || is_lost {
            cost = FORBIDDEN * (1.0 + violation);
            costs = vec![cost; objectives.len()];
        } else {
            cost = cost.min(FORBIDDEN);
            costs.iter_mut().for_each(|cost| *cost = cost.min(FORBIDDEN));
        }
        let cost = if cost.is_nan() { f64::INFINITY } else { cost };
        Self { cost, objectives: costs, values, violation }
    }
}

fn weighted(values: impl Iterator<Item = f64>, weights: &[f64]) -> f64 {
    values.zip(weights).map(|(value, weight)| value * weight).sum()
}

/// One number for many: their mean, the greatest, or the mean of the greatest by weight.
fn brought_together(values: &[f64], weights: &[f64], over: Over) -> f64 {
    let whole = weights.iter().sum::<f64>();
    let share = match over {
        Over::Mean => return weighted(values.iter().copied(), weights) / whole,
        Over::Worst => return values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        Over::Tail { share } => share,
    };
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
    let (mut left, mut sum) = (share * whole, 0.0);
    for index in order {
        // The last flight that counts counts in part.
        let taken = weights[index].min(left);
        sum += taken * values[index];
        left -= taken;
        if !(left > 0.0) {
            break;
        }
    }
    sum / (share * whole)
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
}
