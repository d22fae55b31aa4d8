//! Flying qualities: values, levels with the clause that they come from, and reasons where there are none.

mod rows;

use fspid_aircraft::atmosphere::STANDARD_GRAVITY_M_S2;
use fspid_aircraft::qualities::{
    Category, Class, CommandPath, Confidence, Judgement, Level, PitchModel, Qualities,
    lateral_level,
};
use fspid_aircraft::{AircraftError, VelocityForm, lateral_modes};
use fspid_lti::TransferFunction;
use serde_json::{Value, json};

use super::condition::Question;
use super::facts::Facts;
use super::parse::quantity;
use super::table::{paragraph, table};
use super::trim::{Trimmed, trim};
use fspid_scenario::aircraft::AircraftFailure;
use fspid_scenario::aircraft::number::significant;
use fspid_scenario::aircraft::units::{Kind, TIMES, Units};
use fspid_scenario::file::preset;
use fspid_scenario::supervisor::Refused;

/// Which aircraft is judged for its flying qualities, and behind which servo and delay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QualitiesQuestion<'a> {
    /// The aircraft and its flight; a plant that the program carries does as well.
    pub question: Question<'a>,
    /// For what they are judged.
    pub category: Category,
    /// What flies; without it the lateral motion is not judged.
    pub class: Option<Class>,
    /// Bandwidth of the servo in rad/s; 0 for none.
    pub servo_rad_s: f64,
    /// Dead time between command and servo.
    pub delay: &'a str,
}

/// Flying qualities, judged.
#[derive(Clone, Debug)]
pub struct Judged {
    title: String,
    name: String,
    units: Units,
    servo_rad_s: f64,
    delay_s: f64,
    qualities: Qualities,
    lateral: Vec<Result<Judgement, String>>,
}

/// Judges the flying qualities of an aircraft in a flight, or of a plant that the program carries.
///
/// # Errors
/// [`AircraftFailure`]: as [`trim`]; a servo or a dead time that cannot be.
pub fn qualities(question: &QualitiesQuestion<'_>) -> Result<Judged, AircraftFailure> {
    let (path, delay_s) = path(question)?;
    let asked = &question.question;
    let units = asked.units;
    let (title, model, lateral) = match plant(asked)? {
        Some((title, model)) => (title, model, Vec::new()),
        None => of_flight(&trim(asked)?, question)?,
    };
    Ok(Judged {
        title,
        name: asked.aircraft.to_owned(),
        units,
        servo_rad_s: question.servo_rad_s,
        delay_s,
        qualities: Qualities::of(&model.behind(path), question.category),
        lateral,
    })
}

fn path(question: &QualitiesQuestion<'_>) -> Result<(CommandPath, f64), AircraftFailure> {
    let (mut problems, omega) = (Vec::new(), question.servo_rad_s);
    let read = quantity("--delay", question.delay, &TIMES, Units::Si.of(Kind::Time));
    let delay_s = read.map_err(|problem| problems.push(problem)).unwrap_or_default();
    if !(delay_s >= 0.0) {
        problems.push("--delay must be 0 or above".to_owned());
    }
    if !(omega >= 0.0 && omega.is_finite()) {
        problems.push("--servo must be 0 for none, or a bandwidth above 0 in rad/s".to_owned());
    }
    if !problems.is_empty() {
        return Err(AircraftFailure::Refused(Refused::all(problems)));
    }
    let servo = (omega > 0.0).then(|| TransferFunction::new(&[omega], &[1.0, omega])).transpose();
    let servo = servo.map_err(AircraftError::from)?;
    Ok((CommandPath { servo, delay_s }, delay_s))
}

/// The plant of that name at its own condition; none for a name that is no plant or a flight that is named.
fn plant(question: &Question<'_>) -> Result<Option<(String, PitchModel)>, AircraftFailure> {
    let Some(plant) = preset(question.aircraft).filter(|_| question.is_at_reference()) else {
        return Ok(None);
    };
    let speed_m_s = plant.condition.speed_m_s.ok_or_else(|| {
        let name = question.aircraft;
        AircraftFailure::Refused(Refused::one(format!(
            "{name} does not say how fast it flies, so its loads are not known"
        )))
    })?;
    let transfer = plant.plant.transfer_function().clone();
    let model = PitchModel::new(transfer, speed_m_s, STANDARD_GRAVITY_M_S2)?;
    Ok(Some((plant.title, model)))
}

type Flown = (String, PitchModel, Vec<Result<Judgement, String>>);

