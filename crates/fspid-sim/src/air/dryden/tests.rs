use super::*;
use fspid_numeric::units::FOOT_M;

const FEET: f64 = FOOT_M;

fn turbulence() -> Turbulence {
    Turbulence {
        specification: Specification::MilF8785c,
        intensity: Severity::Moderate.into(),
        height_m: 500.0 * FEET,
        airspeed_m_s: 176.0 * FEET,
        wing_span_m: 33.4 * FEET,
        noise: 5.into(),
        follows: Follows::Start,
        driven_until_s: f64::INFINITY,
    }
}

fn dryden(dt_s: f64) -> Dryden {
    Dryden::new(&turbulence(), dt_s).expect("allowed")
}

fn quadratic<const N: usize>(row: [f64; N], matrix: &[[f64; N]; N], column: [f64; N]) -> f64 {
    let image = matrix.map(|entries| crate::math::dot(&entries, &column));
    crate::math::dot(&row, &image)
}

/// Rows of w and q over the states of w.
fn output_rows(dryden: &Dryden) -> ([f64; 3], [f64; 3]) {
    let per_m = dryden.vertical_output.per_m;
    ([1.0, 1.0, 0.0], [per_m, per_m, -per_m])
}

/// ∫ of a one-sided spectrum over Ω from 0, by x = Ω/(1 + Ω) in 2·10⁵ midpoints.
fn integral(spectrum: impl Fn(f64) -> f64) -> f64 {
    let n = 200_000;
    let midpoint = |i: usize| {
        let x = (i as f64 + 0.5) / f64::from(n);
        spectrum(x / (1.0 - x)) / ((1.0 - x) * (1.0 - x))
    };
    (0..n as usize).map(midpoint).sum::<f64>() / f64::from(n)
}

#[test]
fn the_variance_of_the_sampled_filters_is_sigma_squared_at_any_period() {
    let Scales { sigma_m_s: [sigma_u, sigma_v, sigma_w], .. } =
        Scales::at(Specification::MilF8785c, Severity::Moderate.into(), turbulence().height_m);
    for dt_s in [1e-4, 0.01, 0.02, 0.1, 1.0, 30.0] {
        let dryden = dryden(dt_s);
        let close = |found: f64, sigma: f64| {
            let relative = (found / (sigma * sigma) - 1.0).abs();
            assert!(relative < 1e-9, "{found} is not {sigma}² at {dt_s}");
        };
        let velocity = [1.0, 1.0, 0.0];
        close(dryden.along.sampled_covariance()[0][0], sigma_u);
        close(quadratic(velocity, &dryden.across.sampled_covariance(), velocity), sigma_v);
        close(quadratic(velocity, &dryden.vertical.sampled_covariance(), velocity), sigma_w);
    }
}

/// The covariance of all states, that of the start, and that over a common time agree.
#[test]
fn the_covariance_at_common_times_does_not_depend_on_the_period() {
    let close = |a: [[f64; 3]; 3], b: [[f64; 3]; 3], what: &str| {
        for (a, b) in a.concat().into_iter().zip(b.concat()) {
            assert!((a - b).abs() < 1e-10 * (1.0 + b.abs()), "{what}: {a} {b}");
        }
    };
    let (fine, coarse, coarser) = (dryden(0.01), dryden(0.02), dryden(0.1));
    let reference = fine.vertical.start_covariance();
    for dryden in [&fine, &coarse, &coarser] {
        close(dryden.vertical.sampled_covariance(), reference, "stationary");
        close(dryden.vertical.start_covariance(), reference, "start");
    }
    let product = |a: [[f64; 3]; 3], b: [[f64; 3]; 3]| {
        let column = |j: usize| [b[0][j], b[1][j], b[2][j]];
        a.map(|row| [0, 1, 2].map(|j| crate::math::dot(&row, &column(j))))
    };
    let step = fine.vertical.transition();
    let (twice, mut tenfold) = (product(step, step), step);
    for _ in 1..10 {
        tenfold = product(tenfold, step);
    }
    close(twice, coarse.vertical.transition(), "0.02 s");
    close(tenfold, coarser.vertical.transition(), "0.1 s");
}

