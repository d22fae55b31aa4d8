//! Where the joined set is looked at, and how much each place counts in the derivative.

use alloc::vec::Vec;

use super::super::build::System;
use super::super::defuzzifier::{Defuzzifier, Sampling};
use super::super::output::Piece;
use super::super::parts::{Conclusion, Membership, Output};
use super::super::workspace::Workspace;
use super::{Differentiator, GradientError, jumps};

/// The derivative of the answer with respect to the grade of the joined set at `x`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) x: f64,
    pub(crate) weight: f64,
}

/// Distance of the nodes of Gauss's rule with two nodes from the middle, in half widths: $1/\sqrt3$.
const GAUSS_2: f64 = 0.577_350_269_189_625_8;
/// Nodes and weights of Gauss's rule with ten nodes, the positive half (Abramowitz and Stegun,
/// table 25.4).
const GAUSS_10: [(f64, f64); 5] = [
    (0.148_874_338_981_631_2, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];
/// Panels over the universe of curved sets before kinks are looked for.
const PANELS: u32 = 256;
/// Most kinks that are looked for in one panel.
const KINKS_PER_PANEL: u32 = 8;
/// Halvings that find a kink to rounding.
const HALVINGS: u32 = 60;

impl Differentiator<'_> {
    /// $w_n (x_n - y) / A$ for the samples or quadrature nodes of a centroid.
    pub(crate) fn centroid_nodes(
        &self,
        index: usize,
        output: &Output,
        value: f64,
        workspace: &mut Workspace,
    ) -> Result<Vec<Node>, GradientError> {
        let mut nodes = match output.defuzzifier.sampling() {
            Some(Sampling::Exact) | None => self.quadrature(index, output, None, workspace),
            Some(sampling) => samples(sampling, output),
        };
        let area = self.area(index, output, &nodes, workspace)?;
        for node in &mut nodes {
            node.weight *= (node.x - value) / area;
        }
        Ok(nodes)
    }

    /// $\pm \frac12 w_n / \mu(y)$: area on the right draws the bisector to the right.
    pub(crate) fn bisector_nodes(
        &self,
        index: usize,
        output: &Output,
        value: f64,
        workspace: &mut Workspace,
    ) -> Result<Vec<Node>, GradientError> {
        let mut nodes = self.quadrature(index, output, Some(value), workspace);
        let grade = self.joined_grade(index, output, value, workspace).unwrap_or(0.0);
        if !(grade > 0.0) {
            return Err(jumps("the bisector lies in a gap of the set"));
        }
        for node in &mut nodes {
            node.weight *= if node.x > value { 0.5 } else { -0.5 } / grade;
        }
        Ok(nodes)
    }

    /// Grade of the joined set at `x`.
    fn joined_grade(
        &self,
        index: usize,
        output: &Output,
        x: f64,
        workspace: &mut Workspace,
    ) -> Option<f64> {
        let system = self.system;
        let Workspace { inputs, degrees, scratch, .. } = workspace;
        let mut joined = 0.0;
        for &position in &system.outputs.get(index)?.conclusions {
            let (resolved, &degree) = (system.conclusions.get(position)?, degrees.get(position)?);
            let block = system.parts.blocks.get(resolved.block)?;
            if let Conclusion::Set { membership, .. } = &output.terms.get(resolved.term)?.conclusion
            {
                let grade = membership.grade(x, inputs, &mut scratch.room);
                joined = output.aggregation.apply(joined, block.implication.apply(degree, grade));
            }
        }
        Some(joined)
    }

    fn area(
        &self,
        index: usize,
        output: &Output,
        nodes: &[Node],
        workspace: &mut Workspace,
    ) -> Result<f64, GradientError> {
        let mut area = 0.0_f64;
        for node in nodes {
            let grade = self.joined_grade(index, output, node.x, workspace);
            area += node.weight * grade.unwrap_or(0.0);
        }
        if area > 0.0 { Ok(area) } else { Err(GradientError::NoAnswer) }
    }

    /// Nodes of a rule that is exact for piecewise-linear sets, and of high order for curved ones.
    fn quadrature(
        &self,
        index: usize,
        output: &Output,
        split: Option<f64>,
        workspace: &mut Workspace,
    ) -> Vec<Node> {
        let pieces: Option<Vec<Piece>> =
            self.system.outline(index, workspace).map(|joined| joined.pieces().to_vec());
        let mut nodes = Vec::new();
        let mut each = |from: f64, to: f64, rule: fn(f64, f64, &mut Vec<Node>)| match split {
            Some(at) if from < at && at < to => {
                rule(from, at, &mut nodes);
                rule(at, to, &mut nodes);
            }
            _ => rule(from, to, &mut nodes),
        };
        match pieces {
            Some(pieces) => pieces.iter().for_each(|p| each(p.x[0], p.x[1], gauss_2)),
            None => {
                let breaks = self.system.breaks(index, output, workspace);
                breaks.windows(2).for_each(|pair| {
                    if let &[from, to] = pair {
                        each(from, to, gauss_10);
                    }
                });
            }
        }
        nodes
    }

    /// The plateau of highest grade: its ends and the conclusion that it belongs to.
    pub(crate) fn top(
        &self,
        index: usize,
        workspace: &mut Workspace,
    ) -> Result<Top, GradientError> {
        let because = "the points of highest grade belong to no single piecewise-linear set";
        let joined = self.system.outline(index, workspace).ok_or_else(|| jumps(because))?;
        let highest = joined.top();
        let flat = |p: &&Piece| p.grade.iter().all(|&g| g >= highest);
        let plateau = joined.pieces().iter().find(flat);
        if let Some(piece) = plateau {
            let conclusion = piece.conclusion.ok_or_else(|| jumps(because))?;
            return Ok(Top { ends: piece.x, conclusion, cut: piece.cut });
        }
        let peak = joined.pieces().iter().find_map(|p| {
            let at_end = p.grade.iter().zip(p.x).find(|&(&grade, _)| grade >= highest);
            at_end.and_then(|(_, x)| p.conclusion.map(|conclusion| (x, conclusion)))
        });
        let (x, conclusion) = peak.ok_or_else(|| jumps(because))?;
        Ok(Top { ends: [x; 2], conclusion, cut: false })
    }
}

