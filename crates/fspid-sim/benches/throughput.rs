//! How fast one core is: closed-loop steps per second. Inferences alone are measured in `fspid-fuzzy`.
//!
//! `cargo bench` prints the best of several rounds (others may use the machine), with a
//! checksum that holds the compiler to doing the work and shows that every round did the same.

#![allow(
    clippy::disallowed_types,
    clippy::print_stdout,
    reason = "a benchmark reads the clock and prints"
)]

use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

use fspid_core::fuzzy::{Defuzzifier, Label, OutOfRange, RuleTable, Supervisor};
use fspid_core::{Fspid, Gains, InputScale, Pid, SelfTuner, Shell, TunerSettings};
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::{
    Controller, ElevatorSign, LinearPlant, NamedController, Scenario, Servo, Surroundings, Timing,
    fly,
};

const INPUTS: usize = 1_000_000;
const ROUNDS: usize = 7;

fn main() {
    let scenario = scenario();
    let prepared = scenario.prepare().expect("a scenario that flies");
    for named in &scenario.controllers {
        let controller = named.controller;
        report(&format!("closed-loop steps, {}", named.name), 3.0, || {
            let mut sum = 0.0;
            let outcome = fly(&prepared, black_box(&controller), |instant| {
                sum += instant.theta_rad + instant.step.gains.kp;
                ControlFlow::Continue(())
            });
            assert!(outcome.is_ok());
            sum
        });
    }
}

/// Times `work` over [`INPUTS`] items and prints the best round in millions per second.
fn report(what: &str, asked: f64, work: impl Fn() -> f64) {
    let checksum = work();
    let mut best = 0.0_f64;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        let again = black_box(work());
        let rate = INPUTS as f64 / start.elapsed().as_secs_f64() / 1e6;
        assert_eq!(again.to_bits(), checksum.to_bits(), "a round gave another answer");
        best = best.max(rate);
    }
    println!("{what}: {best:.2} million/s (asked: {asked:.0}), checksum {checksum:?}");
}

fn table() -> RuleTable {
    let file = include_str!("../../../data/rule-tables/printed.toml");
    let parts: Vec<&str> = file.split("\"\"\"").collect();
    let table = RuleTable::parse([parts[1], parts[3], parts[5]]).expect("a shipped table");
    assert_eq!(table.grid(fspid_core::fuzzy::Output::DeltaKp).at(Label::NB, Label::NB), Label::PB);
    table
}

fn supervisor() -> Supervisor<f64> {
    Supervisor::new(&table(), 5.0, Defuzzifier::Exact, OutOfRange::Clamp).expect("allowed")
}

/// A million samples of noise for a command, so that every sample is another one.
fn scenario() -> Scenario {
    let plant = LinearPlant::new(
        &[-1.69144, -0.84341, -0.009_909_6],
        &[1.0, 1.17103, 1.55405, 0.012_538, 0.007_277_1],
        ElevatorSign::NoseDownPositive,
    );
    let shell = Shell::sampled_every(0.01);
    let gains = Gains { kp: 2.0, ki: 0.05, kd: 0.5 };
    let settings = TunerSettings {
        input_scale: InputScale { error_per_rad: 1.0, change_per_rad: 0.02 },
        output_scale: Gains { kp: 0.1, ki: 0.001, kd: 0.05 },
        ..TunerSettings::literal()
    };
    let tuner = SelfTuner::new(gains, supervisor(), settings).expect("allowed");
    let fspid = Fspid::new(tuner, shell).expect("allowed");
    let pid = Pid::new(gains, shell).expect("allowed");
    let named = |name: &str, controller| NamedController { name: name.to_owned(), controller };
    Scenario {
        name: "throughput".to_owned(),
        plant: plant.expect("the paper's plant").into(),
        plant_changes: Vec::new(),
        servo: Servo::first_order(0.1).expect("allowed"),
        timing: Timing::new(0.01, (INPUTS - 1) as f64 * 0.01).expect("allowed"),
        setpoint: Profile::new(1.0, Shape::Noise { at_s: 0.0, seed: 1 }).expect("allowed"),
        disturbances: Vec::new(),
        controllers: vec![
            named("FSPID", Controller::SelfTuning(fspid)),
            named("PID", Controller::Fixed(pid)),
        ],
        surroundings: Surroundings::default(),
    }
}
