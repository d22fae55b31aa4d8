//! What a text says, before it is known what it means.

use std::collections::BTreeMap;

use fspid_fuzzy::system::{Membership, Sampling, Universe};
use fspid_fuzzy::{OutOfRange, SNormKind, TNormKind};

use super::connectives::Connective;
use super::dialect::Evidence;
use crate::lexer::Token;
use crate::names::Index;
use crate::report::Report;
use crate::term::Number;
use crate::tokens::Tokens;
use crate::vocabulary::methods;
use fspid_diagnostics::Place;

/// A function block.
#[derive(Debug, Default)]
pub(super) struct Draft<'a> {
    pub(super) name: String,
    pub(super) variables: Vec<Variable<'a>>,
    /// Names of `variables`.
    pub(super) names: Index,
    /// Local variables that stand for a number, by name in lower case.
    pub(super) constants: BTreeMap<String, f64>,
    pub(super) blocks: Vec<Block<'a>>,
    pub(super) evidence: Evidence,
    pub(super) report: Report,
}

/// Where a variable is declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Input,
    Output,
    Local,
}

/// A variable with all that is said about it.
#[derive(Debug)]
pub(super) struct Variable<'a> {
    pub(super) name: Token<'a>,
    pub(super) role: Role,
    /// The section that describes it.
    pub(super) section: Option<Place>,
    pub(super) defuzzified: bool,
    pub(super) enabled: bool,
    pub(super) universe: Option<Universe>,
    pub(super) out_of_range: OutOfRange,
    pub(super) clamp: bool,
    pub(super) terms: Vec<Term<'a>>,
    pub(super) method: Option<Method<'a>>,
    pub(super) sampling: Option<Sampling>,
    pub(super) accu: Option<(SNormKind, Place)>,
    /// Whether equal conclusions are added up before they are weighed, whatever `ACCU` says.
    pub(super) adds: bool,
    pub(super) default: Option<f64>,
    pub(super) middle: bool,
    pub(super) previous: bool,
}

/// `METHOD : word resolution`
#[derive(Clone, Copy)]
pub(super) struct Method<'a> {
    pub(super) word: Token<'a>,
    pub(super) row: &'static methods::MethodWords,
    pub(super) resolution: Option<u32>,
}

impl std::fmt::Debug for Method<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.word.text)
    }
}

/// `TERM name := set`
#[derive(Debug)]
pub(super) struct Term<'a> {
    pub(super) name: Token<'a>,
    pub(super) set: Set<'a>,
}

/// What a term is.
#[derive(Debug)]
pub(super) enum Set<'a> {
    /// It could not be read; why has been reported.
    Unknown,
    Number(f64),
    Fuzzy(Membership),
    Linear(Token<'a>, Vec<Number<'a>>),
    Formula(Token<'a>),
}

/// A rule block.
#[derive(Debug)]
pub(super) struct Block<'a> {
    pub(super) name: String,
    pub(super) start: Token<'a>,
    pub(super) enabled: bool,
    pub(super) and: Option<TNormKind>,
    pub(super) or: Option<SNormKind>,
    /// Which of the two was said last.
    pub(super) last: Option<Connective>,
    pub(super) act: Option<TNormKind>,
    pub(super) accu: Option<(SNormKind, Place)>,
    pub(super) rules: Vec<RuleText<'a>>,
}

/// A rule to be read once all variables are known.
#[derive(Debug)]
pub(super) struct RuleText<'a> {
    pub(super) name: &'a str,
    pub(super) tokens: Tokens<'a>,
}

impl<'a> Variable<'a> {
    pub(super) fn new(name: Token<'a>, role: Role) -> Self {
        Self {
            name,
            role,
            section: None,
            defuzzified: false,
            enabled: true,
            universe: None,
            out_of_range: OutOfRange::Evaluate,
            clamp: false,
            terms: Vec::new(),
            method: None,
            sampling: None,
            accu: None,
            adds: false,
            default: None,
            middle: false,
            previous: false,
        }
    }

    /// True if it becomes an output of the system.
    pub(super) fn is_output(&self) -> bool {
        self.role == Role::Output || self.defuzzified
    }
}
