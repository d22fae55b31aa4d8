//! The method by which an output is computed (closed form, quadrature, samples), for code generators.

use alloc::vec::Vec;

use super::super::build::{ResolvedOutput, System};
use super::super::defuzzifier::Sampling;
use super::super::norms::TNorm;
use super::Plan;

/// How the number of an output is found from the levels of its [`Actor`]s.
#[derive(Clone, Debug, PartialEq)]
pub enum Way {
    /// Centroid of evenly spaced triangles, by the formula of the fixed-size supervisor.
    Partition {
        /// How its integrals are computed.
        rule: Sampling,
        /// The actors of the terms from left to right, where there are any.
        actors: Vec<Option<usize>>,
        /// Middle of the universe.
        middle: f64,
        /// From peak to peak.
        spacing: f64,
    },
    /// Read off the outline of piecewise-linear sets, in closed form.
    Polygon {
        /// How conclusions are joined.
        join: Join,
        /// The universe, cut at every corner of every set.
        cells: Vec<Cell>,
        /// Whether each actor scales its set (product); the others cut theirs (minimum).
        scales: Vec<bool>,
        /// Middle of the universe.
        middle: f64,
    },
    /// Read off samples.
    Sampled(Sampling),
    /// Integrated with a certified bound on the error, in as many steps as that needs.
    Integral,
    /// Weighted average or sum of the conclusions.
    Weighted,
    /// Type reduction of interval type-2 sets, by iteration.
    Type2,
}

/// How conclusions are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Join {
    /// The highest.
    Maximum,
    /// The sum.
    Sum,
    /// The sum, but no more than 1.
    BoundedSum,
}

/// A part of the universe in which every set is straight.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// From and to.
    pub x: [f64; 2],
    /// The terms that are not 0 in it.
    pub lines: Vec<Line>,
}

/// A term within a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Which.
    pub term: usize,
    /// Grades at the ends of the cell.
    pub grade: [f64; 2],
}

/// Conclusions about one term that differ by their strength only; the strongest stands for all.
#[derive(Clone, Debug, PartialEq)]
pub struct Actor {
    /// The term.
    pub term: usize,
    /// How the strength shapes the set.
    pub implication: TNorm,
    /// The conclusions: their numbers among all that rules which are switched on conclude, in their order.
    pub conclusions: Vec<usize>,
}

impl System {
    /// How an output is computed; nothing for a position without output.
    #[must_use]
    pub fn way(&self, output: usize) -> Option<Way> {
        let resolved = self.outputs.get(output)?;
        if self.type2.is_some() {
            return Some(Way::Type2);
        }
        Some(match (&resolved.plan, &resolved.outline) {
            (Plan::Partition(partition), _) => partition.way(),
            (Plan::Outline, Some(outline)) => outline.way(),
            (Plan::Sampled(sampled), _) => Way::Sampled(sampled.sampling()),
            (Plan::Weighted, _) => Way::Weighted,
            (Plan::Integral(_), _) | (Plan::Outline, None) => Way::Integral,
        })
    }

    /// The actors of an output, by term.
    #[must_use]
    pub fn actors(&self, output: usize) -> Vec<Actor> {
        let Some(ResolvedOutput { actors, conclusions, .. }) = self.outputs.get(output) else {
            return Vec::new();
        };
        let of_system = |own: &usize| conclusions.get(*own).copied();
        let all = actors.list().iter().zip(actors.conclusions());
        all.map(|(actor, own)| Actor {
            term: actor.term,
            implication: actor.implication.clone(),
            conclusions: own.iter().filter_map(of_system).collect(),
        })
        .collect()
    }
}
