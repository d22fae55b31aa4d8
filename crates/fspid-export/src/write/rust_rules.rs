//! The rules of a supervisor in Rust.

use fspid_core::fuzzy::{
    Defuzzifier, Label, Network, NumberTable, Output, RuleTable, Supervisor, SupervisorNumbers,
};
use fspid_numeric::Real;

use super::rust_text::{Number, item, list};

pub(super) fn supervisor<R: Real>(number: Number, supervisor: &Supervisor<R>) -> String {
    let parts = parts(number, supervisor.parts());
    let (head, rules) = match (supervisor.numbers(), supervisor.table()) {
        _ if let Some(weights) = supervisor.network() => {
            ("Supervisor::of_network_unchecked", network(number, weights))
        }
        (Some(numbers), _) => ("Supervisor::of_numbers_unchecked", number_table(number, numbers)),
        (None, table) => {
            // Rules that conclude no numbers conclude labels.
            let table = table.unwrap_or_else(fspid_core::paper::rules);
            ("Supervisor::new_unchecked", format!("&{}", label_table(&table)))
        }
    };
    let inner = format!("{rules},\n{parts},").replace('\n', "\n    ");
    let made = format!("{head}(\n    {inner}\n)");
    if rules.starts_with('&') {
        format!("{{\n    {LABELS}\n    {}\n}}", made.replace('\n', "\n    "))
    } else {
        made
    }
}

const LABELS: &str = "use fspid_core::fuzzy::Label::*;";

fn parts<R: Real>(number: Number, parts: SupervisorNumbers<R>) -> String {
    let SupervisorNumbers { sets, range, spacing, defuzzifier, out_of_range } = parts;
    let sets: Vec<String> = sets.iter().map(|set| reals(number, set)).collect();
    let defuzzifier = match defuzzifier {
        Defuzzifier::Exact => "Exact".to_owned(),
        Defuzzifier::Endpoints(n) => format!("Endpoints({n})"),
        Defuzzifier::Midpoint(n) => format!("Midpoint({n})"),
        Defuzzifier::Trapezoid(n) => format!("Trapezoid({n})"),
        Defuzzifier::LeftEnd(n) => format!("LeftEnd({n})"),
        Defuzzifier::Vertices(n) => format!("Vertices({n})"),
    };
    item(
        "SupervisorNumbers",
        &[
            ("sets", list(&sets)),
            ("range", number.positive(range)),
            ("spacing", number.positive(spacing)),
            ("defuzzifier", format!("Defuzzifier::{defuzzifier}")),
            ("out_of_range", format!("OutOfRange::{out_of_range:?}")),
        ],
    )
}

fn reals<R: Real>(number: Number, values: &[R]) -> String {
    let values: Vec<String> = values.iter().map(|value| number.of(*value)).collect();
    format!("[{}]", values.join(", "))
}

/// Grids in rows, so that they look as they do in a scenario.
fn grids(rows: impl Fn(Output) -> Vec<String>, open: &str, close: &str) -> String {
    let grid = |output| {
        let rows: Vec<String> =
            rows(output).iter().map(|row| format!("        {row},\n")).collect();
        format!("    {open}[\n{}    ]{close},\n", rows.concat())
    };
    format!("[\n{}]", Output::ALL.map(grid).concat())
}

fn label_table(table: &RuleTable) -> String {
    let row = |output, error| {
        let labels = Label::ALL.map(|change| table.grid(output).at(error, change).name());
        format!("[{}]", labels.join(", "))
    };
    let rows = |output| Label::ALL.iter().map(|error| row(output, *error)).collect();
    format!("RuleTable::new({})", grids(rows, "Grid::new(", ")"))
}

fn network<R: Real>(number: Number, network: &Network<R>) -> String {
    let rows: Vec<String> =
        network.rows().iter().map(|row| format!("    {},\n", reals(number, row))).collect();
    format!("Network::new_unchecked([\n{}])", rows.concat())
}

fn number_table<R: Real>(number: Number, table: &NumberTable<R>) -> String {
    let rows = |output| table.grid(output).iter().map(|row| reals(number, row)).collect();
    format!("NumberTable::new_unchecked({})", grids(rows, "", ""))
}
