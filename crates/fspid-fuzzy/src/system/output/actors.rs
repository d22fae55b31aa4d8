//! Grouping of an output's rule conclusions: those with the same term and implication are merged before aggregation.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use super::super::build::ResolvedConclusion;
use super::super::norms::TNorm;
use super::super::parts::{Output, RuleBlock};
use crate::norm::SNormKind;

/// Conclusions about one term that differ by their strength only. Under maximum the strongest
/// stands for all of them; otherwise each conclusion is an actor of its own.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Activation {
    pub(crate) term: usize,
    pub(crate) implication: TNorm,
}

/// The actors of an output.
#[derive(Clone, Debug)]
pub(crate) struct Activations {
    /// By term, then in the order of the conclusions.
    list: Vec<Activation>,
    /// Those of each term.
    of_term: Vec<Range<usize>>,
    /// The conclusions of the first actor, then those of the second, …, each in their order: their
    /// positions in the output's list.
    conclusions: Vec<usize>,
    /// Where in that list each actor ends.
    ends: Vec<usize>,
}

/// Strength of an actor, and the conclusion that it is of.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Level {
    pub(crate) strength: f64,
    pub(crate) conclusion: usize,
}

impl Activations {
    pub(crate) fn of(
        output: &Output,
        conclusions: &[&ResolvedConclusion],
        blocks: &[&RuleBlock],
    ) -> Self {
        let strongest_stands = output.aggregation.is(SNormKind::Maximum);
        let mut of_conclusion = vec![0; conclusions.len()];
        let mut list: Vec<Activation> = Vec::new();
        let mut of_term = Vec::new();
        for term in 0..output.terms.len() {
            let begin = list.len();
            let about = conclusions.iter().zip(blocks).zip(&mut of_conclusion);
            for ((_, block), place) in about.filter(|((c, _), _)| c.term == term) {
                let actor = Activation { term, implication: block.implication.clone() };
                let alike = |known: &Activation| {
                    strongest_stands
                        && *known == actor
                        && matches!(actor.implication, TNorm::Kind(_))
                };
                let own = list.get(begin..).unwrap_or_default();
                *place = begin + own.iter().position(alike).unwrap_or(own.len());
                if *place == list.len() {
                    list.push(actor);
                }
            }
            of_term.push(begin..list.len());
        }
        let mut sorted: Vec<usize> = (0..conclusions.len()).collect();
        let actor = |&position: &usize| of_conclusion.get(position).copied().unwrap_or(0);
        sorted.sort_by_key(actor);
        let ends = (1..=list.len()).map(|next| sorted.partition_point(|own| actor(own) < next));
        Self { ends: ends.collect(), list, of_term, conclusions: sorted }
    }

    pub(crate) fn len(&self) -> usize {
        self.list.len()
    }

    pub(crate) fn list(&self) -> &[Activation] {
        &self.list
    }

    /// The conclusions of each actor: their positions in the output's list.
    pub(super) fn conclusions(&self) -> impl Iterator<Item = &[usize]> {
        let begins = core::iter::once(0).chain(self.ends.iter().copied());
        begins
            .zip(&self.ends)
            .map(|(begin, &end)| self.conclusions.get(begin..end).unwrap_or_default())
    }

    /// Positions of the actors of a term.
    #[inline]
    pub(crate) fn about(&self, term: usize) -> Range<usize> {
        self.of_term.get(term).cloned().unwrap_or_default()
    }

    /// Strengths of the actors from the degrees of all conclusions; those of the output stand at
    /// `conclusions`.
    #[inline]
    pub(crate) fn levels<'l>(
        &self,
        conclusions: &[usize],
        degrees: &[f64],
        levels: &'l mut [Level],
    ) -> &'l [Level] {
        let levels = levels.get_mut(..self.list.len()).unwrap_or_default();
        let mut begin = 0;
        for (level, &end) in levels.iter_mut().zip(&self.ends) {
            *level = Level::default();
            for &position in self.conclusions.get(begin..end).unwrap_or_default() {
                let conclusion = conclusions.get(position).copied().unwrap_or(0);
                let strength = degrees.get(conclusion).copied().unwrap_or(0.0);
                let stronger = strength > level.strength;
                level.conclusion = if stronger { conclusion } else { level.conclusion };
                level.strength = if stronger { strength } else { level.strength };
            }
            begin = end;
        }
        levels
    }
}
