//! What a fuzzy system consists of, as plain data: what readers fill in and writers read out.
//!
//! Everything is referred to by position; [`System::new`](super::System::new) checks the positions
//! and every other rule about how the parts go together.

use alloc::boxed::Box;
use alloc::string::String;
use alloc::vec::Vec;

use super::defuzzifier::Defuzzifier;
use super::norms::{SNorm, TNorm};
use crate::formula::Formula;
use crate::hedge::Hedge;
use crate::membership::ShapeKind;
use crate::supervisor::OutOfRange;

/// A fuzzy system.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Parts {
    /// Name.
    pub name: String,
    /// What it is for, in a sentence; may be empty.
    pub description: String,
    /// Inputs, in the order in which values are given.
    pub inputs: Vec<Input>,
    /// Outputs, in the order of the answers.
    pub outputs: Vec<Output>,
    /// Rule blocks, evaluated in order.
    pub blocks: Vec<RuleBlock>,
}

impl Parts {
    /// True if some formula names an output: its answers then depend on the answers before, see
    /// [`System::evaluate_after`](super::System::evaluate_after).
    #[must_use]
    pub fn formulas_name_outputs(&self) -> bool {
        let (first, count) = (self.inputs.len(), self.outputs.len());
        let names = |formula: &Formula, before: usize| {
            (0..count).any(|output| formula.uses(before + first + output))
        };
        let set = |set: &Membership| match set {
            Membership::Formula { formula, .. } => names(formula, 1),
            Membership::Shape { .. } => false,
        };
        let pair = |upper: &Membership, lower: &Option<Membership>| {
            set(upper) || lower.as_ref().is_some_and(set)
        };
        let of_inputs = self.inputs.iter().flat_map(|input| &input.terms);
        let of_outputs = self.outputs.iter().flat_map(|output| &output.terms);
        of_inputs.into_iter().any(|term| pair(&term.membership, &term.lower))
            || of_outputs.into_iter().any(|term| match &term.conclusion {
                Conclusion::Set { membership, lower } => pair(membership, lower),
                Conclusion::Formula(formula) => names(formula, 0),
                _ => false,
            })
    }
}

/// The universe of discourse of a variable: from `lower` to `upper`, in the variable's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Universe {
    /// Lower end.
    pub lower: f64,
    /// Upper end, above `lower`.
    pub upper: f64,
}

impl Universe {
    /// Upper less lower end.
    #[must_use]
    pub fn span(&self) -> f64 {
        self.upper - self.lower
    }

    /// Half way between the ends.
    #[must_use]
    pub fn middle(&self) -> f64 {
        0.5 * self.lower + 0.5 * self.upper
    }

    /// True for a number from `lower` to `upper`.
    #[must_use]
    pub fn contains(&self, x: f64) -> bool {
        self.lower <= x && x <= self.upper
    }
}

/// An input variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Name.
    pub name: String,
    /// What it stands for; may be empty.
    pub description: String,
    /// A variable that is switched off makes every statement about it false.
    pub enabled: bool,
    /// Where it lives, if that is known.
    pub universe: Option<Universe>,
    /// What happens to a value outside the universe.
    pub out_of_range: OutOfRange,
    /// Its fuzzy sets.
    pub terms: Vec<Term>,
}

/// A fuzzy set with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// Name.
    pub name: String,
    /// Membership function; of an interval type-2 set the upper one.
    pub membership: Membership,
    /// Lower membership function of an interval type-2 set; where it is above the upper one, that one
    /// stands for both.
    pub lower: Option<Membership>,
}

/// A membership function with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub enum Membership {
    /// A member of the family of shapes, scaled.
    Shape {
        /// Which.
        kind: ShapeKind,
        /// Its parameters, in the order of [`ShapeKind::params`].
        params: Vec<f64>,
        /// Largest grade, in (0, 1]; the shape is multiplied by it.
        height: f64,
    },
    /// A formula in `x` (variable 0), the inputs (variables 1 and up), and the last answers of the
    /// outputs (behind them), cut off to [0, 1].
    Formula {
        /// The formula.
        formula: Formula,
        /// As for a shape.
        height: f64,
    },
}

/// An output variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Name.
    pub name: String,
    /// What it stands for; may be empty.
    pub description: String,
    /// A variable that is switched off has no answer but its fallback.
    pub enabled: bool,
    /// Where it lives; needed by every defuzzifier that integrates.
    pub universe: Option<Universe>,
    /// Whether the answer, wherever it comes from, is moved into the universe.
    pub clamp: bool,
    /// What rules may conclude.
    pub terms: Vec<OutputTerm>,
    /// How the conclusions of several rules are joined.
    pub aggregation: SNorm,
    /// How the joined conclusions become a number.
    pub defuzzifier: Defuzzifier,
    /// The answer where no rule fires, the joined set has no area, or a formula has no finite value.
    pub fallback: Fallback,
}

/// A conclusion with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputTerm {
    /// Name.
    pub name: String,
    /// What is concluded.
    pub conclusion: Conclusion,
}

