//! Maps of failures over the parameters that matter most.

use fspid_page::analysis::{Chapter, Item, Picture};
use fspid_plot::{
    IntervalColumn, IntervalFigure, IntervalMark, IntervalRow, RunScatter, ShareCell, ShareMap,
};
use fspid_scenario::dispersion::Distribution;
use fspid_scenario::measure::Measure;

use super::by_parameter::{ByParameter, Counted, Counts, Event, counted, pairs};
use super::distributions::value_at;
use super::words::{count, cut, number};
use super::{Source, style};
use crate::rows::REQUIREMENT;
use crate::statistics::binomial::clopper_pearson;
use crate::summary::{
    ControllerSummary, Influence, Parameter, Sensitivity, SensitivityTarget, SummaryError,
};
use crate::table::Kind;

/// Most parameters of maps, each pair of which has one.
const MOST_PARAMETERS: usize = 4;
/// The same where more than two controllers have maps: pages shall stay small.
const FEW_PARAMETERS: usize = 3;
/// Most controllers with maps: those that failed most often.
const MOST_CONTROLLERS: usize = 4;
/// Fewest and most boxes along a parameter.
const BOXES: [usize; 2] = [4, 9];
/// Runs that a box shall hold if all hold the same.
const RUNS_OF_A_BOX: f64 = 25.0;

/// The chapter; none where nothing that could be mapped was drawn.
///
/// # Errors
/// A file that cannot be read.
pub(super) fn chapter(source: &Source<'_>) -> Result<Option<Chapter>, SummaryError> {
    let chapter = |title: &str, items| {
        Some(Chapter { id: "maps".to_owned(), title: title.to_owned(), items })
    };
    let said = |text: &str| chapter("Where flights fail", vec![Item::Text(text.to_owned())]);
    let Some(what) = What::of(source) else {
        return Ok(said(
            "There is nothing to map: of each controller either no flight failed or every one did, and there is no measure to look at instead.",
        ));
    };
    let parameters = parameters(source, &what);
    if parameters.is_empty() {
        return Ok(said("There is no map: no parameter is a number."));
    }
    let bins = boxes(source.summary.head.runs);
    let all = source.summary.controllers.len();
    let Some(counted) = counted(source.files, &parameters, &what.event, (all, bins))? else {
        return Ok(said("There is no map: a parameter does not differ from run to run."));
    };
    let maps = Maps { source, parameters: &parameters, counted: &counted, what: &what };
    Ok(chapter(what.title(), items(&maps)))
}

/// What is mapped, and in which words.
struct What {
    event: Event,
    /// What it depends on is asked of this.
    target: SensitivityTarget,
    /// Controllers that have maps.
    shown: Vec<usize>,
    /// "failed": what counted flights did.
    did: String,
    /// What the others did.
    did_not: String,
    /// The same in a sentence.
    sentence: String,
}

impl What {
    /// Failing where some flights failed and others did not; else the worst twentieth of the first requirement's
    /// values, or of the overshoot.
    fn of(source: &Source<'_>) -> Option<Self> {
        let shown = controllers(source);
        if !shown.is_empty() {
            return Some(Self {
                event: Event::Failed,
                target: SensitivityTarget::Failure,
                shown,
                did: "failed".to_owned(),
                did_not: "did not fail".to_owned(),
                sentence: "Where in the range of the parameters flights fail.".to_owned(),
            });
        }
        Self::worst_of(source)
    }

