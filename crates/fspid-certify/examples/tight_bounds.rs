//! How near the bounds of disturbances of a certificate are to what is reached: of each the share that the worst disturbance
//! comes to with gains that stand still at the corners of what the law reaches, and with gains that move between them as
//! fast as the claim lets them, in the loop's own equations. A share above 1 would refute the bound.
//!
//! Bounds are found first, with the time that this takes, and checked again from their text alone.
//!
//! `cargo run --release -p fspid-certify --example tight_bounds -- SCENARIO CONTROLLER [PATH=VALUE]...`

#![allow(clippy::print_stdout, reason = "it tells what it finds")]

use std::path::Path;
use std::time::Instant;

#[path = "../../fspid-proof/tests/flown_proofs/worst.rs"]
mod worst;

use fspid_certify::{Certification, Effort, check_text, to_text};
use fspid_core::Gains;
use fspid_scenario::file;

/// Motions that are tried.
const MOTIONS: usize = 60;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [path, name, overrides @ ..] = &words[..] else { return Err("which scenario?".into()) };
    let study = file::load(Path::new(path), overrides).map_err(|it| it.to_string())?;
    let effort = Effort::default();
    let begun = Instant::now();
    let proved = Certification::of(&study, Some(name), &effort)?;
    println!("proved or not: {:.1} s", begun.elapsed().as_secs_f64());
    let begun = Instant::now();
    let found = proved.with_disturbances(&study, &effort, &mut |_| {})?;
    println!("bounds: {:.1} s", begun.elapsed().as_secs_f64());
    println!("{}", found.text());
    let one = found.results.first().ok_or("nobody")?;
    let text = to_text(one.certificate().ok_or("no certificate")?, &one.origin);
    let begun = Instant::now();
    let checked = check_text(&text).map_err(|it| it.to_string())?;
    println!("checked: {:.2} s, {} bytes", begun.elapsed().as_secs_f64(), text.len());
    let certificate = &checked.certificate;
    let rechecked = checked.result.as_ref().map_err(ToString::to_string)?;
    let corners = worst::corners(certificate);
    let mut state = 1_u64;
    let mut part = move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let stays = [1, 1, 5, 20, 60, 200];
    let motions = (0..MOTIONS)
        .map(|number| worst::motion(certificate, &corners, stays[number % 6], &mut part));
    let motions: Vec<Vec<Gains<f64>>> = motions.collect();
    let still =
        |[kp, ki, kd]: &[f64; 3]| vec![Gains { kp: *kp, ki: *ki, kd: *kd }; 4 * worst::SAMPLES];
    for bound in &rechecked.disturbed {
        let share = |gains: &Vec<Gains<f64>>| worst::share(certificate, bound, gains);
        let frozen = corners.iter().map(|it| share(&still(it))).fold(0.0, f64::max);
        let moved = motions.iter().map(share).fold(0.0, f64::max);
        println!(
            "{} to {} by {}: {:.4} of it with gains that stand still, {:.4} with gains that move",
            bound.way.name(),
            bound.quantity.name(),
            bound.extent.name(),
            frozen,
            moved
        );
    }
    Ok(())
}
