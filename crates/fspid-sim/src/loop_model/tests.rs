//! The matrix must fly as the simulation does.

use fspid_core::{Derivative, Gains, IntegralForm, Pid, PidConfig, SetpointWeights};
use fspid_lti::{Matrix, spectral_radius};

use super::{BreakPoint, Gathered, LoopModel, Memory};
use crate::actuator::{Actuator, Lag};
use crate::sensor::{PITCH, RATE, Sensor, SensorModel};
use crate::signal::{Disturbance, Entry, Profile, Shape};
use crate::{
    Controller, ElevatorSign, LinearPlant, NamedController, Scenario, Surroundings, Timing,
    simulate,
};

const DT_S: f64 = 0.01;
/// The paper's 747 and Navion: numerator, denominator, sign.
const PLANTS: [(&[f64], &[f64], ElevatorSign); 2] = [
    (
        &[-1.69144, -0.84341, -0.0099096],
        &[1.0, 1.17103, 1.55405, 0.012538, 0.0072771],
        ElevatorSign::NoseDownPositive,
    ),
    (&[11.7304, 22.578], &[1.0, 4.9676, 12.941, 0.0], ElevatorSign::NoseUpPositive),
];

/// What gains that remember make of a held command.
const GATHERED: Gathered<f64> =
    Gathered { keeps: 0.95, by_error: 0.02, by_change: 0.1, by_rate: 0.0 };

struct Case {
    plant: usize,
    gains: Gains<f64>,
    config: PidConfig<f64>,
    surroundings: Surroundings,
    actuator: Actuator,
}

impl Case {
    fn plant(&self) -> LinearPlant {
        let (numerator, denominator, sign) = PLANTS[self.plant];
        LinearPlant::new(numerator, denominator, sign).expect("allowed")
    }

    fn scenario(&self) -> Scenario {
        let pid = Pid::new(self.gains, self.config).expect("allowed");
        let kick = Shape::Pulse { at_s: 0.0, width_s: DT_S };
        let named = NamedController { name: "C".into(), controller: Controller::Fixed(pid) };
        Scenario {
            name: "matrix".into(),
            plant: self.plant().into(),
            plant_changes: Vec::new(),
            actuator: self.actuator,
            timing: Timing::new(DT_S, 5.0).expect("allowed"),
            setpoint: Profile::new(0.0, Shape::Step { at_s: 0.0 }).expect("allowed"),
            disturbances: vec![Disturbance::new(Entry::Elevator, 0.1, kick).expect("allowed")],
            controllers: vec![named],
            externals: Vec::new(),
            surroundings: self.surroundings.clone(),
            autopilot: None,
        }
    }

    fn model(&self) -> LoopModel<f64> {
        let memory = Memory::of_gains(self.gains, &self.config);
        LoopModel::of(&self.scenario(), &self.plant(), &self.config, memory).expect("a loop")
    }

    /// State after the kick of the first sample.
    fn kicked(&self, size: usize) -> Vec<f64> {
        let scenario = self.scenario();
        let step = scenario.propagation(&self.plant(), DT_S).expect("sampled").linear_step();
        let step = step.expect("linear");
        let mut state = vec![0.0; size];
        for (place, row) in step.rows.chunks_exact(step.states + 2).enumerate() {
            state[place] = 0.1 * row[step.states + 1];
        }
        state
    }
}

fn sensor(delay_s: f64, scale_error: f64, channel: u32) -> Option<Sensor> {
    let model = SensorModel { delay_s, scale_error, ..SensorModel::default() };
    Some(Sensor::new(model, 1, channel).expect("allowed"))
}

fn servo(delay_samples: usize) -> Actuator {
    let servo = Actuator::first_order(0.1).and_then(|servo| servo.with_delay(delay_samples));
    servo.expect("allowed")
}

fn cases() -> Vec<Case> {
    let plain = PidConfig::sampled_every(DT_S);
    let rich = PidConfig {
        rate_gain_s: 0.4,
        derivative: Derivative { filter_s: 0.05 },
        integral: IntegralForm::Literal,
        setpoint_weights: SetpointWeights { proportional: 0.3, derivative: 0.0 },
        ..plain
    };
    let lag = Lag::second_order(20.0, 0.7).expect("allowed");
    let actuator = Actuator::new(lag).with_delay(3).expect("allowed");
    let seen = Surroundings {
        pitch_sensor: sensor(0.015, 0.02, PITCH),
        rate_sensor: sensor(0.02, -0.01, RATE),
        ..Surroundings::default()
    };
    let calm = Surroundings::default;
    let gains = Gains { kp: 0.8, ki: 0.4, kd: 0.2 };
    vec![
        Case { plant: 0, gains, config: plain, surroundings: calm(), actuator: servo(0) },
        Case { plant: 1, gains, config: rich, surroundings: calm(), actuator: servo(2) },
        Case { plant: 1, gains, config: rich, surroundings: seen.clone(), actuator },
        Case {
            plant: 0,
            gains: Gains { ki: 0.0, kd: 0.0, ..gains },
            config: PidConfig { rate_gain_s: 0.9, ..plain },
            surroundings: seen,
            actuator,
        },
    ]
}