/// What a rule may conclude about an output.
#[derive(Clone, Debug, PartialEq)]
pub enum Conclusion {
    /// A fuzzy set (Mamdani, Larsen, Tsukamoto).
    Set {
        /// Membership function; of an interval type-2 set the upper one.
        membership: Membership,
        /// Lower membership function of an interval type-2 set; where it is above the upper one, that
        /// one stands for both.
        lower: Option<Membership>,
    },
    /// A number (Takagi–Sugeno of order 0; a singleton).
    Constant(f64),
    /// A number between two bounds (interval type-2 Takagi–Sugeno of order 0).
    Interval([f64; 2]),
    /// $c_0 + \sum_i c_i x_i$ (Takagi–Sugeno of order 1).
    Linear {
        /// One coefficient for each input.
        coefficients: Vec<f64>,
        /// $c_0$.
        constant: f64,
    },
    /// A formula in the inputs (variables 0 and up) and, behind them, the last answers of the outputs.
    Formula(Formula),
}

/// The answer where the rules give none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fallback {
    /// First choice: the previous answer, if the caller gives one.
    pub previous: bool,
    /// Second choice.
    pub value: FallbackValue,
}

/// The answer where the rules give none and no previous answer is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FallbackValue {
    /// The middle of the universe (MATLAB).
    Middle,
    /// A number (`DEFAULT` of FCL, `default` of fuzzylite).
    Number(f64),
    /// No answer at all.
    Nothing,
}

impl Default for Fallback {
    fn default() -> Self {
        Self { previous: false, value: FallbackValue::Nothing }
    }
}

/// Rules that share their norms.
#[derive(Clone, Debug, PartialEq)]
pub struct RuleBlock {
    /// Name; may be empty.
    pub name: String,
    /// What it is for; may be empty.
    pub description: String,
    /// A block that is switched off has no effect.
    pub enabled: bool,
    /// *and* between statements.
    pub and: TNorm,
    /// *or* between statements.
    pub or: SNorm,
    /// How the firing strength of a rule shapes its conclusion: minimum (Mamdani), product (Larsen).
    pub implication: TNorm,
    /// Which rules act.
    pub activation: Activation,
    /// Rules.
    pub rules: Vec<Rule>,
}

/// Which rules of a block act, and how strongly.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Activation {
    /// Every rule, as strongly as it fires.
    #[default]
    General,
    /// The first rules whose strength is at least the threshold.
    First {
        /// How many.
        count: u32,
        /// Smallest strength that counts.
        threshold: f64,
    },
    /// The last rules whose strength is at least the threshold.
    Last {
        /// How many.
        count: u32,
        /// Smallest strength that counts.
        threshold: f64,
    },
    /// The rules of highest strength; of equals the first.
    Highest {
        /// How many.
        count: u32,
    },
    /// The rules of lowest strength above zero; of equals the first.
    Lowest {
        /// How many.
        count: u32,
    },
    /// Every rule, with its strength divided by the sum of all strengths.
    Proportional,
    /// The rules whose strength compares so with the threshold.
    Threshold {
        /// How it must compare.
        comparison: Comparison,
        /// With what.
        threshold: f64,
    },
}

/// How two numbers compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// <
    Less,
    /// ≤
    AtMost,
    /// =
    Equal,
    /// ≠
    Unequal,
    /// ≥
    AtLeast,
    /// >
    Greater,
}

/// A rule: if the antecedent holds, then every consequent.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    /// Name or number in the file; may be empty.
    pub name: String,
    /// A rule that is switched off never fires.
    pub enabled: bool,
    /// When it fires.
    pub antecedent: Antecedent,
    /// What follows.
    pub consequents: Vec<Consequent>,
    /// Multiplies the firing strength; in [0, 1].
    pub weight: f64,
}

/// When a rule fires.
#[derive(Clone, Debug, PartialEq)]
pub enum Antecedent {
    /// Always, with strength 1: a rule without a condition.
    Always,
    /// A statement about one variable.
    Is(Statement),
    /// Every one, joined from left to right by the block's *and*.
    All(Vec<Self>),
    /// Any one, joined from left to right by the block's *or*.
    Any(Vec<Self>),
    /// One minus the other.
    Not(Box<Self>),
}

impl Antecedent {
    /// True if it has a statement about a variable that is so.
    pub fn asks(&self, is_so: &impl Fn(Variable) -> bool) -> bool {
        match self {
            Self::Always => false,
            Self::Is(statement) => is_so(statement.variable),
            Self::All(parts) | Self::Any(parts) => parts.iter().any(|it| it.asks(is_so)),
            Self::Not(part) => part.asks(is_so),
        }
    }

    /// True if it asks how strongly some output has been concluded.
    #[must_use]
    pub fn asks_outputs(&self) -> bool {
        self.asks(&|variable| matches!(variable, Variable::Output(_)))
    }
}

/// `variable is hedges term`.
#[derive(Clone, Debug, PartialEq)]
pub struct Statement {
    /// About what.
    pub variable: Variable,
    /// Which of its terms; `None` stands for the bare hedge `any`.
    pub term: Option<usize>,
    /// Hedges as written: the last one acts first.
    pub hedges: Vec<Hedge>,
}

/// What a statement is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    /// The input at this position.
    Input(usize),
    /// The output at this position: how strongly its term has been concluded by the rules before.
    Output(usize),
}

/// `output is hedges term`, in a conclusion.
#[derive(Clone, Debug, PartialEq)]
pub struct Consequent {
    /// Position of the output.
    pub output: usize,
    /// Position of its term.
    pub term: usize,
    /// Hedges as written, acting on the firing strength if it is above 0; the last one acts first.
    pub hedges: Vec<Hedge>,
}
