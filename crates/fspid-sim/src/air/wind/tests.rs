use super::microburst::PEAK_HEIGHT;
use super::*;
use fspid_numeric::units::{FOOT_M, KNOT_M_S};

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} is not {expected}");
}

fn at_distance(distance_m: f64) -> AirPlace {
    AirPlace { distance_m, ..AirPlace::default() }
}

fn numbers(motion: &AirMotion) -> impl Iterator<Item = f64> {
    motion.earth_m_s.into_iter().chain(motion.body_m_s).chain(motion.body_rad_s)
}

#[test]
fn every_example_builds_and_moves_the_air_by_finite_amounts_everywhere() {
    for &kind in WindKind::ALL {
        let wind = kind.build(kind.example()).expect("an example is allowed");
        assert_eq!((wind.kind(), WindKind::from_name(kind.name())), (kind, Some(kind)));
        let (mut moved, lengths) = (false, [-1e9, -50.0, 0.0, 1e-300, 30.0, 120.0, 2000.0, 1e9]);
        for distance_m in lengths {
            for height_m in lengths {
                let place =
                    AirPlace { distance_m, north_m: distance_m, height_m, ..AirPlace::default() };
                let motion = wind.at(&place);
                assert!(numbers(&motion).all(f64::is_finite), "{} {place:?}", kind.name());
                moved |= numbers(&motion).any(|part| part != 0.0);
            }
        }
        assert!(moved, "{}", kind.name());
    }
}

#[test]
fn a_wrong_number_of_parameters_or_a_bad_one_is_refused_by_name() {
    for &kind in WindKind::ALL {
        let example = kind.example();
        let short = kind.build(&example[1..]);
        assert!(matches!(short, Err(SimError::ParameterCount { .. })), "{}", kind.name());
        for (index, param) in kind.params().iter().enumerate() {
            let mut params = example.to_vec();
            params[index] = f64::NAN;
            let refused = kind.build(&params);
            let named = matches!(refused, Err(SimError::Number { what, .. }) if what == param.name);
            assert!(named, "{} {}", kind.name(), param.name);
        }
    }
}

#[test]
fn the_gust_of_8785c_is_half_at_half_its_length_and_then_stays() {
    let gust = WindKind::RampHold.build(&[0.0, 0.0, -4.0, 50.0, 10.0]).expect("allowed");
    let down = |distance_m| gust.at(&at_distance(distance_m)).body_m_s[2];
    assert_eq!((down(9.0), down(10.0), down(60.0), down(1e6)), (0.0, 0.0, -4.0, -4.0));
    close(down(35.0), -2.0, 1e-12);
    close(down(10.0 + 50.0 / 3.0), -1.0, 1e-12);
}

#[test]
fn the_gust_of_25_341_is_full_at_its_gradient_distance_and_gone_at_twice_that() {
    let gust = WindKind::FullCycle.build(&[1.0, 2.0, 3.0, 50.0, 0.0]).expect("allowed");
    let at = |distance_m| gust.at(&at_distance(distance_m)).body_m_s;
    assert_eq!(at(50.0), [1.0, 2.0, 3.0]);
    assert_eq!((at(-1.0), at(100.1)), ([0.0; 3], [0.0; 3]));
    close(at(25.0)[2], 1.5, 1e-12);
    close(at(75.0)[2], 1.5, 1e-12);
}

/// q_g = -dw_g/dx and r_g = dv_g/dx, by central differences of the velocity.
#[test]
fn the_rates_of_a_gust_are_the_slopes_of_its_velocity() {
    for kind in [WindKind::RampHold, WindKind::FullCycle] {
        let gust = kind.build(&[1.0, 2.0, 3.0, 50.0, 0.0]).expect("allowed");
        for distance_m in [5.0, 20.0, 40.0, 49.0] {
            let step_m = 1e-4;
            let at = |x: f64| gust.at(&at_distance(x));
            let slope = |axis: usize| {
                let (before, after) = (at(distance_m - step_m), at(distance_m + step_m));
                (after.body_m_s[axis] - before.body_m_s[axis]) / (2.0 * step_m)
            };
            let [p, q, r] = at(distance_m).body_rad_s;
            assert_eq!(p, 0.0);
            close(q, -slope(2), 1e-8);
            close(r, slope(1), 1e-8);
        }
    }
}

/// Handbook oracle: U_ref 41.43 ft/s at 20 000 ft, U_ds 27.51, 33.62, 37.74, 41.43 for H = 30, 100,
/// 200, 350 ft.
#[test]
fn design_gusts_at_20000_ft_are_those_of_the_rule() {
    let feet = |value_m: f64| value_m / FOOT_M;
    let height_m = 20_000.0 * FOOT_M;
    close(feet(reference_gust_m_s(height_m)), 41.43, 0.005);
    for (gradient_ft, expected) in [(30.0, 27.51), (100.0, 33.62), (200.0, 37.74), (350.0, 41.43)] {
        let gust = design_gust_m_s(height_m, gradient_ft * FOOT_M, 1.0).expect("allowed");
        close(feet(gust), expected, 0.005);
    }
    for (height_ft, expected) in
        [(-500.0, 56.0), (0.0, 56.0), (15_000.0, 44.0), (60_000.0, 20.86), (70_000.0, 20.86)]
    {
        close(feet(reference_gust_m_s(height_ft * FOOT_M)), expected, 1e-9);
    }
    assert!(design_gust_m_s(height_m, 0.0, 1.0).is_err());
    assert!(design_gust_m_s(f64::NAN, 10.0, 1.0).is_err());
}

