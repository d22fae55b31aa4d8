//! Requirements judged: which are met, by which number, in which worst case, and what replays it.
//!
//! One judging code with [`simulate`](crate::simulation): the same study, the same evidence, the same numbers.

pub mod interval;
mod json;
mod junit;
mod page;
mod replay;
mod text;

use std::path::Path;

use fspid_sim::SimError;

use crate::judgement::Judgement;
use crate::metrics::EdgeMetrics;
use crate::simulation::{ControllerResult, FailedFlight, Simulation};
use fspid_page::number::sentence;
use fspid_scenario::file::{self, Extra, LoadError, Problems, Study};

pub use replay::ReplayFile;

/// What to verify, as it is written on a command line.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// The scenario file.
    pub path: &'a Path,
    /// Changes `path=value`, and ready sets `NAME` or `NAME:key=value,…`.
    pub settings: &'a [String],
    /// Files of requirements.
    pub requirement_files: &'a [&'a Path],
}

/// A study whose requirements are judged.
#[derive(Clone, Debug)]
pub struct Verification {
    /// Path of the scenario as it was given.
    path: String,
    /// The scenario's text.
    scenario_text: String,
    /// Changes, as they were given.
    overrides: Vec<String>,
    /// Ready sets and files of requirements, as they were given.
    added: Added,
    /// The study.
    study: Study,
    /// Every requirement for every controller that it concerns.
    pub judgements: Vec<Judgement>,
    /// Flights that fail whatever is required of them, of controllers of which something is required: those of the
    /// scenario and those of ready sets' own.
    pub failed_flights: Vec<FailedFlight>,
    /// What is said of each loop beside its judgements: its gains at rest, loads that it does not remove.
    at_rest: Vec<String>,
    /// Controllers of whose loops it is undecided whether they are stable.
    undecided: Vec<String>,
}

/// What is required beside the entries of the scenario.
#[derive(Clone, Debug, Default)]
struct Added {
    sets: Vec<String>,
    requirement_files: Vec<String>,
}

/// Why nothing was verified.
#[derive(Debug, thiserror::Error)]
pub enum VerifyError {
    /// The scenario could not be read, or it or what is asked of it is wrong.
    #[error(transparent)]
    Load(LoadError),
    /// Nothing is required.
    #[error("{path}: nothing is required of it{}", way_out(*in_cases))]
    NothingRequired {
        /// Path of the scenario.
        path: String,
        /// Requirements that cases of a tuning or a contest are asked, and the scenario as it is written is not.
        in_cases: usize,
    },
    /// The scenario cannot be flown.
    #[error(transparent)]
    Simulation(#[from] SimError),
}

/// What can be done where nothing is required.
fn way_out(in_cases: usize) -> String {
    match in_cases {
        0 => "\n    add a ready set: --set mil-f-9490d, --set mil-f-8785c or --set ctms; of an aircraft's altitude --set mil-f-9490d-altitude or --set rvsm;\n    or write into the scenario, or into a file for --requirements:\n\n        [[requirement]]\n        measure = \"phase_margin_deg\"\n        least = 45.0\n".to_owned(),
        _ => format!(
            " as it is written: `only_in` limits all its {in_cases} requirements to cases of tuning or contest\n    leave `only_in` out, or judge a case by `--set` with its changes and requirements of a file\n"
        ),
    }
}

/// Judges every requirement of a scenario.
///
/// # Errors
/// [`VerifyError`]: input that cannot be used; a requirement that is not met is an answer and no error.
pub fn verify(question: &Question<'_>) -> Result<Verification, VerifyError> {
    let scenario_text = file::read_text(question.path).map_err(VerifyError::Load)?;
    let mut requirement_files = Vec::new();
    for file in question.requirement_files {
        let text = file::read_text(file).map_err(VerifyError::Load)?;
        requirement_files.push((file.display().to_string(), text));
    }
    verify_text(scenario_text, question, &requirement_files)
}

/// The same of a text, which is called as the question's `path` and names files from beside it, and of the texts of its
/// files of requirements, each behind its name.
///
/// # Errors
/// As [`verify`].
pub fn verify_text(
    scenario_text: String,
    question: &Question<'_>,
    requirement_files: &[(String, String)],
) -> Result<Verification, VerifyError> {
    let path = question.path.display().to_string();
    let (sets, overrides): (Vec<String>, Vec<String>) =
        question.settings.iter().cloned().partition(|text| names_a_set(text));
    let extra = Extra { overrides: &overrides, sets: &sets, requirement_files };
    let folder = question.path.parent().unwrap_or(Path::new(""));
    let study = file::parse_with(&scenario_text, &path, Some(folder), &extra)
        .map_err(|problems: Problems| VerifyError::Load(LoadError::Problems(problems)))?;
    if study.requirements.is_empty() {
        let in_cases = study.case_requirements.len();
        return Err(VerifyError::NothingRequired { path, in_cases });
    }
    let simulation = Simulation::of(&study)?;
    let mut failed_flights = simulation.failed_flights();
    failed_flights.retain(|failed| simulation.is_asked(failed));
    let at_rest = simulation.results.iter().flat_map(at_rest).collect();
    let undecided =
        simulation.results.iter().filter(|it| it.at_rest.undecided_in_words().is_some());
    let undecided = undecided.map(|it| it.name.clone()).collect();
    let judgements = simulation.judgements;
    let requirement_files = requirement_files.iter().map(|(name, _)| name.clone()).collect();
    let added = Added { sets, requirement_files };
    Ok(Verification {
        path,
        scenario_text,
        overrides,
        added,
        study,
        judgements,
        failed_flights,
        at_rest,
        undecided,
    })
}

/// The gains of a controller at rest beside the nominal ones, and what else is to be known of its flight.
fn at_rest(result: &ControllerResult) -> Vec<String> {
    let gains = result.at_rest.gains_in_words().into_iter();
    let steps = result.metrics.edges.iter().filter_map(EdgeMetrics::disturbed_within_in_words);
    let words = gains.chain(steps).chain(result.notes());
    words.map(|words| sentence(&format!("{}: {words}", result.name))).collect()
}

/// True for a ready set, `NAME` and `NAME:key=value`, false for a change, `path=value`; names in quotes do not count.
#[must_use]
pub fn names_a_set(text: &str) -> bool {
    let mut in_quotes = false;
    for c in text.chars() {
        match c {
            '"' => in_quotes = !in_quotes,
            ':' if !in_quotes => return true,
            '=' if !in_quotes => return false,
            _ => {}
        }
    }
    true
}

impl Verification {
    /// True if every requirement is met and no flight failed by itself.
    #[must_use]
    pub fn all_met(&self) -> bool {
        self.unmet() == 0 && self.failed_flights.is_empty()
    }

    /// How many requirements are not met, those that could not be evaluated among them.
    #[must_use]
    pub fn unmet(&self) -> usize {
        self.judgements.iter().filter(|judgement| !judgement.met).count()
    }

    /// What is allowed in the files and probably not meant.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.study.warnings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_setting_with_an_equals_sign_is_a_change_and_one_without_is_a_set() {
        for set in ["ctms", "mil-f-8785c:level=2,category=C", "cmts", ""] {
            assert!(names_a_set(set), "{set}");
        }
        for change in ["loop.sample_period_s=0.02", "controller.\"a:b\".kp=2", "name=a:b"] {
            assert!(!names_a_set(change), "{change}");
        }
    }
}
