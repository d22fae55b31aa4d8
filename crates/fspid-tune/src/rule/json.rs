//! A design for programs.

use fspid_scenario::units::degrees;
use fspid_study::analysis::Margins;
use serde_json::{Map, Value, json};

use super::{
    Design, FittedModel, Identified, LqrSearch, PlacedPoles, RelayExperiment, UltimatePoint,
};

/// Version of the answer's shape.
const SCHEMA: u32 = 1;

impl Design {
    /// The answer for programs; a number that is infinite is `null`, a loop that is not held has no margins.
    #[must_use]
    pub fn json(&self) -> Value {
        let config = &self.config;
        let weights = config.setpoint_weights;
        let isa =
            self.isa().map(|isa| json!({ "gain": isa.gain, "ti_s": isa.ti_s, "td_s": isa.td_s }));
        json!({
            "schema": SCHEMA,
            "scenario": self.scenario,
            "rule": self.rule.name(),
            "form": self.form.name(),
            "about": self.rule.about(),
            "source": self.rule.source(),
            "formula": self.formula,
            "identified": identified(&self.identified),
            "gains": { "kp": self.gains.kp, "ki_per_s": self.gains.ki, "kd_s": self.gains.kd },
            "isa": isa,
            "rate_gain_s": config.rate_gain_s,
            "derivative_filter_s": config.derivative.filter_s,
            "setpoint_weights": {
                "proportional": weights.proportional,
                "derivative": weights.derivative,
            },
            "given_by_the_rule": {
                "rate_gain": self.given.rate_gain,
                "derivative_filter": self.given.derivative_filter,
                "setpoint_weights": self.given.setpoint_weights,
            },
            "verdict": self.verdict.name(),
            "verdict_sentence": self.verdict.sentence(),
            "plants": self.outcome.plants.iter().map(|plant| {
                let mut part = Map::new();
                part.insert("from_s".into(), json!(plant.from_s));
                part.insert("stable".into(), json!(plant.margins.is_ok()));
                if let Ok(margins) = &plant.margins {
                    part.insert("margins".into(), margins_of(margins));
                }
                Value::Object(part)
            }).collect::<Vec<_>>(),
            "warnings": self.warnings,
            "not_in_the_linear_loop": self.left_out,
            "toml": self.toml(),
        })
    }
}

fn margins_of(margins: &Margins) -> Value {
    json!({
        "gain_margin_db": margins.gain_margin_db,
        "phase_margin_deg": margins.phase_margin_deg,
        "gain_crossover_rad_s": margins.gain_crossover_rad_s,
        "delay_margin_s": margins.delay_margin_s,
        "disk_margin": margins.disk_margin,
        "sensitivity_peak": margins.sensitivity_peak,
        "spectral_radius": margins.spectral_radius,
    })
}

fn identified(found: &Identified) -> Value {
    let mut all = Map::new();
    let mut insert = |name: &str, part: Option<Value>| {
        if let Some(part) = part {
            all.insert(name.into(), part);
        }
    };
    insert("ultimate", found.ultimate.as_ref().map(ultimate));
    insert("model", found.model.as_ref().map(model));
    insert("relay", found.relay.as_ref().map(relay));
    insert("poles", found.poles.as_ref().map(poles));
    insert("search", found.search.as_ref().map(search));
    Value::Object(all)
}

fn ultimate(point: &UltimatePoint) -> Value {
    json!({
        "gain": point.gain,
        "period_s": point.period_s,
        "frequency_rad_s": point.frequency_rad_s(),
        "lowest_gain": point.lowest_gain,
    })
}

fn model(fitted: &FittedModel) -> Value {
    let parameters = fitted
        .model
        .parameters()
        .into_iter()
        .map(|(name, value, unit)| json!({ "name": name, "value": value, "unit": unit }));
    json!({
        "equation": fitted.model.equation(),
        "parameters": parameters.collect::<Vec<_>>(),
        "relative_dead_time": fitted.model.relative_dead_time(),
        "fitted_to": fitted.how,
        "fit_error": fitted.fit_error,
        "band_rad_s": fitted.band_rad_s,
    })
}

fn relay(found: &RelayExperiment) -> Value {
    json!({
        "amplitude_deg": degrees(found.amplitude_rad),
        "hysteresis_deg": degrees(found.hysteresis_rad),
        "oscillation_deg": degrees(found.oscillation_rad),
        "offset_deg": degrees(found.offset_rad),
        "scatter": found.scatter,
        "period_s": found.period_s,
        "cycles": found.cycles,
        "settled_s": found.settled_s,
        "phase_deg": found.phase_deg,
        "ultimate": ultimate(&found.ultimate),
    })
}

fn poles(found: &PlacedPoles) -> Value {
    json!({
        "damping": found.damping,
        "frequency_rad_s": found.frequency_rad_s,
        "third_per_s": found.third_per_s,
    })
}

fn search(found: &LqrSearch) -> Value {
    let [kp, ki, rate_gain] = found.start;
    json!({
        "start": { "kp": kp, "ki_per_s": ki, "rate_gain_s": rate_gain },
        "start_cost": found.start_cost,
        "cost": found.cost,
        "evaluations": found.evaluations,
    })
}
