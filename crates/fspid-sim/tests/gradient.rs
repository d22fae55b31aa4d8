//! What every number of a controller is worth: held against differences of flights, for every option.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use std::ops::ControlFlow;

use fspid_core::fuzzy::{Network, NumberTable, OutOfRange, Output, Supervisor};
use fspid_core::{
    AntiWindup, Fspid, GainCoupling, Gains, InputScale, Law, Pid, PidConfig, ReferenceModel,
    SecondInput, SelfTuner, SetCentres, TunerSettings,
};
use fspid_sim::air::{Follows, Intensity, Severity, Specification, Turbulence, WindKind};
use fspid_sim::batch::{Entrant, Refusal};
use fspid_sim::gradient::{Differentiated, NUMBERS, Weights, differentiate, names, numbers};
use fspid_sim::sensor::{PITCH, RATE, Sensor, SensorModel};
use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
use fspid_sim::{
    Actuator, Controller, Course, ElevatorSign, LinearPlant, LongitudinalDerivatives, Outcome,
    Prepared, Scenario, Surroundings, Timing, Weather, fly,
};
use proptest::prelude::*;

const WEIGHTS: Weights = Weights { iae_rad_s: 1.0, ise_rad2_s: 3.0, travel_rad: 0.05 };

fn scenario(dt_s: f64, servo: Actuator, [step_rad, load_rad]: [f64; 2]) -> Scenario {
    let (numerator, denominator) = ([11.7304, 22.578], [1.0, 4.9676, 12.941, 0.1]);
    let sign = ElevatorSign::NoseUpPositive;
    let plant = LinearPlant::new(&numerator, &denominator, sign).expect("a plant");
    let timing = Timing::new(dt_s, 300.0 * dt_s).expect("a timing");
    let step = Profile::new(step_rad, Shape::Step { at_s: 20.0 * dt_s }).expect("a step");
    let load = |entry, at| {
        let shape = Shape::Step { at_s: f64::from(at) * dt_s };
        Disturbance::new(entry, load_rad, shape).expect("a load")
    };
    Scenario {
        actuator: servo,
        disturbances: vec![
            load(Entry::Servo, 150),
            load(Entry::Elevator, 200),
            load(Entry::Measurement, 250),
        ],
        ..Scenario::new("gradient", plant, timing, step)
    }
}

fn servo(lag_s: f64, limits: Option<[f64; 2]>, delay: usize) -> Actuator {
    let servo = Actuator::first_order(lag_s).and_then(|it| it.with_delay(delay)).expect("a servo");
    limits.map_or(servo, |[position_rad, rate_rad_s]| {
        let limited = servo.with_position_limit(position_rad);
        limited.and_then(|it| it.with_rate_limit(rate_rad_s)).expect("limits")
    })
}

/// Integrals of the error and its square, and the travel, of a flight by the simulator; none for one that is lost.
fn flown(prepared: &Prepared, controller: &Controller) -> Option<[f64; 3]> {
    let (mut sums, mut before, mut near) = ([0.0; 3], None, true);
    let outcome = fly(prepared, controller, |instant| {
        let error_rad = instant.setpoint_rad - instant.theta_rad;
        sums[0] += error_rad.abs();
        sums[1] += error_rad * error_rad;
        let last = before.replace(instant.elevator_rad);
        sums[2] += last.map_or(0.0, |last: f64| (instant.elevator_rad - last).abs());
        // A flight that grows without end has differences of its last instants alone.
        near &= instant.theta_rad.abs() < 3.0 && instant.step.faults.is_empty();
        ControlFlow::Continue(())
    });
    let dt_s = prepared.timing().dt_s();
    let [iae, ise, travel] = sums;
    (outcome == Ok(Outcome::Completed) && near).then_some([iae * dt_s, ise * dt_s, travel])
}

