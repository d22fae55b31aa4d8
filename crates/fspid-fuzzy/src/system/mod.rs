//! Fuzzy systems of any size, behind `alloc`.
//!
//! A system is written down as [`Parts`], checked and resolved once by [`System::new`], and then
//! asked as often as one likes: [`System::evaluate`] allocates nothing and looks up no name; all it
//! needs is a [`Workspace`] of the right size.
//!
//! How an answer comes about:
//!
//! 1. each input is taken as it is, moved into its universe, or refused ([`OutOfRange`](crate::OutOfRange));
//! 2. each term that some rule mentions is graded once;
//! 3. each rule fires with the strength of its antecedent times its weight, and the block's
//!    [`Activation`] chooses which rules act;
//! 4. each output joins what was concluded about it and turns it into a number by its
//!    [`Defuzzifier`], or falls back where there is nothing to join.

mod build;
mod defuzzifier;
mod error;
mod evaluate;
mod firing;
mod gradient;
mod norms;
mod output;
mod parts;
mod program;
mod supervisor;
mod trace;
mod type2;
mod workspace;

pub use build::System;
pub use defuzzifier::{Defuzzifier, Sampling, SetReading};
pub use error::{SystemError, SystemProblem};
pub use evaluate::{Answer, InputError, Source};
pub(crate) use firing::hedged;
pub use gradient::{Differentiator, Gradient, GradientError, Parameter};
pub use norms::{SNorm, TNorm};
pub use output::{Actor, AggregatedSet, Cell, Join, Line, Piece, Way};
pub use parts::{
    Activation, Antecedent, Comparison, Conclusion, Consequent, Fallback, FallbackValue, Input,
    Membership, Output, OutputTerm, Parts, Rule, RuleBlock, Statement, Term, Universe, Variable,
};
pub(crate) use program::{Program, STACK, Step};
pub use supervisor::NoRules;
pub use trace::{Contribution, Firing};
pub use workspace::Workspace;
