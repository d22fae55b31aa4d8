//! Flights that are answered from outside have the bits of those that a loop of their own flies.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use std::sync::Arc;

use fspid_core::{Faults, Gains, Pid, PidConfig, State, Step};
use fspid_sim::actuator::Lag;
use fspid_sim::batch::Formation;
use fspid_sim::sensor::{PITCH, Sensor, SensorPreset};
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::{
    Actuator, Controller, ElevatorSign, InFlight, LinearPlant, Outcome, Prepared, Scenario, Seen,
    SimError, Timing,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::batch::{Flown, PLAIN, WILD, bits, flights, singly, structure};

fn answered(prepared: &Prepared, controller: &Controller) -> Flown {
    let mut flight = InFlight::start(prepared).expect("starts");
    let (mut state, mut rows) = (State::new(), Vec::new());
    loop {
        let seen = match flight.seen() {
            Ok(seen) => seen,
            Err(outcome) => return (rows, Ok(outcome)),
        };
        let step = controller.step(&mut state, seen.sample());
        match flight.act(step) {
            Ok(instant) => rows.push(bits(&instant.expect("it waited"))),
            Err(error) => {
                // The loop shows a sample before it leaves it.
                rows.push(Default::default());
                return (rows, Err(error));
            }
        }
    }
}

type Sights = (Vec<[u64; 6]>, Option<Outcome>);

fn sight(seen: &Seen) -> [u64; 6] {
    let Seen { k, setpoint_rad, theta_rad, q_rad_s, measured: [pitch_rad, rate_rad_s] } = *seen;
    [k as f64, setpoint_rad, theta_rad, q_rad_s, pitch_rad, rate_rad_s].map(f64::to_bits)
}

/// A command alone; in a formation nobody tells more.
fn command(command_rad: f64) -> Step<f64> {
    Step { command_rad, gains: Gains::ZERO, saturated: false, faults: Faults::NONE }
}

fn alone(prepared: &Prepared, controller: &Controller) -> Result<Sights, SimError> {
    let mut flight = InFlight::start(prepared)?;
    let (mut state, mut rows) = (State::new(), Vec::new());
    while let Ok(seen) = flight.seen() {
        rows.push(sight(&seen));
        flight.act(command(controller.step(&mut state, seen.sample()).command_rad))?;
    }
    Ok((rows, flight.seen().err()))
}

/// Flies all of them in a formation of four: whoever waits is put into the next place that is free, one a sample, so
/// that none is at the sample of another.
fn in_formation(flights: &[(Prepared, Controller)]) -> (Vec<Sights>, usize) {
    let mut formation = Formation::<4>::default();
    let mut flown: Vec<Sights> = vec![(Vec::new(), None); flights.len()];
    let mut at: [Option<(usize, State<f64>)>; 4] = [None; 4];
    let (mut waiting, mut in_lanes) = (0..flights.len(), 0);
    loop {
        let free = at.iter().position(Option::is_none);
        if let Some((place, flight)) = free.and_then(|place| Some((place, waiting.next()?))) {
            formation.start(place, Arc::new(flights[flight].0.clone())).expect("starts");
            in_lanes += usize::from(formation.is_in_lane(place));
            at[place] = Some((flight, State::new()));
        }
        let mut command_rad = [f64::NAN; 4];
        for (place, occupied) in at.iter_mut().enumerate() {
            let Some((flight, state)) = occupied else { continue };
            match formation.seen(place).expect("somebody flies there") {
                Ok(seen) => {
                    flown[*flight].0.push(sight(&seen));
                    let step = flights[*flight].1.step(state, seen.sample());
                    command_rad[place] = step.command_rad;
                }
                Err(outcome) => {
                    flown[*flight].1 = Some(outcome);
                    *occupied = None;
                }
            }
        }
        if at.iter().all(Option::is_none) && waiting.is_empty() {
            return (flown, in_lanes);
        }
        formation.act(&command_rad).expect("far from overflow");
    }
}

fn compare_formation(flights: &[(Prepared, Controller)]) -> usize {
    let (flown, in_lanes) = in_formation(flights);
    for (place, (found, (prepared, controller))) in flown.iter().zip(flights).enumerate() {
        let expected = alone(prepared, controller).expect("far from overflow");
        assert_eq!(found, &expected, "flight {place}");
    }
    in_lanes
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 40,
        rng_seed: RngSeed::Fixed(17),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn a_flight_that_is_answered_from_outside_has_the_bits_of_one_that_is_not(
        structure in structure(), seed in any::<u64>(),
    ) {
        let flights = flights(structure, seed, 4);
        for ((prepared, controller), expected) in flights.iter().zip(singly(&flights)) {
            let (mut rows, outcome) = answered(prepared, controller);
            if outcome.is_err() {
                rows.pop();
                rows.push(*expected.0.last().expect("a sample"));
            }
            prop_assert_eq!((rows, outcome), expected);
        }
    }

    #[test]
    fn flights_in_formation_that_begin_one_after_the_other_have_the_bits_of_single_flights(
        structure in structure(), seed in any::<u64>(),
    ) {
        let flights = flights(structure, seed, 10);
        prop_assert_eq!(compare_formation(&flights), 10);
    }
}

/// The same flight with a part that no lane has.
fn without_lanes(change: impl FnOnce(&mut Scenario)) -> (Prepared, Controller) {
    let plant = LinearPlant::new(
        &[11.7304, 22.578],
        &[1.0, 4.9676, 12.941, 0.1],
        ElevatorSign::NoseUpPositive,
    );
    let timing = Timing::new(0.02, 3.0).expect("allowed");
    let setpoint = Profile::new(0.1, Shape::Step { at_s: 0.3 }).expect("allowed");
    let mut scenario = Scenario::new("no lane", plant.expect("proper"), timing, setpoint);
    scenario.actuator =
        Actuator::first_order(0.1).expect("allowed").with_delay(2).expect("allowed");
    change(&mut scenario);
    let gains = Gains { kp: 0.5, ki: 0.2, kd: 0.1 };
    let pid = Pid::new(gains, PidConfig::sampled_every(0.02)).expect("allowed");
    (scenario.prepare().expect("flies"), Controller::Fixed(pid))
}

#[test]
fn what_has_no_lane_flies_alone_beside_those_that_have_one() {
    let mems = SensorPreset::from_name("mems").expect("known");
    let sensor = Sensor::new(mems.pitch, 3, PITCH).expect("allowed");
    let lag = Lag::second_order(20.0, 0.7).expect("allowed");
    let mut all = flights(PLAIN, 5, 3);
    all.push(without_lanes(|scenario| scenario.surroundings.pitch_sensor = Some(sensor)));
    all.push(without_lanes(|scenario| {
        scenario.actuator = Actuator::new(lag).with_rate_limit(0.2).expect("allowed");
    }));
    // Of another order than the first.
    all.push(without_lanes(|_| ()));
    all.extend(flights(WILD, 6, 5));
    assert_eq!(compare_formation(&all), 8);
}

#[test]
fn who_has_ended_waits_for_nothing() {
    let (prepared, controller) = without_lanes(|_| ());
    let mut flight = InFlight::start(&prepared).expect("starts");
    assert_eq!(flight.prepared().timing().rows(), 151);
    let mut state = State::new();
    for _ in 0..151 {
        let seen = flight.seen().expect("it waits");
        assert!(flight.act(controller.step(&mut state, seen.sample())).expect("flies").is_some());
    }
    assert_eq!(flight.seen(), Err(Outcome::Completed));
    assert_eq!(flight.act(command(0.0)), Ok(None));
    let mut formation = Formation::<2>::default();
    assert_eq!(formation.seen(0), None);
    assert!(formation.start(2, Arc::new(prepared)).is_err());
    assert_eq!(formation.act(&[f64::NAN; 2]), Ok(()));
}