    const fn title(&self) -> &'static str {
        match self.event {
            Event::Failed => "Where flights fail",
            Event::Beyond { .. } => "Where the worst flights lie",
        }
    }

    /// "failed" or "are of the highest 5 %": a verb in either case.
    fn are(&self) -> String {
        match self.event {
            Event::Failed => self.did.clone(),
            Event::Beyond { .. } => format!("are {}", self.did),
        }
    }

    fn worst_of(source: &Source<'_>) -> Option<Self> {
        let first = source.summary.controllers.first()?;
        let required = first
            .requirements
            .iter()
            .map(|it| (format!("{REQUIREMENT}{}.value", it.id), it.limits.most.is_some()));
        let choices = required.chain([(Measure::Overshoot.name().to_owned(), true)]);
        choices.into_iter().find_map(|(column, above)| {
            let share = if above { 0.95 } else { 0.05 };
            let limit = |it: &ControllerSummary| {
                let measure = it.measures.iter().find(|it| it.name == column)?;
                let moments = measure.moments?;
                let spread = moments.maximum > moments.minimum;
                value_at(measure, share).filter(|_| spread)
            };
            let limits: Vec<f64> = source
                .summary
                .controllers
                .iter()
                .map(|it| limit(it).unwrap_or(f64::NAN))
                .collect();
            let there = limits.iter().enumerate().filter(|(_, limit)| limit.is_finite());
            let shown: Vec<usize> = there.map(|(n, _)| n).take(MOST_CONTROLLERS).collect();
            let words = cut(&column.replace(REQUIREMENT, "").replace(".value", ""), 60);
            let which = if above { "highest" } else { "lowest" };
            (!shown.is_empty()).then(|| Self {
                event: Event::Beyond { column: column.clone(), limits, above },
                target: SensitivityTarget::Measure(column.clone()),
                shown,
                did: format!("of the {which} 5 %"),
                did_not: "others".to_owned(),
                sentence: format!(
                    "No controller had both flights that failed and flights that did not. Instead: where the flights with the {which} 5 % of {words} lie, each controller by itself."
                ),
            })
        })
    }
}

/// Controllers of which some flights failed and others not, the most failures first.
fn controllers(source: &Source<'_>) -> Vec<usize> {
    let all = source.summary.controllers.iter().enumerate();
    let mut found: Vec<(u64, usize)> = all
        .filter(|(_, it)| it.failed.count > 0 && it.failed.count < it.failed.of)
        .map(|(n, it)| (it.failed.count, n))
        .collect();
    found.sort_by_key(|(failed, n)| (std::cmp::Reverse(*failed), *n));
    found.truncate(MOST_CONTROLLERS);
    let mut places: Vec<usize> = found.into_iter().map(|(_, n)| n).collect();
    places.sort_unstable();
    places
}

/// Parameters that are numbers, those first that what is mapped depends on most.
fn parameters(source: &Source<'_>, what: &What) -> Vec<String> {
    let head = source.summary.head.parameters.iter();
    // A seed is a number whose size means nothing.
    let is_seed = |it: &&Parameter| it.meaning.ends_with(&Distribution::Seed.to_string());
    let numeric = head.filter(|it| matches!(it.kind, Kind::Float | Kind::Integer) && !is_seed(it));
    let mut found: Vec<(f64, &str)> =
        numeric.map(|it| (influence(source, what, &it.name), it.name.as_str())).collect();
    // A stable sort: of equal ones the first in the scenario stays first.
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let most = if what.shown.len() > 2 { FEW_PARAMETERS } else { MOST_PARAMETERS };
    found.into_iter().take(most).map(|(_, name)| name.to_owned()).collect()
}

/// How much depends on a parameter, of all controllers together.
fn influence(source: &Source<'_>, what: &What, parameter: &str) -> f64 {
    let of = |it: &Sensitivity| it.of == what.target;
    let sensitivities = source
        .summary
        .controllers
        .iter()
        .flat_map(|it| it.sensitivities.iter().filter(|it| of(it)));
    let influences = sensitivities.flat_map(|it| &it.influences);
    influences.filter(|it| it.parameter == parameter).map(strength).sum()
}

/// The larger of share and squared rank correlation: the one sees bends, the other is surer with few runs.
fn strength(it: &Influence) -> f64 {
    let share = it.share.map_or(0.0, |share| share.fraction);
    let rank = it.correlation.map_or(0.0, |rank| rank.coefficient * rank.coefficient);
    [share, rank].into_iter().filter(|it| it.is_finite()).fold(0.0, f64::max)
}

