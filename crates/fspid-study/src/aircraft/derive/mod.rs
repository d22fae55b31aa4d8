//! From stability derivatives to polynomials, and how near they come to the paper's.

mod paper;

use fspid_aircraft::AircraftError;
use fspid_aircraft::data::{AircraftData, DerivativeData};
use fspid_aircraft::derivation::{DerivationCondition, DimensionalDerivatives};
use fspid_lti::TransferFunction;
use serde_json::{Value, json};

use super::facts::Facts;
use super::load::load;
use super::polynomial;
use super::table::table;
use fspid_scenario::aircraft::AircraftFailure;
use fspid_scenario::aircraft::number::significant;
use fspid_scenario::aircraft::units::{Kind, Units};
use paper::Comparison;

/// Polynomials from derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivation {
    data: AircraftData,
    units: Units,
    derivatives: DimensionalDerivatives,
    variants: Vec<Variant>,
    short_period: TransferFunction,
    paper: Option<Comparison>,
}

/// Pitch over elevator under an assumption.
#[derive(Clone, Debug, PartialEq)]
struct Variant {
    key: &'static str,
    name: &'static str,
    plant: TransferFunction,
    stable: bool,
}

/// Derives the polynomials of an aircraft by the equations that books print, at the condition of its source.
///
/// # Errors
/// [`AircraftFailure`]: as [`load`], and an aircraft that is known by a linear model alone.
pub fn derive(name: &str, units: Units) -> Result<Derivation, AircraftFailure> {
    let data = load(name)?;
    let known = data.derivatives()?;
    let condition = DerivationCondition::of(known);
    let derivatives = nominal(known, &condition);
    Ok(Derivation {
        variants: variants(known, &condition)?,
        short_period: derivatives.short_period(condition.airspeed_m_s)?,
        paper: paper::comparison(name, known)?,
        derivatives,
        units,
        data,
    })
}

/// True for a source with a derivative of the thrust by speed; without one the thrust is held.
fn has_thrust(data: &DerivativeData) -> bool {
    data.longitudinal.thrust_speed != 0.0
}

fn nominal(data: &DerivativeData, condition: &DerivationCondition) -> DimensionalDerivatives {
    match has_thrust(data) {
        true => DimensionalDerivatives::of(&data.longitudinal, condition),
        false => DimensionalDerivatives::with_constant_thrust(&data.longitudinal, condition),
    }
}

fn variants(
    data: &DerivativeData,
    condition: &DerivationCondition,
) -> Result<Vec<Variant>, AircraftError> {
    let nominal = nominal(data, condition);
    let constant = DimensionalDerivatives::with_constant_thrust(&data.longitudinal, condition);
    let simple = nominal.simplified();
    let turned = DimensionalDerivatives { m_w: -nominal.m_w, ..simple };
    let rows = [
        ("source", "the source's derivatives", nominal),
        ("simplified", "without Zw' and Zq, as the paper simplifies", simple),
        ("constant_thrust", "thrust that does not depend on speed", constant),
        ("printed_sign", "simplified, with the paper's printed sign of Mw", turned),
    ];
    let variant = |(key, name, derivatives): (_, _, DimensionalDerivatives)| {
        let plant =
            derivatives.theta_over_elevator(condition.airspeed_m_s, condition.gravity_m_s2)?;
        let stable = plant.poles()?.iter().all(|pole| pole.re < 0.0);
        Ok(Variant { key, name, plant, stable })
    };
    let told = rows.into_iter().filter(|row| row.0 != "constant_thrust" || has_thrust(data));
    told.map(variant).collect()
}

/// Powers of s above and below the line that are told; the leading one below is 1.
const COLUMNS: [&str; 9] = ["with", "above: s²", "s", "1", "below: s³", "s²", "s", "1", "is"];

/// Three coefficients above the line and four below.
fn coefficients(plant: &TransferFunction) -> Vec<f64> {
    let (above, below) = (plant.numerator().coefficients(), plant.denominator().coefficients());
    let missing = std::iter::repeat_n(0.0, 3_usize.saturating_sub(above.len()));
    missing.chain(above.iter().copied()).chain(below.iter().skip(1).copied()).collect()
}

impl Derivation {
    fn facts(&self) -> Facts {
        let found = &self.derivatives;
        Facts::default()
            .number("Xu", "x_u", Kind::Rate, found.x_u)
            .number("Xw", "x_w", Kind::Rate, found.x_w)
            .number("Xde", "x_elevator", Kind::Acceleration, found.x_elevator)
            .number("Zu", "z_u", Kind::Rate, found.z_u)
            .number("Zw", "z_w", Kind::Rate, found.z_w)
            .number("Zw'", "z_w_rate", Kind::Plain, found.z_w_rate)
            .number("Zq", "z_q", Kind::Speed, found.z_q)
            .number("Zde", "z_elevator", Kind::Acceleration, found.z_elevator)
            .number("Mu", "m_u", Kind::PerLengthTime, found.m_u)
            .number("Mw", "m_w", Kind::PerLengthTime, found.m_w)
            .number("Mw'", "m_w_rate", Kind::PerLength, found.m_w_rate)
            .number("Mq", "m_q", Kind::Rate, found.m_q)
            .number("Mde", "m_elevator", Kind::SquaredRate, found.m_elevator)
    }

    /// The derivation for people.
    #[must_use]
    pub fn text(&self) -> String {
        let row = |variant: &Variant| {
            let numbers = coefficients(&variant.plant);
            let mut cells = vec![variant.name.to_owned()];
            cells.extend(numbers.iter().map(|value| significant(*value, 7)));
            cells.push(if variant.stable { "stable" } else { "UNSTABLE" }.to_owned());
            cells
        };
        let rows: Vec<Vec<String>> = self.variants.iter().map(row).collect();
        let plant = self.variants.first().map(|variant| polynomial::fraction(&variant.plant));
        let thrust = match self.data.derivatives().is_ok_and(has_thrust) {
            true => "thrust by speed as the source says",
            false => "thrust held, as the source says nothing of it",
        };
        let mut out = format!(
            "{}\nby the longitudinal equations about level flight in stability axes; elevator down positive;\n\
             {thrust}\n\nderivatives of accelerations\n{}\npitch over elevator\n{}\nshort period alone\n{}\n\
             what the assumptions do\n{}",
            self.data.title,
            self.facts().text(self.units),
            plant.unwrap_or_default(),
            polynomial::fraction(&self.short_period),
            table(&COLUMNS, &rows),
        );
        if let Some(paper) = &self.paper {
            out.push_str(&paper.text());
        }
        out
    }

    /// The derivation for programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let variant = |variant: &Variant| {
            let mut found = polynomial::json(&variant.plant);
            found["stable"] = json!(variant.stable);
            (variant.key.to_owned(), found)
        };
        let variants: serde_json::Map<String, Value> = self.variants.iter().map(variant).collect();
        json!({
            "aircraft": self.data.name,
            "units": self.units.name(),
            "derivatives": self.facts().json(self.units),
            "theta_over_elevator": variants,
            "short_period": polynomial::json(&self.short_period),
            "paper": self.paper.as_ref().map(Comparison::json),
        })
    }
}
