//! Writing.

mod adapt;
mod norm;
mod options;
mod set;
mod statement;
mod text;

use fspid_fuzzy::system::Parts;

use super::Dialect;
use crate::loss::Loss;
use crate::note::{WriteOptions, Writing};
use fspid_diagnostics::Problems;

/// Writes a system in a dialect of FCL, with every digit that a number needs.
///
/// # Errors
/// What the dialect has no words for, unless `options` allow a loss; parts that are no system.
pub fn write(parts: &Parts, dialect: Dialect, options: WriteOptions) -> Result<Writing, Problems> {
    let mut loss = Loss::new(parts, options)?;
    let adapted = adapt::adapted(parts, dialect, &mut loss);
    let text = text::Writer { parts: &adapted, dialect, loss: &mut loss }.text();
    loss.finish(text, parts, &adapted)
}
