//! What is true of a rule base and of its surface, with proof.
//!
//! [`rule_base()`] looks at the rules as written: holes, contradictions, rules that repeat others,
//! terms that nobody uses, symmetry and monotonicity of the labels. Nothing there is approximate.
//!
//! [`surface()`] proves bounds of values and slopes, shares of the domain where an output goes the
//! wrong way, and departures from symmetry, by interval arithmetic and branch and bound. A bound that
//! could not be proved as close as was asked for is told wider, never guessed.
//!
//! Everything is answered as plain data; words, JSON and pages are made of it elsewhere.

mod rule_base;
mod search;
mod surface;

pub use rule_base::{
    AxisAudit, Contradiction, Direction, Duplicate, Exchange, GridAudit, LabelAudit, Neighbours,
    OutputRules, PairAudit, Redundant, RuleBaseAudit, RulePosition, rule_base,
};
pub use search::Extreme;
pub use surface::{
    AlongInput, Counterexample, Coverage, Monotone, OutputSurface, Reach, RuleEffect, SurfaceAudit,
    SurfaceError, SurfaceOptions, Symmetry, TermReach, slopes, surface,
};

/// What became of a statement.
#[derive(Clone, Debug, PartialEq)]
pub enum Statement<W> {
    /// It holds everywhere.
    Proved,
    /// It does not hold; here is why.
    Refuted(W),
    /// Neither was proved within the budget.
    Open,
}
