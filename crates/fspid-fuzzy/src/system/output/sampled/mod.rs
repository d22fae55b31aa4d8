//! Samples of the joined set, as other tools take them.

mod reading;
mod vertices;

use alloc::vec;
use alloc::vec::Vec;

use super::super::defuzzifier::{Defuzzifier, Sampling};
use super::super::norms::TNorm;
use super::super::parts::{Conclusion, Membership, Output};
use super::actors::{Activations, Level};
use super::{roomy_clone, set_grade};
use crate::defuzzifier::SampleGrid;
use crate::norm::{SNormKind, TNormKind};

/// Most grades that are computed once and for all.
const MOST_GRADES: usize = 1 << 18;

/// Samples of an output's universe.
#[derive(Clone, Debug)]
pub(crate) struct Sampled {
    sampling: Sampling,
    lower: f64,
    upper: f64,
    /// How many.
    count: u32,
    /// Cells between the ends.
    cells: f64,
    /// Where in its cell a sample lies.
    offset: f64,
    terms: usize,
    /// Grades of all terms at the first sample, then at the second, …; none where there would be
    /// too many, or they depend on the inputs.
    grades: Vec<f64>,
}

/// Memory for samples.
#[derive(Debug, Default)]
pub(crate) struct Samples {
    /// Grades of all terms at the sample at hand, if they are not known.
    terms: Vec<f64>,
    /// Grades of the joined set.
    joined: Vec<f64>,
    /// Place and grade of each corner.
    corners: Vec<[f64; 2]>,
    /// Where sets are cut within a cell.
    cuts: Vec<f64>,
}

impl Clone for Samples {
    /// A clone has as much room as the original.
    fn clone(&self) -> Self {
        Self {
            terms: self.terms.clone(),
            joined: roomy_clone(&self.joined),
            corners: roomy_clone(&self.corners),
            cuts: roomy_clone(&self.cuts),
        }
    }
}

/// What is concluded, and how it is joined.
#[derive(Clone, Copy)]
pub(crate) struct Concluded<'a> {
    pub(crate) output: &'a Output,
    pub(crate) actors: &'a Activations,
    pub(crate) levels: &'a [Level],
    pub(crate) inputs: &'a [f64],
}

impl Sampled {
    /// The samples of an output; nothing where the integral itself is asked for.
    pub(crate) fn of(output: &Output) -> Option<Self> {
        let (sampling, universe) = (output.defuzzifier.sampling()?, output.universe?);
        let SampleGrid { count, cells, offset, .. } = sampling.samples()?;
        let mut own = Self {
            sampling,
            lower: universe.lower,
            upper: universe.upper,
            count,
            cells: f64::from(cells),
            offset,
            terms: output.terms.len(),
            grades: Vec::new(),
        };
        own.tabulate(output);
        Some(own)
    }

    pub(super) fn sampling(&self) -> Sampling {
        self.sampling
    }

    fn tabulate(&mut self, output: &Output) {
        let fixed = output.terms.iter().all(|term| {
            matches!(&term.conclusion, Conclusion::Set { membership: Membership::Shape { .. }, .. })
        });
        let total = self.terms.saturating_mul(self.count as usize);
        if fixed && total <= MOST_GRADES {
            let mut grades = vec![0.0; total];
            for (n, place) in (0..self.count).zip(grades.chunks_exact_mut(self.terms.max(1))) {
                self.grade_terms(output, n, &[], &mut [], place);
            }
            self.grades = grades;
        }
    }

    /// Makes room for an evaluation.
    pub(crate) fn reserve(&self, actors: &Activations, samples: &mut Samples) {
        let count = self.count as usize;
        samples.terms.resize(samples.terms.len().max(2 * self.terms), 0.0);
        samples.joined.reserve(count);
        if matches!(self.sampling, Sampling::Vertices(_)) {
            samples.cuts.reserve(actors.len());
            samples.corners.reserve(count + self.most_cuts(actors));
        }
    }

    /// Where sample `n` lies.
    #[inline]
    fn place(&self, n: u32) -> f64 {
        let cell = f64::from(n) + self.offset;
        if cell < self.cells {
            self.lower + cell * (self.upper - self.lower) / self.cells
        } else {
            self.upper
        }
    }

    fn grade_terms(
        &self,
        output: &Output,
        n: u32,
        inputs: &[f64],
        room: &mut [f64],
        grades: &mut [f64],
    ) {
        let x = self.place(n);
        for (place, term) in grades.iter_mut().zip(&output.terms) {
            *place = set_grade(&term.conclusion, x, inputs, room);
        }
    }

    /// Grades of all terms at sample `n`.
    #[inline]
    fn terms<'g>(
        &'g self,
        n: u32,
        concluded: &Concluded<'_>,
        room: &mut [f64],
        anew: &'g mut [f64],
    ) -> &'g [f64] {
        let begin = n as usize * self.terms;
        if let Some(known) = self.grades.get(begin..begin + self.terms)
            && !self.grades.is_empty()
        {
            return known;
        }
        let anew = anew.get_mut(..self.terms).unwrap_or_default();
        self.grade_terms(concluded.output, n, concluded.inputs, room, anew);
        anew
    }

    /// The number that a method reads off the samples; nothing if they have no area.
    pub(crate) fn number(
        &self,
        method: Defuzzifier,
        concluded: &Concluded<'_>,
        room: &mut [f64],
        samples: &mut Samples,
    ) -> Option<f64> {
        if matches!(self.sampling, Sampling::Vertices(_)) {
            self.corners(concluded, room, samples);
            return reading::of_corners(method, &samples.corners);
        }
        let Samples { terms, joined, .. } = samples;
        joined.clear();
        joined
            .extend((0..self.count).map(|n| concluded.join(self.terms(n, concluded, room, terms))));
        self.read(method, joined)
    }
}

impl Concluded<'_> {
    /// Grade of the joined set where the terms have these grades.
    #[inline]
    fn join(&self, terms: &[f64]) -> f64 {
        self.join_with(|term| terms.get(term).copied())
    }

    /// Grade of the joined set, given the grade of each term.
    #[inline]
    pub(crate) fn join_with(&self, mut term: impl FnMut(usize) -> Option<f64>) -> f64 {
        let maximum = self.output.aggregation.is(SNormKind::Maximum);
        let mut joined = 0.0_f64;
        for (actor, level) in self.actors.list().iter().zip(self.levels) {
            if level.strength > 0.0 {
                let grade =
                    imply(&actor.implication, level.strength, term(actor.term).unwrap_or(0.0));
                let higher = if grade > joined { grade } else { joined };
                joined =
                    if maximum { higher } else { self.output.aggregation.apply(joined, grade) };
            }
        }
        joined
    }
}

/// What implication leaves of a set's grade.
#[inline]
fn imply(norm: &TNorm, strength: f64, grade: f64) -> f64 {
    if norm.is(TNormKind::Minimum) { strength.min(grade) } else { norm.apply(strength, grade) }
}
