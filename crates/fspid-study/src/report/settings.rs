//! Every setting that a flight had, whether its file gave it or a default filled it in.

use fspid_fuzzy::{Grid, Label, RuleTable};
use fspid_sim::Scenario;

use super::debug::Node;
use super::number;
use super::page::{Cell, Table};
use crate::units::degrees;

/// Parts that are computed from others or shown elsewhere.
const LEFT_OUT: [&str; 5] = ["consequents", "sets", "spacing", "name", "controllers"];

/// One setting.
#[derive(Clone, Debug, PartialEq)]
struct Setting {
    path: String,
    value: String,
}

/// The settings of the aircraft, the loop and the command.
pub(super) fn of_flight(scenario: &Scenario) -> Table {
    table("Aircraft, servo, samples, command and disturbances.", &Node::of(scenario))
}

/// The settings of each controller with its name.
pub(super) fn of_controllers(scenario: &Scenario) -> Vec<Table> {
    let one = |named: &fspid_sim::NamedController| {
        table(&format!("Controller {}.", named.name), &Node::of(&named.controller))
    };
    scenario.controllers.iter().map(one).collect()
}

fn table(caption: &str, node: &Node) -> Table {
    let mut settings = Vec::new();
    collect("", node, &mut settings);
    let mut table = Table::new(caption, &["setting", "value"]);
    for Setting { path, value } in settings {
        table.push(vec![Cell::text(path), Cell::text(value)]);
    }
    table
}

fn collect(path: &str, node: &Node, out: &mut Vec<Setting>) {
    match node {
        Node::Struct(name, fields) => {
            // A variant with fields says which one it is; a plain structure is named by its path.
            let leaf = path.rsplit(' ').next().unwrap_or_default();
            if VARIANTS.contains(&leaf) {
                push(path, &words(name), out);
            }
            for (field, node) in
                fields.iter().filter(|(field, _)| !LEFT_OUT.contains(&field.as_str()))
            {
                collect(&joined(path, field), node, out);
            }
        }
        Node::Tuple(name, fields) => match fields.as_slice() {
            [one] => {
                if !name.is_empty() && !WRAPPERS.contains(&name.as_str()) {
                    push(&joined(path, "kind"), &words(name), out);
                }
                collect(path, one, out);
            }
            many => many
                .iter()
                .enumerate()
                .for_each(|(n, node)| collect(&format!("{path} {}", n + 1), node, out)),
        },
        Node::List(items) if items.iter().all(|item| matches!(item, Node::Word(_))) => {
            let values: Vec<String> = items.iter().map(|item| value(path, item)).collect();
            let text = if values.is_empty() { "none".to_owned() } else { values.join(", ") };
            push(path, &text, out);
        }
        Node::List(items) => {
            items
                .iter()
                .enumerate()
                .for_each(|(n, node)| collect(&format!("{path} {}", n + 1), node, out));
        }
        Node::Text(_) | Node::Word(_) => push(path, &value(path, node), out),
    }
}

/// Wrappers that say nothing.
const WRAPPERS: [&str; 3] = ["Some", "Profile", "Kind"];
/// Fields whose type's name is the choice that was made.
const VARIANTS: [&str; 4] = ["shape", "law", "windup", "kind"];

fn joined(path: &str, field: &str) -> String {
    // These say nothing that the rest does not.
    let silent = ["transfer_function", "coefficients", "shell", "tuner", "settings", "timing"];
    let field = field.replace('_', " ");
    if silent.contains(&field.replace(' ', "_").as_str()) {
        return path.to_owned();
    }
    if path.is_empty() { field } else { format!("{path} {field}") }
}

fn push(path: &str, value: &str, out: &mut Vec<Setting>) {
    let (path, unit) = renamed(path);
    let number = value.starts_with(|c: char| c.is_ascii_digit() || c == '\u{2212}');
    let value =
        if number && !unit.is_empty() { format!("{value} {unit}") } else { value.to_owned() };
    out.push(Setting { path, value });
}

/// Endings of names inside, and the units in which they are shown.
const UNITS: [(&str, &str); 9] = [
    (" per rad", "per deg (supervisor units)"),
    (" rad s", "deg/s"),
    (" rad", "deg"),
    (" per s", "1/s"),
    (" s", "s"),
    (" hz", "Hz"),
    ("guard limit", "deg"),
    ("gains kd", "s"),
    ("nominal kd", "s"),
];

fn renamed(path: &str) -> (String, &'static str) {
    for (ending, unit) in UNITS {
        if let Some(stem) = path.strip_suffix(ending) {
            let kept = if ending.starts_with(' ') { stem } else { path };
            return (plain(kept), unit);
        }
    }
    let unit = if path.ends_with("gains ki") || path.ends_with("nominal ki") { "1/s" } else { "" };
    (plain(path), unit)
}

/// Names inside that say little outside.
const PLAIN: [(&str, &str); 5] = [
    ("dt", "sample period"),
    ("rows", "samples"),
    ("slew", "slew limit of the command"),
    ("limits", "limits of the command"),
    ("anti windup", "anti-windup"),
];

fn plain(path: &str) -> String {
    let named = PLAIN.iter().find(|(name, _)| *name == path);
    named.map_or_else(|| path.to_owned(), |(_, plain)| (*plain).to_owned())
}

