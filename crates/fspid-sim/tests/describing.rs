//! Describing functions against closed forms, and predicted limit cycles against flights.

use std::f64::consts::{FRAC_PI_2, PI};

use fspid_aircraft::aerodynamics::derivatives::{DragLaw, ThrustLaw};
use fspid_aircraft::data::Laws;
use fspid_aircraft::{Aircraft, Environment, TrimTarget};
use fspid_core::{ControllerSetting, Gains, Limits, Pid, PidConfig};
use fspid_sim::actuator::{Actuator, Lag};
use fspid_sim::aircraft::Forces;
use fspid_sim::describing::{
    LimitCycle, LimitCycles, LimitedPath, OpenLoop, Search, limit_cycles, limit_cycles_at,
};
use fspid_sim::lti::{Complex, modulus};
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::{
    AircraftPlant, Controller, ElevatorSign, LinearPlant, NamedController, Scenario, Surroundings,
    Timing, Trace, simulate,
};

use crate::support;

const DT_S: f64 = 0.01;
const DEG: f64 = PI / 180.0;
/// Sums over 512 steps a period have errors of the order of the step squared, 1.5e-4.
const STEP_TOLERANCE: f64 = 3e-4;

fn b747() -> LinearPlant {
    LinearPlant::new(
        &[-1.69144, -0.84341, -0.009_909_6],
        &[1.0, 1.17103, 1.55405, 0.012_538, 0.007_277_1],
        ElevatorSign::NoseDownPositive,
    )
    .expect("the paper's plant")
}

fn proportional(kp: f64, config: PidConfig<f64>) -> Controller {
    Controller::Fixed(Pid::new(Gains { kp, ki: 0.0, kd: 0.0 }, config).expect("allowed"))
}

fn plain() -> PidConfig<f64> {
    PidConfig::sampled_every(DT_S)
}

fn servo() -> Actuator {
    Actuator::first_order(0.1).expect("allowed")
}

/// A step of the set-point away and back, so that what remains swings around zero.
fn scenario(
    actuator: Actuator,
    kick_rad: f64,
    duration_s: f64,
    controller: Controller,
) -> Scenario {
    let kick = Shape::Pulse { at_s: 0.0, width_s: 1.0 };
    Scenario {
        name: "cycle".into(),
        plant: b747().into(),
        plant_changes: Vec::new(),
        actuator,
        timing: Timing::new(DT_S, duration_s).expect("allowed"),
        setpoint: Profile::new(kick_rad, kick).expect("allowed"),
        disturbances: Vec::new(),
        controllers: vec![NamedController { name: "C".into(), controller }],
        externals: Vec::new(),
        surroundings: Surroundings::default(),
        autopilot: None,
    }
}

fn with_actuator(actuator: Actuator) -> LimitedPath {
    let mut scenario = scenario(Actuator::ideal(), 0.1, 1.0, proportional(1.0, plain()));
    scenario.actuator = actuator;
    LimitedPath::of(&scenario, &plain()).expect("a path")
}

fn predicted(scenario: &Scenario) -> LimitCycles {
    let search = Search::sampled_every(DT_S);
    limit_cycles(scenario, &scenario.controllers[0].controller, &search).expect("searched")
}

fn flown(scenario: &Scenario) -> Trace {
    simulate(scenario).expect("flies").traces.remove(0)
}

/// Amplitude and period of the pitch angle over the last `window_s`, its mean taken out.
fn oscillation(trace: &Trace, window_s: f64) -> (f64, f64) {
    let rows = (window_s / DT_S) as usize;
    let tail = &trace.theta_rad[trace.rows() - rows..];
    let (least, most) =
        tail.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &x| (a.min(x), b.max(x)));
    let mean = 0.5 * (least + most);
    let rises: Vec<f64> = tail
        .windows(2)
        .zip(0..)
        .filter(|(pair, _)| pair[0] < mean && pair[1] >= mean)
        .map(|(pair, k)| DT_S * (f64::from(k) + (mean - pair[0]) / (pair[1] - pair[0])))
        .collect();
    let period_s = match (rises.first(), rises.last()) {
        (Some(first), Some(last)) if rises.len() > 1 => (last - first) / (rises.len() - 1) as f64,
        _ => 0.0,
    };
    (0.5 * (most - least), period_s)
}