#[test]
fn powers_of_the_matrix_are_the_simulated_flight() {
    for (number, case) in cases().iter().enumerate() {
        let matrix = case.model().closed_matrix(case.gains).expect("finite");
        let trace = simulate(&case.scenario()).expect("flies").traces.remove(0);
        let mut state = case.kicked(matrix.rows());
        let mut next = state.clone();
        let largest = trace.theta_rad.iter().fold(0.0_f64, |most, theta| most.max(theta.abs()));
        for (k, theta_rad) in trace.theta_rad.iter().enumerate().skip(1) {
            // Rounding of some hundred products.
            let off = (state[0] - theta_rad).abs();
            assert!(off < 1e-12 * largest, "case {number}, sample {k}: {off:e}");
            matrix.apply(&state, &mut next).expect("square");
            std::mem::swap(&mut state, &mut next);
        }
    }
}

#[test]
fn a_loop_that_is_closed_again_at_any_point_is_the_closed_loop() {
    for case in cases() {
        let (model, gains) = (case.model(), case.gains);
        let closed = model.closed_matrix(gains).expect("finite");
        for point in BreakPoint::ALL {
            let open = model.open(gains, point).expect("finite").closed_matrix();
            let difference = closed.sum(&open.scaled(-1.0)).expect("same size").norm_one();
            assert!(difference < 1e-13 * closed.norm_one(), "{point:?}: {difference:e}");
        }
    }
}

#[test]
fn the_literal_and_the_bumpless_integral_have_the_same_poles_for_fixed_gains() {
    let case = cases().remove(1);
    let radius = |integral| {
        let config = PidConfig { integral, ..case.config };
        let memory = Memory::of_gains(case.gains, &config);
        let model = LoopModel::of(&case.scenario(), &case.plant(), &config, memory);
        let matrix: Matrix = model.expect("a loop").closed_matrix(case.gains).expect("finite");
        spectral_radius(&matrix).expect("found")
    };
    let difference = radius(IntegralForm::Bumpless) - radius(IntegralForm::Literal);
    assert!(difference.abs() < 1e-12, "{difference:e}");
}

#[test]
fn the_matrix_is_affine_in_the_gains() {
    let case = cases().remove(1);
    let model = case.model();
    let at = |kp, ki, kd| model.closed_matrix(Gains { kp, ki, kd }).expect("finite");
    let (one, other) = (at(0.2, 0.9, -0.3), at(1.4, 0.1, 0.7));
    let half = one.sum(&other).expect("same size").scaled(0.5);
    let difference = half.sum(&at(0.8, 0.5, 0.2).scaled(-1.0)).expect("same size").norm_one();
    assert!(difference < 1e-14, "{difference:e}");
}

#[test]
fn the_family_of_all_gains_is_the_open_loop_at_each() {
    for (number, case) in cases().iter().enumerate() {
        let model = case.model();
        let gains = [case.gains.kp, case.gains.ki, case.gains.kd];
        for point in [BreakPoint::Command, BreakPoint::Pitch] {
            let family = model.family(point).expect("poles").expect("gains are factors here");
            let open = model.open(case.gains, point).expect("finite");
            for omega_rad_s in [0.01, 0.1, 1.0, 10.0, 100.0] {
                let (quick, careful) = (family.at(&gains, omega_rad_s), open.at(omega_rad_s));
                let off = fspid_lti::modulus(quick - careful) / fspid_lti::modulus(careful);
                // At low frequency the open loop loses digits in its integral.
                assert!(off < 1e-7, "case {number}, {point:?}, {omega_rad_s} rad/s: {off:e}");
            }
        }
        assert!(model.family(BreakPoint::Rate).expect("poles").is_none());
    }
}

/// A servo without a lag but with a rate limit used to change as if its deflection stood still, and had no margins.
#[test]
fn what_a_sample_changes_is_its_step_less_what_it_was() {
    let limited = |actuator: Actuator| actuator.with_rate_limit(0.3).expect("allowed");
    let second = Actuator::new(Lag::second_order(20.0, 0.7).expect("allowed"));
    let ideal = Actuator::ideal();
    for actuator in [ideal, limited(ideal), servo(0), limited(servo(0)), limited(second)] {
        let case = Case { actuator, ..cases().remove(0) };
        let propagation = case.scenario().propagation(&case.plant(), DT_S).expect("sampled");
        let step = propagation.linear_step().expect("linear");
        let change = propagation.linear_change(&case.plant()).expect("sampled").expect("linear");
        let rows = change[0].chunks_exact(step.states + 1);
        for (place, (row, of_step)) in rows.zip(step.rows.chunks_exact(step.states + 2)).enumerate()
        {
            for (column, (entry, stepped)) in row.iter().zip(of_step).enumerate() {
                let was = if column == place { 1.0 } else { 0.0 };
                assert!((entry + was - stepped).abs() < 1e-14, "{actuator:?} {place} {column}");
            }
        }
    }
}