/// A value as it is shown: degrees where the inside has radians.
fn value(path: &str, node: &Node) -> String {
    let Some(number) = node.number().filter(|number| !number.is_nan()) else {
        return match node {
            Node::Text(text) => text.clone(),
            Node::Word(word) => words(word),
            _ => String::new(),
        };
    };
    let per = path.ends_with(" per rad");
    let angle = path.ends_with(" rad")
        || path.ends_with(" rad s")
        || path.ends_with("guard limit")
        || path.ends_with("limits lower")
        || path.ends_with("limits upper");
    let gains = path.contains("gain limits");
    let shown = match (per, angle && !gains) {
        (true, _) => number / degrees(1.0),
        (false, true) => degrees(number),
        (false, false) => number,
    };
    if shown.is_infinite() {
        return "no limit".to_owned();
    }
    number::exact(tidy(shown))
}

/// Away with the last digits that the way to radians and back has left.
fn tidy(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}

/// "MeasurementMinusSetpoint" as "measurement minus setpoint".
fn words(name: &str) -> String {
    let mut out = String::new();
    for (at, c) in name.char_indices() {
        if c.is_uppercase() && at > 0 {
            out.push(' ');
        }
        out.extend(c.to_lowercase());
    }
    out
}

/// The rules of a controller's supervisor, read back from its cells.
pub(super) fn rules(controller: &fspid_sim::Controller) -> Option<RuleTable> {
    let node = Node::of(controller);
    let consequents = node.at(&["tuner", "supervisor", "consequents"])?.items().to_vec();
    let grids: Vec<Grid> = consequents.iter().filter_map(grid).collect();
    <[Grid; 3]>::try_from(grids).ok().map(RuleTable::new)
}

/// Cells sorted by label, and where each label's cells end.
fn grid(consequents: &Node) -> Option<Grid> {
    let numbers = |name: &str| -> Option<Vec<usize>> {
        let items = consequents.field(name)?.items();
        items.iter().map(|item| item.number().map(|number| number as usize)).collect()
    };
    let (cells, ends) = (numbers("cells")?, numbers("ends")?);
    let mut rows = [[Label::ZO; 7]; 7];
    for (place, cell) in cells.iter().enumerate() {
        let label = Label::ALL.get(ends.iter().position(|end| place < *end)?)?;
        *rows.get_mut(cell / 7)?.get_mut(cell % 7)? = *label;
    }
    Some(Grid::new(rows))
}

/// What disturbs, in words: "pulse (at 1 s, width 1 s)".
pub(super) fn disturbance_forms(scenario: &Scenario) -> Vec<String> {
    let node = Node::of(scenario);
    let disturbances = node.field("disturbances").map(Node::items).unwrap_or_default();
    disturbances.iter().filter_map(|disturbance| form(disturbance.field("shape")?)).collect()
}

fn form(shape: &Node) -> Option<String> {
    let Node::Struct(name, fields) = shape.inside() else {
        return None;
    };
    let detail = |(field, node): &(String, Node)| {
        let (name, unit) = renamed(&format!(" {}", field.replace('_', " ")));
        format!("{} {} {unit}", name.trim(), value(&name, node)).trim_end().to_owned()
    };
    let details: Vec<String> = fields.iter().map(detail).collect();
    Some(format!("{} ({})", words(name), details.join(", ")))
}

/// The law of a controller's tuner in words; `None` for fixed gains.
pub(super) fn law(controller: &fspid_sim::Controller) -> Option<String> {
    match Node::of(controller).at(&["tuner", "settings", "law"])? {
        Node::Struct(name, _) | Node::Word(name) => Some(words(name)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file;

    #[test]
    fn the_rules_that_fly_are_read_back_exactly() {
        let study =
            file::parse(file::starter(), "starter.toml", None, &[]).expect("the starter is right");
        let fspid = &study.scenario.controllers[1].controller;
        assert_eq!(rules(fspid), file::rule_table("mirrored"));
        assert_eq!(law(fspid).as_deref(), Some("memoryless"));
    }

    #[test]
    fn defaults_are_shown_in_degrees_with_their_units() {
        let study =
            file::parse(file::starter(), "starter.toml", None, &[]).expect("the starter is right");
        let rows = |table: &Table| -> Vec<String> {
            table
                .rows
                .iter()
                .map(|row| format!("{} = {}", row.cells[0].text, row.cells[1].text))
                .collect()
        };
        let flight = rows(&of_flight(&study.scenario));
        assert!(flight.contains(&"setpoint amplitude = 5 deg".to_owned()), "{flight:#?}");
        let tuned = rows(&of_controllers(&study.scenario)[1]);
        assert!(tuned.contains(&"guard limit = 1000000000 deg".to_owned()), "{tuned:#?}");
        assert!(tuned.contains(&"supervisor out of range = clamp".to_owned()), "{tuned:#?}");
        assert!(
            tuned.iter().any(|row| row == "input scale error = 1 per deg (supervisor units)"),
            "{tuned:#?}"
        );
    }

    #[test]
    fn a_disturbance_is_described_by_its_shape_and_times() {
        let text = file::starter().to_owned()
            + "\n[[disturbance]]\nkind = \"pulse\"\nenters_at = \"elevator\"\namplitude_deg = 2.0\nat_s = 1.0\nwidth_s = 0.5\n";
        let study = file::parse(&text, "test.toml", None, &[]).expect("the scenario is right");
        assert_eq!(disturbance_forms(&study.scenario), ["pulse (at 1 s, width 0.5 s)"]);
    }
}