fn near(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() < relative, "{found} is not {expected}");
}

/// Saturation of a sine of amplitude A at M: 2/π (asin m + m √(1 - m²)), m = M/A.
#[test]
fn a_limit_of_the_position_has_the_textbook_describing_function() {
    let limit_rad = 0.2;
    let closed = |amplitude_rad: f64| {
        let m = limit_rad / amplitude_rad;
        2.0 / PI * (libm::asin(m) + m * (1.0 - m * m).sqrt())
    };
    let servo = servo().with_position_limit(limit_rad).expect("allowed");
    let by_servo = scenario(servo, 0.1, 1.0, proportional(1.0, plain()));
    let config = PidConfig {
        limits: Some(
            Limits::new(ControllerSetting::OutputLimits, -limit_rad, limit_rad).expect("allowed"),
        ),
        ..plain()
    };
    let paths = [
        LimitedPath::of(&by_servo, &plain()).expect("a path"),
        with_actuator(
            Actuator::new(Lag::NONE).with_travel(-limit_rad, limit_rad).expect("allowed"),
        ),
        LimitedPath::of(&scenario(Actuator::ideal(), 0.1, 1.0, proportional(1.0, config)), &config)
            .expect("a path"),
    ];
    for path in paths {
        for amplitude_rad in [0.201, 0.25, 0.5, 2.0, 50.0] {
            let n = path.describing_function(amplitude_rad, 3.0).expect("positive");
            assert!((n.re - closed(amplitude_rad)).abs() < STEP_TOLERANCE, "{n} {amplitude_rad}");
            assert!(n.im.abs() < STEP_TOLERANCE, "{n}");
        }
    }
}

/// Deadband of half width d: 1 - 2/π (asin m + m √(1 - m²)), m = d/A; 0 below.
#[test]
fn a_deadband_has_the_textbook_describing_function() {
    let path = with_actuator(Actuator::new(Lag::NONE).with_deadband(0.1).expect("allowed"));
    for amplitude_rad in [0.12, 0.2, 1.0] {
        let m: f64 = 0.1 / amplitude_rad;
        let expected = 1.0 - 2.0 / PI * (libm::asin(m) + m * (1.0 - m * m).sqrt());
        let n = path.describing_function(amplitude_rad, 1.0).expect("positive");
        assert!(modulus(n - expected) < STEP_TOLERANCE, "{n} {expected}");
    }
    let silent = path.describing_function(0.09, 1.0).expect("positive");
    assert!(modulus(silent) < 1e-12, "{silent}");
}

/// Fully in its limit the output is a triangle of slope R that peaks where it meets the sine: gain
/// 4 R/(π A ω), lag acos(π R/(2 A ω)), from A ω/R = √(1 + π²/4) = 1.862 on.
#[test]
fn a_rate_limit_that_never_lets_go_makes_the_triangle_of_the_textbook() {
    let path = with_actuator(Actuator::new(Lag::NONE).with_rate_limit(0.5).expect("allowed"));
    for ratio in [1.9, 3.0, 20.0] {
        let (amplitude_rad, frequency_rad_s) = (0.25 * ratio, 2.0);
        let n = path.describing_function(amplitude_rad, frequency_rad_s).expect("positive");
        // It turns around at one of 512 steps of the sine.
        near(modulus(n), 4.0 / (PI * ratio), 1.0 / 512.0);
        let lag_rad = -libm::atan2(n.im, n.re);
        let off_rad = lag_rad - libm::acos(FRAC_PI_2 / ratio);
        assert!(off_rad.abs() < 2.0 * PI / 512.0, "{off_rad} {ratio}");
    }
    // Within its limit it still takes its time for each of the 512 steps.
    let free = path.describing_function(0.24, 2.0).expect("positive");
    assert!(modulus(free - 1.0) < 2.0 * PI / 512.0, "{free}");
}

