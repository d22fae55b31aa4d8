//! What the self-tuning laws do at rest and near it.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]
#![allow(
    clippy::disallowed_methods,
    reason = "formulas to compare with, within a tolerance; nothing that flies"
)]

use crate::common;

use common::{NOMINAL, T, error, fspid, tuner};
use fspid_core::{
    ControllerSetting, DeadZone, GainLimits, Gains, Law, Limits, PidConfig, State, TunerSettings,
};

/// What the printed table adds at the origin over a range of 5 (handbook; 40-digit polygons).
const AT_REST: Gains<f64> = Gains { kp: 0.216_500_696_638, ki: 0.0, kd: -1.666_610_153_842 };
/// Half a unit of the last printed digit.
const PRINTED_TOL: f64 = 5e-13;
const OUTPUT_SCALE: Gains<f64> = Gains { kp: 0.2, ki: 0.05, kd: 0.1 };

fn settings(law: Law<f64>) -> TunerSettings<f64> {
    TunerSettings { output_scale: OUTPUT_SCALE, law, ..TunerSettings::literal() }
}

/// Nominal plus `times` the scaled increments at rest.
fn nominal_and(times: f64) -> Gains<f64> {
    Gains {
        kp: NOMINAL.kp + times * OUTPUT_SCALE.kp * AT_REST.kp,
        ki: NOMINAL.ki + times * OUTPUT_SCALE.ki * AT_REST.ki,
        kd: NOMINAL.kd + times * OUTPUT_SCALE.kd * AT_REST.kd,
    }
}

fn assert_near(ours: Gains<f64>, expected: Gains<f64>, tolerance: f64) {
    for (ours, expected) in [(ours.kp, expected.kp), (ours.ki, expected.ki), (ours.kd, expected.kd)]
    {
        assert!((ours - expected).abs() < tolerance, "{ours} {expected}");
    }
}

/// The gains after `samples` samples without any error.
fn rested(settings: TunerSettings<f64>, samples: u32) -> Gains<f64> {
    let (controller, mut state) = (fspid(settings, PidConfig::sampled_every(T)), State::new());
    let mut gains = NOMINAL;
    for _ in 0..samples {
        let step = controller.step(&mut state, error(0.0));
        assert_eq!(step.command_rad, 0.0);
        gains = step.gains;
    }
    gains
}

#[test]
fn the_gains_at_rest_are_the_nominal_ones_and_what_the_printed_table_adds() {
    assert_near(tuner(settings(Law::Memoryless)).gains_at_rest(), nominal_and(1.0), PRINTED_TOL);
    let literal = tuner(TunerSettings::literal()).gains_at_rest();
    let expected = Gains {
        kp: NOMINAL.kp + AT_REST.kp,
        ki: NOMINAL.ki + AT_REST.ki,
        kd: NOMINAL.kd + AT_REST.kd,
    };
    assert_near(literal, expected, PRINTED_TOL);
}

#[test]
fn the_memoryless_law_is_at_rest_from_the_first_sample() {
    let expected = tuner(settings(Law::Memoryless)).gains_at_rest();
    for samples in [1, 2, 100] {
        assert_eq!(rested(settings(Law::Memoryless), samples), expected);
    }
}

#[test]
fn the_accumulating_law_drifts_linearly_at_rest_from_the_first_sample_on() {
    let settings = settings(Law::Accumulating { leakage_per_s: 0.0 });
    for samples in [1, 10, 100, 2000] {
        let expected = nominal_and(f64::from(samples) * T);
        // The printed digits and a rounding of a gain near 2 each sample.
        let tolerance = PRINTED_TOL * (1.0 + f64::from(samples) * T) + f64::from(samples) * 4.5e-16;
        assert_near(rested(settings, samples), expected, tolerance);
    }
    assert_near(rested(settings, 100), tuner(settings).gains_at_rest(), PRINTED_TOL);
}

/// $g_k - k' = \frac{s \Delta}{\lambda} \left( 1 - (1 - \lambda T)^k \right)$, k counted from 1.
#[test]
fn leakage_stops_the_drift_of_the_accumulating_law() {
    let leakage_per_s = 2.0;
    let settings = settings(Law::Accumulating { leakage_per_s });
    for samples in [1, 10, 100, 5000] {
        let share = 1.0 - (1.0 - leakage_per_s * T).powi(samples);
        let expected = nominal_and(share / leakage_per_s);
        // Roundings of a gain near 2 die away with the leakage: 50 samples of them remain.
        assert_near(
            rested(settings, samples.unsigned_abs()),
            expected,
            PRINTED_TOL + 50.0 * 4.5e-16,
        );
    }
}

#[test]
fn the_dead_zone_silences_both_laws() {
    let dead_zone = Some(DeadZone { error_rad: 0.01, change_rad: 0.1 });
    for law in [Law::Memoryless, Law::Accumulating { leakage_per_s: 0.0 }] {
        let silent = TunerSettings { dead_zone, ..settings(law) };
        assert_eq!(rested(silent, 1000), NOMINAL);
        assert_eq!(tuner(silent).gains_at_rest(), NOMINAL);
        let (controller, mut state) = (fspid(silent, PidConfig::sampled_every(T)), State::new());
        // Each of the two alone is not enough: 0.01 is the edge of the error, and from 0.001 to
        // 0.003 the change is 0.2 rad/s.
        assert_eq!(controller.step(&mut state, error(0.01)).gains, NOMINAL);
        assert!(controller.step(&mut state, error(0.001)).gains != NOMINAL);
        let mut state = State::new();
        assert!(controller.step(&mut state, error(0.0101)).gains != NOMINAL);
        let mut state = State::new();
        controller.step(&mut state, error(0.001));
        assert!(controller.step(&mut state, error(0.003)).gains != NOMINAL);
    }
}

#[test]
fn gain_limits_stop_the_drift_where_they_stand() {
    let limits = |lower, upper| {
        Limits::new(ControllerSetting::GainLimits, lower, upper).expect("lower is below upper")
    };
    let gain_limits =
        Some(GainLimits { kp: limits(1.9, 2.1), ki: limits(0.0, 1.0), kd: limits(0.75, 1.5) });
    let limited =
        TunerSettings { gain_limits, ..settings(Law::Accumulating { leakage_per_s: 0.0 }) };
    let gains = rested(limited, 1000);
    assert_eq!((gains.kp, gains.kd), (2.1, 0.75));
    let literal = TunerSettings { gain_limits, ..TunerSettings::literal() };
    let at_rest = tuner(literal).gains_at_rest();
    assert_eq!((at_rest.kp, at_rest.kd), (2.1, 0.75));
}
