//! The parameter vector of a controller: the numbers that a gradient has components for.

use fspid_core::equations::{GainNumbers, PidNumbers, TunerEquations, TunerNumbers};
use fspid_core::fuzzy::{Network, Output};
use fspid_core::{Fspid, Gains, SetCentres};

use super::network::WEIGHTS;
use crate::controller::Controller;

/// Numbers of [`PidNumbers`], [`TunerNumbers`] and of one [`GainNumbers`].
pub(super) const PID: usize = PidNumbers::<f64>::COUNT;
pub(super) const TUNER: usize = TunerNumbers::<f64>::COUNT;
pub(super) const GAIN: usize = GainNumbers::<f64>::COUNT;
/// Cells of one gain's rules.
pub(super) const CELLS: usize = 49;
/// Centres of the small and the medium sets of both inputs.
pub(super) const SETS: usize = 4;
/// Numbers of a controller.
pub const NUMBERS: usize = PID + TUNER + 3 * GAIN + 3 * CELLS + SETS + WEIGHTS;

/// Where the parts begin.
pub(super) const TUNER_AT: usize = PID;
pub(super) const GAINS_AT: usize = TUNER_AT + TUNER;
pub(super) const CELLS_AT: usize = GAINS_AT + 3 * GAIN;
pub(super) const SETS_AT: usize = CELLS_AT + 3 * CELLS;
pub(super) const WEIGHTS_AT: usize = SETS_AT + SETS;

/// Places of the nominal `kp` and `kd`, from which what moves with the gains is counted: they are those of the gains.
pub(super) const NOMINAL: [(usize, usize); 2] = [(6, GAINS_AT), (7, GAINS_AT + 2 * GAIN)];

/// The numbers of a controller, in the order of a gradient: those of [`PidNumbers`], of [`TunerNumbers`], of
/// [`GainNumbers`] for kp, ki and kd, what the rules conclude row by row for the same, where the small and the medium
/// sets of the error and of what stands beside it lie, and the weights of a network row by row. Fixed gains stand in the place of the nominal ones. Numbers that a
/// controller does not have are as if they did nothing.
#[must_use]
pub fn numbers(controller: &Controller) -> [f64; NUMBERS] {
    let mut all = [0.0; NUMBERS];
    let mut place = all.iter_mut();
    let mut put = |number: f64| {
        if let Some(place) = place.next() {
            *place = number;
        }
    };
    let PidNumbers { .. } = controller.equations().numbers.map(|number| put(*number));
    match controller {
        Controller::Fixed(pid) => {
            (0..TUNER).for_each(|_| put(0.0));
            let Gains { kp, ki, kd } = pid.gains();
            for nominal in [kp, ki, kd] {
                [nominal, 0.0, f64::NEG_INFINITY, f64::INFINITY].into_iter().for_each(&mut put);
            }
        }
        Controller::SelfTuning(fspid) => {
            let TunerEquations { numbers, gains, .. } = fspid.tuner_equations();
            let TunerNumbers { .. } = numbers.map(|number| put(*number));
            for gain in gains {
                let GainNumbers { .. } = gain.map(|number| put(*number));
            }
            let table = fspid.tuner().supervisor().numbers();
            for output in Output::ALL {
                let cells = table.map(|table| table.grid(output).as_flattened());
                (0..CELLS).for_each(|cell| put(cells.map_or(0.0, |cells| cells[cell])));
            }
            sets(fspid).into_iter().flatten().for_each(&mut put);
            let network = fspid.tuner().supervisor().network();
            let weights = network.map(|network| network.rows().as_flattened());
            (0..WEIGHTS).for_each(|weight| put(weights.map_or(0.0, |weights| weights[weight])));
        }
    }
    all
}

/// Centres of the small and the medium sets of both inputs.
pub(super) fn sets(fspid: &Fspid<f64>) -> [[f64; 2]; 2] {
    let of = |centres: Option<SetCentres<f64>>| {
        centres.map_or([1.0 / 3.0, 2.0 / 3.0], |it| [it.small(), it.medium()])
    };
    let sets = fspid.tuner().settings().input_sets;
    [of(sets.error), of(sets.change)]
}

/// Names of the numbers, as [`numbers`] has them.
#[must_use]
pub fn names(controller: &Controller) -> Vec<String> {
    let mut names = Vec::with_capacity(NUMBERS);
    controller.equations().numbers.map_named(|name, _, _| names.push(name.to_owned()));
    let tuner = match controller {
        Controller::SelfTuning(fspid) => Some(fspid.tuner_equations()),
        Controller::Fixed(_) => None,
    };
    if let Some(equations) = tuner {
        equations.numbers.map_named(|name, _, _| names.push(name.to_owned()));
    } else {
        names.extend((0..TUNER).map(|place| format!("no tuner, {place}")));
    }
    for gain in ["kp", "ki", "kd"] {
        names.extend(["nominal", "scale", "lower", "upper"].map(|what| format!("{gain}, {what}")));
    }
    for gain in ["kp", "ki", "kd"] {
        names.extend(
            (0..CELLS).map(|cell| format!("{gain}, row {}, column {}", cell / 7 + 1, cell % 7 + 1)),
        );
    }
    names.extend(
        ["error", "change"]
            .iter()
            .flat_map(|input| ["small", "medium"].map(|set| format!("{set} sets of the {input}"))),
    );
    names.extend(Network::<f64>::ROWS.iter().flat_map(|row| {
        (1..=WEIGHTS / Network::<f64>::ROWS.len()).map(move |unit| format!("{row} of unit {unit}"))
    }));
    names
}