#[test]
fn a_slew_limit_of_the_controller_is_a_rate_limit() {
    let config = PidConfig { slew_rad_s: Some(0.5), ..plain() };
    let scenario = scenario(Actuator::ideal(), 0.1, 1.0, proportional(1.0, config));
    let path = LimitedPath::of(&scenario, &config).expect("a path");
    let n = path.describing_function(1.0, 2.0).expect("positive");
    near(modulus(n), 4.0 * 0.5 / (PI * 2.0), 1.0 / 512.0);
}

#[test]
fn the_open_loop_returns_the_command_at_the_border_of_stability() {
    // Gains at which a pair of poles lies on the unit circle, by bisection on the spectral radius.
    let scenario = scenario(servo(), 0.1, 1.0, proportional(1.0, plain()));
    let radius = |kp: f64| {
        let gains = Gains { kp, ki: 0.0, kd: 0.0 };
        fspid_sim::stability::loop_spectral_radius(&scenario, gains, &plain()).expect("found")
    };
    let (mut stable, mut unstable) = (4.0, 6.0);
    for _ in 0..50 {
        let middle = 0.5 * (stable + unstable);
        *(if radius(middle) < 1.0 { &mut stable } else { &mut unstable }) = middle;
    }
    let gains = Gains { kp: stable, ki: 0.0, kd: 0.0 };
    let open = OpenLoop::of(&scenario, &b747(), &plain(), gains).expect("a loop");
    let crossovers = open.gain_crossovers_rad_s().expect("found");
    let nearest = crossovers
        .iter()
        .map(|at| modulus(open.at(*at).expect("no pole").returned + Complex::from(1.0)))
        .fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-9, "{nearest:e} at {crossovers:?}, kp {stable}");
}

#[test]
fn a_loop_that_is_unstable_inside_its_position_limit_swings_as_predicted() {
    for kp in [5.2, 8.0] {
        let limited = servo().with_position_limit(20.0 * DEG).expect("allowed");
        let scenario = scenario(limited, 2.0 * DEG, 120.0, proportional(kp, plain()));
        let prediction = predicted(&scenario);
        let [cycle] = prediction.cycles() else {
            panic!("{prediction:?}");
        };
        assert!(cycle.stable && cycle.residual < 1e-3, "{cycle:?}");
        let (amplitude_rad, period_s) = oscillation(&flown(&scenario), 20.0);
        near(amplitude_rad, cycle.pitch_amplitude_rad, 0.05);
        near(period_s, cycle.period_s, 0.03);
    }
}

fn rate_limited(kp: f64, kick_rad: f64, duration_s: f64) -> Scenario {
    let limited = servo().with_rate_limit(20.0 * DEG).expect("allowed");
    scenario(limited, kick_rad, duration_s, proportional(kp, plain()))
}

#[test]
fn a_rate_limit_makes_a_stable_loop_swing_from_a_large_start_and_only_from_there() {
    let scenario = rate_limited(3.5, 120.0 * DEG, 200.0);
    let prediction = predicted(&scenario);
    let mut cycles: Vec<&LimitCycle> = prediction.cycles().iter().collect();
    cycles.sort_by(|a, b| a.pitch_amplitude_rad.total_cmp(&b.pitch_amplitude_rad));
    let [border, lasting] = cycles[..] else {
        panic!("{prediction:?}");
    };
    assert!(!border.stable && lasting.stable, "{prediction:?}");
    let (amplitude_rad, period_s) = oscillation(&flown(&scenario), 30.0);
    near(amplitude_rad, lasting.pitch_amplitude_rad, 0.1);
    near(period_s, lasting.period_s, 0.05);
    let small = rate_limited(3.5, 0.2 * border.pitch_amplitude_rad, 60.0);
    let (left_rad, _) = oscillation(&flown(&small), 10.0);
    assert!(left_rad < 0.01 * border.pitch_amplitude_rad, "{left_rad}");
}

