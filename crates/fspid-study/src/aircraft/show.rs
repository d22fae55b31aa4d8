//! Everything that is known about an aircraft.

use fspid_aircraft::aerodynamics::derivatives::{
    Lateral, LateralCoefficient, Longitudinal, LongitudinalCoefficient,
};
use fspid_aircraft::aerodynamics::increment::Configuration;
use fspid_aircraft::data::{
    AircraftData, DerivativeData, LinearData, LinearElevator, ModelData, Variations,
};
use serde_json::{Value, json};

use super::facts::Facts;
use super::limits::{travel, validity};
use super::linearise::linearise;
use super::list::kind;
use super::load::load;
use super::table::table;
use super::{Question, polynomial, tables};
use crate::json::{merged, present};
use fspid_scenario::aircraft::AircraftFailure;
use fspid_scenario::aircraft::number::short;
use fspid_scenario::aircraft::units::{Kind, Units};

/// An aircraft, to be told.
#[derive(Clone, Debug, PartialEq)]
pub struct Show {
    data: AircraftData,
    units: Units,
    /// What a linear model amounts to.
    linear: Option<super::Linear>,
}

/// Everything that is known about an aircraft that the program carries, or that is in a file.
///
/// # Errors
/// [`AircraftFailure`]: as [`load`].
pub fn show(name: &str, units: Units) -> Result<Show, AircraftFailure> {
    let data = load(name)?;
    let linear = match &data.model {
        ModelData::Derivatives(_) | ModelData::Forces(_) => None,
        ModelData::Linear(_) => {
            let question = Question { aircraft: name, units, ..Question::default() };
            Some(linearise(&question, fspid_aircraft::VelocityForm::Components)?)
        }
    };
    Ok(Show { data, units, linear })
}

fn reference(data: &DerivativeData) -> Facts {
    let reference = &data.reference;
    Facts::default()
        .number("true airspeed", "airspeed", Kind::Speed, reference.airspeed_m_s)
        .number("altitude", "altitude", Kind::Length, reference.altitude_m)
        .number("Mach number", "mach", Kind::Plain, reference.mach)
        .number("density", "density", Kind::Density, reference.density_kg_m3)
        .number(
            "dynamic pressure",
            "dynamic_pressure",
            Kind::Pressure,
            reference.dynamic_pressure_pa,
        )
        .number("gravity", "gravity", Kind::Acceleration, reference.gravity_m_s2)
        .number("angle of attack of the fuselage", "alpha_body", Kind::Angle, reference.alpha_rad)
}

/// Where a linear model holds, as far as its source tells.
fn condition(data: &LinearData) -> Facts {
    let mut facts = Facts::default();
    if let Some(condition) = data.condition {
        facts = facts
            .number("true airspeed", "airspeed", Kind::Speed, condition.airspeed_m_s)
            .number("altitude", "altitude", Kind::Length, condition.altitude_m);
        if let Some(mach) = condition.mach {
            facts = facts.number("Mach number", "mach", Kind::Plain, mach);
        }
    }
    match data.span_m {
        Some(span_m) => facts.number("span", "span", Kind::Length, span_m),
        None => facts,
    }
}

const fn positive_elevator(data: &LinearData) -> &'static str {
    match data.elevator {
        LinearElevator::NoseDownPositive => "down",
        LinearElevator::NoseUpPositive => "up",
    }
}

fn body(data: &DerivativeData) -> Facts {
    let (geometry, inertia) = (&data.geometry, &data.inertia);
    Facts::default()
        .number("wing area", "area", Kind::Area, geometry.area_m2)
        .number("span", "span", Kind::Length, geometry.span_m)
        .number("mean chord", "chord", Kind::Length, geometry.chord_m)
        .number("weight", "weight", Kind::Force, data.weight_n)
        .number("mass", "mass", Kind::Mass, data.mass_kg())
        .number("Ix, fuselage axes", "ix", Kind::Inertia, inertia.ix_kg_m2)
        .number("Iy", "iy", Kind::Inertia, inertia.iy_kg_m2)
        .number("Iz", "iz", Kind::Inertia, inertia.iz_kg_m2)
        .number("Ixz", "ixz", Kind::Inertia, inertia.ixz_kg_m2)
}

const FROM_REFERENCE: &str = "angle of attack, from the reference";
const AT_REFERENCE: &str = "throttle, 1 at the reference";

const LONGITUDINAL: [&str; 7] =
    ["coefficient", "reference", "alpha", "alpha rate", "pitch rate", "speed", "elevator"];
const LATERAL: [&str; 6] =
    ["coefficient", "sideslip", "roll rate", "yaw rate", "aileron", "rudder"];

fn longitudinal_values(row: &LongitudinalCoefficient) -> [f64; 6] {
    [row.reference, row.alpha, row.alpha_rate, row.pitch_rate, row.speed, row.elevator]
}

fn lateral_values(row: &LateralCoefficient) -> [f64; 5] {
    [row.beta, row.roll_rate, row.yaw_rate, row.aileron, row.rudder]
}

fn cells(name: &str, values: &[f64]) -> Vec<String> {
    let numbers = values.iter().map(|value| short(*value, 6));
    std::iter::once(name.to_owned()).chain(numbers).collect()
}

