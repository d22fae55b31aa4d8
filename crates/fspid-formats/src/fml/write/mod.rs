//! Writing.

mod adapt;
mod text;

use fspid_fuzzy::system::Parts;

use crate::loss::Loss;
use crate::note::{WriteOptions, Writing};
use fspid_diagnostics::Problems;

/// Writes a system in the Fuzzy Markup Language of IEEE 1855, with every digit that a number needs.
///
/// # Errors
/// What the language has no words for, unless `options` allow a loss; parts that are no system.
pub fn write(parts: &Parts, options: WriteOptions) -> Result<Writing, Problems> {
    let mut loss = Loss::new(parts, options)?;
    let adapted = adapt::adapted(parts, &mut loss);
    let text = text::Writer { parts: &adapted, loss: &mut loss }.text();
    loss.finish(text, parts, &adapted)
}

/// What kind of variable an output is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// Fuzzy sets that are joined.
    Mamdani,
    /// Numbers and planes that are weighted.
    Tsk,
    /// Monotone sets that are weighted.
    Tsukamoto,
}

impl Kind {
    fn of(output: &fspid_fuzzy::system::Output) -> Self {
        let is_set = |term: &fspid_fuzzy::system::OutputTerm| {
            matches!(term.conclusion, fspid_fuzzy::system::Conclusion::Set { .. })
        };
        match output.defuzzifier.sampling() {
            Some(_) => Self::Mamdani,
            None if output.terms.iter().any(is_set) => Self::Tsukamoto,
            None => Self::Tsk,
        }
    }
}
