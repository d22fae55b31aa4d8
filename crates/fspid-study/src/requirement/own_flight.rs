//! Flights of their own: a ready set asks for a step of its size, which the scenario may not have.

use fspid_sim::SimError;
use fspid_sim::signal::{Profile, Shape};

use super::{Judgement, NotEvaluated};
use crate::file::Study;
use crate::simulation::Simulation;
use crate::units::radians;

/// Judges anew what a ready set asks of a step that the command does not have: on a flight of the same scenario with
/// one step of that size at its start in place of the command. Everything else is as the scenario says.
///
/// Requirements that are written out, and ask for a step by their own `step_deg`, choose among the steps that there are.
///
/// # Errors
/// [`SimError`] where the scenario cannot be flown.
pub(crate) fn flown(study: &Study, judgements: &mut [Judgement]) -> Result<(), SimError> {
    let mut sizes_deg: Vec<f64> = Vec::new();
    for size_deg in judgements.iter().filter_map(step_of_set) {
        if !sizes_deg.contains(&size_deg) {
            sizes_deg.push(size_deg);
        }
    }
    for size_deg in sizes_deg {
        let own = with_step(study, size_deg)?;
        let judged = Simulation::as_commanded(&own)?.judgements;
        for judgement in judgements.iter_mut() {
            let is_of_it = step_of_set(judgement) == Some(size_deg);
            let anew = judged.iter().find(|new| {
                is_of_it
                    && new.controller == judgement.controller
                    && new.requirement.id == judgement.requirement.id
            });
            if let Some(anew) = anew {
                *judgement = Judgement { own_step_deg: Some(size_deg), ..anew.clone() };
            }
        }
    }
    Ok(())
}

/// The size of the step that a line of a ready set asks for in vain, deg.
fn step_of_set(judgement: &Judgement) -> Option<f64> {
    let Err(NotEvaluated::NoStepOf { asked_deg, .. }) = &judgement.found else {
        return None;
    };
    judgement.requirement.origin.set.is_some().then_some(*asked_deg)
}

/// The study with one step at its start.
fn with_step(study: &Study, size_deg: f64) -> Result<Study, SimError> {
    let mut own = study.clone();
    own.scenario.setpoint = Profile::new(radians(size_deg), Shape::Step { at_s: 0.0 })?;
    Ok(own)
}
