//! What is known about an aircraft that is made of tables.

use fspid_aircraft::data::ForceData;
use fspid_aircraft::{Quantity, Range, TableInput};
use serde_json::{Value, json};

use super::facts::Facts;
use super::limits::{travel, validity};
use fspid_scenario::aircraft::number::short;
use fspid_scenario::aircraft::units::{Kind, Units};

fn body(data: &ForceData) -> Facts {
    let (geometry, mass) = (&data.geometry, &data.mass);
    Facts::default()
        .number("reference area", "area", Kind::Area, geometry.area_m2)
        .number("reference span", "span", Kind::Length, geometry.span_m)
        .number("reference chord", "chord", Kind::Length, geometry.chord_m)
        .number("mass", "mass", Kind::Mass, mass.mass_kg)
        .number("gravity", "gravity", Kind::Acceleration, data.gravity_m_s2)
        .number("Ix", "ix", Kind::Inertia, mass.ix_kg_m2)
        .number("Iy", "iy", Kind::Inertia, mass.iy_kg_m2)
        .number("Iz", "iz", Kind::Inertia, mass.iz_kg_m2)
        .number("Ixz", "ixz", Kind::Inertia, mass.ixz_kg_m2)
        .number("angular momentum of the engine", "engine", Kind::Momentum, mass.engine_kg_m2_s)
}

fn limits(data: &ForceData) -> [Facts; 2] {
    let forces = &data.forces;
    [
        validity("angle of attack", forces.validity()),
        travel("throttle, of its travel", forces.travel()),
    ]
}

/// The aircraft for people.
pub(super) fn text(data: &ForceData, units: Units) -> String {
    let [validity, travel] = limits(data).map(|facts| facts.text(units));
    let (body, inputs, held) = (body(data).text(units), inputs_text(data), held_text(data));
    format!(
        "body\n{body}\nwhat the tables cover\n{validity}{inputs}\nhow far the controls go\n{travel}{held}"
    )
}

/// What else enters tables, in the units of its file.
fn inputs_text(data: &ForceData) -> String {
    let name = |(input, _): &(TableInput, Range)| Quantity::Table(*input).name().chars().count();
    let width = data.table_inputs.iter().map(name).fold("angle of attack".len(), usize::max);
    let line = |(input, range): &(TableInput, Range)| {
        let quantity = Quantity::Table(*input);
        let [min, max] = [range.min, range.max].map(|end| short(end, 6));
        let line = format!("  {:width$}  {min} to {max} {}", quantity.name(), quantity.unit());
        format!("{}\n", line.trim_end())
    };
    data.table_inputs.iter().map(line).collect()
}

fn held_text(data: &ForceData) -> String {
    match data.held.is_empty() {
        true => String::new(),
        false => {
            let lines = data.held.iter().map(|held| format!("  {held}\n"));
            format!("\nwhat a flight leaves as the files have it\n{}", lines.collect::<String>())
        }
    }
}

fn inputs_json(data: &ForceData) -> Value {
    let input = |(input, range): &(TableInput, Range)| {
        let quantity = Quantity::Table(*input);
        json!({
            "input": quantity.name(), "unit": quantity.unit(), "from": range.min, "to": range.max,
        })
    };
    data.table_inputs.iter().map(input).collect()
}

/// The aircraft for programs; a limit that is not known is null.
pub(super) fn json(data: &ForceData, units: Units) -> Value {
    let [validity, travel] = limits(data).map(|facts| facts.json(units));
    json!({
        "body": body(data).json(units), "validity": validity, "travel": travel,
        "table_inputs": inputs_json(data), "held": data.held,
    })
}