fn cost(prepared: &Prepared, controller: &Controller) -> Option<f64> {
    let [iae, ise, travel] = flown(prepared, controller)?;
    let Weights { iae_rad_s, ise_rad2_s, travel_rad } = WEIGHTS;
    Some(iae_rad_s * iae + ise_rad2_s * ise + travel_rad * travel)
}

fn gradient(
    prepared: &Prepared,
    controller: &Controller,
) -> Result<Option<Differentiated>, Refusal> {
    let entrant = Entrant { prepared, controller };
    Ok(differentiate::<8>(&[entrant], &[WEIGHTS])?.pop().flatten())
}

/// The parts of a controller, so that each can be moved by a little.
#[derive(Clone, Copy)]
struct Parts {
    gains: Gains<f64>,
    config: PidConfig<f64>,
    tuner: Option<(Supervisor<f64>, TunerSettings<f64>)>,
}

impl Parts {
    fn of(controller: &Controller) -> Self {
        let tuner = match controller {
            Controller::Fixed(_) => None,
            Controller::SelfTuning(fspid) => {
                Some((*fspid.tuner().supervisor(), *fspid.tuner().settings()))
            }
        };
        Self { gains: controller.nominal(), config: *controller.config(), tuner }
    }

    fn built(&self) -> Option<Controller> {
        let Some((supervisor, settings)) = self.tuner else {
            return Some(Controller::Fixed(Pid::new(self.gains, self.config).ok()?));
        };
        let tuner = SelfTuner::new(self.gains, supervisor, settings).ok()?;
        Some(Controller::SelfTuning(Fspid::new(tuner, self.config).ok()?))
    }
}

/// How many directions there are.
const DIRECTIONS: usize = 23;

/// The controller with one of its settings moved; none where it has no such setting.
fn moved(mut parts: Parts, direction: usize, by: f64) -> Option<Controller> {
    let config = &mut parts.config;
    match direction {
        22 => config.feedforward += by,
        0 => parts.gains.kp += by,
        1 => parts.gains.ki += by,
        2 => parts.gains.kd += by,
        3 => config.rate_gain_s += by,
        4 => config.setpoint_weights.proportional += by,
        5 => config.setpoint_weights.derivative += by,
        6 => config.derivative.filter_s += by,
        7 => match &mut config.anti_windup {
            AntiWindup::BackCalculation { tracking_s } => *tracking_s += by,
            _ => return None,
        },
        _ => {
            let (supervisor, settings) = parts.tuner.as_mut()?;
            let InputScale { error_per_rad, change_per_rad } = &mut settings.input_scale;
            let GainCoupling { setpoint_weight, rate_gain } = &mut settings.gain_coupling;
            match direction {
                8 => *error_per_rad += by,
                9 => *change_per_rad += by,
                10 => settings.output_scale.kp += by,
                11 => settings.output_scale.ki += by,
                12 => settings.output_scale.kd += by,
                13 => *setpoint_weight += by,
                14 => *rate_gain += by,
                15 => match &mut settings.law {
                    Law::Accumulating { leakage_per_s } => *leakage_per_s += by,
                    Law::Memoryless => return None,
                },
                16 | 17 => match &mut settings.second_input {
                    SecondInput::ModelError(ReferenceModel { bandwidth_rad_s, damping }) => {
                        *(if direction == 16 { bandwidth_rad_s } else { damping }) += by;
                    }
                    _ => return None,
                },
                18 | 19 => {
                    let sets = &mut settings.input_sets;
                    let places = if direction == 18 { &mut sets.error } else { &mut sets.change };
                    let (small, medium) = places.map(|it| (it.small(), it.medium()))?;
                    *places = Some(SetCentres::new(small + by, medium - 0.3 * by).ok()?);
                }
                _ => *supervisor = with_cells(supervisor, direction, by)?,
            }
        }
    }
    parts.built()
}

