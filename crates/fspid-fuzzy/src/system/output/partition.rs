//! The centroid of evenly spaced triangles, by the formula of the fixed-size supervisor.

use alloc::vec::Vec;

use super::super::defuzzifier::Defuzzifier;
use super::super::parts::{Conclusion, Membership, Output, OutputTerm};
use super::actors::{Activations, Level};
use super::way::Way;
use crate::centroid::centroid;
use crate::defuzzifier;
use crate::membership::ShapeKind;
use crate::norm::{SNormKind, TNormKind};
use fspid_numeric::lanes::One;

/// Corners may be off by this many times the universe's span times the precision: what is lost when
/// they are computed from the spacing, and written and read again.
const SLACK: f64 = 8.0 * f64::EPSILON;
/// Fewest and most triangles; beyond, the general method is as good.
const COUNTS: core::ops::RangeInclusive<usize> = 2..=64;

/// Triangles one spacing apart, crossing at one half, from one end of the universe to the other.
#[derive(Clone, Debug)]
pub(crate) struct Partition {
    rule: defuzzifier::Defuzzifier,
    /// The actors of the terms from left to right, where there are any.
    actors: Vec<Option<usize>>,
    middle: f64,
    spacing: f64,
}

impl Partition {
    /// The partition that an output's terms make, if they do and are joined as the formula needs.
    pub(crate) fn of(output: &Output, actors: &Activations) -> Option<Self> {
        let Defuzzifier::Centroid(sampling) = output.defuzzifier else { return None };
        let (rule, universe) = (sampling, output.universe?);
        let joined = output.aggregation.is(SNormKind::Maximum)
            && actors.list().iter().all(|actor| actor.implication.is(TNormKind::Minimum));
        if !joined || actors.len() == 0 || !COUNTS.contains(&output.terms.len()) {
            return None;
        }
        let mut order: Vec<usize> = (0..output.terms.len()).collect();
        order.sort_by(|&a, &b| peak(output, a).total_cmp(&peak(output, b)));
        let gaps = (order.len() - 1) as f64;
        let (middle, spacing) = (universe.middle(), universe.span() / gaps);
        let slack = SLACK * universe.span();
        let fits = order.iter().enumerate().all(|(position, &term)| {
            let centre = universe.lower + spacing * position as f64;
            output.terms.get(term).and_then(triangle).is_some_and(|corners| {
                let ideal = [centre - spacing, centre, centre + spacing];
                corners.iter().zip(ideal).all(|(c, i)| (c - i).abs() <= slack)
            })
        });
        let own = order.iter().map(|&term| actors.about(term).next()).collect();
        fits.then_some(Self { rule, actors: own, middle, spacing })
    }

    /// What it does, in public words.
    pub(super) fn way(&self) -> Way {
        let Self { rule, ref actors, middle, spacing } = *self;
        Way::Partition { rule, actors: actors.clone(), middle, spacing }
    }

    /// The centroid, given the level of each actor; nothing if none fires. `sorted` has room for as
    /// many numbers as there are terms.
    pub(crate) fn centroid(&self, levels: &[Level], sorted: &mut [One<f64>]) -> Option<f64> {
        let sorted = sorted.get_mut(..self.actors.len())?;
        let mut strongest = 0.0_f64;
        for (place, actor) in sorted.iter_mut().zip(&self.actors) {
            let level = actor.and_then(|actor| levels.get(actor));
            *place = One(level.map_or(0.0, |level| level.strength));
            strongest = strongest.max(place.0);
        }
        // Below the normal range the quotient of moments would lose its digits.
        let answers = strongest >= f64::MIN_POSITIVE;
        answers.then(|| {
            let One(centre) = centroid(self.rule, sorted, One(0.0));
            self.middle + centre * self.spacing
        })
    }
}

fn peak(output: &Output, term: usize) -> f64 {
    output.terms.get(term).and_then(triangle).map_or(f64::NAN, |[_, peak, _]| peak)
}

/// The corners of a full-height type-1 triangle.
#[allow(clippy::float_cmp, reason = "a height of exactly 1 is what the formula needs")]
fn triangle(term: &OutputTerm) -> Option<[f64; 3]> {
    let Conclusion::Set {
        membership: Membership::Shape { kind: ShapeKind::Triangle, params, height },
        lower: None,
    } = &term.conclusion
    else {
        return None;
    };
    let corners: [f64; 3] = params.as_slice().try_into().ok()?;
    (*height == 1.0).then_some(corners)
}
