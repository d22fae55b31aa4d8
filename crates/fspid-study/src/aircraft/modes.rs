//! The natural motions of an aircraft, by their names.

use fspid_aircraft::data::{AircraftData, ModelData};
use fspid_aircraft::{AircraftMode, Growth, VelocityForm, lateral_modes, longitudinal_modes};
use fspid_lti::{Complex, Mode, StateSpace, modulus};
use serde_json::{Value, json};

use super::NO_TRIM;
use super::condition::Question;
use super::table::table;
use super::trim::{Trimmed, trim};
use crate::json::with_null_reasons;
use fspid_diagnostics::digits::to_digits;
use fspid_scenario::aircraft::AircraftFailure;
use fspid_scenario::aircraft::number::significant;
use fspid_scenario::aircraft::units::Units;

/// The modes of an aircraft in a flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    data: AircraftData,
    units: Units,
    trimmed: Option<Trimmed>,
    longitudinal: Vec<Motion>,
    lateral: Vec<Motion>,
}

/// A mode with its name.
#[derive(Clone, Debug, PartialEq)]
struct Motion {
    name: &'static str,
    /// The pole as a mode; its name there is not read.
    pole: Complex,
    growth: Growth,
    period_s: Option<f64>,
    time_constant_s: f64,
}

/// The modes of an aircraft around a trim, or those of its source's model where there is no more.
///
/// # Errors
/// [`AircraftFailure`]: as [`trim`].
pub fn modes(question: &Question<'_>) -> Result<Modes, AircraftFailure> {
    let data = question.data()?;
    match &data.model {
        ModelData::Linear(model) if question.is_at_reference() => {
            let longitudinal = longitudinal(&model.system()?)?;
            let units = question.units;
            Ok(Modes { data, units, trimmed: None, longitudinal, lateral: Vec::new() })
        }
        _ => of_flight(trim(question)?),
    }
}

fn of_flight(trimmed: Trimmed) -> Result<Modes, AircraftFailure> {
    let model = trimmed.flight.aircraft.linearise(&trimmed.trim);
    let data = trimmed.flight.data.clone();
    let lateral = match data.has_lateral() {
        true => named(lateral_modes(&model.lateral(VelocityForm::Components)?)?),
        false => Vec::new(),
    };
    Ok(Modes {
        units: trimmed.flight.units,
        longitudinal: longitudinal(&model.longitudinal(VelocityForm::Components)?)?,
        lateral,
        trimmed: Some(trimmed),
        data,
    })
}

/// Motions by name; with fewer than four states, in which there is no phugoid, the pair is the short period.
fn longitudinal(system: &StateSpace) -> Result<Vec<Motion>, AircraftFailure> {
    if system.states() == 4 {
        return Ok(named(longitudinal_modes(system)?));
    }
    let poles = system.poles()?.into_iter().filter(|pole| pole.im >= 0.0).map(at_origin);
    let name = |pole: &Complex| match (pole.im > 0.0, pole.re == 0.0) {
        (true, _) => "short period",
        (false, true) => "attitude",
        (false, false) => "real pole",
    };
    let of_pole = |pole: Complex| {
        let mode = AircraftMode { name: fspid_aircraft::ModeName::ShortPeriod, pole };
        Motion { name: name(&pole), ..Motion::of(&mode) }
    };
    Ok(poles.map(of_pole).collect())
}

/// A pole that rounding alone keeps from the origin is there: pitch that is the sum of its rate.
fn at_origin(pole: Complex) -> Complex {
    if modulus(pole) < 1e-12 { Complex::new(0.0, 0.0) } else { pole }
}

fn named(modes: Vec<AircraftMode>) -> Vec<Motion> {
    modes.iter().map(Motion::of).collect()
}

impl Motion {
    fn of(mode: &AircraftMode) -> Self {
        Self {
            name: mode.name.name(),
            pole: mode.pole,
            growth: mode.growth(),
            period_s: mode.period_s(),
            time_constant_s: mode.time_constant_s(),
        }
    }

    fn mode(&self) -> Option<Mode> {
        Mode::of_pole(self.pole).ok()
    }

