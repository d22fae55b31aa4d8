//! Why a system answers as it does: rules by strength, and the share of each in every answer.

mod json;
mod picture;
mod share;
mod text;
mod why_not;

use fspid_fuzzy::system::{Firing, System};

use super::answer::{Asked, ask};
use super::words;
use fspid_scenario::supervisor::Refused;

pub use share::{Basis, Share, Shares};
pub use why_not::{Lack, WhyNot};

/// A question, its answers, and how they came about.
#[derive(Clone, Debug)]
pub struct Explanation<'a> {
    asked: Asked<'a>,
    /// Rules that fire, the strongest first.
    pub rules: Vec<Firing>,
    /// For each output what each rule has in its answer.
    pub shares: Vec<Shares>,
    /// Why a conclusion was not drawn, if that was asked.
    pub why_not: Option<WhyNot>,
}

/// Explains the answers at these values, `name=value`; `why_not` is `output=term`.
///
/// # Errors
/// [`Refused`] with everything that is wrong with the question.
pub fn explain<'a>(
    system: &'a System,
    values: &[String],
    why_not: Option<&str>,
) -> Result<Explanation<'a>, Refused> {
    let conclusion = why_not.map(|text| why_not::conclusion(system, text)).transpose()?;
    let mut asked = ask(system, values)?;
    let workspace = &mut asked.workspace;
    let mut rules: Vec<Firing> = system.firings(workspace).filter(|f| f.strength > 0.0).collect();
    rules.sort_by(|a, b| b.acting.total_cmp(&a.acting).then(b.strength.total_cmp(&a.strength)));
    let outputs = 0..system.parts().outputs.len();
    let shares = outputs.map(|output| share::shares(system, output, workspace)).collect();
    let why_not =
        conclusion.map(|(output, term)| why_not::why_not(system, (output, term), workspace));
    Ok(Explanation { asked, rules, shares, why_not })
}

impl Explanation<'_> {
    fn system(&self) -> &System {
        self.asked.system()
    }

    /// A rule as a sentence; empty for one that is not there.
    pub(crate) fn rule_in_words(&self, block: usize, rule: usize) -> String {
        let parts = self.system().parts();
        let found = parts.blocks.get(block).and_then(|block| block.rules.get(rule));
        found.map_or(String::new(), |rule| words::rule(rule, parts))
    }

    /// What a rule of the first block concludes of an output, and what that adds to the answer.
    pub(crate) fn conclusion(&self, output: usize, rule: usize) -> Option<(&str, Option<f64>)> {
        let is_meant = |share: &&Share| matches!(share.of.origin, [0, found, _] if found == rule);
        let share = self.shares.get(output)?.list.iter().find(is_meant)?;
        let output = self.system().parts().outputs.get(output)?;
        Some((&output.terms.get(share.of.term)?.name, share.contribution))
    }
}
