//! Corners near rest hold every gain that the controller can have there.

use fspid_core::fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_core::{
    Change, InputScale, Law, Pid, PidConfig, ReferenceModel, SecondInput, SelfTuner, TunerSettings,
};
use fspid_fuzzy::NumberTable;
use fspid_lti::Matrix;
use fspid_sim::actuator::Actuator;

use super::*;
use crate::gain_set::{GainCell, IncrementMap, producible};
use crate::steps::terminal::NearGains;
use crate::steps::tests::navion::{GAINS, navion};

const DT_S: f64 = 0.02;
const RANGE: f64 = 5.0;

fn settings() -> TunerSettings<f64> {
    TunerSettings {
        input_scale: InputScale { error_per_rad: 40.0, change_per_rad: 8.0 },
        output_scale: Gains { kp: 0.08, ki: 0.04, kd: 0.01 },
        ..TunerSettings::literal()
    }
}

/// The Navion.
fn description(controller: Controller) -> LoopDescription {
    navion(Actuator::first_order(0.1).expect("allowed"), controller)
}

fn tuned_by(supervisor: Supervisor<f64>, settings: TunerSettings<f64>) -> LoopDescription {
    let tuner = SelfTuner::new(GAINS, supervisor, settings).expect("allowed");
    let fspid = Fspid::new(tuner, PidConfig::sampled_every(DT_S)).expect("allowed");
    description(Controller::SelfTuning(fspid))
}

/// By the paper's rules.
fn by_labels() -> LoopDescription {
    let rules = fspid_core::paper::rules();
    let rule = Defuzzifier::Exact;
    let labels = Supervisor::new(&rules, RANGE, rule, OutOfRange::Clamp).expect("allowed");
    tuned_by(labels, settings())
}

/// By numbers, with gains that remember.
fn remembering(second_input: SecondInput<f64>, change: Change) -> LoopDescription {
    let grid = |by_error: f64, by_second: f64| {
        core::array::from_fn(|row| {
            core::array::from_fn(|column| {
                by_error * (row as f64 - 3.0) + by_second * (column as f64 - 3.0)
            })
        })
    };
    let table = NumberTable::new([grid(0.7, 0.4), grid(-0.5, 0.8), grid(0.3, -0.6)]);
    let table = table.expect("numbers");
    let numbers = Supervisor::of_numbers(&table, RANGE, OutOfRange::Clamp).expect("allowed");
    let law = Law::Accumulating { leakage_per_s: 0.6 };
    tuned_by(numbers, TunerSettings { law, second_input, change, ..settings() })
}

fn fspid(description: &LoopDescription) -> &Fspid<f64> {
    match &description.controller {
        Controller::SelfTuning(fspid) => fspid,
        Controller::Fixed(_) => panic!("gains are fixed"),
    }
}

fn model(description: &LoopDescription) -> LoopModel<Interval> {
    description.enclosed().expect("enclosed")
}

/// A ball in the state.
fn terminal(model: &LoopModel<Interval>, level: f64, gains: Option<NearGains>) -> Terminal {
    Terminal { form: Matrix::identity(model.size()), rate: 0.99, level, gains }
}

fn array(gains: Gains<f64>) -> [f64; 3] {
    [gains.kp, gains.ki, gains.kd]
}

/// Most of a row on a ball.
fn most(row: &[Interval], level: f64) -> f64 {
    let squares: f64 = row.iter().map(|entry| entry.midpoint() * entry.midpoint()).sum();
    (squares * level).sqrt()
}

/// Bounds of corners.
fn hull(corners: &[HeldGains]) -> [[f64; 2]; 3] {
    [0, 1, 2].map(|gain: usize| {
        let all = corners.iter().map(|corner| array(corner.gains)[gain]);
        let (least, most) = (all.clone().fold(f64::INFINITY, f64::min), all.fold(-9.0, f64::max));
        [least, most]
    })
}