    /// What becomes of it, in words.
    const fn class(&self) -> &'static str {
        match (self.growth, self.period_s.is_some()) {
            (Growth::Halves(_), true) => "damped oscillation",
            (Growth::Halves(_), false) => "subsides",
            (Growth::Doubles(_), true) => "growing oscillation",
            (Growth::Doubles(_), false) => "diverges",
            (Growth::Stays, true) => "undamped oscillation",
            (Growth::Stays, false) => "neutral",
        }
    }

    fn cells(&self) -> Vec<String> {
        let told = |value: Option<f64>| value.map_or("-".to_owned(), |v| significant(v, 6));
        let (halves, doubles) = self.times();
        let (re, im) = (significant(self.pole.re, 6), self.pole.im);
        let pole = if im > 0.0 { format!("{re} ± {}j", significant(im, 6)) } else { re };
        let mode = self.mode();
        vec![
            self.name.to_owned(),
            pole,
            told(mode.map(|mode| mode.natural_frequency_rad_s)),
            told(self.period_s.and(mode).map(|mode| mode.damping_ratio)),
            told(self.period_s),
            told(halves),
            told(doubles),
            self.class().to_owned(),
        ]
    }

    /// Its name, and how fast and damped it is, or how soon it halves or doubles.
    fn in_words(&self) -> String {
        let name = self.name;
        match (self.period_s.and(self.mode()), self.growth) {
            (Some(mode), _) => format!(
                "{name} {} rad/s, damping {}",
                to_digits(mode.natural_frequency_rad_s, 3),
                to_digits(mode.damping_ratio, 3)
            ),
            (None, Growth::Halves(time_s)) => {
                format!("{name} halves in {} s", to_digits(time_s, 3))
            }
            (None, Growth::Doubles(time_s)) => {
                format!("{name} doubles in {} s", to_digits(time_s, 3))
            }
            (None, Growth::Stays) => format!("{name} neutral"),
        }
    }

    /// Times to half and to double size.
    const fn times(&self) -> (Option<f64>, Option<f64>) {
        match self.growth {
            Growth::Halves(time_s) => (Some(time_s), None),
            Growth::Doubles(time_s) => (None, Some(time_s)),
            Growth::Stays => (None, None),
        }
    }

    fn json(&self) -> Value {
        let (mode, (halves, doubles)) = (self.mode(), self.times());
        let constant_s = self.time_constant_s.is_finite().then_some(self.time_constant_s);
        json!({
            "name": self.name,
            "pole_rad_s": [self.pole.re, self.pole.im],
            "natural_frequency_rad_s": mode.map(|mode| mode.natural_frequency_rad_s),
            "damping_ratio": mode.map(|mode| mode.damping_ratio),
            "period_s": self.period_s,
            "time_to_half_s": halves,
            "time_to_double_s": doubles,
            "time_constant_s": constant_s,
            "class": self.class(),
        })
    }
}

/// Why keys of this answer are null.
const NULLS: [(&str, &str); 7] = [
    ("trim", NO_TRIM),
    ("natural_frequency_rad_s", "the pole is at the origin"),
    ("damping_ratio", "the pole is at the origin"),
    ("period_s", "the motion does not swing"),
    ("time_to_half_s", "the motion does not decay"),
    ("time_to_double_s", "the motion does not grow"),
    ("time_constant_s", "the motion neither decays nor grows"),
];

const HEADINGS: [&str; 8] = [
    "motion",
    "pole, rad/s",
    "frequency, rad/s",
    "damping",
    "period, s",
    "to half, s",
    "to double, s",
    "what becomes of it",
];

impl Modes {
    fn condition(&self) -> String {
        match &self.trimmed {
            Some(trimmed) => trimmed.condition(),
            None => "as its source has it, at that condition alone".to_owned(),
        }
    }

    /// The modes in a line: `short period 2.6 rad/s, damping 0.69; …; spiral doubles in 93 s`.
    pub(super) fn in_words(&self) -> String {
        let motions = self.longitudinal.iter().chain(&self.lateral);
        motions.map(Motion::in_words).collect::<Vec<_>>().join("; ")
    }

    /// The modes for people.
    #[must_use]
    pub fn text(&self) -> String {
        let mut out = format!("{}\n{}\n", self.data.title, self.condition());
        for (title, motions) in [("longitudinal", &self.longitudinal), ("lateral", &self.lateral)] {
            let rows: Vec<Vec<String>> = motions.iter().map(Motion::cells).collect();
            match rows.is_empty() {
                true => out.push_str(&format!("\n{title}: the source has nothing on it\n")),
                false => out.push_str(&format!("\n{title}\n{}", table(&HEADINGS, &rows))),
            }
        }
        out
    }

    /// The modes for programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let list = |motions: &[Motion]| motions.iter().map(Motion::json).collect::<Vec<_>>();
        let answer = json!({
            "aircraft": self.data.name,
            "units": self.units.name(),
            "trim": self.trimmed.as_ref().map(Trimmed::json),
            "longitudinal": list(&self.longitudinal),
            "lateral": list(&self.lateral),
        });
        with_null_reasons(answer, &NULLS)
    }
}
