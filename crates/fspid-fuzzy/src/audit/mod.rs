//! What is true of a rule base and of its surface, with proof.
//!
//! [`rule_base`] looks at the rules as written: holes, contradictions, rules that repeat others,
//! terms that nobody uses, symmetry and monotonicity of the labels. Nothing there is approximate.
//!
//! Everything is answered as plain data; words, JSON and pages are made of it elsewhere.

mod rule_base;

pub use rule_base::{
    AxisAudit, Contradiction, Direction, Duplicate, Exchange, GridAudit, LabelAudit, Neighbours,
    OutputRules, PairAudit, Redundant, RuleBaseAudit, RulePosition, rule_base,
};
