//! The enclosed plant against the one that simulations fly.

use fspid_core::{Gains, Pid, PidConfig};
use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_proof::check::{
    ActuatorLag, ContinuousPlant, IntervalMatrix, LagOf, NotProved, PrintedPlant, exponential,
    printed,
};
use fspid_sim::actuator::{Actuator, Lag};
use fspid_sim::loop_model::{Followers, LoopModel, LoopSettings, Memory, SampledPlant, Sensing};
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::{
    Controller, ElevatorSign, LinearPlant, NamedController, Scenario, Surroundings, Timing,
};

const GAINS: Gains<f64> = Gains { kp: 0.8, ki: 0.4, kd: 0.2 };
/// The paper's two plants, one whose elevator moves the pitch rate at once, one of first order.
const PLANTS: [(&[f64], &[f64], ElevatorSign); 4] = [
    (
        &[-1.69144, -0.84341, -0.0099096],
        &[1.0, 1.17103, 1.55405, 0.012538, 0.0072771],
        ElevatorSign::NoseDownPositive,
    ),
    (&[11.7304, 22.578], &[1.0, 4.9676, 12.941, 0.0], ElevatorSign::NoseUpPositive),
    (&[0.3, 1.1, 2.0], &[2.0, 3.1, 0.0, 0.7], ElevatorSign::NoseDownPositive),
    (&[1.3], &[3.0, 0.7], ElevatorSign::NoseUpPositive),
];
const LAGS: [ActuatorLag; 3] = [
    ActuatorLag::None,
    ActuatorLag::First { time_constant_s: 0.1 },
    ActuatorLag::Second { natural_frequency_rad_s: 30.0, damping: 0.7 },
];

/// The same loop as the simulation builds it: as one with its plant, or, with stops that are never reached, by legs.
fn flown(plant: usize, lag: ActuatorLag, dt_s: f64, as_one: bool) -> SampledPlant<f64> {
    let (numerator, denominator, sign) = PLANTS[plant];
    let plant = LinearPlant::new(numerator, denominator, sign).expect("allowed");
    let lag = match lag {
        ActuatorLag::None => Ok(Lag::NONE),
        ActuatorLag::First { time_constant_s } => Lag::first_order(time_constant_s),
        ActuatorLag::Second { natural_frequency_rad_s, damping } => {
            Lag::second_order(natural_frequency_rad_s, damping)
        }
    };
    let servo = Actuator::new(lag.expect("allowed"));
    let by_legs = servo.with_travel(-1e3, 1e3).expect("allowed");
    let config = PidConfig::sampled_every(dt_s);
    let pid = Pid::new(GAINS, config).expect("allowed");
    let scenario = Scenario {
        name: "plant".into(),
        plant: plant.clone().into(),
        plant_changes: Vec::new(),
        actuator: if as_one { servo } else { by_legs },
        timing: Timing::new(dt_s, 1.0).expect("allowed"),
        setpoint: Profile::new(0.0, Shape::Step { at_s: 0.0 }).expect("allowed"),
        disturbances: Vec::new(),
        controllers: vec![NamedController { name: "C".into(), controller: Controller::Fixed(pid) }],
        externals: Vec::new(),
        surroundings: Surroundings::default(),
        autopilot: None,
    };
    let memory = Memory::of_gains(GAINS, &config);
    LoopModel::of(&scenario, &plant, &config, memory).expect("a loop").plant().clone()
}

fn enclosed(plant: usize, lag: ActuatorLag, dt_s: f64) -> SampledPlant<Interval> {
    let (numerator, denominator, elevator_sign) = PLANTS[plant];
    let printed = PrintedPlant { numerator, denominator, elevator_sign, lag, dt_s };
    printed.sampled().expect("a plant")
}

