//! Fig. 7: who resists disturbances better, and by how much.

use crate::report::templates::render;
use fspid_sim::Controller;
use serde::Serialize;

use crate::Library;
use crate::disturbance::{
    CONTROLLERS, Contest, ENTRIES, SHAPES, SIZES_DEG, START_S, Sweep, VARIATION_WEIGHT,
    scenario_name,
};
use crate::report::Paper;
use fspid_page::context;
use fspid_page::number::{capital, exact, fixed, significant};
use fspid_page::page::{Cell, Figure, PageSection, PageTable, TableRow};
use fspid_plot::{RatioFigure, Series, SeriesStyle};
use fspid_scenario::file::Study;
use fspid_study::report::settings;
use fspid_study::report::traces::Drawing;
use fspid_study::simulation::Simulation;

/// A comparison: who, over whom, and what it is called.
pub(super) struct Match {
    of: usize,
    over: usize,
    pub(super) name: &'static str,
    slug: &'static str,
}

/// The comparisons that are shown.
pub(super) const MATCHES: [Match; 3] = [
    Match {
        of: 1,
        over: 0,
        name: "FSPID over CPID with the same nominal gains",
        slug: "same-gains",
    },
    Match { of: 1, over: 2, name: "FSPID over a re-tuned CPID", slug: "retuned-cpid" },
    Match { of: 3, over: 2, name: "both tuned with the same effort", slug: "both-tuned" },
];

/// Place of entry of the time responses that are shown.
const SHOWN_AT: &str = "elevator";

impl Match {
    /// Its outcome for a shape.
    pub(super) fn contest(&self, sweeps: &[Sweep], shape: &str) -> Contest {
        Contest::of(sweeps, shape, self.of, self.over)
    }
}

/// The flight of a disturbance scenario at its stored size.
pub(in crate::report) struct StoredFlight {
    /// Name of its traces.
    pub(in crate::report) name: String,
    study: Study,
    pub(in crate::report) simulation: Simulation,
}

/// The disturbance scenarios at their stored size.
pub(in crate::report) fn flights(library: &Library) -> Vec<StoredFlight> {
    let mut flights = Vec::new();
    for shape in SHAPES {
        for entry in ENTRIES {
            let flown = library.study(&scenario_name(shape, entry), &[]).ok().and_then(|study| {
                Simulation::of_window(&study).ok().map(|simulation| (study, simulation))
            });
            if let Some((study, simulation)) = flown {
                let name = format!("disturbance-{shape}-{entry}");
                flights.push(StoredFlight { name, study, simulation });
            }
        }
    }
    flights
}

#[derive(Serialize)]
struct Shape {
    name: &'static str,
    title: String,
    form: String,
    verdicts: Vec<String>,
    ratios: Vec<Figure>,
    response: Option<Figure>,
}

/// Fig. 7.
pub(super) fn section(paper: &Paper<'_>) -> PageSection {
    let sweeps = &paper.reproduction.sweeps;
    let flights = flights(paper.library);
    let shapes: Vec<Shape> = SHAPES
        .iter()
        .map(|shape| Shape {
            name: shape,
            title: capital(shape),
            form: form(shape, &flights),
            verdicts: MATCHES.iter().map(|of| verdict(of, sweeps, shape)).collect(),
            ratios: MATCHES.iter().map(|of| ratio(of, sweeps, shape)).collect(),
            response: flights.iter().find_map(|flown| response(shape, flown)),
        })
        .collect();
    let figures = shapes.iter().flat_map(|s| s.ratios.iter().chain(&s.response).cloned()).collect();
    let context = context! {
        shapes,
        outcome => outcome(sweeps),
        gains => gains(&flights),
        weight => exact(VARIATION_WEIGHT),
        start => exact(START_S),
        // What A16 says of a change after a first run holds for the pulse only.
        replaced => shapes.iter().any(|shape| shape.name == "abrupt" && shape.form.contains("pulse")),
        sizes => SIZES_DEG.len(),
        smallest => exact(SIZES_DEG.iter().copied().fold(f64::INFINITY, f64::min)),
        largest => exact(SIZES_DEG.iter().copied().fold(0.0, f64::max)),
        cases => SIZES_DEG.len() * ENTRIES.len(),
        budget => budget(paper),
    };
    PageSection::of("disturbances", "Figure 7: disturbances", render("disturbances", context))
        .with_figures(figures)
}

/// The form of a shape as its scenario has it.
fn form(shape: &str, flights: &[StoredFlight]) -> String {
    let named =
        flights.iter().find(|flown| flown.name.starts_with(&format!("disturbance-{shape}-")));
    named.map_or_else(String::new, |flown| {
        settings::disturbance_forms(&flown.study.settings).join(" and ")
    })
}

/// Who wins, in words: the geometric mean decides, the count qualifies.
pub(super) fn verdict(of: &Match, sweeps: &[Sweep], shape: &str) -> String {
    let Contest { won, cases, lowest, mean, highest } = of.contest(sweeps, shape);
    format!(
        "{}: FSPID better in {won} of {cases} cases; its cost is {} on average (geometric mean of the ratio {}, \
         from {} to {}).",
        of.name,
        compared(mean),
        fixed(mean, 3),
        fixed(lowest, 3),
        fixed(highest, 3)
    )
}