#[test]
fn a_box_has_each_of_its_corners_once() {
    let sides = [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]];
    let corners = boxed(sides.map(|[lower, upper]| Interval::between(lower, upper)));
    let ends = |corner: &HeldGains| {
        let gains = array(corner.gains);
        [0, 1, 2].map(|gain: usize| {
            let end = sides[gain].iter().position(|end| (end - gains[gain]).abs() <= 0.0);
            end.expect("an end")
        })
    };
    let mut found: Vec<[usize; 3]> = corners.iter().map(ends).collect();
    found.sort_unstable();
    found.dedup();
    assert_eq!((corners.len(), found.len()), (8, 8));
    assert!(corners.iter().all(|corner| corner.change_gain.abs() <= 0.0));
}

#[test]
fn rules_are_made_ready_of_a_self_tuner_alone() {
    assert!(system(&by_labels()).is_some());
    let fixed = Pid::new(GAINS, PidConfig::sampled_every(DT_S)).expect("allowed");
    let fixed = description(Controller::Fixed(fixed));
    assert!(system(&fixed).is_none());
    let model = model(&fixed);
    let set = GainSet::fixed(GAINS);
    let corners = corners_within(&fixed, &model, &set, &terminal(&model, 1.0, None));
    let corners = corners.expect("there are some");
    assert!(corners.iter().all(|corner| corner.gains == GAINS) && corners.len() == 1);
}

#[test]
fn corners_hold_the_gains_of_all_that_the_supervisor_may_see_near_rest_and_little_more() {
    let description = by_labels();
    let (model, fspid) = (model(&description), fspid(&description));
    let set = IncrementMap::of(fspid.tuner(), 12).expect("bounded").gains(1.0);
    for level in [1e-8, 1e-5, 1e-3, 0.1] {
        let corners = corners_within(&description, &model, &set, &terminal(&model, level, None));
        let bounds = hull(&corners.expect("there are some"));
        let [error, change] = input_rows(&model, fspid).map(|row| most(&row, level));
        for step in 0..=40 {
            for other in 0..=40 {
                let at = |step: usize, most: f64| most * (step as f64 / 20.0 - 1.0);
                let gains = producible(fspid.tuner(), at(step, error), at(other, change));
                for (gain, value) in array(gains).into_iter().enumerate() {
                    let [least, most] = bounds[gain];
                    assert!(least <= value && value <= most, "{level}: {value} {least} {most}");
                }
            }
        }
        // Far less than those of the cells around the origin.
        let narrow = bounds
            .iter()
            .zip(set.bounds())
            .all(|([least, most], whole)| most - least < 0.05 * whole.width());
        assert!(narrow || level > 1e-7, "{bounds:?}");
    }
}

/// Cells that hold a command, each of gains that no other has; the inner ones meet everything that is seen.
fn holding(within: [f64; 2], change_gain: f64) -> GainSet {
    let ends = |most: f64| {
        [[-9.0, -1.5], [-1.5, -1.0], [-1.0, 1.0], [1.0, 1.5]]
            .map(|side| side.map(|end: f64| end * most))
    };
    let mut cells = Vec::new();
    for error in ends(within[0]) {
        for change in ends(within[1]) {
            let gain = cells.len() as f64;
            let gains = [gain, gain + 0.25, gain + 0.5].map(Interval::point);
            cells.push(GainCell { error, change, gains, change_gain });
        }
    }
    let rest = [Interval::ONE; 3];
    GainSet { cells, ..GainSet::boxed(GAINS, rest, rest) }
}

