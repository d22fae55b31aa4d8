//! The trace as columns: angles in degrees, shortest digits that read back as the same number.

use fspid_core::Gains;
use fspid_sim::{Column, Trace};

use super::{ControllerResult, Simulation};
use crate::output::{Names, Place};
use fspid_diagnostics::lines::add;
use fspid_scenario::units::degrees;

/// Columns of one controller.
const COLUMNS: [&str; 7] =
    ["theta_deg", "q_deg_s", "command_deg", "elevator_deg", "kp", "ki", "kd"];

impl Simulation {
    /// All traces side by side: time and set-point once, then each controller's columns, with its
    /// name before them where there are several. Cells after a divergence are empty. Sensors, gusts
    /// and nonlinear aircraft add columns of their own.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::from("time_s,setpoint_deg");
        let several = self.results.len() > 1;
        for (result, name) in self.results.iter().zip(self.column_names().iter()) {
            let prefix = if several { format!("{name}.") } else { String::new() };
            for column in columns(&result.trace) {
                text.push(',');
                text.push_str(&prefix);
                text.push_str(&column);
            }
        }
        text.push('\n');
        let longest = self.results.iter().max_by_key(|result| result.trace.rows());
        for k in 0..longest.map_or(0, |result| result.trace.rows()) {
            if let Some(result) = longest {
                push(&mut text, result.trace.time_s[k]);
                text.push(',');
                push(&mut text, degrees(result.trace.setpoint_rad[k]));
            }
            for result in &self.results {
                push_row(&mut text, result, k);
            }
            text.push('\n');
        }
        text
    }

    /// What the columns of the controllers begin with, where there are several.
    #[must_use]
    pub fn column_names(&self) -> Names {
        Names::of(Place::Column, self.results.iter().map(|result| &result.name))
    }
}

impl ControllerResult {
    /// The flight as columns, each with a name that ends in its unit: time, set-point, and what
    /// [`Simulation::csv`] has of this controller. Angles in degrees.
    #[must_use]
    pub fn columns(&self) -> Vec<(String, Vec<f64>)> {
        let trace = &self.trace;
        let angle = |values: &[f64]| values.iter().map(|value| degrees(*value)).collect::<Vec<_>>();
        let gain = |of: fn(&Gains<f64>) -> f64| trace.gains.iter().map(of).collect();
        let own = [
            angle(&trace.theta_rad),
            angle(&trace.q_rad_s),
            angle(&trace.command_rad),
            angle(&trace.elevator_rad),
            gain(|gains| gains.kp),
            gain(|gains| gains.ki),
            gain(|gains| gains.kd),
        ];
        let more = trace.columns.iter();
        let more = more.map(|it| it.values.iter().map(|value| in_degrees(it, *value)).collect());
        let first = [
            ("time_s".to_owned(), trace.time_s.clone()),
            ("setpoint_deg".to_owned(), angle(&trace.setpoint_rad)),
        ];
        first.into_iter().chain(columns(trace).zip(own.into_iter().chain(more))).collect()
    }
}

fn push_row(text: &mut String, result: &ControllerResult, k: usize) {
    let trace = &result.trace;
    if k >= trace.rows() {
        text.push_str(&",".repeat(COLUMNS.len() + trace.columns.len()));
        return;
    }
    let gains = trace.gains[k];
    let row = [
        degrees(trace.theta_rad[k]),
        degrees(trace.q_rad_s[k]),
        degrees(trace.command_rad[k]),
        degrees(trace.elevator_rad[k]),
        gains.kp,
        gains.ki,
        gains.kd,
    ];
    let more = trace.columns.iter().map(|column| in_degrees(column, column.values[k]));
    for value in row.into_iter().chain(more) {
        text.push(',');
        push(text, value);
    }
}

/// Names of the columns of a trace, angles in degrees.
fn columns(trace: &Trace) -> impl Iterator<Item = String> {
    let own = COLUMNS.into_iter().map(str::to_owned);
    own.chain(trace.columns.iter().map(|column| column.name.replace("_rad", "_deg")))
}

fn in_degrees(column: &Column, value: f64) -> f64 {
    if column.name.contains("_rad") { degrees(value) } else { value }
}

/// The shortest digits that read back as `value`, zero without a sign.
fn push(text: &mut String, value: f64) {
    add(text, format_args!("{:?}", value + 0.0));
}
