//! Scenarios at random: parts of all that there are, exchanged, with keys and words of the schema.

use std::path::{Path, PathBuf};

use fspid_scenario::file::{Extra, Template};
use serde_json::Value;
use toml::{Table, Value as Toml};

use super::schema::Schema;
use crate::accepted::{Drawn, SCENARIOS};

const EVERY_KEY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../fspid-scenario/tests/scenarios");
/// What flies: one of them.
const FLYING: [&str; 3] = ["plant", "aircraft", "simulator"];
/// What every scenario has.
const ALWAYS: [&str; 5] = ["schema", "name", "loop", "setpoint", "controller"];
/// Fewer changes than this are tried of a document.
const CHANGES: usize = 13;
/// Longest flight, s.
const LONGEST_S: f64 = 12.0;

/// The documents that scenarios are made of.
pub(super) struct Parts {
    all: Vec<Table>,
}

impl Parts {
    pub(super) fn shipped() -> Self {
        let mut files = Vec::new();
        for folder in [SCENARIOS, EVERY_KEY] {
            walk(Path::new(folder), &mut files);
        }
        files.sort();
        let read = |path: &PathBuf| std::fs::read_to_string(path).ok()?.parse::<Table>().ok();
        let all: Vec<Table> = files.iter().filter_map(read).collect();
        assert!(all.len() > 30, "{} scenarios", all.len());
        Self { all }
    }

    /// One of them, changed in a few places. What makes of a scenario none is taken back, so that most of what is drawn can be
    /// asked, and a few changes come together; `folder` is where its files lie.
    pub(super) fn draw(&self, drawn: &mut Drawn, schema: &Schema, folder: &Path) -> Table {
        let mut document = drawn.one_of(&self.all).clone();
        made_short(&mut document);
        for _ in 0..drawn.below(CHANGES) {
            let mut changed = document.clone();
            match drawn.below(12) {
                0 | 1 => self.exchange(drawn, &mut changed),
                2 => self.exchange_below(drawn, &mut changed),
                3 => leave_out(drawn, &mut changed),
                4 => other_word(drawn, &mut changed, schema),
                5 => one_key_more(drawn, &mut changed, schema),
                _ => self.aim(drawn, &mut changed, schema),
            }
            made_short(&mut changed);
            if is_scenario(&changed, folder) {
                document = changed;
            }
        }
        document
    }

    /// A whole part of another.
    fn exchange(&self, drawn: &mut Drawn, document: &mut Table) {
        let other = drawn.one_of(&self.all);
        let keys: Vec<&String> = other.keys().filter(|key| *key != "schema").collect();
        let key = *drawn.one_of(&keys);
        replace_part(document, key, &other[key]);
    }

    /// One key of a part of another.
    fn exchange_below(&self, drawn: &mut Drawn, document: &mut Table) {
        let key = a_key(drawn, document);
        let others: Vec<&Table> = self.all.iter().filter_map(|it| table(it.get(&key)?)).collect();
        if others.is_empty() {
            return;
        }
        let other = *drawn.one_of(&others);
        let (Some(own), false) = (document.get_mut(&key).and_then(table_mut), other.is_empty())
        else {
            return;
        };
        let names: Vec<&String> = other.keys().collect();
        let name = (*drawn.one_of(&names)).clone();
        own.insert(name.clone(), other[&name].clone());
    }

