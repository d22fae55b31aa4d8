//! The answer of `analyse --format json`.

use fspid_core::Gains;
use fspid_lti::{Complex, modulus};
use serde_json::{Map, Value, json};

use fspid_scenario::units::degrees;

use super::answer::{Margins, NO_CROSSOVER, NO_LOWER_LIMIT, NO_UPPER_LIMIT};
use super::{AnalysedLoop, Analysis, Equilibrium, FrozenMap, FrozenPoint, PlantLoop, RestLoop};

/// Version of the answer's shape.
const SCHEMA: u32 = 1;

impl Analysis {
    /// The answer for programs: an infinite margin is `null`, with its reason under `reasons`; a loop
    /// that is unstable has no margins.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({
            "schema": SCHEMA,
            "scenario": self.scenario,
            "broken_at": self.question.point.name(),
            "controllers": self.loops.iter().map(controller).collect::<Vec<_>>(),
            "not_in_the_linear_loop": self.left_out,
        })
    }
}

fn controller(found: &AnalysedLoop) -> Value {
    let mut answer = Map::new();
    answer.insert("name".into(), json!(found.name));
    match found.worst() {
        Some(plant) => plant_into(&mut answer, plant),
        None => {
            answer.insert("stable".into(), Value::Null);
            let reason = found.absent.map(|reason| reason.to_string()).unwrap_or_default();
            answer.insert("absent".into(), json!(reason));
        }
    }
    let (kind, gains) = match &found.equilibrium {
        Equilibrium::Fixed(gains) => ("fixed", Some(*gains)),
        Equilibrium::AtRest(gains) => ("at rest", Some(*gains)),
        Equilibrium::Drifts { .. } => ("none: they drift", None),
    };
    answer.insert("gains_are".into(), json!(kind));
    answer.insert("gains".into(), gains.map_or(Value::Null, triple));
    if found.plants.len() > 1 {
        let plants = found.plants.iter().map(|plant| {
            let mut part = Map::new();
            part.insert("from_s".into(), json!(plant.from_s));
            plant_into(&mut part, plant);
            Value::Object(part)
        });
        answer.insert("plants".into(), plants.collect());
    }
    if let Some(flights) = &found.flights {
        answer.insert("flights".into(), flights.json());
    }
    Value::Object(answer)
}

fn plant_into(answer: &mut Map<String, Value>, plant: &PlantLoop) {
    let unstable = plant.worst.closed_poles.iter().filter(|pole| modulus(**pole) >= 1.0);
    answer.insert("stable".into(), json!(plant.is_stable()));
    // Where gains that move make a constant command part of the loop, the rest at which it is worst.
    if !plant.others.is_empty() {
        let RestLoop { at, gains, .. } = &plant.worst;
        answer.insert("setpoint_deg".into(), json!(degrees(at.setpoint_rad)));
        answer.insert("load_deg".into(), json!(degrees(at.load_rad)));
        answer.insert("gain_on_the_error".into(), json!(gains.kp));
    }
    let shown = |pole: &Complex| pole_of(*pole, plant.worst.open.dt_s());
    answer.insert("unstable_poles".into(), unstable.map(shown).collect());
    if let Ok(margins) = &plant.margins {
        margins_into(answer, margins);
    }
    if let Some(map) = &plant.map {
        answer.insert("frozen_gains".into(), frozen(map));
    }
}

/// A pole in the z-plane and as a mode.
fn pole_of(pole: Complex, dt_s: f64) -> Value {
    let mode = super::text::mode(pole, dt_s);
    json!({
        "re": pole.re,
        "im": pole.im,
        "modulus": modulus(pole),
        "natural_frequency_rad_s": mode.natural_frequency_rad_s,
        "damping": mode.damping_ratio,
    })
}

fn margins_into(answer: &mut Map<String, Value>, margins: &Margins) {
    let mut reasons = Map::new();
    let mut number = |name: &str, value: f64, reason: &str| {
        if value.is_finite() {
            return json!(value);
        }
        reasons.insert(name.to_owned(), json!(reason));
        Value::Null
    };
    let [low, high] = margins.gain_margin_db;
    let low = number("gain_margin_db[0]", low, NO_LOWER_LIMIT);
    let high = number("gain_margin_db[1]", high, NO_UPPER_LIMIT);
    let phase = number("phase_margin_deg", margins.phase_margin_deg, NO_CROSSOVER);
    let delay = number("delay_margin_s", margins.delay_margin_s, NO_CROSSOVER);
    let crossover = margins.gain_crossover_rad_s.unwrap_or(f64::INFINITY);
    let crossover = number("gain_crossover_rad_s", crossover, NO_CROSSOVER);
    let values = [
        ("gain_margin_db", json!([low, high])),
        ("phase_margin_deg", phase),
        ("delay_margin_s", delay),
        ("disk_margin", json!(margins.disk_margin)),
        ("sensitivity_peak", json!(margins.sensitivity_peak)),
        ("gain_crossover_rad_s", crossover),
        ("phase_crossover_rad_s", json!(margins.phase_crossover_rad_s)),
        ("disk_gain_db", json!(margins.disk_gain_db)),
        ("disk_phase_deg", json!(margins.disk_phase_deg)),
        ("complementary_peak", json!(margins.complementary_peak)),
        ("spectral_radius", json!(margins.spectral_radius)),
    ];
    answer.extend(values.map(|(name, value)| (name.to_owned(), value)));
    let finite = |value: f64| if value.is_finite() { json!(value) } else { Value::Null };
    let open: Map<String, Value> = margins
        .open_brackets()
        .into_iter()
        .map(|(name, it)| (name.to_owned(), json!([finite(it.at_least), finite(it.at_most)])))
        .collect();
    if !open.is_empty() {
        answer.insert("proved_between".into(), Value::Object(open));
    }
    if !reasons.is_empty() {
        answer.insert("reasons".into(), Value::Object(reasons));
    }
}

fn triple(gains: Gains<f64>) -> Value {
    json!({ "kp": gains.kp, "ki": gains.ki, "kd": gains.kd })
}

/// Points of the map and, where rules conclude numbers, the cells beside them.
fn frozen(map: &FrozenMap) -> Value {
    let mut answer = json!({
        "stable": map.is_stable(),
        "points": map.points.len(),
        "unstable": map.unstable(),
        "worst": frozen_point(&map.worst),
        "map": map.points.iter().map(frozen_point).collect::<Vec<_>>(),
    });
    if !map.nodes.is_empty() {
        answer["cells"] = json!(map.nodes.len());
        answer["unstable_cells"] = json!(map.unstable_nodes());
        answer["map_of_cells"] = map.nodes.iter().map(frozen_point).collect();
    }
    answer
}

fn frozen_point(point: &FrozenPoint) -> Value {
    let mut answer = Map::new();
    answer.insert("error".into(), json!(point.input[0]));
    answer.insert("change".into(), json!(point.input[1]));
    answer.insert("gains".into(), triple(point.gains));
    answer.insert("stable".into(), json!(point.margins.is_ok()));
    match &point.margins {
        Ok(margins) => margins_into(&mut answer, margins),
        Err(reason) => {
            answer.insert("absent".into(), json!(reason.to_string()));
        }
    }
    Value::Object(answer)
}
