//! What is small is linear, and what is integrated is integrated finely enough.

use crate::flying::{NAVION, apart, flown, largest};

const B747: [&str; 3] = [
    "aircraft.name=b747-cruise-low",
    "aircraft.airspeed_ft_s=673.0",
    "aircraft.altitude_ft=20000.0",
];

/// Of a step of 0.1 deg; the linear model has no density that falls with altitude.
const SMALL_STEP_TOL: f64 = 0.01;

#[test]
fn a_step_of_a_tenth_of_a_degree_is_that_of_the_linear_model_within_one_per_cent() {
    for aircraft in [&[][..], &B747] {
        let nonlinear = flown(NAVION, aircraft);
        let linear = flown(NAVION, &[aircraft, &["aircraft.model=linear"]].concat());
        let step_rad = 0.1_f64.to_radians();
        let error = apart(&nonlinear.theta_rad, &linear.theta_rad) / step_rad;
        assert!(error < SMALL_STEP_TOL, "{aircraft:?}: {error}");
        let rates = apart(&nonlinear.q_rad_s, &linear.q_rad_s) / largest(&linear.q_rad_s);
        assert!(rates < SMALL_STEP_TOL, "{aircraft:?}: {rates}");
    }
}

/// In the uniform air of textbooks nothing but the excursion is left of the difference: with half of
/// the step it is a quarter.
#[test]
fn what_is_left_of_the_difference_is_quadratic() {
    let error = |amplitude: &str| {
        let amplitude = format!("setpoint.amplitude_deg={amplitude}");
        let set = ["aircraft.atmosphere=reference", amplitude.as_str()];
        let linear = flown(NAVION, &[&set[..], &["aircraft.model=linear"]].concat());
        apart(&flown(NAVION, &set).theta_rad, &linear.theta_rad)
    };
    let ratio = error("1.0") / error("0.5");
    assert!((ratio - 4.0).abs() < 0.3, "{ratio}");
}

/// A small gust, too, is felt as the linear model feels it.
#[test]
fn a_weak_gust_is_that_of_the_linear_model() {
    let gust = format!(
        "{NAVION}[[gust]]\nkind = \"full-cycle\"\nup_m_s = 0.2\ngradient_m = 40.0\nat_s = 1.0\n"
    );
    let still = ["setpoint.amplitude_deg=0.0", "aircraft.atmosphere=reference"];
    let nonlinear = flown(&gust, &still);
    let linear = flown(&gust, &[&still[..], &["aircraft.model=linear"]].concat());
    let size = largest(&linear.theta_rad);
    assert!(size > 1e-4, "{size}");
    let error = apart(&nonlinear.theta_rad, &linear.theta_rad) / size;
    assert!(error < 0.02, "{error}");
}

/// Without a controller only the integration between samples is left: sub-steps of 10 ms, however
/// long the period, and their error against sub-steps of 1 ms.
#[test]
fn a_slow_loop_is_integrated_as_finely_as_a_fast_one() {
    let open = |period: &str| {
        let period = format!("loop.sample_period_s={period}");
        let gains = ["controller.PID.kp=0.0", "controller.PID.ki=0.0", "controller.PID.kd=0.0"];
        let text = format!(
            "{NAVION}[[disturbance]]\nkind = \"step\"\nenters_at = \"servo\"\namplitude_deg = 1.0\n"
        );
        flown(&text, &[&gains[..], &[period.as_str()]].concat())
    };
    let (slow, fast, finer) = (open("0.1"), open("0.01"), open("0.001"));
    let every = |values: &[f64], step| values.iter().copied().step_by(step).collect::<Vec<_>>();
    assert!(apart(&slow.theta_rad, &every(&fast.theta_rad, 10)) < 1e-12);
    let size = largest(&finer.theta_rad);
    assert!(apart(&fast.theta_rad, &every(&finer.theta_rad, 10)) < 1e-7 * size);
}

#[test]
fn an_aircraft_left_alone_stays_at_its_trim() {
    for aircraft in [&[][..], &B747] {
        let trace = flown(NAVION, &[aircraft, &["setpoint.amplitude_deg=0.0"]].concat());
        assert!(largest(&trace.theta_rad) < 1e-9, "{aircraft:?}");
        assert_eq!(trace.exit, None);
    }
}
