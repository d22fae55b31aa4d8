//! How long the margins of one sampled loop take, by order.
//!
//! `cargo bench -p fspid-lti` prints the best of several rounds (others may use the machine), with a checksum that
//! holds the compiler to doing the work.

#![allow(
    clippy::disallowed_types,
    clippy::print_stdout,
    reason = "a benchmark reads the clock and prints"
)]

use std::hint::black_box;
use std::time::Instant;

use fspid_lti::{LtiError, Matrix, SampledLoop, Stability, TransferFunction, zero_order_hold};

const ROUNDS: usize = 15;
/// Sample period, s.
const DT_S: f64 = 0.02;

fn main() -> Result<(), LtiError> {
    for (delay_samples, repeats) in [(0, 200), (1, 200), (4, 100), (20, 10)] {
        let open = b747(delay_samples)?;
        let order = open.order();
        report(&format!("order {order}, margins"), repeats, || margins(&open));
        report(&format!("order {order}, disk margin"), repeats, || {
            open.disk_margin(0.0).map_or(f64::NAN, |disk| disk.size)
        });
        report(&format!("order {order}, closed poles"), repeats, || {
            open.closed_poles().map_or(f64::NAN, |poles| poles[0].re)
        });
        report(&format!("order {order}, one frequency"), 1000 * repeats, || {
            open.at(black_box(1.5)).re
        });
    }
    Ok(())
}

/// The paper's 747 with its servo, PID control with a filtered derivative, and a delay of whole samples.
fn b747(delay_samples: usize) -> Result<SampledLoop, LtiError> {
    let plant = TransferFunction::new(
        &[1.69144, 0.84341, 0.0099096],
        &[1.0, 1.17103, 1.55405, 0.012538, 0.0072771],
    )?;
    let servo = TransferFunction::new(&[10.0], &[1.0, 10.0])?;
    let pid = TransferFunction::new(&[0.0665 + 1.22, 1.33 + 0.0715, 1.43], &[0.05, 1.0, 0.0])?;
    let gain = TransferFunction::new(&[0.02], &[1.0])?;
    let model = plant.series(&servo)?.series(&pid)?.series(&gain)?.to_state_space();
    let (held, input) = zero_order_hold(model.a(), model.b(), DT_S)?;
    let (states, order) = (model.states(), model.states() + delay_samples);
    let mut a = Matrix::zeros(order, order);
    let (mut b, mut c) = (vec![0.0; order], vec![0.0; order]);
    for (row, value) in c.iter_mut().enumerate().take(states) {
        *value = model.c().get(0, row).unwrap_or(0.0);
        for column in 0..states {
            a.set(row, column, held.get(row, column).unwrap_or(0.0))?;
        }
        let entry = input.get(row, 0).unwrap_or(0.0);
        if delay_samples == 0 { b[row] = entry } else { a.set(row, states, entry)? }
    }
    for row in states + 1..order {
        a.set(row - 1, row, 1.0)?;
    }
    if delay_samples > 0 {
        b[order - 1] = 1.0;
    }
    SampledLoop::new(a, b, c, DT_S)
}

fn margins(open: &SampledLoop) -> f64 {
    match open.margins() {
        Ok(Stability::Stable(margins)) => margins.disk.size + margins.sensitivity_peak.value,
        _ => f64::NAN,
    }
}

/// Times `work` and prints the best round in microseconds for one.
fn report(what: &str, repeats: usize, work: impl Fn() -> f64) {
    let mut best = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        for _ in 0..repeats {
            black_box(work());
        }
        best = best.min(start.elapsed().as_secs_f64() * 1e6 / repeats as f64);
    }
    println!("{what}: {best:.3} µs, checksum {:?}", work());
}
