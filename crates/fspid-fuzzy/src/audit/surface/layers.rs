//! The sets of an output as straight lines, slice by slice.
//!
//! Between neighbouring corners every piecewise-linear set is a straight line. What rules conclude
//! about one term with one implication is a layer: the set cut at (minimum) or scaled by (product)
//! the strongest of their strengths, the level of the layer. The joined set is the upper edge of all
//! layers.

use alloc::vec::Vec;

use crate::membership::Vertex;
use crate::norm::{SNormKind, TNormKind};
use crate::system::{Conclusion, Defuzzifier, Membership, Output, Sampling, System};
use fspid_numeric::scalar::Interval;

/// Roundings that a grade computed from a line may have suffered, with room to spare.
const ROUNDINGS: f64 = 32.0 * f64::EPSILON;

/// What is concluded about one term with one implication.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    term: usize,
    /// The set is scaled by the level rather than cut at it.
    pub(super) scaled: bool,
    /// The conclusions whose strongest is the level.
    pub(super) conclusions: Vec<usize>,
}

/// A straight piece of a set.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) layer: usize,
    /// Grade at the left end of the slice.
    pub(super) start: f64,
    /// Change of the grade per unit.
    pub(super) slope: f64,
}

/// A part of the universe in which every set is straight.
#[derive(Clone, Debug)]
pub(super) struct Slice {
    pub(super) left: f64,
    pub(super) right: f64,
    /// The sets that are not zero here.
    pub(super) lines: Vec<Line>,
}

impl Slice {
    /// Grade of a line at `x`.
    #[inline]
    pub(super) fn grade(&self, line: &Line, x: f64) -> f64 {
        line.start + line.slope * (x - self.left)
    }
}

/// All layers of an output whose sets are piecewise linear. Places are told from the middle of the
/// universe.
#[derive(Clone, Debug)]
pub(super) struct Layers {
    pub(super) layers: Vec<Layer>,
    pub(super) slices: Vec<Slice>,
    pub(super) middle: f64,
    pub(super) span: f64,
    /// A computed grade is off by no more than this, also where the place was rounded.
    pub(super) slack: f64,
}

impl Layers {
    /// The layers of an output, if its exact centroid is asked for and all its sets are straight.
    pub(super) fn of(system: &System, index: usize) -> Option<Self> {
        let (output, resolved) = (system.parts.outputs.get(index)?, system.outputs.get(index)?);
        let exact = output.defuzzifier == Defuzzifier::Centroid(Sampling::Exact);
        if !exact || !output.aggregation.is(SNormKind::Maximum) {
            return None;
        }
        let universe = output.universe?;
        let layers = collect(system, &resolved.conclusions)?;
        let outlines: Option<Vec<_>> =
            layers.iter().map(|layer| outline(output, layer, universe.middle())).collect();
        let outlines = outlines?;
        let half = 0.5 * universe.span();
        let slices = slices(&outlines, half);
        let steepest = slices.iter().flat_map(|slice| &slice.lines).map(|line| line.slope.abs());
        let reach = half + universe.middle().abs();
        let slack = ROUNDINGS * (1.0 + steepest.fold(0.0, f64::max) * reach);
        let middle = universe.middle();
        Some(Self { layers, slices, middle, span: universe.span(), slack })
    }

    /// Where the universe begins and ends, from its middle, rounded outward.
    pub(super) fn ends(&self) -> Interval {
        let half = 0.5 * self.span;
        Interval::between((-half).next_down(), half.next_up())
    }
}

fn collect(system: &System, conclusions: &[usize]) -> Option<Vec<Layer>> {
    let mut layers: Vec<Layer> = Vec::new();
    for &index in conclusions {
        let resolved = system.conclusions.get(index)?;
        let implication = &system.parts.blocks.get(resolved.block)?.implication;
        let scaled = implication.is(TNormKind::AlgebraicProduct);
        if !scaled && !implication.is(TNormKind::Minimum) {
            return None;
        }
        let known = layers.iter_mut().find(|l| l.term == resolved.term && l.scaled == scaled);
        match known {
            Some(layer) => layer.conclusions.push(index),
            None => {
                layers.push(Layer { term: resolved.term, scaled, conclusions: Vec::from([index]) });
            }
        }
    }
    (!layers.is_empty()).then_some(layers)
}

/// The corners of a layer's set, from the middle of the universe.
fn outline(output: &Output, layer: &Layer, middle: f64) -> Option<Vec<Vertex>> {
    let Conclusion::Set { membership: Membership::Shape { kind, params, height }, lower: None } =
        &output.terms.get(layer.term)?.conclusion
    else {
        return None;
    };
    let mut corners = Vec::new();
    kind.vertices(params, &mut |vertex| {
        corners.push(Vertex { x: vertex.x - middle, grade: vertex.grade * height });
    });
    (kind.is_piecewise_linear() && !corners.is_empty()).then_some(corners)
}

fn slices(outlines: &[Vec<Vertex>], half: f64) -> Vec<Slice> {
    let mut places = Vec::from([-half, half]);
    let corners = outlines.iter().flatten().map(|corner| corner.x);
    places.extend(corners.filter(|x| x.abs() < half));
    places.sort_by(f64::total_cmp);
    places.dedup_by(|later, earlier| *later <= *earlier);
    let pairs = places.windows(2).filter_map(|pair| <[f64; 2]>::try_from(pair).ok());
    pairs.map(|[left, right]| slice(outlines, left, right)).collect()
}

fn slice(outlines: &[Vec<Vertex>], left: f64, right: f64) -> Slice {
    let lines = outlines.iter().enumerate().filter_map(|(layer, corners)| {
        let [start, end] = ends(corners, left, right);
        let slope = (end - start) / (right - left);
        (start > 0.0 || end > 0.0).then_some(Line { layer, start, slope })
    });
    Slice { left, right, lines: lines.collect() }
}

/// Grades of a set at the two ends of a slice, seen from inside.
fn ends(corners: &[Vertex], left: f64, right: f64) -> [f64; 2] {
    let before = corners.iter().rev().find(|corner| corner.x <= left);
    let after = corners.iter().find(|corner| corner.x >= right);
    match (before, after) {
        (Some(before), Some(after)) => [left, right].map(|x| {
            let share = (x - before.x) / (after.x - before.x);
            before.grade + share * (after.grade - before.grade)
        }),
        (Some(only), None) | (None, Some(only)) => [only.grade; 2],
        (None, None) => [0.0; 2],
    }
}
