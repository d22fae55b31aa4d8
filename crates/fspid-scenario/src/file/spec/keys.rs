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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting_path::renamed::{EACH, RENAMED, Renamed};

    /// Names of the keys of the table at a path, of all kinds.
    fn names(path: &str) -> Vec<&'static str> {
        let mut tables: Vec<&'static Table> = vec![&SCENARIO];
        for part in path.split('.').filter(|part| *part != EACH) {
            let keys = tables.iter().flat_map(|table| table.all_keys());
            let inner =
                keys.filter(|key| key.name().as_str() == part).filter_map(|key| match key.kind() {
                    Kind::Table(table) | Kind::Tables { table, .. } => Some(*table),
                    _ => None,
                });
            tables = inner.collect();
        }
        tables.into_iter().flat_map(Table::all_keys).map(|key| key.name().as_str()).collect()
    }

    #[test]
    fn a_new_key_is_in_the_specification_and_an_old_one_is_not() {
        for Renamed { table, old, new } in &RENAMED {
            let known = names(table);
            assert!(
                known.contains(new) && !known.contains(old),
                "{table}: {old}, {new}: {known:?}"
            );
        }
    }
}
