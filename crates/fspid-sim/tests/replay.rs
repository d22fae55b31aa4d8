//! A flight replayed with its own gains or inputs is that flight; gains that stand still are a PID.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use std::ops::ControlFlow;

use fspid_core::{Fspid, Gains, Pid};
use fspid_sim::replay::{Replay, fly_replayed, fly_watching_inputs};
use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
use fspid_sim::{
    Actuator, Controller, ElevatorSign, Instant, LinearPlant, Outcome, Prepared, Scenario,
    SimError, Timing, fly,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

type Flown = (Vec<Instant>, Outcome);

fn flown(
    fly: impl FnOnce(&mut dyn FnMut(Instant) -> ControlFlow<()>) -> Result<Outcome, SimError>,
) -> Flown {
    let mut instants = Vec::new();
    let outcome = fly(&mut |instant| {
        instants.push(instant);
        ControlFlow::Continue(())
    });
    (instants, outcome.expect("it can be flown"))
}

/// The paper's Navion with the servo of 0.1 s and its limits, delay, a load and a step; sampled as the controller is.
fn prepared(controller: &Fspid<f64>) -> Prepared {
    let (numerator, denominator) = ([11.7304, 22.578], [1.0, 4.9676, 12.941, 0.1]);
    let sign = ElevatorSign::NoseUpPositive;
    let plant = LinearPlant::new(&numerator, &denominator, sign).expect("a plant");
    let dt_s = controller.config().dt_s;
    let timing = Timing::new(dt_s, 400.0 * dt_s).expect("a timing");
    let step = Profile::new(0.1, Shape::Step { at_s: 20.0 * dt_s }).expect("a step");
    let servo = Actuator::first_order(0.1).and_then(|it| it.with_delay(1)).expect("a servo");
    let shape = Shape::Step { at_s: 200.0 * dt_s };
    Scenario {
        actuator: servo,
        disturbances: vec![Disturbance::new(Entry::Servo, 0.02, shape).expect("a load")],
        ..Scenario::new("replayed", plant, timing, step)
    }
    .prepare()
    .expect("it can be flown")
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, rng_seed: RngSeed::Fixed(20), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_flight_with_its_own_gains_or_inputs_is_that_flight_bit_by_bit(
        controller in fspid_options::any_controller(),
    ) {
        let Controller::SelfTuning(fspid) = controller else { return Ok(()) };
        let prepared = prepared(&fspid);
        let as_it_is = flown(|observer| fly(&prepared, &controller, observer));
        let mut inputs = Vec::new();
        let watched = flown(|observer| {
            fly_watching_inputs(&prepared, &fspid, |instant, seen| {
                inputs.push(seen);
                observer(instant)
            })
        });
        prop_assert_eq!(&as_it_is, &watched);
        let by_inputs =
            flown(|observer| fly_replayed(&prepared, &fspid, Replay::Inputs(&inputs), observer));
        prop_assert_eq!(&as_it_is, &by_inputs);
        // Faults of the supervisor are not those of gains that somebody else has.
        let gains: Vec<Gains<f64>> = as_it_is.0.iter().map(|it| it.step.gains).collect();
        let (instants, outcome) =
            flown(|observer| fly_replayed(&prepared, &fspid, Replay::Gains(&gains), observer));
        prop_assert_eq!(outcome, as_it_is.1);
        for (instant, own) in instants.iter().zip(&as_it_is.0) {
            let step = fspid_core::Step { faults: own.step.faults, ..instant.step };
            prop_assert_eq!(&Instant { step, ..*instant }, own);
        }
    }

    #[test]
    fn gains_that_stand_still_fly_as_the_pid_that_has_them(
        controller in fspid_options::any_controller(),
        factors in prop::array::uniform3(0.5_f64..1.5),
    ) {
        let Controller::SelfTuning(fspid) = controller else { return Ok(()) };
        let prepared = prepared(&fspid);
        let nominal = fspid.tuner().nominal();
        let moved = Gains {
            kp: nominal.kp * factors[0], ki: nominal.ki * factors[1], kd: nominal.kd * factors[2],
        };
        for gains in [nominal, moved] {
            let pid = Pid::new(gains, fspid.config_at(gains)).expect("a controller");
            let fixed = Controller::Fixed(pid);
            let expected = flown(|observer| fly(&prepared, &fixed, observer));
            let still = flown(|observer| fly_replayed(&prepared, &fspid, Replay::Gains(&[gains]), observer));
            // A self-tuner that sees the pitch rate holds a sample whose rate is bad; nothing else differs.
            prop_assert_eq!(expected, still);
        }
    }
}

#[test]
fn nothing_to_replay_is_the_flight_as_it_is() {
    let text = "any controller that tunes itself";
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let fspid = loop {
        let tree = fspid_options::any_controller().new_tree(&mut runner).expect(text);
        if let Controller::SelfTuning(fspid) = proptest::strategy::ValueTree::current(&tree) {
            break fspid;
        }
    };
    let prepared = prepared(&fspid);
    let as_it_is = flown(|observer| fly(&prepared, &Controller::SelfTuning(fspid), observer));
    for replay in [Replay::Gains(&[]), Replay::Inputs(&[])] {
        assert_eq!(flown(|observer| fly_replayed(&prepared, &fspid, replay, observer)), as_it_is);
    }
}
