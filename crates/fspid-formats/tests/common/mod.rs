//! What several tests need.

#![allow(dead_code, reason = "each test file uses some of it")]
#![allow(clippy::unwrap_used, reason = "a helper of tests may panic")]

use fspid_formats::{Problems, Reading, WriteOptions};
use fspid_fuzzy::system::{Parts, Sampling, System};
use fspid_fuzzy::{Defuzzifier, OutOfRange, RuleTable, Supervisor};

/// Nothing may get lost.
pub(crate) const EXACT: WriteOptions = WriteOptions { lossy: false };
/// Losses are allowed.
pub(crate) const LOSSY: WriteOptions = WriteOptions { lossy: true };

/// The paper's supervisor with half range 5 as a general system that integrates so.
pub(crate) fn paper(sampling: Sampling) -> Parts {
    let tables = include_str!("../../../../data/rule-tables/printed.toml");
    let grids: Vec<&str> = tables.split("\"\"\"").collect();
    let table = RuleTable::parse([grids[1], grids[3], grids[5]]).unwrap();
    let supervisor =
        Supervisor::new(&table, 5.0_f64, Defuzzifier::Exact, OutOfRange::Evaluate).unwrap();
    let mut parts = Parts::try_from(&supervisor).expect("rules");
    for output in &mut parts.outputs {
        output.defuzzifier = output.defuzzifier.with_sampling(sampling);
    }
    parts
}

/// The answers of a system at an input.
pub(crate) fn answers(parts: &Parts, at: &[f64]) -> Vec<Option<f64>> {
    let system = System::new(parts.clone()).unwrap();
    let mut workspace = system.workspace();
    let answers = system.evaluate(at, &mut workspace).unwrap();
    answers.iter().map(|answer| answer.value).collect()
}

/// Problems as lines.
pub(crate) fn problems(result: Result<Reading, Problems>) -> String {
    result.unwrap_err().to_string()
}

/// Notes as lines.
pub(crate) fn notes(reading: &Reading) -> Vec<String> {
    reading.notes.iter().map(ToString::to_string).collect()
}
