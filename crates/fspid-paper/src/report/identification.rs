//! How the unpublished parameters were found.

use crate::report::templates::render;
use serde::Serialize;

use crate::identify::{ProblemRecord, SeedRecord};
use crate::report::Paper;
use fspid_page::context;
use fspid_page::number::significant;
use fspid_page::page::{Cell, PageSection, PageTable};

/// A parameter that moves by more than this between seeds of nearly equal cost is not determined.
const DETERMINED: f64 = 0.1;
/// Seeds that come this near the best, or reach costs this small, count as equally good.
const NEARLY_EQUAL: f64 = 1.05;
const AS_GOOD_AS_ZERO: f64 = 1e-6;

#[derive(Serialize)]
struct FitView {
    name: String,
    runs: PageTable,
    parameters: PageTable,
    seeds: usize,
    loose: Vec<String>,
}

/// The record of the searches.
pub(super) fn section(paper: &Paper<'_>) -> PageSection {
    let record = &paper.reproduction.record;
    let fits: Vec<FitView> =
        record.problems.iter().filter(|p| !p.name.contains("tuned")).map(problem).collect();
    let tuned = record.problems.iter().filter(|p| p.name.contains("tuned"));
    let several = record.problems.iter().any(|problem| problem.runs.len() > 1);
    let context =
        context! { command => record.command, fits, tuned => tuned_table(tuned), several };
    PageSection::of(
        "identification",
        "How the parameters were found",
        render("identification", context),
    )
}

fn problem(of: &ProblemRecord) -> FitView {
    let mut runs =
        PageTable::new(format!("{}: seeds.", of.name), &["seed", "cost", "evaluations", "kept"]);
    for run in &of.runs {
        runs.push(vec![
            Cell::text(run.seed.to_string()),
            Cell::number(significant(run.cost, 3)),
            Cell::number(run.evaluations.to_string()),
            Cell::text(if run.seed == of.kept { "\u{2713} kept" } else { "" }),
        ]);
    }
    FitView {
        parameters: parameters(of),
        name: of.name.clone(),
        runs,
        seeds: of.runs.len(),
        loose: loose(of),
    }
}

/// The kept parameters with their units, and their spread where there are several seeds.
fn parameters(of: &ProblemRecord) -> PageTable {
    let several = of.runs.len() > 1;
    let (caption, head) = if several {
        (
            "the kept parameters, and their spread over all seeds",
            &["parameter", "kept", "lowest", "highest", "unit"][..],
        )
    } else {
        ("the kept parameters", &["parameter", "kept", "unit"][..])
    };
    let mut table = PageTable::new(format!("{}: {caption}.", of.name), head);
    let kept = of.runs.iter().find(|run| run.seed == of.kept);
    for (index, (name, (low, high))) in of.parameters.iter().zip(of.spread()).enumerate() {
        let value = kept.and_then(|run| run.point.get(index)).copied().unwrap_or(f64::NAN);
        let mut cells = vec![Cell::text(numbered(&of.parameters, index))];
        let spread = if several { vec![value, low, high] } else { vec![value] };
        cells.extend(spread.into_iter().map(|value| Cell::number(significant(value, 4))));
        cells.push(Cell::text(unit(name)));
        table.push(cells);
    }
    table
}

/// The name of a parameter; those of several figures that are searched together are numbered.
fn numbered(names: &[String], index: usize) -> String {
    let Some(name) = names.get(index) else {
        return String::new();
    };
    let same = |names: &[String]| names.iter().filter(|other| *other == name).count();
    match (same(names), names.get(..index).map(same)) {
        (2.., Some(before)) => format!("{name}, figure {}", before + 1),
        _ => name.clone(),
    }
}

/// Units of the parameters by the beginnings and ends of their names.
fn unit(name: &str) -> &'static str {
    let word = |part: &str| name.split(' ').any(|word| word == part);
    match name {
        "error_scale" => "1/deg",
        "change_scale" => "s/deg",
        "rate_gain" | "half_period_s" => "s",
        _ if word("ki") => "1/s",
        _ if word("kd") => "s",
        _ => "",
    }
}

/// Parameters that seeds of about equal cost put at different places.
fn loose(of: &ProblemRecord) -> Vec<String> {
    let best = of.runs.iter().map(|run| run.cost).fold(f64::INFINITY, f64::min);
    let good: Vec<&SeedRecord> = of
        .runs
        .iter()
        .filter(|run| run.cost <= (best * NEARLY_EQUAL).max(AS_GOOD_AS_ZERO))
        .collect();
    if good.len() < 2 {
        return Vec::new();
    }
    let is_loose = |index: usize| {
        let values = || good.iter().filter_map(|run| run.point.get(index).copied());
        let (low, high) =
            values().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        high - low > DETERMINED * low.abs().max(high.abs())
    };
    let names = of.parameters.iter().enumerate().filter(|(index, _)| is_loose(*index));
    names.map(|(_, name)| name.clone()).collect()
}

fn tuned_table<'a>(problems: impl Iterator<Item = &'a ProblemRecord>) -> PageTable {
    let head =
        ["search", "seeds", "lowest cost", "highest cost", "evaluations in all", "kept seed"];
    let mut table =
        PageTable::new("Controllers tuned against the disturbances of Fig. 7.", &head).in_cards();
    for problem in problems {
        let costs = || problem.runs.iter().map(|run| run.cost);
        let spent: usize = problem.runs.iter().map(|run| run.evaluations).sum();
        table.push(vec![
            Cell::text(problem.name.trim_start_matches("Fig. 7, ")),
            Cell::number(problem.runs.len().to_string()),
            Cell::number(significant(costs().fold(f64::INFINITY, f64::min), 4)),
            Cell::number(significant(costs().fold(f64::NEG_INFINITY, f64::max), 4)),
            Cell::number(spent.to_string()),
            Cell::number(problem.kept.to_string()),
        ]);
    }
    table
}
