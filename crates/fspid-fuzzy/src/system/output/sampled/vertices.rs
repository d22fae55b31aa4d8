//! Samples and cut points: the line that scikit-fuzzy integrates.
//!
//! Each term is sampled and straight between the samples. To the samples are added the points where
//! a term's line has the height at which it is cut, but not those where two terms cross.
//!
//! # Source
//! scikit-fuzzy: the tutorial's tip of 19.8476 is this rule's, on 26 samples.

use super::{Concluded, Sampled, Samples};
use crate::norm::TNormKind;

use super::super::actors::Activations;

impl Sampled {
    /// Cuts that can lie between samples: one for each actor on each rise and fall of its term.
    pub(super) fn most_cuts(&self, actors: &Activations) -> usize {
        let runs = |term: usize| {
            let grades = || self.grades.iter().skip(term).step_by(self.terms);
            let changes = grades().zip(grades().skip(1)).filter(|(a, b)| a < b || b < a).count();
            if self.grades.is_empty() { self.count as usize } else { changes }
        };
        actors.list().iter().map(|actor| runs(actor.term)).sum()
    }

    /// The corners of the joined line.
    pub(super) fn corners(
        &self,
        concluded: &Concluded<'_>,
        room: &mut [f64],
        samples: &mut Samples,
    ) {
        let Samples { terms, corners, cuts, .. } = samples;
        corners.clear();
        let half = self.terms.min(terms.len());
        let (left, right) = terms.split_at_mut(half);
        let first = self.terms(0, concluded, room, left);
        corners.push([self.place(0), concluded.join(first)]);
        for n in 1..self.count {
            let begin = self.terms(n - 1, concluded, room, left);
            let end = self.terms(n, concluded, room, right);
            let x = [self.place(n - 1), self.place(n)];
            self.cut(concluded, [begin, end], cuts);
            for &t in cuts.iter() {
                corners.push([x[0] + (x[1] - x[0]) * t, concluded.join_between([begin, end], t)]);
            }
            corners.push([x[1], concluded.join(end)]);
        }
    }

    /// At which fractions of a cell, whose ends have these grades, actors are cut.
    fn cut(&self, concluded: &Concluded<'_>, ends: [&[f64]; 2], cuts: &mut alloc::vec::Vec<f64>) {
        cuts.clear();
        for (actor, level) in concluded.actors.list().iter().zip(concluded.levels) {
            let [Some(begin), Some(end)] = ends.map(|grades| grades.get(actor.term)) else {
                continue;
            };
            let strength = level.strength;
            let crosses =
                (*begin < strength && strength < *end) || (*end < strength && strength < *begin);
            if crosses && strength > 0.0 && actor.implication.is(TNormKind::Minimum) {
                cuts.push((strength - begin) / (end - begin));
            }
        }
        cuts.sort_unstable_by(f64::total_cmp);
    }
}

impl Concluded<'_> {
    /// Grade of the joined set a fraction `t` of the way between terms of these grades.
    fn join_between(&self, [begin, end]: [&[f64]; 2], t: f64) -> f64 {
        self.join_with(|term| {
            let (begin, end) = (begin.get(term).copied()?, end.get(term).copied()?);
            Some(begin * (1.0 - t) + end * t)
        })
    }
}