/// Largest distance of a number from its enclosure, and largest radius, as parts of the largest entry.
fn distances(enclosed: &[Interval], found: &[f64]) -> (f64, f64) {
    assert_eq!(enclosed.len(), found.len());
    let largest = found.iter().fold(1e-300, |most: f64, value| most.max(value.abs()));
    let outside = enclosed.iter().zip(found).fold(0.0, |most: f64, (entry, value)| {
        most.max(entry.lower() - value).max(value - entry.upper())
    });
    let radius = enclosed.iter().fold(0.0, |most: f64, entry| most.max(entry.radius()));
    (outside / largest, radius / largest)
}

#[test]
fn the_plant_of_the_simulation_lies_inside_but_for_its_own_rounding() {
    for plant in 0..PLANTS.len() {
        for lag in LAGS {
            for dt_s in [0.01, 0.02, 0.05] {
                let second = matches!(lag, ActuatorLag::Second { .. });
                for as_one in [false, true].into_iter().filter(|as_one| !(*as_one && second)) {
                    let flown = flown(plant, lag, dt_s, as_one);
                    let enclosed = enclosed(plant, lag, dt_s);
                    assert_eq!(enclosed.states, flown.states);
                    let (outside, radius) = distances(&enclosed.rows, &flown.rows);
                    assert!(outside < 1e-15, "{plant} {lag:?} {dt_s}: {outside:e}");
                    assert!(radius < 1e-14, "{plant} {lag:?} {dt_s}: {radius:e}");
                    let (outside, radius) = distances(&enclosed.rate, &flown.rate);
                    assert!(outside <= 0.0 && radius < 1e-15, "{plant} {lag:?}: {outside:e}");
                }
            }
        }
    }
}

#[test]
fn the_enclosed_loop_holds_the_loop_in_floats() {
    let config = PidConfig::sampled_every(0.02);
    let settings = LoopSettings {
        config,
        followers: Followers::NONE,
        memory: Memory::of_gains(GAINS, &config),
        delay_samples: 1,
        pitch: Sensing::DIRECT,
        rate: Sensing::DIRECT,
    };
    let lag = LAGS[1];
    let enclosed = LoopModel::new(enclosed(0, lag, 0.02), settings.clone());
    let point = Interval::point;
    let gains = Gains { kp: point(GAINS.kp), ki: point(GAINS.ki), kd: point(GAINS.kd) };
    let matrix = IntervalMatrix::from_rows(&enclosed.closed(gains)).expect("square");
    let flown = LoopModel::new(flown(0, lag, 0.02, true), settings);
    let flown = flown.closed_matrix(GAINS).expect("finite");
    let entries: Vec<Interval> = matrix.entries().collect();
    let (outside, radius) = distances(&entries, flown.data());
    assert!(outside < 1e-15 && radius < 1e-14, "{outside:e} {radius:e}");
}

#[test]
fn a_printed_number_stands_for_its_decimal_and_zero_for_itself() {
    // 0.1 is not a float: it lies between the one that it reads as and the next below.
    let tenth = printed(0.1);
    assert!(tenth.lower() < 0.1 && tenth.upper() > 0.1);
    assert_eq!(printed(0.0), Interval::ZERO);
    assert_eq!(printed(-0.0), Interval::ZERO);
    assert_eq!(printed(f64::NAN), Interval::ENTIRE);
}

#[test]
fn the_zeros_of_the_printed_plant_stay_exact() {
    let navion = enclosed(1, LAGS[1], 0.01);
    // No pole at rest: pitch keeps its value, and the servo feels nothing of the plant.
    let entry = |row: usize, column: usize| navion.rows[row * (navion.states + 1) + column];
    assert_eq!([entry(0, 0), entry(1, 0), entry(2, 0)], [1.0, 0.0, 0.0].map(Interval::point));
    assert_eq!([entry(3, 0), entry(3, 1), entry(3, 2)], [Interval::ZERO; 3]);
    let ideal = enclosed(1, LAGS[0], 0.01);
    let last = &ideal.rows[ideal.rows.len() - ideal.states - 1..];
    assert_eq!(last, [0.0, 0.0, 0.0, 0.0, 1.0].map(Interval::point));
}

