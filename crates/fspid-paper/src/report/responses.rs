//! Figures 5, 6, 8a, 8b and 9 under both fits.

use crate::report::templates::render;
use fspid_diagnostics::digits::to_six_decimals;
use serde::Serialize;

use crate::report::Paper;
use crate::{FIGURES, Fit, FlownFigure, JudgedClaim, Status};
use fspid_page::context;
use fspid_page::number::exact;
use fspid_page::page::{Figure, PageSection, PageTable};
use fspid_study::report::measures;
use fspid_study::report::traces::Drawing;

#[derive(Serialize)]
struct Part {
    id: &'static str,
    title: &'static str,
    own: Figure,
    shared: Figure,
    measures: PageTable,
    claims: Vec<Standing>,
    square: bool,
}

/// How many numbers of a figure stand how, under one fit.
#[derive(Serialize)]
struct Standing {
    fit: &'static str,
    reproduced: usize,
    all: usize,
}

/// The time responses of the paper.
pub(super) fn section(paper: &Paper<'_>) -> PageSection {
    let parts: Vec<Part> = FIGURES.iter().filter_map(|figure| part(paper, figure.id)).collect();
    let figures = parts.iter().flat_map(|part| [part.own.clone(), part.shared.clone()]).collect();
    PageSection::of("responses", "Figures 5, 6, 8 and 9", render("responses", context! { parts }))
        .with_figures(figures)
}

fn part(paper: &Paper<'_>, id: &'static str) -> Option<Part> {
    let reproduction = paper.reproduction;
    let own = reproduction.figure(Fit::Own, id)?;
    let shared = reproduction.figure(Fit::Shared, id)?;
    let of_figure = |judged: &&JudgedClaim| {
        judged.claim.id.strip_prefix('F').is_some_and(|rest| rest.split('.').next() == Some(id))
    };
    let claims: Vec<&JudgedClaim> = reproduction.claims.iter().filter(of_figure).collect();
    let standing = |fit: &'static str, status: fn(&JudgedClaim) -> Status| Standing {
        fit,
        reproduced: claims.iter().filter(|judged| status(judged) == Status::Reproduced).count(),
        all: claims.len(),
    };
    let variants = [("own fit", &own.simulation), ("shared supervisor", &shared.simulation)];
    Some(Part {
        id,
        title: own.figure.title,
        own: figure(own, "a fit of the figure's own"),
        shared: figure(shared, "the supervisor that is shared by all figures of its range"),
        measures: measures::side_by_side(
            &format!("Fig. {id}: measures of every step of the command under both fits."),
            &variants,
            &[],
        ),
        claims: vec![
            standing("its own fit", |j| j.status),
            standing("the shared supervisor", |j| j.shared_status),
        ],
        square: own.simulation.results.first().is_some_and(|result| result.metrics.edges.len() > 1),
    })
}

fn figure(flown: &FlownFigure, fit: &str) -> Figure {
    let title = match flown.fit {
        Fit::Own => format!("Fig. {}, own fit", flown.figure.id),
        Fit::Shared => format!("Fig. {}, shared supervisor", flown.figure.id),
    };
    let drawing = Drawing {
        title: &title,
        scenario: &flown.study.scenario,
        simulation: &flown.simulation,
        only: &[],
        detailed: false,
        width_px: 520.0,
    };
    let timing = flown.study.scenario.timing;
    let names: Vec<&str> =
        flown.simulation.results.iter().map(|result| result.name.as_str()).collect();
    let caption = format!(
        "Fig. {} with {fit}. Window {} s, sampled every {} s; controllers {}. From above: pitch angle, command, and \
         the three gains of the FSPID.{}",
        flown.figure.id,
        to_six_decimals(timing.end_s()),
        exact(timing.dt_s()),
        names.join(", "),
        drawing.spikes(),
    );
    Figure::new(
        format!("figure-{}-{}", flown.figure.id, flown.fit.name()),
        drawing.render(),
        caption,
    )
    .resting_on(flown.figure.assumptions)
}
