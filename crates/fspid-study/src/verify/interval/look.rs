//! Whether a scenario holds with another value.

use fspid_scenario::file::{Extra, Problems, Study, changed_text, parse_with};
use fspid_sim::SimError;

use super::{Question, Why};
use crate::judgement::Judgement;
use crate::simulation::{ControllerResult, Simulation};

/// How many times as many samples as the present flight a flight may have, and how many it always may.
const LONGER: usize = 8;
const ALWAYS: usize = 20_000;

/// What has to hold, and of whom.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asked {
    /// The controller that is asked alone; none where all are.
    pub controller: Option<String>,
    /// How many requirements are judged; with none, stability at rest and settled steps are asked.
    pub requirements: usize,
    /// Ready sets that are required too.
    pub sets: Vec<String>,
}

/// Judges a scenario with one number changed.
pub(super) struct Looker<'a> {
    question: Question<'a>,
    /// Samples of a flight that is not looked at any more.
    most_samples: usize,
    pub(super) asked: Asked,
}

impl<'a> Looker<'a> {
    pub(super) fn new(
        question: &Question<'a>,
        controller: Option<String>,
    ) -> Result<Self, Problems> {
        let study = study_of(question, question.text)?;
        let asked = Asked { controller, requirements: 0, sets: question.sets.to_vec() };
        let most_samples = ALWAYS.max(LONGER * study.scenario.timing.rows());
        Ok(Self { question: *question, most_samples, asked })
    }

    /// Why the scenario does not hold with this value; nothing if it does.
    pub(super) fn look(&mut self, value: f64) -> Option<Why> {
        let study = match self.study(value) {
            Ok(study) => study,
            Err(problems) => return Some(Why::Refused(first(&problems))),
        };
        let samples = study.scenario.timing.rows();
        if samples > self.most_samples {
            return Some(Why::TooLong { samples });
        }
        match self.shortfalls(study) {
            Ok(found) if found.is_empty() => None,
            Ok(found) => Some(Why::NotMet(found)),
            Err(error) => Some(Why::Refused(error.to_string())),
        }
    }

    fn study(&self, value: f64) -> Result<Study, Problems> {
        let Question { text, path, .. } = self.question;
        let with = |value: String| study_of(&self.question, &changed_text(text, path, &value)?);
        // A key that wants a whole number takes no other.
        with(format!("{value:?}")).or_else(|problems| match value.fract() == 0.0 {
            true => with(format!("{value:.0}")),
            false => Err(problems),
        })
    }

    /// What is not met, a sentence each.
    fn shortfalls(&mut self, mut study: Study) -> Result<Vec<String>, SimError> {
        if let Some(name) = &self.asked.controller {
            study.scenario.controllers.retain(|it| it.name == *name);
            study.scenario.externals.retain(|it| it.name == *name);
        }
        let simulation = Simulation::of(&study)?;
        // What is required of the aircraft alone is required whoever flies it.
        let is_other = |of: &str| study.scenario.flyers().any(|flyer| flyer.name() == of);
        let is_asked = |of: &str| {
            self.asked.controller.as_ref().is_none_or(|name| name == of || !is_other(of))
        };
        let judgements = simulation.judgements.iter().filter(|it| is_asked(&it.controller));
        self.asked.requirements = judgements.clone().count();
        let mut found: Vec<String> = match self.asked.requirements {
            0 => simulation.results.iter().filter_map(not_good).collect(),
            _ => judgements.filter(|it| !it.met).map(unmet).collect(),
        };
        if self.asked.requirements > 0 {
            let failed = simulation.failed_flights();
            let failed = failed.iter().filter(|failed| simulation.is_asked(failed));
            found.extend(failed.map(|it| format!("{}: {}", it.who(), it.failures.join(", "))));
        }
        if found.is_empty() {
            found.extend(simulation.results.iter().filter_map(undecided));
        }
        Ok(found)
    }
}

/// The study of a text, with the ready sets of the question.
fn study_of(question: &Question<'_>, text: &str) -> Result<Study, Problems> {
    let extra = Extra { sets: question.sets, ..Extra::default() };
    parse_with(text, question.name, question.folder, &extra)
}

/// A requirement and what was found in its place.
fn unmet(judgement: &Judgement) -> String {
    let (requirement, measure) = (&judgement.requirement, judgement.requirement.measure.name());
    let id = if requirement.id == measure { "" } else { &format!("{}, ", requirement.id) };
    let (value, limits) = (judgement.value_in_words(), requirement.limits_in_words());
    format!("{id}{}: {measure} {value}, required {limits}", judgement.controller)
}

/// That nobody can tell whether a loop is stable at rest.
fn undecided(result: &ControllerResult) -> Option<String> {
    let is_undecided = result.at_rest.stability_word() == Some("undecided");
    is_undecided.then(|| format!("{}: undecided whether it is stable at rest", result.name))
}

/// Why a flight cannot be called good where nothing is required of it.
fn not_good(result: &ControllerResult) -> Option<String> {
    let (name, verdict) = (&result.name, result.verdict());
    if !verdict.is_good() {
        return Some(format!("{name}: {verdict}"));
    }
    match result.at_rest.stability_word() {
        Some("stable" | "undecided") => None,
        Some(other) => Some(format!("{name}: {other} at rest")),
        None => Some(format!("{name}: it has no gains at rest of which stability could be asked")),
    }
}

/// The first problem; the others mostly follow from it.
fn first(problems: &Problems) -> String {
    problems.list.first().map_or_else(String::new, |problem| {
        let place = if problem.path.is_empty() { "" } else { ": " };
        let allowed = match problem.allowed.as_str() {
            "" => String::new(),
            allowed => format!("; allowed is {allowed}"),
        };
        format!("{}{place}{}{allowed}", problem.path, problem.message)
    })
}
