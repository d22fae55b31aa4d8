//! What is wrong with cases of a tuning or a contest, as JSON.

use fspid_scenario::file::{LoadError, Problems};
use serde_json::{Value, json};

/// Of cases that are wrong, each in its own way, so many are told.
pub(crate) const MOST_CASES: usize = 10;

/// What is wrong with cases, each with its name, as JSON: as [`Problems::to_json`] has it, every problem with the name of its
/// case as `case`. Nothing where none of them could be read at all.
pub(crate) fn problems_of_cases<'a>(
    wrong: impl IntoIterator<Item = (&'a str, &'a LoadError)>,
) -> Option<Value> {
    let all: Vec<(&str, &Problems)> = wrong
        .into_iter()
        .filter_map(|(case, reason)| match reason {
            LoadError::Problems(problems) => Some((case, problems)),
            LoadError::Unreadable { .. } => None,
        })
        .collect();
    let file = &all.first()?.1.file;
    let told: Vec<Value> = all.iter().take(MOST_CASES).copied().flat_map(of_case).collect();
    let count = all.iter().map(|(_, problems)| problems.list.len() + problems.omitted);
    let omitted = count.sum::<usize>() - told.len();
    Some(json!({ "file": file, "problems": told, "omitted": omitted }))
}

/// Each problem of a case, with its name.
fn of_case((case, problems): (&str, &Problems)) -> Vec<Value> {
    let mut list = problems.to_json()["problems"].take();
    let list = list.as_array_mut().map(std::mem::take).unwrap_or_default();
    let named = |mut problem: Value| {
        problem["case"] = case.into();
        problem
    };
    list.into_iter().map(named).collect()
}
