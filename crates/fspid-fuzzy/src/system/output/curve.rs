//! The joined set as a function that can be asked with any kind of number.

use alloc::vec;

use super::super::norms::{SNorm, TNorm};
use super::super::parts::{Conclusion, Membership};
use super::sampled::Concluded;
use crate::norm::{SNormKind, TNormKind};
use crate::quadrature::Curve;
use crate::scalar::Scalar;

/// Parameters and variables that need no heap.
const ROOM: usize = 8;

/// The joined set, scaled.
#[derive(Clone, Copy)]
pub(super) struct JoinedCurve<'a> {
    pub(super) concluded: Concluded<'a>,
    /// A power of two.
    pub(super) scale: f64,
}

impl Curve for JoinedCurve<'_> {
    fn at<S: Scalar>(&self, x: S) -> S {
        let Concluded { output, actors, levels, inputs } = self.concluded;
        let mut joined: Option<S> = None;
        for (actor, level) in actors.list().iter().zip(levels) {
            let conclusion = output.terms.get(actor.term).map(|term| &term.conclusion);
            if level.strength > 0.0
                && let Some(Conclusion::Set { membership, .. }) = conclusion
            {
                let (strength, grade) = (S::constant(level.strength), grade(membership, x, inputs));
                let grade = imply(&actor.implication, strength, grade);
                joined = Some(match joined {
                    Some(joined) => aggregate(&output.aggregation, joined, grade),
                    None => begin(&output.aggregation, grade),
                });
            }
        }
        joined.unwrap_or_else(S::zero) * S::constant(self.scale)
    }
}

/// What implication leaves of a grade; the strength is above 0.
///
/// The norms of the family are arranged to keep identities to the last bit, for which they choose
/// between values that are equal but for rounding. Here such choices would look like kinks
/// everywhere, so the same functions are written without them.
fn imply<S: Scalar>(norm: &TNorm, strength: S, grade: S) -> S {
    let product = strength * grade;
    match norm {
        TNorm::Kind(TNormKind::EinsteinProduct) => {
            product / (S::one() + (S::one() - strength) * (S::one() - grade))
        }
        TNorm::Kind(TNormKind::HamacherProduct) => {
            product / (strength + grade * (S::one() - strength))
        }
        TNorm::Kind(TNormKind::BoundedDifference) => {
            (grade - (S::one() - strength)).larger(S::zero())
        }
        _ => norm.apply(strength, grade),
    }
}

/// What joining makes of the first grade.
fn begin<S: Scalar>(norm: &SNorm, grade: S) -> S {
    match norm {
        SNorm::Kind(_) => grade,
        SNorm::Formula(_) => norm.apply(S::zero(), grade),
    }
}

/// What joining makes of two grades.
fn aggregate<S: Scalar>(norm: &SNorm, joined: S, grade: S) -> S {
    let sum = joined + grade;
    match norm {
        SNorm::Kind(SNormKind::AlgebraicSum) => joined + grade * (S::one() - joined),
        SNorm::Kind(SNormKind::EinsteinSum) => sum / (S::one() + joined * grade),
        SNorm::Kind(SNormKind::BoundedSum | SNormKind::NormalizedSum) => sum.smaller(S::one()),
        SNorm::Kind(SNormKind::UnboundedSum) => sum,
        _ => norm.apply(joined, grade),
    }
}

fn grade<S: Scalar>(membership: &Membership, x: S, inputs: &[f64]) -> S {
    match membership {
        Membership::Shape { kind, params, height } => {
            let grade = with_room(params.len(), |room| kind.grade(S::lift(params, room), x));
            if *height < 1.0 { grade * S::constant(*height) } else { grade }
        }
        Membership::Formula { formula, height } => {
            let grade = with_room(inputs.len() + 1, |room| {
                let variables = [x].into_iter().chain(inputs.iter().map(|&v| S::constant(v)));
                room.iter_mut().zip(variables).for_each(|(place, variable)| *place = variable);
                formula.evaluate(room).unit()
            });
            if *height < 1.0 { grade * S::constant(*height) } else { grade }
        }
    }
}

/// Calls with so much room; from the heap only if it is more than usual.
fn with_room<S: Scalar>(count: usize, call: impl FnOnce(&mut [S]) -> S) -> S {
    let mut usual = [S::zero(); ROOM];
    match usual.get_mut(..count) {
        Some(room) => call(room),
        None => call(&mut vec![S::zero(); count]),
    }
}
