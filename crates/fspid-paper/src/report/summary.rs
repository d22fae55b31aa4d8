//! What was done, and the bottom line: every sentence with numbers of this very run.

use crate::report::templates::render;
use fspid_sim::Controller;
use serde::Serialize;

use super::disturbances::{MATCHES, Match, compared};
use crate::disturbance::{Contest, SHAPES};
use crate::report::Paper;
use crate::{Fit, Reproduction, Status};
use fspid_page::context;
use fspid_page::number::{fixed, measured, significant};
use fspid_page::page::{Cell, PageSection, PageTable};
use fspid_study::metrics::{Measured, StepMetrics};
use fspid_study::simulation::Simulation;

/// The figure whose steps are taken apart, and the controller.
const EXAMPLE: (&str, &str) = ("8a", "FSPID");

/// The summary.
pub(super) fn section(paper: &Paper<'_>) -> PageSection {
    let reproduction = paper.reproduction;
    let context = context! {
        numbers => reproduction.claims.len(),
        statements => reproduction.statements.len(),
        scenarios => paper.library.scenarios().len(),
        statuses => statuses(reproduction),
        fits => fits(reproduction),
        contests => contests(reproduction),
        memory => memory(paper),
        failed => failed(reproduction),
    };
    PageSection::of("summary", "Summary", render("summary", context))
}

fn statuses(reproduction: &Reproduction) -> PageTable {
    let mut head = vec!["claims".to_owned()];
    head.extend(Status::ALL.map(|status| super::status(status).text));
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    let mut table = PageTable::new("How many claims stand how.", &head).in_cards();
    let own = reproduction.claims.iter().map(|judged| judged.status).collect();
    let shared = reproduction.claims.iter().map(|judged| judged.shared_status).collect();
    let words = reproduction.statements.iter().map(|judged| judged.status).collect();
    let rows: [(&str, Vec<Status>); 3] = [
        ("numbers, each figure with its own fit", own),
        ("numbers, one supervisor per range", shared),
        ("claims in words", words),
    ];
    for (name, found) in rows {
        let mut cells = vec![Cell::text(name)];
        cells.extend(Status::ALL.map(|status| {
            Cell::number(found.iter().filter(|of| **of == status).count().to_string())
        }));
        table.push(cells);
    }
    table
}

/// What the two kinds of fit say.
#[derive(Serialize)]
struct Fits {
    all: usize,
    own: usize,
    own_parameters: usize,
    shared: usize,
    shared_near: usize,
    shared_parameters: usize,
    median_pct: String,
    worst_pct: String,
    worst: &'static str,
}