/// All cells of some gains moved, or all weights of a network, each by another amount.
fn with_cells(supervisor: &Supervisor<f64>, direction: usize, by: f64) -> Option<Supervisor<f64>> {
    let share = |place: usize| ((place * direction) % 7) as f64 / 7.0 - 0.4;
    if let Some(network) = supervisor.network() {
        let mut rows = *network.rows();
        for (place, weight) in rows.iter_mut().flatten().enumerate() {
            *weight += by * share(place);
        }
        let network = Network::new(rows).ok()?;
        return Supervisor::of_network(&network, supervisor.range(), supervisor.out_of_range())
            .ok();
    }
    let table = supervisor.numbers()?;
    let mut grids = Output::ALL.map(|output| *table.grid(output));
    for (place, cell) in grids.iter_mut().flatten().flatten().enumerate() {
        let share = share(place);
        *cell = (*cell + by * share).clamp(-supervisor.range(), supervisor.range());
    }
    let table = NumberTable::new(grids).ok()?;
    Supervisor::of_numbers(&table, supervisor.range(), supervisor.out_of_range()).ok()
}

/// What was compared, and what lay around a corner.
#[derive(Debug, Default)]
struct Compared {
    good: [usize; DIRECTIONS],
    corners: usize,
}

fn compare(prepared: &Prepared, controller: &Controller, compared: &mut Compared) {
    let here = cost(prepared, controller);
    let found = match gradient(prepared, controller) {
        Ok(found) => found,
        Err(refusal) => {
            let told = refusal.to_string();
            assert!(told.contains("labels") || told.contains("refuses inputs"), "{told}");
            return;
        }
    };
    let (Some(here), Some(found)) = (here, found) else { return };
    let parts = Parts::of(controller);
    for direction in 0..DIRECTIONS {
        const BY: f64 = 1e-6;
        let sides = [-BY, BY].map(|by| {
            let controller = moved(parts, direction, by)?;
            Some((cost(prepared, &controller)?, numbers(&controller)))
        });
        let [Some((below, from)), Some((above, to))] = sides else { continue };
        let slope = (above - below) / (2.0 * BY);
        let along: f64 =
            (0..NUMBERS).map(|it| found.gradient[it] * finite(to[it] - from[it])).sum::<f64>()
                / (2.0 * BY);
        // Differences to both sides that are apart lie around a corner, or where rounding is all there is.
        let sides = [(here - below) / BY, (above - here) / BY];
        let apart = (sides[0] - sides[1]).abs();
        let size = 1.0_f64.max(slope.abs());
        if apart > 2e-4 * size {
            compared.corners += 1;
            continue;
        }
        assert!(
            (slope - along).abs() < 5e-4 * size,
            "direction {direction}: {along} by the way back, {slope} by differences {sides:?} of {controller:?}"
        );
        compared.good[direction] += 1;
    }
}

/// Infinite limits do not move.
fn finite(difference: f64) -> f64 {
    if difference.is_finite() { difference } else { 0.0 }
}

#[test]
fn the_way_back_has_the_slopes_of_differences_for_every_option() {
    let mut runner = proptest::test_runner::TestRunner::new_with_rng(
        ProptestConfig::default(),
        proptest::test_runner::TestRng::from_seed(
            proptest::test_runner::RngAlgorithm::ChaCha,
            &[20; 32],
        ),
    );
    let drawn = (
        fspid_options::any_controller(),
        0.03_f64..0.2,
        0..4_usize,
        prop::bool::ANY,
        0.05_f64..0.3,
        -0.05_f64..0.05,
    );
    let mut compared = Compared::default();
    for _ in 0..1500 {
        let tree = drawn.new_tree(&mut runner).expect("a draw");
        let (controller, lag_s, delay, limits, step_rad, load_rad) =
            proptest::strategy::ValueTree::current(&tree);
        let servo = servo(lag_s, limits.then_some([0.2, 0.6]), delay);
        let dt_s = controller.config().dt_s;
        let prepared = scenario(dt_s, servo, [step_rad, load_rad]).prepare().expect("flies");
        compare(&prepared, &controller, &mut compared);
    }
    assert!(compared.good.iter().all(|&count| count >= 10), "{compared:?}");
    assert!(compared.good.iter().sum::<usize>() > 4 * compared.corners, "{compared:?}");
}

