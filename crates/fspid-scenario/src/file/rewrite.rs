//! A scenario written anew: with one controller, one requirement, one plant or frozen gains.
//!
//! Every number is written with the shortest digits that read back as the same bits.

use fspid_core::{Gains, PidConfig, SetpointWeights};
use fspid_sim::ElevatorSign;

use crate::file::extra::Extra;
use crate::file::files::Files;
use crate::file::overrides::{self, Change};
use crate::file::spec::SCENARIO;
use crate::file::spec::scenario::{
    CONTEST, CONTROLLER, GLIDE_SLOPE, MODE, OUTER_LOOP, TOTAL_ENERGY, TUNING,
};
use crate::keyed::document::{Item, Member, Value};
use crate::keyed::{Kind, Table};
use crate::requirement::Requirement;
use crate::toml_text::{key, quoted};
use fspid_diagnostics::{Report, Span};

/// What is left of a scenario in a replay.
pub struct Replay<'a> {
    /// The one requirement.
    pub requirement: &'a Requirement,
    /// Name of the one controller; all of them for the aircraft alone.
    pub controller: Option<&'a str>,
    /// Gains that it is frozen at, and everything of it but its gains.
    pub frozen: Option<(Gains<f64>, PidConfig<f64>)>,
    /// The one plant: 0 for the first, otherwise the number of its change.
    pub plant: Option<usize>,
    /// Size of the one step of its command, deg, where it has a flight of its own: of the pitch loop without the autopilot
    /// around it.
    pub own_step_deg: Option<f64>,
    /// Sign of the first plant's elevator, which changes have where they say none.
    pub sign: ElevatorSign,
}

/// The text of a scenario with what comes from outside, cut down to a replay. Paths of files are written as `moved`
/// says. `None` for a text that is no scenario.
pub fn replay(
    text: &str,
    extra: &Extra<'_>,
    replay: &Replay<'_>,
    moved: &dyn Fn(&str) -> String,
) -> Option<String> {
    let (mut report, mut files) = (Report::default(), Files::new(None));
    // The requirement is written out; those of sets and files are not needed.
    let extra = Extra { overrides: extra.overrides, ..Extra::default() };
    let (document, _) = super::changed_document(&mut report, &mut files, text, &extra)?;
    let Value::Table(mut members) = document.value else {
        return None;
    };
    if let Some(plant) = replay.plant {
        keep_plant(&mut members, plant, replay.sign);
    }
    let kept = keep_controller(&mut members, replay);
    let listed = |change: &Change| {
        // A frozen controller has no supervisor any more.
        let is_gone = replay.frozen.is_some() && change.path.contains(".supervisor.")
            || replay.own_step_deg.is_some() && is_of_autopilot(&change.path);
        let path = path_now(&change.path, replay.plant, kept).filter(|_| !is_gone)?;
        Some(item(text_value(&change.text(&path, written))))
    };
    let changes: Vec<Item> = files.changes().filter_map(listed).collect();
    // The others stand in the document by now. Tunings and contests name controllers that are not here any more.
    let is_left_out =
        |name: &str| [overrides::KEY, TUNING.name.as_str(), CONTEST.name.as_str()].contains(&name);
    members.retain(|member| !is_left_out(&member.name));
    if !changes.is_empty() {
        put(&mut members, overrides::KEY, Value::Array(changes));
    }
    put(&mut members, "requirement", Value::Array(vec![requirement(replay)]));
    if let Some(step_deg) = replay.own_step_deg {
        put_own_step(&mut members, step_deg);
    }
    move_paths(&SCENARIO, &mut members, moved);
    let mut out = String::new();
    write_document(&mut out, &members);
    Some(out)
}

const NOWHERE: Span = Span { source: 0, start: 0, end: 0 };

fn item(value: Value) -> Item {
    Item { place: NOWHERE, value }
}

fn text_value(text: &str) -> Value {
    Value::Text(text.to_owned())
}

