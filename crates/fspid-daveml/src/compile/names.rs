//! Identifiers and what they stand for.

use std::collections::BTreeMap;

use crate::document::{Document, Mention};
use crate::finding::{Findings, Origin};
use crate::formula::is_name;

/// Indices by identifier.
pub(super) struct Names<'a> {
    pub(super) variables: BTreeMap<&'a str, usize>,
    pub(super) variables_by_name: BTreeMap<&'a str, usize>,
    pub(super) breakpoints: BTreeMap<&'a str, usize>,
    pub(super) tables: BTreeMap<&'a str, usize>,
}

impl<'a> Names<'a> {
    /// All identifiers; each may occur once in its kind.
    pub(super) fn of(document: &'a Document, findings: &mut Findings) -> Self {
        for variable in document.variables.iter().filter(|variable| !is_name(&variable.id)) {
            let expected = "a letter or _ first; no white space, comma or bracket";
            let message = "this cannot be the identifier of a variable";
            findings.problem(variable.origin, &variable.id, message, expected);
        }
        let variables = document.variables.iter();
        let breakpoints = document.breakpoints.iter();
        let tables = document.tables.iter();
        Self {
            variables_by_name: variables
                .clone()
                .enumerate()
                .map(|(index, variable)| (variable.name.as_str(), index))
                .collect(),
            variables: unique(variables.map(|it| (it.id.as_str(), it.origin)), findings),
            breakpoints: unique(breakpoints.map(|it| (it.id.as_str(), it.origin)), findings),
            tables: unique(tables.map(|it| (it.id.as_str(), it.origin)), findings),
        }
    }

    /// Index of a variable, or a problem.
    pub(super) fn variable(
        &self,
        id: &str,
        origin: Origin,
        findings: &mut Findings,
    ) -> Option<usize> {
        find(&self.variables, id, origin, "variable", findings)
    }

    /// Index of breakpoints, or a problem.
    pub(super) fn breakpoints(&self, mention: &Mention, findings: &mut Findings) -> Option<usize> {
        find(&self.breakpoints, &mention.id, mention.origin, "breakpointDef", findings)
    }

    /// Index of a table, or a problem.
    pub(super) fn table(&self, mention: &Mention, findings: &mut Findings) -> Option<usize> {
        find(&self.tables, &mention.id, mention.origin, "griddedTableDef", findings)
    }
}

fn unique<'a>(
    ids: impl Iterator<Item = (&'a str, Origin)>,
    findings: &mut Findings,
) -> BTreeMap<&'a str, usize> {
    let mut map = BTreeMap::new();
    for (index, (id, origin)) in ids.enumerate() {
        if map.insert(id, index).is_some() {
            findings.problem(origin, id, "this identifier is used twice", "another identifier");
        }
    }
    map
}

fn find(
    map: &BTreeMap<&str, usize>,
    id: &str,
    origin: Origin,
    what: &str,
    findings: &mut Findings,
) -> Option<usize> {
    let found = map.get(id).copied();
    if found.is_none() {
        findings.problem(
            origin,
            id,
            format!("there is no {what} with this identifier"),
            known(map),
        );
    }
    found
}

/// The first known identifiers.
fn known(map: &BTreeMap<&str, usize>) -> String {
    let mut ids: Vec<_> = map.keys().take(20).copied().collect();
    if map.len() > ids.len() {
        ids.push("…");
    }
    ids.join(", ")
}
