//! How fast one core is: closed-loop steps per second. Inferences alone are measured in `fspid-fuzzy`.
//!
//! `cargo bench` prints the best rate over blocks of work so short that some are not interrupted by
//! whoever else uses the machine, with a checksum that holds the compiler to doing the work and shows
//! that every round did the same, and that flights side by side did what single ones do. Behind `--` it
//! takes words of which what is measured shall have one.

#![allow(
    clippy::disallowed_types,
    clippy::print_stdout,
    reason = "a benchmark reads the clock and prints"
)]

use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

use fspid_core::fuzzy::{Defuzzifier, Label, NumberTable, OutOfRange, RuleTable, Supervisor};
use fspid_core::{
    AntiWindup, ControllerSetting, Derivative, Fspid, Gains, InputScale, Limits, Pid, PidConfig,
    SelfTuner, TunerSettings,
};
use fspid_sim::batch::{BatchRow, Entrant, InstructionSet, fly_group_by};
use fspid_sim::gradient::{Weights, differentiate, differentiate_by};
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::{
    Actuator, Controller, ElevatorSign, LinearPlant, NamedController, Prepared, Scenario,
    Surroundings, Timing, fly,
};

/// Flights: ten groups of the widest.
const FLIGHTS: usize = 160;
/// Samples of a flight; a million in all.
const SAMPLES: usize = 6_250;
const ROUNDS: usize = 7;

fn main() {
    let scenarios: Vec<Scenario> = (1..).take(FLIGHTS).map(scenario).collect();
    let prepared: Vec<Prepared> =
        scenarios.iter().map(|it| it.prepare().expect("a scenario that flies")).collect();
    for (place, named) in scenarios[0].controllers.iter().enumerate() {
        let controller = black_box(named.controller);
        let name = &named.name;
        let single = report(&format!("{name}, one by one"), 7.0, 1, |first| {
            vec![single_sum(&prepared[first], &controller)]
        });
        let entrants: Vec<Entrant<'_>> = prepared
            .iter()
            .zip(&scenarios)
            .map(|(prepared, it)| Entrant {
                prepared,
                controller: &it.controllers[place].controller,
            })
            .collect();
        for set in InstructionSet::available() {
            batched::<8>(name, set, &entrants, single);
            batched::<16>(name, set, &entrants, single);
        }
        let [first, ..] = entrants.as_slice() else { continue };
        // Rules that conclude labels have no numbers to learn.
        if differentiate::<1>(&[*first], &[WEIGHTS]).is_ok() {
            for set in InstructionSet::available() {
                differentiated::<8>(name, set, &entrants);
                differentiated::<16>(name, set, &entrants);
            }
        }
    }
}

