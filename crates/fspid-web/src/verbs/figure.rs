//! Figures as reports draw them.

use fspid_fuzzy::Output;
use fspid_plot::{Observer, SurfaceKind};
use fspid_sim::Controller;
use fspid_study::report;
use fspid_study::report::supervisor::{Fineness, surface_of};
use fspid_study::simulation::Simulation;
use serde_json::json;

use super::Answered;
use super::judge::analysed;
use crate::Answer;
use crate::question::Question;

/// The figure of a `kind`: `responses`, `bode`, `nyquist`, `nichols`, `sensitivity`, or of a supervisor
/// `surface-kp` and the like, `map-kp`, and `view-kp` from `azimuth_deg` and `elevation_deg`.
pub(super) fn figure(question: &Question) -> Answered {
    let kind = question.text("kind")?;
    let svg = match kind {
        "responses" => {
            let study = question.study()?;
            let simulation = Simulation::of(&study).map_err(Answer::refused)?;
            Some(report::responses_of(&study, &simulation).as_str().to_owned())
        }
        _ if ["surface-", "map-", "view-"].iter().any(|it| kind.starts_with(it)) => {
            surface(question, kind)?
        }
        _ => {
            let figures = analysed(question)?.response_figures();
            let found = figures.into_iter().find(|(name, _)| *name == kind);
            found.map(|(_, svg)| svg.as_str().to_owned())
        }
    };
    let svg = svg.ok_or_else(|| Answer::refused(format_args!("there is no figure `{kind}`")))?;
    Ok(Answer::of(json!({ "svg": svg })))
}

/// A gain over the inputs of a supervisor: as a report has it, as a map alone, or as an observer sees it.
fn surface(question: &Question, kind: &str) -> Result<Option<String>, Answer> {
    let (study, name) = (question.study()?, question.text("controller")?);
    let named = study.scenario.controllers.iter().find(|named| named.name == name);
    let Some(Controller::SelfTuning(fspid)) = named.map(|named| &named.controller) else {
        return Ok(None);
    };
    let gain = kind.rsplit('-').next().unwrap_or_default();
    let mut outputs = Output::ALL.into_iter();
    let Some(output) = outputs.find(|it| it.name().strip_prefix("delta_") == Some(gain)) else {
        return Ok(None);
    };
    let surface = |fineness| surface_of(name, fspid.tuner().supervisor(), output, fineness);
    let svg = match kind.split('-').next() {
        Some("view") => {
            let [azimuth, elevation] =
                ["azimuth_deg", "elevation_deg"].map(|it| question.number(it));
            surface(Fineness::Moving).seen_by(Observer::at_deg(azimuth?, elevation?))
        }
        Some("map") => surface(Fineness::Report).render(SurfaceKind::Map),
        _ => surface(Fineness::Report).render(SurfaceKind::Relief),
    };
    Ok(Some(svg.as_str().to_owned()))
}
