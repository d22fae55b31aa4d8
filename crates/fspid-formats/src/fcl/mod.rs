//! The Fuzzy Control Language of IEC 61131-7, `.fcl`, in the dialects that are in use.
//!
//! Read is their union: keywords in any case, also in rules; comments `(* *)`, `/* */`, `//`, `#`;
//! sets as points, numbers, words of jFuzzyLogic and classes of fuzzylite; `RANGE` in both kinds of
//! section; `ACCU` in `RULEBLOCK` or `DEFUZZIFY`; rules that end with or without `;`. What a file
//! means by a centre of gravity depends on the tool that it was written for:
//!
//! | dialect | known by | integrals |
//! | --- | --- | --- |
//! | the standard | nothing below | exact |
//! | jFuzzyLogic | `TRIAN`, `GAUSS`, …, comments `/* */` and `//` | left ends of 1000 cells |
//! | fuzzylite | `RANGE` in `FUZZIFY`, `ACCU` in `DEFUZZIFY`, class names, `#`, `ENABLED`, `LOCK`, a resolution, rules without `;` | midpoints of 1000 cells, or of as many as are given |
//!
//! jFuzzyLogic knows *and* and *or* in pairs, of which the last of `AND` and `OR` sets both, reads them from left to right,
//! and adds conclusions up where no `ACCU` is given. In the standard and in jFuzzyLogic rules that conclude the same number
//! are joined by `ACCU` before they are weighed, and are read as one rule; where that is not one rule, they are refused.
//!
//! Points that are a triangle or a trapezoid are read as such. Local variables with a number stand
//! for that number; local variables that are defuzzified are outputs.
//!
//! In the standard's dialect the `OPTION` section holds what the standard has no words for, in
//! statements of our own that begin with `FSPID_`.
//!
//! # Source
//! Grammar of IEC 1131-7 CD 1.0; the documentation of jFuzzyLogic and fuzzylite; answers of jFuzzyLogic 3.3.

mod block;
mod build;
mod connectives;
mod dialect;
mod draft;
mod option;
mod parser;
mod rules;
mod section;
mod set;
mod write;

use crate::note::Reading;
use fspid_diagnostics::Problems;

pub use dialect::Dialect;
pub use write::write;

/// What a reader of FCL is told beside the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ReadOptions<'o> {
    /// The dialect, if it is not to be found out.
    pub dialect: Option<Dialect>,
    /// The function block to read, if there are several.
    pub block: Option<&'o str>,
}

/// Reads the only function block of a text, in any dialect.
///
/// # Errors
/// Every problem of the text, each with its place.
pub fn read(text: &str) -> Result<Reading, Problems> {
    read_with(text, ReadOptions::default())
}

/// Reads a function block of a text.
///
/// # Errors
/// Every problem of the text, each with its place.
pub fn read_with(text: &str, options: ReadOptions) -> Result<Reading, Problems> {
    let draft = parser::parse(text, options.block)?;
    build::reading(draft, options.dialect)
}