    /// Any key or word of the schema, wherever it stands: as a document has it that has the key, or as the schema allows.
    fn aim(&self, drawn: &mut Drawn, document: &mut Table, schema: &Schema) {
        let target = *drawn.one_of(&schema.all().iter().collect::<Vec<_>>());
        let (path, word) =
            target.split_once('=').map_or((&**target, None), |it| (it.0, Some(it.1)));
        let steps: Vec<&str> = steps(path).collect();
        let Some(last) = steps.iter().rposition(|step| *step != LIST) else { return };
        let (parent, key) = (&steps[..last], steps[last]);
        // A document without the table that the key belongs to gets all of that part from one that has it.
        if let (Some(top), true) = (parent.first(), below(document, parent).is_none()) {
            let have = self.all.iter().filter(|it| below(it, parent).is_some());
            let have: Vec<&Table> = have.collect();
            if have.is_empty() {
                return;
            }
            replace_part(document, top, &drawn.one_of(&have)[*top]);
        }
        let is_list = steps.len() > last + 1;
        let value = match word {
            Some(word) if is_list => Some(Toml::Array(vec![Toml::String(word.to_owned())])),
            Some(word) => Some(Toml::String(word.to_owned())),
            None => {
                let known = |it: &Table| below(it, parent).and_then(|own| own.get(key).cloned());
                let known: Vec<Toml> = self.all.iter().filter_map(known).collect();
                match known.as_slice() {
                    [] => schema.at(path).into_iter().find_map(|node| value(drawn, node)),
                    _ => Some(drawn.one_of(&known).clone()),
                }
            }
        };
        if let (Some(value), Some(own)) = (value, below_mut(document, parent)) {
            own.insert(key.to_owned(), value);
        }
    }
}

/// What stands for each of a list.
const LIST: &str = "[]";

/// `controller[].kp` as controller, each of the list, kp.
fn steps(path: &str) -> impl Iterator<Item = &str> {
    path.split('.').flat_map(|step| {
        let name = step.trim_end_matches(LIST);
        let lists = (step.len() - name.len()) / LIST.len();
        core::iter::once(name).chain(core::iter::repeat_n(LIST, lists))
    })
}

/// The table at a place, in the first of a list that has it.
fn below<'a>(document: &'a Table, steps: &[&str]) -> Option<&'a Table> {
    let Some((first, rest)) = steps.split_first() else { return Some(document) };
    inside(document.get(*first)?, rest)
}

fn inside<'a>(value: &'a Toml, steps: &[&str]) -> Option<&'a Table> {
    match (value, steps.split_first()) {
        (Toml::Table(table), _) => below(table, steps),
        (Toml::Array(list), Some((&LIST, rest))) => list.iter().find_map(|it| inside(it, rest)),
        _ => None,
    }
}

fn below_mut<'a>(document: &'a mut Table, steps: &[&str]) -> Option<&'a mut Table> {
    let Some((first, rest)) = steps.split_first() else { return Some(document) };
    inside_mut(document.get_mut(*first)?, rest)
}

fn inside_mut<'a>(value: &'a mut Toml, steps: &[&str]) -> Option<&'a mut Table> {
    match (value, steps.split_first()) {
        (Toml::Table(table), _) => below_mut(table, steps),
        (Toml::Array(list), Some((&LIST, rest))) => {
            list.iter_mut().find_map(|it| inside_mut(it, rest))
        }
        _ => None,
    }
}

/// A part of another document; of what flies there is one.
fn replace_part(document: &mut Table, key: &str, part: &Toml) {
    if FLYING.contains(&key) {
        FLYING.iter().for_each(|flying| drop(document.remove(*flying)));
    }
    document.insert(key.to_owned(), part.clone());
}

fn walk(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            walk(&path, files);
        } else if path.extension().is_some_and(|ending| ending == "toml") {
            files.push(path);
        }
    }
}

fn a_key(drawn: &mut Drawn, document: &Table) -> String {
    let keys: Vec<&String> = document.keys().collect();
    (*drawn.one_of(&keys)).clone()
}

/// A table, or the first of a list.
fn table(value: &Toml) -> Option<&Table> {
    match value {
        Toml::Table(table) => Some(table),
        Toml::Array(list) => list.first().and_then(table),
        _ => None,
    }
}

fn table_mut(value: &mut Toml) -> Option<&mut Table> {
    match value {
        Toml::Table(table) => Some(table),
        Toml::Array(list) => list.first_mut().and_then(table_mut),
        _ => None,
    }
}