/// The case with more and less gain, behind delays of commands and sensors that are short enough for a matrix.
fn late_cases() -> Vec<Case> {
    let scaled = |factor: f64, delay_samples: usize| {
        cases().into_iter().map(move |case| {
            let Gains { kp, ki, kd } = case.gains;
            let gains = Gains { kp: factor * kp, ki: factor * ki, kd: factor * kd };
            let actuator = case.actuator.with_delay(delay_samples).expect("allowed");
            Case { gains, actuator, ..case }
        })
    };
    [(0.2, 4), (1.0, 9), (3.0, 25), (10.0, 0)]
        .into_iter()
        .flat_map(|(factor, delay)| scaled(factor, delay))
        .collect()
}

#[test]
fn a_loop_whose_dead_times_are_no_states_has_the_verdict_of_its_matrix() {
    let (mut held, mut lost) = (0, 0);
    let each = late_cases().into_iter().flat_map(|case| {
        let model = case.model();
        let gathering = model.with_gathered(Some(GATHERED));
        [(model, case.gains), (gathering, case.gains)]
    });
    for (number, (model, gains)) in each.enumerate() {
        let by_matrix = model.open(gains, BreakPoint::Command).expect("finite").unstable_radius();
        let found = model.delayed(gains).expect("a loop").unstable_radius();
        match (by_matrix, found) {
            (Ok(None), Ok(None)) => held += 1,
            (Ok(Some(one)), Ok(Some(other))) => {
                lost += 1;
                assert!((one - other).abs() < 1e-8, "case {number}: {one} {other}");
            }
            verdicts => panic!("case {number}: {verdicts:?}"),
        }
    }
    assert!(held > 2 && lost > 2, "{held} {lost}");
}

#[test]
fn what_gains_gather_goes_around_wherever_the_loop_is_broken() {
    let (mut held, mut lost) = (0, 0);
    for case in late_cases() {
        let gathered = Gathered { by_rate: 0.2, ..GATHERED };
        let model = case.model().with_gathered(Some(gathered));
        let radius = spectral_radius(&model.closed_matrix(case.gains).expect("finite"));
        let radius = radius.expect("found");
        for point in [BreakPoint::Command, BreakPoint::Pitch, BreakPoint::Rate] {
            let open = model.open(case.gains, point).expect("finite");
            match open.unstable_radius() {
                Ok(None) => assert!(radius < 1.0, "{point:?}: {radius}"),
                Ok(Some(found)) => assert!((found - radius).abs() < 1e-8, "{point:?}: {found}"),
                Err(error) => panic!("{point:?}: {error}"),
            }
        }
        if radius < 1.0 { held += 1 } else { lost += 1 }
    }
    assert!(held > 2 && lost > 2, "{held} {lost}");
}

/// One sample of the closed loop has what the equations say of it.
#[test]
fn what_gains_gather_follows_its_equation() {
    let case = cases().remove(0);
    let gathered = Gathered { by_rate: 0.2, ..GATHERED };
    let [plain, model] = [None, Some(gathered)].map(|it| case.model().with_gathered(it));
    let size = model.size();
    assert_eq!((size, model.state_names().pop().as_deref()), (plain.size() + 1, Some("gains")));
    let [error, change] = model.error_rows();
    let [_, rate] = model.seen_rows();
    let last = &model.closed(case.gains)[size - 1];
    for place in 0..size {
        let of_itself = if place + 1 == size { gathered.keeps } else { 0.0 };
        let expected =
            of_itself + gathered.by_error * error[place] + gathered.by_change * change[place]
                - gathered.by_rate * rate[place];
        assert!((last[place] - expected).abs() < 1e-14, "{place}");
        // And it is added to the command at once.
        let own = plain.command_row(case.gains).get(place).copied().unwrap_or(0.0);
        assert!((model.command_row(case.gains)[place] - own - expected).abs() < 1e-14, "{place}");
    }
}

/// 10 000 samples used to be a matrix of 800 MB, whose eigenvalues nobody waits for.
#[test]
fn a_way_of_ten_thousand_samples_is_judged_without_a_matrix() {
    let of = |factor: f64| {
        let case = cases().remove(0);
        let Gains { kp, .. } = case.gains;
        // Without an integral: a loop whose gain is below 1 at every frequency holds behind any delay.
        let gains = Gains { kp: factor * kp, ki: 0.0, kd: 0.0 };
        Case { gains, actuator: servo(10_000), ..case }
    };
    let calm = of(0.01);
    assert_eq!(calm.model().unstable_radius(calm.gains), Ok(None));
    let bold = of(1.0);
    let found = bold.model().unstable_radius(bold.gains);
    assert!(matches!(found, Ok(Some(radius)) if radius > 1.0 && radius < 1.001), "{found:?}");
    let refused = bold.model().closed_matrix(bold.gains).expect_err("too long").to_string();
    assert!(refused.starts_with("10000 samples are on their way"), "{refused}");
    assert!(bold.model().open(bold.gains, BreakPoint::Command).is_err());
    assert!(bold.model().family(BreakPoint::Command).is_err());
}