fn fits(reproduction: &Reproduction) -> Fits {
    let claims = &reproduction.claims;
    let mut deviations: Vec<(f64, &'static str)> = claims
        .iter()
        .filter(|judged| judged.claim.paper.value() != 0.0)
        .filter_map(|judged| {
            let (paper, shared) = (judged.claim.paper.value(), judged.shared.ok()?);
            Some((100.0 * (shared - paper).abs() / paper.abs(), judged.claim.id))
        })
        .collect();
    deviations.sort_by(|a, b| a.0.total_cmp(&b.0));
    let median = deviations.get(deviations.len() / 2).map_or(f64::NAN, |found| found.0);
    let worst = deviations.last().copied().unwrap_or((f64::NAN, "F5.1"));
    let parameters = |start: &str| {
        let problems = reproduction.record.problems.iter();
        let of = problems.filter(|p| p.name.starts_with(start) && !p.name.contains("tuned"));
        of.map(|problem| problem.parameters.len()).sum()
    };
    let count = |status: Status, shared: bool| {
        let of = |judged: &&crate::JudgedClaim| {
            status == if shared { judged.shared_status } else { judged.status }
        };
        claims.iter().filter(of).count()
    };
    Fits {
        all: claims.len(),
        own: count(Status::Reproduced, false),
        own_parameters: parameters("Fig. "),
        shared: count(Status::Reproduced, true),
        shared_near: count(Status::Approached, true),
        shared_parameters: parameters("Figs "),
        median_pct: fixed(median, 1),
        worst_pct: fixed(worst.0, 0),
        worst: worst.1,
    }
}

/// A comparison of Fig. 7 over both shapes.
#[derive(Serialize)]
struct Outcome {
    name: &'static str,
    shapes: Vec<String>,
}

fn contests(reproduction: &Reproduction) -> Vec<Outcome> {
    let one = |of: &Match, shape: &str| {
        let Contest { won, cases, mean, .. } = of.contest(&reproduction.sweeps, shape);
        format!("{shape}, better in {won} of {cases} cases, cost {} on average", compared(mean))
    };
    let outcome = |of: &Match| Outcome {
        name: of.name,
        shapes: SHAPES.iter().map(|shape| one(of, shape)).collect(),
    };
    MATCHES.iter().map(outcome).collect()
}

/// What a law without memory explains: steps of both sizes from rest beside the first and later ones.
#[derive(Serialize)]
struct Memory {
    figure: &'static str,
    memoryless: bool,
    laws: Vec<&'static str>,
    first: Step,
    down: Step,
    later: Step,
    alone_small: String,
    alone_large: String,
    ratio: String,
    /// That share is more than half.
    mostly: bool,
    /// Share of the gain in rise time that a step without a past has too, %; `None` without a gain.
    share_pct: Option<String>,
}

#[derive(Serialize)]
struct Step {
    rise_s: String,
    overshoot_pct: String,
}

fn memory(paper: &Paper<'_>) -> Option<Memory> {
    let (figure, controller) = EXAMPLE;
    let flown = paper.reproduction.figure(Fit::Own, figure)?;
    let metrics = &flown.simulation.result(controller)?.metrics;
    let step = |index: usize| {
        let edge = metrics.edges.get(index)?;
        let (rise_s, overshoot_pct) =
            (measured(edge.step.rise_time_s, 2), measured(edge.step.overshoot_pct, 1));
        Some(Step { rise_s, overshoot_pct })
    };
    let size =
        |index: usize| metrics.edges.get(index).map(|edge| (edge.to_rad - edge.from_rad).abs());
    let (small, large) = (size(0)?, size(2)?);
    let alone =
        |size_rad: f64| alone(paper, figure, controller, fspid_scenario::units::degrees(size_rad));
    let (alone_small, alone_large) = (alone(small)?, alone(large)?);
    let rise = |index: usize| metrics.of_step(index, |step| step.rise_time_s).ok();
    let share = |first: f64, later: f64, alone: f64| {
        (first > later).then(|| 100.0 * (first - alone) / (first - later))
    };
    let share_pct = share(rise(0)?, rise(2)?, alone_large.ok()?);
    let mut laws: Vec<&'static str> = paper
        .reproduction
        .figures
        .iter()
        .flat_map(|flown| {
            flown.study.scenario.controllers.iter().filter_map(|named| law(&named.controller))
        })
        .collect();
    laws.sort();
    laws.dedup();
    Some(Memory {
        figure,
        memoryless: laws == ["memoryless"],
        laws,
        first: step(0)?,
        down: step(1)?,
        later: step(2)?,
        alone_small: measured(alone_small, 2),
        alone_large: measured(alone_large, 2),
        ratio: significant(large / small, 2),
        mostly: share_pct.is_some_and(|share| share > 50.0),
        share_pct: share_pct.map(|share| fixed(share, 0)),
    })
}

/// The law of a self-tuning controller.
fn law(controller: &Controller) -> Option<&'static str> {
    match controller {
        Controller::SelfTuning(fspid) => Some(fspid.tuner().settings().law.name()),
        Controller::Fixed(_) => None,
    }
}

/// Rise time of one step of this size from rest, with nothing before it.
fn alone(paper: &Paper<'_>, figure: &str, controller: &str, size_deg: f64) -> Option<Measured> {
    let step = format!("setpoint={{kind=\"step\",amplitude_deg={size_deg:?},at_s=1.0}}");
    let study = paper.library.study(&format!("own/figure-{figure}.toml"), &[step]).ok()?;
    let simulation = Simulation::of_window(&study).ok()?;
    let of = |step: &StepMetrics| step.rise_time_s;
    Some(simulation.result(controller)?.metrics.of_step(0, of))
}

/// Claims that do not stand, with their status.
#[derive(Serialize)]
struct Failed {
    id: &'static str,
    what: &'static str,
    status: String,
    class: &'static str,
}

fn failed(reproduction: &Reproduction) -> Vec<Failed> {
    let entry = |id, what, status: Status| Failed {
        id,
        what,
        status: super::status(status).text,
        class: status.name(),
    };
    let numbers = reproduction.claims.iter().map(|j| entry(j.claim.id, j.claim.quantity, j.status));
    let words = reproduction.statements.iter().map(|j| entry(j.id, j.paper, j.status));
    numbers.chain(words).filter(|failed| failed.class != Status::Reproduced.name()).collect()
}
