//! A program in Rust that asks the exported constant for the answers to vectors.

use fspid_numeric::Real;

use super::{Page, put};
use crate::compose::Angles;
use crate::program::Precision;
use crate::vectors::Vector;
use crate::write::Heading;
use fspid_core::Controller;

/// The program; it prints `N samples, M different` and fails unless M is 0 and `fspid-core` builds the same design
/// of its settings.
#[must_use]
pub fn rust_harness<R: Real>(
    controller: &Controller<R>,
    prefix: &str,
    heading: &Heading<'_>,
    vectors: &[Vector<R>],
) -> String {
    let is_single = heading.precision == Precision::Single;
    let (real, bits) = if is_single { ("f32", "u32") } else { ("f64", "u64") };
    let kind = match controller {
        Controller::Fixed(_) => "Fixed",
        Controller::SelfTuning(_) => "SelfTuning",
    };
    let text = match heading.angles {
        None | Some(Angles::Radians) => PROGRAM
            .replace("SAMPLE", "fspid_core::Sample { setpoint_rad, measurement_rad, rate_rad_s }")
            .replace("COMMAND", "command_rad")
            .replace("ANGLE", "rad")
            .replace("RATE", "rad_s"),
        Some(Angles::Degrees) => PROGRAM
            .replace(
                "SAMPLE",
                &format!(
                    "{prefix}::SampleInDegrees {{ setpoint_deg, measurement_deg, rate_deg_s }}"
                ),
            )
            .replace("COMMAND", "command_deg")
            .replace("ANGLE", "deg")
            .replace("RATE", "deg_s"),
    };
    let mut page = Page::default();
    let program = text.replace("PREFIX", prefix).replace("KIND", kind);
    page.text = program.replace("REAL", real).replace("BITS", bits);
    page.line("");
    page.line(&format!("static VECTORS: [([{bits}; 7], [u8; 2]); {}] = [", vectors.len()));
    page.inside(|page| {
        for Vector { sample, answer, marks, .. } in vectors {
            let values = sample.iter().chain(answer).map(|value| value.to_f64());
            page.row(["([", "]),"], |text| {
                put::list(text, ", ", values, |text, value| put::bits(text, value, is_single));
                text.push_str("], [");
                put::list(text, ", ", marks, |text, mark| put::byte(text, *mark));
            });
        }
    });
    page.line("];");
    page.text
}

const PROGRAM: &str = "\
//! Asks the design for the answers to vectors and counts those with other bits.

mod PREFIX;

use fspid_core::{Controller, State};

fn main() {
    let design = Controller::KIND(PREFIX::DESIGN);
    // Every setting checked and everything that follows from it derived again.
    assert_eq!(design.rounded::<REAL>(), Ok(design), \"the design's numbers contradict its settings\");
    let mut state = State::new();
    let mut different = 0;
    for (k, (bits, marks)) in VECTORS.iter().enumerate() {
        let [setpoint_ANGLE, measurement_ANGLE, rate_RATE, expected @ ..] = bits.map(REAL::from_bits);
        let sample = SAMPLE;
        let answer = PREFIX::step(&mut state, sample);
        let gains = answer.gains;
        let answered = [answer.COMMAND, gains.kp, gains.ki, gains.kd];
        let same = answered.map(REAL::to_bits) == expected.map(REAL::to_bits)
            && [u8::from(answer.saturated), answer.faults.bits()] == *marks;
        if !same {
            if different == 0 {
                println!(\"first at sample {k}\");
            }
            different += 1;
        }
    }
    println!(\"{} samples, {different} different\", VECTORS.len());
    std::process::exit(i32::from(different != 0));
}
";
