//! Errors as exceptions of the package: `fspid.Error` and what is below it.

use std::fmt::Display;

use fspid::campaign::CampaignError;
use fspid::scenario::file::{LoadError, Problems};
use fspid::study::verify::VerifyError;
use fspid::tune::{NotRight, TuneError};
use pyo3::prelude::*;
use pyo3::types::PyType;

/// An exception of `fspid.errors` with these arguments.
fn raise<'py>(py: Python<'py>, class: &str, arguments: impl pyo3::call::PyCallArgs<'py>) -> PyErr {
    let made = py
        .import("fspid.errors")
        .and_then(|errors| errors.getattr(class)?.cast_into::<PyType>().map_err(PyErr::from))
        .and_then(|class| class.call1(arguments));
    made.map_or_else(|error| error, PyErr::from_value)
}

/// Input that cannot be used.
pub(crate) fn input(py: Python<'_>, message: impl Display) -> PyErr {
    raise(py, "InputError", (message.to_string().trim_end().to_owned(),))
}

/// A scenario that is wrong, with every problem in it.
pub(crate) fn problems(py: Python<'_>, problems: &Problems) -> PyErr {
    let message = problems.to_string().trim_end().to_owned();
    raise(py, "ScenarioError", (message, problems.to_json().to_string()))
}

/// A scenario that is wrong as it stands, or as its dispersions and cases make it.
pub(crate) fn not_right(py: Python<'_>, wrong: &NotRight) -> PyErr {
    let message = wrong.to_string().trim_end().to_owned();
    raise(py, "ScenarioError", (message, wrong.to_json().to_string()))
}

/// A file that gave no scenario.
pub(crate) fn load(py: Python<'_>, error: &LoadError) -> PyErr {
    match error {
        LoadError::Problems(found) => problems(py, found),
        LoadError::Unreadable { .. } => raise(py, "FileError", (error.to_string(),)),
    }
}

/// Output that cannot be written.
pub(crate) fn output(py: Python<'_>, message: impl Display) -> PyErr {
    raise(py, "FileError", (message.to_string(),))
}

/// What kept requirements from being judged.
pub(crate) fn verify(py: Python<'_>, error: &VerifyError) -> PyErr {
    match error {
        VerifyError::Load(error) => load(py, error),
        _ => input(py, error),
    }
}

/// What kept a campaign from going on.
pub(crate) fn campaign(py: Python<'_>, error: &CampaignError) -> PyErr {
    match error {
        CampaignError::Scenario(found) => problems(py, found),
        CampaignError::Unreadable(error) => load(py, error),
        error if error.is_of_output() => output(py, error),
        _ => input(py, error),
    }
}

/// What kept a tuning or a contest from going on.
pub(crate) fn tune(py: Python<'_>, error: &TuneError) -> PyErr {
    match error {
        TuneError::Scenario(found) => problems(py, found),
        TuneError::Unreadable(error) => load(py, error),
        error if error.is_of_output() => output(py, error),
        _ => input(py, error),
    }
}
