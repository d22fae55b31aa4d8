//! The Fuzzy Markup Language of IEEE 1855, `.xml`, and what was in use before the standard.
//!
//! | in the file | here |
//! | --- | --- |
//! | `fuzzySystem`, `fuzzyController`; names in any case | a system |
//! | `fuzzyVariable`, `tskVariable`, `tsukamotoVariable` | inputs and outputs |
//! | `mamdaniRuleBase`, `tskRuleBase`, `tsukamotoRuleBase`, `RuleBase` with a `type` | rule blocks |
//! | `complement="true"` | `not` before the set, which is named "complement of …" |
//! | `modifier` of a clause | a hedge; in a conclusion a set of its own |
//! | a rule's own `andMethod`, `orMethod` | a rule block of its own |
//! | `anYaRuleBase`, `aggregatedFuzzyVariable`, `circularDefinition`, `else`, `custom…` | refused by name |
//! | `networkAddress`, `scale` | not used, with a note |
//!
//! The standard does not say how integrals are computed: they are exact here. Documents have no
//! declarations of their own, so that no entity can blow up a short text.
//!
//! # Source
//! Element and attribute names of IEEE 1855-2016 as public descriptions and examples show them.
//! These do not agree everywhere; where they differ a note says how a file is read.

mod document;
mod knowledge;
mod read;
mod rules;
mod shape;
mod words;
mod write;

pub use read::read;
pub use write::write;

/// Most elements inside each other.
const MAX_DEPTH: usize = 64;
/// Most elements and texts of a file; each takes some hundred bytes of memory.
const MAX_NODES: u32 = 2_000_000;
/// Where the side of a set lies that never ends: a half of [`GaussianProduct`] that is 1 throughout.
///
/// [`GaussianProduct`]: fspid_fuzzy::membership::ShapeKind::GaussianProduct
const FAR: f64 = 1e100;
