//! Formulas in postfix order, so that they are computed without recursion.

use core::ops::Range;

use crate::compile::names::Names;
use crate::expression::{Expression, Function, One, Two};
use crate::finding::{Findings, Origin};
use crate::model::{Operation, STACK};

/// Puts the code of a formula at the end and answers where it stands.
pub(super) fn append(
    formula: &Expression,
    names: &Names<'_>,
    code: &mut Vec<Operation>,
    findings: &mut Findings,
) -> Range<usize> {
    let start = code.len();
    let mut writer = Writer { names, code, findings };
    writer.expression(formula);
    let deepest = deepest(code.get(start..).unwrap_or_default());
    if deepest > STACK {
        let message = format!("a formula that keeps {deepest} numbers waiting");
        findings.problem(Origin(None), "", message, format!("at most {STACK}; split it"));
    }
    start..code.len()
}

struct Writer<'a, 'n> {
    names: &'a Names<'n>,
    code: &'a mut Vec<Operation>,
    findings: &'a mut Findings,
}

impl Writer<'_, '_> {
    fn expression(&mut self, formula: &Expression) {
        match formula {
            Expression::Number(value) => self.code.push(Operation::Number(*value)),
            Expression::Variable { id, origin } => {
                let slot = self.names.variable(id, *origin, self.findings);
                self.code.push(Operation::Variable(slot.unwrap_or_default()));
            }
            Expression::Apply(function, operands) => self.application(*function, operands),
        }
    }

    fn application(&mut self, function: Function, operands: &[Expression]) {
        if let Some(expected) = function.refuses(operands.len()) {
            let message = format!("the number of operands is {}", operands.len());
            self.findings.problem(Origin(None), function.name(), message, expected);
            return;
        }
        match function {
            Function::Piecewise => self.piecewise(operands),
            Function::Minus if operands.len() == 1 => self.folded(operands, One::Negate.into()),
            Function::Minus => self.folded(operands, Two::Subtract.into()),
            Function::One(one) => self.folded(operands, one.into()),
            // Exact, and quicker than a general power.
            Function::Two(Two::Power) if operands.get(1) == Some(&Expression::Number(2.0)) => {
                self.folded(operands.get(..1).unwrap_or_default(), One::Square.into());
            }
            Function::Two(two) => self.folded(operands, two.into()),
            Function::Fold(two @ (Two::And | Two::Or)) if operands.len() == 1 => {
                // A single condition becomes 0 or 1 as several do.
                self.folded(operands, One::Not.into());
                self.code.push(One::Not.into());
                debug_assert!(matches!(two, Two::And | Two::Or), "the others keep their operand");
            }
            Function::Fold(two) => self.folded(operands, two.into()),
        }
    }

    /// The first operand, then each further one followed by the operation; a lone operand is followed by a function of
    /// one operand only.
    fn folded(&mut self, operands: &[Expression], operation: Operation) {
        for (index, operand) in operands.iter().enumerate() {
            self.expression(operand);
            if index > 0 || matches!(operation, Operation::One(_)) {
                self.code.push(operation);
            }
        }
    }

    /// From the last case to the first: the value so far, the value of the case, its condition, the choice.
    fn piecewise(&mut self, operands: &[Expression]) {
        let (pieces, otherwise) = operands.as_chunks::<2>();
        for operand in otherwise {
            self.expression(operand);
        }
        for piece in pieces.iter().rev() {
            for operand in piece {
                self.expression(operand);
            }
            self.code.push(Operation::Choose);
        }
    }
}

/// Most numbers that wait at once.
fn deepest(code: &[Operation]) -> usize {
    let mut waiting = 0_usize;
    let depths = code.iter().map(|operation| {
        waiting = (waiting + 1).saturating_sub(operation.operands());
        waiting
    });
    depths.max().unwrap_or(0)
}
