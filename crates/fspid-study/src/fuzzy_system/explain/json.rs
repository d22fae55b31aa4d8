//! An explanation for programs.

use serde_json::{Map, Value, json};

use super::Explanation;
use super::share::{Basis, Share, Shares};
use super::why_not::{Lack, WhyNot};
use crate::fuzzy_system::words;
use crate::json::{merged, present};

impl Explanation<'_> {
    /// The answers, the rules by strength, and the share of each in every output. Blocks and rules
    /// are numbered from 1.
    #[must_use]
    pub fn json(&self) -> Value {
        let rules = self.rules.iter().map(|firing| {
            let degrees = json!({ "strength": firing.strength, "acting": firing.acting });
            merged([self.rule_json([firing.block, firing.rule]), degrees])
        });
        let outputs = self.system().parts().outputs.iter().zip(&self.shares).enumerate();
        let shares: Map<String, Value> = outputs
            .map(|(index, (output, shares))| (output.name.clone(), self.shares_json(index, shares)))
            .collect();
        let why_not = self.why_not.as_ref().map(|why_not| self.why_not_json(why_not));
        merged([
            self.asked.json(),
            json!({ "rules": rules.collect::<Vec<_>>(), "shares": shares }),
            present(json!({ "why_not": why_not })),
        ])
    }

    fn rule_json(&self, [block, rule]: [usize; 2]) -> Value {
        let parts = self.system().parts();
        let found = parts.blocks.get(block).and_then(|block| block.rules.get(rule));
        let name = found.map(|rule| rule.name.as_str());
        present(json!({
            "block": block + 1,
            "rule": rule + 1,
            "text": found.map_or(String::new(), |rule| words::rule(rule, parts)),
            "name": name.filter(|name| !name.is_empty()),
        }))
    }

    fn term(&self, output: usize, term: usize) -> &str {
        let output = self.system().parts().outputs.get(output);
        output.and_then(|output| output.terms.get(term)).map_or("", |term| &term.name)
    }

    fn shares_json(&self, output: usize, shares: &Shares) -> Value {
        let basis = match shares.basis {
            Basis::Outline => "outline",
            Basis::Grid(_) => "grid",
            Basis::Weights => "weights",
            Basis::Aggregated => "joined",
        };
        let one = |share: &Share| {
            let [block, rule, _] = share.of.origin;
            let part = if shares.basis == Basis::Weights { "weight_share" } else { "area_share" };
            json!({
                "block": block + 1, "rule": rule + 1, "term": self.term(output, share.of.term),
                "degree": share.of.degree, part: share.part,
                "contribution": number(share.contribution),
            })
        };
        let polygon = shares.pieces.iter().flat_map(|piece| {
            [0, 1].map(|end: usize| [piece.x.get(end).copied(), piece.grade.get(end).copied()])
        });
        let list: Vec<Value> = shares.list.iter().map(one).collect();
        let interval = self.asked.workspace().interval(output);
        let is_outline = shares.basis == Basis::Outline;
        merged([
            json!({ "basis": basis, "sum": number(shares.sum), "rules": list }),
            present(json!({
                "of": interval.map(|_| "upper sets"),
                "polygon": is_outline.then(|| polygon.collect::<Vec<_>>()),
            })),
        ])
    }

    fn why_not_json(&self, why_not: &WhyNot) -> Value {
        let parts = self.system().parts();
        let one = |lack: &Lack| {
            let statements = lack.statements.iter().enumerate().map(|(index, (found, grade))| {
                let text = words::statement(found, parts);
                json!({ "text": text, "grade": grade, "limits": lack.limit == Some(index) })
            });
            let degrees = json!({
                "enabled": lack.enabled,
                "strength": lack.strength,
                "acting": lack.acting,
                "statements": statements.collect::<Vec<_>>(),
            });
            merged([self.rule_json(lack.rule), degrees])
        };
        json!({
            "output": parts.outputs.get(why_not.output).map(|output| &output.name),
            "term": self.term(why_not.output, why_not.term),
            "rules": why_not.rules.iter().map(one).collect::<Vec<_>>(),
        })
    }
}

/// A number, or that there is none: a rule concludes something infinite, or its set has no area.
fn number(found: Option<f64>) -> Value {
    found.map_or_else(|| json!("no number"), |number| json!(number))
}
