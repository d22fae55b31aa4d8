//! What a program does where the two sides of a comparison are the same number.

use super::super::ranges::{Known, Range, Ranges, rounded};
use crate::program::{Expression, Operator, Place, Precision, Program, Statement, each_expression};

/// A choice whose comparison is changed.
enum Choice<'a> {
    Value(&'a Expression, [&'a Expression; 2]),
    Blocks(&'a Expression, [&'a [Statement]; 2]),
}

/// True where two programs differ in whether a comparison holds for equal numbers, and both ways do the same there.
pub(super) fn is_the_same(program: &Program, changed: &Program, ranges: &Ranges<'_>) -> bool {
    let both = program.functions.iter().zip(&changed.functions);
    let Some((function, choice)) =
        both.filter_map(|(a, b)| Some((a, in_blocks(&a.body, &b.body)?))).next()
    else {
        return false;
    };
    let (Choice::Value(asked, _) | Choice::Blocks(asked, _)) = &choice;
    let Expression::Binary(_, left, right) = asked else { return false };
    let mut reads = Vec::new();
    each_expression(&function.body, &mut |value| {
        if let (Expression::Read(_), Some(Known::Real(range))) = (value, ranges.of(value)) {
            reads.push((value.clone(), *range));
        }
    });
    let known = At { left, right, reads: &reads, precision: program.precision };
    let [a, b] = [left, right].map(|side| match ranges.of(side) {
        Some(Known::Real(range)) => *range,
        _ => Range::ANY,
    });
    if a.has_zero() && b.has_zero() && (a.minus_zero || b.minus_zero) {
        return false;
    }
    match choice {
        Choice::Value(_, [then, otherwise]) => known.tidy(then) == known.tidy(otherwise),
        Choice::Blocks(_, [then, otherwise]) => {
            let mut ways = [Vec::new(), Vec::new()];
            known.done(then, &mut ways[0]).is_some()
                && known.done(otherwise, &mut ways[1]).is_some()
                && known.are_the_same(&ways)
        }
    }
}

fn is_comparison(value: &Expression) -> bool {
    matches!(value, Expression::Binary(Operator::Less | Operator::LessOrEqual, ..))
}

fn in_blocks<'a>(a: &'a [Statement], b: &[Statement]) -> Option<Choice<'a>> {
    let (a, b) = a.iter().zip(b).find(|(a, b)| a != b)?;
    match (a, b) {
        (Statement::If(asked, then, otherwise), Statement::If(other, then_b, otherwise_b)) => {
            if asked != other {
                if is_comparison(asked) && is_comparison(other) {
                    return Some(Choice::Blocks(asked, [then, otherwise]));
                }
                return in_values(asked, other);
            }
            in_blocks(then, then_b).or_else(|| in_blocks(otherwise, otherwise_b))
        }
        (Statement::For(.., a), Statement::For(.., b)) => in_blocks(a, b),
        (Statement::Let(.., a), Statement::Let(.., b))
        | (Statement::Set(_, a), Statement::Set(_, b))
        | (Statement::Return(Some(a)), Statement::Return(Some(b))) => in_values(a, b),
        _ => None,
    }
}

fn in_values<'a>(a: &'a Expression, b: &Expression) -> Option<Choice<'a>> {
    if let (Expression::Select(asked, then, otherwise), Expression::Select(other, ..)) = (a, b)
        && asked != other
        && is_comparison(asked)
        && is_comparison(other)
    {
        return Some(Choice::Value(asked, [then, otherwise]));
    }
    a.children()
        .into_iter()
        .zip(b.children())
        .find(|(a, b)| a != b)
        .and_then(|(a, b)| in_values(a, b))
}

/// The place at which the left side is the right one.
struct At<'a> {
    left: &'a Expression,
    right: &'a Expression,
    /// What is read in the function, and what it may be.
    reads: &'a [(Expression, Range)],
    precision: Precision,
}

type Done = Vec<(Place, Expression)>;

