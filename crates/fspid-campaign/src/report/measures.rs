//! Which measures stand first, and what they are called.

use super::Source;
use super::words::{axis_label, capital, cut};
use crate::rows::REQUIREMENT;
use crate::summary::{Limits, MeasureSummary};
use fspid_scenario::measure::{Measure as Asked, label};

/// Measures that every reader looks for, in this order; requirements' values follow.
const FIRST: [&str; 7] = [
    Asked::Overshoot.name(),
    Asked::SettlingTime.name(),
    Asked::RiseTime.name(),
    Asked::ErrorIntegral.name(),
    Asked::ElevatorTravel.name(),
    Asked::ElevatorRate.name(),
    Asked::FinalError.name(),
];

/// A measure of all controllers.
pub(super) struct Measure<'a> {
    /// Name of its column.
    pub(super) name: &'a str,
    /// The measure of each controller that has values, with the controller's place.
    pub(super) of: Vec<(usize, &'a MeasureSummary)>,
    /// Title of its figures.
    pub(super) title: String,
    /// What stands below its figure, without the full stop.
    pub(super) caption: String,
    /// Name of its axis.
    pub(super) axis: String,
    /// Limits on it with their words.
    pub(super) limits: Vec<(Limits, String)>,
    /// True for those that stand first.
    pub(super) is_main: bool,
}

/// All measures, the main ones first.
pub(super) fn all<'a>(source: &Source<'a>) -> Vec<Measure<'a>> {
    let Some(first) = source.summary.controllers.first() else { return Vec::new() };
    let mut found: Vec<Measure<'a>> =
        first.measures.iter().enumerate().map(|(place, it)| of(source, place, it)).collect();
    let rank = |measure: &Measure<'_>| {
        let listed = FIRST.iter().position(|name| *name == measure.name);
        (!measure.is_main, listed.unwrap_or(FIRST.len()))
    };
    found.sort_by_key(rank);
    found
}

fn of<'a>(source: &Source<'a>, place: usize, first: &'a MeasureSummary) -> Measure<'a> {
    let name = first.name.as_str();
    let controllers = source.summary.controllers.iter().enumerate();
    let of = controllers.filter_map(|(n, it)| Some((n, it.measures.get(place)?)));
    let judged = judged(source, name);
    let base = judged.as_ref().map_or(name, |it| it.0.as_str());
    let words = capital(&label(base, &first.unit));
    let title = match &judged {
        // What is judged has a name of its own, and is the worst case where there are several.
        Some((_, id)) => format!("{words}, as judged by {id}"),
        None => words.clone(),
    };
    let caption = match &judged {
        Some((_, id)) => {
            format!("{words}, the worst case of each flight, as the requirement {id} judges it")
        }
        None => format!("{words}: {}", meaning(source, place, first)),
    };
    // The same measure as a main one needs no second figure beside it.
    let is_twin = judged.as_ref().is_some_and(|(base, _)| FIRST.contains(&base.as_str()));
    let limits = limits(source, base);
    Measure {
        name,
        of: of.filter(|(_, it)| it.count > 0).collect(),
        title: cut(&title, 120),
        caption,
        axis: axis_label(&cut(&label(base, &first.unit), 80), &first.unit),
        is_main: (FIRST.contains(&name) || judged.is_some() || !limits.is_empty()) && !is_twin,
        limits,
    }
}

/// What a measure means; one that refers to the one before it says it itself.
fn meaning(source: &Source<'_>, place: usize, measure: &MeasureSummary) -> String {
    let before = source.summary.controllers.first().and_then(|it| {
        it.measures.get(place.checked_sub(1)?).map(|before| before.meaning.as_str())
    });
    match (measure.meaning.strip_prefix("the same,"), before) {
        (Some(rest), Some(before)) => format!("{before},{rest}"),
        _ => measure.meaning.clone(),
    }
}

/// The measure and the id of the requirement whose value a column holds.
fn judged(source: &Source<'_>, column: &str) -> Option<(String, String)> {
    let id = column.strip_prefix(REQUIREMENT)?.strip_suffix(".value")?;
    let mut all = source.summary.controllers.iter().flat_map(|it| &it.requirements);
    let found = all.find(|requirement| requirement.id == id)?;
    let base = if found.measure.is_empty() { found.id.clone() } else { found.measure.clone() };
    Some((base, found.id.clone()))
}

/// Limits on a measure, each once.
fn limits(source: &Source<'_>, measure: &str) -> Vec<(Limits, String)> {
    let mut found: Vec<(Limits, String)> = Vec::new();
    for requirement in source.summary.controllers.iter().flat_map(|it| &it.requirements) {
        let asked = (requirement.limits, requirement.required.clone());
        if requirement.measure == measure && !found.contains(&asked) {
            found.push(asked);
        }
    }
    found
}
