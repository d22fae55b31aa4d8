//! Forms near rest are what is said of them, and the widest of those that are tried.

use fspid_core::fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_core::{Fspid, InputScale, Pid, PidConfig, SelfTuner, TunerSettings};
use fspid_sim::actuator::Actuator;

use super::*;
use crate::certificate::Claim;
use crate::gain_set::IncrementMap;
use crate::scope::Range;
use crate::solve::never;
use crate::steps::tests::navion::{GAINS, navion};

fn config() -> PidConfig<f64> {
    PidConfig::sampled_every(0.02)
}

fn fixed() -> Controller {
    Controller::Fixed(Pid::new(GAINS, config()).expect("allowed"))
}

/// By the paper's rules.
fn by_labels() -> Controller {
    let rules = fspid_core::paper::rules();
    let rule = Defuzzifier::Exact;
    let labels = Supervisor::new(&rules, 5.0, rule, OutOfRange::Clamp).expect("allowed");
    let settings = TunerSettings {
        input_scale: InputScale { error_per_rad: 20.0, change_per_rad: 4.0 },
        output_scale: Gains { kp: 0.05, ki: 0.03, kd: 0.01 },
        ..TunerSettings::literal()
    };
    let tuner = SelfTuner::new(GAINS, labels, settings).expect("allowed");
    Controller::SelfTuning(Fspid::new(tuner, config()).expect("allowed"))
}

/// The Navion behind a servo with limits.
fn certificate(controller: Controller) -> Certificate {
    let actuator = Actuator::first_order(0.1)
        .and_then(|servo| servo.with_rate_limit(0.35))
        .and_then(|servo| servo.with_command_limits(-0.3, 0.25));
    let description = navion(actuator.expect("allowed"), controller);
    Certificate {
        description,
        output_factor: 1.0,
        divisions: 12,
        range: Range { setpoint_rad: 0.0, load_rad: 0.0 },
        left_out: Vec::new(),
        claim: Claim::CommonQuadratic { form: Matrix::identity(1), rate: 1.0 },
        level: None,
        steps: None,
        commanded: None,
        family: None,
        disturbances: Vec::new(),
        nonlinear: None,
    }
}

