//! The answer for people.

use super::{ControllerResult, Judgement, Simulation};
use crate::flight::on_its_own;
use crate::metrics::{Absent, Measured, StepMetrics};
use fspid_scenario::units::degrees;

impl Simulation {
    /// The answer of `simulate --format text`: each controller with one line for each step of the
    /// command, then the requirements.
    #[must_use]
    pub fn text(&self) -> String {
        let mut out = format!("{}\n", self.scenario);
        let width = self.results.iter().map(|r| r.name.chars().count()).max().unwrap_or(0).max(10);
        for result in &self.results {
            out.push_str(&format!("\n{:width$}  {}\n", result.name, result.verdict()));
            push_measures(&mut out, result);
        }
        if let Some(note) = self.range_rule.note() {
            out.push_str(&format!("\nnote: {note}\n"));
        }
        if !self.judgements.is_empty() || !self.failed_flights().is_empty() {
            out.push('\n');
        }
        for judgement in &self.judgements {
            push_judgement(&mut out, judgement);
        }
        for failed in self.failed_flights() {
            let failures = failed.failures.join("; ");
            out.push_str(&format!("FAILED FLIGHT: {}: {failures}\n", failed.who()));
        }
        out
    }
}

fn push_measures(out: &mut String, result: &ControllerResult) {
    let metrics = &result.metrics;
    for (edge, number) in metrics.edges.iter().zip(1..) {
        let (from_deg, to_deg) = (degrees(edge.from_rad), degrees(edge.to_rad));
        out.push_str(&format!(
            "  step {number} at {:.2} s, {from_deg:+.3} to {to_deg:+.3} deg: {}{}\n",
            edge.at_s,
            step(&edge.step),
            edge.disturbed_in_words()
        ));
    }
    if let (Ok(integrals), Ok(effort)) = (metrics.integrals, metrics.effort) {
        out.push_str(&format!(
            "  IAE {:.4} deg s, ITAE {:.4} deg s², ISE {:.4} deg² s, command variation {:.3} deg, \
            largest command {:.3} deg\n",
            degrees(integrals.iae_rad_s),
            degrees(integrals.itae_rad_s2),
            degrees(degrees(integrals.ise_rad2_s)),
            degrees(effort.variation_rad),
            degrees(effort.largest_rad)
        ));
    }
    push_beside(out, result);
}

/// What is said beside the measures: the gains at rest, notes, faults.
fn push_beside(out: &mut String, result: &ControllerResult) {
    if let Some(words) = result.at_rest.gains_in_words() {
        out.push_str(&format!("  {words}\n"));
    }
    for words in result.notes() {
        out.push_str(&format!("  note: {words}\n"));
    }
    if !result.trace.faults.is_empty() {
        out.push_str(&format!("  faults: {}\n", result.trace.faults));
    }
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
    let own = on_its_own(judgement.own_step_deg);
    out.push_str(&format!("{met}: {controller} {name} {value}, {limits}{id}{own}\n"));
}

fn step(step: &StepMetrics) -> String {
    if let Err(reason @ (Absent::EndedEarly(_) | Absent::Unstable { .. } | Absent::NotFinite)) =
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
