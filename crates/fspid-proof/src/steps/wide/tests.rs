//! The form for the end of a step of gains that remember: where gains come to, what may be seen, and what lies in it.

use fspid_core::{
    Change, Fspid, InputScale, Law, PidConfig, ReferenceModel, SecondInput, SelfTuner,
    TunerSettings,
};
use fspid_sim::Controller;

use super::*;
use crate::check::{IntervalMatrix, decreases};
use crate::solve::never;
use crate::steps::terminal::tests::with_near;
use crate::steps::tests::navion::GAINS;
use crate::steps::tuned::tests::numbers;

const DT_S: f64 = 0.02;
const MODEL_OF: ReferenceModel<f64> = ReferenceModel { bandwidth_rad_s: 2.4, damping: 0.58 };
const ERROR_RAD: f64 = 0.004;

/// One whose gains remember, and what it is shown beside the error.
fn remembering(change: Change, second_input: SecondInput<f64>) -> Controller {
    let settings = TunerSettings {
        input_scale: InputScale { error_per_rad: 20.0, change_per_rad: 4.0 },
        output_scale: Gains { kp: 0.02, ki: 0.01, kd: 0.004 },
        law: Law::Accumulating { leakage_per_s: 0.6 },
        change,
        second_input,
        ..TunerSettings::literal()
    };
    let tuner = SelfTuner::new(GAINS, numbers(), settings).expect("allowed");
    Controller::SelfTuning(Fspid::new(tuner, PidConfig::sampled_every(DT_S)).expect("allowed"))
}

fn of_model() -> Controller {
    remembering(Change::Delta, SecondInput::ModelError(MODEL_OF))
}

fn with_wide(controller: Controller, asks: impl FnOnce(&Wide<'_>)) {
    with_near(controller, |near| {
        let Controller::SelfTuning(fspid) = &near.certificate.description.controller else {
            panic!("it tunes itself")
        };
        let tuner = Tuner::of(fspid).expect("it remembers");
        asks(&Wide::of(near, &tuner, never).expect("found"));
    });
}

fn most(form: &Matrix, row: &[f64]) -> f64 {
    let row: Vec<Interval> = row.iter().map(|entry| Interval::point(*entry)).collect();
    reach(form, 1.0, &row).expect("positive definite")
}

#[track_caller]
fn same(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-9 * expected.abs(), "{found:e} {expected:e}");
}

#[test]
fn what_is_seen_beside_the_error_is_to_it_as_their_bounds_in_a_form_that_falls_at_rest() {
    with_wide(of_model(), |wide| {
        same(wide.second_per_rad, 1.0 + MODEL);
        same(wide.model_off, MODEL);
    });
    let mut of_change = [0.0; 2];
    for (found, change) in of_change.iter_mut().zip([Change::Delta, Change::Rate]) {
        with_wide(remembering(change, SecondInput::Change), |wide| {
            assert!(wide.model_off == 0.0);
            let at_rest = corners(wide.near.held.rest);
            let at_rest = closed_at(&wide.model, &at_rest).expect("closed");
            let rate = slower(&at_rest).expect("it falls");
            let form = solve::common_form(&at_rest, rate, &wide.effort).expect("found");
            let [error, change] = wide.model.error_rows().map(|row| most(&form, &row));
            let divisor = wide.tuner.change_divisor().expect("of a change");
            same(wide.second_per_rad, change / error / divisor);
            *found = wide.second_per_rad * divisor;
        });
    }
    same(of_change[0], of_change[1]);
}

/// Where they tend to and where they rest, with a slack at both ends, and nothing that the law does not reach.
#[test]
fn gains_near_rest_are_those_that_the_law_comes_to_and_somewhat_more() {
    with_wide(of_model(), |wide| {
        let whole = wide.near.held.bounds();
        for error_rad in [ERROR_RAD, 0.0, 9.0] {
            let targets = wide.tuner.targets([error_rad, wide.second_per_rad * error_rad]);
            for (gain, found) in wide.gains(error_rad).into_iter().enumerate() {
                let slack = whole[gain].width() / 64.0;
                let come_to = targets[gain].hull(wide.near.held.rest[gain]);
                let expected = [
                    (come_to.lower() - slack).max(whole[gain].lower()),
                    (come_to.upper() + slack).min(whole[gain].upper()),
                ];
                let apart = [found.lower() - expected[0], found.upper() - expected[1]];
                assert!(apart.iter().all(|it| it.abs() < 1e-12), "{gain} {error_rad}: {apart:?}");
            }
        }
    });
}

