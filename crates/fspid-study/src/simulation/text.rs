//! The answer for people.

use std::fmt::Write as _;

use fspid_aircraft::Departure;
use fspid_sim::Exit;

use super::{ControllerResult, Judgement, Simulation};
use crate::metrics::{Absent, Measured, StepMetrics};
use crate::requirement::shortest;
use crate::units::degrees;

impl Simulation {
    /// The answer of `simulate --format text`: each controller with one line for each step of the
    /// command, then the requirements.
    #[must_use]
    pub fn text(&self) -> String {
        let mut out = format!("{}\n", self.scenario);
        let width = self.results.iter().map(|r| r.name.chars().count()).max().unwrap_or(0).max(10);
        for result in &self.results {
            line(&mut out, format_args!("\n{:width$}  {}", result.name, result.metrics.verdict));
            push_measures(&mut out, result);
        }
        if !self.judgements.is_empty() {
            out.push('\n');
        }
        for judgement in &self.judgements {
            push_judgement(&mut out, judgement);
        }
        out
    }
}

fn push_measures(out: &mut String, result: &ControllerResult) {
    let metrics = &result.metrics;
    for (edge, number) in metrics.edges.iter().zip(1..) {
        let (from_deg, to_deg) = (degrees(edge.from_rad), degrees(edge.to_rad));
        line(
            out,
            format_args!(
                "  step {number} at {:.2} s, {from_deg:+.3} to {to_deg:+.3} deg: {}",
                edge.at_s,
                step(&edge.step),
            ),
        );
    }
    if let (Ok(integrals), Ok(effort)) = (metrics.integrals, metrics.effort) {
        line(
            out,
            format_args!(
                "  IAE {:.4} deg s, ITAE {:.4} deg s², ISE {:.4} deg² s, command variation {:.3} deg, \
             largest command {:.3} deg",
                degrees(integrals.iae_rad_s),
                degrees(integrals.itae_rad_s2),
                degrees(degrees(integrals.ise_rad2_s)),
                degrees(effort.variation_rad),
                degrees(effort.largest_rad),
            ),
        );
    }
    if let Some(exit) = result.trace.exit {
        line(out, format_args!("  warning: {}", left_validity(&exit)));
    }
    if !result.trace.faults.is_empty() {
        line(out, format_args!("  faults: {}", result.trace.faults));
    }
}

/// When and by which limit a flight left the range of its model, in words.
pub(crate) fn left_validity(exit: &Exit) -> String {
    let Departure { quantity, value, allowed } = exit.departure;
    let (factor, unit) = match quantity.unit() {
        "rad" => (degrees(1.0), "deg"),
        unit => (1.0, unit),
    };
    let text = format!(
        "left the range of its model at t = {:.2} s: {} {:.4} {unit}, trusted {:.4} to {:.4} {unit}",
        exit.at_s,
        quantity.name(),
        factor * value,
        factor * allowed.min,
        factor * allowed.max,
    );
    text.trim_end().replace("  ", " ")
}

fn push_judgement(out: &mut String, judgement: &Judgement) {
    let met = if judgement.met { "met" } else { "NOT MET" };
    let requirement = &judgement.requirement;
    let (name, limits) = (requirement.measure.name(), requirement.limits_in_words());
    let (controller, value) = (&judgement.controller, judgement.value_in_words());
    let id = match requirement.id.as_str() {
        id if id == name => String::new(),
        id => format!(" ({id})"),
    };
    let own = judgement.own_step_deg.map_or(String::new(), |step_deg| {
        format!(", on a flight of its own with a step of {} deg", shortest(step_deg))
    });
    line(out, format_args!("{met}: {controller} {name} {value}, {limits}{id}{own}"));
}

/// Writing to a string cannot fail.
fn line(out: &mut String, text: std::fmt::Arguments<'_>) {
    let _ = writeln!(out, "{text}");
}

fn step(step: &StepMetrics) -> String {
    if let Err(reason @ (Absent::Diverged { .. } | Absent::Unstable { .. } | Absent::NotFinite)) =
        step.overshoot_pct
    {
        return format!("no measures ({reason})");
    }
    let show = |name: &str, measured: Measured, unit: &str| match measured {
        Ok(value) => format!("{name} {value:.3} {unit}"),
        Err(reason) => reason.to_string(),
    };
    [
        show("rise", step.rise_time_s, "s"),
        show("settling", step.settling_time_s, "s"),
        show("overshoot", step.overshoot_pct, "%"),
        show("final error", step.final_error_pct, "%"),
    ]
    .join(", ")
}
