//! How fast one core trims, linearises and flies.
//!
//! `cargo bench -p fspid-aircraft` prints the best of several rounds (others may use the machine), with a checksum
//! that holds the compiler to doing the work and shows that every round did the same.

#![allow(
    clippy::disallowed_types,
    clippy::print_stdout,
    reason = "a benchmark reads the clock and prints"
)]

use std::hint::black_box;
use std::num::NonZeroUsize;
use std::time::Instant;

use fspid_aircraft::aerodynamics::derivatives::DerivativeModel;
use fspid_aircraft::data::Laws;
use fspid_aircraft::envelope::{EnvelopeGrid, Evenly};
use fspid_aircraft::qualities::CommandPath;
use fspid_aircraft::{AirMotion, Aircraft, Environment, TrimTarget, Vector3};
use fspid_lti::{FrequencyResponse, TransferFunction};

#[path = "../tests/support/mod.rs"]
mod support;

const ROUNDS: usize = 9;

/// One minute at 100 Hz.
const SAMPLES: usize = 6000;

fn main() {
    let data = support::derivative_data("b747-cruise-low");
    let aircraft = data.aircraft(Laws::default(), Environment::STANDARD).expect("an aircraft");
    let target = TrimTarget {
        airspeed_m_s: 0.95 * data.reference.airspeed_m_s,
        altitude_m: data.reference.altitude_m,
        flight_path_rad: 0.0,
    };
    report("trim and linearisation", 2.0, || trim_and_linearise(&aircraft, target));
    report("60 s at 100 Hz with gusts", 60.0, || fly(&aircraft, target));
    report("envelope of 600 points on 2 threads", 3000.0, || map(&aircraft));
}

/// Times some work and prints the best round in milliseconds.
fn report(what: &str, allowed_ms: f64, work: impl Fn() -> f64) {
    let checksum = work();
    let mut best_ms = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        let again = black_box(work());
        best_ms = best_ms.min(start.elapsed().as_secs_f64() * 1e3);
        assert_eq!(again.to_bits(), checksum.to_bits(), "a round gave another answer");
    }
    println!("{what}: {best_ms:.3} ms (allowed: {allowed_ms}), checksum {checksum:?}");
}

fn trim_and_linearise(aircraft: &Aircraft<DerivativeModel>, target: TrimTarget) -> f64 {
    let trim = aircraft.trim(black_box(target)).expect("a flight that can be held");
    let plant = aircraft.linearise(&trim).theta_over_elevator().expect("a plant");
    plant.dc_gain().expect("no integrator")
}

/// Trim, linear model, modes, qualities and a gain margin at 30 airspeeds and 20 altitudes.
fn map(aircraft: &Aircraft<DerivativeModel>) -> f64 {
    let servo = TransferFunction::new(&[10.0], &[1.0, 10.0]).expect("a servo");
    let path = CommandPath { servo: Some(servo.clone()), delay_s: 0.05 };
    let grid = EnvelopeGrid {
        path,
        ..EnvelopeGrid::even(
            Evenly { first: 100.0, last: 290.0, count: 30 },
            Evenly { first: 0.0, last: 12_000.0, count: 20 },
        )
    };
    let threads = NonZeroUsize::new(2).expect("two");
    let rows = aircraft.envelope(black_box(&grid), threads, |linear| {
        let plant = linear.theta_over_elevator().expect("a plant").negated();
        let open = plant.series(&servo).expect("small");
        FrequencyResponse::new(open, 0.05).expect("roots").margins().expect("a loop").gain_margin()
    });
    let flights = rows.iter().filter_map(|row| row.flight.as_ref().ok());
    flights.map(|flight| flight.beside.unwrap_or(0.0)).sum()
}

/// A flight through gusts that change at each sample; their filters are not part of this crate.
fn fly(aircraft: &Aircraft<DerivativeModel>, target: TrimTarget) -> f64 {
    let trim = aircraft.trim(target).expect("a flight that can be held");
    let state = (0..SAMPLES).fold(trim.state, |state, index| {
        let phase = 0.01 * index as f64;
        let gust =
            0.5 * Vector3::new(libm::sin(phase), libm::sin(1.7 * phase), libm::cos(2.3 * phase));
        let motion = AirMotion {
            wind_ned_m_s: Vector3::new(10.0, -5.0, 0.0),
            gust_body_m_s: gust,
            gust_rates_rad_s: 0.01 * gust,
        };
        aircraft.step(&state, black_box(&trim.controls), &motion, 0.01)
    });
    state.altitude_m()
}
