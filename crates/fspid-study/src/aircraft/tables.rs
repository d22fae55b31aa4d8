//! What is known about an aircraft that is made of tables.

use fspid_aircraft::data::ForceData;
use serde_json::{Value, json};

use super::facts::Facts;
use super::limits::{travel, validity};
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
    let body = body(data).text(units);
    format!("body\n{body}\nwhat the tables cover\n{validity}\nhow far the controls go\n{travel}")
}

/// The aircraft for programs; a limit that is not known is null.
pub(super) fn json(data: &ForceData, units: Units) -> Value {
    let [validity, travel] = limits(data).map(|facts| facts.json(units));
    json!({ "body": body(data).json(units), "validity": validity, "travel": travel })
}
