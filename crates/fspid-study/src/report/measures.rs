//! Tables of measures: one row for each controller and each step of the command.

use super::traces::fails;
use crate::metrics::{EdgeMetrics, FlightMetrics, METRICS, Metric, StepMetrics};
use crate::simulation::{ControllerResult, Simulation};
use fspid_diagnostics::digits::without_zeros;
use fspid_page::number;
use fspid_page::page::{Cell, PageTable, TableRow};
use fspid_scenario::measure::Measure;
use fspid_scenario::units::degrees;

/// A measure that is shown.
struct Column {
    metric: &'static Metric,
    /// Its heading with the unit.
    heading: String,
    decimals: usize,
}

impl Column {
    fn of(metric: &'static Metric) -> Option<Self> {
        let (heading, decimals) = metric.shown?;
        Some(Self { metric, heading: format!("{heading} [{}]", metric.unit), decimals })
    }

    /// The measures of steps, or those of whole flights.
    fn all(are_of_steps: bool) -> Vec<Self> {
        let kind = METRICS.iter().filter(|metric| metric.is_of_step() == are_of_steps);
        kind.filter_map(Self::of).collect()
    }

    fn of_step(&self, step: &StepMetrics) -> Option<Cell> {
        self.metric.of_step(step).map(|value| Cell::measured(value, self.decimals))
    }

    fn of_flight(&self, flight: &FlightMetrics) -> Cell {
        Cell::measured(self.metric.of_flight(flight), self.decimals)
    }
}

/// Headings of these columns behind some others.
fn head<'a>(before: &[&'a str], columns: &'a [Column]) -> Vec<&'a str> {
    before.iter().copied().chain(columns.iter().map(|it| it.heading.as_str())).collect()
}

/// What stands before the measures of a step.
const OF_A_STEP: [&str; 2] = ["controller", "step of the command"];

/// More steps than these would bury the rest of a report.
const MOST_STEPS: usize = 40;

/// What the paper speaks of.
const OF_THE_PAPER: [Measure; 4] =
    [Measure::RiseTime, Measure::Overshoot, Measure::SettlingTime, Measure::FinalError];

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
fn rows(result: &ControllerResult, columns: &[Column]) -> Vec<TableRow> {
    let measures = |step: &StepMetrics| -> Vec<Cell> {
        columns.iter().filter_map(|column| column.of_step(step)).collect()
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
    let columns = Column::all(true);
    let mut table = PageTable::new(caption, &head(&OF_A_STEP, &columns)).in_cards();
    for result in &simulation.results {
        table.rows.extend(rows(result, &columns));
    }
    table
}

/// What the paper measures, under two fits or variants side by side; both fly the same controllers
/// and steps.
pub fn side_by_side(caption: &str, variants: &[(&str, &Simulation)], only: &[&str]) -> PageTable {
    let columns: Vec<Column> =
        OF_THE_PAPER.iter().filter_map(|it| Column::of(Metric::asked_as(*it)?)).collect();
    let mut head = OF_A_STEP.to_vec();
    let mut groups = vec![("", 2)];
    for (name, _) in variants {
        head.extend(self::head(&[], &columns));
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
    let columns = Column::all(false);
    let mut head = head(&["controller"], &columns);
    head.extend(["samples cut by limits", "faults"]);
    let mut table = PageTable::new(caption, &head).in_cards();
    for result in &simulation.results {
        let metrics = &result.metrics;
        let mut cells = vec![Cell::text(&result.name)];
        if fails(result) {
            let reason = format!("\u{2717} {}: no measures", metrics.verdict);
            cells.push(Cell::failing(reason, columns.len()));
        } else {
            cells.extend(columns.iter().map(|column| column.of_flight(metrics)));
        }
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