/// Leaves out a part, or a key of one.
fn leave_out(drawn: &mut Drawn, document: &mut Table) {
    let key = a_key(drawn, document);
    if drawn.below(2) == 0 && !ALWAYS.contains(&key.as_str()) && !FLYING.contains(&key.as_str()) {
        document.remove(&key);
        return;
    }
    let Some(own) = document.get_mut(&key).and_then(table_mut) else { return };
    if own.len() > 1 {
        let name = a_key(drawn, own);
        own.remove(&name);
    }
}

/// Every word of a document with its place, in an order that is always the same.
fn words<'a>(value: &'a mut Toml, key: &str, found: &mut Vec<(String, &'a mut String)>) {
    match value {
        Toml::Table(table) => {
            for (name, below) in table.iter_mut() {
                let below_key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                words(below, &below_key, found);
            }
        }
        Toml::Array(list) => {
            list.iter_mut().for_each(|below| words(below, &format!("{key}[]"), found));
        }
        Toml::String(word) => found.push((key.to_owned(), word)),
        _ => {}
    }
}

fn words_of(node: &Value) -> Vec<&str> {
    node["enum"].as_array().into_iter().flatten().filter_map(Value::as_str).collect()
}

/// Another word where the schema allows several.
fn other_word(drawn: &mut Drawn, document: &mut Table, schema: &Schema) {
    let mut whole = Toml::Table(std::mem::take(document));
    let mut found = Vec::new();
    words(&mut whole, "", &mut found);
    found.retain(|(key, _)| schema.at(key).iter().any(|node| !words_of(node).is_empty()));
    if !found.is_empty() {
        let place = drawn.below(found.len());
        let (key, word) = &mut found[place];
        let allowed: Vec<&str> = schema.at(key).into_iter().flat_map(words_of).collect();
        **word = (*drawn.one_of(&allowed)).to_owned();
    }
    if let Toml::Table(table) = whole {
        *document = table;
    }
}

/// A key that the schema knows and the part has not, with a value that the schema allows.
fn one_key_more(drawn: &mut Drawn, document: &mut Table, schema: &Schema) {
    let key = a_key(drawn, document);
    let path = match document.get(&key) {
        Some(Toml::Array(_)) => format!("{key}[]"),
        _ => key.clone(),
    };
    let nodes = schema.at(&path);
    let known: Vec<(&String, &Value)> =
        nodes.iter().filter_map(|node| node["properties"].as_object()).flatten().collect();
    let Some(own) = document.get_mut(&key).and_then(table_mut) else { return };
    let missing: Vec<_> = known.into_iter().filter(|(name, _)| !own.contains_key(*name)).collect();
    if missing.is_empty() {
        return;
    }
    let (name, _) = drawn.one_of(&missing);
    let below = schema.at(&format!("{path}.{name}"));
    if let Some(value) = below.into_iter().find_map(|node| value(drawn, node)) {
        own.insert((*name).clone(), value);
    }
}

/// A value that a node of the schema allows, if it is a number, a word or a truth.
fn value(drawn: &mut Drawn, node: &Value) -> Option<Toml> {
    let allowed = words_of(node);
    if !allowed.is_empty() {
        return Some(Toml::String((*drawn.one_of(&allowed)).to_owned()));
    }
    let low = ["minimum", "exclusiveMinimum"].iter().find_map(|name| node[*name].as_f64());
    let high = ["maximum", "exclusiveMaximum"].iter().find_map(|name| node[*name].as_f64());
    match node["type"].as_str()? {
        "boolean" => Some(Toml::Boolean(drawn.below(2) == 0)),
        "integer" => Some(Toml::Integer(low.unwrap_or(0.0) as i64 + drawn.below(9) as i64)),
        "number" => {
            let size = *drawn.one_of(&[0.01, 0.1, 0.3, 1.0, 2.0, 5.0, 20.0, 100.0]);
            let value = match (low, high) {
                (Some(low), Some(high)) if high - low < 1e3 => low + (high - low) * size / 101.0,
                (Some(low), _) => low + size,
                _ => size,
            };
            Some(Toml::Float(value))
        }
        _ => None,
    }
}

