//! The linear model of a flight: first-order equations and the transfer function of pitch over elevator.

use fspid_aircraft::data::{AircraftData, LinearData, ModelData};
use fspid_aircraft::{AircraftError, VelocityForm};
use fspid_lti::{Complex, TransferFunction};
use serde_json::{Value, json};

use super::NO_TRIM;
use super::condition::Question;
use super::polynomial;
use super::state_model::StateModel;
use super::trim::{Trimmed, trim};
use crate::json::with_null_reasons;
use fspid_scenario::aircraft::AircraftFailure;
use fspid_scenario::aircraft::number::significant;
use fspid_scenario::aircraft::units::Units;

/// A linear model and the flight around which it holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    pub(super) data: AircraftData,
    pub(super) units: Units,
    /// The flight; none for a model that its source has for one condition alone.
    pub(super) trimmed: Option<Trimmed>,
    pub(super) longitudinal: StateModel,
    pub(super) lateral: Option<StateModel>,
    pub(super) plant: TransferFunction,
}

/// The linear model of an aircraft around a trim, or that of its source where there is no more.
///
/// # Errors
/// [`AircraftFailure`]: as [`trim`].
pub fn linearise(question: &Question<'_>, form: VelocityForm) -> Result<Linear, AircraftFailure> {
    let data = question.data()?;
    match &data.model {
        ModelData::Linear(model) if question.is_at_reference() => {
            of_source(question.units, data.clone(), model)
        }
        _ => of_flight(trim(question)?, form),
    }
}

fn of_flight(trimmed: Trimmed, form: VelocityForm) -> Result<Linear, AircraftFailure> {
    let model = trimmed.flight.aircraft.linearise(&trimmed.trim);
    let has_lateral = trimmed.flight.data.has_lateral();
    let lateral = match has_lateral {
        true => Some(StateModel::lateral(model.lateral(form)?, form)),
        false => None,
    };
    Ok(Linear {
        data: trimmed.flight.data.clone(),
        units: trimmed.flight.units,
        longitudinal: StateModel::longitudinal(model.longitudinal(form)?, form),
        lateral,
        plant: model.theta_over_elevator()?,
        trimmed: Some(trimmed),
    })
}

fn of_source(
    units: Units,
    data: AircraftData,
    model: &LinearData,
) -> Result<Linear, AircraftFailure> {
    let longitudinal = StateModel::of_source(model.system()?, &model.states);
    let plant = model.theta_over_elevator()?;
    Ok(Linear { data, units, trimmed: None, longitudinal, lateral: None, plant })
}

impl Linear {
    /// Where the model holds, in a line.
    #[must_use]
    pub fn condition(&self) -> String {
        match &self.trimmed {
            Some(trimmed) => trimmed.condition(),
            None => "as its source has it, at that condition alone".to_owned(),
        }
    }

    /// The model for people.
    #[must_use]
    pub fn text(&self) -> String {
        let mut out = format!("{}\n{}\n\nlongitudinal\n", self.data.title, self.condition());
        out.push_str(&self.longitudinal.text(self.units));
        if let Some(lateral) = &self.lateral {
            out.push_str(&format!("\nlateral\n{}", lateral.text(self.units)));
        }
        out.push_str(&format!("\npitch over elevator\n{}", polynomial::fraction(&self.plant)));
        for (name, roots) in self.roots() {
            let roots: Vec<String> = roots.iter().copied().filter(upper).map(told).collect();
            out.push_str(&format!("  {name}  {}\n", roots.join(", ")));
        }
        out
    }

    fn roots(&self) -> [(&'static str, Vec<Complex>); 2] {
        let found = |roots: Result<_, AircraftError>| roots.unwrap_or_default();
        let poles = self.plant.poles().map_err(AircraftError::from);
        let zeros = self.plant.zeros().map_err(AircraftError::from);
        [("poles", found(poles)), ("zeros", found(zeros))]
    }

    /// The model for programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let roots = self.roots().map(|(name, roots)| {
            let pairs: Vec<[f64; 2]> = roots.iter().map(|root| [root.re, root.im]).collect();
            (format!("{name}_rad_s"), json!(pairs))
        });
        let mut plant = polynomial::json(&self.plant);
        for (name, roots) in roots {
            plant[name] = roots;
        }
        let answer = json!({
            "aircraft": self.data.name,
            "units": self.units.name(),
            "trim": self.trimmed.as_ref().map(Trimmed::json),
            "longitudinal": self.longitudinal.json(self.units),
            "lateral": self.lateral.as_ref().map(|lateral| lateral.json(self.units)),
            "theta_over_elevator": plant,
        });
        let lateral = ("lateral", "the source has nothing on it");
        with_null_reasons(answer, &[("trim", NO_TRIM), lateral])
    }
}

fn upper(root: &Complex) -> bool {
    root.im >= 0.0
}

/// A root for people; of a pair, both at once.
fn told(root: Complex) -> String {
    let real = significant(root.re, 6);
    match root.im > 0.0 {
        true => format!("{real} ± {}j", significant(root.im, 6)),
        false => real,
    }
}
