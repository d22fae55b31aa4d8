//! Flights for programs.

use fspid_sim::describing::{LimitCycle, LimitCycles};
use fspid_sim::flown::Margin;
use fspid_sim::flown::empirical::EmpiricalAnswer;
use fspid_sim::flown::trajectory::{TrajectoryLinearisation, Worst};
use serde_json::{Value, json};

use super::Flights;
use crate::analysis::decibels;
use fspid_scenario::units::degrees;

impl Flights {
    /// The answer for programs.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({
            "flown_margins": empirical_json(&self.empirical),
            "limit_cycles": cycles(&self.limit_cycles),
            "along_the_flight": self.along.as_ref().map(along),
        })
    }
}

/// What a flight bears, for programs.
pub(in crate::analysis) fn empirical_json(answer: &EmpiricalAnswer) -> Value {
    match answer {
        EmpiricalAnswer::NominalFails { failure, .. } => {
            json!({ "absent": format!("the flight itself does not hold: {failure}") })
        }
        EmpiricalAnswer::NothingMoves => json!({ "absent": "nothing moves in this flight" }),
        EmpiricalAnswer::Margins(margins) => {
            let phase = margins.phase.iter().map(|phase| {
                json!({ "at_rad_s": phase.at_rad_s, "lag_deg": between(&phase.lag_rad, degrees) })
            });
            json!({
                "gain_down_db": between(&margins.gain_down, decibels),
                "gain_up_db": between(&margins.gain_up, decibels),
                "delay_s": between(&margins.delay_s, |seconds| seconds),
                "phase": phase.collect::<Vec<_>>(),
                "lenient": !margins.quiet,
                "flights": margins.flights,
            })
        }
    }
}

fn between(margin: &Margin, unit: impl Fn(f64) -> f64) -> Value {
    match margin {
        Margin::Between { holds, fails, failure } => json!({
            "holds_at": unit(*holds), "fails_at": unit(*fails), "failure": failure.to_string(),
        }),
        Margin::Beyond { held } => json!({ "holds_at": unit(*held), "fails_at": null }),
    }
}

fn cycles(found: &LimitCycles) -> Value {
    match found {
        LimitCycles::NothingLimits => json!({ "absent": "nothing is limited" }),
        LimitCycles::NoneFound { .. } | LimitCycles::Cycles(_) => {
            found.cycles().iter().map(cycle).collect()
        }
    }
}

fn cycle(cycle: &LimitCycle) -> Value {
    json!({
        "pitch_deg": degrees(cycle.pitch_amplitude_rad),
        "elevator_deg": degrees(cycle.elevator_amplitude_rad),
        "command_deg": degrees(cycle.command_amplitude_rad),
        "frequency_rad_s": cycle.frequency_rad_s,
        "period_s": cycle.period_s,
        "stable": cycle.stable,
    })
}

fn along(found: &TrajectoryLinearisation) -> Value {
    let worst = |worst: &Option<Worst>| {
        worst.as_ref().map(|worst| json!({ "spectral_radius": worst.radius, "at_s": worst.time_s }))
    };
    json!({
        "worst_with_frozen_gains": worst(&found.worst_frozen),
        "worst_with_gain_derivatives": worst(&found.worst),
        "share_above_one_frozen": found.frozen_above_one,
        "share_above_one": found.above_one,
        "share_limited": found.limited,
        "largest_growth": found.growth.largest,
        "growth_from_s": found.growth.from_s,
        "growth_to_s": found.growth.to_s,
        "exponent_1_s": found.growth.exponent_1_s,
    })
}
