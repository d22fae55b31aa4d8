//! A linear model as a plant file.

use fspid_aircraft::data::{LinearCondition, LinearElevator, ModelData};

use fspid_scenario::toml_text::quoted;

use super::linearise::Linear;
use super::trim::Trimmed;

impl Linear {
    /// The model as a plant file, which a scenario names under `[plant]` as `file`.
    #[must_use]
    pub fn plant_file(&self) -> String {
        text(self)
    }
}

/// The file: what a scenario reads, with the flight and the source in it.
fn text(linear: &Linear) -> String {
    let coefficients = linear.plant.numerator().coefficients();
    let numerator = list(coefficients);
    let denominator = list(linear.plant.denominator().coefficients());
    let data = &linear.data;
    let title = format!("{}; {}", data.title, linear.condition());
    let model = match &data.model {
        ModelData::Linear(model) => Some(model),
        _ => None,
    };
    let sign = match model.map(|model| model.elevator) {
        Some(LinearElevator::NoseUpPositive) => "\"nose-up-positive\"",
        _ => "\"nose-down-positive\"",
    };
    let mut out = format!(
        "# Written by `fspid aircraft linearise`; in a scenario: [plant] with file = \"…\".\n\
         name = {}\n\
         title = {}\n\
         numerator = {numerator}\n\
         denominator = {denominator}\n\
         elevator_sign = {sign}\n\
         source = {}\n\
         \n[condition]\n\
         aircraft = {}\n",
        quoted(&data.name),
        quoted(&title),
        quoted(&format!("Linear model computed from: {}", data.source)),
        quoted(&data.title),
    );
    if let Some(trimmed) = &linear.trimmed {
        out.push_str(&condition(trimmed));
    } else if let Some(held) = model.and_then(|model| model.condition) {
        out.push_str(&condition_of_source(&held));
    }
    out
}

fn condition_of_source(held: &LinearCondition) -> String {
    let LinearCondition { airspeed_m_s, altitude_m, mach } = held;
    let mach = mach.map_or_else(String::new, |mach| format!("mach = {mach:?}\n"));
    format!("speed_m_s = {airspeed_m_s:?}\naltitude_m = {altitude_m:?}\n{mach}")
}

fn condition(trimmed: &Trimmed) -> String {
    let target = &trimmed.trim.target;
    format!(
        "speed_m_s = {:?}\naltitude_m = {:?}\nmach = {:?}\nmass_kg = {:?}\n",
        target.airspeed_m_s,
        target.altitude_m,
        trimmed.mach(),
        trimmed.flight.aircraft.mass().mass_kg,
    )
}

/// Digits that read back as the same numbers.
fn list(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
    format!("[{}]", values.join(", "))
}
