//! Tables of measures: one row for each controller and each step of the command.

use super::traces::fails;
use crate::metrics::{EdgeMetrics, FlightMetrics, Measured, StepMetrics};
use crate::simulation::{ControllerResult, Simulation};
use fspid_diagnostics::digits::without_zeros;
use fspid_page::number;
use fspid_page::page::{Cell, PageTable, TableRow};
use fspid_scenario::units::degrees;

/// A column: its heading with the unit, decimals, and the measure.
type Column = (&'static str, usize, fn(&StepMetrics) -> Measured);

const COLUMNS: &[Column] = &[
    ("rise time [s]", 3, |step| step.rise_time_s),
    ("settling time [s]", 3, |step| step.settling_time_s),
    ("overshoot [%]", 2, |step| step.overshoot_pct),
    ("undershoot [%]", 2, |step| step.undershoot_pct),
    ("final error [%]", 2, |step| step.final_error_pct),
    ("peak [deg]", 3, |step| step.peak.map(degrees)),
    ("time of peak [s]", 2, |step| step.peak_time_s),
];

/// More steps than these would bury the rest of a report.
const MOST_STEPS: usize = 40;

/// Columns that the paper speaks of.
const OF_THE_PAPER: [usize; 4] = [0, 2, 1, 4];

/// "2, down: +1 to −1 deg at 6.60 s".
pub fn step_name(index: usize, edge: &EdgeMetrics) -> String {
    let way = if edge.to_rad >= edge.from_rad { "up" } else { "down" };
    let (from, to) = (degrees(edge.from_rad), degrees(edge.to_rad));
    let level = |value: f64| without_zeros(&number::fixed(value, 3)).to_owned();
    let (from, to, at_s) = (level(from), level(to), number::fixed(edge.at_s, 2));
    let both = edge.disturbed_in_words();
    format!("{}, {way}: {from} to {to} deg at {at_s} s{both}", index + 1)
}

/// Rows of a flight: one a step, or one that says why there is none.
fn rows(result: &ControllerResult, columns: &[&Column]) -> Vec<TableRow> {
    let measures = |step: &StepMetrics| {
        columns
            .iter()
            .map(|(_, decimals, of)| Cell::measured(of(step), *decimals))
            .collect::<Vec<_>>()
    };
    let metrics = &result.metrics;
    if fails(result) {
        let reason = format!("\u{2717} {}: no measures", metrics.verdict);
        let cells =
            vec![Cell::text(&result.name), Cell::text("all"), Cell::failing(reason, columns.len())];
        return vec![TableRow { class: "first", ..TableRow::from(cells) }];
    }
    if metrics.edges.is_empty() {
        let mut cells = vec![Cell::text(&result.name), Cell::text("no step in the command")];
        cells.extend(measures(&metrics.first_step()));
        return vec![TableRow { class: "first", ..TableRow::from(cells) }];
    }
    let row = |(index, edge): (usize, &EdgeMetrics)| {
        let mut cells = vec![Cell::text(&result.name), Cell::text(step_name(index, edge))];
        cells.extend(measures(&edge.step));
        TableRow { class: if index == 0 { "first" } else { "" }, ..TableRow::from(cells) }
    };
    let shown = metrics.edges.iter().enumerate().take(MOST_STEPS);
    let mut rows: Vec<TableRow> = shown.map(row).collect();
    let left_out = metrics.edges.len().saturating_sub(MOST_STEPS);
    if left_out > 0 {
        let reason =
            format!("{left_out} more steps: `fspid simulate --format json` lists them all");
        let name = Cell::text(&result.name);
        rows.push(TableRow::from(vec![
            name,
            Cell::text("and"),
            Cell::left_out(reason, columns.len()),
        ]));
    }
    rows
}

/// Every step measure of every controller.
pub fn table(caption: &str, simulation: &Simulation) -> PageTable {
    let columns: Vec<&Column> = COLUMNS.iter().collect();
    let mut head = vec!["controller", "step of the command"];
    head.extend(columns.iter().map(|column| column.0));
    let mut table = PageTable::new(caption, &head).in_cards();
    for result in &simulation.results {
        table.rows.extend(rows(result, &columns));
    }
    table
}

/// What the paper measures, under two fits or variants side by side; both fly the same controllers
/// and steps.
pub fn side_by_side(caption: &str, variants: &[(&str, &Simulation)], only: &[&str]) -> PageTable {
    let columns: Vec<&Column> =
        OF_THE_PAPER.iter().filter_map(|index| COLUMNS.get(*index)).collect();
    let mut head = vec!["controller", "step of the command"];
    let mut groups = vec![("", 2)];
    for (name, _) in variants {
        head.extend(columns.iter().map(|column| column.0));
        groups.push((name, columns.len()));
    }
    let mut table = PageTable::new(caption, &head).grouped(&groups).in_cards();
    let Some((_, first)) = variants.first() else {
        return table;
    };
    for result in
        first.results.iter().filter(|r| only.is_empty() || only.contains(&r.name.as_str()))
    {
        let mut rows = rows(result, &columns);
        for (_, other) in variants.iter().skip(1) {
            let others = other
                .result(&result.name)
                .map(|result| self::rows(result, &columns))
                .unwrap_or_default();
            // A failed flight has one row for all steps: it says so on each.
            for (index, row) in rows.iter_mut().enumerate() {
                let other = others.get(index).or_else(|| others.first());
                row.cells.extend(other.iter().flat_map(|row| row.cells.iter().skip(2).cloned()));
            }
        }
        table.rows.extend(rows);
    }
    table
}

/// Integrals and effort of whole flights.
pub fn integrals(caption: &str, simulation: &Simulation) -> PageTable {
    let head = [
        "controller",
        "IAE [deg s]",
        "ITAE [deg s²]",
        "ISE [deg² s]",
        "ITSE [deg² s²]",
        "command variation [deg]",
        "largest command [deg]",
        "fastest command [deg/s]",
        "samples cut by limits",
        "faults",
    ];
    let mut table = PageTable::new(caption, &head).in_cards();
    for result in &simulation.results {
        let FlightMetrics { integrals, effort, .. } = &result.metrics;
        let mut cells = vec![Cell::text(&result.name)];
        if fails(result) {
            cells.push(Cell::failing(
                format!("\u{2717} {}: no measures", result.metrics.verdict),
                7,
            ));
            cells.extend(tail(result));
            table.push(cells);
            continue;
        }
        let squared = |value: f64| degrees(degrees(value));
        cells.extend([
            Cell::measured(integrals.map(|i| degrees(i.iae_rad_s)), 4),
            Cell::measured(integrals.map(|i| degrees(i.itae_rad_s2)), 4),
            Cell::measured(integrals.map(|i| squared(i.ise_rad2_s)), 4),
            Cell::measured(integrals.map(|i| squared(i.itse_rad2_s2)), 4),
            Cell::measured(effort.map(|e| degrees(e.variation_rad)), 3),
            Cell::measured(effort.map(|e| degrees(e.largest_rad)), 3),
            Cell::measured(effort.map(|e| degrees(e.fastest_rad_s)), 2),
        ]);
        cells.extend(tail(result));
        table.push(cells);
    }
    table
}

/// What is known of a failed flight too.
fn tail(result: &ControllerResult) -> [Cell; 2] {
    let faults = result.trace.faults;
    let faults = if faults.is_empty() { "none".to_owned() } else { faults.to_string() };
    [Cell::number(result.trace.saturated_samples.to_string()), Cell::text(faults)]
}