/// Asks about the Navion with a controller, near rest.
pub(in crate::steps) fn with_near(controller: Controller, asks: impl FnOnce(&NearRest<'_>)) {
    let certificate = certificate(controller);
    let held = match &controller {
        Controller::Fixed(pid) => GainSet::fixed(pid.gains()),
        Controller::SelfTuning(fspid) => {
            IncrementMap::of(fspid.tuner(), 12).expect("bounded").gains(1.0)
        }
    };
    let enclosed = certificate.description.enclosed().expect("enclosed");
    let rest = Rest::NOTHING;
    asks(&NearRest { certificate: &certificate, enclosed: &enclosed, held: &held, rest: &rest });
}

fn gains_at_rest(near: &NearRest<'_>) -> Gains<f64> {
    let [kp, ki, kd] = near.held.rest.map(Interval::midpoint);
    Gains { kp, ki, kd }
}

fn within(near: &NearRest<'_>, terminal: &Terminal) -> f64 {
    limits::pitch_within(near.enclosed, &terminal.form, terminal.level).expect("some")
}

/// The terms that the form adds up: what is limited, and so much of what each gain lets into the command.
fn added(near: &NearRest<'_>, weight: f64) -> Vec<Vec<f64>> {
    let (model, gains) = (near.enclosed.midpoint(), gains_at_rest(near));
    let rows = limits::rows(&near.certificate.description, &model, gains, near.rest);
    let narrowest = rows.iter().map(|(_, limit)| *limit).fold(f64::INFINITY, f64::min);
    let let_in = [
        Gains { kp: gains.kp, ..Gains::ZERO },
        Gains { ki: gains.ki, ..Gains::ZERO },
        Gains { kd: gains.kd, ..Gains::ZERO },
    ];
    let none = model.command_row(Gains::ZERO);
    let own = let_in.map(|gains| -> Vec<f64> {
        model.command_row(gains).iter().zip(&none).map(|(with, without)| with - without).collect()
    });
    let scaled = |row: &[f64], by: f64| -> Vec<f64> { row.iter().map(|it| it * by).collect() };
    let limited = rows.iter().map(|(row, limit)| scaled(row, 1.0 / limit));
    let let_in = own.iter().map(|row| scaled(row, weight.sqrt() / narrowest));
    limited.chain(let_in).collect()
}

/// A form of a weight, if one holds, is the sum that it is said to be, at the largest level of those that are tried.
fn is_the_sum(near: &NearRest<'_>, weight: f64) -> bool {
    let (model, gains) = (near.enclosed.midpoint(), gains_at_rest(near));
    let Some(terminal) = near.weighted(&model, gains, weight) else { return false };
    let matrix = model.closed_matrix(gains).expect("a matrix");
    // The rate that the form was made for is as far below as that which is claimed is below 1.
    let rate = 2.0 * terminal.rate - 1.0;
    let radius = fspid_lti::spectral_radius(&matrix).expect("found");
    assert!((rate - 0.5 * (1.0 + radius)).abs() < 1e-12, "{rate} {radius}");
    let later = matrix.scaled(1.0 / rate);
    let falls = later.transpose().product(&terminal.form).expect("square");
    let falls = falls.product(&later).expect("square");
    let terms = added(near, weight);
    let sum =
        |row: usize, column: usize| -> f64 { terms.iter().map(|it| it[row] * it[column]).sum() };
    let size = matrix.rows();
    let most = (0..size).map(|place| sum(place, place)).fold(0.0, f64::max);
    for (place, (form, later)) in terminal.form.data().iter().zip(falls.data()).enumerate() {
        let (row, column) = (place / size, place % size);
        let regular = if row == column { REGULAR * most } else { 0.0 };
        let off = (form - later - sum(row, column) - regular).abs();
        assert!(off <= 1e-8 * (most + form.abs()), "{weight}: {row} {column}: {off}");
    }
    let corner = HeldGains { gains, change_gain: 0.0, remembered: None };
    let rows = limits::rows_held(&near.certificate.description, &model, &corner, near.rest);
    let most = limits::level([(&terminal.form, rows)]).expect("limits");
    let quarters = libm::log(0.95 * most / terminal.level) / libm::log(4.0);
    assert!((quarters - quarters.round()).abs() < 1e-9, "{quarters}");
    let wider = Terminal { level: 4.0 * terminal.level, ..terminal };
    assert!(quarters.round() <= 0.0 || !near.holds(&wider), "{quarters}");
    true
}

#[test]
fn a_form_falls_by_what_is_limited_and_by_what_gains_let_in() {
    let mut found = 0;
    for controller in [fixed(), by_labels()] {
        with_near(controller, |near| {
            found += WEIGHTS.into_iter().filter(|weight| is_the_sum(near, *weight)).count();
        });
    }
    assert!(found > WEIGHTS.len(), "{found}");
}

#[test]
fn no_form_that_is_tried_is_wider_than_the_one_that_is_found() {
    for controller in [fixed(), by_labels()] {
        with_near(controller, |near| {
            let found = near.found(never).expect("found");
            let (model, gains) = (near.enclosed.midpoint(), gains_at_rest(near));
            let tried = WEIGHTS.map(|weight| {
                near.weighted(&model, gains, weight).map_or(0.0, |it| within(near, &it))
            });
            let [least, most] = [f64::min, f64::max].map(|of| tried.into_iter().fold(tried[0], of));
            assert!((within(near, &found) - most).abs() <= 0.0, "{tried:?}");
            assert!(least < most, "{tried:?}");
        });
    }
}

#[test]
fn a_form_that_does_not_fall_and_one_in_which_a_limit_acts_do_not_hold() {
    with_near(fixed(), |near| {
        let found = near.found(never).expect("found");
        assert!(near.holds(&found));
        let limited = Terminal { level: 1.2 * found.level, ..found.clone() };
        assert!(!near.holds(&limited), "a limit acts");
        let steep = Terminal { rate: 0.9 * found.rate, ..found };
        assert!(!near.holds(&steep), "it falls, but not so much");
    });
}
