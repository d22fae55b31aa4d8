//! Names of variables and terms, looked up in logarithmic time.

use std::collections::BTreeMap;

use fspid_fuzzy::system::Variable;

use crate::work;

/// Names of one kind in the order of their positions.
#[derive(Debug, Default)]
pub(crate) struct Index {
    names: Vec<String>,
    exact: BTreeMap<String, usize>,
    /// Names in lower case; `None` where several differ in case only.
    folded: BTreeMap<String, Option<usize>>,
}

/// What a look-up finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Found {
    /// The name as written.
    Exact(usize),
    /// The only name that is the same but for its case.
    Folded(usize),
    /// Nothing, or several that differ in case only.
    Nothing,
}

impl Index {
    /// Adds a name; false if it was there.
    pub(crate) fn add(&mut self, name: &str) -> bool {
        let position = self.names.len();
        self.names.push(name.into());
        self.folded
            .entry(name.to_lowercase())
            .and_modify(|seen| *seen = None)
            .or_insert(Some(position));
        let new = !self.exact.contains_key(name);
        self.exact.entry(name.into()).or_insert(position);
        new
    }

    /// The position of a name.
    pub(crate) fn find(&self, name: &str) -> Found {
        work::add(1);
        if let Some(&position) = self.exact.get(name) {
            return Found::Exact(position);
        }
        match self.folded.get(&name.to_lowercase()) {
            Some(&Some(position)) => Found::Folded(position),
            _ => Found::Nothing,
        }
    }

    /// The name at a position.
    pub(crate) fn name(&self, position: usize) -> &str {
        self.names.get(position).map_or("", String::as_str)
    }

    /// Every name.
    pub(crate) fn all(&self) -> impl Iterator<Item = &str> + Clone {
        self.names.iter().map(String::as_str).inspect(|_| work::add(1))
    }
}

impl<'n> FromIterator<&'n str> for Index {
    fn from_iter<I: IntoIterator<Item = &'n str>>(names: I) -> Self {
        let mut index = Self::default();
        for name in names {
            index.add(name);
        }
        index
    }
}

/// The names that rules may use.
#[derive(Debug)]
pub(crate) struct Names {
    /// Inputs, then outputs.
    pub(crate) variables: Index,
    inputs: usize,
    terms: Vec<Index>,
    /// Whether case matters; if not, a name in another case is found and noted.
    pub(crate) case_matters: bool,
}

impl Names {
    /// No names so far.
    pub(crate) fn empty(case_matters: bool) -> Self {
        Self { variables: Index::default(), inputs: 0, terms: Vec::new(), case_matters }
    }

    /// Adds a variable with its terms; inputs come before outputs.
    pub(crate) fn push(&mut self, name: &str, output: bool, terms: Index) {
        self.variables.add(name);
        self.inputs += usize::from(!output);
        self.terms.push(terms);
    }

    /// The variable at a position of [`variables`](Self::variables).
    pub(crate) fn variable(&self, position: usize) -> Variable {
        match position.checked_sub(self.inputs) {
            Some(output) => Variable::Output(output),
            None => Variable::Input(position),
        }
    }

    /// The terms of the variable at a position.
    pub(crate) fn terms(&self, position: usize) -> Option<&Index> {
        self.terms.get(position)
    }

    /// The outputs' names.
    pub(crate) fn outputs(&self) -> impl Iterator<Item = &str> + Clone {
        self.variables.all().skip(self.inputs)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_as_written_and_else_without_case_if_only_one_fits() {
        let index: Index = ["Low", "low", "High"].into_iter().collect();
        assert_eq!(index.find("low"), Found::Exact(1));
        assert_eq!(index.find("LOW"), Found::Nothing);
        assert_eq!(index.find("HIGH"), Found::Folded(2));
        assert_eq!(index.find("mid"), Found::Nothing);
    }
}
