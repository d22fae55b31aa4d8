//! From the degrees of an output's conclusions to one number.
//!
//! How that is done best is decided once, when the system is built: a [`Plan`].

mod actors;
mod curve;
mod integral;
mod joined;
mod maximum;
mod outline;
mod partition;
mod runs;
mod sampled;
mod way;
mod weighted;

use alloc::vec;
use alloc::vec::Vec;

use super::build::{ResolvedOutput, System};
use super::defuzzifier::Defuzzifier;
use super::parts::{Conclusion, Membership, Output};
use super::workspace::Workspace;
use fspid_numeric::lanes::One;

pub(crate) use actors::{Activations, Level};
pub(crate) use integral::Integral;
pub use joined::{AggregatedSet, Piece};
pub(crate) use outline::{Outline, Room, smaller_set};
pub(crate) use partition::Partition;
pub(crate) use sampled::{Concluded, Sampled, Samples};
pub use way::{Actor, Cell, Join, Line, Way};
pub(crate) use weighted::value;

/// How the number of one output is found.
#[derive(Clone, Debug)]
pub(crate) enum Plan {
    /// Centroid of evenly spaced triangles: the closed form of the fixed-size supervisor.
    Partition(Partition),
    /// Read off the outline of piecewise-linear sets, in closed form.
    Outline,
    /// Read off samples.
    Sampled(Sampled),
    /// Integrated with a certified bound on the error.
    Integral(Integral),
    /// Weighted average or sum of the conclusions.
    Weighted,
}

impl Plan {
    /// The plan for an output and what is concluded about it.
    pub(crate) fn new(output: &Output, actors: &Activations, outline: Option<&Outline>) -> Self {
        if let Some(partition) = Partition::of(output, actors) {
            return Self::Partition(partition);
        }
        match (Sampled::of(output), Integral::of(output), outline) {
            (Some(sampled), _, _) => Self::Sampled(sampled),
            (None, Some(_), Some(_)) => Self::Outline,
            (None, Some(integral), None) => Self::Integral(integral),
            (None, None, _) => Self::Weighted,
        }
    }
}

/// Memory that the plans need, shared by the outputs.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// Room for lifted parameters and the variables of formulas.
    pub(crate) room: Vec<f64>,
    /// Levels of the actors of the output at hand.
    pub(crate) levels: Vec<Level>,
    /// Strengths of terms from left to right.
    pub(crate) sorted: Vec<One<f64>>,
    /// Activations that fire, in the order in which they are joined.
    pub(crate) order: Vec<usize>,
    pub(crate) outline: Room,
    pub(crate) samples: Samples,
}

impl Scratch {
    pub(crate) fn for_outputs(system: &System) -> Self {
        // Formulas may name the outputs too.
        let inputs = system.parts.inputs.len() + system.parts.outputs.len();
        let of_inputs = system.parts.inputs.iter().flat_map(|i| &i.terms).map(|t| &t.membership);
        let of_outputs = system.parts.outputs.iter().flat_map(|o| &o.terms);
        let of_outputs = of_outputs.filter_map(|t| match &t.conclusion {
            Conclusion::Set { membership, .. } => Some(membership),
            _ => None,
        });
        let room = of_inputs.chain(of_outputs).map(|m: &Membership| m.room(inputs)).max();
        let actors = system.outputs.iter().map(|output| output.actors.len()).max();
        let terms = system.parts.outputs.iter().map(|output| output.terms.len()).max();
        let mut scratch = Self {
            room: vec![0.0; room.unwrap_or(0).max(inputs + 1)],
            levels: vec![Level::default(); actors.unwrap_or(0)],
            order: Vec::with_capacity(actors.unwrap_or(0)),
            sorted: vec![One(0.0); terms.unwrap_or(0)],
            ..Self::default()
        };
        for output in &system.outputs {
            if let Some(outline) = &output.outline {
                outline.reserve(&output.actors, &mut scratch.outline);
            }
            if let Plan::Sampled(sampled) = &output.plan {
                sampled.reserve(&output.actors, &mut scratch.samples);
            }
        }
        scratch
    }
}