/// Nelson's rounded derivatives of the Navion, ft and s: a plant that feels gusts.
const NAVION: LongitudinalDerivatives = LongitudinalDerivatives {
    u0: 176.0,
    gravity: 32.2,
    x: [-0.045, 0.036, 0.0],
    z: [-0.369, -2.02, 0.0, 0.0, -28.15],
    m: [0.0, -0.05, -0.0051, -2.05, -11.874],
};

/// A sensor of noise, bias, drift and a scale error, with its own clock and delay where it has some.
fn sensor(channel: u32, [period_s, delay_s]: [f64; 2]) -> Sensor {
    let model = SensorModel {
        noise_density: 2e-4,
        bias: 2e-3,
        drift: 2e-3,
        drift_time_s: 0.5,
        scale_error: 0.02,
        period_s,
        delay_s,
        ..SensorModel::default()
    };
    Sensor::new(model, 7, channel).expect("allowed")
}

fn weather(gust: bool, rough: bool) -> Option<Weather> {
    let airspeed_m_s = 53.6;
    let course = Course {
        airspeed_m_s,
        height_m: 150.0,
        climb_rad: 0.0,
        axes_rad: 0.0,
        heading_rad: 0.0,
        start_m: [0.0; 2],
    };
    let turbulence = Turbulence {
        specification: Specification::MilF8785c,
        intensity: Intensity::new(10.0, Severity::Light).expect("allowed"),
        height_m: 150.0,
        airspeed_m_s,
        wing_span_m: 10.0,
        noise: 9.into(),
        follows: Follows::Start,
        driven_until_s: f64::INFINITY,
    };
    let wind = WindKind::FullCycle.build(&[3.0, 0.0, -6.0, 40.0, 20.0]).expect("allowed");
    let winds = if gust { vec![wind] } else { Vec::new() };
    (gust || rough).then_some(Weather { course, winds, turbulence: rough.then_some(turbulence) })
}

#[test]
fn through_sensors_and_in_moving_air_the_way_back_has_the_slopes_of_differences() {
    let mut runner = proptest::test_runner::TestRunner::new_with_rng(
        ProptestConfig::default(),
        proptest::test_runner::TestRng::from_seed(
            proptest::test_runner::RngAlgorithm::ChaCha,
            &[21; 32],
        ),
    );
    let drawn = (
        fspid_options::any_controller(),
        0..4_usize,
        [prop::bool::ANY, prop::bool::ANY, prop::bool::ANY],
        [0..4_usize, 0..4_usize],
        0.05_f64..0.3,
    );
    let clocks = [[0.0, 0.0], [0.0, 0.013], [0.037, 0.0], [0.02, 0.051]];
    let mut compared = Compared::default();
    for _ in 0..700 {
        let tree = drawn.new_tree(&mut runner).expect("a draw");
        let (controller, delay, [limits, gust, rough], [pitch, rate], step_rad) =
            proptest::strategy::ValueTree::current(&tree);
        let servo = servo(0.1, limits.then_some([0.2, 0.6]), delay);
        let calm = scenario(controller.config().dt_s, servo, [step_rad, 0.02]);
        let seen = |channel, clock: usize| (clock > 0).then(|| sensor(channel, clocks[clock]));
        let surroundings = Surroundings {
            weather: weather(gust, rough),
            pitch_sensor: seen(PITCH, pitch),
            rate_sensor: seen(RATE, rate),
        };
        let plant = NAVION.plant(0.3048).expect("a plant").into();
        let prepared = Scenario { plant, surroundings, ..calm }.prepare().expect("flies");
        compare(&prepared, &controller, &mut compared);
    }
    assert!(compared.good.iter().all(|&count| count >= 5), "{compared:?}");
    assert!(compared.good.iter().sum::<usize>() > 4 * compared.corners, "{compared:?}");
}

