//! The sets of a supervisor as its flight sees them, and how often each rule is the strongest.

use fspid_core::{SelfTuner, SetCentres};
use fspid_fuzzy::LABEL_COUNT;
use fspid_scenario::file::Study;
use fspid_sim::Controller;

use crate::analysis::flown_inputs;

/// Points of a curve.
const POINTS: u32 = 241;

/// The sets of both inputs.
#[derive(Clone, Debug)]
pub struct SetCurves {
    /// Values of an input over the range.
    pub inputs: Vec<f64>,
    /// Of the error and of what is seen beside it: a column for each label.
    pub grades: [[Vec<f64>; LABEL_COUNT]; 2],
}

/// Grades of the sets of a tuner over its range, with the places to which their centres were moved; zeros for a network.
#[must_use]
pub fn set_curves(tuner: &SelfTuner<f64>) -> SetCurves {
    let (supervisor, sets) = (tuner.supervisor(), tuner.settings().input_sets);
    let range = supervisor.range();
    let last = f64::from(POINTS - 1);
    let inputs: Vec<f64> = (0..POINTS).map(|k| range * (2.0 * f64::from(k) / last - 1.0)).collect();
    let of = |centres: Option<SetCentres<f64>>| {
        let all = inputs.iter().map(|&input| supervisor.grades(even(centres, input, range)));
        let all: Vec<[f64; LABEL_COUNT]> = all.collect();
        std::array::from_fn(|label| all.iter().map(|grades| grades[label]).collect())
    };
    let grades = [of(sets.error), of(sets.change)];
    SetCurves { inputs, grades }
}

fn even(centres: Option<SetCentres<f64>>, input: f64, range: f64) -> f64 {
    centres.map_or(input, |centres| centres.warp(input, range))
}

/// Of how many samples of a controller's flight each rule is the strongest, by the places of its labels; zeros for a
/// controller without a supervisor or with a network, and for one that sees no change.
#[must_use]
pub fn visits(study: &Study, name: &str) -> [[u32; LABEL_COUNT]; LABEL_COUNT] {
    let mut counts = [[0; LABEL_COUNT]; LABEL_COUNT];
    let named = study.scenario.controllers.iter().find(|named| named.name == name);
    let Some(Controller::SelfTuning(fspid)) = named.map(|named| &named.controller) else {
        return counts;
    };
    let (supervisor, sets) = (fspid.tuner().supervisor(), fspid.tuner().settings().input_sets);
    if supervisor.network().is_some() {
        return counts;
    }
    let strongest = |input: f64, centres| {
        let grades = supervisor.grades(even(centres, input, supervisor.range()));
        let order = grades.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        order.map_or(0, |(label, _)| label)
    };
    for (error, change) in flown_inputs(study, name) {
        counts[strongest(error, sets.error)][strongest(change, sets.change)] += 1;
    }
    counts
}