impl Clone for Scratch {
    /// A clone has as much room as the original.
    fn clone(&self) -> Self {
        let (outline, samples) = (self.outline.clone(), self.samples.clone());
        let (room, levels, sorted) = (self.room.clone(), self.levels.clone(), self.sorted.clone());
        Self { room, levels, sorted, order: roomy_clone(&self.order), outline, samples }
    }
}

/// A clone with the same capacity.
pub(crate) fn roomy_clone<T: Clone>(original: &Vec<T>) -> Vec<T> {
    let mut clone = Vec::with_capacity(original.capacity());
    clone.extend_from_slice(original);
    clone
}

/// Grade of a set at `x`; 0 for a conclusion that is no set.
fn set_grade(conclusion: &Conclusion, x: f64, inputs: &[f64], room: &mut [f64]) -> f64 {
    match conclusion {
        Conclusion::Set { membership, .. } => membership.grade(x, inputs, room),
        _ => 0.0,
    }
}

impl System {
    /// The number of an output and its error bound, unless no rule fires or there is no area.
    pub(crate) fn defuzzified(
        &self,
        index: usize,
        output: &Output,
        workspace: &mut Workspace,
    ) -> Option<(f64, f64)> {
        if self.type2.is_some() {
            return Some((self.middle_of_interval(index, output, workspace)?, 0.0));
        }
        let ResolvedOutput { plan, actors, conclusions, .. } = self.outputs.get(index)?;
        let method = output.defuzzifier;
        if let Plan::Weighted = plan {
            return Some((self.weighted(index, output, method, workspace)?, 0.0));
        }
        if let Plan::Outline = plan {
            return Some((read(method, self.outline(index, workspace)?)?, 0.0));
        }
        let Workspace { inputs, degrees, scratch, .. } = workspace;
        let levels = actors.levels(conclusions, degrees, &mut scratch.levels);
        let concluded = Concluded { output, actors, levels, inputs };
        match plan {
            Plan::Partition(partition) => {
                Some((partition.centroid(levels, &mut scratch.sorted)?, 0.0))
            }
            Plan::Integral(integral) => integral.number(method, &concluded, &mut scratch.order),
            Plan::Sampled(sampled) => {
                let Scratch { room, samples, .. } = scratch;
                Some((sampled.number(method, &concluded, room, samples)?, 0.0))
            }
            Plan::Outline | Plan::Weighted => None,
        }
    }

    /// The outline of what the last evaluation in `workspace` concluded about an output: whatever
    /// the output's defuzzifier, as long as its sets are piecewise linear and minimum or product,
    /// maximum, bounded or unbounded sum keep them so; nothing otherwise.
    pub fn outline<'w>(
        &self,
        output: usize,
        workspace: &'w mut Workspace,
    ) -> Option<&'w AggregatedSet> {
        let ResolvedOutput { actors, outline, conclusions, .. } = self.outputs.get(output)?;
        let Scratch { levels, outline: room, .. } = &mut workspace.scratch;
        let levels = actors.levels(conclusions, &workspace.degrees, levels);
        outline.as_ref()?.join(actors, levels, room);
        Some(&room.joined)
    }
}

/// What a method reads off an outline.
fn read(method: Defuzzifier, joined: &AggregatedSet) -> Option<f64> {
    match method {
        Defuzzifier::Centroid(_) => joined.centroid(),
        Defuzzifier::Bisector(_) => joined.bisector(),
        Defuzzifier::SmallestOfMaximum(_) => joined.maximum().map(|[smallest, _, _]| smallest),
        Defuzzifier::MeanOfMaximum(_) => joined.maximum().map(|[_, mean, _]| mean),
        Defuzzifier::LargestOfMaximum(_) => joined.maximum().map(|[_, _, largest]| largest),
        Defuzzifier::WeightedAverage(_) | Defuzzifier::WeightedSum(_) => None,
    }
}
