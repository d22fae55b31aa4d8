//! A controller of a study in another language: which one is meant, if it can leave, and what its code is called.

use fspid_diagnostics::listed;
use fspid_export::program::Precision;
use fspid_export::{Angles, Export, Request, Target, export_called, prefix, prefixes};
use fspid_scenario::file::{Study, known_words};
use fspid_scenario::tuning::TunableParameter;
use fspid_sim::NamedController;

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// The controller's name; may be left out where there is only one.
    pub controller: Option<&'a str>,
    /// In which language.
    pub target: Target,
    /// With which digits; those that the target's users expect if left out.
    pub precision: Option<Precision>,
    /// In which unit angles go in and come out.
    pub angles: Angles,
    /// How many samples the vectors have.
    pub samples: usize,
    /// How many points a table has along each input.
    pub points: usize,
    /// What names in the code begin with; made of the controller's name if left out.
    pub prefix: Option<&'a str>,
    /// Data for a review is asked for, which C has.
    pub evidence: bool,
}

impl Question<'_> {
    /// Samples of the vectors where nobody asks for another number.
    pub const SAMPLES: u32 = 20_000;

    /// What is asked for where nothing but the target is said.
    #[must_use]
    pub const fn of(target: Target) -> Self {
        Self {
            controller: None,
            target,
            precision: None,
            angles: Angles::Radians,
            samples: Self::SAMPLES as usize,
            points: fspid_export::table::POINTS,
            prefix: None,
            evidence: false,
        }
    }
}

/// Why there is no export.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExportError {
    /// Several fly, and none is named.
    #[error("--controller NAME is missing; the scenario flies {flown}")]
    NoName {
        /// Those that fly.
        flown: String,
    },
    /// Nobody has that name.
    #[error("there is no controller `{name}`{known}")]
    Unknown {
        /// The name.
        name: String,
        /// The known ones, in words.
        known: String,
    },
    /// Numbers of it are still to be found.
    #[error(
        "{path} is marked for tuning; `fspid tune FILE --out design.toml` writes a design, which can be exported"
    )]
    NotTuned {
        /// Where the first of them is.
        path: String,
    },
    /// It cannot be said in that language, or not with those digits.
    #[error(transparent)]
    Export(#[from] fspid_export::ExportError),
}

/// The controller of a study that is meant.
///
/// # Errors
/// [`ExportError`]: none of that name, several and no name, one with numbers that are still to be tuned.
pub fn chosen<'a>(
    study: &'a Study,
    name: Option<&str>,
) -> Result<&'a NamedController, ExportError> {
    let controllers = &study.scenario.controllers;
    let names: Vec<&str> = controllers.iter().map(|named| named.name.as_str()).collect();
    let found = match (name, controllers.as_slice()) {
        (None, [only]) => only,
        (None, _) => return Err(ExportError::NoName { flown: listed(&names) }),
        (Some(name), all) => all.iter().find(|named| named.name == name).ok_or_else(|| {
            ExportError::Unknown { name: name.to_owned(), known: known_words(name, &names) }
        })?,
    };
    tuned(study, &found.name)?;
    Ok(found)
}

/// Refuses a controller that is not tuned yet.
fn tuned(study: &Study, name: &str) -> Result<(), ExportError> {
    let free = |mark: &&TunableParameter| mark.controller().is_none_or(|it| it == name);
    match study.tunable_parameters.iter().find(free) {
        None => Ok(()),
        Some(mark) => Err(ExportError::NotTuned { path: mark.path.text().to_owned() }),
    }
}

/// The controller in another language, with vectors that show that it answers alike.
///
/// # Errors
/// As [`chosen`], and what the language has no words for.
pub fn export(study: &Study, asked: &Question<'_>) -> Result<Export, ExportError> {
    let named = chosen(study, asked.controller)?;
    let request = Request {
        name: &named.name,
        target: asked.target,
        precision: asked.precision.unwrap_or(asked.target.usual_precision()),
        angles: asked.angles,
        samples: asked.samples,
        points: asked.points,
        digest: &study.digest,
        evidence: asked.evidence,
    };
    let called = asked.prefix.map_or_else(|| called(study, &named.name), str::to_owned);
    Ok(export_called(&named.controller, &request, &called)?)
}

/// What its code is called, which no other controller of the scenario is.
fn called(study: &Study, name: &str) -> String {
    let names: Vec<&str> = study.scenario.controllers.iter().map(|it| it.name.as_str()).collect();
    let mut all = names.iter().zip(prefixes(&names)).filter(|(it, _)| **it == name);
    all.next().map_or_else(|| prefix(name), |(_, own)| own)
}
