//! A summary for a terminal.

use fspid_diagnostics::lines;
use fspid_page::columns::{self, Align, Columns};

use super::above_chance::AboveChance;
use super::data::{
    Bad, ControllerSummary, Extreme, Head, MeasureSummary, QuantileSummary, RequirementSummary,
    Sensitivity, SensitivityTarget, Severity, Summary,
};
use super::words::{number, percent, whole};

/// Widest line, in characters, as long as names are not very long.
const WIDTH: usize = 100;
/// Longest name of a measure or parameter in a table, in characters: three of them and four numbers fit into a line.
const NAME: usize = 22;
/// What the columns are.
const LEGEND: &str = "without: flights that do not have the measure. share: of the variance, what the \
    parameter explains alone, where it is 1 % at least and above chance, for all shares of a controller together. rank: Spearman's \
    correlation. run: number of the flight with the worst value.";
/// What stands where there is nothing.
const NOTHING: &str = "\u{2013}";

/// A summary in lines of at most some hundred characters.
#[must_use]
pub fn text(summary: &Summary) -> String {
    let mut lines = head(&summary.head);
    for controller in &summary.controllers {
        lines.push(String::new());
        lines.extend(of_controller(controller, summary.head.confidence));
    }
    lines.push(String::new());
    lines.push("Notes".to_owned());
    lines.extend(wrapped(LEGEND, "- "));
    lines.extend(summary.notes.iter().flat_map(|note| wrapped(&note.to_string(), "- ")));
    let mut text = lines.join("\n");
    text.push('\n');
    text
}

fn head(head: &Head) -> Vec<String> {
    let short = |digest: &str| digest.chars().take(12).collect::<String>();
    let mut lines = vec![head.scenario.clone().unwrap_or_else(|| "a campaign".to_owned())];
    lines.extend(head.incomplete().map(|incomplete| format!("  {incomplete}")));
    lines.push(format!(
        "  {} runs, {} sampling, seed {}; flown by {}",
        whole(head.runs),
        head.sampling.name(),
        head.seed,
        head.program
    ));
    let digest = head.digest.map(|digest| digest.to_string());
    let digest = digest.map_or_else(
        || "each part has its digest".to_owned(),
        |digest| format!("digest of the rows {}", short(&digest)),
    );
    lines.push(format!("  campaign {}, {digest}", short(&head.campaign)));
    if !head.changes.is_empty() {
        lines.extend(wrapped(&format!("changed: {}", head.changes.join(", ")), "  "));
    }
    let sure = percent(head.confidence);
    lines.push(format!("  Intervals in brackets hold the truth with {sure} confidence."));
    lines
}

fn of_controller(controller: &ControllerSummary, confidence: f64) -> Vec<String> {
    let mut lines = vec![controller.name.clone()];
    let failed = controller.failed.in_words(confidence);
    lines.push(match controller.is_judged() {
        true => format!("  fails {failed}"),
        false if controller.is_aircraft_judged() => format!(
            "  nothing is required of it but of the aircraft; not settled, failed by itself, or that is not met: {failed}"
        ),
        false => format!("  nothing is required of it; not settled, or failed by itself: {failed}"),
    });
    let verdicts: Vec<String> = controller
        .verdicts
        .iter()
        .map(|count| format!("{} {}", count.verdict, whole(count.flights)))
        .collect();
    lines.extend(wrapped(&verdicts.join(", "), "  "));
    if controller.undecided > 0 {
        lines.push(format!("  stability at rest undecided: {}", whole(controller.undecided)));
    }
    if controller.refused.count > 0 {
        lines.push(format!("  refused {}", controller.refused.in_words(confidence)));
    }
    lines.extend(requirements(&controller.requirements, confidence));
    let (values, others): (Vec<_>, Vec<_>) =
        controller.measures.iter().partition(|measure| requirement_of(&measure.name).is_some());
    lines.extend(measures("measure", &others));
    lines.extend(measures("requirement", &values));
    let (values, others): (Vec<_>, Vec<_>) =
        controller.sensitivities.iter().partition(|it| match &it.of {
            SensitivityTarget::Failure => false,
            SensitivityTarget::Measure(name) => requirement_of(name).is_some(),
        });
    let above = AboveChance::of(controller);
    lines.extend(sensitivities("measure", &others, above));
    lines.extend(sensitivities("requirement", &values, above));
    if above.asked > 0 {
        lines.extend([String::new(), format!("  {}", above.in_words())]);
    }
    lines.extend(failed_runs(controller));
    lines
}

fn requirements(requirements: &[RequirementSummary], confidence: f64) -> Vec<String> {
    let asked: Vec<_> = requirements.iter().filter(|it| it.not_met.of > 0).collect();
    if asked.is_empty() {
        return Vec::new();
    }
    let mut table = Columns::new(&[
        ("requirement", Align::Left),
        ("required", Align::Left),
        ("not met", Align::Left),
        ("worst", Align::Right),
        ("run", Align::Right),
    ]);
    for requirement in asked {
        let [worst, run] = extreme(requirement.worst);
        let not_met = requirement.not_met.in_words(confidence);
        table.row(vec![cut(&requirement.id), cut(&requirement.required), not_met, worst, run]);
    }
    below(&table)
}