/// "14 % lower", "37 % higher", "47 times as high".
pub(super) fn compared(ratio: f64) -> String {
    match ratio {
        ratio if ratio >= 2.0 => format!("{} times as high", significant(ratio, 2)),
        ratio if ratio < 1.0 => format!("{} % lower", fixed(100.0 * (1.0 - ratio), 0)),
        _ => format!("{} % higher", fixed(100.0 * (ratio - 1.0), 0)),
    }
}

fn ratio(of: &Match, sweeps: &[Sweep], shape: &str) -> Figure {
    let line = |(n, sweep): (usize, &Sweep)| Series {
        name: match sweep.entry {
            "measurement" => "at the measured pitch".to_owned(),
            entry => format!("at the {entry}"),
        },
        style: SeriesStyle::Numbered(n),
        x: SIZES_DEG.to_vec(),
        y: sweep.ratios(of.of, of.over).map(|ratio| ratio.unwrap_or(f64::NAN)).collect(),
        stairs: false,
    };
    let series = sweeps.iter().filter(|sweep| sweep.shape == shape).enumerate().map(line).collect();
    let drawn = RatioFigure {
        title: format!("Fig. 7, {shape}: {}", of.name),
        x_label: "size of the disturbance [deg]".to_owned(),
        y_label: "ratio of costs (below 1: FSPID better)".to_owned(),
        series,
        log_x: true,
        log_y: true,
        reference: Some((1.0, "equal cost".to_owned())),
        width_px: 480.0,
    };
    let caption = format!("Cost ratio, {shape} disturbance: {}.", of.name);
    Figure::new(format!("figure-7-{shape}-{}", of.slug), drawn.render(), caption)
}

fn response(
    shape: &str,
    StoredFlight { name, study, simulation }: &StoredFlight,
) -> Option<Figure> {
    if *name != format!("disturbance-{shape}-{SHOWN_AT}") {
        return None;
    }
    let title = format!("Fig. 7, {shape} disturbance at the {SHOWN_AT}");
    let (scenario, only) = (&study.scenario, &CONTROLLERS[..]);
    let drawing =
        Drawing { title: &title, scenario, simulation, only, detailed: false, width_px: 720.0 };
    let caption = format!(
        "Response to the {shape} disturbance entering at the {SHOWN_AT}, at the size of the stored scenario; the \
         set-point stays at zero. From above: pitch angle, command, gains of both FSPIDs.{}",
        drawing.spikes()
    );
    let figure = Figure::new(format!("figure-7-{shape}-response"), drawing.render(), caption);
    Some(figure.resting_on(&["A16", "A17"]))
}

/// Every comparison in numbers.
fn outcome(sweeps: &[Sweep]) -> PageTable {
    let caption = "Ratios of cost over all sizes and places of entry; below 1 the FSPID is better. The mean is geometric.";
    let head = ["disturbance", "comparison", "FSPID better in", "lowest", "mean", "highest"];
    let mut table = PageTable::new(caption, &head).in_cards();
    for shape in SHAPES {
        for of in &MATCHES {
            let Contest { won, cases, lowest, mean, highest } = of.contest(sweeps, shape);
            let mut cells = vec![Cell::text(shape), Cell::text(of.name)];
            cells.push(Cell::number(format!("{won} of {cases}")));
            cells.extend([lowest, mean, highest].map(|ratio| Cell::number(fixed(ratio, 3))));
            table.push(TableRow::from(cells));
        }
    }
    table
}

/// The gains that are compared: the first two are the same everywhere.
fn gains(flights: &[StoredFlight]) -> PageTable {
    let caption = "Gains of the four controllers: fixed, or nominal where the FSPID moves them. Tuned ones were tuned \
                   for each disturbance and place of entry.";
    let mut table =
        PageTable::new(caption, &["controller", "kp", "ki [1/s]", "kd [s]", "gains are"]);
    for (index, StoredFlight { name, study, .. }) in flights.iter().enumerate() {
        for named in &study.scenario.controllers {
            let tuned = named.name.ends_with("tuned");
            if index > 0 && !tuned {
                continue;
            }
            let place = name.trim_start_matches("disturbance-").replace('-', ", ");
            let nominal = named.controller.nominal();
            let title = if tuned { format!("{}: {place}", named.name) } else { named.name.clone() };
            let mut cells = vec![Cell::text(title)];
            cells.extend(
                [nominal.kp, nominal.ki, nominal.kd].map(|gain| Cell::number(significant(gain, 4))),
            );
            cells.push(Cell::text(match named.controller {
                Controller::Fixed(_) => "fixed",
                Controller::SelfTuning(_) => "moved",
            }));
            table.push(cells);
        }
    }
    table
}

/// What each tuned controller was allowed to spend, from the record.
fn budget(paper: &Paper<'_>) -> Option<String> {
    let problems = paper.reproduction.record.problems.iter();
    let tuned = problems.filter(|problem| problem.name.contains("tuned"));
    let spent: Vec<usize> =
        tuned.flat_map(|problem| problem.runs.iter().map(|run| run.evaluations)).collect();
    let (least, most) = (spent.iter().min()?, spent.iter().max()?);
    Some(if least == most { most.to_string() } else { format!("{least} to {most}") })
}