/// Sets a member, or adds it.
fn put(members: &mut Vec<Member>, name: &str, value: Value) {
    members.retain(|member| member.name != name);
    members.push(Member { name: name.to_owned(), place: NOWHERE, item: item(value) });
}

fn tables_of<'a>(members: &'a [Member], name: &str) -> &'a [Item] {
    let found = members.iter().find(|member| member.name == name);
    match found.map(|member| &member.item.value) {
        Some(Value::Array(items)) => items,
        _ => &[],
    }
}

/// One step at the start in place of the command, and no autopilot, which would command another.
fn put_own_step(members: &mut Vec<Member>, step_deg: f64) {
    members.retain(|member| !is_of_autopilot(&member.name));
    let mut step = Vec::new();
    put(&mut step, "kind", text_value("step"));
    put(&mut step, "amplitude_deg", Value::Float(step_deg));
    put(&mut step, "at_s", Value::Float(0.0));
    put(members, "setpoint", Value::Table(step));
}

/// True for a path that begins with one of the tables of which an autopilot is made. Engine and lateral motion are the
/// aircraft's.
fn is_of_autopilot(path: &str) -> bool {
    let root = path.split(['.', '[']).next();
    let tables = [OUTER_LOOP.name, MODE.name, TOTAL_ENERGY.name, GLIDE_SLOPE.name];
    tables.into_iter().any(|table| Some(table.as_str()) == root)
}

/// Leaves one of the plants, and no change.
fn keep_plant(members: &mut Vec<Member>, plant: usize, sign: ElevatorSign) {
    let change =
        plant.checked_sub(1).and_then(|index| tables_of(members, "plant_change").get(index));
    if let Some(Value::Table(change)) = change.map(|change| change.value.clone()) {
        let mut plant = change;
        plant.retain(|member| !["at_s", "ramp_s"].contains(&member.name.as_str()));
        let has = |name: &str| plant.iter().any(|member| member.name == name);
        if has("numerator") && !has("elevator_sign") {
            let word = match sign {
                ElevatorSign::NoseUpPositive => "nose-up-positive",
                ElevatorSign::NoseDownPositive => "nose-down-positive",
            };
            put(&mut plant, "elevator_sign", text_value(word));
        }
        put(members, "plant", Value::Table(plant));
    }
    members.retain(|member| member.name != "plant_change");
}

/// Where a key stands in the replay that was at `path`; `None` for one that is left out.
fn path_now(path: &str, plant: Option<usize>, controller: Option<usize>) -> Option<String> {
    let moved = |number: usize, list: &str, to: &str| {
        let rest = path.strip_prefix(&format!("{list}[{number}]"))?;
        Some(format!("{to}{rest}"))
    };
    if let (true, Some(number)) = (path.starts_with("controller["), controller) {
        return moved(number, "controller", "controller[0]");
    }
    let of_plant = path.starts_with("plant.");
    match plant {
        Some(0) if path.starts_with("plant_change[") => None,
        Some(0) | None => Some(path.to_owned()),
        Some(_) if of_plant => None,
        Some(number) if path.starts_with("plant_change[") => {
            moved(number - 1, "plant_change", "plant")
        }
        Some(_) => Some(path.to_owned()),
    }
}

/// Leaves one controller, frozen where that is asked for; answers which one it was.
fn keep_controller(members: &mut Vec<Member>, replay: &Replay<'_>) -> Option<usize> {
    let meant = replay.controller?;
    let is_name = |member: &Member| {
        member.name == "name" && matches!(&member.item.value, Value::Text(name) if name == meant)
    };
    let is_meant = |item: &Item| match &item.value {
        Value::Table(members) => members.iter().any(is_name),
        _ => false,
    };
    let controllers = tables_of(members, "controller");
    let index = controllers.iter().position(is_meant)?;
    let mut controller = controllers.get(index)?.clone();
    if let (Some((gains, config)), Value::Table(keys)) = (replay.frozen, &mut controller.value) {
        freeze(keys, gains, &config);
    }
    put(members, "controller", Value::Array(vec![controller]));
    Some(index)
}

