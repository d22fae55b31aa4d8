//! Which rules of a block act, as `activate` of `fspid-fuzzy`.

use fspid_fuzzy::system::{Activation, Comparison};

use super::{count_of, index_of, put};
use crate::program::{Expression, Kind, Operator, Place, Statement, element, local, number};

/// Where the strengths of acting rules stand.
pub(super) fn acting(activation: Activation) -> &'static str {
    if activation == Activation::General { "strengths" } else { "acting" }
}

fn strength() -> Expression {
    element("strengths", local("rule"))
}

fn acts(value: Expression) -> Statement {
    Statement::set_element("acting", local("rule"), value)
}

fn fires(threshold: f64) -> Expression {
    number(0.0).less(strength()).and(number(threshold).at_most(strength()))
}

/// Strengths of the rules from `first` to `last` as they act.
pub(super) fn activate(body: &mut Vec<Statement>, how: Activation, [first, last]: [usize; 2]) {
    let each = |inside: Vec<Statement>| {
        Statement::For("rule".to_owned(), count_of(first), count_of(last), inside)
    };
    match how {
        Activation::General => {}
        Activation::First { count, threshold } => {
            let left = format!("left_{first}");
            body.push(Statement::real(&left, number(f64::from(count))));
            body.push(each(kept(fires(threshold), &left)));
        }
        Activation::Threshold { comparison, threshold } => {
            let chosen = compares(comparison, threshold);
            body.push(each(vec![acts(chosen.select(strength(), number(0.0)))]));
        }
        Activation::Last { count, threshold } => {
            let (total, seen) = (format!("total_{first}"), format!("seen_{first}"));
            let more = |name: &str| Statement::set(name, local(name) + number(1.0));
            body.push(Statement::real(&total, number(0.0)));
            body.push(each(vec![Statement::when(fires(threshold), vec![more(&total)])]));
            let skip = local(&total) - number(f64::from(count));
            let chosen = fires(threshold).and(skip.at_most(local(&seen)));
            body.push(Statement::real(&seen, number(0.0)));
            body.push(each(vec![
                acts(chosen.select(strength(), number(0.0))),
                Statement::when(fires(threshold), vec![more(&seen)]),
            ]));
        }
        Activation::Highest { count } => {
            body.extend(ranked(count, [first, last], |best| local(best).less(strength())))
        }
        Activation::Lowest { count } => {
            body.extend(ranked(count, [first, last], |best| strength().less(local(best))))
        }
        Activation::Proportional => {
            let sum = format!("all_{first}");
            body.push(Statement::real(&sum, number(0.0)));
            body.push(each(vec![Statement::set(&sum, local(&sum) + strength())]));
            let share = Statement::If(
                number(0.0).less(local(&sum)),
                vec![acts(strength() / local(&sum))],
                vec![acts(number(0.0))],
            );
            body.push(each(vec![share]));
        }
    }
}

/// The first rules that act, as many as are left.
fn kept(chosen: Expression, left: &str) -> Vec<Statement> {
    let chosen = number(0.0).less(local(left)).and(chosen);
    let taken = vec![acts(strength()), Statement::set(left, local(left) - number(1.0))];
    vec![Statement::If(chosen, taken, vec![acts(number(0.0))])]
}

/// The best rules that fire, one after the other; of equals the first.
fn ranked(
    count: u32,
    [first, last]: [usize; 2],
    better: impl Fn(&str) -> Expression,
) -> Vec<Statement> {
    let rounds = usize::try_from(count).unwrap_or(usize::MAX).min(last + 1 - first);
    let (best, found) = (format!("best_{first}"), format!("best_rule_{first}"));
    let free =
        number(0.0).less(strength()).and(element("acting", local("rule")).at_most(number(0.0)));
    let none = local(&best).less(number(0.0));
    let chosen = free.and(none.or(better(&best)));
    let rule = || Expression::Read(Place::Local("rule".to_owned()));
    let look = Statement::when(
        chosen,
        vec![Statement::set(&best, strength()), Statement::set(&found, rule())],
    );
    let each = |inside: Vec<Statement>| {
        Statement::For("rule".to_owned(), count_of(first), count_of(last), inside)
    };
    let mut all: Vec<Statement> =
        (first..=last).map(|rule| put("acting", rule, number(0.0))).collect();
    if rounds == 0 {
        return all;
    }
    all.extend([
        Statement::real(&best, number(-1.0)),
        Statement::Let(found.clone(), Kind::Whole, index_of(first)),
        Statement::repeat(
            "turn",
            count_of(rounds),
            vec![
                Statement::set(&best, number(-1.0)),
                each(vec![look]),
                Statement::when(
                    number(0.0).less(local(&best)),
                    vec![Statement::set_element("acting", local(&found), local(&best))],
                ),
            ],
        ),
    ]);
    all
}

fn compares(comparison: Comparison, threshold: f64) -> Expression {
    let to = number(threshold);
    let join = |operator| Expression::binary(operator, strength(), to.clone());
    match comparison {
        Comparison::Less => join(Operator::Less),
        Comparison::AtMost => join(Operator::LessOrEqual),
        Comparison::Equal => join(Operator::Equal),
        Comparison::Unequal => join(Operator::NotEqual),
        Comparison::AtLeast => number(threshold).at_most(strength()),
        Comparison::Greater => number(threshold).less(strength()),
    }
}
