//! Side by side, a controller with any options answers with the bits of a single one.

use std::ops::ControlFlow;

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::{Entrant, fly_many};
use crate::signal::{Disturbance, Entry, Profile, Shape};
use crate::{
    Actuator, Controller, ElevatorSign, Instant, LinearPlant, Prepared, Scenario, Timing, fly,
};
use fspid_options::{DT_S, controller, structure};

/// The Navion of the paper, whose sensor and set-point are noisy.
fn prepared(seed: u64) -> Prepared {
    let plant = LinearPlant::new(
        &[11.7304, 22.578],
        &[1.0, 4.9676, 12.941, 0.1],
        ElevatorSign::NoseUpPositive,
    );
    let noise = |seed| Shape::Noise { at_s: 0.2, seed };
    let timing = Timing::new(DT_S, 1.0).expect("allowed");
    let setpoint = Profile::new(0.5, noise(seed)).expect("allowed");
    let mut scenario = Scenario::new("options", plant.expect("proper"), timing, setpoint);
    scenario.actuator = Actuator::first_order(0.05).expect("allowed");
    let seen = Disturbance::new(Entry::Measurement, 0.1, noise(seed.wrapping_add(1)));
    scenario.disturbances.push(seen.expect("allowed"));
    scenario.prepare().expect("flies")
}

fn bits(instant: &Instant) -> ([u64; 6], bool, u8) {
    let (step, gains) = (instant.step, instant.step.gains);
    let numbers =
        [instant.theta_rad, instant.measured[0], step.command_rad, gains.kp, gains.ki, gains.kd];
    (numbers.map(f64::to_bits), step.saturated, step.faults.bits())
}

type Bits = Vec<([u64; 6], bool, u8)>;

fn singly(prepared: &Prepared, controller: &Controller) -> Bits {
    let mut rows = Vec::new();
    fly(prepared, controller, |instant| {
        rows.push(bits(&instant));
        ControlFlow::Continue(())
    })
    .expect("flies");
    rows
}

fn side_by_side<const W: usize>(flights: &[(Prepared, Controller)]) -> Vec<Bits> {
    let mut rows = vec![Vec::new(); flights.len()];
    let entrants: Vec<Entrant<'_>> =
        flights.iter().map(|(prepared, controller)| Entrant { prepared, controller }).collect();
    let outcomes = fly_many::<W>(&entrants, |flight, instant| rows[flight].push(bits(instant)));
    assert!(outcomes.is_ok(), "{outcomes:?}");
    rows
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 200,
        rng_seed: RngSeed::Fixed(15),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn every_option_answers_side_by_side_as_it_does_alone(
        (controllers, seed) in structure()
            .prop_flat_map(|one| (prop::collection::vec(controller(one), 5), any::<u64>())),
    ) {
        let flights: Vec<_> =
            (seed >> 8..).map(prepared).zip(controllers).collect();
        let expected: Vec<Bits> =
            flights.iter().map(|(prepared, controller)| singly(prepared, controller)).collect();
        prop_assert_eq!(&side_by_side::<1>(&flights), &expected);
        prop_assert_eq!(&side_by_side::<8>(&flights), &expected);
    }
}
