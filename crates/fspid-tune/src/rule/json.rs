//! A design for programs.

use fspid_scenario::units::degrees;
use fspid_study::analysis::{Margins, PlantLoop};
use fspid_study::json::with_null_reasons;
use serde::{Serialize, Serializer};
use serde_json::{Value, json};

use super::{Design, FittedModel, RelayExperiment, UltimatePoint};

/// Version of the answer's shape.
const SCHEMA: u32 = 1;

/// Why keys of the answer are null.
const NULLS: [(&str, &str); 2] = [
    ("lowest_gain", "no smaller gain is known to make the loop unstable"),
    (
        "relative_dead_time",
        "the fitted model is no lag, beside which a dead time would be a share of something",
    ),
];

impl Design {
    /// The answer for programs; a number that is infinite is `null`, a loop that is not held has no margins.
    #[must_use]
    pub fn json(&self) -> Value {
        let config = &self.config;
        let weights = config.setpoint_weights;
        let answer = json!({
            "schema": SCHEMA,
            "scenario": self.scenario,
            "rule": self.rule.name(),
            "form": self.form.name(),
            "about": self.rule.about(),
            "source": self.rule.source(),
            "formula": self.formula,
            "identified": self.identified,
            "gains": { "kp": self.gains.kp, "ki_per_s": self.gains.ki, "kd_s": self.gains.kd },
            "isa": self.isa(),
            "rate_gain_s": config.rate_gain_s,
            "derivative_filter_s": config.derivative.filter_s,
            "setpoint_weights": {
                "proportional": weights.proportional,
                "derivative": weights.derivative,
            },
            "given_by_the_rule": self.given,
            "verdict": self.verdict.name(),
            "verdict_sentence": self.verdict.sentence(),
            "plants": self.outcome.plants.iter().map(plant).collect::<Vec<_>>(),
            "warnings": self.warnings,
            "not_in_the_linear_loop": self.left_out,
            "toml": self.toml(),
        });
        with_null_reasons(answer, &NULLS)
    }
}

fn plant(plant: &PlantLoop) -> Value {
    match &plant.margins {
        Ok(margins) => {
            json!({
                "from_s": plant.from_s,
                "stable": true,
                "stability": plant.stability().word(),
                "margins": margins_of(margins),
            })
        }
        Err(reason) => json!({
            "from_s": plant.from_s,
            "stable": plant.stability().known(),
            "stability": plant.stability().word(),
            "absent": reason.to_string(),
        }),
    }
}

fn margins_of(margins: &Margins) -> Value {
    let mut answer = json!({
        "gain_margin_db": margins.gain_margin_db,
        "phase_margin_deg": margins.phase_margin_deg,
        "gain_crossover_rad_s": margins.gain_crossover_rad_s,
        "delay_margin_s": margins.delay_margin_s,
        "disk_margin": margins.disk_margin,
        "sensitivity_peak": margins.sensitivity_peak,
        "spectral_radius": margins.spectral_radius,
    });
    let [low, high] = margins.gain_margin_db;
    if [low, high, margins.phase_margin_deg].iter().any(|margin| !margin.is_finite()) {
        answer["null"] = json!("no such change makes the loop unstable");
    }
    answer
}

impl Serialize for UltimatePoint {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let view = json!({
            "gain": self.gain,
            "period_s": self.period_s,
            "frequency_rad_s": self.frequency_rad_s(),
            "lowest_gain": self.lowest_gain,
        });
        view.serialize(to)
    }
}

impl Serialize for FittedModel {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let view = json!({
            "equation": self.model.equation(),
            "parameters": self.model.parameters(),
            "relative_dead_time": self.model.relative_dead_time(),
            "fitted_to": self.how,
            "fit_error": self.fit_error,
            "band_rad_s": self.band_rad_s,
        });
        view.serialize(to)
    }
}

impl Serialize for RelayExperiment {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let view = json!({
            "amplitude_deg": degrees(self.amplitude_rad),
            "hysteresis_deg": degrees(self.hysteresis_rad),
            "oscillation_deg": degrees(self.oscillation_rad),
            "offset_deg": degrees(self.offset_rad),
            "scatter": self.scatter,
            "period_s": self.period_s,
            "cycles": self.cycles,
            "settled_s": self.settled_s,
            "phase_deg": self.phase_deg,
            "ultimate": self.ultimate,
        });
        view.serialize(to)
    }
}

/// The gains that a search of least cost began with.
pub(super) fn start_gains<S: Serializer>(
    [kp, ki, rate_gain]: &[f64; 3],
    to: S,
) -> Result<S::Ok, S::Error> {
    json!({ "kp": kp, "ki_per_s": ki, "rate_gain_s": rate_gain }).serialize(to)
}