#[test]
fn where_a_command_is_held_the_corners_are_those_of_all_cells_that_may_be_seen() {
    let description = by_labels();
    let (model, fspid) = (model(&description), fspid(&description));
    let level = 1e-3;
    let terminal = terminal(&model, level, None);
    let [error, change] = input_rows(&model, fspid);
    let within = [error, change].map(|row| reach(&terminal.form, level, &row).expect("bounded"));
    let of = |change_gain: f64| {
        let held = holding(within, change_gain);
        corners_within(&description, &model, &held, &terminal).expect("there are some")
    };
    // Of four along either input all but the first; borders that touch count.
    let met: Vec<usize> = (0..16).filter(|cell| cell / 4 > 0 && cell % 4 > 0).collect();
    let corners = of(0.3);
    let found: Vec<usize> = (0..16)
        .filter(|cell| corners.iter().any(|it| (it.gains.kp - *cell as f64).abs() <= 0.0))
        .collect();
    assert_eq!(found, met);
    for sign in [-1.0, 1.0] {
        let all = corners.iter().filter(|corner| (corner.change_gain - sign * 0.3).abs() <= 0.0);
        assert_eq!(all.count(), met.len());
    }
    // Where nothing is held gains are asked for, and cells are not looked at.
    assert!(of(0.0).iter().all(|corner| corner.gains.kp < 2.0));
}

#[test]
fn a_box_of_gains_that_remember_is_refused_unless_it_keeps_them() {
    let description = remembering(SecondInput::Change, Change::Rate);
    let (model, fspid) = (model(&description), fspid(&description));
    let tuner = Tuner::of(fspid).expect("followed");
    let set = IncrementMap::of(fspid.tuner(), 12).expect("bounded").gains(1.0);
    let asked = |bounds: [Interval; 3], model_rad: f64| {
        let gains = bounds.map(|side| [side.lower(), side.upper()]);
        let terminal = terminal(&model, 1e-4, Some(NearGains { gains, model_rad }));
        (corners_within(&description, &model, &set, &terminal), terminal)
    };
    let (_, of_nothing) = asked([Interval::ONE; 3], 0.0);
    let seen = seen_within(&tuner, &model, &of_nothing).expect("bounded");
    let bounds = tuner.targets(seen);
    let kept = asked(bounds, 0.0).0.expect("kept");
    assert_eq!((kept.len(), hull(&kept)), (8, bounds.map(|it| [it.lower(), it.upper()])));
    let narrower = bounds.map(|it| {
        let cut = 0.01 * it.width();
        Interval::between(it.lower() + cut, it.upper() - cut)
    });
    for (bounds, model_rad) in [(narrower, 0.0), (bounds, -1e-9), (bounds, f64::NAN)] {
        assert_eq!(asked(bounds, model_rad).0.err(), Some(NotProved::NotKept), "{model_rad}");
    }
}

#[test]
fn what_is_seen_near_rest_is_all_that_rows_reach_there_and_how_far_a_model_is_off() {
    let level = 1e-4;
    let about = |one: f64, other: f64| (one - other).abs() <= 1e-6 * other;
    for (change, divisor) in [(Change::Rate, DT_S), (Change::Delta, 1.0)] {
        let description = remembering(SecondInput::Change, change);
        let model = model(&description);
        let tuner = Tuner::of(fspid(&description)).expect("followed");
        let found = seen_within(&tuner, &model, &terminal(&model, level, None)).expect("bounded");
        let [error, change] = model.error_rows().map(|row| most(&row, level));
        assert!(found[0] >= error && about(found[0], error), "{found:?} {error}");
        assert!(found[1] >= change / divisor && about(found[1], change / divisor), "{found:?}");
    }
    let follows = ReferenceModel { bandwidth_rad_s: 2.4, damping: 0.58 };
    let description = remembering(SecondInput::ModelError(follows), Change::Rate);
    let model = model(&description);
    let tuner = Tuner::of(fspid(&description)).expect("followed");
    let gains = NearGains { gains: [[0.0, 1.0]; 3], model_rad: 0.03 };
    let found = seen_within(&tuner, &model, &terminal(&model, level, Some(gains)));
    let found = found.expect("bounded");
    let [error, _] = model.error_rows().map(|row| most(&row, level));
    assert!(found[1] >= error + 0.03 && about(found[1], error + 0.03), "{found:?} {error}");
}
