//! Lines of a block.

use fspid_fuzzy::system::Universe;

use crate::number::written as number;

pub(super) fn statement(begin: &str, end: &str) -> String {
    format!("  {begin}{end};\n")
}

pub(super) fn range(universe: Option<Universe>) -> String {
    let ends = universe.map_or([f64::NEG_INFINITY, f64::INFINITY], |u| [u.lower, u.upper]);
    format!("({})", ends.map(number).join(" .. "))
}