/// A self-tuning controller with its gains held: a PID of the same configuration.
fn freeze(keys: &mut Vec<Member>, gains: Gains<f64>, config: &PidConfig<f64>) {
    let of_pid: Vec<&str> =
        controller_table().keys_of("pid").map(|key| key.name().as_str()).collect();
    keys.retain(|member| of_pid.contains(&member.name.as_str()));
    put(keys, "kind", text_value("pid"));
    // The filter may have been given with gains in ISA form.
    put(keys, "derivative_filter_s", Value::Float(config.derivative.filter_s));
    for (name, gain) in [("kp", gains.kp), ("ki", gains.ki), ("kd", gains.kd)] {
        put(keys, name, Value::Float(gain));
    }
    // Both may go with the gains.
    put(keys, "rate_gain", Value::Float(config.rate_gain_s));
    let SetpointWeights { proportional, derivative } = config.setpoint_weights;
    let mut weights = Vec::new();
    put(&mut weights, "proportional", Value::Float(proportional));
    put(&mut weights, "derivative", Value::Float(derivative));
    put(keys, "setpoint_weights", Value::Table(weights));
}

fn controller_table() -> &'static Table {
    let mut tables = SCENARIO.keys().filter_map(|key| match key.kind() {
        Kind::Tables { table, .. } if key.name() == CONTROLLER.name => Some(*table),
        _ => None,
    });
    // The specification has a list of controllers; without one nothing would be kept.
    tables.next().unwrap_or(&SCENARIO)
}

/// The requirement as a file has it.
fn requirement(replay: &Replay<'_>) -> Item {
    let asked = replay.requirement;
    let mut members = Vec::new();
    put(&mut members, "id", text_value(&asked.id));
    put(&mut members, "measure", text_value(asked.measure.name()));
    let limits = [("least", asked.least), ("most", asked.most)];
    for (name, number) in limits.into_iter().chain(asked.conditions.numbers()) {
        if let Some(number) = number {
            put(&mut members, name, Value::Float(number));
        }
    }
    let origin = &asked.origin;
    let words = [
        ("air", asked.conditions.air.map(|air| air.name())),
        ("clause", origin.clause.as_deref()),
        ("source", origin.source.as_deref()),
        ("confidence", origin.confidence.map(|confidence| confidence.name())),
        ("note", origin.note.as_deref()),
        ("controller", replay.controller),
    ];
    for (name, word) in words {
        if let Some(word) = word {
            put(&mut members, name, text_value(word));
        }
    }
    item(Value::Table(members))
}

/// Writes every path of a file as it is from the new place.
fn move_paths(spec: &'static Table, members: &mut [Member], moved: &dyn Fn(&str) -> String) {
    let kind = kind_of(members).to_owned();
    for member in members {
        let Some(key) = spec.keys_of(&kind).find(|key| key.name().as_str() == member.name) else {
            continue;
        };
        match (key.kind(), &mut member.item.value) {
            (Kind::Path, Value::Text(path)) => *path = moved(path),
            (Kind::Rules { names, .. }, Value::Text(path)) if !names().contains(&path.as_str()) => {
                *path = moved(path);
            }
            (Kind::Table(table), Value::Table(members)) => move_paths(table, members, moved),
            (Kind::Tables { table, .. }, Value::Array(items)) => {
                for item in items {
                    if let Value::Table(members) = &mut item.value {
                        move_paths(table, members, moved);
                    }
                }
            }
            _ => {}
        }
    }
}

fn kind_of(members: &[Member]) -> &str {
    let kind = members.iter().find(|member| member.name == "kind");
    match kind.map(|member| &member.item.value) {
        Some(Value::Text(kind)) => kind,
        _ => "",
    }
}