/// The approximation sees the two cycles of the rate-limited loop from kp = 1.92 on; the flight keeps
/// swinging somewhat below. That is wrong, and why "none found" proves nothing.
#[test]
fn just_below_where_cycles_appear_the_approximation_misses_one_that_is_flown() {
    let scenario = rate_limited(1.9, 120.0 * DEG, 200.0);
    assert!(matches!(predicted(&scenario), LimitCycles::NoneFound { .. }));
    let (amplitude_rad, _) = oscillation(&flown(&scenario), 30.0);
    assert!(amplitude_rad > 10.0 * DEG, "{amplitude_rad}");
    assert_eq!(predicted(&rate_limited(1.95, 0.1, 1.0)).cycles().len(), 2);
}

#[test]
fn a_loop_with_room_for_its_limit_has_no_cycle_and_comes_to_rest_from_far_away() {
    let limited = servo().with_position_limit(20.0 * DEG).expect("allowed");
    let scenario = scenario(limited, 200.0 * DEG, 120.0, proportional(1.0, plain()));
    assert!(matches!(predicted(&scenario), LimitCycles::NoneFound { .. }));
    let (left_rad, _) = oscillation(&flown(&scenario), 10.0);
    assert!(left_rad < 0.5 * DEG, "{left_rad}");
}

#[test]
fn a_path_without_limits_has_nothing_to_predict() {
    let scenario = scenario(servo(), 0.1, 1.0, proportional(9.0, plain()));
    assert_eq!(predicted(&scenario), LimitCycles::NothingLimits);
}

#[test]
fn each_of_a_list_of_gains_gets_its_own_answer() {
    let limited = servo().with_position_limit(20.0 * DEG).expect("allowed");
    let controller = proportional(1.0, plain());
    let scenario = scenario(limited, 0.1, 1.0, controller);
    let gains = [1.0, 6.0].map(|kp| Gains { kp, ki: 0.0, kd: 0.0 });
    let search = Search::sampled_every(DT_S);
    let answers = limit_cycles_at(&scenario, &controller, &gains, &search).expect("searched");
    let counts: Vec<usize> = answers.iter().map(|answer| answer.cycles().len()).collect();
    assert_eq!(counts, [0, 1]);
}

#[test]
fn a_search_that_makes_no_sense_is_refused() {
    let limited = servo().with_position_limit(0.1).expect("allowed");
    let controller = proportional(1.0, plain());
    let scenario = scenario(limited, 0.1, 1.0, controller);
    let good = Search::sampled_every(DT_S);
    for bad in [(0.0, 1.0), (2.0, 1.0), (1.0, f64::NAN)] {
        for search in
            [Search { amplitude_rad: bad, ..good }, Search { frequency_rad_s: bad, ..good }]
        {
            assert!(limit_cycles(&scenario, &controller, &search).is_err(), "{search:?}");
        }
    }
}

/// A nonlinear aircraft by its linear model at the trim, in swings of some degrees.
#[test]
fn a_nonlinear_aircraft_swings_as_predicted_at_its_trim() {
    let data = support::derivative_data("navion");
    let laws = Laws { drag: DragLaw::Polar, thrust: ThrustLaw::Constant };
    let forces = Forces::from(data.force_model(laws));
    let aircraft = Aircraft::new(data.mass_properties(), forces, Environment::STANDARD);
    let target = TrimTarget { airspeed_m_s: 53.6, altitude_m: 500.0, flight_path_rad: 0.0 };
    let plant = AircraftPlant::trimmed(aircraft.expect("a body"), target).expect("flies");
    let limited = servo().with_position_limit(3.0 * DEG).expect("allowed");
    let mut scenario = scenario(limited, 0.5 * DEG, 60.0, proportional(8.0, plain()));
    scenario.plant = plant.into();
    let prediction = predicted(&scenario);
    let [cycle] = prediction.cycles() else {
        panic!("{prediction:?}");
    };
    let (amplitude_rad, period_s) = oscillation(&flown(&scenario), 10.0);
    near(amplitude_rad, cycle.pitch_amplitude_rad, 0.1);
    near(period_s, cycle.period_s, 0.05);
}