#[test]
fn a_plant_that_cannot_be_is_refused() {
    let (numerator, denominator, elevator_sign) = PLANTS[1];
    let lag = ActuatorLag::None;
    let good = PrintedPlant { numerator, denominator, elevator_sign, lag, dt_s: 0.01 };
    assert!(good.sampled().is_ok());
    for dt_s in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        let found = PrintedPlant { dt_s, ..good }.sampled();
        assert!(matches!(found, Err(NotProved::Number { .. })), "{dt_s}");
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let first = ActuatorLag::First { time_constant_s: bad };
        let second = ActuatorLag::Second { natural_frequency_rad_s: bad, damping: 0.7 };
        let undamped = ActuatorLag::Second { natural_frequency_rad_s: 30.0, damping: bad };
        for lag in [first, second, undamped] {
            assert!(PrintedPlant { lag, ..good }.sampled().is_err(), "{lag:?}");
        }
    }
    let jump: &[f64] = &[1.0, 2.0, 3.0, 4.0];
    for numerator in [jump, &[], &[f64::NAN], &[0.0]] {
        let found = PrintedPlant { numerator, ..good }.sampled();
        assert!(matches!(found, Err(NotProved::Plant(_))), "{numerator:?}");
    }
    let bolting = PrintedPlant { denominator: &[1.0, -1e6, 0.0], numerator: &[1.0], ..good };
    assert!(matches!(bolting.sampled(), Err(NotProved::Unbounded { .. })));
}

/// Coefficients with the highest power of s first.
fn value(coefficients: &[f64], s: f64) -> f64 {
    coefficients.iter().fold(0.0, |sum, coefficient| sum * s + coefficient)
}