#[test]
fn in_the_form_no_limit_acts_and_no_more_is_seen_than_its_gains_are_bounded_by() {
    for controller in [of_model(), remembering(Change::Rate, SecondInput::Change)] {
        with_wide(controller, |wide| {
            let terminal = wide.within(ERROR_RAD).expect("found");
            let bounds = wide.gains(ERROR_RAD);
            let gains = bounds.map(|it| [it.lower(), it.upper()]);
            let model_rad = wide.model_off * ERROR_RAD;
            assert_eq!(terminal.gains, Some(NearGains { gains, model_rad }));
            assert!(terminal.level.to_bits() == CLAIMED.to_bits());
            let corners = corners(bounds);
            let matrices = closed_at(&wide.model, &corners).expect("closed");
            same(terminal.rate, 1.0 - 0.5 * (1.0 - slower(&matrices).expect("it falls")));
            for gains in &corners {
                let Gains { kp, ki, kd } = *gains;
                let [kp, ki, kd] = [kp, ki, kd].map(Interval::point);
                let closed = wide.near.enclosed.closed(Gains { kp, ki, kd });
                let closed = IntervalMatrix::from_rows(&closed).expect("a matrix");
                assert!(decreases(&terminal.form, terminal.rate, &closed, None).is_ok());
                let description = &wide.near.certificate.description;
                for (row, limit) in limits::rows(description, &wide.model, *gains, wide.near.rest) {
                    assert!(most(&terminal.form, &row) <= limit * (1.0 + 1e-6));
                }
            }
            let [error, change] = wide.model.error_rows().map(|row| most(&terminal.form, &row));
            assert!(error <= ERROR_RAD * (1.0 + 1e-6), "{error}");
            let divisor = wide.tuner.change_divisor();
            let of_change = divisor.map(|it| it * wide.second_per_rad * ERROR_RAD);
            assert!(of_change.is_none_or(|most| change <= most * (1.0 + 1e-6)), "{change}");
            let shown = wide.shown(ERROR_RAD);
            assert_eq!(shown.len(), 1 + usize::from(divisor.is_some()));
            let [error_row, change_row] = wide.model.error_rows();
            assert_eq!(shown[0], over(&error_row, ERROR_RAD));
            let of_change = of_change.map(|most| over(&change_row, most));
            assert_eq!(shown.get(1), of_change.as_ref());
        });
    }
}

/// After 4 to 64 s, at the least and the largest gains, each of length 1 in the form.
#[test]
fn a_form_is_made_wide_along_what_is_left_of_a_deviation() {
    with_wide(of_model(), |wide| {
        let matrices = closed_at(&wide.model, &corners(wide.gains(ERROR_RAD))).expect("closed");
        let rate = slower(&matrices).expect("it falls");
        let form = solve::common_form(&matrices, rate, &wide.effort).expect("found");
        let found = wide.directions(&matrices, &form).expect("found");
        let ends = [&matrices[0], &matrices[matrices.len() - 1]];
        let mut expected = Vec::new();
        for matrix in ends {
            for samples in [200, 400, 800, 1600, 3200] {
                let mut state = wide.model.pitch_off(1.0);
                for _ in 0..samples {
                    state = times(matrix, &state).expect("fits");
                }
                let turned = times(&form, &state).expect("fits");
                let squared: f64 = state.iter().zip(&turned).map(|(x, y)| x * y).sum();
                // What is nothing any more has no direction.
                if squared > 0.0 {
                    expected.push(over(&state, squared.sqrt()));
                }
            }
        }
        assert!(expected.len() >= 4, "{}", expected.len());
        assert_eq!(found, expected);
    });
}

#[test]
fn who_is_told_to_stop_finds_no_form() {
    with_near(remembering(Change::Rate, SecondInput::Change), |near| {
        let Controller::SelfTuning(fspid) = &near.certificate.description.controller else {
            panic!("it tunes itself")
        };
        let tuner = Tuner::of(fspid).expect("it remembers");
        assert!(Wide::of(near, &tuner, || true).is_none());
    });
}

fn diagonal(entries: [f64; 2]) -> Matrix {
    Matrix::from_rows(&[[entries[0], 0.0], [0.5, entries[1]]]).unwrap()
}

/// A quarter of what the slowest mode of all falls by; nothing where a mode stands still or grows.
#[test]
fn a_rate_leaves_room_beside_the_slowest_mode_of_all() {
    for (modes, rate) in [
        ([[0.5, 0.2], [0.1, -0.8]], Some(0.95)),
        ([[0.6, 0.0], [0.1, 0.2]], Some(0.9)),
        ([[0.0, 0.0], [0.0, 0.0]], Some(0.75)),
        ([[0.5, 0.2], [0.1, -1.0]], None),
        ([[1.2, 0.2], [0.1, 0.3]], None),
    ] {
        let found = slower(&modes.map(diagonal));
        assert_eq!(found.is_some(), rate.is_some(), "{modes:?}");
        let off = found.zip(rate).map_or(0.0, |(found, rate)| found - rate);
        assert!(off.abs() < 1e-9, "{modes:?}: {found:?}");
    }
}

#[test]
fn rows_are_divided_by_their_limit_and_states_multiplied_by_a_matrix() {
    assert_eq!(over(&[1.0, -3.0], 4.0), [0.25, -0.75]);
    assert_eq!(times(&diagonal([2.0, -1.0]), &[1.0, 3.0]), Some(vec![2.0, -2.5]));
    assert_eq!(times(&diagonal([2.0, -1.0]), &[1.0]), None, "another size");
}

#[test]
fn the_corners_of_a_box_are_all_of_its_ends() {
    let bounds = [(1.0, 2.0), (3.0, 5.0), (-1.0, 0.5)];
    let found = corners(bounds.map(|(lower, upper)| Interval::between(lower, upper)));
    let all = (0..8_usize).filter(|corner| {
        let end = |gain: usize| {
            let (lower, upper) = bounds[gain];
            if corner >> gain & 1 == 1 { upper } else { lower }
        };
        found.contains(&Gains { kp: end(0), ki: end(1), kd: end(2) })
    });
    assert_eq!((all.count(), found.len()), (8, 8));
}
