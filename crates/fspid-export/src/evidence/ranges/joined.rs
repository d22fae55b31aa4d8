//! Arrays, whole numbers and bytes of which intervals are known.

use super::known::{Known, Range, Truth};
use crate::program::Operator;

fn places(index: &Known, count: usize) -> std::ops::RangeInclusive<usize> {
    let last = count.saturating_sub(1);
    let end = |it: i32| usize::try_from(it).unwrap_or(0).min(last);
    match index {
        Known::Whole([low, high]) => end(*low)..=end(*high),
        _ => 0..=last,
    }
}

pub(super) fn fetched(array: Option<&Known>, index: &Known) -> Known {
    match array {
        Some(Known::Reals(all)) => {
            let all = all.get(places(index, all.len())).into_iter().flatten().copied();
            Known::Real(all.reduce(Range::joined).unwrap_or(Range::ANY))
        }
        Some(Known::Bytes(all)) => {
            let all = all.get(places(index, all.len())).unwrap_or_default();
            let end = |it: Option<&u8>| it.map_or(0, |it| i32::from(*it));
            Known::Whole([end(all.iter().min()), end(all.iter().max())])
        }
        _ => Known::Real(Range::ANY),
    }
}

pub(super) fn store(array: Option<&mut Known>, index: &Known, known: Known) {
    if let (Some(Known::Reals(all)), Known::Real(range)) = (array, known) {
        let places = places(index, all.len());
        let is_one = places.start() == places.end();
        for held in all.get_mut(places).into_iter().flatten() {
            *held = if is_one { range } else { held.joined(range) };
        }
    }
}

pub(super) fn wholes(operator: Operator, a: [i32; 2], b: [i32; 2]) -> Known {
    let all = |of: fn(i32, i32) -> i32| {
        let ends = [of(a[0], b[0]), of(a[0], b[1]), of(a[1], b[0]), of(a[1], b[1])];
        let [mut low, mut high] = [ends[0]; 2];
        ends.iter().for_each(|end| (low, high) = (low.min(*end), high.max(*end)));
        Known::Whole([low, high])
    };
    let apart = a[1] < b[0] || b[1] < a[0];
    let one = a == b && a[0] == a[1];
    let equal = Truth { yes: !apart, no: !one };
    match operator {
        Operator::Add => all(i32::saturating_add),
        Operator::Subtract => all(i32::saturating_sub),
        Operator::Multiply => all(i32::saturating_mul),
        Operator::Equal => Known::Truth(equal),
        Operator::NotEqual => Known::Truth(equal.negated()),
        Operator::Less => Known::Truth(Truth { yes: a[0] < b[1], no: a[1] >= b[0] }),
        Operator::LessOrEqual => Known::Truth(Truth { yes: a[0] <= b[1], no: a[1] > b[0] }),
        _ => Known::Truth(Truth::ANY),
    }
}

pub(super) fn bytes(operator: Operator, a: Option<u8>, b: Option<u8>) -> Known {
    match (operator, a, b) {
        (Operator::BitOr, a, b) => Known::Byte(a.zip(b).map(|(a, b)| a | b)),
        (Operator::Equal, Some(a), Some(b)) => Known::Truth(Truth::of(a == b)),
        (Operator::NotEqual, Some(a), Some(b)) => Known::Truth(Truth::of(a != b)),
        _ => Known::Truth(Truth::ANY),
    }
}
