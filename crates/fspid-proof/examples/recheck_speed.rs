//! How long it takes to check a Lyapunov matrix for thousands of gains of the paper's 747.
//!
//! `cargo run --release -p fspid-proof --example recheck_speed [checks]`
//!
//! The loop has nine states: plant, servo, a command that is two samples late, integral, last sample.

#![allow(clippy::print_stdout, reason = "an example shows something")]
#![allow(clippy::disallowed_types, reason = "the time it took is what is asked here")]

use std::time::Instant;

use fspid_core::{Gains, PidConfig};
use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_proof::check::{ActuatorLag, IntervalMatrix, PrintedPlant, decreases};
use fspid_sim::ElevatorSign;
use fspid_sim::loop_model::{Followers, LoopModel, LoopSettings, Memory, Sensing};

const DT_S: f64 = 0.02;
/// Gains in the middle, and how far the checked ones are away from them, as a part.
const GAINS: Gains<f64> = Gains { kp: 2.0, ki: 0.5, kd: 1.0 };
const SPREAD: f64 = 1e-5;
/// Decay that is asked for, a sample.
const RATE: f64 = 0.999_999;

fn main() {
    let checks: u32 = std::env::args().nth(1).map_or(5000, |word| word.parse().expect("a number"));
    let begin = Instant::now();
    let plant = PrintedPlant {
        numerator: &[-1.69144, -0.84341, -0.0099096],
        denominator: &[1.0, 1.17103, 1.55405, 0.012538, 0.0072771],
        elevator_sign: ElevatorSign::NoseDownPositive,
        lag: ActuatorLag::First { time_constant_s: 0.1 },
        dt_s: DT_S,
    };
    let sampled = plant.sampled().expect("a plant");
    println!("plant enclosed in {:.1?}", begin.elapsed());

    let config = PidConfig::sampled_every(DT_S);
    let settings = LoopSettings {
        config,
        followers: Followers::NONE,
        memory: Memory::of_gains(GAINS, &config),
        delay_samples: 2,
        pitch: Sensing::DIRECT,
        rate: Sensing::DIRECT,
    };
    let model = LoopModel::new(sampled, settings);
    let begin = Instant::now();
    let loops: Vec<IntervalMatrix> = (0..checks).map(|k| closed(&model, k)).collect();
    let size = model.size();
    println!("{checks} loops of {size} states in {:.1?}", begin.elapsed());
    println!("largest radius of an entry {:.2e}", loops[0].max_radius());

    let p = lyapunov(&loops[0].midpoint());
    let begin = Instant::now();
    let proved = loops.iter().filter(|matrix| decreases(&p, RATE, matrix, None).is_ok()).count();
    let took = begin.elapsed();
    println!("{proved} of {checks} proved in {took:.1?}, {:.1?} each", took / checks);
}

/// The enclosed loop of one of many gains around the middle.
fn closed(model: &LoopModel<Interval>, k: u32) -> IntervalMatrix {
    let part = |every: u32| 1.0 + SPREAD * f64::from(k % every) / f64::from(every);
    let gain = |value: f64, every: u32| Interval::point(value * part(every));
    let gains = Gains { kp: gain(GAINS.kp, 17), ki: gain(GAINS.ki, 23), kd: gain(GAINS.kd, 29) };
    IntervalMatrix::from_rows(&model.closed(gains)).expect("square")
}

/// $\sum_k (M^T)^k M^k$, by doubling.
fn lyapunov(m: &Matrix) -> Matrix {
    let (mut sum, mut power) = (Matrix::identity(m.rows()), m.clone());
    for _ in 0..16 {
        let after = power.transpose().product(&sum).and_then(|left| left.product(&power));
        sum = after.and_then(|after| after.sum(&sum)).expect("square");
        power = power.product(&power).expect("square");
    }
    let twice = sum.sum(&sum.transpose()).expect("square");
    twice.scaled(0.5)
}
