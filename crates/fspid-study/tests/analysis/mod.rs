//! Margins of scenarios: handbook values, loops that must not be called good, and the answer's shape.

mod ages;
mod answers;
mod handbook;
mod self_tuning;

use fspid_scenario::file::{self, Study};
use fspid_study::analysis::{Analysis, BreakPoint, Margins, Question};
use fspid_study::metrics::Absent;

/// The paper's 747 with its servo under proportional control.
const LOOP: &str = r#"
schema = 1
name = "handbook"
[plant]
preset = "b747-paper"
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.05
duration_s = 5.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
[[controller]]
name = "C"
kind = "p"
kp = 2.0
"#;

/// A scenario with changes, as `--set` has them.
fn study(text: &str, set: &[&str]) -> Study {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    file::parse(text, "test.toml", None, &set).unwrap_or_else(|problems| panic!("{problems}"))
}

fn analysed_at(text: &str, set: &[&str], point: BreakPoint) -> Analysis {
    let question = Question { point, ..Question::default() };
    Analysis::of(&study(text, set), question).expect("a loop")
}

fn analysed(text: &str, set: &[&str]) -> Analysis {
    analysed_at(text, set, BreakPoint::Command)
}

/// Margins of the first controller.
fn margins(text: &str, set: &[&str]) -> Result<Margins, Absent> {
    analysed(text, set).loops.first().expect("a controller").margins()
}
