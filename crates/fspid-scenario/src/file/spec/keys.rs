//! Every key that a scenario may have.

use std::collections::BTreeSet;

use super::SCENARIO;
use crate::keyed::{Kind, Table};

/// Every key that a scenario may have, such as `controller.supervisor.range`; tables of a kind have `kind` as well.
#[must_use]
pub fn scenario_keys() -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    walk(&SCENARIO, "", &mut found);
    found
}

fn walk(table: &'static Table, before: &str, found: &mut BTreeSet<String>) {
    for key in table.all_keys() {
        let path = format!("{before}{}", key.name());
        let inner = format!("{path}.");
        match key.kind() {
            Kind::Table(table) | Kind::Tables { table, .. } => walk(table, &inner, found),
            Kind::Rules { grids: table, .. } => {
                found.insert(path);
                walk(table, &inner, found);
            }
            _ => {
                found.insert(path);
            }
        }
    }
    if !table.variants.is_empty() {
        found.insert(format!("{before}kind"));
    }
}
