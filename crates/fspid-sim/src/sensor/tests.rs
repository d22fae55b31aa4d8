use super::*;

const DEG: f64 = std::f64::consts::PI / 180.0;

fn sensor(model: SensorModel) -> Sensor {
    Sensor::new(model, 11, PITCH).expect("allowed")
}

/// What a sensor shows of a function of time at each of `samples`.
fn shown(sensor: Sensor, dt_s: f64, samples: usize, truth: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut state = sensor.start(dt_s).expect("allowed");
    let value = |k: usize| Truth { value: truth(k as f64 * dt_s), ..Truth::default() };
    (0..samples).map(|k| state.measure(k, value(k))).collect()
}

fn moments(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n)
}

#[test]
fn an_ideal_sensor_shows_the_truth_bit_for_bit() {
    let values = shown(sensor(SensorModel::default()), 0.013, 100, |t| libm::sin(3.0 * t));
    for (k, value) in values.into_iter().enumerate() {
        assert_eq!(value, libm::sin(3.0 * (k as f64 * 0.013)));
    }
}

#[test]
fn every_preset_is_allowed_and_found_by_its_name() {
    for preset in SensorPreset::ALL {
        for (channel, model) in [(PITCH, preset.pitch), (RATE, preset.rate)] {
            let sensor = Sensor::new(model, 1, channel).expect("allowed");
            let values = shown(sensor, 0.02, 200, |t| 0.1 * libm::sin(t));
            assert!(values.iter().all(|value| value.is_finite()), "{}", preset.name);
        }
        assert_eq!(SensorPreset::from_name(preset.name), Some(preset));
    }
}

