//! A sample's derivatives are the differences of the core's own step, for every option.

use fspid_core::{
    Fspid, InputSets, Previous, Sample, SecondInput, SelfTuner, State, TunerSettings,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::controller::{Done, Inputs, Places, Rows, Twin};
use super::gains::{TunerSlopes, system_of};
use crate::Controller;
use fspid_options::{any_controller, labels};

/// Pitch, rate, integral, derivative, last sample, last command, three gains.
const STATES: usize = 9;
const PLACES: Places = Places {
    integral: Some(2),
    derivative: Some(3),
    previous: Some(4),
    last_command: Some(5),
    gains: Some(6),
    size: STATES,
};
/// Half the width of a difference: rounding is 1e-9 of it, curvature of the rules below 1e-4.
const HALF: f64 = 1e-7;
/// Relative to the size of a column.
const TOLERANCE: f64 = 1e-3;
/// Differences to both sides that are further apart than this lie around a corner: a rule that takes
/// over from another, a limit.
const CORNER: f64 = 5e-4;

/// Command, then the five parts of the memory from the integral on, as [`PLACES`].
type Answer = [f64; 8];

fn unit(place: usize) -> Vec<f64> {
    (0..STATES).map(|other| if other == place { 1.0 } else { 0.0 }).collect()
}

/// What the core answers where one state is `by` off.
fn stepped(
    controller: &Controller,
    mut state: State<f64>,
    mut sample: Sample<f64>,
    place: usize,
    by: f64,
) -> Answer {
    let mut previous = state.previous.as_mut();
    match (place, &mut previous) {
        (0, _) => sample.measurement_rad += by,
        (1, _) => sample.rate_rad_s += by,
        (2, _) => state.integral += by,
        (3, _) => state.derivative_rad_s += by,
        (5, _) => state.command_rad += by,
        (4, Some(Previous { error_rad, derivative_input_rad, .. })) => {
            *error_rad += by;
            *derivative_input_rad += by;
        }
        (6, Some(previous)) => previous.gains.kp += by,
        (7, Some(previous)) => previous.gains.ki += by,
        (8, Some(previous)) => previous.gains.kd += by,
        _ => {}
    }
    let command_rad = controller.step(&mut state, sample).command_rad;
    let (last_rad, gains) = state.previous.map_or((0.0, controller.nominal()), |previous| {
        (previous.derivative_input_rad, previous.gains)
    });
    let [integral, derivative] = [state.integral, state.derivative_rad_s];
    [command_rad, integral, derivative, last_rad, state.command_rad, gains.kp, gains.ki, gains.kd]
}

/// A column of the rows, in the order of [`Answer`].
fn column(rows: &Rows, place: usize) -> Answer {
    let mut column = [rows.command[place]; 8];
    for (row, entries) in &rows.memory {
        column[row - 1] = entries[place];
    }
    column
}

fn rows(controller: &Controller, slopes: Option<&mut TunerSlopes<'_>>, done: Done) -> Rows {
    let asked = slopes.zip(done.seen);
    let slopes = Some(asked.map_or([[0.0; 2]; 3], |(slopes, seen)| slopes.at(seen)));
    done.rows(controller, &PLACES, &Inputs { pitch: &unit(0), rate: &unit(1), slopes })
}

/// How many entries of how many were smooth enough to be compared; an error tells the first that differs.
fn compared(controller: &Controller, samples: &[Sample<f64>]) -> Result<[usize; 2], String> {
    let system = match controller {
        Controller::SelfTuning(fspid) => system_of(fspid.tuner().supervisor()),
        Controller::Fixed(_) => None,
    };
    let mut slopes = match (controller, &system) {
        (Controller::SelfTuning(fspid), Some(system)) => {
            Some(TunerSlopes::new(fspid.tuner(), system))
        }
        _ => None,
    };
    let (mut twin, mut state, mut count) = (Twin::new(controller), State::new(), [0; 2]);
    for (k, &sample) in samples.iter().enumerate() {
        let (before, done) = (state, twin.step(sample));
        let rows = rows(controller, slopes.as_mut(), done);
        controller.step(&mut state, sample);
        // Before the first sample there are no gains that could be moved.
        let places = if before.previous.is_some() { STATES } else { STATES - 3 };
        for place in 0..places {
            let at = |by| stepped(controller, before, sample, place, by);
            let (below, here, above) = (at(-HALF), at(0.0), at(HALF));
            let expected = column(&rows, place);
            let size = expected.iter().fold(1.0_f64, |most, entry| most.max(entry.abs()));
            for (row, found) in expected.into_iter().enumerate() {
                let left = (here[row] - below[row]) / HALF;
                let right = (above[row] - here[row]) / HALF;
                count[1] += 1;
                if (left - right).abs() > CORNER * size {
                    continue;
                }
                count[0] += 1;
                if !((found - 0.5 * (left + right)).abs() <= TOLERANCE * size) {
                    return Err(format!(
                        "sample {k}, row {row} by {place}: {found} {left} {right}"
                    ));
                }
            }
        }
    }
    Ok(count)
}

/// The same controller without what brings states or slopes of its own: a reference model, uneven sets,
/// rules that conclude numbers or a network. Along flights fewer are linearised, see `SelfTuner::is_plain`.
fn derivable(controller: Controller) -> Controller {
    let Controller::SelfTuning(fspid) = controller else {
        return controller;
    };
    let tuner = fspid.tuner();
    let settings = TunerSettings {
        second_input: match tuner.settings().second_input {
            SecondInput::ModelError(_) => SecondInput::Change,
            change_or_rate => change_or_rate,
        },
        input_sets: InputSets::EVEN,
        ..*tuner.settings()
    };
    let supervisor = match tuner.supervisor().has_labels() {
        false => labels(tuner.supervisor().out_of_range()),
        true => *tuner.supervisor(),
    };
    let tuner = SelfTuner::new(tuner.nominal(), supervisor, settings).expect("allowed");
    Controller::SelfTuning(Fspid::new(tuner, *fspid.config()).expect("allowed"))
}

fn samples() -> impl Strategy<Value = Vec<Sample<f64>>> {
    let sample = (-0.2..0.2, -0.2..0.2, -0.5..0.5).prop_map(
        |(setpoint_rad, measurement_rad, rate_rad_s)| Sample {
            setpoint_rad,
            measurement_rad,
            rate_rad_s,
        },
    );
    prop::collection::vec(sample, 8)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        rng_seed: RngSeed::Fixed(15),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn a_sample_is_linearised_as_the_core_answers_it(
        controller in any_controller(), samples in samples(),
    ) {
        let controller = derivable(controller);
        let [smooth, all] = compared(&controller, &samples).map_err(TestCaseError::fail)?;
        prop_assert!(2 * smooth > all, "{} of {} entries are smooth", smooth, all);
    }
}