fn boxes(runs: u64) -> usize {
    ((runs as f64 / RUNS_OF_A_BOX).sqrt() as usize).clamp(BOXES[0], BOXES[1])
}

/// Everything that the figures of the chapter need.
struct Maps<'a> {
    source: &'a Source<'a>,
    parameters: &'a [String],
    counted: &'a Counted,
    what: &'a What,
}

fn items(maps: &Maps<'_>) -> Vec<Item> {
    let mut items = vec![Item::Text(format!(
        "{} Parameters, the one that it depends on most first: {}. Boxes with few runs say little; their number stands in them.",
        maps.what.sentence,
        maps.parameters.iter().map(|name| cut(name, 60)).collect::<Vec<_>>().join(", ")
    ))];
    if maps.what.shown.len() < maps.source.summary.controllers.len() {
        let names: Vec<String> = maps.what.shown.iter().map(|n| maps.source.name(*n)).collect();
        items.push(Item::Text(format!(
            "Maps are drawn for {}; of the others fewer flights count, or none, or all.",
            names.join(", ")
        )));
    }
    let alone = (0..maps.parameters.len().min(2)).map(|n| maps.alone(n)).collect();
    items.push(Item::Figures(alone));
    let mut further = Vec::new();
    let pairs = pairs(maps.parameters.len());
    for controller in &maps.what.shown {
        let Some(of) = maps.counted.of.get(*controller) else { continue };
        for (n, pair) in pairs.iter().enumerate() {
            let map = maps.map(*controller, of, n, *pair);
            match n {
                0 => items.push(Item::Figures(vec![maps.scatter(*controller, of), map])),
                _ => further.push(map),
            }
        }
    }
    if !further.is_empty() {
        let title = format!("{} maps of other pairs of parameters", further.len());
        items.push(Item::Fold(title, vec![Item::Figures(further)]));
    }
    items
}

