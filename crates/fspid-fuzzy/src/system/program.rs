//! Antecedents, resolved to a postfix program over numbered statements.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;
use core::ops::Range;

use super::parts::{Antecedent, RuleBlock, Statement, Variable};
use fspid_numeric::scalar::Scalar;

/// Deepest nesting of an antecedent.
pub(crate) const MAX_DEPTH: usize = 64;
/// Room for intermediate grades: one for each level, and the operand at hand.
pub(crate) const STACK: usize = MAX_DEPTH + 2;

/// One step of an antecedent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    /// The grade of a statement.
    Statement(usize),
    /// 1.
    Always,
    /// The last two by the block's *and*.
    And,
    /// The last two by the block's *or*.
    Or,
    /// One minus the last.
    Not,
}

/// What an antecedent looks like; most are short chains, which need no stack.
#[derive(Clone, Debug)]
pub(crate) enum Form {
    /// Statements, at least one, all joined by *and* (so is a single one).
    All(Range<usize>),
    /// Statements, all joined by *or*.
    Any(Range<usize>),
    /// Anything else.
    Other,
}

/// Statements that occur in rules, each once, and the steps of all rules one after the other.
#[derive(Clone, Debug, Default)]
pub(crate) struct Program {
    pub(crate) statements: Vec<Statement>,
    pub(crate) steps: Vec<Step>,
    /// The statements of antecedents that are plain chains.
    operands: Vec<usize>,
    /// The statements about each term of each input, so that building takes linear time.
    by_term: BTreeMap<(usize, Option<usize>), Vec<usize>>,
}

impl Program {
    /// Appends the steps of an antecedent; their positions are answered.
    pub(crate) fn append(&mut self, antecedent: &Antecedent) -> Range<usize> {
        let begin = self.steps.len();
        self.append_steps(antecedent);
        begin..self.steps.len()
    }

    /// The form of steps that have been appended.
    pub(crate) fn form(&mut self, steps: Range<usize>) -> Form {
        let begin = self.operands.len();
        let (mut all, mut any) = (true, true);
        for step in self.steps.get(steps.clone()).unwrap_or_default() {
            match *step {
                Step::Statement(statement) => self.operands.push(statement),
                Step::And => any = false,
                Step::Or => all = false,
                Step::Always | Step::Not => (all, any) = (false, false),
            }
        }
        // One joining step less than operands, and each right after its operand: no brackets.
        let operands = begin..self.operands.len();
        let is_chain = self.is_chain(steps);
        match (all && is_chain, any && is_chain) {
            (true, _) => Form::All(operands),
            (false, true) => Form::Any(operands),
            (false, false) => Form::Other,
        }
    }

    /// True for a statement followed by any number of pairs of a statement and a joining step.
    fn is_chain(&self, steps: Range<usize>) -> bool {
        let is_statement = |step: &Step| matches!(step, Step::Statement(_));
        match self.steps.get(steps) {
            Some([first, pairs @ ..]) => {
                is_statement(first)
                    && pairs.chunks(2).all(|pair| match pair {
                        [operand, join] => is_statement(operand) && !is_statement(join),
                        _ => false,
                    })
            }
            _ => false,
        }
    }

    /// The statements of a chain.
    #[inline]
    pub(crate) fn operands(&self, chain: Range<usize>) -> &[usize] {
        self.operands.get(chain).unwrap_or_default()
    }

    fn append_steps(&mut self, antecedent: &Antecedent) {
        match antecedent {
            Antecedent::Always => self.steps.push(Step::Always),
            Antecedent::Is(statement) => {
                let step = Step::Statement(self.number(statement));
                self.steps.push(step);
            }
            Antecedent::All(parts) => self.append_joined(parts, Step::And),
            Antecedent::Any(parts) => self.append_joined(parts, Step::Or),
            Antecedent::Not(part) => {
                self.append_steps(part);
                self.steps.push(Step::Not);
            }
        }
    }

    fn append_joined(&mut self, parts: &[Antecedent], join: Step) {
        if parts.is_empty() {
            self.steps.push(Step::Always);
        }
        for (index, part) in parts.iter().enumerate() {
            self.append_steps(part);
            if index > 0 {
                self.steps.push(join);
            }
        }
    }

    /// Statements about inputs are graded once however often they occur; those about outputs change
    /// from rule to rule and keep a number of their own.
    fn number(&mut self, statement: &Statement) -> usize {
        let next = self.statements.len();
        if let Variable::Input(input) = statement.variable {
            let alike = self.by_term.entry((input, statement.term)).or_default();
            let known =
                alike.iter().copied().find(|&index| self.statements.get(index) == Some(statement));
            if let Some(index) = known {
                return index;
            }
            alike.push(next);
        }
        self.statements.push(statement.clone());
        next
    }
}

/// The strength of a chain of statements.
#[inline]
pub(crate) fn chain<S: Scalar>(
    operands: &[usize],
    join: impl Fn(S, S) -> S,
    mut grade: impl FnMut(usize) -> S,
) -> S {
    let Some((&first, others)) = operands.split_first() else { return S::one() };
    let first = grade(first);
    others.iter().fold(first, |joined, &operand| join(joined, grade(operand)))
}

/// The strength of an antecedent, given how to grade a statement.
#[inline]
pub(crate) fn strength<S: Scalar>(
    steps: &[Step],
    block: &RuleBlock,
    stack: &mut [S],
    mut grade: impl FnMut(usize) -> S,
) -> S {
    let mut top = 0;
    for &step in steps {
        match step {
            Step::Statement(index) => {
                push(stack, &mut top, grade(index));
            }
            Step::Always => push(stack, &mut top, S::one()),
            Step::Not => {
                let last = pop(stack, &mut top);
                push(stack, &mut top, S::one() - last);
            }
            Step::And => {
                let (right, left) = (pop(stack, &mut top), pop(stack, &mut top));
                push(stack, &mut top, block.and.apply(left, right));
            }
            Step::Or => {
                let (right, left) = (pop(stack, &mut top), pop(stack, &mut top));
                push(stack, &mut top, block.or.apply(left, right));
            }
        }
    }
    pop(stack, &mut top)
}

/// The depth is checked when the system is built, so that the stack is never full.
#[inline]
fn push<S: Scalar>(stack: &mut [S], top: &mut usize, value: S) {
    if let Some(place) = stack.get_mut(*top) {
        *place = value;
        *top += 1;
    }
}

#[inline]
fn pop<S: Scalar>(stack: &[S], top: &mut usize) -> S {
    *top = top.saturating_sub(1);
    stack.get(*top).copied().unwrap_or_else(S::zero)
}
