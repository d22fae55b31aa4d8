//! A moment for programs: angles in degrees.

use fspid_core::Gains;
use fspid_fuzzy::Label;
use fspid_scenario::units::degrees;
use serde_json::{Value, json};

use super::{Fired, Fuzzy, Moment};
use crate::json::{finite, present};

impl Moment {
    /// What was seen, which rules fired with what each added to which gain, and the parts of the command: the first
    /// three less the rate's, and what is fed forward, are the command before its limits.
    #[must_use]
    pub fn json(&self) -> Value {
        let triple = |Gains { kp, ki, kd }| json!({ "kp": kp, "ki": ki, "kd": kd });
        present(json!({
            "controller": self.controller,
            "at_s": self.at_s,
            "setpoint_deg": degrees(self.sample.setpoint_rad),
            "measurement_deg": degrees(self.sample.measurement_rad),
            "rate_deg_s": degrees(self.sample.rate_rad_s),
            "command_deg": degrees(self.step.command_rad),
            "command_before_limits_deg": degrees(self.free_rad),
            "saturated": self.step.saturated,
            "parts": {
                "proportional_deg": degrees(self.parts.proportional_rad),
                "integral_deg": degrees(self.parts.integral_rad),
                "derivative_deg": degrees(self.parts.derivative_rad),
                "rate_deg": degrees(self.parts.rate_rad),
                "fed_forward_deg": degrees(self.parts.fed_forward_rad),
            },
            "gains": { "nominal": triple(self.nominal), "used": triple(self.step.gains) },
            "supervisor": self.fuzzy.as_ref().map(Fuzzy::json),
        }))
    }
}

impl Fuzzy {
    fn json(&self) -> Value {
        json!({
            "error": finite(self.seen[0]),
            "change": finite(self.seen[1]),
            "error_grades": self.grades[0],
            "change_grades": self.grades[1],
            "increments": { "kp": self.increments.kp, "ki": self.increments.ki, "kd": self.increments.kd },
            "rules": self.rules.iter().map(Fired::json).collect::<Vec<_>>(),
        })
    }
}

impl Fired {
    fn json(&self) -> Value {
        let label = |at: usize| Label::ALL.get(at).map(|label| label.name());
        let added = self.added.iter().map(|it| {
            it.as_ref().map(|it| json!({ "label": it.term, "added": it.added.map(finite) }))
        });
        let added: Vec<_> = added.collect();
        json!({
            "cell": self.cell,
            "error": label(self.cell[0]),
            "change": label(self.cell[1]),
            "strength": self.strength,
            "words": self.words,
            "kp": added.first(), "ki": added.get(1), "kd": added.get(2),
        })
    }
}