/// Where the joined set is highest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Top {
    pub(crate) ends: [f64; 2],
    pub(crate) conclusion: usize,
    /// True if the strength of the conclusion cuts the set there.
    pub(crate) cut: bool,
}

impl Top {
    /// How much each end counts in the answer.
    pub(crate) fn shares(method: Defuzzifier) -> [f64; 2] {
        match method {
            Defuzzifier::SmallestOfMaximum(_) => [1.0, 0.0],
            Defuzzifier::LargestOfMaximum(_) => [0.0, 1.0],
            _ => [0.5, 0.5],
        }
    }
}

/// The samples of a sampled centroid with their weights.
fn samples(sampling: Sampling, output: &Output) -> Vec<Node> {
    let (Some(grid), Some(universe)) = (sampling.samples(), output.universe) else {
        return Vec::new();
    };
    let sample = |n| {
        let (x, weight) = grid.at(n, [universe.lower, universe.upper]);
        Node { x, weight }
    };
    (0..grid.count).map(sample).collect()
}

fn gauss_2(from: f64, to: f64, nodes: &mut Vec<Node>) {
    let (middle, half) = (0.5 * from + 0.5 * to, 0.5 * (to - from));
    nodes.push(Node { x: middle - half * GAUSS_2, weight: half });
    nodes.push(Node { x: middle + half * GAUSS_2, weight: half });
}

fn gauss_10(from: f64, to: f64, nodes: &mut Vec<Node>) {
    let (middle, half) = (0.5 * from + 0.5 * to, 0.5 * (to - from));
    for (distance, weight) in GAUSS_10 {
        nodes.push(Node { x: middle - half * distance, weight: half * weight });
        nodes.push(Node { x: middle + half * distance, weight: half * weight });
    }
}

impl System {
    /// Places between which the joined set of curved terms is smooth: corners, and points where the
    /// conclusion on top changes or begins to be cut.
    fn breaks(&self, index: usize, output: &Output, workspace: &mut Workspace) -> Vec<f64> {
        let Some(universe) = output.universe else { return Vec::new() };
        let mut breaks: Vec<f64> = (0..=PANELS)
            .map(|n| universe.lower + universe.span() * (f64::from(n) / f64::from(PANELS)))
            .collect();
        for term in &output.terms {
            if let Conclusion::Set { membership: Membership::Shape { kind, params, .. }, .. } =
                &term.conclusion
            {
                kind.corners(params, &mut |x| breaks.push(x));
            }
        }
        breaks.retain(|&x| universe.contains(x));
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        let mut kinks = Vec::new();
        for pair in breaks.windows(2) {
            if let &[from, to] = pair {
                self.kinks(index, output, [from, to], workspace, &mut kinks);
            }
        }
        breaks.append(&mut kinks);
        breaks.sort_by(f64::total_cmp);
        breaks
    }

    /// The places within a panel where another conclusion comes on top or begins to be cut.
    fn kinks(
        &self,
        index: usize,
        output: &Output,
        panel: [f64; 2],
        workspace: &mut Workspace,
        kinks: &mut Vec<f64>,
    ) {
        // A hair inside, so that corners at the ends do not count.
        let hair = 1e-9 * (panel[1] - panel[0]);
        let [mut begin, end] = [panel[0] + hair, panel[1] - hair];
        let last = self.signature(index, output, end, workspace);
        for _ in 0..KINKS_PER_PANEL {
            let first = self.signature(index, output, begin, workspace);
            if first == last {
                return;
            }
            let [mut from, mut to] = [begin, end];
            for _ in 0..HALVINGS {
                let middle = 0.5 * from + 0.5 * to;
                if self.signature(index, output, middle, workspace) == first {
                    from = middle;
                } else {
                    to = middle;
                }
            }
            kinks.push(to);
            begin = to;
        }
    }

    /// Which conclusion is highest at `x`, and whether its strength cuts it there.
    fn signature(
        &self,
        index: usize,
        output: &Output,
        x: f64,
        workspace: &mut Workspace,
    ) -> (usize, bool) {
        let Workspace { inputs, degrees, scratch, .. } = workspace;
        let mut best = (usize::MAX, false);
        let mut highest = -1.0;
        for &position in self.outputs.get(index).map_or(&[][..], |o| &o.conclusions) {
            let Some((resolved, &degree)) =
                self.conclusions.get(position).zip(degrees.get(position))
            else {
                continue;
            };
            let (Some(block), Some(term)) =
                (self.parts.blocks.get(resolved.block), output.terms.get(resolved.term))
            else {
                continue;
            };
            let Conclusion::Set { membership, .. } = &term.conclusion else { continue };
            let grade = membership.grade(x, inputs, &mut scratch.room);
            let shaped = block.implication.apply(degree, grade);
            if shaped > highest {
                highest = shaped;
                best = (position, degree <= grade);
            }
        }
        best
    }
}
