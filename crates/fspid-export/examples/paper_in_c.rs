//! Writes the paper's controller in C: `cargo run -p fspid-export --example paper_in_c -- FOLDER`.

use std::error::Error;

use fspid_core::fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_core::{
    AntiWindup, Controller, Fspid, Gains, Limits, PidConfig, SelfTuner, TunerSettings, paper,
};
use fspid_export::vectors::vectors;
use fspid_export::write::{c, c_harness};
use fspid_export::{Angles, program};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("the folder to write to is missing")?;
    std::fs::create_dir_all(&folder)?;
    let supervisor =
        Supervisor::new(&paper::rules(), 5.0_f32, Defuzzifier::Exact, OutOfRange::Clamp)?;
    let nominal = Gains { kp: 1.0, ki: 0.5, kd: 0.2 };
    let config = PidConfig {
        limits: Some(Limits::new("output limits", -0.3, 0.3)?),
        slew_rad_s: Some(1.0),
        anti_windup: AntiWindup::Conditional,
        ..PidConfig::sampled_every(0.01)
    };
    let tuner = SelfTuner::new(nominal, supervisor, TunerSettings::literal())?;
    let controller = Controller::SelfTuning(Fspid::new(tuner, config)?);
    let program = program(&controller, Angles::Radians)?;
    let files = c(&program, "pitch");
    let vectors = vectors(&controller, Angles::Radians, 1, 2000);
    for (name, text) in [
        ("pitch.h", files.header),
        ("pitch.c", files.source),
        ("main.c", c_harness(&program, "pitch", &vectors)),
    ] {
        std::fs::write(format!("{folder}/{name}"), text)?;
    }
    Ok(())
}
