//! A controller on a line: the protocol, and the same bits as in a simulation.

use std::fmt::Write as _;
use std::io;

use fspid_scenario::file::{self, Study};
use fspid_study::fly::{Angles, Pilot, fly};

mod lines;
mod noise;
mod rate;
mod same_bits;
mod stream;

const SCENARIO: &str = r#"
schema = 1
name = "747 pitch step"
[plant]
preset = "b747-paper"
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.01
duration_s = 20.0
[setpoint]
kind = "square"
amplitude_deg = 3.0
half_period_s = 4.0
[[controller]]
name = "P"
kind = "p"
kp = 3.5287
rate_gain = 0.9144
[[controller]]
name = "PID"
kind = "pid"
kp = 2.0
ki = 0.5
kd = 1.0
derivative_filter_s = 0.03
slew_limit_deg_s = 60.0
output_limits_deg = [-20.0, 20.0]
anti_windup = { kind = "back-calculation", tracking_s = 1.0 }
[[controller]]
name = "FSPID"
kind = "fspid"
nominal = { kp = 2.0, ki = 0.5, kd = 1.0 }
rate_gain = 0.3
supervisor = { table = "printed", range = 5.0, error_scale = 1.0, change_scale = 0.2, output_scale = { kp = 0.2, ki = 0.05, kd = 0.1 } }
law = "accumulating"
"#;

fn study() -> Study {
    file::parse(SCENARIO, "scenario.toml", None, &[]).expect("a good scenario")
}

fn pilot(name: &str, angles: Angles) -> Pilot {
    Pilot::new(&study().scenario, Some(name), angles).expect("one of the three")
}

/// Everything that is answered and told.
fn said(pilot: &mut Pilot, input: &[u8]) -> (String, String) {
    let (mut output, mut told) = (Vec::new(), String::new());
    let mut reader = io::BufReader::with_capacity(7, input);
    fly(pilot, &mut reader, &mut output, |note| {
        let _ = writeln!(told, "{note}");
    })
    .expect("memory can be read and written");
    (String::from_utf8(output).expect("UTF-8"), told)
}

fn numbers(answers: &str) -> Vec<f64> {
    answers.lines().map(|line| line.parse().expect("a number")).collect()
}
