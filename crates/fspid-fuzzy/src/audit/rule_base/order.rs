//! Terms from left to right.

use alloc::vec;
use alloc::vec::Vec;

use crate::system::{Conclusion, Input, Membership, Output, Universe};

/// Points at which a set is looked at to find where it is highest.
const POINTS: u32 = 1000;

/// Positions of an input's terms from left to right, if they can be put in order.
pub(super) fn of_input(input: &Input) -> Option<Vec<usize>> {
    let places = input.terms.iter().map(|term| peak(&term.membership, input.universe));
    ordered(places.collect())
}

/// Positions of an output's terms from left to right, if they can be put in order.
pub(super) fn of_output(output: &Output) -> Option<Vec<usize>> {
    let places = output.terms.iter().map(|term| match &term.conclusion {
        Conclusion::Set { membership, .. } => peak(membership, output.universe),
        Conclusion::Constant(constant) => Some(*constant),
        Conclusion::Interval([lower, upper]) => Some(0.5 * lower + 0.5 * upper),
        Conclusion::Linear { .. } | Conclusion::Formula(_) => None,
    });
    ordered(places.collect())
}

/// The middle of the points of highest grade.
fn peak(membership: &Membership, universe: Option<Universe>) -> Option<f64> {
    let universe = universe?;
    let Membership::Shape { kind, params, .. } = membership else { return None };
    let x = |n: u32| universe.lower + universe.span() * (f64::from(n) / f64::from(POINTS));
    let grades: Vec<f64> = (0..=POINTS).map(|n| kind.grade(params, x(n))).collect();
    let highest = grades.iter().copied().fold(0.0, f64::max);
    let top = |grade: &f64| *grade >= highest * (1.0 - 1e-9);
    let first = (0..).zip(&grades).find(|(_, grade)| top(grade))?.0;
    let last = (0..).zip(&grades).filter(|(_, grade)| top(grade)).last()?.0;
    (highest > 0.0).then(|| 0.5 * (x(first) + x(last)))
}

/// Positions in ascending order of their places; nothing if a place is missing or taken twice.
fn ordered(places: Vec<Option<f64>>) -> Option<Vec<usize>> {
    let places: Option<Vec<f64>> = places.into_iter().collect();
    let places = places?;
    let place = |position: usize| places.get(position).copied().unwrap_or(f64::NAN);
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by(|&a, &b| place(a).total_cmp(&place(b)));
    let distinct = order.windows(2).all(|pair| match pair {
        &[left, right] => place(left) < place(right),
        _ => true,
    });
    distinct.then_some(order)
}

/// The rank of each position.
pub(super) fn ranks(order: &[usize]) -> Vec<usize> {
    let mut ranks = vec![0; order.len()];
    for (rank, &position) in order.iter().enumerate() {
        if let Some(place) = ranks.get_mut(position) {
            *place = rank;
        }
    }
    ranks
}