/// An empty line and the table; nothing at all without rows.
fn below(table: &Columns) -> Vec<String> {
    if table.is_empty() {
        return Vec::new();
    }
    format!("\n{table}").lines().map(str::to_owned).collect()
}

fn measures(heading: &str, measures: &[&MeasureSummary]) -> Vec<String> {
    let mut table = Columns::new(&[
        (heading, Align::Left),
        ("without", Align::Right),
        ("mean", Align::Right),
        ("5 %", Align::Right),
        ("median", Align::Right),
        ("95 %", Align::Right),
        ("99 %", Align::Right),
        ("worst", Align::Right),
        ("run", Align::Right),
    ]);
    for measure in measures.iter().filter(|measure| measure.count > 0) {
        let [worst, run] = extreme(worst(measure));
        let mean = measure.moments.map_or_else(nothing, |moments| number(moments.mean));
        let quantile = |share: f64| {
            let found = measure.quantiles.iter().find(|it| it.share.to_bits() == share.to_bits());
            found.map_or_else(nothing, QuantileSummary::in_words)
        };
        table.row(vec![
            cut(short_name(&measure.name)),
            whole(measure.missing + measure.not_finite),
            mean,
            quantile(0.05),
            quantile(0.5),
            quantile(0.95),
            quantile(0.99),
            worst,
            run,
        ]);
    }
    below(&table)
}

/// The worst value, where it is known which side is bad.
fn worst(measure: &MeasureSummary) -> Option<Extreme> {
    match measure.bad? {
        Bad::High => measure.highest.first().copied(),
        Bad::Low => measure.lowest.first().copied(),
    }
}

fn extreme(extreme: Option<Extreme>) -> [String; 2] {
    match extreme {
        Some(Extreme { run, value }) => [number(value), run.to_string()],
        None => [nothing(), nothing()],
    }
}

fn sensitivities(heading: &str, sensitivities: &[&Sensitivity], above: AboveChance) -> Vec<String> {
    let mut table = Columns::new(&[
        (heading, Align::Left),
        ("depends most on", Align::Left),
        ("share", Align::Right),
        ("rank", Align::Right),
        ("then on", Align::Left),
        ("share", Align::Right),
        ("rank", Align::Right),
    ]);
    for sensitivity in sensitivities {
        let name = match &sensitivity.of {
            SensitivityTarget::Failure => "failing",
            SensitivityTarget::Measure(name) => short_name(name),
        };
        let mut row = vec![cut(name)];
        let named = |it| Some((it, above.names(it)?));
        let mut influences: Vec<_> = sensitivity.influences.iter().filter_map(named).collect();
        influences.sort_by(|a, b| b.1.total_cmp(&a.1));
        for (influence, share) in influences.iter().take(2) {
            let rank = influence.correlation.map(|found| rank(found.coefficient));
            row.push(cut(&influence.parameter));
            row.push(format!("{:.0} %", 100.0 * share));
            row.push(rank.unwrap_or_else(nothing));
        }
        if row.len() > 1 {
            row.resize(7, String::new());
            table.row(row);
        }
    }
    below(&table)
}

fn rank(coefficient: f64) -> String {
    let text = format!("{coefficient:+.2}");
    text.replace('-', "\u{2212}")
}

fn failed_runs(controller: &ControllerSummary) -> Vec<String> {
    if controller.failed_runs.is_empty() {
        return Vec::new();
    }
    let order = "  failed runs: diverged first, ground, unstable, range, refused, requirements not met, not settled";
    let mut lines = vec![String::new(), order.to_owned()];
    for failed in &controller.failed_runs {
        let reasons = match (failed.reasons.as_str(), failed.severity) {
            ("", severity) => severity.name(),
            (reasons, _) => reasons,
        };
        let mark = match failed.severity {
            Severity::Refused => "refused: ",
            _ => "",
        };
        let line = format!("  {:>10}  {mark}{reasons}", failed.run);
        lines.push(shortened(&line, WIDTH));
    }
    lines
}

/// The id of the requirement whose value a column holds.
fn requirement_of(column: &str) -> Option<&str> {
    column.strip_prefix(crate::rows::REQUIREMENT)?.strip_suffix(".value")
}

/// The name of a column below the heading of its table.
fn short_name(column: &str) -> &str {
    requirement_of(column).unwrap_or(column)
}

fn nothing() -> String {
    NOTHING.to_owned()
}

fn cut(name: &str) -> String {
    shortened(name, NAME)
}

/// A text of at most so many characters on one line.
fn shortened(text: &str, most: usize) -> String {
    columns::cut(&text.replace(['\n', '\r', '\t'], " "), most)
}

/// A text in lines, the first of which begins with `mark`, the others as far right.
fn wrapped(text: &str, mark: &str) -> Vec<String> {
    lines::wrapped(text, mark, WIDTH)
}