fn batched<const W: usize>(
    name: &str,
    set: InstructionSet,
    flights: &[Entrant<'_>],
    single: Option<f64>,
) {
    let what = format!("{name}, {W} lanes, {set}");
    let sum = report(&what, 25.0, W, |first| group_sums::<W>(set, &flights[first..first + W]));
    if let (Some(sum), Some(single)) = (sum, single) {
        assert_eq!(sum.to_bits(), single.to_bits(), "flights side by side gave another answer");
    }
}

/// What gradients are asked of.
const WEIGHTS: Weights = Weights { iae_rad_s: 1.0, ise_rad2_s: 0.0, travel_rad: 0.05 };

fn differentiated<const W: usize>(name: &str, set: InstructionSet, flights: &[Entrant<'_>]) {
    let what = format!("{name}, gradients, {W} lanes, {set}");
    report(&what, 5.0, W, |first| gradient_sums::<W>(set, &flights[first..first + W]));
}

/// A number of the gradient of each flight with respect to every number of its controller.
fn gradient_sums<const W: usize>(set: InstructionSet, flights: &[Entrant<'_>]) -> Vec<f64> {
    let found = differentiate_by::<W>(set, flights, &[WEIGHTS; W]).expect("differentiable");
    found.iter().map(|it| it.as_ref().map_or(0.0, |it| it.gradient.iter().sum())).collect()
}

fn single_sum(prepared: &Prepared, controller: &Controller) -> f64 {
    let mut sum = 0.0;
    let outcome = fly(prepared, controller, |instant| {
        sum += instant.theta_rad + instant.step.gains.kp;
        ControlFlow::Continue(())
    });
    assert!(outcome.is_ok());
    sum
}

fn group_sums<const W: usize>(set: InstructionSet, flights: &[Entrant<'_>]) -> Vec<f64> {
    let mut sums = [0.0; W];
    let outcomes = fly_group_by::<W>(set, flights, |row: &BatchRow<'_, W>| {
        let [kp, ..] = row.gains;
        for (lane, sum) in sums.iter_mut().enumerate() {
            *sum += row.theta_rad[lane] + kp[lane];
        }
    });
    assert!(outcomes.is_ok());
    sums.to_vec()
}

/// Times `work` over all flights, `at_once` at a time, and prints the best rate of a block in millions
/// of steps per second. Answers the sum over all flights, in their order; none where something else is asked for.
fn report(what: &str, asked: f64, at_once: usize, work: impl Fn(usize) -> Vec<f64>) -> Option<f64> {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|it| !it.starts_with('-')).collect();
    if !wanted.is_empty() && !wanted.iter().any(|it| what.contains(it)) {
        return None;
    }
    let (mut best, mut checksum) = (0.0_f64, None);
    for _ in 0..ROUNDS {
        let mut sum = 0.0;
        for first in (0..FLIGHTS).step_by(at_once) {
            let start = Instant::now();
            let sums = black_box(work(first));
            let steps = (at_once * SAMPLES) as f64;
            best = best.max(steps / start.elapsed().as_secs_f64() / 1e6);
            sum = sums.iter().fold(sum, |sum, more| sum + more);
        }
        let before: f64 = *checksum.get_or_insert(sum);
        assert_eq!(before.to_bits(), sum.to_bits(), "a round gave another answer");
    }
    let checksum = checksum.unwrap_or(0.0);
    println!("{what}: {best:.2} million steps/s (asked: {asked:.0}), checksum {checksum:?}");
    Some(checksum)
}

fn table() -> RuleTable {
    let table = fspid_core::paper::rules();
    assert_eq!(table.grid(fspid_core::fuzzy::Output::DeltaKp).at(Label::NB, Label::NB), Label::PB);
    table
}

fn supervisor() -> Supervisor<f64> {
    Supervisor::new(&table(), 5.0, Defuzzifier::Exact, OutOfRange::Clamp).expect("allowed")
}

/// What the labels answer at the centres of the sets, as numbers.
fn numbers() -> Supervisor<f64> {
    let labels = supervisor();
    let answer = |gain: usize, i: usize, j: usize| {
        let centre = |set: usize| 5.0 * (set as f64 - 3.0) / 3.0;
        let delta = labels.infer(centre(i), centre(j)).expect("within the range").delta;
        [delta.kp, delta.ki, delta.kd][gain]
    };
    let grid = |gain| std::array::from_fn(|i| std::array::from_fn(|j| answer(gain, i, j)));
    let table = NumberTable::new([0, 1, 2].map(grid)).expect("finite");
    Supervisor::of_numbers(&table, 5.0, OutOfRange::Clamp).expect("within the range")
}

/// Noise for a command, so that every sample is another one.
fn scenario(seed: u64) -> Scenario {
    let plant = LinearPlant::new(
        &[-1.69144, -0.84341, -0.009_909_6],
        &[1.0, 1.17103, 1.55405, 0.012_538, 0.007_277_1],
        ElevatorSign::NoseDownPositive,
    );
    let config = PidConfig::sampled_every(0.01);
    let gains = Gains { kp: 2.0, ki: 0.05, kd: 0.5 };
    let settings = TunerSettings {
        input_scale: InputScale { error_per_rad: 1.0, change_per_rad: 0.02 },
        output_scale: Gains { kp: 0.1, ki: 0.001, kd: 0.05 },
        ..TunerSettings::literal()
    };
    let tuned = |supervisor| {
        let tuner = SelfTuner::new(gains, supervisor, settings).expect("allowed");
        Controller::SelfTuning(Fspid::new(tuner, config).expect("allowed"))
    };
    let pid = Pid::new(gains, config).expect("allowed");
    let limited = PidConfig {
        rate_gain_s: 0.2,
        derivative: Derivative { filter_s: 0.05 },
        anti_windup: AntiWindup::BackCalculation { tracking_s: 0.5 },
        limits: Some(Limits::new(ControllerSetting::OutputLimits, -0.4, 0.4).expect("in order")),
        slew_rad_s: Some(20.0),
        ..config
    };
    let limited = Pid::new(gains, limited).expect("allowed");
    let named = |name: &str, controller| NamedController { name: name.to_owned(), controller };
    Scenario {
        name: "throughput".to_owned(),
        plant: plant.expect("the paper's plant").into(),
        plant_changes: Vec::new(),
        actuator: Actuator::first_order(0.1).expect("allowed"),
        timing: Timing::new(0.01, (SAMPLES - 1) as f64 * 0.01).expect("allowed"),
        setpoint: Profile::new(1.0, Shape::Noise { at_s: 0.0, seed }).expect("allowed"),
        disturbances: Vec::new(),
        externals: Vec::new(),
        controllers: vec![
            named("FSPID", tuned(supervisor())),
            named("FSPID by numbers", tuned(numbers())),
            named("PID", Controller::Fixed(pid)),
            named("PID with limits", Controller::Fixed(limited)),
        ],
        surroundings: Surroundings::default(),
        autopilot: None,
    }
}