/// Handbook oracle: ratios to the wind at 20 ft for both roughness lengths.
#[test]
fn a_logarithmic_wind_has_the_ratios_of_the_specification() {
    let heights_ft = [50.0, 100.0, 200.0, 500.0, 1000.0];
    let cases = [
        (LogShear::CATEGORY_C_ROUGHNESS_M, [1.1873, 1.3289, 1.4706, 1.6579, 1.7995]),
        (LogShear::OTHER_ROUGHNESS_M, [1.3979, 1.6990, 2.0, 2.3979, 2.6990]),
    ];
    for (roughness_m, ratios) in cases {
        let wind = LogShear { w20_m_s: 30.0 * KNOT_M_S, from_rad: 0.0, roughness_m };
        close(wind.speed_m_s(20.0 * FOOT_M), wind.w20_m_s, 1e-12);
        for (height_ft, ratio) in heights_ft.iter().zip(ratios) {
            close(wind.speed_m_s(height_ft * FOOT_M) / wind.w20_m_s, ratio, 5e-5);
        }
        assert_eq!(wind.speed_m_s(1e5), wind.speed_m_s(1000.0 * FOOT_M));
        assert_eq!(wind.speed_m_s(-5.0), wind.speed_m_s(3.0 * FOOT_M));
    }
}

#[test]
fn a_wind_over_the_roughest_ground_blows_the_way_it_is_said_to_everywhere() {
    let roughness_m = LogShear::MOST_ROUGHNESS_M;
    let wind = LogShear { w20_m_s: 5.0, from_rad: 0.0, roughness_m };
    for height_m in [0.0, 0.5, 1.0, 3.0, 6.096, 50.0, 400.0] {
        let speed_m_s = wind.speed_m_s(height_m);
        assert!((0.0..20.0).contains(&speed_m_s), "{height_m} m: {speed_m_s} m/s");
    }
}

#[test]
fn a_wind_from_the_east_moves_the_air_west() {
    let from_rad = std::f64::consts::FRAC_PI_2;
    let wind = LogShear { w20_m_s: 10.0, from_rad, roughness_m: 0.05 };
    let [north, east, down] =
        wind.at(&AirPlace { height_m: 20.0 * FOOT_M, ..AirPlace::default() }).earth_m_s;
    close(north, 0.0, 1e-12);
    close(east, -10.0, 1e-12);
    assert_eq!(down, 0.0);
}

const BURST: Microburst =
    Microburst { outflow_m_s: 15.0, radius_m: 900.0, peak_height_m: 40.0, axis_m: [0.0; 2] };

/// Handbook oracle: the largest outflow is 0.2357 λR at r = 1.121 R, z = 0.22 z*.
#[test]
fn the_largest_outflow_of_a_microburst_is_where_and_as_large_as_stated() {
    let outflow = |x: f64, z: f64| BURST.outflow_and_updraught_m_s(x, z).0;
    let peak_m = 1.120_906_422_8 * BURST.radius_m;
    close(outflow(peak_m, 40.0), 15.0, 1e-9);
    for (x, z) in [(peak_m * 1.01, 40.0), (peak_m * 0.99, 40.0), (peak_m, 39.0), (peak_m, 41.0)] {
        assert!(outflow(x, z) < 15.0);
    }
    let (lambda, deep_m) = (BURST.scale_1_s(), BURST.peak_height_m / PEAK_HEIGHT);
    close(15.0 / (lambda * BURST.radius_m), 0.2357, 5e-5);
    close(BURST.peak_height_m / deep_m, 0.22, 5e-3);
}

/// Continuity: (1/r) d(r u)/dr + dw/dz = 0.
#[test]
fn a_microburst_neither_makes_nor_swallows_air() {
    for (x, z) in [(100.0, 20.0), (700.0, 60.0), (1500.0, 300.0), (3000.0, 10.0)] {
        let step = 1e-3;
        let flow = |x: f64, z: f64| BURST.outflow_and_updraught_m_s(x, z);
        let outwards = ((x + step) * flow(x + step, z).0 - (x - step) * flow(x - step, z).0)
            / (2.0 * step * x);
        let upwards = (flow(x, z + step).1 - flow(x, z - step).1) / (2.0 * step);
        close(outwards + upwards, 0.0, 1e-9);
    }
}

#[test]
fn a_microburst_blows_outwards_and_down_and_nothing_passes_the_ground() {
    let at = |north_m: f64, height_m: f64| {
        BURST.at(&AirPlace { north_m, height_m, ..AirPlace::default() }).earth_m_s
    };
    assert!(at(800.0, 50.0)[0] > 0.0 && at(-800.0, 50.0)[0] < 0.0);
    assert!(at(0.0, 300.0)[2] > 0.0 && at(0.0, 300.0)[0] == 0.0);
    assert_eq!(at(500.0, 0.0)[2], 0.0);
}

#[test]
fn motions_of_the_air_add() {
    let steady = WindKind::Steady.build(&[1.0, 2.0, 3.0]).expect("allowed");
    let sum = steady.at(&AirPlace::default()) + steady.at(&AirPlace::default());
    assert_eq!(sum.earth_m_s, [2.0, 4.0, 6.0]);
}