/// Members in the order of their specification, the kind first.
fn in_order(spec: &'static Table, members: &[Member]) -> Vec<Member> {
    let place = |name: &str| match name {
        "kind" => Some(0),
        name => spec
            .keys_of(kind_of(members))
            .position(|key| key.name().as_str() == name)
            .map(|at| at + 1),
    };
    let mut ordered = members.to_vec();
    ordered.sort_by_key(|member| place(&member.name).unwrap_or(usize::MAX));
    ordered
}

fn write_document(out: &mut String, members: &[Member]) {
    let members = in_order(&SCENARIO, members);
    let is_table = |member: &&Member| match &member.item.value {
        Value::Table(_) => true,
        Value::Array(items) => items.iter().any(|item| matches!(item.value, Value::Table(_))),
        _ => false,
    };
    for member in members.iter().filter(|member| !is_table(member)) {
        write_line(out, member);
    }
    for member in members.iter().filter(is_table) {
        let spec =
            SCENARIO.keys().find(|key| key.name().as_str() == member.name).map(|key| key.kind());
        match (&member.item.value, spec) {
            (Value::Table(table), Some(Kind::Table(spec))) => {
                out.push_str(&format!("\n[{}]\n", key(&member.name)));
                in_order(spec, table).iter().for_each(|member| write_line(out, member));
            }
            (Value::Array(items), Some(Kind::Tables { table: spec, .. })) => {
                for item in items {
                    out.push_str(&format!("\n[[{}]]\n", key(&member.name)));
                    if let Value::Table(table) = &item.value {
                        in_order(spec, table).iter().for_each(|member| write_line(out, member));
                    }
                }
            }
            _ => write_line(out, member),
        }
    }
}

fn write_line(out: &mut String, member: &Member) {
    out.push_str(&format!("{} = {}\n", key(&member.name), written(&member.item.value)));
}

/// A value in one line.
pub(crate) fn written(value: &Value) -> String {
    match value {
        Value::Text(text) => quoted(text),
        Value::Integer(_, Some(exact)) => exact.to_string(),
        Value::Integer(number, None) | Value::Float(number) => format!("{number:?}"),
        Value::Boolean(boolean) => boolean.to_string(),
        // No key of a scenario holds a date, so that the check has refused it.
        Value::Date => quoted(""),
        Value::Array(items) => {
            let items: Vec<String> = items.iter().map(|item| written(&item.value)).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Table(members) => {
            let member = |member: &Member| {
                format!("{} = {}", key(&member.name), written(&member.item.value))
            };
            let members: Vec<String> = members.iter().map(member).collect();
            format!("{{ {} }}", members.join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_written_so_that_toml_reads_it_back() {
        let hostile = "a\"b\\c\nd\te\r\u{1b}\u{7f}\u{85}ä=[{,";
        for value in [
            text_value(hostile),
            Value::Float(0.1 + 0.2),
            Value::Float(-1e-300),
            Value::Float(5.0),
            Value::Integer(7.0, Some(7)),
            Value::Boolean(true),
            Value::Array(vec![item(Value::Float(1.0)), item(Value::Float(-2.5))]),
        ] {
            let line = format!("x = {}", written(&value));
            let read: toml::Table = line.parse().unwrap_or_else(|error| panic!("{line}: {error}"));
            match value {
                Value::Text(text) => assert_eq!(read["x"].as_str(), Some(text.as_str())),
                Value::Float(number) => assert_eq!(read["x"].as_float(), Some(number)),
                Value::Integer(_, exact) => assert_eq!(read["x"].as_integer(), exact),
                Value::Boolean(boolean) => assert_eq!(read["x"].as_bool(), Some(boolean)),
                _ => assert_eq!(read["x"].as_array().map(Vec::len), Some(2)),
            }
        }
    }

    #[test]
    fn a_nested_table_is_written_in_one_line() {
        let inner =
            vec![Member { name: "a b".to_owned(), place: NOWHERE, item: item(text_value("c")) }];
        let read: toml::Table =
            format!("x = {}", written(&Value::Table(inner))).parse().expect("TOML");
        assert_eq!(read["x"]["a b"].as_str(), Some("c"));
    }
}