impl At<'_> {
    /// What a block puts where; none where it does more.
    fn done(&self, body: &[Statement], done: &mut Done) -> Option<()> {
        for statement in body {
            match statement {
                Statement::Remark(_) => {}
                Statement::Set(place, value) => {
                    let value = self.tidy(value);
                    done.retain(|(known, _)| known != place);
                    done.push((place.clone(), value));
                }
                Statement::If(condition, then, otherwise) => match self.tidy(condition) {
                    Expression::Truth(true) => self.done(then, done)?,
                    Expression::Truth(false) => self.done(otherwise, done)?,
                    _ => return None,
                },
                _ => return None,
            }
        }
        Some(())
    }

    fn are_the_same(&self, [a, b]: &[Done; 2]) -> bool {
        let in_way = |way: &Done, place: &Place| {
            let put = way.iter().find(|(known, _)| known == place).map(|(_, value)| value.clone());
            put.unwrap_or_else(|| self.tidy(&Expression::Read(place.clone())))
        };
        a.iter().chain(b).all(|(place, _)| in_way(a, place) == in_way(b, place))
    }

    fn range(&self, value: &Expression) -> Range {
        match value {
            Expression::Number(value) => Range::point(rounded(self.precision, *value)),
            Expression::Negative(inner) => self.range(inner).negative(),
            Expression::Binary(
                operator @ (Operator::Add
                | Operator::Subtract
                | Operator::Multiply
                | Operator::Divide),
                left,
                right,
            ) => self.range(left).computed(*operator, self.range(right), self.precision),
            value => {
                let known = self.reads.iter().filter(|(read, _)| read == value);
                let ranges = known.map(|(_, range)| *range);
                ranges.reduce(Range::joined).unwrap_or(Range::ANY)
            }
        }
    }

    /// The value there, as simple as can be seen; what is done to it changes no bit.
    fn tidy(&self, value: &Expression) -> Expression {
        if value == self.left {
            return self.right.clone();
        }
        match value {
            Expression::Negative(inner) => -self.tidy(inner),
            Expression::Magnitude(inner) => self.tidy(inner).magnitude(),
            Expression::Select(condition, then, otherwise) => match self.tidy(condition) {
                Expression::Truth(true) => self.tidy(then),
                Expression::Truth(false) => self.tidy(otherwise),
                condition => {
                    let (then, otherwise) = (self.tidy(then), self.tidy(otherwise));
                    if then == otherwise { then } else { condition.select(then, otherwise) }
                }
            },
            Expression::Binary(operator, left, right) => {
                self.joined(*operator, self.tidy(left), self.tidy(right))
            }
            other => other.clone(),
        }
    }

    fn joined(&self, operator: Operator, left: Expression, right: Expression) -> Expression {
        use Expression::Number;
        let (a, b) = (self.range(&left), self.range(&right));
        let truth = match operator {
            Operator::Less if left == right && !a.nan => Some(false),
            Operator::LessOrEqual if left == right && !a.nan => Some(true),
            Operator::Less => a.less(b, false).constant(),
            Operator::LessOrEqual => a.less(b, true).constant(),
            _ => None,
        };
        if let Some(truth) = truth {
            return Expression::Truth(truth);
        }
        let exact = |value: f64| Number(rounded(self.precision, value));
        match (operator, &left, &right) {
            (Operator::Subtract, _, _) if left == right && a.is_finite() => Number(0.0),
            (Operator::Divide, _, _) if left == right && a.is_finite() && !a.has_zero() => {
                Number(1.0)
            }
            (Operator::Divide, Number(zero), _) if *zero == 0.0 && b.low > 0.0 && !b.nan => {
                Number(0.0)
            }
            (Operator::Multiply, Number(a), Number(b)) => exact(a * b),
            (Operator::Add, Number(a), Number(b)) => {
                exact(rounded(self.precision, *a) + rounded(self.precision, *b))
            }
            _ => Expression::binary(operator, left, right),
        }
    }
}