/// A self-tuner of numbers as the designs have it, and the PID that it is without.
fn designs(seed: u64) -> [Controller; 2] {
    let dt_s = 0.01;
    let mut state = seed;
    let mut random = |low: f64, high: f64| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let grids = [[[0.0; 7]; 7]; 3].map(|grid| grid.map(|row| row.map(|_| random(-1.0, 1.0))));
    let table = NumberTable::new(grids).expect("finite");
    let supervisor = Supervisor::of_numbers(&table, 1.0, OutOfRange::Clamp).expect("allowed");
    let gains = Gains { kp: random(0.8, 1.4), ki: random(0.8, 1.6), kd: random(0.0, 0.1) };
    let limits = fspid_core::Limits::new(fspid_core::ControllerSetting::OutputLimits, -0.35, 0.35);
    let config = PidConfig {
        rate_gain_s: 0.2,
        limits: Some(limits.expect("limits")),
        anti_windup: AntiWindup::BackCalculation { tracking_s: 0.5 },
        ..PidConfig::sampled_every(dt_s)
    };
    let settings = TunerSettings {
        second_input: SecondInput::ModelError(ReferenceModel {
            bandwidth_rad_s: 2.0,
            damping: 0.9,
        }),
        input_scale: InputScale { error_per_rad: 10.0, change_per_rad: 30.0 },
        output_scale: Gains { kp: 0.5, ki: 1.0, kd: 0.02 },
        gain_coupling: GainCoupling { setpoint_weight: 0.1, rate_gain: 0.5 },
        law: Law::Accumulating { leakage_per_s: 0.5 },
        ..TunerSettings::literal()
    };
    let tuner = SelfTuner::new(gains, supervisor, settings).expect("allowed");
    let fspid = Fspid::new(tuner, config).expect("allowed");
    [Controller::SelfTuning(fspid), Controller::Fixed(Pid::new(gains, config).expect("allowed"))]
}

#[test]
fn costs_are_those_of_the_flights_and_lanes_do_not_show() {
    for which in 0..2 {
        let prepared: Vec<Prepared> = (0..5_u32)
            .map(|it| {
                let step_rad = 0.03 * f64::from(it) + 0.02;
                // Other delays, a lane without limits, and one with a sensor.
                let limits = (it != 1).then_some([0.35, 0.65]);
                let servo = servo(0.1, limits, it as usize % 3);
                let mut scenario = scenario(0.01, servo, [step_rad, 0.01]);
                scenario.surroundings.pitch_sensor =
                    (it == 3).then(|| sensor(PITCH, [0.02, 0.013]));
                scenario.prepare().expect("flies")
            })
            .collect();
        let controllers: Vec<Controller> = (0..5).map(|seed| designs(seed)[which]).collect();
        let entrants: Vec<Entrant<'_>> = prepared
            .iter()
            .zip(&controllers)
            .map(|(prepared, controller)| Entrant { prepared, controller })
            .collect();
        let together = differentiate::<8>(&entrants, &[WEIGHTS; 5]).expect("differentiable");
        for (entrant, found) in entrants.iter().zip(together) {
            let found = found.expect("it flies");
            let alone = differentiate::<1>(&[*entrant], &[WEIGHTS]).expect("differentiable");
            assert_eq!(alone, vec![Some(found.clone())]);
            let [iae, ise, travel] = flown(entrant.prepared, entrant.controller).expect("flies");
            for (own, flown) in
                [(found.iae_rad_s, iae), (found.ise_rad2_s, ise), (found.travel_rad, travel)]
            {
                assert!((own - flown).abs() < 1e-10 * flown, "{own} {flown}");
            }
            assert_eq!(found.gradient.len(), names(entrant.controller).len());
        }
    }
}

