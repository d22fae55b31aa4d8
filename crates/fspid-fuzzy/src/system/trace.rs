//! What an evaluation leaves behind: which rules fired, and what each concluded.

use alloc::vec::Vec;

use super::build::System;
use super::defuzzifier::Defuzzifier;
use super::output::value as number;
use super::workspace::Workspace;

/// A rule in an evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Firing {
    /// Its block.
    pub block: usize,
    /// Its position in the block.
    pub rule: usize,
    /// Strength of its antecedent times its weight.
    pub strength: f64,
    /// The strength with which it acts: 0 where the block's activation leaves it out.
    pub acting: f64,
}

/// What a rule concluded about an output in an evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    /// The conclusion, as [`Piece::conclusion`](super::Piece::conclusion) numbers it.
    pub conclusion: usize,
    /// Block, rule in the block, and consequent in the rule.
    pub origin: [usize; 3],
    /// Position of the term.
    pub term: usize,
    /// Its strength, after the hedges of the consequent.
    pub degree: f64,
    /// The number that a weighted defuzzifier takes for it; `None` with other defuzzifiers.
    pub value: Option<f64>,
}

impl System {
    /// The rules that are switched on, with their strengths in the last evaluation.
    pub fn firings<'w>(&'w self, workspace: &'w Workspace) -> impl Iterator<Item = Firing> + 'w {
        let strengths = workspace.strengths.iter().zip(&workspace.acting);
        self.rules.iter().zip(strengths).map(|(found, (&strength, &acting))| Firing {
            block: found.block,
            rule: found.rule,
            strength,
            acting,
        })
    }

    /// Whether a rule concluded anything about an output in the last evaluation.
    #[must_use]
    pub fn is_concluded(&self, output: usize, workspace: &Workspace) -> bool {
        let conclusions = self.outputs.get(output).map(|found| found.conclusions.iter());
        let degree = |&conclusion: &usize| workspace.degrees.get(conclusion).copied();
        conclusions.into_iter().flatten().filter_map(degree).any(|degree| degree > 0.0)
    }

    /// What the rules concluded about an output in the last evaluation, in the order of the rules.
    pub fn contributions(&self, output: usize, workspace: &mut Workspace) -> Vec<Contribution> {
        let (Some(part), Some(resolved)) =
            (self.parts.outputs.get(output), self.outputs.get(output))
        else {
            return Vec::new();
        };
        let reading = match part.defuzzifier {
            Defuzzifier::WeightedAverage(reading) | Defuzzifier::WeightedSum(reading) => {
                Some(reading)
            }
            _ => None,
        };
        self.look_from(output, workspace);
        let Workspace { inputs, degrees, scratch, .. } = workspace;
        let one = |&conclusion: &usize| {
            let (found, &degree) = (self.conclusions.get(conclusion)?, degrees.get(conclusion)?);
            let set = &part.terms.get(found.term)?.conclusion;
            let value = |reading| number(set, reading, degree, inputs, &mut scratch.room);
            let (origin, term) = (self.origin(conclusion)?, found.term);
            Some(Contribution { conclusion, origin, term, degree, value: reading.map(value) })
        };
        resolved.conclusions.iter().filter_map(one).collect()
    }
}
