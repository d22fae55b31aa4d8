//! The schema of scenarios as a list of its keys and words, and what of it a document has.

use std::collections::BTreeSet;

use serde_json::Value;
use toml::Value as Toml;

use crate::accepted::asked;
use crate::common::json;

/// The schema that the program prints.
pub(super) struct Schema {
    root: Value,
    all: BTreeSet<String>,
}

impl Schema {
    pub(super) fn of_scenarios() -> Self {
        let root = json(&asked(&["schema"]));
        let mut all = BTreeSet::new();
        collect(&root, &root, "", &mut all);
        Self { root, all }
    }

    /// Every key, as `controller[].kp`, and every word, as `controller[].kind=pid`.
    pub(super) fn all(&self) -> &BTreeSet<String> {
        &self.all
    }

    /// Those that a document has.
    pub(super) fn reached(&self, document: &toml::Table) -> BTreeSet<String> {
        let mut found = BTreeSet::new();
        have(&Toml::Table(document.clone()), "", &mut found);
        found.intersection(&self.all).cloned().collect()
    }

    /// What the schema says at a key.
    pub(super) fn at(&self, key: &str) -> Vec<&Value> {
        let mut nodes = vec![&self.root];
        for step in key.replace("[]", ".[]").split('.').filter(|step| !step.is_empty()) {
            nodes = nodes
                .into_iter()
                .flat_map(|node| self.alternatives(node))
                .filter_map(|node| match step {
                    "[]" => node.get("items"),
                    name => node.get("properties").and_then(|it| it.get(name)),
                })
                .collect();
        }
        nodes.into_iter().flat_map(|node| self.alternatives(node)).collect()
    }

    /// A node and what it may be instead.
    fn alternatives<'a>(&'a self, node: &'a Value) -> Vec<&'a Value> {
        let node = resolved(&self.root, node);
        let others = ["anyOf", "oneOf", "allOf"].iter().filter_map(|name| node.get(*name));
        let others = others.filter_map(Value::as_array).flatten();
        core::iter::once(node).chain(others.flat_map(|other| self.alternatives(other))).collect()
    }
}

fn resolved<'a>(root: &'a Value, node: &'a Value) -> &'a Value {
    let name = node.get("$ref").and_then(Value::as_str).and_then(|it| it.strip_prefix("#/$defs/"));
    name.and_then(|name| root["$defs"].get(name)).unwrap_or(node)
}

fn collect(root: &Value, node: &Value, key: &str, all: &mut BTreeSet<String>) {
    if node["$ref"] == "#/$defs/mark" {
        return;
    }
    let node = resolved(root, node);
    for name in ["anyOf", "oneOf", "allOf"] {
        for other in node[name].as_array().into_iter().flatten() {
            collect(root, other, key, all);
        }
    }
    for (name, below) in node["properties"].as_object().into_iter().flatten() {
        let below_key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
        all.insert(below_key.clone());
        collect(root, below, &below_key, all);
    }
    if node.get("items").is_some() {
        collect(root, &node["items"], &format!("{key}[]"), all);
    }
    let words = node["enum"].as_array().into_iter().flatten().chain(node.get("const"));
    all.extend(words.filter_map(Value::as_str).map(|word| format!("{key}={word}")));
}

fn have(value: &Toml, key: &str, found: &mut BTreeSet<String>) {
    match value {
        Toml::Table(table) => {
            for (name, below) in table {
                let below_key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                found.insert(below_key.clone());
                have(below, &below_key, found);
            }
        }
        Toml::Array(list) => {
            let key = format!("{key}[]");
            list.iter().for_each(|value| have(value, &key, found));
        }
        Toml::String(word) => {
            found.insert(format!("{key}={word}"));
        }
        _ => {}
    }
}
