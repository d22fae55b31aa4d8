//! From the degrees of an output's conclusions to one number.
//!
//! How that is done best is decided once, when the system is built: a [`Plan`].

mod joined;
mod outline;
mod partition;
mod sampled;
mod weighted;

use alloc::vec;
use alloc::vec::Vec;

use super::build::{ResolvedConclusion, System};
use super::defuzzifier::{Defuzzifier, Sampling};
use super::parts::{Conclusion, Membership, Output, RuleBlock};
use super::workspace::Workspace;

pub use joined::{Joined, Piece};
pub(crate) use outline::{Outline, Room};
pub(crate) use partition::Partition;
pub(crate) use weighted::value;

/// How the number of one output is found.
#[derive(Clone, Debug)]
pub(crate) enum Plan {
    /// Centroid of evenly spaced triangles: the closed form of the fixed-size supervisor.
    Partition(Partition),
    /// The outline of piecewise-linear sets, in closed form.
    Outline,
    /// Anything that is integrated or searched over the universe.
    Integral,
    /// Weighted average or sum of the conclusions.
    Weighted,
}

impl Plan {
    /// The plan for an output, what is concluded about it, and the blocks that do so.
    pub(crate) fn new(
        output: &Output,
        conclusions: &[&ResolvedConclusion],
        blocks: &[&RuleBlock],
        outline: Option<&Outline>,
    ) -> Self {
        let Some(sampling) = output.defuzzifier.sampling() else { return Self::Weighted };
        match (Partition::of(output, conclusions, blocks), outline) {
            (Some(partition), _) => Self::Partition(partition),
            (None, Some(_)) if sampling == Sampling::Exact => Self::Outline,
            (None, _) => Self::Integral,
        }
    }
}

/// Memory that the plans need.
#[derive(Clone, Debug)]
pub(crate) struct Scratch {
    /// Room for lifted parameters and the variables of formulas.
    pub(crate) room: Vec<f64>,
    /// Strength of each term of the output at hand.
    pub(crate) levels: Vec<f64>,
    /// Of each output with an outline.
    pub(crate) outlines: Vec<Option<Room>>,
}

impl Scratch {
    pub(crate) fn for_outputs(system: &System) -> Self {
        let inputs = system.parts.inputs.len();
        let of_inputs = system.parts.inputs.iter().flat_map(|i| &i.terms).map(|t| &t.membership);
        let of_outputs = system.parts.outputs.iter().flat_map(|o| &o.terms);
        let of_outputs = of_outputs.filter_map(|t| match &t.conclusion {
            Conclusion::Set { membership, .. } => Some(membership),
            _ => None,
        });
        let room = of_inputs.chain(of_outputs).map(|m: &Membership| m.room(inputs)).max();
        let terms = system.parts.outputs.iter().map(|o| o.terms.len()).max();
        Self {
            room: vec![0.0; room.unwrap_or(0).max(inputs + 1)],
            levels: vec![0.0; terms.unwrap_or(0)],
            outlines: system.outputs.iter().map(|o| Some(o.outline.as_ref()?.room())).collect(),
        }
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
        let plan = &self.outputs.get(index)?.plan;
        match (plan, output.defuzzifier) {
            (Plan::Partition(partition), _) => {
                self.levels(index, workspace);
                Some((partition.centroid(&workspace.scratch.levels)?, 0.0))
            }
            (Plan::Outline, method) => {
                let joined = self.outline(index, workspace)?;
                let value = match method {
                    Defuzzifier::Centroid(_) => joined.centroid()?,
                    Defuzzifier::Bisector(_) => joined.bisector()?,
                    Defuzzifier::SmallestOfMaximum(_) => joined.maximum()?[0],
                    Defuzzifier::MeanOfMaximum(_) => joined.maximum()?[1],
                    Defuzzifier::LargestOfMaximum(_) => joined.maximum()?[2],
                    Defuzzifier::WeightedAverage(_) | Defuzzifier::WeightedSum(_) => return None,
                };
                Some((value, 0.0))
            }
            (Plan::Weighted, method) => {
                Some((self.weighted(index, output, method, workspace)?, 0.0))
            }
            (Plan::Integral, Defuzzifier::Centroid(Sampling::Exact)) => None,
            (Plan::Integral, method) => {
                Some((self.sampled(index, output, method, workspace)?, 0.0))
            }
        }
    }

    /// The outline of what the last evaluation in `workspace` concluded about an output: whatever
    /// the output's defuzzifier, as long as its sets are piecewise linear and minimum or product,
    /// maximum, bounded or unbounded sum keep them so; nothing otherwise.
    pub fn outline<'w>(&self, output: usize, workspace: &'w mut Workspace) -> Option<&'w Joined> {
        let resolved = self.outputs.get(output)?;
        let room = workspace.scratch.outlines.get_mut(output)?.as_mut()?;
        resolved.outline.as_ref()?.join(&resolved.conclusions, &workspace.degrees, room);
        Some(&room.joined)
    }

    /// Strength of each term: the strongest of its conclusions.
    fn levels(&self, index: usize, workspace: &mut Workspace) {
        let Workspace { degrees, scratch, .. } = workspace;
        scratch.levels.fill(0.0);
        for &conclusion in self.outputs.get(index).map_or(&[][..], |o| &o.conclusions) {
            let (Some(resolved), Some(&degree)) =
                (self.conclusions.get(conclusion), degrees.get(conclusion))
            else {
                continue;
            };
            if let Some(level) = scratch.levels.get_mut(resolved.term) {
                *level = level.max(degree);
            }
        }
    }
}