#[test]
fn what_has_no_gradient_is_refused_by_name_and_what_is_lost_has_none() {
    let [fspid, pid] = designs(1);
    let refused = |scenario: Scenario| {
        let prepared = scenario.prepare().expect("flies");
        gradient(&prepared, &pid).expect_err("it is refused").to_string()
    };
    let calm = || scenario(0.01, servo(0.1, None, 0), [0.05, 0.0]);
    let ideal = Scenario { actuator: Actuator::ideal(), ..calm() };
    assert!(refused(ideal).contains("a servo without lag"));
    let model = SensorModel { resolution: 1e-3, ..SensorModel::default() };
    let sensor = Sensor::new(model, 1, PITCH).expect("allowed");
    let surroundings = Surroundings { pitch_sensor: Some(sensor), ..Surroundings::default() };
    let told = refused(Scenario { surroundings, ..calm() });
    assert!(told.contains("a sensor with a resolution"), "{told}");
    let lag = fspid_sim::actuator::Lag::second_order(30.0, 0.7).expect("allowed");
    let told = refused(Scenario { actuator: Actuator::new(lag), ..calm() });
    assert!(told.contains("an actuator that is no first-order servo"), "{told}");
    let labels = fspid_options::labels(OutOfRange::Clamp);
    let Controller::SelfTuning(of_numbers) = fspid else { panic!("it tunes itself") };
    let tuner =
        SelfTuner::new(of_numbers.tuner().nominal(), labels, *of_numbers.tuner().settings());
    let of_labels = Fspid::new(tuner.expect("allowed"), *of_numbers.config()).expect("allowed");
    let prepared = calm().prepare().expect("flies");
    let told = gradient(&prepared, &Controller::SelfTuning(of_labels)).expect_err("refused");
    assert!(told.to_string().contains("rules that conclude labels"), "{told}");
    let unstable = Pid::new(Gains { kp: 400.0, ki: 0.0, kd: 0.0 }, PidConfig::sampled_every(0.01));
    let unstable = Controller::Fixed(unstable.expect("allowed"));
    let long = Scenario { timing: Timing::new(0.01, 60.0).expect("a timing"), ..calm() };
    let prepared = long.prepare().expect("flies");
    assert_eq!(gradient(&prepared, &unstable).expect("differentiable"), None);
}

/// A step downhill along the gradient makes the mean cost of many flights smaller by what it says.
#[test]
fn a_small_step_against_the_gradient_saves_what_it_promises() {
    let servo = servo(0.1, Some([0.35, 0.65]), 1);
    let prepared = scenario(0.01, servo, [0.1, 0.02]).prepare().expect("flies");
    let [fspid, _] = designs(3);
    let found = gradient(&prepared, &fspid).expect("differentiable").expect("flies");
    let Controller::SelfTuning(own) = fspid else { panic!("it tunes itself") };
    let table = own.tuner().supervisor().numbers().expect("numbers");
    let mut grids = Output::ALL.map(|output| *table.grid(output));
    let cells: Vec<usize> =
        (0..NUMBERS).filter(|&it| names(&fspid)[it].contains(", row ")).collect();
    let length: f64 =
        cells.iter().map(|&it| found.gradient[it] * found.gradient[it]).sum::<f64>().sqrt();
    assert!(length > 1e-6, "no cell matters");
    let by = 1e-4;
    for (cell, place) in grids.iter_mut().flatten().flatten().zip(&cells) {
        *cell = (*cell - by * found.gradient[*place] / length).clamp(-1.0, 1.0);
    }
    let table = NumberTable::new(grids).expect("finite");
    let supervisor = Supervisor::of_numbers(&table, 1.0, OutOfRange::Clamp).expect("allowed");
    let tuner = SelfTuner::new(own.tuner().nominal(), supervisor, *own.tuner().settings());
    let less = Fspid::new(tuner.expect("allowed"), *own.config()).expect("allowed");
    let saved = cost(&prepared, &fspid).expect("flies")
        - cost(&prepared, &Controller::SelfTuning(less)).expect("flies");
    assert!((saved / (by * length) - 1.0).abs() < 0.05, "{saved} {}", by * length);
}
