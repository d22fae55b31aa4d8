//! Bounds on a loop's gains near its equilibrium.

use fspid_core::{Fspid, Gains};
use fspid_fuzzy::system::System;
use fspid_numeric::scalar::Interval;
use fspid_sim::Controller;
use fspid_sim::loop_model::LoopModel;

use crate::check::{NotProved, reach};
use crate::description::LoopDescription;
use crate::gain_set::{GainSet, GainsOver, HeldGains, input_rows};

use super::terminal::Terminal;
use super::tuned::Tuner;

/// The rules of a self-tuner, made ready to be enclosed.
pub(super) fn system(description: &LoopDescription) -> Option<System> {
    match &description.controller {
        Controller::Fixed(_) => None,
        Controller::SelfTuning(fspid) => system_of(fspid),
    }
}

/// The same of its controller.
pub(crate) fn system_of(fspid: &Fspid<f64>) -> Option<System> {
    System::new(fspid_fuzzy::system::Parts::try_from(fspid.tuner().supervisor()).ok()?).ok()
}

/// Corners of all gains that the controller can have in the ellipsoid $z^T P z \le$ `level` around rest, where they remember
/// in the box that is claimed.
///
/// `held` is the set of all gains, with what they make of the command that is held.
pub(crate) fn corners_within(
    description: &LoopDescription,
    model: &LoopModel<Interval>,
    held: &GainSet,
    terminal: &Terminal,
) -> Result<Vec<HeldGains>, NotProved> {
    let Terminal { form, level, .. } = terminal;
    let level = *level;
    let Controller::SelfTuning(fspid) = &description.controller else {
        return Ok(held.held_corners().map(|(_, corner)| corner).collect());
    };
    if let Some(near) = &terminal.gains {
        let tuner = Tuner::of(fspid).ok_or(NotProved::NotKept)?;
        let seen = seen_within(&tuner, model, terminal)?;
        let bounds = near.bounds();
        if !(near.model_rad >= 0.0) || !tuner.keeps(bounds, seen) {
            return Err(NotProved::NotKept);
        }
        return Ok(boxed(bounds));
    }
    let [error, change] = input_rows(model, fspid);
    let within = [reach(form, level, &error)?, reach(form, level, &change)?];
    let inputs = within.map(|most| Interval::between(-most, most));
    let holds_nothing = held.cells.iter().all(|cell| cell.change_gain <= 0.0);
    if holds_nothing && let Some(gains) = over(description, fspid, inputs) {
        return Ok(boxed(gains));
    }
    let meets = |side: [f64; 2], most: f64| side[0] <= most && side[1] >= -most;
    let cells: Vec<usize> = (0..held.cells.len())
        .filter(|&cell| {
            let cell = &held.cells[cell];
            meets(cell.error, within[0]) && meets(cell.change, within[1])
        })
        .collect();
    let near = held.of_cells(&cells);
    let corners: Vec<HeldGains> = near.held_corners().map(|(_, corner)| corner).collect();
    Ok(corners)
}

/// The gains over a box of inputs.
fn over(
    description: &LoopDescription,
    fspid: &Fspid<f64>,
    inputs: [Interval; 2],
) -> Option<[Interval; 3]> {
    let system = system(description);
    GainsOver::of(fspid.tuner(), system.as_ref())?.over(inputs)
}

/// Corners of a box of gains.
pub(super) fn boxed(gains: [Interval; 3]) -> Vec<HeldGains> {
    let end = |corner: usize, gain: usize| match corner >> gain & 1 {
        0 => gains[gain].lower(),
        _ => gains[gain].upper(),
    };
    let corner = |corner: usize| {
        let [kp, ki, kd] = [0, 1, 2].map(|gain| end(corner, gain));
        HeldGains { gains: Gains { kp, ki, kd }, change_gain: 0.0, remembered: None }
    };
    (0..8).map(corner).collect()
}

/// Most of the error, rad, and of what a supervisor sees beside it, in the ellipsoid around rest.
pub(super) fn seen_within(
    tuner: &Tuner<'_>,
    model: &LoopModel<Interval>,
    terminal: &Terminal,
) -> Result<[f64; 2], NotProved> {
    let Terminal { form, level, gains, .. } = terminal;
    let [error, change] = model.error_rows();
    let error_rad = reach(form, *level, &error)?;
    let model_rad = gains.map_or(0.0, |near| near.model_rad);
    let second = match tuner.change_divisor() {
        Some(divisor) => {
            let most = Interval::point(reach(form, *level, &change)?) / Interval::point(divisor);
            most.upper()
        }
        // The model is off its set-point, and the pitch angle off its own.
        None => (Interval::point(error_rad) + Interval::point(model_rad)).upper(),
    };
    Ok([error_rad, second])
}

#[cfg(test)]
mod tests;
