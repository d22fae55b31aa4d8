//! Flights of their own: a ready set asks for a step of its size, which the scenario may not have.

use fspid_sim::SimError;
use fspid_sim::signal::{Profile, Shape};

use super::{FailedFlight, Judgement, Simulation};
use crate::judgement::NotEvaluated;
use fspid_scenario::file::Study;
use fspid_scenario::requirement::Requirement;
use fspid_scenario::units::{degrees, radians};

/// Judges anew what a ready set asks of a step that the command does not have: on a flight of the same scenario with
/// one step of that size at its start in place of the command, and without the autopilot, which would command another.
/// Everything else is as the scenario says. The answer is those of these flights that fail whatever is required of them.
///
/// Requirements that are written out, and ask for a step by their own `step_deg`, choose among the steps that there are.
///
/// # Errors
/// [`SimError`] where the scenario cannot be flown.
pub(crate) fn flown(
    study: &Study,
    judgements: &mut [Judgement],
) -> Result<Vec<FailedFlight>, SimError> {
    let sizes_deg = sizes_of_steps_deg(study);
    let asked_deg: Vec<Option<f64>> =
        judgements.iter().map(|judgement| missing_step_deg(judgement, &sizes_deg)).collect();
    let mut own_deg: Vec<f64> = Vec::new();
    for size_deg in asked_deg.iter().flatten() {
        if !own_deg.contains(size_deg) {
            own_deg.push(*size_deg);
        }
    }
    let mut failed = Vec::new();
    for size_deg in own_deg {
        let own = Simulation::as_commanded(&with_step(study, size_deg)?)?;
        let mut flown: Vec<&str> = Vec::new();
        for (judgement, asked_deg) in judgements.iter_mut().zip(&asked_deg) {
            let anew = own.judgements.iter().find(|new| {
                *asked_deg == Some(size_deg)
                    && new.controller == judgement.controller
                    && new.requirement.id == judgement.requirement.id
            });
            if let Some(anew) = anew {
                *judgement = Judgement { own_step_deg: Some(size_deg), ..anew.clone() };
                flown.push(&anew.controller);
            }
        }
        let flown = own.results.iter().filter(|result| flown.contains(&result.name.as_str()));
        failed.extend(flown.filter_map(|result| result.failed(Some(size_deg))));
    }
    Ok(failed)
}

/// The sizes of the steps of the command, deg, whatever came of the flight.
fn sizes_of_steps_deg(study: &Study) -> Vec<f64> {
    let timing = study.scenario.timing;
    let (_, edges) = study.scenario.setpoint.sampled(timing);
    // A step at the very last sample has no response to measure.
    let edges = edges.iter().filter(|edge| edge.sample + 1 < timing.rows());
    edges.map(|edge| degrees(edge.to_rad) - degrees(edge.from_rad)).collect()
}

/// The size of the step that a line of a ready set asks for in vain, deg, in an air that it may be flown in.
fn missing_step_deg(judgement: &Judgement, sizes_deg: &[f64]) -> Option<f64> {
    let Requirement { conditions, origin, .. } = &judgement.requirement;
    let asked_deg = conditions.step_deg.filter(|_| origin.set.is_some())?;
    let has_it = sizes_deg.iter().any(|size_deg| conditions.counts_step(*size_deg));
    let is_other_air = matches!(judgement.found, Err(NotEvaluated::OtherAir { .. }));
    (!has_it && !is_other_air).then_some(asked_deg)
}

/// The study with one step at its start.
fn with_step(study: &Study, size_deg: f64) -> Result<Study, SimError> {
    let mut own = study.clone();
    // The step is one of the pitch loop's, whatever stands around it.
    own.scenario.autopilot = None;
    own.scenario.setpoint = Profile::new(radians(size_deg), Shape::Step { at_s: 0.0 })?;
    Ok(own)
}
