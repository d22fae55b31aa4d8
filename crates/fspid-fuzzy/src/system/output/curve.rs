//! The joined set as a function that can be asked with any kind of number.

use alloc::vec;
use alloc::vec::Vec;

use super::super::norms::{SNorm, TNorm};
use super::super::parts::{Conclusion, Membership};
use super::actors::Activation;
use super::sampled::Concluded;
use crate::norm::{SNormKind, TNormKind};
use fspid_numeric::quadrature::Curve;
use fspid_numeric::scalar::Scalar;

/// Parameters and variables that need no heap.
const ROOM: usize = 8;

/// The joined set, scaled.
#[derive(Clone, Copy)]
pub(super) struct JoinedCurve<'a> {
    concluded: Concluded<'a>,
    /// Activations that fire, those of one term from strong to weak.
    order: &'a [usize],
    /// A power of two.
    scale: f64,
}

impl<'a> JoinedCurve<'a> {
    /// `order` is memory for as many numbers as there are actors.
    pub(super) fn new(concluded: Concluded<'a>, order: &'a mut Vec<usize>, scale: f64) -> Self {
        let Concluded { actors, levels, .. } = concluded;
        let strength = |&own: &usize| levels.get(own).map_or(0.0, |level| level.strength);
        let term = |&own: &usize| actors.list().get(own).map_or(0, |actor| actor.term);
        order.clear();
        order.extend((0..actors.len()).filter(|own| strength(own) > 0.0));
        order.sort_unstable_by(|a, b| {
            let stronger = strength(b).total_cmp(&strength(a));
            term(a).cmp(&term(b)).then(stronger).then(a.cmp(b))
        });
        Self { concluded, order, scale }
    }

    /// An actor and what implication leaves of its set.
    fn implied<S: Scalar>(&self, own: usize, x: S) -> Option<(&'a Activation, S)> {
        let Concluded { output, actors, levels, inputs } = self.concluded;
        let (actor, level) = (actors.list().get(own)?, levels.get(own)?);
        match &output.terms.get(actor.term)?.conclusion {
            Conclusion::Set { membership, .. } => {
                let grade = grade(membership, x, inputs);
                Some((actor, imply(&actor.implication, S::constant(level.strength), grade)))
            }
            _ => None,
        }
    }
}

impl Curve for JoinedCurve<'_> {
    fn at<S: Scalar>(&self, x: S) -> S {
        let norm = &self.concluded.output.aggregation;
        let (mut joined, mut last): (Option<S>, Option<(&Activation, S)>) = (None, None);
        for (actor, grade) in self.order.iter().filter_map(|&own| self.implied(own, x)) {
            last = match last {
                Some((before, strong)) if before == actor => {
                    Some((actor, aggregate_ordered(norm, strong, grade)))
                }
                Some((_, done)) => {
                    joined = Some(joined.map_or(done, |joined| aggregate(norm, joined, done)));
                    Some((actor, grade))
                }
                None => Some((actor, begin(norm, grade))),
            };
        }
        let joined = match (joined, last) {
            (Some(joined), Some((_, done))) => aggregate(norm, joined, done),
            (None, Some((_, done))) => done,
            (_, None) => S::zero(),
        };
        joined * S::constant(self.scale)
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

/// What joining makes of two grades of one set, of which the weaker is nowhere above the stronger:
/// to ask which is larger would be a kink wherever both follow the set.
fn aggregate_ordered<S: Scalar>(norm: &SNorm, strong: S, weak: S) -> S {
    let rest = S::one() - strong;
    match norm {
        SNorm::Kind(SNormKind::DrasticSum) => S::zero().if_less(weak, S::one(), strong),
        SNorm::Kind(SNormKind::NilpotentMaximum) => weak.if_less(rest, strong, S::one()),
        SNorm::Kind(SNormKind::HamacherSum) => {
            let both = (S::one() - weak * strong).larger(S::constant(f64::MIN_POSITIVE));
            strong + weak * rest * (rest / both)
        }
        _ => aggregate(norm, strong, weak),
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