/// True if `check` says so.
fn is_scenario(document: &Table, folder: &Path) -> bool {
    let Ok(template) =
        Template::parse(&written(document), "draw.toml", Some(folder), &Extra::default())
    else {
        return false;
    };
    template.study().dispersions.is_empty() || template.check_dispersions().is_ok()
}

/// As a person writes it: a part is a table with a head, a list of tables has double brackets, and what stands inside is in
/// braces, as marks of free numbers have to be.
pub(super) fn written(document: &Table) -> String {
    let is_part = |value: &Toml| value.is_table() || tables_of(value).is_some();
    let (parts, alone): (Vec<_>, Vec<_>) = document.iter().partition(|(_, value)| is_part(value));
    let mut text: String = alone.into_iter().map(|(key, value)| line(key, value)).collect();
    for (key, value) in parts {
        match (value, tables_of(value)) {
            (Toml::Table(table), _) => part(&mut text, &format!("[{}]", quoted(key)), key, table),
            (_, Some(list)) => {
                for table in list {
                    part(&mut text, &format!("[[{}]]", quoted(key)), key, table);
                }
            }
            _ => {}
        }
    }
    text
}

fn part(text: &mut String, head: &str, key: &str, table: &Table) {
    text.push_str(&format!("\n{head}\n"));
    let (lists, others): (Vec<_>, Vec<_>) = table.iter().partition(|it| tables_of(it.1).is_some());
    text.extend(others.into_iter().map(|(key, value)| line(key, value)));
    for (below, value) in lists {
        for table in tables_of(value).unwrap_or_default() {
            text.push_str(&format!("\n[[{}.{}]]\n", quoted(key), quoted(below)));
            text.extend(table.iter().map(|(key, value)| line(key, value)));
        }
    }
}

/// The tables of a list that has nothing else, and something.
fn tables_of(value: &Toml) -> Option<Vec<&Table>> {
    let list = value.as_array().filter(|list| !list.is_empty())?;
    list.iter().map(Toml::as_table).collect()
}

fn line(key: &str, value: &Toml) -> String {
    format!("{} = {value}\n", quoted(key))
}

fn quoted(key: &str) -> String {
    let bare = |letter: char| letter.is_ascii_alphanumeric() || "_-".contains(letter);
    match !key.is_empty() && key.chars().all(bare) {
        true => key.to_owned(),
        false => Toml::String(key.to_owned()).to_string(),
    }
}

fn made_short(document: &mut Table) {
    shorten(document);
    without_waiting(document);
}

/// Without controllers that wait for a flight stack at an address: nobody is there, and each flight would wait for that.
fn without_waiting(document: &mut Table) {
    let waits = |it: &Toml| {
        let kind = table(it).and_then(|it| it.get("kind")).and_then(Toml::as_str);
        kind.is_some_and(|kind| ["ardupilot", "px4"].contains(&kind))
    };
    if let Some(Toml::Array(controllers)) = document.get_mut("controller") {
        controllers.retain(|controller| !waits(controller));
    }
}

/// Flights of a few seconds, or thousands of draws would take days.
fn shorten(document: &mut Table) {
    let Some(part) = document.get_mut("loop").and_then(table_mut) else { return };
    let duration = part.get("duration_s").and_then(|it| match it {
        Toml::Float(value) => Some(*value),
        Toml::Integer(value) => Some(*value as f64),
        _ => None,
    });
    if duration.is_some_and(|duration| duration > LONGEST_S) {
        part.insert("duration_s".to_owned(), Toml::Float(LONGEST_S));
    }
}
