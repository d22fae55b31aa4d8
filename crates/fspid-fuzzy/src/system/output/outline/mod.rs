//! The outline of cut or scaled sets that are all piecewise linear, in closed form.
//!
//! The corners of all sets divide the universe into cells in each of which every set is one straight
//! line. An evaluation walks over the cells: minimum cuts a line at its strength, product tilts it;
//! between the cuts every conclusion is a straight line, and the highest of them (or their sum) is
//! the outline. No sample is taken.

mod cells;
mod edge;

use alloc::vec::Vec;

use super::super::build::System;
use super::super::norms::SNorm;
use super::super::parts::Output;
use super::actors::{Activations, Level};
use super::joined::AggregatedSet;
use super::roomy_clone;
use super::way::{self, Join, Way};
use crate::membership::Vertex;
use crate::norm::{SNormKind, TNormKind};
pub(crate) use cells::smaller_set;
use cells::{Cell, Line, cells, polyline};
use edge::{Active, Edge, highest, sum};

impl Join {
    fn of(norm: &SNorm) -> Option<Self> {
        match norm {
            SNorm::Kind(SNormKind::Maximum) => Some(Self::Maximum),
            SNorm::Kind(SNormKind::UnboundedSum) => Some(Self::Sum),
            // Of two numbers, and so of any number of them, the same.
            SNorm::Kind(SNormKind::BoundedSum | SNormKind::NormalizedSum) => Some(Self::BoundedSum),
            _ => None,
        }
    }
}

/// The piecewise-linear sets of an output, cut into cells.
#[derive(Clone, Debug)]
pub(crate) struct Outline {
    join: Join,
    cells: Vec<Cell>,
    lines: Vec<Line>,
    /// Whether each actor scales its set (product); the others cut theirs (minimum).
    scales: Vec<bool>,
    middle: f64,
}

/// Memory for an outline.
#[derive(Debug, Default)]
pub(crate) struct Room {
    active: Vec<Active>,
    cuts: Vec<f64>,
    edges: Vec<Edge>,
    pub(crate) joined: AggregatedSet,
}

impl Clone for Room {
    /// A clone has as much room as the original.
    fn clone(&self) -> Self {
        Self {
            active: roomy_clone(&self.active),
            cuts: roomy_clone(&self.cuts),
            edges: roomy_clone(&self.edges),
            joined: self.joined.roomy_clone(),
        }
    }
}

impl Outline {
    /// The outline of an output whose sets are all piecewise linear and stay so when joined.
    pub(crate) fn of(output: &Output, actors: &Activations) -> Option<Self> {
        let (join, universe) = (Join::of(&output.aggregation)?, output.universe?);
        let polylines: Vec<Vec<Vertex>> =
            output.terms.iter().map(|term| polyline(&term.conclusion)).collect::<Option<_>>()?;
        let scales = actors.list().iter().map(|actor| {
            let scales = actor.implication.is(TNormKind::AlgebraicProduct);
            (scales || actor.implication.is(TNormKind::Minimum)).then_some(scales)
        });
        let scales = scales.collect::<Option<_>>()?;
        let (cells, lines) = cells([universe.lower, universe.upper], &polylines);
        Some(Self { join, cells, lines, scales, middle: universe.middle() })
    }

    /// What it does, in public words.
    pub(super) fn way(&self) -> Way {
        let line = |line: &Line| way::Line { term: line.term, grade: line.grade };
        let cell = |cell: &Cell| {
            let lines = self.lines.get(cell.lines.clone()).unwrap_or_default();
            way::Cell { x: cell.x, lines: lines.iter().map(line).collect() }
        };
        let cells = self.cells.iter().map(cell).collect();
        Way::Polygon { join: self.join, cells, scales: self.scales.clone(), middle: self.middle }
    }

    /// Makes room for it.
    pub(crate) fn reserve(&self, actors: &Activations, room: &mut Room) {
        let of_cell = |cell: &Cell| -> usize {
            let lines = self.lines.get(cell.lines.clone()).unwrap_or_default();
            lines.iter().map(|line| actors.about(line.term).len()).sum()
        };
        let most = self.cells.iter().map(of_cell).max().unwrap_or(0);
        // The upper envelope of m conclusions of two segments each has fewer than 16 m pieces.
        let pieces = self.cells.iter().map(|cell| of_cell(cell).min(16) * of_cell(cell) + 2).sum();
        room.active.reserve(most);
        room.cuts.reserve(most + 1);
        room.edges.reserve(most);
        room.joined.reserve(pieces);
    }

    /// Joins what the actors conclude at their levels.
    pub(crate) fn join(&self, actors: &Activations, levels: &[Level], room: &mut Room) {
        room.joined.restart(self.middle);
        for cell in &self.cells {
            self.join_cell(cell, actors, levels, room);
        }
    }

    fn join_cell(&self, cell: &Cell, actors: &Activations, levels: &[Level], room: &mut Room) {
        let Room { active, cuts, edges, joined } = room;
        active.clear();
        cuts.clear();
        for line in self.lines.get(cell.lines.clone()).unwrap_or_default() {
            let about = actors.about(line.term);
            let (levels, scales) = (levels.get(about.clone()), self.scales.get(about));
            let (Some(levels), Some(scales)) = (levels, scales) else { continue };
            for (level, &scales) in levels.iter().zip(scales) {
                if level.strength > 0.0 {
                    let own = Active::new(cell.x, line.grade, level, scales);
                    cuts.extend(own.cut.into_iter().filter(|&x| cell.x[0] < x && x < cell.x[1]));
                    active.push(own);
                }
            }
        }
        if active.is_empty() {
            return;
        }
        cuts.sort_unstable_by(f64::total_cmp);
        cuts.push(cell.x[1]);
        let (first, mut from) = (joined.len(), cell.x[0]);
        for &to in cuts.iter() {
            if from < to {
                edges.clear();
                edges.extend(active.iter().map(|own| own.edge(from, to)));
                match self.join {
                    Join::Maximum => highest([from, to], edges, first, joined),
                    Join::Sum => sum([from, to], edges, f64::INFINITY, first, joined),
                    Join::BoundedSum => sum([from, to], edges, 1.0, first, joined),
                }
                from = to;
            }
        }
    }
}

impl System {
    /// Where a conclusion comes from: the rule block, the rule within it and the consequent within
    /// that; nothing for a number that is not one of a conclusion.
    #[must_use]
    pub fn origin(&self, conclusion: usize) -> Option<[usize; 3]> {
        let found = self.conclusions.get(conclusion)?;
        let rule = self.rules.get(found.rule)?;
        Some([found.block, rule.rule, conclusion - rule.conclusions.start])
    }
}
