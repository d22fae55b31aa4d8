//! Work of which `checks/instructions/check.py` has valgrind count the instructions: `instructions step-fspid`.
//!
//! Each kind is a function of its own, called `counted_…`, in which alone is counted; what has to be built first stands outside.

#![allow(clippy::print_stdout, reason = "an example shows something")]

use std::hint::black_box;

use fspid_certify::check_text;
use fspid_core::fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_core::{AntiWindup, ControllerSetting, Fspid, Gains, InputScale, Limits};
use fspid_core::{Pid, PidConfig, Sample, SelfTuner, State, TunerSettings, paper};
use fspid_scenario::file;
use fspid_study::analysis::{Analysis, Question};
use fspid_study::simulation::Simulation;

const NOMINAL: Gains<f64> = Gains { kp: 2.0, ki: 0.5, kd: 1.0 };
const DT_S: f64 = 0.01;
/// How often what takes few instructions is done.
const TIMES: u32 = 2000;

fn main() {
    let asked = std::env::args().nth(1).unwrap_or_default();
    let answer = match asked.as_str() {
        "step-fspid" => counted_step_fspid(&fspid()),
        "step-pid" => counted_step_pid(&pid()),
        "inference" => counted_inference(&supervisor()),
        "flight" => counted_flight(&study()),
        "margins" => counted_margins(&study()),
        "certificate" => {
            counted_certificate(fspid_data_text("data/designs/navion-paper.certificate.json"))
        }
        _ => panic!("one of step-fspid, step-pid, inference, flight, margins, certificate"),
    };
    // So that nothing of it is left out, and the same work is seen to be the same.
    println!("{asked}: {answer:e}");
}

/// A shipped file, read before anything is counted.
fn fspid_data_text(path: &str) -> String {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    std::fs::read_to_string(root.join(path)).expect("a shipped file")
}

fn study() -> file::Study {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    file::load(&root.join("scenarios/747-pitch-step.toml"), &[]).expect("a shipped scenario")
}

fn supervisor() -> Supervisor<f64> {
    Supervisor::new(&paper::rules().mirrored(), 5.0, Defuzzifier::Exact, OutOfRange::Clamp)
        .expect("the paper's rules")
}

fn config() -> PidConfig<f64> {
    let limits = Limits::new(ControllerSetting::OutputLimits, -0.35, 0.35).expect("limits");
    let anti_windup = AntiWindup::Conditional;
    PidConfig { limits: Some(limits), anti_windup, ..PidConfig::sampled_every(DT_S) }
}

fn fspid() -> Fspid<f64> {
    let settings = TunerSettings {
        input_scale: InputScale { error_per_rad: 60.0, change_per_rad: 12.0 },
        output_scale: Gains { kp: 0.05, ki: 0.01, kd: 0.01 },
        ..TunerSettings::literal()
    };
    let tuner = SelfTuner::new(NOMINAL, supervisor(), settings).expect("a tuner");
    Fspid::new(tuner, config()).expect("a controller")
}

fn pid() -> Pid<f64> {
    Pid::new(NOMINAL, config()).expect("a controller")
}

/// A sample whose error goes through every set of the supervisor.
fn sample(k: u32) -> Sample<f64> {
    let phase = f64::from(k % 400) / 200.0 - 1.0;
    Sample { setpoint_rad: 0.05, measurement_rad: 0.05 - 0.1 * phase, rate_rad_s: 0.1 * phase }
}

#[inline(never)]
fn counted_step_fspid(controller: &Fspid<f64>) -> f64 {
    let mut state = State::default();
    (0..TIMES).map(|k| controller.step(&mut state, black_box(sample(k))).command_rad).sum()
}

#[inline(never)]
fn counted_step_pid(controller: &Pid<f64>) -> f64 {
    let mut state = State::default();
    (0..TIMES).map(|k| controller.step(&mut state, black_box(sample(k))).command_rad).sum()
}

#[inline(never)]
fn counted_inference(supervisor: &Supervisor<f64>) -> f64 {
    let one = |k: u32| {
        let error = f64::from(k % 101) / 10.0 - 5.0;
        let change = f64::from(k % 97) / 10.0 - 4.8;
        supervisor.infer(black_box(error), black_box(change)).map_or(0.0, |found| found.delta.kp)
    };
    (0..TIMES).map(one).sum()
}

#[inline(never)]
fn counted_flight(study: &file::Study) -> f64 {
    let simulation = Simulation::of(study).expect("it flies");
    f64::from(u8::from(simulation.requirements_met()))
}

#[inline(never)]
fn counted_margins(study: &file::Study) -> f64 {
    let question = Question { map_points: 0, ..Question::default() };
    let analysis = Analysis::of(study, question).expect("it is analysed");
    f64::from(u8::from(analysis.all_held()))
}

#[inline(never)]
fn counted_certificate(text: String) -> f64 {
    let checked = check_text(&text).expect("a certificate");
    f64::from(u8::from(checked.holds()))
}