#[test]
fn a_delay_of_whole_samples_shows_the_value_of_that_many_samples_before() {
    let delayed = sensor(SensorModel { delay_s: 0.03, ..SensorModel::default() });
    let values = shown(delayed, 0.01, 8, |t| (t / 0.01).round() + 5.0);
    assert_eq!(values, [5.0, 5.0, 5.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
}

#[test]
fn a_transport_delay_between_samples_shows_a_ramp_that_much_later() {
    let delayed = sensor(SensorModel { delay_s: 0.0273, ..SensorModel::default() });
    for (k, value) in shown(delayed, 0.01, 50, |t| t).into_iter().enumerate() {
        let expected = (k as f64 * 0.01 - 0.0273).max(0.0);
        assert!((value - expected).abs() < 1e-14, "{k} {value} {expected}");
    }
}

#[test]
fn a_slow_sensor_holds_its_value_until_its_next_sample() {
    let slow = sensor(SensorModel { period_s: 0.04, ..SensorModel::default() });
    let values = shown(slow, 0.01, 10, |t| (t / 0.01).round());
    assert_eq!(values, [0.0, 0.0, 0.0, 0.0, 4.0, 4.0, 4.0, 4.0, 8.0, 8.0]);
    let off_beat = sensor(SensorModel { period_s: 0.025, delay_s: 0.01, ..SensorModel::default() });
    let values = shown(off_beat, 0.01, 7, |t| t / 0.01);
    for (value, expected) in values.into_iter().zip([0.0, 0.0, 0.0, 0.0, 2.5, 2.5, 5.0]) {
        assert!((value - expected).abs() < 1e-12, "{value} {expected}");
    }
}

#[test]
fn what_is_shown_lies_on_the_grid_of_the_resolution() {
    let coarse = sensor(SensorModel { resolution: 0.01 * DEG, ..SensorModel::default() });
    for (k, value) in shown(coarse, 0.02, 500, |t| 0.02 * libm::sin(t)).into_iter().enumerate() {
        let steps = value / (0.01 * DEG);
        assert!((steps - steps.round()).abs() < 1e-9, "{k}");
        assert!((value - 0.02 * libm::sin(k as f64 * 0.02)).abs() <= 0.005 * DEG * 1.000_001);
    }
}

/// Tolerance: four standard errors, sqrt(2/n).
#[test]
fn noise_of_a_density_has_the_variance_of_its_bandwidth_at_any_loop_period() {
    for (dt_s, period_s) in [(0.01, 0.0), (0.02, 0.0), (0.01, 0.02), (0.02, 0.005)] {
        let noisy = sensor(SensorModel { noise_density: 0.3, period_s, ..SensorModel::default() });
        let every = if period_s > 0.0 { period_s } else { dt_s };
        let stride = (every / dt_s).round().max(1.0) as usize;
        let values: Vec<f64> =
            shown(noisy, dt_s, 20_000 * stride, |_| 0.0).into_iter().step_by(stride).collect();
        let (mean, variance) = moments(&values);
        let expected = 0.3 * 0.3 / (2.0 * every);
        assert!((variance / expected - 1.0).abs() < 0.04, "{variance} {expected}");
        assert!(mean.abs() < 4.0 * (expected / 20_000.0).sqrt(), "{mean}");
    }
}

#[test]
fn the_noise_of_a_slow_sensor_does_not_depend_on_the_loops_period() {
    let noisy = sensor(SensorModel {
        noise_density: 0.1,
        drift: 0.2,
        drift_time_s: 3.0,
        period_s: 0.1,
        ..SensorModel::default()
    });
    let (fine, coarse) = (shown(noisy, 0.01, 500, |_| 0.0), shown(noisy, 0.05, 100, |_| 0.0));
    let every_fifth: Vec<f64> = fine.into_iter().step_by(5).collect();
    assert_eq!(every_fifth, coarse);
}

#[test]
fn a_bias_is_constant_in_a_flight_and_spread_from_run_to_run() {
    let model = SensorModel { bias: 0.5, ..SensorModel::default() };
    let biases: Vec<f64> = (0..4000)
        .map(|seed| {
            let values = shown(Sensor::new(model, seed, PITCH).expect("allowed"), 0.1, 3, |_| 0.0);
            assert!(values.windows(2).all(|pair| pair[0] == pair[1]));
            values[0]
        })
        .collect();
    let (mean, variance) = moments(&biases);
    assert!(mean.abs() < 0.032 && (variance / 0.25 - 1.0).abs() < 0.09, "{mean} {variance}");
}

/// Over seeds: variance σ² at the start and later, correlation e^(-t/T) between.
#[test]
fn drift_is_stationary_and_forgets_at_its_correlation_time() {
    let model = SensorModel { drift: 2.0, drift_time_s: 5.0, ..SensorModel::default() };
    let pairs: Vec<(f64, f64)> = (0..4000)
        .map(|seed| {
            let values = shown(Sensor::new(model, seed, PITCH).expect("allowed"), 0.5, 11, |_| 0.0);
            (values[0], values[10])
        })
        .collect();
    let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / 4000.0;
    assert!((mean(|p| p.0 * p.0) / 4.0 - 1.0).abs() < 0.09);
    assert!((mean(|p| p.1 * p.1) / 4.0 - 1.0).abs() < 0.09);
    assert!((mean(|p| p.0 * p.1) / 4.0 - crate::math::exp(-1.0)).abs() < 0.075);
}

#[test]
fn channels_and_sources_have_streams_of_their_own() {
    let noise = SensorModel { noise_density: 0.1, ..SensorModel::default() };
    let with_bias = SensorModel { bias: 0.3, ..noise };
    let of =
        |model, channel| shown(Sensor::new(model, 4, channel).expect("allowed"), 0.01, 50, |_| 0.0);
    let (plain, biased) = (of(noise, PITCH), of(with_bias, PITCH));
    let bias = biased[0] - plain[0];
    assert!(bias != 0.0);
    for (a, b) in plain.iter().zip(&biased) {
        assert!((b - a - bias).abs() < 1e-15);
    }
    assert_ne!(plain, of(noise, RATE));
}

/// A steady acceleration of 0.1 g for 60 s at 3 deg/min: the gyro shows 3 deg too much, and returns.
#[test]
fn a_vertical_gyro_sags_in_a_long_acceleration_and_erects_again() {
    let erecting = sensor(SensorModel { erection_rad_s: 0.05 * DEG, ..SensorModel::default() });
    let mut state = erecting.start(0.1).expect("allowed");
    let mut after = |range: std::ops::Range<usize>, apparent_vertical_rad: f64| {
        range.fold(0.0, |_, k| state.measure(k, Truth { value: 0.0, apparent_vertical_rad }))
    };
    let tilted = after(0..600, libm::atan(0.1));
    assert!((tilted - 3.0 * DEG).abs() < 1e-12, "{}", tilted / DEG);
    assert!(after(600..2000, libm::atan(0.1)) <= libm::atan(0.1));
    assert!(after(2000..4000, 0.0).abs() < 1e-12);
}

#[test]
fn numbers_out_of_range_are_refused() {
    let none = SensorModel::default();
    for bad in [
        SensorModel { noise_density: -1.0, ..none },
        SensorModel { resolution: f64::NAN, ..none },
        SensorModel { drift: 1.0, ..none },
        SensorModel { scale_error: f64::INFINITY, ..none },
    ] {
        assert!(Sensor::new(bad, 0, PITCH).is_err(), "{bad:?}");
    }
    assert!(sensor(SensorModel { delay_s: 1e9, ..none }).start(0.01).is_err());
}