impl Maps<'_> {
    fn label(&self, parameter: usize) -> String {
        self.parameters.get(parameter).map_or_else(String::new, |name| cut(name, 80))
    }

    fn ends(&self, parameter: usize) -> (f64, f64) {
        self.counted.ends.get(parameter).copied().unwrap_or((0.0, 1.0))
    }

    fn edges(&self, parameter: usize, bins: usize) -> Vec<f64> {
        let (lo, hi) = self.ends(parameter);
        (0..=bins).map(|n| lo + (hi - lo) * n as f64 / bins as f64).collect()
    }

    /// The largest share in a box of any controller's map of a pair: maps that are compared have one scale.
    fn most_pct(&self, pair: usize) -> Option<f64> {
        let maps =
            self.what.shown.iter().filter_map(|n| self.counted.of.get(*n)?.together.get(pair));
        let boxes = maps.flatten().flatten().filter(|counts| counts.all > 0);
        boxes.map(|it| 100.0 * it.failed as f64 / it.all as f64).reduce(f64::max)
    }

    /// Failures over one parameter, with intervals.
    fn alone(&self, parameter: usize) -> Picture {
        let confidence = self.source.summary.head.confidence;
        let of = |n: &usize| Some((*n, self.counted.of.get(*n)?.alone.get(parameter)?));
        let lists: Vec<(usize, &Vec<Counts>)> = self.what.shown.iter().filter_map(of).collect();
        let bins = lists.first().map_or(1, |(_, list)| list.len());
        let edges = self.edges(parameter, bins);
        let row = |bin: usize| {
            let mark = |(n, list): &(usize, &Vec<Counts>)| {
                let counts = list.get(bin).filter(|counts| counts.all > 0)?;
                let ends = clopper_pearson(counts.failed, counts.all, confidence).ok()?;
                let value = 100.0 * counts.failed as f64 / counts.all as f64;
                let [lower, upper] = ends.map(|end| 100.0 * end);
                Some(IntervalMark { column: 0, style: style(*n), value, lower, upper })
            };
            let runs = lists.first().and_then(|(_, list)| list.get(bin)).map_or(0, |it| it.all);
            IntervalRow {
                name: format!("{} to {}", number(edges[bin]), number(edges[bin + 1])),
                words: format!("of {}", count(runs)),
                marks: lists.iter().filter_map(mark).collect(),
            }
        };
        let label = self.label(parameter);
        let figure = IntervalFigure {
            title: format!("Flights over {label}"),
            columns: vec![IntervalColumn {
                label: format!("share of the flights that {} [%]", self.what.are()),
                ..IntervalColumn::default()
            }],
            // The largest values on top, as on an ordinate.
            rows: (0..bins).rev().map(row).collect(),
            series: lists.iter().map(|(n, _)| (self.source.name(*n), style(*n))).collect(),
            width_px: 560.0,
        };
        let caption = format!(
            "Share of the flights that {} where {label} lies between two values, with {} intervals.",
            self.what.are(),
            super::words::percent(confidence)
        );
        Picture { name: format!("failing-over-{parameter}"), svg: figure.render(), caption }
    }

    fn scatter(&self, controller: usize, of: &ByParameter) -> Picture {
        let name = self.source.name(controller);
        let counts = of.alone.first().map_or(&[][..], Vec::as_slice).iter();
        let (failed, all) = counts.fold((0, 0), |sum, it| (sum.0 + it.failed, sum.1 + it.all));
        let most = super::by_parameter::MOST_PASSED - of.failed.len();
        let passed: Vec<(f64, f64)> = of.passed.iter().copied().take(most).collect();
        let shown = |points: usize, of: u64, what: &str| match points as u64 == of {
            true => format!("{} {what}", count(of)),
            false => format!("{} {what}, the first {}", count(of), count(points as u64)),
        };
        let mut runs = of.runs.clone();
        runs[0].truncate(passed.len());
        let figure = RunScatter {
            runs,
            title: format!("Runs of {name}"),
            x_label: self.label(0),
            y_label: self.label(1),
            ranges: [Some(self.ends(0)), Some(self.ends(1))],
            names: [
                shown(passed.len(), all - failed, &self.what.did_not),
                shown(of.failed.len(), failed, &self.what.did),
            ],
            passed,
            failed: of.failed.clone(),
        };
        let mut caption = format!("{name}: runs over the two parameters that it depends on most.");
        if of.failed.len() as u64 != failed || figure.passed.len() as u64 != all - failed {
            // Those that failed are drawn first, so that none is missed that could be shown.
            caption.push_str(" Not all are drawn, and of those that count more than of the others: how dense they are says nothing of shares.");
        }
        Picture { name: format!("runs-{controller}"), svg: figure.render(), caption }
    }

    fn map(
        &self,
        controller: usize,
        of: &ByParameter,
        n: usize,
        (a, b): (usize, usize),
    ) -> Picture {
        let name = self.source.name(controller);
        let grid = of.together.get(n).map_or(&[][..], Vec::as_slice);
        let bins = grid.len();
        let cell = |counts: &Counts| ShareCell { runs: counts.all, counted: counts.failed };
        let figure = ShareMap {
            title: format!("Share of the flights of {name} that {}", self.what.are()),
            x_label: self.label(a),
            y_label: self.label(b),
            quantity: format!("flights that {}", self.what.are()),
            most_pct: self.most_pct(n),
            x_edges: self.edges(a, bins),
            y_edges: self.edges(b, bins),
            cells: grid.iter().map(|row| row.iter().map(cell).collect()).collect(),
        };
        let caption = format!(
            "{name}: share of the flights that {}, over {} and {}, of the runs in each box.",
            self.what.are(),
            self.label(a),
            self.label(b)
        );
        Picture { name: format!("map-{controller}-{n}"), svg: figure.render(), caption }
    }
}
