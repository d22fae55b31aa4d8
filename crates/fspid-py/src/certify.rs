//! Proofs of a scenario, of all its cases, and certificates that are believed only after they are proved anew.

use std::path::PathBuf;

use fspid::certify::{
    self, Cases, CasesError, CertificateFile, Certification, CertifiedCases, CheckedFile, Effort,
    NotWritable, Question,
};
use fspid::scenario::file::{self, Study};
use fspid::tune::{NotRight, Source, WrongCase};
use pyo3::prelude::*;

use crate::answer::Answer;
use crate::origin::Origin;
use crate::scenario::Scenario;
use crate::{error, interrupt};

/// What is asked beside stability.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
#[allow(clippy::struct_excessive_bools, reason = "what Python passes by name")]
pub(crate) struct Wanted {
    controller: Option<String>,
    disturbances: bool,
    family: bool,
    nonlinear: bool,
    cases: Option<String>,
    steps: bool,
}

impl Wanted {
    fn question<'a>(&'a self, effort: &'a Effort) -> Question<'a> {
        let Self { disturbances, family, nonlinear, .. } = *self;
        Question { only: self.controller.as_deref(), disturbances, family, nonlinear, effort }
    }

    /// Which cases, if any are asked for; else what is wrong.
    fn which(&self, scenario: &Scenario) -> Result<Option<Cases>, String> {
        let names = scenario.controllers();
        if let Some(name) = self.controller.as_ref().filter(|name| !names.contains(name)) {
            let known: Vec<&str> = names.iter().map(String::as_str).collect();
            let known = file::known_words(name, &known);
            return Err(format!("there is no controller `{name}`{known}"));
        }
        if self.steps && self.cases.is_none() {
            return Err(
                "steps=True goes with cases: without them, steps are asked in any case".to_owned()
            );
        }
        self.cases.as_deref().map(Cases::named).transpose()
    }

    fn of_cases(&self, source: &Source, study: &Study, which: Cases) -> Result<Answer, Refused> {
        let effort = Effort { long_flights: self.steps, ..Effort::default() };
        let source = (source.path.as_path(), source.overrides.as_slice());
        let question = self.question(&effort);
        let found = CertifiedCases::answering(source, study, which, question, &mut |_| {});
        let found = found.map_err(Refused::Cases)?;
        answer((found.text(), found.json()), found.all_proved(), found.certificate_files())
    }

    fn as_it_stands(&self, template: &file::Template) -> Result<Answer, Refused> {
        let effort = Effort::default();
        let found = Certification::answering(template, self.question(&effort), &mut |_| {});
        let found = found.map_err(|error| Refused::Otherwise(error.to_string()))?;
        answer((found.text(), found.json()), found.all_proved(), found.certificate_files())
    }
}

/// Why there is no answer: as `check` tells it where the scenario is wrong in its cases.
enum Refused {
    Cases(CasesError),
    Otherwise(String),
}

impl Refused {
    fn raise(self, py: Python<'_>) -> PyErr {
        match self {
            Self::Cases(CasesError::Scenario(wrong)) => {
                let wrong = wrong.into_iter().map(|(case, problems)| WrongCase { case, problems });
                error::not_right(py, &NotRight::Cases(wrong.collect()))
            }
            Self::Cases(other) => error::input(py, other),
            Self::Otherwise(why) => error::input(py, why),
        }
    }
}

/// The answer with its certificates as files.
fn answer(
    (text, json): (String, serde_json::Value),
    good: bool,
    files: Result<Vec<CertificateFile>, NotWritable>,
) -> Result<Answer, Refused> {
    let files = files.map_err(|found| Refused::Otherwise(found.to_string()))?;
    let files = files.into_iter().map(|file| (file.name, file.text)).collect();
    Ok(Answer::new(text, &json, good).with_files(files))
}

#[pymethods]
impl Scenario {
    /// Proofs that its loops stay stable while gains move, as it stands or in each of its cases, with what is asked beside; the
    /// files are certificates.
    fn certify(&self, py: Python<'_>, wanted: Wanted) -> PyResult<Answer> {
        let which = wanted.which(self).map_err(|wrong| error::input(py, wrong))?;
        let Some(which) = which else {
            let template = py.detach(|| self.written(|written| written.template()));
            let template = template.map_err(|found| error::problems(py, &found))?;
            let answer = interrupt::run(py, move || wanted.as_it_stands(&template))?;
            return Ok(answer.map_err(|found| found.raise(py))?.from(self.made_of()));
        };
        let source = self.source(py)?;
        let origin = self.made_of_all(&source).map_err(|found| error::tune(py, &found))?;
        let study = self.shared_study();
        let answer = interrupt::run(py, move || wanted.of_cases(&source, &study, which))?;
        Ok(answer.map_err(|found| found.raise(py))?.from(origin))
    }
}

/// The text of a certificate's file.
#[pyfunction]
pub(crate) fn read_certificate(py: Python<'_>, path: PathBuf) -> PyResult<String> {
    file::read_text(&path).map_err(|found| error::load(py, &found))
}

/// A certificate proved anew from its text alone, and compared with what a scenario flies, if one is given. `name` stands
/// before what is wrong with a text that is none; `path` is its file, if it has one.
#[pyfunction]
#[pyo3(signature = (text, name, path=None, against=None))]
pub(crate) fn check_certificate(
    py: Python<'_>,
    text: String,
    name: &str,
    path: Option<PathBuf>,
    against: Option<PyRef<'_, Scenario>>,
) -> PyResult<Answer> {
    let template = against.as_ref().map(|it| it.written(|written| written.template()));
    let template = template.transpose().map_err(|found| error::problems(py, &found))?;
    let made_of = against.as_ref().map_or_else(Origin::default, |it| it.made_of());
    drop(against);
    let checked = interrupt::run(py, move || {
        let mut checked = certify::check_text(&text).map_err(NotChecked::NoCertificate)?;
        if let Some(template) = &template {
            checked.compare_family(template).map_err(NotChecked::Plant)?;
        }
        Ok(checked)
    })?;
    let checked: CheckedFile = checked.map_err(|found: NotChecked| found.raise(py, name))?;
    let answer = Answer::new(checked.text(), &checked.json(), checked.holds());
    Ok(answer.from(made_of.with(path)))
}

/// Why a certificate has no answer.
enum NotChecked {
    NoCertificate(certify::NoCertificate),
    Plant(fspid::sim::SimError),
}

impl NotChecked {
    fn raise(&self, py: Python<'_>, name: &str) -> PyErr {
        match self {
            Self::NoCertificate(refused) => {
                let located = refused.problems.iter().map(|it| format!("{name}: {it}"));
                error::input(py, located.collect::<Vec<_>>().join("\n"))
            }
            Self::Plant(error) => error::input(py, error),
        }
    }
}
