//! Membership functions in MATLAB's words: the same function, or the nearest trapezoid.

use crate::fit::Landmarks;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{Membership, Universe};

use super::fit;
use super::losses::Losses;
use crate::fis::shape::by_kind;

/// A membership function as the file has it: name and parameters in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Function {
    pub(super) name: &'static str,
    pub(super) params: Vec<f64>,
    pub(super) height: f64,
}

impl Function {
    fn new(name: &'static str, params: &[f64]) -> Self {
        Self { name, params: params.to_vec(), height: 1.0 }
    }
}

/// The function in MATLAB's words. A height is left to the caller if `heights`.
pub(super) fn function(
    place: &str,
    membership: &Membership,
    universe: Universe,
    heights: bool,
    losses: &mut Losses,
) -> Function {
    let (Membership::Shape { height, .. } | Membership::Formula { height, .. }) = membership;
    let (exact, what) = match membership {
        Membership::Shape { kind, params, .. } => (exact(*kind, params), kind.name()),
        Membership::Formula { .. } => (None, "formula"),
    };
    let full_height = heights || height.to_bits() == 1.0_f64.to_bits();
    match exact {
        Some((function, same)) if full_height => {
            if !same {
                let name = function.name;
                losses.note(format!("{place}: `{what}` is written as `{name}`, the same function"));
            }
            Function { height: *height, ..function }
        }
        _ => fitted(place, what, membership, universe, losses),
    }
}

fn fitted(
    place: &str,
    what: &str,
    membership: &Membership,
    universe: Universe,
    losses: &mut Losses,
) -> Function {
    if let Membership::Formula { formula, .. } = membership
        && (1..=64).any(|variable| formula.uses(variable))
    {
        losses.never(format!("{place}: a formula in the inputs cannot be written"));
        // Nothing is written, so that nothing is told of what would stand for it.
        return Function::new("trapmf", &[]);
    }
    let marks = match membership {
        Membership::Shape { kind, params, .. } => Landmarks::of(*kind, params).marks,
        Membership::Formula { .. } => Vec::new(),
    };
    let (params, error) = fit::trapezoid(|x| grade(membership, x), universe, &marks);
    losses.lost(format!(
        "{place}: MATLAB has no such `{what}`; the nearest trapezoid differs by up to {error:.4}"
    ));
    Function::new("trapmf", &params)
}

fn grade(membership: &Membership, x: f64) -> f64 {
    match membership {
        Membership::Shape { kind, params, height } => kind.grade(params, x) * height,
        Membership::Formula { formula, height } => {
            let mut values = [0.0; 65];
            values[0] = x;
            formula.evaluate(&values).clamp(0.0, 1.0) * height
        }
    }
}

/// The same function in MATLAB's words, and whether it reads back as the same kind.
fn exact(kind: ShapeKind, params: &[f64]) -> Option<(Function, bool)> {
    let infinity = f64::INFINITY;
    let other = |name, params: &[f64]| Some((Function::new(name, params), false));
    match (kind, params) {
        (ShapeKind::Singleton, &[at]) => Some((Function::new("trimf", &[at; 3]), true)),
        (ShapeKind::Ramp, &[start, end]) if start < end => other("linsmf", &[start, end]),
        (ShapeKind::Ramp, &[start, end]) => other("linzmf", &[end, start]),
        (ShapeKind::Rectangle, &[start, end]) if start < end => {
            other("trapmf", &[start, start, end, end])
        }
        (ShapeKind::Rectangle, &[start, _]) => other("trimf", &[start; 3]),
        (ShapeKind::Step, &[at, direction]) if direction > 0.0 => {
            other("trapmf", &[at, at, infinity, infinity])
        }
        (ShapeKind::Step, &[at, _]) => other("trapmf", &[-infinity, -infinity, at, at]),
        (ShapeKind::Points, points) => straight(points).and_then(|(name, p)| other(name, &p)),
        _ => {
            let row = by_kind(kind)?;
            let mut file = vec![0.0; row.order.len()];
            for (&place, &value) in row.order.iter().zip(params) {
                *file.get_mut(place)? = value;
            }
            Some((Function::new(row.name, &file), true))
        }
    }
}

/// Points that are a triangle, a trapezoid or a single slope.
fn straight(points: &[f64]) -> Option<(&'static str, Vec<f64>)> {
    let at: Vec<f64> = points.iter().step_by(2).copied().collect();
    let tops: Vec<bool> = points.iter().skip(1).step_by(2).map(|grade| *grade >= 1.0).collect();
    let whole = points.iter().skip(1).step_by(2).all(|grade| *grade <= 0.0 || *grade >= 1.0);
    let name = match tops[..] {
        [false, true, false] => "trimf",
        [false, true, true, false] => "trapmf",
        [false, true] => "linsmf",
        [true, false] => "linzmf",
        _ => return None,
    };
    whole.then_some((name, at))
}
