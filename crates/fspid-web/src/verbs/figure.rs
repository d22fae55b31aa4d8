//! Figures as reports draw them.

use fspid_plot::SurfaceKind;
use fspid_sim::Controller;
use fspid_study::report;
use fspid_study::report::supervisor;
use fspid_study::simulation::Simulation;
use serde_json::json;

use super::Answered;
use super::judge::analysed;
use crate::Answer;
use crate::question::Question;

/// The figure of a `kind`: `responses`, `bode`, `nyquist`, `nichols`, `sensitivity`, or of a supervisor `surface-kp`,
/// `surface-ki`, `surface-kd`.
pub(super) fn figure(question: &Question) -> Answered {
    let kind = question.text("kind")?;
    let svg = match kind {
        "responses" => {
            let study = question.study()?;
            let simulation = Simulation::of(&study).map_err(Answer::refused)?;
            Some(report::responses_of(&study, &simulation).as_str().to_owned())
        }
        _ if kind.starts_with("surface-") => surface(question, kind)?,
        _ => {
            let figures = analysed(question)?.response_figures();
            let found = figures.into_iter().find(|(name, _)| *name == kind);
            found.map(|(_, svg)| svg.as_str().to_owned())
        }
    };
    let svg = svg.ok_or_else(|| Answer::refused(format_args!("there is no figure `{kind}`")))?;
    Ok(Answer::of(json!({ "svg": svg })))
}

/// A gain over the inputs of a supervisor.
fn surface(question: &Question, kind: &str) -> Result<Option<String>, Answer> {
    let (study, name) = (question.study()?, question.text("controller")?);
    let named = study.scenario.controllers.iter().find(|named| named.name == name);
    let Some(Controller::SelfTuning(fspid)) = named.map(|named| &named.controller) else {
        return Ok(None);
    };
    let figures =
        supervisor::surfaces("cockpit", name, fspid.tuner().supervisor(), &[SurfaceKind::Relief]);
    let gain = format!("cockpit{}-", kind.strip_prefix("surface").unwrap_or_default());
    let found = figures.into_iter().find(|figure| figure.name.starts_with(&gain));
    Ok(found.map(|figure| figure.svg))
}
