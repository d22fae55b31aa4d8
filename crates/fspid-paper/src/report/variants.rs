//! The same flights with another rule table, and with another tool's centroid.

use crate::report::templates::render;
use fspid_sim::Controller;

use crate::report::Paper;
use crate::{FIGURES, Fit, FlownFigure};
use fspid_page::context;
use fspid_page::number::fixed;
use fspid_page::page::{Figure, PageSection, PageTable};
use fspid_plot::{LineFigure, LinePanel, Series, SeriesStyle};
use fspid_scenario::units::degrees;
use fspid_study::report::measures;
use fspid_study::simulation::Simulation;

/// Figures whose printed and mirrored flights are drawn.
const DRAWN: [&str; 2] = ["8a", "8b"];
/// The key that the first variant changes, and its value.
const MIRRORED: (&str, &str) = ("table", "mirrored");
/// MATLAB's centroid: 101 samples, both ends included.
const SAMPLED: (&str, &str) = ("defuzzifier", "endpoints:101");

/// A figure as it is stored and as it flies with one thing changed.
struct Pair<'a> {
    stored: &'a FlownFigure,
    changed: Simulation,
    tuned: Vec<&'a str>,
}

/// What depends on the rule table and on the centroid.
pub(super) fn section(paper: &Paper<'_>) -> PageSection {
    let mirrored = pairs(paper, MIRRORED);
    let sampled = pairs(paper, SAMPLED);
    let figures: Vec<Figure> = mirrored
        .iter()
        .filter(|pair| DRAWN.contains(&pair.stored.figure.id))
        .map(drawing)
        .collect();
    let context = context! {
        figures,
        mirrored => table("FSPID under its own fit when only the rule table is changed.", "mirrored", &mirrored),
        mirrored_most => most(&mirrored),
        sampled_most => most(&sampled),
        sampled => table(
            "FSPID under its own fit when only the centroid is changed, to 101 samples with both ends.",
            "endpoints:101",
            &sampled,
        ),
    };
    PageSection::of("variants", "Other rule table, other centroid", render("variants", context))
        .with_figures(figures)
}

fn pairs<'a>(paper: &Paper<'a>, change: (&str, &str)) -> Vec<Pair<'a>> {
    let pair = |id: &str| {
        let stored = paper.reproduction.figure(Fit::Own, id)?;
        let changed = fly(paper, stored, change)?;
        let tuned = tuned(stored).map(|(_, name)| name).collect();
        Some(Pair { stored, changed, tuned })
    };
    FIGURES.iter().filter_map(|figure| pair(figure.id)).collect()
}

/// Index and name of every self-tuning controller.
fn tuned(flown: &FlownFigure) -> impl Iterator<Item = (usize, &str)> {
    let controllers = flown.study.scenario.controllers.iter().enumerate();
    controllers.filter_map(|(index, named)| match named.controller {
        Controller::SelfTuning(_) => Some((index, named.name.as_str())),
        Controller::Fixed(_) => None,
    })
}

fn fly(paper: &Paper<'_>, flown: &FlownFigure, (key, value): (&str, &str)) -> Option<Simulation> {
    let set = |(index, _): (usize, &str)| format!("controller[{index}].supervisor.{key}={value}");
    let overrides: Vec<String> = tuned(flown).map(set).collect();
    let name = format!("{}/figure-{}.toml", flown.fit.name(), flown.figure.id);
    let study = paper.library.study(&name, &overrides).ok()?;
    Simulation::of_window(&study).ok()
}

/// The rise time that changes most, in words.
fn most(pairs: &[Pair<'_>]) -> Option<String> {
    let mut most: Option<(f64, String)> = None;
    for pair in pairs {
        for name in &pair.tuned {
            let edges = |simulation: &Simulation| {
                let result = simulation.result(name);
                result.map_or_else(Vec::new, |result| result.metrics.edges.clone())
            };
            let both = edges(&pair.stored.simulation).into_iter().zip(edges(&pair.changed));
            for (index, (stored, changed)) in both.enumerate() {
                let (Ok(before), Ok(after)) = (stored.step.rise_time_s, changed.step.rise_time_s)
                else {
                    continue;
                };
                let change = libm::fabs(libm::log(after / before));
                if most.as_ref().is_none_or(|(largest, _)| change > *largest) {
                    let (figure, step) = (pair.stored.figure.id, index + 1);
                    let (before, after) = (fixed(before, 3), fixed(after, 3));
                    most = Some((
                        change,
                        format!("Fig. {figure}, {name}, step {step}: {before} to {after} s"),
                    ));
                }
            }
        }
    }
    most.map(|(_, words)| words)
}

/// All figures in one table, the figure named with the controller.
fn table(caption: &str, changed: &str, pairs: &[Pair<'_>]) -> PageTable {
    let mut all = PageTable::default();
    for pair in pairs {
        let variants = [("as stored", &pair.stored.simulation), (changed, &pair.changed)];
        let mut one = measures::side_by_side(caption, &variants, &pair.tuned);
        for row in &mut one.rows {
            if let Some(cell) = row.cells.first_mut() {
                cell.text = format!("Fig. {}, {}", pair.stored.figure.id, cell.text);
            }
        }
        if all.head.is_empty() {
            all = one;
        } else {
            all.rows.append(&mut one.rows);
        }
    }
    all
}

fn drawing(pair: &Pair<'_>) -> Figure {
    let id = pair.stored.figure.id;
    let line = |name: &str, style, simulation: &Simulation| {
        let result =
            simulation.results.iter().find(|result| pair.tuned.contains(&result.name.as_str()))?;
        let y = result.trace.theta_rad.iter().copied().map(degrees).collect();
        Some(Series {
            name: name.to_owned(),
            style,
            x: result.trace.time_s.clone(),
            y,
            stairs: false,
        })
    };
    let stored = &pair.stored.simulation;
    let command = stored.results.first().map(|result| Series {
        name: "set-point".to_owned(),
        style: SeriesStyle::Setpoint,
        x: result.trace.time_s.clone(),
        y: result.trace.setpoint_rad.iter().copied().map(degrees).collect(),
        stairs: true,
    });
    let printed = line("FSPID, printed table", SeriesStyle::Numbered(0), stored);
    let mirrored = line("FSPID, mirrored table", SeriesStyle::Numbered(1), &pair.changed);
    let panel = LinePanel {
        y_label: "pitch angle [deg]".to_owned(),
        x_label: "time [s]".to_owned(),
        series: [command, printed, mirrored].into_iter().flatten().collect(),
        ..LinePanel::default()
    };
    let title = format!("Fig. {id}: printed against mirrored rule table");
    let svg = LineFigure { title, panels: vec![panel], width_px: 720.0 }.render();
    let caption =
        format!("Fig. {id}, FSPID under the figure's own fit: only the rule table differs.");
    Figure::new(format!("variant-{id}-mirrored"), svg, caption).resting_on(&["A14"])
}
