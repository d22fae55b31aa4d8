//! What is true of the surfaces, with proof.
//!
//! Every number here is a pair of bounds that hold for every input of the domain and for every
//! rounding on the way; nothing is sampled. Boxes of inputs are enclosed by interval arithmetic
//! and divided until the bounds are close or the budget is
//! used up, in which case the bounds are simply wider.

mod continuity;
mod coverage;
mod envelope;
mod facts;
mod field;
mod firing;
mod gradient;
mod layers;
mod masses;
mod objective;
mod options;
mod reach;
mod rules;
mod symmetry;
mod ties;
mod weighted;

use alloc::vec::Vec;

use super::Statement;
use super::search::Extreme;
use crate::system::System;
use field::Field;
use fspid_numeric::scalar::Interval;

pub use coverage::Coverage;
pub use options::{SurfaceError, SurfaceOptions};
pub use reach::Reach;
pub use rules::{RuleEffect, TermReach};

/// What is true of the surfaces of a system over a domain.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceAudit {
    /// Lower and upper end of each input.
    pub domain: Vec<[f64; 2]>,
    /// The inputs at rest.
    pub rest: Vec<f64>,
    /// One for each output.
    pub outputs: Vec<OutputSurface>,
    /// For each input, how far each of its terms is reached.
    pub terms: Vec<Vec<TermReach>>,
    /// For each rule that is switched on, what it does.
    pub rules: Vec<RuleEffect>,
    /// Boxes that were looked at, all in all.
    pub boxes: u64,
}

/// What is true of one output.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputSurface {
    /// The smallest value.
    pub least: Extreme,
    /// The largest value.
    pub most: Extreme,
    /// Bounds of the value at rest.
    pub at_rest: [f64; 2],
    /// How strongly the rules about it fire at least.
    pub coverage: Coverage,
    /// Along each input.
    pub along: Vec<AlongInput>,
    /// $f(-x) = -f(x)$, about the middles of the domain and of the output's universe.
    pub odd: Symmetry,
    /// $f(-x) = f(x)$, about the middle of the domain.
    pub even: Symmetry,
    /// $f(\dots x_i \dots x_j \dots) = f(\dots x_j \dots x_i \dots)$ for inputs with one domain.
    pub exchange: Vec<([usize; 2], Symmetry)>,
    /// In some box perhaps no rule fires, so that the fallback answers.
    pub may_fall_back: bool,
}

/// A symmetry of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Symmetry {
    /// The largest difference between the values at a point and at its mirror image.
    pub departure: Extreme,
    /// Whether the symmetry holds; refuted by a point.
    pub statement: Statement<Vec<f64>>,
}

/// How an output goes along one input, the others held.
///
/// What is said of slopes leaves out strips of $10^{-12}$ of the distances in question along lines on
/// which two Gaussian sets tie. Lines that differ only by the rounding of centres are taken for one;
/// between them a slope may be anything, but no difference over a longer way shows it.
#[derive(Clone, Debug, PartialEq)]
pub struct AlongInput {
    /// The smallest slope.
    pub least_slope: Extreme,
    /// The largest slope.
    pub most_slope: Extreme,
    /// The largest magnitude of the slope: proved to be reached, and proved not to be exceeded. The
    /// latter is a Lipschitz constant.
    pub lipschitz: [f64; 2],
    /// Bounds of the slope at rest: of all slopes that meet there, if there is a kink.
    pub slope_at_rest: [f64; 2],
    /// Whether the output never falls, and never rises, with the input.
    pub monotone: Monotone,
    /// Bounds of $(f(r + t) - f(r)) / t$ for the rest point $r$ and all $t$ of the domain.
    pub sector: [Extreme; 2],
}

/// Whether an output goes one way along an input.
#[derive(Clone, Debug, PartialEq)]
pub struct Monotone {
    /// The output rises with the input on the larger part of the domain.
    pub rises: bool,
    /// Whether it goes that way everywhere.
    pub statement: Statement<Counterexample>,
    /// The steepest slope the wrong way, as a magnitude; 0 if there is none.
    pub worst: [f64; 2],
    /// Share of the domain with a slope the wrong way.
    pub wrong_share: [f64; 2],
}

/// Two points between which an output goes the wrong way.
#[derive(Clone, Debug, PartialEq)]
pub struct Counterexample {
    /// The point with the smaller input.
    pub from: Vec<f64>,
    /// The point with the larger input.
    pub to: Vec<f64>,
    /// Bounds of the change of the output.
    pub change: [f64; 2],
}

/// What is true of the surfaces of a system.
///
/// # Errors
/// [`SurfaceError`] for an input without a universe or domain, and for options that do not fit.
pub fn surface(system: &System, options: &SurfaceOptions) -> Result<SurfaceAudit, SurfaceError> {
    let domain = options.domain(system)?;
    let rest = options.rest(&domain)?;
    let mut field = Field::new(system);
    let outputs = (0..system.parts.outputs.len())
        .map(|output| facts::of_output(&mut field, output, &domain, &rest, options))
        .collect();
    let terms = rules::reaches(&mut field, &domain, options);
    let rules = rules::effects(&mut field, &domain, options);
    Ok(SurfaceAudit {
        domain: domain.iter().map(|side| ends(*side)).collect(),
        rest,
        outputs,
        terms,
        rules,
        boxes: field.boxes,
    })
}

/// The smallest and the largest slope of each output along each input, and nothing else of what
/// [`surface`] says; with its exception of narrow strips.
///
/// # Errors
/// As [`surface`].
pub fn slopes(
    system: &System,
    options: &SurfaceOptions,
) -> Result<Vec<Vec<[Extreme; 2]>>, SurfaceError> {
    let domain = options.domain(system)?;
    let mut field = Field::new(system);
    let outputs = 0..system.parts.outputs.len();
    Ok(outputs
        .map(|output| {
            let inputs = 0..domain.len();
            inputs.map(|input| facts::slopes(&mut field, output, input, &domain, options)).collect()
        })
        .collect())
}

/// Lower and upper bound.
fn ends(interval: Interval) -> [f64; 2] {
    [interval.lower(), interval.upper()]
}