/// Handbook oracle for V 176 ft/s, L 500 ft: R_w/σ² = e^(-t/τ) (1 - t/2τ).
#[test]
fn the_autocorrelation_of_w_is_that_of_dryden() {
    let (lag_s, row) = (500.0 / 176.0, [1.0, 1.0, 0.0]);
    for (time_s, expected) in
        [(0.1, 0.948_421), (0.5, 0.764_820), (1.0, 0.579_503), (2.0, 0.320_503)]
    {
        let noise = second_order(1.0, lag_s, 0.2, time_s).expect("allowed");
        let covariance = noise.sampled_covariance();
        let image = covariance.map(|entries| crate::math::dot(&entries, &row));
        let later = noise.transition().map(|entries| crate::math::dot(&entries, &image));
        let found = later[0] + later[1];
        assert!((found - expected).abs() < 5.1e-7, "{time_s} s: {found}");
    }
}

#[test]
fn the_autocorrelation_of_u_is_an_exponential() {
    for time_s in [0.1, 0.5, 1.0, 2.0] {
        let noise = first_order(1.0, 1.7, time_s).expect("allowed");
        let found = noise.transition()[0][0] * noise.sampled_covariance()[0][0];
        assert!((found - crate::math::exp(-time_s / 1.7)).abs() < 1e-12);
    }
}

/// The filters against the spectra of the documents, integrated numerically.
#[test]
fn the_variances_of_the_rates_are_the_integrals_of_their_spectra() {
    let (dryden, pi) = (dryden(0.01), std::f64::consts::PI);
    let span_m = turbulence().wing_span_m;
    let scales =
        Scales::at(Specification::MilF8785c, Severity::Moderate.into(), turbulence().height_m);
    let ([_, across_m, vertical_m], [_, sigma_v, sigma_w]) = (scales.length_m, scales.sigma_m_s);
    let transverse = |sigma: f64, length: f64, x: f64| {
        let square = (length * x) * (length * x);
        length * sigma * sigma / pi * (1.0 + 3.0 * square) / ((1.0 + square) * (1.0 + square))
    };
    let lag = |spans: f64, x: f64| 1.0 + (spans * span_m * x / pi) * (spans * span_m * x / pi);
    let slender = libm::cbrt(pi * vertical_m / (4.0 * span_m));
    let expected_p = integral(|x| sigma_w * sigma_w / vertical_m * 0.8 * slender / lag(4.0, x));
    let expected_q = integral(|x| x * x / lag(4.0, x) * transverse(sigma_w, vertical_m, x));
    let expected_r = integral(|x| x * x / lag(3.0, x) * transverse(sigma_v, across_m, x));

    let (_, q_row) = output_rows(&dryden);
    let r_per_m = dryden.across_output.per_m;
    let r_row = [r_per_m, r_per_m, -r_per_m];
    let found = [
        dryden.roll.sampled_covariance()[0][0],
        quadratic(q_row, &dryden.vertical.sampled_covariance(), q_row),
        quadratic(r_row, &dryden.across.sampled_covariance(), r_row),
    ];
    for (found, expected) in found.into_iter().zip([expected_p, expected_q, expected_r]) {
        assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
    }
}

/// Sum over frequencies of a sampled flight is too blunt for a sign: -q V is the slope of a slow w.
#[test]
fn q_is_minus_the_slope_of_w_and_r_the_slope_of_v() {
    let dryden = dryden(0.001);
    let mut state = dryden.start();
    let (mut with_w, mut with_v) = (0.0, 0.0);
    let mut before = dryden.motion(&state);
    for k in 1..200_000 {
        dryden.advance(&mut state, k);
        let now = dryden.motion(&state);
        with_w += now.body_rad_s[1] * (now.body_m_s[2] - before.body_m_s[2]);
        with_v += now.body_rad_s[2] * (now.body_m_s[1] - before.body_m_s[1]);
        before = now;
    }
    assert!(with_w < 0.0 && with_v > 0.0, "{with_w} {with_v}");
}

#[test]
fn both_documents_describe_the_same_air() {
    let motion = |specification, height_m| {
        let dryden = Dryden::new(&Turbulence { specification, height_m, ..turbulence() }, 0.02);
        let dryden = dryden.expect("allowed");
        dryden.motion(&dryden.start())
    };
    for height_m in [50.0, 450.0, 6000.0] {
        let old = motion(Specification::MilF8785c, height_m);
        assert_eq!(old, motion(Specification::MilHdbk1797, height_m));
    }
}

#[test]
fn another_span_changes_the_rates_and_no_velocity() {
    let flown = |wing_span_m: f64| {
        let dryden = Dryden::new(&Turbulence { wing_span_m, ..turbulence() }, 0.02);
        let dryden = dryden.expect("allowed");
        let mut state = dryden.start();
        (1..100).for_each(|k| dryden.advance(&mut state, k));
        dryden.motion(&state)
    };
    let (small, large) = (flown(5.0), flown(60.0));
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-9 * (1.0 + b.abs()), "{a} {b}");
    for (a, b) in small.body_m_s.into_iter().zip(large.body_m_s) {
        near(a, b);
    }
    for (a, b) in small.body_rad_s.into_iter().zip(large.body_rad_s) {
        assert!((a - b).abs() > 1e-6, "{a} {b}");
    }
}