fn of_flight(
    trimmed: &Trimmed,
    question: &QualitiesQuestion<'_>,
) -> Result<Flown, AircraftFailure> {
    let aircraft = &trimmed.flight.aircraft;
    let linear = aircraft.linearise(&trimmed.trim);
    let model = PitchModel::of(&linear, aircraft.environment().gravity_m_s2)?;
    let title = format!("{}\n{}", trimmed.flight.data.title, trimmed.condition());
    let has_lateral = trimmed.flight.data.has_lateral();
    let lateral = match question.class.filter(|_| has_lateral) {
        None => Vec::new(),
        Some(class) => {
            let modes = lateral_modes(&linear.lateral(VelocityForm::Components)?)?;
            let level = |mode| {
                lateral_level(mode, class, question.category)
                    .map_err(|reason| format!("{}: {reason}", mode.name.name()))
            };
            modes.iter().map(level).collect()
        }
    };
    Ok((title, model, lateral))
}

/// The number of a level; none for what is worse than all.
const fn level_number(level: Level) -> Option<u8> {
    match level {
        Level::One => Some(1),
        Level::Two => Some(2),
        Level::Three => Some(3),
        Level::Worse => None,
    }
}

const fn sureness(confidence: Confidence) -> &'static str {
    match confidence {
        Confidence::Transcribed => "transcribed",
        Confidence::Disputed => "disputed",
        Confidence::Digitised => "read off a chart",
        Confidence::Recalled => "recalled",
    }
}

impl Judged {
    fn judgements(&self) -> Vec<Judgement> {
        let lateral = self.lateral.iter().filter_map(|found| found.as_ref().ok().copied());
        self.qualities.judgements().chain(lateral).collect()
    }

    fn reasons(&self) -> Vec<String> {
        let lateral = self.lateral.iter().filter_map(|found| found.as_ref().err().cloned());
        rows::reasons(&self.qualities).into_iter().chain(lateral).collect()
    }

    fn facts(&self) -> Facts {
        rows::facts(&self.qualities)
    }

    /// The flying qualities for people.
    #[must_use]
    pub fn text(&self) -> String {
        let cells = |judgement: &Judgement| {
            let requirement = judgement.requirement;
            let value = significant(judgement.value, 4);
            let level = judgement.level.to_string();
            let sure = sureness(requirement.confidence).to_owned();
            let [title, clause] = [requirement.title, requirement.clause].map(str::to_owned);
            vec![title, value, level, clause, sure]
        };
        let judgements = self.judgements();
        let rows: Vec<Vec<String>> = judgements.iter().map(cells).collect();
        let headings = ["requirement", "value", "level", "clause", "numbers are"];
        let mut out = format!(
            "{}\ncategory {:?}; behind {}\n\n{}\n{}",
            self.title,
            self.qualities.category,
            self.path_in_words(),
            self.facts().text(self.units),
            table(&headings, &rows),
        );
        for (heading, lines) in
            [("what there is not", self.reasons()), ("notes", notes(&judgements))]
        {
            if !lines.is_empty() {
                let lines: String = lines.iter().map(|line| paragraph(line)).collect();
                out.push_str(&format!("\n{heading}\n{lines}"));
            }
        }
        out
    }

    fn path_in_words(&self) -> String {
        let servo = match self.servo_rad_s > 0.0 {
            true => format!("a servo of {} rad/s", self.servo_rad_s),
            false => "no servo".to_owned(),
        };
        format!("{servo} and a dead time of {} s", self.delay_s)
    }

    /// The flying qualities for programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let level = |judgement: &Judgement| {
            let requirement = judgement.requirement;
            json!({
                "requirement": requirement.title,
                "value": judgement.value.is_finite().then_some(judgement.value),
                "level": level_number(judgement.level),
                "level_in_words": judgement.level.to_string(),
                "clause": requirement.clause,
                "numbers_are": sureness(requirement.confidence),
                "note": requirement.note,
            })
        };
        json!({
            "aircraft": self.name,
            "units": self.units.name(),
            "category": format!("{:?}", self.qualities.category),
            "servo_rad_s": self.servo_rad_s,
            "delay_s": self.delay_s,
            "values": self.facts().json(self.units),
            "levels": self.judgements().iter().map(level).collect::<Vec<_>>(),
            "absent": self.reasons(),
        })
    }
}

/// What should be known about the requirements: how sure their numbers are, and what of them is not asked here.
fn notes(judgements: &[Judgement]) -> Vec<String> {
    let requirements = judgements.iter().map(|judgement| judgement.requirement);
    let mut notes: Vec<String> =
        requirements.map(|it| format!("{}: {}", it.title, it.note)).collect();
    notes.dedup();
    notes
}