#[test]
fn the_normal_form_has_the_transfer_function_from_elevator_to_pitch_and_pitch_rate() {
    let denominator = [2.0, 3.1, 1.7, 4.0, 0.7];
    let numerator = [-1.5, 1.1, 2.0, 0.3];
    for order in 1..=4_usize {
        for inner in 0..order {
            let (numerator, denominator) = (&numerator[..=inner], &denominator[..=order]);
            for (sign, per_nose_up) in
                [(ElevatorSign::NoseUpPositive, 1.0), (ElevatorSign::NoseDownPositive, -1.0)]
            {
                let parts = (sign, LagOf::None);
                let plant =
                    ContinuousPlant::in_normal_form(numerator, denominator, parts, |it| *it == 0.0);
                let plant = plant.expect("strictly proper");
                assert_eq!((plant.by_states.len(), plant.by_elevator.len()), (order, order));
                for s in [0.3, 1.0, 4.0] {
                    let entry = |row: usize, column: usize| {
                        (if row == column { s } else { 0.0 }) - plant.by_states[row][column]
                    };
                    let rows: Vec<Vec<f64>> = (0..order)
                        .map(|row| (0..order).map(|column| entry(row, column)).collect())
                        .collect();
                    let input: Vec<[f64; 1]> = plant.by_elevator.iter().map(|it| [*it]).collect();
                    let input = Matrix::from_rows(&input).expect("finite");
                    let states = Matrix::from_rows(&rows).expect("square").solve(&input);
                    let states = states.expect("no pole on the right");
                    let expected = per_nose_up * value(numerator, s) / value(denominator, s);
                    let pitch = states.data()[0];
                    assert!(
                        (pitch - expected).abs() < 1e-12 * expected.abs(),
                        "{order} {inner} {s}"
                    );
                    let rate = states.data().iter().chain([&1.0]).zip(&plant.pitch_rate);
                    let rate: f64 = rate.map(|(state, by)| state * by).sum();
                    assert!(
                        (rate - s * expected).abs() < 1e-11 * expected.abs(),
                        "{order} {inner} {s}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_numerator_that_may_vanish_or_is_none_of_a_plant_has_no_normal_form() {
    let form = |numerator: &[f64], denominator: &[f64]| {
        let parts = (ElevatorSign::NoseUpPositive, LagOf::None);
        ContinuousPlant::in_normal_form(numerator, denominator, parts, |it| it.abs() < 0.1)
    };
    assert!(form(&[1.0, 2.0], &[1.0, 2.0, 3.0]).is_some());
    assert_eq!(form(&[0.05, 2.0], &[1.0, 2.0, 3.0]), None);
    assert_eq!(form(&[1.0, 2.0], &[0.05, 2.0, 3.0]), None);
    assert_eq!(form(&[1.0, 2.0, 3.0], &[1.0, 2.0, 3.0]), None);
    assert_eq!(form(&[1.0, 2.0, 3.0, 4.0], &[1.0, 2.0, 3.0]), None);
    assert_eq!(form(&[], &[1.0, 2.0]), None);
    assert_eq!(form(&[1.0], &[]), None);
}

fn printed_plant(plant: usize, dt_s: f64) -> PrintedPlant<'static> {
    let (numerator, denominator, elevator_sign) = PLANTS[plant];
    PrintedPlant { numerator, denominator, elevator_sign, lag: ActuatorLag::None, dt_s }
}

#[test]
fn an_elevator_moves_the_rate_at_once_where_the_numerator_is_one_degree_below() {
    let at_once = [0, 1, 2, 3].map(|plant| printed_plant(plant, 0.02).moves_rate_at_once());
    assert_eq!(at_once, [false, false, true, true]);
}

#[test]
fn an_impulse_within_a_sample_is_held_at_its_start_at_its_end_and_between() {
    for (plant, states) in [(0, 4), (1, 3), (2, 3), (3, 1)] {
        let found = printed_plant(plant, 0.01).impulse_within_sample().expect("a plant");
        assert_eq!(found.len(), states);
        let (numerator, denominator, sign) = PLANTS[plant];
        let parts = (sign, LagOf::None);
        let own = ContinuousPlant::of_transfer_function(numerator, denominator, parts.0, parts.1);
        let column: Vec<[f64; 1]> = own.by_elevator.iter().map(|it| [*it]).collect();
        let column = IntervalMatrix::from(&Matrix::from_rows(&column).expect("finite"));
        let a = IntervalMatrix::from(&Matrix::from_rows(&own.by_states).expect("square"));
        let largest = column.entries().fold(0.0, |most: f64, entry| most.max(entry.magnitude()));
        for time_s in [0.0, 0.003, 0.01] {
            let moved = exponential(&a.scaled(Interval::point(time_s))).expect("small");
            let moved = moved.product(&column).expect("fits").midpoint();
            for (entry, value) in found.iter().zip(moved.data()) {
                let near = 1e-14 * largest;
                assert!(
                    entry.lower() <= value + near && entry.upper() >= value - near,
                    "{plant} {time_s}"
                );
                assert!(entry.width() < 0.5 * largest, "{plant} {entry:?}");
            }
        }
    }
}

/// $E E^T$, entry by entry.
fn square(factor: &Matrix) -> Vec<f64> {
    factor.product(&factor.transpose()).expect("square").data().to_vec()
}

#[test]
fn a_gust_that_enters_as_the_elevator_does_adds_as_much() {
    for (number, (numerator, denominator, _)) in PLANTS.into_iter().enumerate() {
        let plant = printed_plant(number, 0.02);
        let elevator = square(&plant.driven(None).expect("proved"));
        let states = denominator.len() - 1;
        for factor in [1.0, 3.0] {
            // Over the denominator with a leading 1.
            let mut gust = vec![0.0; states - numerator.len()];
            gust.extend(numerator.iter().map(|it| factor * it / denominator[0]));
            let found = square(&plant.driven(Some(&gust)).expect("proved"));
            let largest = elevator.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
            for (found, elevator) in found.iter().zip(&elevator) {
                let expected = factor * factor * elevator;
                assert!(
                    (found - expected).abs() < 1e-6 * factor * factor * largest,
                    "{found:e} {expected:e}"
                );
            }
        }
        for other in [states - 1, states + 1] {
            let found = plant.driven(Some(&vec![1.0; other]));
            assert!(matches!(found, Err(NotProved::Number { .. })), "{other} {found:?}");
        }
    }
}