/// Sample moments of 40 seeds of 500 s each; tolerances are four standard errors, the correlation
/// time of some 3 s leaving about 70 independent values a flight.
#[test]
fn flights_through_turbulence_have_the_moments_of_the_distribution() {
    let scales =
        Scales::at(Specification::MilF8785c, Severity::Moderate.into(), turbulence().height_m);
    let (mut sums, mut squares, mut fourths, mut n) = ([0.0; 3], [0.0; 3], [0.0; 3], 0.0);
    for seed in 0..40 {
        let noise = seed.into();
        let dryden = Dryden::new(&Turbulence { noise, ..turbulence() }, 0.5).expect("allowed");
        let mut state = dryden.start();
        for k in 1..=1000 {
            for (axis, value) in dryden.motion(&state).body_m_s.into_iter().enumerate() {
                let z = value / scales.sigma_m_s[axis];
                sums[axis] += z;
                squares[axis] += z * z;
                fourths[axis] += z * z * z * z;
            }
            n += 1.0;
            dryden.advance(&mut state, k);
        }
    }
    for axis in 0..3 {
        assert!((sums[axis] / n).abs() < 0.1, "{axis} {}", sums[axis] / n);
        assert!((squares[axis] / n - 1.0).abs() < 0.12, "{axis} {}", squares[axis] / n);
        assert!((fourths[axis] / n - 3.0).abs() < 0.8, "{axis} {}", fourths[axis] / n);
    }
}

#[test]
fn turbulence_is_as_strong_at_its_first_sample_as_at_any_other() {
    let scales =
        Scales::at(Specification::MilF8785c, Severity::Moderate.into(), turbulence().height_m);
    let n = 4000;
    let mut squares = [0.0; 3];
    for seed in 0..n {
        let dryden = Dryden { noise: seed.into(), ..dryden(0.01) };
        for (axis, value) in dryden.motion(&dryden.start()).body_m_s.into_iter().enumerate() {
            squares[axis] += (value / scales.sigma_m_s[axis]) * (value / scales.sigma_m_s[axis]);
        }
    }
    // Four standard errors: 4 sqrt(2/n).
    for square in squares {
        assert!((square / n as f64 - 1.0).abs() < 0.09, "{}", square / n as f64);
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_seed_others() {
    let first = |seed: u64| {
        let noise = seed.into();
        let dryden = Dryden::new(&Turbulence { noise, ..turbulence() }, 0.02).expect("allowed");
        let mut state = dryden.start();
        (1..50).for_each(|k| dryden.advance(&mut state, k));
        dryden.motion(&state).body_m_s.map(f64::to_bits)
    };
    assert_eq!(first(3), first(3));
    assert_ne!(first(3), first(4));
}

#[test]
fn calm_air_aloft_does_not_move_and_bad_numbers_are_refused() {
    let calm =
        Turbulence { height_m: 45_000.0 * FEET, intensity: Severity::Light.into(), ..turbulence() };
    let dryden = Dryden::new(&calm, 0.02).expect("allowed");
    let mut state = dryden.start();
    dryden.advance(&mut state, 1);
    assert_eq!(dryden.motion(&state).body_m_s, [0.0; 3]);
    for bad in [
        Turbulence { airspeed_m_s: 0.0, ..turbulence() },
        Turbulence { wing_span_m: f64::NAN, ..turbulence() },
        Turbulence { height_m: f64::INFINITY, ..turbulence() },
    ] {
        assert!(Dryden::new(&bad, 0.02).is_err());
    }
    assert!(Dryden::new(&turbulence(), 0.0).is_err());
}

/// So that velocities of the air can be told to a simulator whose aircraft's span nobody here knows.
#[test]
fn the_span_moves_rates_of_the_air_alone() {
    let flown = |wing_span_m: f64| {
        let dryden =
            Dryden::new(&Turbulence { wing_span_m, ..turbulence() }, 0.01).expect("allowed");
        let mut state = dryden.start();
        (1..=500).for_each(|k| dryden.advance(&mut state, k));
        dryden.motion(&state)
    };
    let (short, long) = (flown(10.0), flown(60.0));
    assert_eq!(short.body_m_s, long.body_m_s);
    assert_ne!(short.body_rad_s, long.body_rad_s);
}
