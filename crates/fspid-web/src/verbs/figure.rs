//! Figures as reports draw them.

use fspid_fuzzy::Output;
use fspid_plot::{Observer, Surface, SurfaceKind, Svg};
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
/// `surface-kp` and the like, `map-kp` with its nodes, and `view-kp` from `azimuth_deg` and `elevation_deg`.
pub(super) fn figure(question: &Question) -> Answered {
    let kind = question.text("kind")?;
    let svg = match kind {
        "responses" => {
            let study = question.study()?;
            let simulation = Simulation::of(&study).map_err(Answer::refused)?;
            report::responses_of(&study, &simulation)
        }
        _ if ["surface-", "map-", "view-"].iter().any(|it| kind.starts_with(it)) => {
            return surface(question, kind);
        }
        _ => {
            let figures = analysed(question)?.response_figures();
            let found = figures.into_iter().find(|(name, _)| *name == kind);
            found.ok_or_else(|| unknown(kind))?.1
        }
    };
    Ok(drawn(&svg))
}

fn unknown(kind: &str) -> Answer {
    Answer::refused(format_args!("there is no figure `{kind}`"))
}

fn drawn(svg: &Svg) -> Answer {
    Answer::of(json!({ "svg": svg.as_str() }))
}

/// A gain over the inputs of a supervisor: as a report has it, as a map alone, or as an observer sees it.
fn surface(question: &Question, kind: &str) -> Answered {
    let (study, name) = (question.study()?, question.text("controller")?);
    let named = study.scenario.controllers.iter().find(|named| named.name == name);
    let Some(Controller::SelfTuning(fspid)) = named.map(|named| &named.controller) else {
        return Err(unknown(kind));
    };
    let gain = kind.rsplit('-').next().unwrap_or_default();
    let mut outputs = Output::ALL.into_iter();
    let output = outputs.find(|it| it.name().strip_prefix("delta_") == Some(gain));
    let output = output.ok_or_else(|| unknown(kind))?;
    let surface = |fineness| surface_of(name, fspid.tuner().supervisor(), output, fineness);
    Ok(match kind.split('-').next() {
        Some("view") => {
            let [azimuth, elevation] =
                ["azimuth_deg", "elevation_deg"].map(|it| question.number(it));
            drawn(&surface(Fineness::Moving).seen_by(Observer::at_deg(azimuth?, elevation?)))
        }
        Some("map") => map(&surface(Fineness::Report)),
        _ => drawn(&surface(Fineness::Report).render(SurfaceKind::Relief)),
    })
}

/// A map, and for who reads it the nodes along both axes with the values, row by row from below.
fn map(surface: &Surface) -> Answer {
    let mut answer = drawn(&surface.render(SurfaceKind::Map));
    let columns = [surface.xs.clone(), surface.ys.clone(), surface.values.concat()];
    let [x, y, values] = columns.map(|column| answer.keep(column));
    answer.json["nodes"] = json!({
        "x": x, "y": y, "values": values,
        "names": surface.spoken_labels(),
    });
    answer
}