fn longitudinal_rows(data: &Longitudinal) -> [(&'static str, [f64; 6]); 3] {
    let rows = [("lift", &data.lift), ("drag", &data.drag), ("pitching moment", &data.pitch)];
    rows.map(|(name, row)| (name, longitudinal_values(row)))
}

fn lateral_rows(data: &Lateral) -> [(&'static str, [f64; 5]); 3] {
    let rows =
        [("side force", &data.side), ("rolling moment", &data.roll), ("yawing moment", &data.yaw)];
    rows.map(|(name, row)| (name, lateral_values(row)))
}

fn coefficients_text(data: &DerivativeData) -> String {
    let rows = longitudinal_rows(&data.longitudinal).map(|(name, row)| cells(name, &row));
    let mut out = table(&LONGITUDINAL, &rows);
    out.push_str(&format!("  thrust by speed: {}\n", short(data.longitudinal.thrust_speed, 6)));
    if let Some(lateral) = &data.lateral {
        let rows = lateral_rows(lateral).map(|(name, row)| cells(name, &row));
        out.push('\n');
        out.push_str(&table(&LATERAL, &rows));
    }
    out
}

fn coefficients_json(data: &DerivativeData) -> Value {
    let named = |names: &[&str], values: &[f64]| -> Value {
        let pairs = names.iter().skip(1).zip(values);
        let keys = pairs.map(|(name, value)| (name.replace(' ', "_"), json!(value)));
        Value::Object(keys.collect())
    };
    let key = |name: &str| name.replace(' ', "_");
    let longitudinal = longitudinal_rows(&data.longitudinal)
        .map(|(name, row)| (key(name), named(&LONGITUDINAL, &row)));
    let lateral = data.lateral.as_ref().map(lateral_rows);
    let lateral = lateral.into_iter().flatten();
    let lateral = lateral.map(|(name, row)| (key(name), named(&LATERAL, &row)));
    let mut whole: serde_json::Map<String, Value> =
        longitudinal.into_iter().chain(lateral).collect();
    whole.insert("thrust_speed".to_owned(), json!(data.longitudinal.thrust_speed));
    Value::Object(whole)
}

/// What is added to the derivatives in flight, in lines; nothing where nothing is.
fn variations_text(variations: &Variations) -> String {
    let mut text = String::new();
    for configuration in &variations.configurations {
        let Configuration { name, source, .. } = configuration;
        text.push_str(&format!("\nconfiguration {name}: {source}\n"));
    }
    if let Some(mach) = &variations.mach {
        let range = mach.range();
        text.push_str(&format!("\nrows over Mach number from {} to {}\n", range.min, range.max));
    }
    if let Some(ground) = &variations.ground {
        let height_m = ground.wing_height_m;
        text.push_str(&format!("\nground effect with the wing {height_m} m above the ground\n"));
    }
    text
}

/// The same for programs.
fn variations_json(variations: &Variations) -> Value {
    let Variations { configurations, mach, ground } = variations;
    let named = |it: &Configuration| json!({ "name": it.name, "source": it.source });
    let named: Vec<Value> = configurations.iter().map(named).collect();
    present(json!({
        "configurations": (!named.is_empty()).then_some(named),
        "mach_rows": mach.as_ref().map(|table| [table.range().min, table.range().max]),
        "wing_height_m": ground.map(|ground| ground.wing_height_m),
    }))
}

impl Show {
    /// The aircraft for people.
    #[must_use]
    pub fn text(&self) -> String {
        let AircraftData { name, title, source, notes, .. } = &self.data;
        let notes = if notes.is_empty() { String::new() } else { format!("notes: {notes}\n") };
        let (of_model, more) = (self.model_text(), variations_text(&self.data.variations));
        format!("{name}: {title}\nsource: {source}\n{notes}\n{of_model}{more}")
    }

    fn model_text(&self) -> String {
        let units = self.units;
        match (&self.data.model, &self.linear) {
            (ModelData::Derivatives(data), _) => format!(
                "flight condition of the derivatives\n{}\nbody\n{}\nderivatives, angles in rad\n{}\n\
                 where they are trusted\n{}\nhow far the controls go\n{}",
                reference(data).text(units),
                body(data).text(units),
                coefficients_text(data),
                validity(FROM_REFERENCE, &data.validity).text(units),
                travel(AT_REFERENCE, &data.travel).text(units),
            ),
            (ModelData::Forces(data), _) => tables::text(data, units),
            (ModelData::Linear(data), Some(linear)) => {
                let title = match data.condition {
                    Some(_) => "flight condition of the model",
                    None => "its source gives no flight condition",
                };
                let condition = condition(data).text(units);
                let sense = positive_elevator(data);
                let equations = linear.longitudinal.text(units);
                let plant = polynomial::fraction(&linear.plant);
                format!(
                    "known by its linear model alone; it cannot be trimmed or flown elsewhere\n\n\
                     {title}\n{condition}\na positive elevator turns the nose {sense}\n\n\
                     longitudinal\n{equations}\npitch over elevator\n{plant}"
                )
            }
            _ => String::new(),
        }
    }

    /// The aircraft for programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let units = self.units;
        let AircraftData { name, title, source, notes, model, variations } = &self.data;
        let of_model = match model {
            ModelData::Derivatives(data) => json!({
                "reference": reference(data).json(units),
                "body": body(data).json(units),
                "coefficients": coefficients_json(data),
                "validity": validity(FROM_REFERENCE, &data.validity).json(units),
                "travel": travel(AT_REFERENCE, &data.travel).json(units),
            }),
            ModelData::Forces(data) => tables::json(data, units),
            ModelData::Linear(data) => json!({
                "condition": condition(data).json(units),
                "elevator_sign": format!("nose-{}-positive", positive_elevator(data)),
            }),
        };
        let linear = self.linear.as_ref();
        merged([
            json!({
                "name": name, "title": title, "source": source, "notes": notes,
                "known_by": kind(model), "units": units.name(),
            }),
            of_model,
            variations_json(variations),
            present(json!({
                "longitudinal": linear.map(|linear| linear.longitudinal.json(units)),
                "theta_over_elevator": linear.map(|linear| polynomial::json(&linear.plant)),
            })),
        ])
    }
}
